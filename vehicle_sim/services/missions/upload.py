"""A plan on its way to the vehicle.

    IDLE --MISSION_COUNT--> RECEIVING --last item, all good--> IDLE, plan swapped, ack ACCEPTED
                             |  ^   |--last item, one is bad--> IDLE, old plan whole, ack says why
                             +--+   '--no answer for too long-> IDLE, ack OPERATION_CANCELLED
        the item asked for: ask for the next; any other, or none in time: ask again
        the same MISSION_COUNT frame again: ask again; a new one: start over
        MISSION_ACK UNSUPPORTED (MAVSDK, to a float request): ask in the other form
        MISSION_ACK OPERATION_CANCELLED: IDLE, old plan whole

MISSION_WRITE_PARTIAL_LIST (ArduPilot's) is the same for a part of the plan.  Invariant: the stored
plan changes in one step, at the final ack.  Time is wall time, for it measures the other side.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final, TypeAlias

from vehicle_sim.autopilot.interface import PlanItem
from vehicle_sim.effects import Client, Effect, Note, Send
from vehicle_sim.services.missions.plan_items import from_float, from_int
from vehicle_sim.services.missions.plans import Plans
from vehicle_sim.services.profile import PLAN_TYPES, Profile
from vehicle_sim.services.streams import NEVER
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import MissionResult, MissionType

ACK_REPEATED_NS: Final = 15_000_000_000
"""How long a repeated last item is answered with the ack again (the first may have been lost)."""
TWIN_NS: Final = 3_000_000_000
"""How much later a frame's duplicate may come: afterwards its number means nothing any more."""
SEVERITY_WARNING: Final = 4

Request: TypeAlias = type[m.MissionRequest] | type[m.MissionRequestInt]
Opening: TypeAlias = m.MissionCount | m.MissionWritePartialList
_OTHER_FORM: Final[dict[type, Request]] = {
    m.MissionRequest: m.MissionRequestInt,
    m.MissionRequestInt: m.MissionRequest,
}


@dataclass(frozen=True, slots=True)
class _Opened:
    """The frame that began an upload."""

    client: Client
    sequence: int | None
    asked: Opening
    at_ns: int

    def repeated_by(self, other: _Opened) -> bool:
        """The network has delivered it twice."""
        return (
            self.sequence is not None
            and (self.client, self.sequence, self.asked)
            == (other.client, other.sequence, other.asked)
            and other.at_ns - self.at_ns <= TWIN_NS
        )


@dataclass(slots=True)
class _Receiving:
    client: Client
    kind: MissionType
    first: int  # seq
    count: int
    deadline_ns: int
    request: Request
    opening: _Opened
    tries: int = 0
    items: list[PlanItem] = field(default_factory=list)

    @property
    def wanted(self) -> int:
        """The seq that is asked for."""
        return self.first + len(self.items)


@dataclass(frozen=True, slots=True)
class _Finished:
    """The last upload, in case its ack gets lost."""

    client: Client
    kind: MissionType
    last_seq: int
    at_ns: int
    ack: Send
    opening: _Opened


