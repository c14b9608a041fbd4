"""What a mission does beside flying: speed, home, camera, region of interest, and when.

The items between two flown ones are done while the second is flown to, one after another; a
condition among them (CONDITION_DELAY, _DISTANCE, _YAW) holds up those that follow it, never the
flight.  What is still held up when the next flown item begins is left out, as in ArduPilot.
"""

from __future__ import annotations

from collections import deque
from math import hypot, isfinite, radians
from typing import Protocol

from vehicle_sim.autopilot.control.demands import Situation, Turner
from vehicle_sim.autopilot.interface import (
    MissionReached,
    PlanItem,
    Result,
    StatusText,
    VehicleEvent,
)
from vehicle_sim.autopilot.mission.plan import KINDS, Cmd, Datum, ItemKind, has_place, place_of
from vehicle_sim.autopilot.tasks.guided_limits import GuidedLimits
from vehicle_sim.autopilot.tasks.tasks import distance, face
from vehicle_sim.numerics.vectors import Vec3


class MissionVehicle(Protocol):
    """What a mission may ask of the rest of the vehicle."""

    def emit(self, event: VehicleEvent) -> None: ...
    def datum(self) -> Datum: ...
    def take_pictures(self, interval_s: float, count: int) -> None: ...
    def stop_pictures(self) -> None: ...
    def change_speed(self, kind: float, speed_m_s: float | None) -> None:
        """`kind`: a SPEED_TYPE."""
        ...

    def move_home(self, where_ned: Vec3 | None) -> None: ...
    def turn_nose(self, yaw_rad: float, rate_rad_s: float, direction: int) -> None: ...
    def nose_turns(self) -> bool: ...
    def enable_fence(self, choice: int) -> Result: ...
    def actuate(self, item: PlanItem) -> None:
        """Servos and relays."""
        ...

    def leave_without_terrain(self) -> bool:
        """Give up an item whose height counts from the terrain, of which nothing is known."""
        ...

    def leave_for_return(self) -> bool:
        """Change to the return mode; False where the personality returns within the mission."""
        ...


class MissionCommands:
    """Carries out what is put on its list, and keeps up what lasts."""

    __slots__ = (
        "_begun",
        "_last_shot_ned",
        "_list",
        "_reports",
        "_roi_ned",
        "_trigger_m",
        "_until_ns",
        "_vehicle",
        "guided_limits",
    )

    def __init__(self, vehicle: MissionVehicle, reports: bool = False) -> None:
        """`reports`: what is done counts as reached, as in PX4; MAVSDK tells the end by it."""
        self._vehicle = vehicle
        self._reports = reports
        self.forget()

    def forget(self) -> None:
        self.guided_limits = GuidedLimits()
        self._roi_ned: Vec3 | None = None
        self._trigger_m = 0.0
        self._last_shot_ned: Vec3 | None = None
        self._list: deque[PlanItem] = deque()
        self.drop()

    def put(self, item: PlanItem) -> None:
        """The next on the list."""
        self._list.append(item)

    def drop(self) -> None:
        """Leave out what has not been done yet."""
        self._list.clear()
        self._begun = False
        self._until_ns = 0

    @property
    def idle(self) -> bool:
        return not self._list

    def run_commands(self, s: Situation, goal_ned: Vec3 | None) -> None:
        """Down the list, as far as no condition holds it up; `goal_ned` is what is flown to."""
        while self._list:
            item = self._list[0]
            match KINDS[item.command]:
                case ItemKind.WAITED:
                    if not self._begun:
                        self._begun = True
                        self._await(item, s)
                    if not self._met(item, s, goal_ned):
                        return
                    self._begun = False
                case ItemKind.DONE:
                    self._do(item, s)
                case _:
                    text = f"Mission item {item.seq}: no such equipment, passed over"
                    self._vehicle.emit(StatusText(6, text))
            self._list.popleft()
            if self._reports:
                self._vehicle.emit(MissionReached(item.seq))

    def _await(self, item: PlanItem, s: Situation) -> None:
        if item.command == Cmd.CONDITION_DELAY:
            self._until_ns = s.time_ns + int(item.p1 * 1e9)
        elif item.command == Cmd.CONDITION_YAW:
            yaw_rad = radians(item.p1)
            if item.p4 == 1.0:
                yaw_rad = s.heading_rad + (yaw_rad if item.p3 >= 0.0 else -yaw_rad)
            rate_rad_s = radians(item.p2) if isfinite(item.p2) else 0.0
            self._vehicle.turn_nose(yaw_rad, rate_rad_s, int(item.p3) if isfinite(item.p3) else 0)

    def _met(self, item: PlanItem, s: Situation, goal_ned: Vec3 | None) -> bool:
        match item.command:
            case Cmd.CONDITION_DELAY:
                return s.time_ns >= self._until_ns
            case Cmd.CONDITION_DISTANCE:
                if goal_ned is None:
                    return True
                north, east = goal_ned[0] - s.pos_ned[0], goal_ned[1] - s.pos_ned[1]
                return hypot(north, east) <= item.p1
            case _:
                return not self._vehicle.nose_turns()

    def _do(self, item: PlanItem, s: Situation) -> None:
        vehicle = self._vehicle
        match item.command:
            case Cmd.CHANGE_SPEED:
                if item.p2 != -1.0:
                    vehicle.change_speed(item.p1, item.p2 if item.p2 > 0.0 else None)
            case Cmd.SET_HOME:
                here = item.p1 == 1.0
                vehicle.move_home(None if here else place_of(item, vehicle.datum(), s.pos_ned))
            case Cmd.FENCE_ENABLE:
                vehicle.enable_fence(int(item.p1))
            case Cmd.SET_SERVO | Cmd.REPEAT_SERVO | Cmd.SET_RELAY | Cmd.REPEAT_RELAY:
                vehicle.actuate(item)
            case Cmd.GUIDED_LIMITS:
                self.guided_limits = GuidedLimits(item.p1, item.p2, item.p3, item.p4)
            case Cmd.ROI_NONE:
                self._roi_ned = None
            case Cmd.ROI_LOCATION | Cmd.ROI:
                none = item.command == Cmd.ROI and not has_place(item)
                self._roi_ned = None if none else place_of(item, vehicle.datum(), s.pos_ned)
            case Cmd.DIGICAM_CONTROL:
                if item.x != 0:
                    vehicle.take_pictures(0.0, 1)
            case Cmd.IMAGE_START:
                count = int(item.p3) if isfinite(item.p3) else 1
                vehicle.take_pictures(item.p2 if isfinite(item.p2) else 0.0, count)
            case Cmd.IMAGE_STOP:
                vehicle.stop_pictures()
            case Cmd.CAM_TRIGG_DIST:
                self._trigger_m = item.p1 if isfinite(item.p1) and item.p1 > 0.0 else 0.0
                self._last_shot_ned = None if item.p3 == 1.0 else s.pos_ned
            case _:
                pass

    def update_payload(self, s: Situation, turner: Turner) -> None:
        """Point at the region of interest; take the picture that is due by distance."""
        if self._roi_ned is not None:
            face(self._roi_ned, s, turner)
        if self._trigger_m > 0.0:
            last = self._last_shot_ned
            if last is None or distance(last, s.pos_ned) >= self._trigger_m:
                self._last_shot_ned = s.pos_ned
                self._vehicle.take_pictures(0.0, 1)
