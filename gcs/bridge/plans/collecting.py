"""A plan on its way from a client: item by item, as a vehicle asks for them.

The client is asked with MISSION_REQUEST_INT; until its first item has come, every other question is
a MISSION_REQUEST, which is all that some clients know (MAVProxy, DroneKit: their sources), while
MAVSDK answers it with MISSION_ACK UNSUPPORTED for a PX4.  After that the form that was answered is
kept.

An item is asked for again as soon as the link's round trip allows.  MAVSDK gives a transfer up when
the same item was asked for a fourth time in vain, so the pauses grow.
"""

from __future__ import annotations

from typing import Final, TypeAlias

from gcs.bridge.conversation.pending_requests import From
from gcs.plan.item_messages import item_of, item_of_degrees
from gcs.plan.wire import WireItem
from gcs.protocol.effects import Address
from gcs.protocol.transfers.transfer import RoundTrip, Timing
from gcs.wire.ids import MissionResult, MissionType
from gcs.wire.messages import (
    MissionAck,
    MissionCount,
    MissionItem,
    MissionItemInt,
    MissionRequest,
    MissionRequestInt,
)

Question: TypeAlias = MissionRequest | MissionRequestInt
ItemMessage: TypeAlias = MissionItem | MissionItemInt

QUICK_REPEATS: Final = 2
"""After so many repeats of a question each pause is twice the one before."""
SILENCE_NS: Final = 10_000_000_000
"""A client that sends nothing that was asked for is given up after so long (ArduPilot: 8 s)."""


class Collecting:
    """`start`, then `item`, `unsupported`, `again` and `wake` until it is `whole`, `given_up`, or
    `bad_item` names one that cannot be taken."""

    def __init__(self, opened: MissionCount, opened_by: From, timing: Timing) -> None:
        self.kind = MissionType(opened.mission_type)
        self.opened_by = opened_by
        self._timing = timing
        self._silence_ns = SILENCE_NS * timing.item_wait_ns // Timing().item_wait_ns
        self._round_trip = RoundTrip(timing)
        self.opened = opened
        self.items: list[WireItem] = []
        self.repeated = 0
        """How many questions were put again: the link loses frames, or the client is slow."""
        self.given_up = False
        self.bad_item: int | None = None
        self._as_int = True
        self._repeats = 0
        self._asked_ns = 0
        self._heard_ns = 0
        self.deadline_ns: int | None = None

    @property
    def whole(self) -> bool:
        return len(self.items) == self.opened.count

    @property
    def answer_ns(self) -> int:
        """How long this client's link takes to bring an answer, at most, where none is lost."""
        return self._round_trip.wait_ns

    @property
    def asks_int(self) -> bool:
        """The form of question that this client answers."""
        return self._as_int

    def start(self, now_ns: int) -> list[Question]:
        self._heard_ns = now_ns
        return self._ask(now_ns)

    def item(self, message: ItemMessage, now_ns: int) -> list[Question]:
        """An item of this plan: the one that was asked for, or one that came late."""
        wanted = len(self.items)
        if message.seq != wanted or wanted == self.opened.count:
            return []
        if self._repeats == 0:
            self._round_trip.measured(now_ns - self._asked_ns)
        if isinstance(message, MissionItem) and not self.items:
            self._as_int = False
        item = item_of_degrees(message) if isinstance(message, MissionItem) else item_of(message)
        if item is None:
            self.bad_item, self.deadline_ns = message.seq, None
            return []
        self.items.append(item)
        self._heard_ns = now_ns
        self._repeats = 0
        if len(self.items) == self.opened.count:
            self.deadline_ns = None
            return []
        return self._ask(now_ns)

    def unsupported(self, now_ns: int) -> list[Question]:
        """The client does not know the form of the question (MISSION_ACK UNSUPPORTED)."""
        self._as_int = not self._as_int
        self._heard_ns = now_ns
        return self._ask(now_ns)

    def again(self, now_ns: int) -> list[Question]:
        """The client has sent its count again: the question has not reached it."""
        self._heard_ns = now_ns
        return self._ask(now_ns)

    def wake(self, now_ns: int) -> list[Question]:
        if self.deadline_ns is None or now_ns < self.deadline_ns:
            return []
        if now_ns - self._heard_ns >= self._silence_ns:
            self.given_up, self.deadline_ns = True, None
            return []
        self._repeats += 1
        self.repeated += 1
        if not self.items:
            self._as_int = not self._as_int
        return self._ask(now_ns)

    def _ask(self, now_ns: int) -> list[Question]:
        wait_ns = min(self._timing.item_wait_ns, self._round_trip.wait_ns)
        wait_ns <<= max(0, self._repeats - QUICK_REPEATS)
        self._asked_ns = now_ns
        self.deadline_ns = now_ns + min(wait_ns, 2 * self._timing.item_wait_ns)
        return [question(len(self.items), self.opened_by.source, self.kind, self._as_int)]


def question(seq: int, client: Address, kind: MissionType, as_int: bool) -> Question:
    """Send item `seq`, please."""
    form = MissionRequestInt if as_int else MissionRequest
    return form(
        seq=seq,
        target_system=client.sysid,
        target_component=client.compid,
        mission_type=kind,
    )


def acknowledgement(
    client: Address, result: MissionResult, kind: int, opaque_id: int = 0
) -> MissionAck:
    return MissionAck(
        target_system=client.sysid,
        target_component=client.compid,
        type=result,
        mission_type=kind,
        opaque_id=opaque_id,
    )
