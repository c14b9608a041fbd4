"""How recordings name modes, answers and items, and their numbers on the wire."""

from __future__ import annotations

import math
from typing import Any, Final

from pymavlink.dialects.v20 import all as mavlink

from tests.scenarios.facts import Item
from vehicle_sim.autopilot.modes import Personality

PX4_MODES: Final = {
    (1, 0): "MANUAL",
    (2, 0): "ALTCTL",
    (3, 0): "POSCTL",
    (3, 1): "ORBIT",
    (4, 2): "AUTO.TAKEOFF",
    (4, 3): "AUTO.LOITER",
    (4, 4): "AUTO.MISSION",
    (4, 5): "AUTO.RTL",
    (4, 6): "AUTO.LAND",
    (4, 10): "AUTO.VTOL_TAKEOFF",
    (5, 0): "ACRO",
    (6, 0): "OFFBOARD",
    (7, 0): "STABILIZED",
}


def mode_numbers(personality: Personality, name: str) -> tuple[int, int]:
    """Parameters 2 and 3 of DO_SET_MODE."""
    if personality == "px4":
        return next(pair for pair, mode in PX4_MODES.items() if mode == name)
    modes = mavlink.enums["COPTER_MODE"].items()
    return (next(n for n, mode in modes if mode.name == f"COPTER_MODE_{name}"), 0)


def mode_name(personality: Personality, custom_mode: int) -> str:
    if personality == "px4":
        return PX4_MODES.get((custom_mode >> 16 & 0xFF, custom_mode >> 24), str(custom_mode))
    name: str = mavlink.enums["COPTER_MODE"][custom_mode].name
    return name.removeprefix("COPTER_MODE_")


def mission_ack(acks: list[Any]) -> str | None:
    return mavlink.enums["MAV_MISSION_RESULT"][acks[-1].type].name if acks else None


def plan_item(item: Item, seq: int, kind: int) -> Any:
    frame, name, *rest = item
    values = [math.nan if value is None else value for value in rest]
    number = next(k for k, entry in mavlink.enums["MAV_CMD"].items() if entry.name == name)
    x, y = (0 if math.isnan(value) else int(value) for value in values[4:6])
    return mavlink.MAVLink_mission_item_int_message(
        1, 1, seq, frame, number, 0, 1, *values[:4], x, y, values[6], kind
    )
