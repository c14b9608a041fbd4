"""The flight modes, one literal table per personality: numbers, flags and what they fly."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum, IntFlag
from typing import Literal, TypeAlias

Personality: TypeAlias = Literal["px4", "ardupilot"]


class Behaviour(Enum):
    """What a mode makes the vehicle do."""

    LEVEL = "level"  # a manual mode: without sticks level, height held, drifting with the air
    HOLD = "hold"
    GUIDED = "guided"  # flown from outside by setpoints
    TAKEOFF = "takeoff"
    MISSION = "mission"
    RETURN = "return"
    LAND = "land"


class Flag(IntFlag):
    """MAV_MODE_FLAG."""

    CUSTOM_MODE_ENABLED = 1
    AUTO_ENABLED = 4
    GUIDED_ENABLED = 8
    STABILIZE_ENABLED = 16
    MANUAL_INPUT_ENABLED = 64
    SAFETY_ARMED = 128


@dataclass(frozen=True, slots=True)
class Mode:
    """`custom_mode` is HEARTBEAT's; `flags` is base_mode without the armed bit."""

    name: str
    custom_mode: int
    behaviour: Behaviour
    flags: int
    may_arm: bool
    needs_position: bool


def _px4(main: int, sub: int = 0) -> int:
    """px4_custom_mode: main mode in the third byte, sub mode in the fourth."""
    return main << 16 | sub << 24


_C = Flag.CUSTOM_MODE_ENABLED
_PX4_STICKS = int(_C | Flag.MANUAL_INPUT_ENABLED | Flag.STABILIZE_ENABLED)
_PX4_POSCTL = int(_PX4_STICKS | Flag.GUIDED_ENABLED)
_PX4_AUTO = int(_C | Flag.AUTO_ENABLED | Flag.STABILIZE_ENABLED | Flag.GUIDED_ENABLED)
_AP = int(_C | Flag.MANUAL_INPUT_ENABLED | Flag.STABILIZE_ENABLED)
_AP_GUIDED = int(_AP | Flag.GUIDED_ENABLED)

_B = Behaviour
# fmt: off
PX4_MODES = (
    #     name            custom_mode  behaviour    flags        may_arm  needs_position
    Mode("MANUAL",        _px4(1),     _B.LEVEL,    _PX4_STICKS, True,    False),
    Mode("ALTCTL",        _px4(2),     _B.LEVEL,    _PX4_STICKS, True,    False),
    Mode("POSCTL",        _px4(3),     _B.HOLD,     _PX4_POSCTL, True,    True),
    Mode("STABILIZED",    _px4(7),     _B.LEVEL,    _PX4_STICKS, True,    False),
    Mode("OFFBOARD",      _px4(6),     _B.GUIDED,   _PX4_AUTO,   True,    True),
    Mode("AUTO.TAKEOFF",  _px4(4, 2),  _B.TAKEOFF,  _PX4_AUTO,   True,    True),
    Mode("AUTO.LOITER",   _px4(4, 3),  _B.HOLD,     _PX4_AUTO,   True,    True),
    Mode("AUTO.MISSION",  _px4(4, 4),  _B.MISSION,  _PX4_AUTO,   True,    True),
    Mode("AUTO.RTL",      _px4(4, 5),  _B.RETURN,   _PX4_AUTO,   False,   True),
    Mode("AUTO.LAND",     _px4(4, 6),  _B.LAND,     _PX4_AUTO,   False,   False),
)
ARDUPILOT_MODES = (
    Mode("STABILIZE",     0,           _B.LEVEL,    _AP,         True,    False),
    Mode("ALT_HOLD",      2,           _B.LEVEL,    _AP,         True,    False),
    Mode("AUTO",          3,           _B.MISSION,  _AP_GUIDED,  True,    True),
    Mode("GUIDED",        4,           _B.GUIDED,   _AP_GUIDED,  True,    True),
    Mode("LOITER",        5,           _B.HOLD,     _AP_GUIDED,  True,    True),
    Mode("RTL",           6,           _B.RETURN,   _AP_GUIDED,  False,   True),
    Mode("LAND",          9,           _B.LAND,     _AP,         False,   False),
    Mode("POSHOLD",       16,          _B.HOLD,     _AP_GUIDED,  True,    True),
    Mode("BRAKE",         17,          _B.HOLD,     _AP_GUIDED,  False,   True),
)
# fmt: on

MODES: dict[Personality, dict[str, Mode]] = {
    "px4": {mode.name: mode for mode in PX4_MODES},
    "ardupilot": {mode.name: mode for mode in ARDUPILOT_MODES},
}

BOOT_MODE: dict[Personality, str] = {"px4": "AUTO.LOITER", "ardupilot": "STABILIZE"}

KINDS: dict[Personality, dict[str, str]] = {
    "px4": {
        "hold": "AUTO.LOITER",
        "brake": "AUTO.LOITER",
        "position": "POSCTL",
        "altitude": "ALTCTL",
        "manual": "MANUAL",
        "guided": "OFFBOARD",
        "mission": "AUTO.MISSION",
        "return": "AUTO.RTL",
        "land": "AUTO.LAND",
    },
    "ardupilot": {
        "hold": "LOITER",
        "brake": "BRAKE",
        "position": "POSHOLD",
        "altitude": "ALT_HOLD",
        "manual": "STABILIZE",
        "guided": "GUIDED",
        "mission": "AUTO",
        "return": "RTL",
        "land": "LAND",
    },
}
"""What each personality calls a mode that is asked for by its meaning."""


def by_number(personality: Personality, custom_mode: int) -> Mode | None:
    """The mode with this HEARTBEAT.custom_mode; None where there is none."""
    for mode in MODES[personality].values():
        if mode.custom_mode == custom_mode:
            return mode
    return None
