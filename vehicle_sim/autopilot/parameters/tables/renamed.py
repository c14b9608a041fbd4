"""Parameters that ArduCopter 4.7 has under another name or in another unit than 4.5.

Inside, the vehicle reads every parameter by its name of 4.5 and in the unit of 4.5.  The names and
types of 4.7 are those that a 4.7.0-dev listed; those of FOLL_* did not change.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from vehicle_sim.autopilot.parameters.tables.spec import StoredAs


class Meaning(Enum):
    """How the value of 4.7 is reckoned from that of 4.5."""

    SCALED = "times a factor"
    OPPOSITE = "1 for 0, and 0 for anything else"
    CHECKS_LEFT_OUT = "a mask of the checks before arming that are not made, -1 for none made"
    LOWEST_BIT = "the lowest bit of several"


@dataclass(frozen=True, slots=True)
class Renamed:
    """`factor` makes a value of 4.7 from one of 4.5."""

    old: str
    new: str
    factor: float = 1.0
    stored_as: StoredAs = StoredAs.REAL32
    meaning: Meaning = Meaning.SCALED

    def to_new(self, value: float) -> float:
        match self.meaning:
            case Meaning.SCALED:
                return value * self.factor
            case Meaning.OPPOSITE:
                return 0.0 if value else 1.0
            case Meaning.CHECKS_LEFT_OUT:
                checks = int(value)
                if checks & _EVERY_CHECK:
                    return 0.0
                return float(_CHECKS & ~checks) if checks else -1.0
            case Meaning.LOWEST_BIT:
                return float(int(value) & 1)

    def to_old(self, value: float) -> float:
        match self.meaning:
            case Meaning.SCALED:
                return value / self.factor
            case Meaning.OPPOSITE:
                return 0.0 if value else 1.0
            case Meaning.CHECKS_LEFT_OUT:
                left_out = int(value)
                return float(_CHECKS & ~left_out) if left_out else float(_EVERY_CHECK)
            case Meaning.LOWEST_BIT:
                return float(int(value) & 1)

    def bounds(self, low: float, high: float) -> tuple[float, float]:
        """Those of the values of 4.7, from those of 4.5."""
        if self.meaning is Meaning.CHECKS_LEFT_OUT:
            return -1.0, float(_CHECKS)
        one, other = self.to_new(low), self.to_new(high)
        return min(one, other), max(one, other)


_EVERY_CHECK = 1  # of ARMING_CHECK
_CHECKS = 0x1FFFFE  # its other bits
_CM = 0.01
_INT8, _INT16, _INT32 = StoredAs.INT8, StoredAs.INT16, StoredAs.INT32

# fmt: off
COPTER_4_7 = (
    Renamed("ANGLE_MAX",        "ATC_ANGLE_MAX",    _CM),
    Renamed("ARMING_CHECK",     "ARMING_SKIPCHK",   1.0, _INT32, Meaning.CHECKS_LEFT_OUT),
    Renamed("CIRCLE_RADIUS",    "CIRCLE_RADIUS_M",  _CM),
    Renamed("GPS_TYPE",         "GPS1_TYPE",        1.0, _INT8),
    Renamed("LAND_ALT_LOW",     "LAND_ALT_LOW_M",   _CM),
    Renamed("LAND_SPEED",       "LAND_SPD_MS",      _CM),
    Renamed("LAND_SPEED_HIGH",  "LAND_SPD_HIGH_MS", _CM),
    Renamed("LOIT_ACC_MAX",     "LOIT_ACC_MAX_M",   _CM),
    Renamed("LOIT_BRK_ACCEL",   "LOIT_BRK_ACC_M",   _CM),
    Renamed("LOIT_BRK_JERK",    "LOIT_BRK_JRK_M",   _CM),
    Renamed("LOIT_SPEED",       "LOIT_SPEED_MS",    _CM),
    Renamed("PSC_ACCZ_I",       "PSC_D_ACC_I",      0.1),
    Renamed("PSC_ACCZ_P",       "PSC_D_ACC_P",      0.1),
    Renamed("PSC_JERK_XY",      "PSC_JERK_NE"),
    Renamed("PSC_POSXY_P",      "PSC_NE_POS_P"),
    Renamed("PSC_POSZ_P",       "PSC_D_POS_P"),
    Renamed("PSC_VELXY_D",      "PSC_NE_VEL_D"),
    Renamed("PSC_VELXY_I",      "PSC_NE_VEL_I"),
    Renamed("PSC_VELXY_P",      "PSC_NE_VEL_P"),
    Renamed("PSC_VELZ_P",       "PSC_D_VEL_P"),
    Renamed("RTL_ALT",          "RTL_ALT_M",        _CM),
    Renamed("RTL_ALT_FINAL",    "RTL_ALT_FINAL_M",  _CM),
    Renamed("RTL_CLIMB_MIN",    "RTL_CLIMB_MIN_M",  _CM),
    Renamed("RTL_SPEED",        "RTL_SPEED_MS",     _CM),
    Renamed("SIM_GPS_DISABLE",  "SIM_GPS1_ENABLE",  1.0, _INT8, Meaning.OPPOSITE),
    Renamed("SIM_GPS_GLITCH_X", "SIM_GPS1_GLTCH_X"),
    Renamed("SIM_GPS_GLITCH_Y", "SIM_GPS1_GLTCH_Y"),
    Renamed("SIM_GPS_GLITCH_Z", "SIM_GPS1_GLTCH_Z"),
    Renamed("SR0_EXTRA1",       "MAV1_EXTRA1",      1.0, _INT16),
    Renamed("SR0_EXTRA2",       "MAV1_EXTRA2",      1.0, _INT16),
    Renamed("SR0_EXTRA3",       "MAV1_EXTRA3",      1.0, _INT16),
    Renamed("SR0_EXT_STAT",     "MAV1_EXT_STAT",    1.0, _INT16),
    Renamed("SR0_POSITION",     "MAV1_POSITION",    1.0, _INT16),
    Renamed("SR0_RAW_SENS",     "MAV1_RAW_SENS",    1.0, _INT16),
    Renamed("SR0_RC_CHAN",      "MAV1_RC_CHAN",     1.0, _INT16),
    Renamed("SYSID_ENFORCE",    "MAV_OPTIONS",      1.0, _INT16, Meaning.LOWEST_BIT),
    Renamed("SYSID_MYGCS",      "MAV_GCS_SYSID",    1.0, _INT16),
    Renamed("SYSID_THISMAV",    "MAV_SYSID",        1.0, _INT16),
    Renamed("WPNAV_ACCEL",      "WP_ACC",           _CM),
    Renamed("WPNAV_ACCEL_Z",    "WP_ACC_Z",         _CM),
    Renamed("WPNAV_JERK",       "WP_JERK"),
    Renamed("WPNAV_RADIUS",     "WP_RADIUS_M",      _CM),
    Renamed("WPNAV_RFND_USE",   "WP_RFND_USE",      1.0, _INT8),
    Renamed("WPNAV_SPEED",      "WP_SPD",           _CM),
    Renamed("WPNAV_SPEED_DN",   "WP_SPD_DN",        _CM),
    Renamed("WPNAV_SPEED_UP",   "WP_SPD_UP",        _CM),
    Renamed("WPNAV_TER_MARGIN", "WP_TER_MARGIN"),
)
# fmt: on
