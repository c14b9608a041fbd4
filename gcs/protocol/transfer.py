"""What upload, download and clearing of a plan have in common: whom they listen to, how long
they wait, how often they try (https://mavlink.io/en/services/mission.html).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from gcs.protocol.effects import (
    Address,
    Cancel,
    Heard,
    Send,
    TransferDone,
    TransferEffect,
    TransferFailed,
    Wake,
)
from gcs.wire.ids import MissionResult, MissionType
from gcs.wire.messages import (
    MissionAck,
    MissionCount,
    MissionItemInt,
    MissionRequest,
    MissionRequestInt,
)

Input: TypeAlias = Heard | Wake | Cancel
PlanMessage: TypeAlias = (
    MissionAck | MissionCount | MissionItemInt | MissionRequest | MissionRequestInt
)


@dataclass(frozen=True, slots=True)
class Timing:
    """The specification's figures."""

    wait_ns: int = 1_500_000_000
    item_wait_ns: int = 250_000_000
    retries: int = 5
    """Of one and the same message, after its first try."""


SPEC_TIMING = Timing()


@dataclass(frozen=True, slots=True)
class Parties:
    """Who asks whom about which plan."""

    own: Address
    target: Address
    mission_type: MissionType

    def concerns(self, heard: Heard) -> PlanMessage | None:
        """The message if it belongs to this transfer: from the target, to us, of our plan."""
        message = heard.message
        if not isinstance(message, PlanMessage):
            return None
        to = Address(message.target_system, message.target_component)
        from_target = self.target.includes(heard.sysid, heard.compid)
        to_us = to.includes(self.own.sysid, self.own.compid)
        ours = message.mission_type == self.mission_type
        return message if from_target and to_us and ours else None


class Pending:
    """A message that is repeated until something comes back, or given up."""

    def __init__(self, retries: int) -> None:
        self._retries = retries
        self._send: Send | None = None
        self._wait_ns = 0
        self._left = 0
        self.deadline_ns: int | None = None

    def put(self, send: Send, wait_ns: int, now_ns: int) -> list[TransferEffect]:
        """Send it and start the wait, with all retries ahead."""
        self._send, self._wait_ns, self._left = send, wait_ns, self._retries
        self.deadline_ns = now_ns + wait_ns
        return [send]

    def clear(self) -> None:
        self._send = self.deadline_ns = None

    def wake(self, now_ns: int) -> list[TransferEffect] | None:
        """Repeat it if its wait is over; None when it was repeated often enough."""
        if self._send is None or self.deadline_ns is None or now_ns < self.deadline_ns:
            return []
        if self._left == 0:
            return None
        self._left -= 1
        self.deadline_ns = now_ns + self._wait_ns
        return [self._send]


class Transfer:
    """A transfer's frame: it starts once, ends once, and hears nothing after that."""

    def __init__(self, parties: Parties, timing: Timing) -> None:
        self._parties = parties
        self._timing = timing
        self._pending = Pending(timing.retries)
        self.ended = False

    @property
    def deadline_ns(self) -> int | None:
        return self._pending.deadline_ns

    def _done(self, items: tuple[MissionItemInt, ...]) -> list[TransferEffect]:
        self._end()
        return [TransferDone(self._parties.mission_type, items)]

    def _failed(self, result: int | None, text: str) -> list[TransferEffect]:
        self._end()
        return [TransferFailed(self._parties.mission_type, result, text)]

    def _refused(self, result: int) -> list[TransferEffect]:
        return self._failed(result, f"the vehicle answered {result_name(result)}")

    def _cancelled(self) -> list[TransferEffect]:
        """Tell the vehicle, so that it need not time out."""
        return [
            self._acknowledge(MissionResult.OPERATION_CANCELLED),
            *self._failed(None, "cancelled"),
        ]

    def _acknowledge(self, result: MissionResult) -> Send:
        to = self._parties.target
        ack = MissionAck(
            target_system=to.sysid,
            target_component=to.compid,
            type=result,
            mission_type=self._parties.mission_type,
        )
        return Send(ack)

    def _end(self) -> None:
        self.ended = True
        self._pending.clear()


def result_name(result: int) -> str:
    """MAV_MISSION_RESULT in words, as far as it is known."""
    try:
        return MissionResult(result).name
    except ValueError:
        return f"result {result}"
