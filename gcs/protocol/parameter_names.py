"""Parameters that an autopilot's newer versions have under another name, or in another unit.

ArduCopter 4.7 renamed many to metres and SI.  The new names are those that a 4.7.0-dev listed; the
old ones, in centimetres, are those of ArduCopter 4.5's parameter list.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True, slots=True)
class ParameterName:
    """One name of a parameter; a value under it, times `scale`, is in the unit of the newest."""

    name: str
    scale: float = 1.0


@dataclass(frozen=True, slots=True)
class Renamed:
    """`scale` makes a value of the new name from one of the old."""

    new: str
    old: str
    scale: float = 1.0


_CM: Final = 0.01

# fmt: off
RENAMED: Final = (
    Renamed("ATC_ANGLE_MAX",    "ANGLE_MAX",       _CM),
    Renamed("CIRCLE_RADIUS_M",  "CIRCLE_RADIUS",   _CM),
    Renamed("LAND_ALT_LOW_M",   "LAND_ALT_LOW",    _CM),
    Renamed("LAND_SPD_HIGH_MS", "LAND_SPEED_HIGH", _CM),
    Renamed("LAND_SPD_MS",      "LAND_SPEED",      _CM),
    Renamed("LOIT_SPEED_MS",    "LOIT_SPEED",      _CM),
    Renamed("MAV_GCS_SYSID",    "SYSID_MYGCS"),
    Renamed("MAV_OPTIONS",      "SYSID_ENFORCE"),
    Renamed("MAV_SYSID",        "SYSID_THISMAV"),
    Renamed("PSC_JERK_NE",      "PSC_JERK_XY"),
    Renamed("PSC_NE_POS_P",     "PSC_POSXY_P"),
    Renamed("PSC_NE_VEL_D",     "PSC_VELXY_D"),
    Renamed("PSC_NE_VEL_I",     "PSC_VELXY_I"),
    Renamed("PSC_NE_VEL_P",     "PSC_VELXY_P"),
    Renamed("RTL_ALT_FINAL_M",  "RTL_ALT_FINAL",   _CM),
    Renamed("RTL_ALT_M",        "RTL_ALT",         _CM),
    Renamed("RTL_CLIMB_MIN_M",  "RTL_CLIMB_MIN",   _CM),
    Renamed("RTL_SPEED_MS",     "RTL_SPEED",       _CM),
    Renamed("WP_ACC",           "WPNAV_ACCEL",     _CM),
    Renamed("WP_ACC_Z",         "WPNAV_ACCEL_Z",   _CM),
    Renamed("WP_JERK",          "WPNAV_JERK"),
    Renamed("WP_RADIUS_M",      "WPNAV_RADIUS",    _CM),
    Renamed("WP_SPD",           "WPNAV_SPEED",     _CM),
    Renamed("WP_SPD_DN",        "WPNAV_SPEED_DN",  _CM),
    Renamed("WP_SPD_UP",        "WPNAV_SPEED_UP",  _CM),
)
# fmt: on

_BY_NEW: Final = {row.new: row for row in RENAMED}


def names_of(name: str) -> tuple[ParameterName, ...]:
    """All names of the parameter whose newest name is `name`, the newest first."""
    newest = ParameterName(name)
    row = _BY_NEW.get(name)
    return (newest,) if row is None else (newest, ParameterName(row.old, row.scale))
