"""Which EVENT PX4 1.14 sends with each of its texts, and with what arguments.

Ids, log levels and arguments as recorded from PX4 1.14.3.  An id is the component (1: the
autopilot) in the upper 8 bits, and 24 bits of a hash of the event's name; so the same happening has
the same id in every version that knows it.  Arguments are packed little-endian, in the order of the
event's definition.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Callable
from typing import Final, NamedTuple, TypeAlias

INFO: Final = 0x66
"""Log levels: four bits for outside, MAV_SEVERITY, and above them four bits for the flight log."""
PROTOCOL: Final = 0x88
"""Of the interface itself: never shown as a text."""


class PX4Event(NamedTuple):
    """What is told of one happening."""

    id: int
    log_levels: int
    arguments: bytes = b""


class Modes(NamedTuple):
    """HEARTBEAT.custom_mode when the text was said, and as it was before."""

    now: int
    before: int


Arguments: TypeAlias = Callable[[re.Match[str], Modes], bytes]

# ------------------------------------------------------------------------ numbers of enums

ARM_DISARM_REASONS: Final = {
    "RC": 1,
    "RC switch": 2,
    "internal command": 3,
    "external command": 4,
    "mission start": 5,
    "landing": 6,
    "auto preflight disarming": 7,
    "kill-switch": 8,
    "lockdown": 9,
    "failsafe": 10,
}
"""arm_disarm_reason_t; 4, 6 and 7 recorded, the others from memory of PX4's sources."""
NAVIGATION_MODES: Final = {
    "MANUAL": 0,
    "ALTCTL": 1,
    "POSCTL": 2,
    "AUTO_MISSION": 3,
    "AUTO_LOITER": 4,
    "AUTO_RTL": 5,
    "ACRO": 6,
    "OFFBOARD": 7,
    "STABILIZED": 8,
    "AUTO_TAKEOFF": 10,
    "AUTO_LAND": 11,
    "AUTO_FOLLOW_TARGET": 12,
    "AUTO_PRECLAND": 13,
    "POSCTL_ORBIT": 14,
}
"""navigation_mode_t; 3 and 7 recorded, the others from memory."""
NO_SUCH_MODE: Final = 255
CUSTOM_MODES: Final = {"AUTO_MISSION": 0x0404_0000, "OFFBOARD": 0x0006_0000}
FAILSAFE_ACTIONS: Final = {
    "Position mode": 2,
    "Altitude mode": 3,
    "Stabilized mode": 4,
    "Hold": 5,
    "RTL": 6,
    "Land": 7,
    "Descend": 8,
    "Disarm": 9,
    "Terminate": 10,
}
"""failsafe_action_t; 2, 5, 6 and 7 recorded, the others from memory."""
ACTION_OF_MODE: Final = {
    0x0003_0000: FAILSAFE_ACTIONS["Position mode"],
    0x0304_0000: FAILSAFE_ACTIONS["Hold"],
    0x0504_0000: FAILSAFE_ACTIONS["RTL"],
    0x0604_0000: FAILSAFE_ACTIONS["Land"],
}
"""Of a text that does not name the action: what the mode is now."""

# ----------------------------------------------------------------------------- arguments


def _nothing(said: re.Match[str], modes: Modes) -> bytes:
    return b""


def _reason(said: re.Match[str], modes: Modes) -> bytes:
    return struct.pack("<B", ARM_DISARM_REASONS.get(said[1], 0))


def _mode(said: re.Match[str], modes: Modes) -> bytes:
    name = said[1]
    number = NAVIGATION_MODES.get(name, NO_SUCH_MODE)
    return struct.pack("<IB", CUSTOM_MODES.get(name, modes.before), number)


def _heights(said: re.Match[str], modes: Modes) -> bytes:
    return struct.pack("<ii", int(said[1]), int(said[2]))


def _height(said: re.Match[str], modes: Modes) -> bytes:
    return struct.pack("<f", float(said[1]))


def _byte(said: re.Match[str], modes: Modes) -> bytes:
    return struct.pack("<B", int(said[1]) & 0xFF)


def _index(said: re.Match[str], modes: Modes) -> bytes:
    return struct.pack("<HH", int(said[1]) & 0xFFFF, int(said[2]) & 0xFFFF)


def _failsafe(said: re.Match[str], modes: Modes) -> bytes:
    named = FAILSAFE_ACTIONS.get(said[1] or "")
    action = named if named is not None else ACTION_OF_MODE.get(modes.now, 0)
    return struct.pack("<IB", modes.before, action)


def _failsafe_soon(said: re.Match[str], modes: Modes) -> bytes:
    action = FAILSAFE_ACTIONS.get(said[1], 0)
    return struct.pack("<IBH", modes.before, action, int(said[2]))


# --------------------------------------------------------------------------------- table


class _Row(NamedTuple):
    text: re.Pattern[str]
    """The whole text; what is in brackets becomes arguments."""
    id: int
    log_levels: int
    arguments: Arguments = _nothing


def _row(text: str, number: int, log_levels: int = INFO, arguments: Arguments = _nothing) -> _Row:
    return _Row(re.compile(text), number, log_levels, arguments)


ROWS: Final = (
    _row(r"Armed by (.+)", 26266355, INFO, _reason),
    _row(r"Disarmed by (.+)", 32794487, INFO, _reason),
    _row(r"Takeoff detected", 21054825),
    _row(r"Landing detected", 26622124),
    _row(r"Switching to (\w+) is currently not available", 27280279, 0x62, _mode),
    _row(r"Mission start denied! No valid mission", 23844490, 0x62),
    _row(r"Takeoff to ([\d.]+) meters above home", 31928670, INFO, _height),
    _row(r"Mission finished, landed", 24580612),
    _row(r"Mission finished, loitering", 21455606),
    _row(r"No valid mission available, loitering", 20167372, 0x93),
    _row(r"DO JUMP repetitions completed\.", 26093318),
    _row(r"Mission item index out of bound, index: (\d+), max: (\d+)\.", 18740064, 0x33, _index),
    _row(r"IGN MISSION_ITEM: Invalid item", 33469040, 0x33),
    _row(r"Geofence violation for waypoint (\d+)", 19608877, 0x63, _byte),
    _row(r"RTL HOME activated", 18121339),
    _row(r"RTL: landing at home position\.", 27934633),
    _row(r"RTL: climb to (\d+) m \((\d+) m above destination\)", 25988105, INFO, _heights),
    _row(r"RTL: return at (\d+) m \((\d+) m above destination\)", 32911184, INFO, _heights),
    _row(r"RTL: descend to (\d+) m \((\d+) m above destination\)", 28905952, INFO, _heights),
    _row(r"RTL: land at destination", 16962474),
    _row(r"Connection to ground station lost", 27571288, 0x64),
    _row(r"GCS connection regained", 31011876),
    _row(r"Pilot took over using sticks", 17738815),
    _row(r"command denied during calibration: (\d+)", 22511653, 0x63, _byte),
    _row(r"Failsafe activated.*, triggering (.+) in (\d+) seconds", 21279712, 0x42, _failsafe_soon),
    _row(r"Failsafe activated(?:.*, triggering (.+))?", 31382480, 0x42, _failsafe),
)
"""The first that fits counts."""


def event_of(text: str, modes: Modes) -> PX4Event | None:
    """None: it is not known which event goes with that text."""
    for row in ROWS:
        said = row.text.fullmatch(text)
        if said is not None:
            return PX4Event(row.id, row.log_levels, row.arguments(said, modes))
    return None
