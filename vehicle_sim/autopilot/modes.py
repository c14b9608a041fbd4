"""The flight modes, one literal table per personality: numbers, flags and what they fly."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum, IntFlag
from typing import Literal, TypeAlias

Personality: TypeAlias = Literal["px4", "ardupilot"]


class Behaviour(Enum):
    """What a mode makes the vehicle do while nobody has touched the sticks."""

    LEVEL = "level"  # a manual mode: without sticks level, height held, drifting with the air
    HOLD = "hold"
    GUIDED = "guided"  # flown from outside by setpoints
    TAKEOFF = "takeoff"
    MISSION = "mission"
    RETURN = "return"
    LAND = "land"
    ORBIT = "orbit"  # round a centre that was asked for (PX4's DO_ORBIT)
    CIRCLE = "circle"  # round a point ahead (ArduCopter's CIRCLE)
    FOLLOW = "follow"


class StickLaw(Enum):
    """What the sticks mean in a mode that is flown by hand."""

    RATES = "rates"  # body rates and thrust
    ANGLE = "angle"  # lean angles and thrust
    ALTITUDE = "altitude"  # lean angles and climb rate
    POSITION = "position"  # velocity over ground and climb rate; centred = stay
    LEAN_AND_STAY = "lean and stay"  # lean angles and climb rate; centred = stay


class Flag(IntFlag):
    """MAV_MODE_FLAG."""

    CUSTOM_MODE_ENABLED = 1
    AUTO_ENABLED = 4
    GUIDED_ENABLED = 8
    STABILIZE_ENABLED = 16
    MANUAL_INPUT_ENABLED = 64
    SAFETY_ARMED = 128


class Property(IntFlag):
    """MAV_MODE_PROPERTY."""

    NONE = 0
    ADVANCED = 1
    NOT_USER_SELECTABLE = 2


@dataclass(frozen=True, slots=True)
class Mode:
    """`custom_mode` is HEARTBEAT's; `flags` is base_mode without the armed bit.

    `needs_stream`: it is entered, and kept, only while setpoints come.  `enabled_by` is the
    parameter without which it is refused.
    """

    name: str
    custom_mode: int
    behaviour: Behaviour
    flags: int
    may_arm: bool
    needs_position: bool
    law: StickLaw | None = None
    properties: Property = Property.NONE
    needs_stream: bool = False
    enabled_by: str | None = None


def _px4(main: int, sub: int = 0) -> int:
    """px4_custom_mode: main mode in the third byte, sub mode in the fourth."""
    return main << 16 | sub << 24


_C = Flag.CUSTOM_MODE_ENABLED
_PX4_ACRO = int(_C | Flag.MANUAL_INPUT_ENABLED)
_PX4_STICKS = int(_C | Flag.MANUAL_INPUT_ENABLED | Flag.STABILIZE_ENABLED)
_PX4_STABLE = int(_C | Flag.STABILIZE_ENABLED)
_PX4_AUTO = int(_C | Flag.AUTO_ENABLED | Flag.STABILIZE_ENABLED | Flag.GUIDED_ENABLED)
_AP = int(_C | Flag.MANUAL_INPUT_ENABLED | Flag.STABILIZE_ENABLED)
_AP_GUIDED = int(_AP | Flag.GUIDED_ENABLED)

_B = Behaviour
_S = StickLaw
_ADV = Property.ADVANCED
_HID = Property.NOT_USER_SELECTABLE
# fmt: off
PX4_MODES = (
    #     name                 custom_mode  behaviour    flags      may_arm needs_position
    Mode("MANUAL",             _px4(1),    _B.LEVEL,   _PX4_STICKS, True,  False, _S.ANGLE, _ADV),
    Mode("ALTCTL",             _px4(2),    _B.LEVEL,   _PX4_STICKS, True,  False, _S.ALTITUDE),
    Mode("POSCTL",             _px4(3),    _B.HOLD,    _PX4_STICKS, True,  True,  _S.POSITION),
    Mode("POSCTL.ORBIT",       _px4(3, 1), _B.ORBIT,   _PX4_STABLE, False, True,  None, _HID),
    Mode("ACRO",               _px4(5),    _B.LEVEL,   _PX4_ACRO,   True,  False, _S.RATES, _ADV),
    Mode("STABILIZED",         _px4(7),    _B.LEVEL,   _PX4_STICKS, True,  False, _S.ANGLE, _ADV),
    Mode("OFFBOARD",           _px4(6),    _B.GUIDED,  _PX4_STABLE, True,  True,  None, _ADV,
         needs_stream=True),
    Mode("AUTO.TAKEOFF",       _px4(4, 2), _B.TAKEOFF, _PX4_AUTO,   True,  True),
    Mode("AUTO.LOITER",        _px4(4, 3), _B.HOLD,    _PX4_AUTO,   True,  True),
    Mode("AUTO.MISSION",       _px4(4, 4), _B.MISSION, _PX4_AUTO,   True,  True),
    Mode("AUTO.RTL",           _px4(4, 5), _B.RETURN,  _PX4_AUTO,   False, True),
    Mode("AUTO.LAND",          _px4(4, 6), _B.LAND,    _PX4_AUTO,   False, False),
    Mode("AUTO.FOLLOW_TARGET", _px4(4, 8), _B.FOLLOW,  _PX4_AUTO,   False, True),
)
ARDUPILOT_MODES = (
    Mode("STABILIZE", 0,  _B.LEVEL,   _AP,        True,  False, _S.ANGLE),
    Mode("ACRO",      1,  _B.LEVEL,   _AP,        True,  False, _S.RATES, _ADV),
    Mode("ALT_HOLD",  2,  _B.LEVEL,   _AP,        True,  False, _S.ALTITUDE),
    Mode("AUTO",      3,  _B.MISSION, _AP_GUIDED, True,  True),
    Mode("GUIDED",    4,  _B.GUIDED,  _AP_GUIDED, True,  True),
    Mode("LOITER",    5,  _B.HOLD,    _AP_GUIDED, True,  True,  _S.POSITION),
    Mode("RTL",       6,  _B.RETURN,  _AP_GUIDED, False, True),
    Mode("CIRCLE",    7,  _B.CIRCLE,  _AP_GUIDED, False, True),
    Mode("LAND",      9,  _B.LAND,    _AP_GUIDED, False, False),
    Mode("POSHOLD",   16, _B.HOLD,    _AP_GUIDED, True,  True,  _S.LEAN_AND_STAY),
    Mode("BRAKE",     17, _B.HOLD,    _AP_GUIDED, False, True),
    Mode("FOLLOW",    23, _B.FOLLOW,  _AP_GUIDED, False, True,  enabled_by="FOLL_ENABLE"),
)

# Modes that clients know by number and that this vehicle does not fly.
REFUSED: dict[Personality, dict[int, str]] = {
    "px4": {
        _px4(4, 1): "AUTO.READY",
        _px4(4, 7): "AUTO.RTGS",
        _px4(4, 9): "AUTO.PRECLAND",
        _px4(4, 10): "AUTO.VTOL_TAKEOFF",
        _px4(8): "RATTITUDE",
    },
    "ardupilot": {
        11: "DRIFT",
        13: "SPORT",
        14: "FLIP",
        15: "AUTOTUNE",
        18: "THROW",
        19: "AVOID_ADSB",
        20: "GUIDED_NOGPS",
        21: "SMARTRTL",
        22: "FLOWHOLD",
        24: "ZIGZAG",
        25: "SYSTEMID",
        27: "AUTO_RTL",
        28: "TURTLE",
    },
}
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
        "orbit": "POSCTL.ORBIT",
        "follow": "AUTO.FOLLOW_TARGET",
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
        "orbit": "CIRCLE",
        "follow": "FOLLOW",
    },
}
"""What each personality calls a mode that is asked for by its meaning."""

_NO_SUCH_MODE: dict[Personality, tuple[int, str]] = {
    "px4": (2, "Unsupported auto mode"),
    "ardupilot": (4, "No such mode {number}"),
}
_WILL_NOT: dict[Personality, tuple[int, str]] = {
    "px4": (2, "Switching to {mode} is currently not available"),
    "ardupilot": (4, "Mode change to {mode} failed: {why}"),
}
_NOT_FLOWN_HERE: dict[Personality, tuple[int, str]] = {
    "px4": _NO_SUCH_MODE["px4"],
    "ardupilot": _WILL_NOT["ardupilot"],
}
"""Of a mode that the real autopilot has, and this one has not."""

COPTER_NAMES: dict[str, str] = {
    "STABILIZE": "Stabilize",
    "ACRO": "Acro",
    "ALT_HOLD": "Altitude Hold",
    "AUTO": "Auto",
    "GUIDED": "Guided",
    "LOITER": "Loiter",
    "CIRCLE": "Circle",
    "LAND": "Land",
    "POSHOLD": "Position Hold",
    "BRAKE": "Brake",
    "FOLLOW": "Follow",
}
"""What ArduCopter's own texts call its modes: "Auto" as recorded, the others from memory."""

