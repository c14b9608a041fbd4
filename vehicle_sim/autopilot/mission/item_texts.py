"""What ArduCopter says of the items of its mission, when it begins and when it reaches them."""

from __future__ import annotations

from vehicle_sim.autopilot.interface import PlanItem, StatusText
from vehicle_sim.autopilot.mission.mission_commands import MissionVehicle
from vehicle_sim.autopilot.mission.plan import KINDS, Cmd, ItemKind

COPTER_ITEMS: dict[int, str] = {
    Cmd.WAYPOINT: "WP",
    Cmd.LOITER_UNLIM: "LoitUnlim",
    Cmd.LOITER_TURNS: "LoitTurns",
    Cmd.LOITER_TIME: "LoitTime",
    Cmd.RETURN: "RTL",
    Cmd.LAND: "Land",
    Cmd.TAKEOFF: "Takeoff",
    Cmd.LOITER_TO_ALT: "LoitAltitude",
    Cmd.SPLINE: "SplineWP",
    Cmd.DELAY: "Delay",
    Cmd.CONDITION_DELAY: "CondDelay",
    Cmd.CONDITION_DISTANCE: "CondDist",
    Cmd.CONDITION_YAW: "CondYaw",
    Cmd.CHANGE_SPEED: "ChangeSpeed",
    Cmd.SET_HOME: "SetHome",
    Cmd.ROI: "SetROI",
    Cmd.GUIDED_ENABLE: "NavGuidedEnable",
    Cmd.PAYLOAD_PLACE: "PayloadPlace",
    Cmd.SET_RELAY: "SetRelay",
    Cmd.REPEAT_RELAY: "RepeatRelay",
    Cmd.SET_SERVO: "SetServo",
    Cmd.REPEAT_SERVO: "RepeatServo",
    Cmd.PARACHUTE: "Parachute",
    Cmd.GRIPPER: "Gripper",
    Cmd.AUX_FUNCTION: "AuxFunction",
    Cmd.GUIDED_LIMITS: "GuidedLimits",
    Cmd.JUMP_TAG: "Tag",
    Cmd.WINCH: "Winch",
}
"""What ArduCopter calls an item that it begins: "WP", "Takeoff", "RTL" and "SetROI" as recorded,
the others from memory of AP_Mission."""

_TOLD_WHEN_REACHED = frozenset({Cmd.WAYPOINT, Cmd.SPLINE})
_INFO = 6  # MAV_SEVERITY


class ItemTexts:
    """Each item is named once when it begins; those that a mission begins with, with the mission.

    `tells`: whether this autopilot says anything of them (PX4 does not).
    """

    __slots__ = ("_circles", "_named_up_to", "_tells", "_vehicle")

    def __init__(self, vehicle: MissionVehicle, tells: bool) -> None:
        self._vehicle = vehicle
        self._tells = tells
        self._named_up_to = -1
        self._circles: int | None = None

    def begin(self, items: tuple[PlanItem, ...]) -> None:
        """A mission begins with the first of `items`: all up to the first flown one are named."""
        for item in items:
            self._name(item)
            self._named_up_to = item.seq
            if KINDS[item.command] is ItemKind.FLOWN:
                break

    def start(self, item: PlanItem) -> None:
        """An item begins."""
        self._circles = None
        if item.seq > self._named_up_to:
            self._name(item)
        elif KINDS[item.command] is ItemKind.FLOWN:
            self._named_up_to = -1

    def circling(self, item: PlanItem, completed: int | None) -> None:
        """A whole circle of LOITER_TURNS is over, or the first begins (0); the last one, too, is
        followed by the number of a next one, as recorded."""
        if self._tells and completed != self._circles and completed is not None:
            text = f"Mission: starting circle {completed + 1}/{int(item.p1)}"
            self._vehicle.emit(StatusText(_INFO, text))
        self._circles = completed

    def reached(self, item: PlanItem) -> None:
        if self._tells and item.command in _TOLD_WHEN_REACHED:
            self._vehicle.emit(StatusText(_INFO, f"Reached command #{item.seq}"))

    def _name(self, item: PlanItem) -> None:
        if not self._tells:
            return
        self._vehicle.emit(
            StatusText(_INFO, f"Mission: {item.seq} {COPTER_ITEMS.get(item.command, '')}")
        )
        if item.command == Cmd.DELAY:
            self._vehicle.emit(StatusText(_INFO, f"Delaying {int(item.p1)} sec"))
