"""What upload, download and clearing of a plan have in common: whom they listen to, how long
they wait, how often they try (https://mavlink.io/en/services/mission.html).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, TypeAlias

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
    """How long a message waits for its answer, and when a silent vehicle is given up.

    The specification recommends 1.5 s, 250 ms for items, and 5 retries.  The 250 ms are taken until
    the link's round trip is measured: on a slow link each item would be sent twice.  On a link that
    loses a quarter both ways 5 retries are too few for 500 items: one and the same message is
    repeated for `silence_ns`, and at least `retries` times.  Through a bridge whose links both lose
    a quarter one of three tries comes through: of 500 items one was nearly always asked for in vain
    for 15 s, and one of fifty counts, which are repeated every 1.5 s.  How long a whole transfer
    may take is its owner's to say.

    A bridge answers the last item only when the plan is on board of its vehicle and read back, and
    asks for items again meanwhile.  For `confirm_ns` that counts as progress.
    """

    wait_ns: int = 1_500_000_000
    item_wait_ns: int = 250_000_000
    retries: int = 5
    silence_ns: int = 30_000_000_000
    confirm_ns: int = 300_000_000_000

    @property
    def soonest_ns(self) -> int:
        """However quick the link is, an item is not asked for again sooner than this."""
        return self.item_wait_ns // 5


SPEC_TIMING = Timing()
MOST_BACKOFF: Final = 4


class RoundTrip:
    """How long an answer takes on this link, as TCP reckons it (RFC 6298, with Karn's rule).

    An answer to a message that was repeated measures nothing.  The wait for the next one is doubled
    then, until an answer comes that measures; of a link that was measured to `MOST_BACKOFF` times,
    as one that loses a quarter both ways is not slower for it.
    """

    def __init__(self, timing: Timing) -> None:
        self._timing = timing
        self._mean_ns: float | None = None
        self._spread_ns = 0.0
        self._backoff = 1

    def measured(self, took_ns: int) -> None:
        """An answer to a message that was sent once came after `took_ns`."""
        self._backoff = 1
        if self._mean_ns is None:
            self._mean_ns, self._spread_ns = float(took_ns), took_ns / 2.0
            return
        self._spread_ns += 0.25 * (abs(took_ns - self._mean_ns) - self._spread_ns)
        self._mean_ns += 0.125 * (took_ns - self._mean_ns)

    def ambiguous(self) -> None:
        """An answer came to an item that was sent more than once."""
        known = self._mean_ns is not None
        if self.wait_ns < self._timing.wait_ns and not (known and self._backoff >= MOST_BACKOFF):
            self._backoff *= 2

    @property
    def wait_ns(self) -> int:
        """Before an item is asked for again; never longer than for any other message."""
        wait_ns = self._timing.item_wait_ns
        if self._mean_ns is not None:
            soonest_ns = self._timing.soonest_ns
            spread_ns = max(soonest_ns / 2.0, 4.0 * self._spread_ns)
            wait_ns = max(soonest_ns, round(self._mean_ns + spread_ns))
        return min(self._timing.wait_ns, self._backoff * wait_ns)


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

    def __init__(self, timing: Timing) -> None:
        self._timing = timing
        self._round_trip = RoundTrip(timing)
        self._send: Send | None = None
        self._is_item = False
        self._wait_ns = 0
        self._put_ns = 0
        self.repeats = 0
        self.deadline_ns: int | None = None

    def put(self, send: Send, now_ns: int) -> list[TransferEffect]:
        """Send it and start the wait, with all retries ahead."""
        self._is_item = False
        return self._start(send, self._timing.wait_ns, now_ns)

    def put_item(self, send: Send, now_ns: int) -> list[TransferEffect]:
        """The same for an item, or for the question for one: as quick as the link is."""
        self._is_item = True
        return self._start(send, self._round_trip.wait_ns, now_ns)

    def _start(self, send: Send, wait_ns: int, now_ns: int) -> list[TransferEffect]:
        self._send, self._wait_ns, self._put_ns, self.repeats = send, wait_ns, now_ns, 0
        self.deadline_ns = now_ns + wait_ns
        return [send]

    def answered(self, now_ns: int) -> None:
        """What was awaited has come.  After a repeat nobody knows which of them it answers."""
        if self._send is None:
            return
        if self.repeats == 0:
            self._round_trip.measured(now_ns - self._put_ns)
        elif self._is_item:
            self._round_trip.ambiguous()

    def clear(self) -> None:
        self._send = self.deadline_ns = None

    def wake(self, now_ns: int) -> list[TransferEffect] | None:
        """Repeat it if its wait is over; None when it was repeated often enough."""
        if self._send is None or self.deadline_ns is None or now_ns < self.deadline_ns:
            return []
        over = now_ns - self._put_ns >= self._timing.silence_ns
        if over and self.repeats >= self._timing.retries:
            return None
        self.repeats += 1
        if self.repeats > self._timing.retries:
            self._wait_ns = min(self._timing.wait_ns, 2 * self._wait_ns)
        self.deadline_ns = now_ns + self._wait_ns
        return [self._send]


class Transfer:
    """A transfer's frame: it starts once, ends once, and hears nothing after that."""

    def __init__(self, parties: Parties, timing: Timing) -> None:
        self._parties = parties
        self._pending = Pending(timing)
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

    def _cancelled(self, why: str) -> list[TransferEffect]:
        """Tell the vehicle, so that it need not time out."""
        return [
            self._acknowledge(MissionResult.OPERATION_CANCELLED),
            *self._failed(None, why),
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