_SPOKEN: dict[Personality, Callable[[str], str]] = {
    "px4": lambda name: name.replace(".", "_"),
    "ardupilot": lambda name: COPTER_NAMES.get(name, name),
}
"""A mode's name in a text."""


def main_mode(custom_mode: int) -> int:
    """PX4's, from HEARTBEAT.custom_mode."""
    return custom_mode >> 16 & 0xFF


AUTO_MAIN_MODE = 4


def by_number(personality: Personality, custom_mode: int) -> Mode | None:
    """The mode with this HEARTBEAT.custom_mode; None where there is none."""
    for mode in MODES[personality].values():
        if mode.custom_mode == custom_mode:
            return mode
    return None


def unknown_mode_words(personality: Personality, custom_mode: int) -> tuple[int, str]:
    """MAV_SEVERITY and STATUSTEXT for a number that is no mode, or one that is not flown here."""
    name = REFUSED[personality].get(custom_mode)
    if name is None:
        severity, text = _NO_SUCH_MODE[personality]
        return severity, text.format(number=custom_mode)
    severity, text = _NOT_FLOWN_HERE[personality]
    return severity, text.format(mode=_SPOKEN[personality](name), why="init failed")


def refusal_words(personality: Personality, name: str, why: str) -> tuple[int, str]:
    """MAV_SEVERITY and STATUSTEXT for a mode that cannot be entered now."""
    severity, text = _WILL_NOT[personality]
    return severity, text.format(mode=_SPOKEN[personality](name), why=why)
