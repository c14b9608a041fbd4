"""The mission protocol, as the vehicle speaks it: upload, download, clear, set current.

Downloads have no state: each request is answered for itself.  Uploads are in `upload.py`.
"""

from __future__ import annotations

from typing import Final

from vehicle_sim.autopilot.interface import PlanItem, Result, Vehicle
from vehicle_sim.effects import Client, Effect, Send
from vehicle_sim.services.missions.plan_items import (
    as_ardupilot_gives_back,
    as_px4_gives_back,
    from_float,
    from_int,
    place_as_px4_gives_back,
    to_float,
    to_int,
)
from vehicle_sim.services.missions.plans import Plans
from vehicle_sim.services.missions.upload import Opening, Uploads, ack
from vehicle_sim.services.profile import PLAN_TYPES, Profile
from vehicle_sim.services.setpoints import BadSetpointError, place_ned
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import RELATIVE, MissionResult, MissionType

NOTHING: Final = PlanItem(0, 0, 0, 0.0, 0.0, 0.0, 0.0, 0, 0, 0.0, 1)
"""Where home stands at the head of a mission that is empty."""
GUIDED: Final = 2
GUIDED_HEIGHT: Final = 3


class MissionServer:
    """One vehicle's plans."""

    def __init__(self, vehicle: Vehicle, profile: Profile) -> None:
        self._vehicle = vehicle
        self._profile = profile
        self._plans = Plans(vehicle, profile)
        self._uploads = Uploads(profile, self._plans)

    @property
    def deadline_ns(self) -> int:
        return self._uploads.deadline_ns

    def plan(self, kind: MissionType) -> tuple[PlanItem, ...]:
        return self._plans.plan(kind)

    def plan_ids(self) -> tuple[int, int, int, int]:
        """Number of mission items; ids of mission, fence and rally points."""
        return self._plans.summary()

    def forget(self, channel: int) -> None:
        self._uploads.forget(channel)

    # ------------------------------------------------------------------------- upload

    def count(
        self, client: Client, asked: Opening, now_ns: int, sequence: int | None = None
    ) -> list[Effect]:
        """An upload begins; PX4 has never heard of partial ones."""
        if isinstance(asked, m.MissionWritePartialList) and not self._profile.partial_lists:
            return []
        return self._uploads.open(client, asked, now_ns, sequence)

    def item(
        self, client: Client, asked: m.MissionItemInt | m.MissionItem, now_ns: int
    ) -> list[Effect]:
        if asked.current in (GUIDED, GUIDED_HEIGHT) and self._profile.guided_items:
            return [self._guided(client, asked)]
        return self._uploads.item(client, asked, now_ns)

    def answered(self, client: Client, asked: m.MissionAck, now_ns: int) -> list[Effect]:
        return self._uploads.answered(client, asked, now_ns)

    def tick(self, now_ns: int) -> list[Effect]:
        """Ask again for what did not come, or give up."""
        return self._uploads.tick(now_ns)

    def _guided(self, client: Client, asked: m.MissionItemInt | m.MissionItem) -> Send:
        """current = 2: go there; 3: go to that height.  The ack says whether it does."""
        item = from_int(asked) if isinstance(asked, m.MissionItemInt) else from_float(asked)
        if item is None:
            return ack(client, asked.mission_type, MissionResult.INVALID)
        relative = item.frame in RELATIVE
        try:
            place = place_ned(
                self._vehicle, self._profile, item.x * 1e-7, item.y * 1e-7, item.z, relative
            )
        except BadSetpointError:
            return ack(client, asked.mission_type, MissionResult.INVALID)
        if asked.current == GUIDED_HEIGHT:
            here = self._vehicle.estimate.pos_ned
            place = (here[0], here[1], place[2])
        result = self._vehicle.reposition(place, None, None)
        return ack(
            client,
            asked.mission_type,
            MissionResult.ACCEPTED if result is Result.ACCEPTED else MissionResult.ERROR,
        )

    # -------------------------------------------------------------- download and the rest

    def request_list(self, client: Client, asked: m.MissionRequestList) -> list[Effect]:
        if asked.mission_type not in PLAN_TYPES:
            return [ack(client, asked.mission_type, MissionResult.UNSUPPORTED)]
        kind = MissionType(asked.mission_type)
        count = m.MissionCount(
            count_=len(self._plans.plan(kind)),
            target_system=client.system,
            target_component=client.component,
            mission_type=kind,
            opaque_id=self._plans.opaque_id(kind),
        )
        return [Send(client.channel, count)]

    def request(
        self, client: Client, asked: m.MissionRequest | m.MissionRequestInt
    ) -> list[Effect]:
        if asked.mission_type not in PLAN_TYPES:
            return [ack(client, asked.mission_type, MissionResult.UNSUPPORTED)]
        items = self._plans.plan(MissionType(asked.mission_type))
        if asked.seq < len(items):
            item = items[asked.seq]
        elif asked.seq == 0 and self._home_can_be_read(asked.mission_type):
            item = NOTHING
        else:
            return [ack(client, asked.mission_type, self._profile.no_such_item)]
        if not self._profile.home_is_item_0:
            flown = asked.mission_type == MissionType.MISSION
            item = as_px4_gives_back(item) if flown else place_as_px4_gives_back(item)
        elif asked.mission_type == MissionType.MISSION:
            item = as_ardupilot_gives_back(item, self._vehicle.home)
        if isinstance(asked, m.MissionRequest) and self._profile.float_items:
            return [Send(client.channel, to_float(item, client, asked.mission_type))]
        return [Send(client.channel, to_int(item, client, asked.mission_type))]

    def _home_can_be_read(self, kind: int) -> bool:
        """ArduPilot gives item 0 of an empty mission too.

        DroneKit asks for it after a count of 0.
        """
        home = self._vehicle.home if self._profile.home_is_item_0 else None
        return kind == MissionType.MISSION and home is not None

    def clear(self, client: Client, asked: m.MissionClearAll) -> list[Effect]:
        if asked.mission_type == MissionType.ALL:
            kinds = list(PLAN_TYPES)
        elif asked.mission_type in PLAN_TYPES:
            kinds = [MissionType(asked.mission_type)]
        else:
            return [ack(client, asked.mission_type, MissionResult.UNSUPPORTED)]
        if self._uploads.busy_for(client):
            return [ack(client, asked.mission_type, MissionResult.DENIED)]
        self._uploads.abandon()
        for kind in kinds:
            self._plans.store(kind, ())
        return [ack(client, asked.mission_type, MissionResult.ACCEPTED)]

    def set_current(self, client: Client, asked: m.MissionSetCurrent) -> list[Effect]:
        """MISSION_CURRENT is the answer to one that is carried out; the caller sends it."""
        if self._vehicle.mission_set_current(asked.seq) is Result.ACCEPTED:
            return []
        return [ack(client, MissionType.MISSION, MissionResult.INVALID_SEQUENCE)]