class Uploads:
    """At most one at a time, whoever sends it."""

    def __init__(self, profile: Profile, plans: Plans) -> None:
        self._profile = profile
        self._plans = plans
        self._receiving: _Receiving | None = None
        self._finished: _Finished | None = None

    @property
    def deadline_ns(self) -> int:
        return self._receiving.deadline_ns if self._receiving is not None else NEVER

    def busy_for(self, client: Client) -> bool:
        """Another client's upload is under way."""
        return self._receiving is not None and self._receiving.client != client

    def abandon(self) -> None:
        self._receiving = None

    def forget(self, channel: int) -> None:
        """The channel is gone, and with it an upload on it."""
        if self._receiving is not None and self._receiving.client.channel == channel:
            self._receiving = None

    def open(
        self, client: Client, asked: Opening, now_ns: int, sequence: int | None
    ) -> list[Effect]:
        """`sequence`: the frame's; a frame that comes twice is no second upload."""
        opening = _Opened(client, sequence, asked, now_ns)
        if self.busy_for(client):
            return [ack(client, asked.mission_type, MissionResult.DENIED)]
        if self._receiving is not None and self._receiving.opening.repeated_by(opening):
            return [self._ask(self._receiving, now_ns)]
        if self._finished is not None and self._finished.opening.repeated_by(opening):
            return [self._finished.ack]
        self._receiving = None
        if asked.mission_type not in PLAN_TYPES:
            return [ack(client, asked.mission_type, MissionResult.UNSUPPORTED)]
        kind = MissionType(asked.mission_type)
        if isinstance(asked, m.MissionCount):
            first, count = 0, asked.count_
        else:
            first, count = asked.start_index, asked.end_index - asked.start_index + 1
            # The item after the last may be written too: it is appended.
            if not (first >= 0 and count > 0 and asked.end_index <= len(self._plans.plan(kind))):
                return [ack(client, kind, MissionResult.ERROR)]
        if first + count > self._profile.plan_max[kind]:
            return [ack(client, kind, MissionResult.NO_SPACE)]
        upload = _Receiving(
            client, kind, first, count, now_ns, self._profile.first_item_request, opening
        )
        if upload.count == 0:
            return self._complete(upload, now_ns)
        self._receiving = upload
        return [self._ask(upload, now_ns)]

    def item(
        self, client: Client, asked: m.MissionItemInt | m.MissionItem, now_ns: int
    ) -> list[Effect]:
        upload = self._receiving
        if upload is None or upload.client != client or upload.kind != asked.mission_type:
            return self._stray(client, asked, now_ns)
        upload.tries = 0
        if asked.seq != upload.wanted:
            return [self._ask(upload, now_ns)]
        item = from_int(asked) if isinstance(asked, m.MissionItemInt) else from_float(asked)
        if item is None:
            self._receiving = None
            return [
                Send(None, _text(f"item {asked.seq}: a coordinate is not a number")),
                ack(client, upload.kind, MissionResult.INVALID),
            ]
        upload.items.append(item)
        upload.request = self._profile.item_request
        if len(upload.items) < upload.count:
            return [self._ask(upload, now_ns)]
        self._receiving = None
        return self._complete(upload, now_ns)

    def answered(self, client: Client, asked: m.MissionAck, now_ns: int) -> list[Effect]:
        """The sender of an upload refuses a request's form, or gives the upload up."""
        upload = self._receiving
        if upload is None or upload.client != client or upload.kind != asked.mission_type:
            return []
        if asked.type == MissionResult.UNSUPPORTED:
            upload.request = _OTHER_FORM[upload.request]
            return [self._ask(upload, now_ns)]
        if asked.type == MissionResult.OPERATION_CANCELLED:
            self._receiving = None
            return [Note("info", f"{upload.kind.name.lower()} upload cancelled by its sender")]
        return []

    def tick(self, now_ns: int) -> list[Effect]:
        """Ask again for what did not come, or give up."""
        upload = self._receiving
        if upload is None or now_ns < upload.deadline_ns:
            return []
        upload.tries += 1
        if upload.tries <= self._profile.mission_retries:
            return [self._ask(upload, now_ns)]
        self._receiving = None
        return [
            Note("warning", f"{upload.kind.name.lower()} upload timed out"),
            ack(upload.client, upload.kind, MissionResult.OPERATION_CANCELLED),
        ]

    def _ask(self, upload: _Receiving, now_ns: int) -> Send:
        upload.deadline_ns = now_ns + self._profile.mission_retry_ns
        client = upload.client
        request = upload.request(upload.wanted, client.system, client.component, upload.kind)
        return Send(client.channel, request)

    def _complete(self, upload: _Receiving, now_ns: int) -> list[Effect]:
        items = tuple(upload.items)
        if isinstance(upload.opening.asked, m.MissionWritePartialList):
            old = self._plans.plan(upload.kind)
            items = old[: upload.first] + items + old[upload.wanted :]
        bad = self._plans.check(upload.kind, items)
        if bad is None:
            self._plans.store(upload.kind, items)
            said = ack(
                upload.client,
                upload.kind,
                MissionResult.ACCEPTED,
                self._plans.opaque_id(upload.kind),
            )
            effects: list[Effect] = [
                Note("info", f"{upload.kind.name.lower()} of {len(items)} items received"),
                said,
            ]
        else:
            seq, why, result = bad
            said = ack(upload.client, upload.kind, result)
            effects = [Send(None, _text(f"item {seq}: {why}")), said]
        self._finished = _Finished(
            upload.client, upload.kind, upload.wanted - 1, now_ns, said, upload.opening
        )
        return effects

    def _stray(
        self, client: Client, asked: m.MissionItemInt | m.MissionItem, now_ns: int
    ) -> list[Effect]:
        """An item that nobody asked for: if it is of the last upload, its ack may have got lost."""
        last = self._finished
        if (
            last is not None
            and (last.client, last.kind) == (client, asked.mission_type)
            and asked.seq <= last.last_seq
            and now_ns - last.at_ns <= ACK_REPEATED_NS
        ):
            return [last.ack] if asked.seq == last.last_seq else []
        return [ack(client, asked.mission_type, MissionResult.ERROR)]


def ack(client: Client, kind: int, result: MissionResult, plan_id: int = 0) -> Send:
    """MISSION_ACK to the one who sent."""
    return Send(
        client.channel, m.MissionAck(client.system, client.component, result, kind, plan_id)
    )


def _text(text: str) -> m.Statustext:
    return m.Statustext(severity=SEVERITY_WARNING, text=text.encode("ascii", "replace")[:50])
