"""What a mission does beside flying: speed, home, camera, region of interest."""

from __future__ import annotations

from math import isfinite
from typing import Protocol

from vehicle_sim.autopilot.demands import Situation, Turner
from vehicle_sim.autopilot.interface import PlanItem, Vec3, VehicleEvent
from vehicle_sim.autopilot.plan import Cmd, Datum, place_of
from vehicle_sim.autopilot.tasks import distance, face


class Crew(Protocol):
    """What a mission may ask of the rest of the vehicle."""

    def emit(self, event: VehicleEvent) -> None: ...
    def datum(self) -> Datum: ...
    def take_pictures(self, interval_s: float, count: int) -> None: ...
    def stop_pictures(self) -> None: ...
    def cruise_at(self, speed_m_s: float | None) -> None: ...
    def move_home(self, where_ned: Vec3 | None) -> None: ...
    def turn_nose(self, yaw_rad: float, rate_rad_s: float, direction: int) -> None: ...
    def nose_turns(self) -> bool: ...
    def leave_for_return(self) -> bool:
        """Change to the return mode; False where the personality returns within the mission."""
        ...


class Errands:
    """Carries out the items that happen at once, and keeps up those that last."""

    __slots__ = ("_crew", "_last_shot_ned", "_roi_ned", "_trigger_m")

    def __init__(self, crew: Crew) -> None:
        self._crew = crew
        self.forget()

    def forget(self) -> None:
        self._roi_ned: Vec3 | None = None
        self._trigger_m = 0.0
        self._last_shot_ned: Vec3 | None = None

    def do(self, item: PlanItem, s: Situation) -> None:
        crew = self._crew
        match item.command:
            case Cmd.CHANGE_SPEED:
                if item.p1 in (0.0, 1.0) and item.p2 != -1.0:
                    crew.cruise_at(item.p2 if item.p2 > 0.0 else None)
            case Cmd.SET_HOME:
                here = item.p1 == 1.0
                crew.move_home(None if here else place_of(item, crew.datum(), s.pos_ned))
            case Cmd.ROI_LOCATION | Cmd.ROI:
                self._roi_ned = place_of(item, crew.datum(), s.pos_ned)
            case Cmd.ROI_NONE:
                self._roi_ned = None
            case Cmd.DIGICAM_CONTROL:
                if item.x == 1:
                    crew.take_pictures(0.0, 1)
            case Cmd.IMAGE_START:
                count = int(item.p3) if isfinite(item.p3) else 1
                crew.take_pictures(item.p2 if isfinite(item.p2) else 0.0, count)
            case Cmd.IMAGE_STOP:
                crew.stop_pictures()
            case Cmd.CAM_TRIGG_DIST:
                self._trigger_m = item.p1 if isfinite(item.p1) and item.p1 > 0.0 else 0.0
                self._last_shot_ned = None if item.p3 == 1.0 else s.pos_ned
            case _:
                pass

    def attend(self, s: Situation, turner: Turner) -> None:
        """Point at the region of interest; take the picture that is due by distance."""
        if self._roi_ned is not None:
            face(self._roi_ned, s, turner)
        if self._trigger_m > 0.0:
            last = self._last_shot_ned
            if last is None or distance(last, s.pos_ned) >= self._trigger_m:
                self._last_shot_ned = s.pos_ned
                self._crew.take_pictures(0.0, 1)
