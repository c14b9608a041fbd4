"""The mission protocol, as the vehicle speaks it: upload, download, clear, set current.

    IDLE --MISSION_COUNT--> RECEIVING --last item, all good--> IDLE, plan swapped, ack ACCEPTED
                             |  ^   |--last item, one is bad--> IDLE, old plan whole, ack says why
                             +--+   '--no answer for too long-> IDLE, ack OPERATION_CANCELLED
        the item asked for: ask for the next; any other, or none in time: ask again

Invariant: the stored plan changes in one step, at the final ack.  Downloads have no state: each
request is answered for itself.  Time is wall time, for it measures the other side.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

from vehicle_sim.autopilot.interface import PlanItem, Result, Vehicle
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import RELATIVE, MissionResult, MissionType

from .effects import Client, Effect, Note, Send
from .plan_items import (
    as_ardupilot_gives_back,
    as_px4_gives_back,
    from_float,
    from_int,
    opaque_id,
    to_float,
    to_int,
)
from .profile import PLAN_TYPES, Profile
from .setpoints import BadSetpointError, place_ned
from .streams import NEVER

ITEMS_MAX: Final = 1000
ACK_REPEATED_NS: Final = 5_000_000_000
"""How long a repeated last item is answered with the ack again (the first may have been lost)."""
SEVERITY_WARNING: Final = 4
COMMANDS: Final = {
    MissionType.FENCE: range(5000, 5005),
    MissionType.RALLY: range(5100, 5101),
}
GUIDED: Final = 2
GUIDED_HEIGHT: Final = 3


@dataclass(slots=True)
class _Receiving:
    client: Client
    kind: MissionType
    count: int
    deadline_ns: int
    tries: int = 0
    items: list[PlanItem] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class _Finished:
    """The last upload, in case its ack gets lost."""

    client: Client
    kind: MissionType
    last_seq: int
    at_ns: int
    ack: Send


class MissionServer:
    """One vehicle's plans."""

    def __init__(self, vehicle: Vehicle, profile: Profile) -> None:
        self._vehicle = vehicle
        self._profile = profile
        self._stored: dict[MissionType, tuple[PlanItem, ...]] = {}
        self._receiving: _Receiving | None = None
        self._finished: _Finished | None = None

    @property
    def deadline_ns(self) -> int:
        return self._receiving.deadline_ns if self._receiving is not None else NEVER

    def plan(self, kind: MissionType) -> tuple[PlanItem, ...]:
        if kind is MissionType.MISSION:
            return self._vehicle.plan
        return self._stored.get(kind, ())

    def plan_ids(self) -> tuple[int, int, int, int]:
        """Number of mission items; ids of mission, fence and rally points."""
        mission, fence, rally = (opaque_id(self.plan(kind)) for kind in PLAN_TYPES)
        return len(self._vehicle.plan), mission, fence, rally

    # ------------------------------------------------------------------------- upload

    def count(self, client: Client, asked: m.MissionCount, now_ns: int) -> list[Effect]:
        if self._busy_for(client):
            return [self._ack(client, asked.mission_type, MissionResult.DENIED)]
        self._receiving = None
        if asked.mission_type not in PLAN_TYPES:
            return [self._ack(client, asked.mission_type, MissionResult.UNSUPPORTED)]
        if asked.count_ > ITEMS_MAX:
            return [self._ack(client, asked.mission_type, MissionResult.NO_SPACE)]
        upload = _Receiving(client, MissionType(asked.mission_type), asked.count_, now_ns)
        if upload.count == 0:
            return self._complete(upload, now_ns)
        self._receiving = upload
        return [self._ask(upload, now_ns)]

    def item(
        self, client: Client, asked: m.MissionItemInt | m.MissionItem, now_ns: int
    ) -> list[Effect]:
        if asked.current in (GUIDED, GUIDED_HEIGHT) and self._profile.guided_items:
            return [self._guided(client, asked)]
        upload = self._receiving
        if upload is None or upload.client != client or upload.kind != asked.mission_type:
            return self._stray(client, asked, now_ns)
        upload.tries = 0
        if asked.seq != len(upload.items):
            return [self._ask(upload, now_ns)]
        item = from_int(asked) if isinstance(asked, m.MissionItemInt) else from_float(asked)
        if item is None:
            self._receiving = None
            return [
                Send(None, _text(f"item {asked.seq}: a coordinate is not a number")),
                self._ack(client, upload.kind, MissionResult.INVALID),
            ]
        upload.items.append(item)
        if len(upload.items) < upload.count:
            return [self._ask(upload, now_ns)]
        self._receiving = None
        return self._complete(upload, now_ns)

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
            self._ack(upload.client, upload.kind, MissionResult.OPERATION_CANCELLED),
        ]

    def forget(self, channel: int) -> None:
        """The channel is gone, and with it an upload on it."""
        if self._receiving is not None and self._receiving.client.channel == channel:
            self._receiving = None

    def _busy_for(self, client: Client) -> bool:
        return self._receiving is not None and self._receiving.client != client

    def _ask(self, upload: _Receiving, now_ns: int) -> Send:
        upload.deadline_ns = now_ns + self._profile.mission_retry_ns
        seq = len(upload.items)
        request = self._profile.item_request if seq else self._profile.first_item_request
        client = upload.client
        return Send(client.channel, request(seq, client.system, client.component, upload.kind))

    def _complete(self, upload: _Receiving, now_ns: int) -> list[Effect]:
        items = tuple(upload.items)
        bad = self._check(upload.kind, items)
        if bad is None:
            self._store(upload.kind, items)
            ack = self._ack(upload.client, upload.kind, MissionResult.ACCEPTED, opaque_id(items))
            effects: list[Effect] = [
                Note("info", f"{upload.kind.name.lower()} of {len(items)} items received"),
                ack,
            ]
        else:
            seq, why = bad
            ack = self._ack(upload.client, upload.kind, MissionResult.UNSUPPORTED)
            effects = [Send(None, _text(f"item {seq}: {why}")), ack]
        self._finished = _Finished(upload.client, upload.kind, upload.count - 1, now_ns, ack)
        return effects

    def _check(self, kind: MissionType, items: tuple[PlanItem, ...]) -> tuple[int, str] | None:
        if kind is MissionType.MISSION:
            return self._vehicle.check_plan(items)
        return next(
            (
                (item.seq, f"command {item.command} is not for a {kind.name.lower()}")
                for item in items
                if item.command not in COMMANDS[kind]
            ),
            None,
        )

    def _store(self, kind: MissionType, items: tuple[PlanItem, ...]) -> None:
        if kind is MissionType.MISSION:
            self._vehicle.load_plan(items)
        else:
            self._stored[kind] = items

    def _stray(
        self, client: Client, asked: m.MissionItemInt | m.MissionItem, now_ns: int
    ) -> list[Effect]:
        """An item that nobody asked for: if it is the last one again, its ack got lost."""
        last = self._finished
        if (
            last is not None
            and (last.client, last.kind, last.last_seq) == (client, asked.mission_type, asked.seq)
            and now_ns - last.at_ns <= ACK_REPEATED_NS
        ):
            return [last.ack]
        return [self._ack(client, asked.mission_type, MissionResult.ERROR)]

    def _guided(self, client: Client, asked: m.MissionItemInt | m.MissionItem) -> Send:
        """current = 2: go there; 3: go to that height.  The ack says whether it does."""
        item = from_int(asked) if isinstance(asked, m.MissionItemInt) else from_float(asked)
        if item is None:
            return self._ack(client, asked.mission_type, MissionResult.INVALID)
        relative = item.frame in RELATIVE
        try:
            place = place_ned(
                self._vehicle, self._profile, item.x * 1e-7, item.y * 1e-7, item.z, relative
            )
        except BadSetpointError:
            return self._ack(client, asked.mission_type, MissionResult.INVALID)
        if asked.current == GUIDED_HEIGHT:
            here = self._vehicle.estimate.pos_ned
            place = (here[0], here[1], place[2])
        result = self._vehicle.reposition(place, None, None)
        return self._ack(
            client,
            asked.mission_type,
            MissionResult.ACCEPTED if result is Result.ACCEPTED else MissionResult.ERROR,
        )

    # -------------------------------------------------------------- download and the rest

    def request_list(self, client: Client, asked: m.MissionRequestList) -> list[Effect]:
        if asked.mission_type not in PLAN_TYPES:
            return [self._ack(client, asked.mission_type, MissionResult.UNSUPPORTED)]
        items = self.plan(MissionType(asked.mission_type))
        told = m.MissionCount(
            count_=len(items),
            target_system=client.system,
            target_component=client.component,
            mission_type=asked.mission_type,
            opaque_id=opaque_id(items),
        )
        return [Send(client.channel, told)]

    def request(
        self, client: Client, asked: m.MissionRequest | m.MissionRequestInt
    ) -> list[Effect]:
        if asked.mission_type not in PLAN_TYPES:
            return [self._ack(client, asked.mission_type, MissionResult.UNSUPPORTED)]
        items = self.plan(MissionType(asked.mission_type))
        if asked.seq >= len(items):
            return [self._ack(client, asked.mission_type, MissionResult.INVALID_SEQUENCE)]
        item = items[asked.seq]
        if not self._profile.home_is_item_0:
            item = as_px4_gives_back(item)
        elif asked.mission_type == MissionType.MISSION:
            item = as_ardupilot_gives_back(item, self._vehicle.home)
        if isinstance(asked, m.MissionRequest) and self._profile.float_items:
            return [Send(client.channel, to_float(item, client, asked.mission_type))]
        return [Send(client.channel, to_int(item, client, asked.mission_type))]

    def clear(self, client: Client, asked: m.MissionClearAll) -> list[Effect]:
        if asked.mission_type == MissionType.ALL:
            kinds = list(PLAN_TYPES)
        elif asked.mission_type in PLAN_TYPES:
            kinds = [MissionType(asked.mission_type)]
        else:
            return [self._ack(client, asked.mission_type, MissionResult.UNSUPPORTED)]
        if self._busy_for(client):
            return [self._ack(client, asked.mission_type, MissionResult.DENIED)]
        self._receiving = None
        for kind in kinds:
            self._store(kind, ())
        return [self._ack(client, asked.mission_type, MissionResult.ACCEPTED)]

    def set_current(self, client: Client, asked: m.MissionSetCurrent) -> list[Effect]:
        """MISSION_CURRENT is the answer to one that is carried out; the caller sends it."""
        if self._vehicle.mission_set_current(asked.seq) is Result.ACCEPTED:
            return []
        return [self._ack(client, MissionType.MISSION, MissionResult.INVALID_SEQUENCE)]

    def _ack(self, client: Client, kind: int, result: MissionResult, plan_id: int = 0) -> Send:
        return Send(
            client.channel,
            m.MissionAck(client.system, client.component, result, kind, plan_id),
        )


def _text(text: str) -> m.Statustext:
    return m.Statustext(severity=SEVERITY_WARNING, text=text.encode("ascii", "replace")[:50])
