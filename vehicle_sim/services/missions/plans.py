"""The plans that a vehicle keeps: its mission, its fence, its rally points."""

from __future__ import annotations

from typing import Final

from vehicle_sim.autopilot.interface import Flaw, PlanItem, Vehicle
from vehicle_sim.services.missions.plan_items import opaque_id
from vehicle_sim.services.profile import PLAN_TYPES, Profile
from vehicle_sim.wire.ids import MissionResult, MissionType

FLAWS: Final = {
    Flaw.COMMAND: MissionResult.UNSUPPORTED,
    Flaw.FRAME: MissionResult.UNSUPPORTED_FRAME,
    Flaw.PARAM1: MissionResult.INVALID_PARAM1,
    Flaw.PLACE: MissionResult.INVALID_PARAM5_X,
    Flaw.WHOLE: MissionResult.ERROR,
}
"""What the ack of a fence or of rally points says."""


class Plans:
    """What is stored is whole: a plan is swapped in one step, after it was checked."""

    def __init__(self, vehicle: Vehicle, profile: Profile) -> None:
        self._vehicle = vehicle
        self._profile = profile
        self._stored: dict[MissionType, tuple[PlanItem, ...]] = {}
        self._ids: dict[MissionType, tuple[tuple[PlanItem, ...], int]] = {}

    def plan(self, kind: MissionType) -> tuple[PlanItem, ...]:
        if kind is MissionType.MISSION:
            return self._vehicle.plan
        return self._stored.get(kind, ())

    def opaque_id(self, kind: MissionType) -> int:
        """Of the plan that is stored; 0 where the firmware numbers none.  It is worked out once."""
        if not self._profile.numbers_plans:
            return 0
        items = self.plan(kind)
        known, number = self._ids.get(kind, ((), 0))
        if known is not items:
            number = opaque_id(items)
            self._ids[kind] = (items, number)
        return number

    def summary(self) -> tuple[int, int, int, int]:
        """For MISSION_CURRENT: number of mission items; ids of mission, fence and rally points.

        ArduPilot does not count home.
        """
        mission, fence, rally = (self.opaque_id(kind) for kind in PLAN_TYPES)
        count = len(self._vehicle.plan)
        if self._profile.home_is_item_0:
            count = max(0, count - 1)
        return count, mission, fence, rally

    def check(
        self, kind: MissionType, items: tuple[PlanItem, ...]
    ) -> tuple[int, str, MissionResult] | None:
        """The first item that is refused, why, and what the ack says."""
        if kind is MissionType.MISSION:
            bad = self._vehicle.check_plan(items)
            return None if bad is None else (*bad, MissionResult.UNSUPPORTED)
        fence = kind is MissionType.FENCE
        refusal = (self._vehicle.check_fence if fence else self._vehicle.check_rally)(items)
        if refusal is None:
            return None
        return refusal.seq, refusal.why, FLAWS[refusal.flaw]

    def store(self, kind: MissionType, items: tuple[PlanItem, ...]) -> None:
        """Swap; only what `check` had nothing against."""
        if kind is MissionType.MISSION:
            self._vehicle.load_plan(items)
            return
        if kind is MissionType.FENCE:
            self._vehicle.load_fence(items)
        else:
            self._vehicle.load_rally(items)
        self._stored[kind] = items
