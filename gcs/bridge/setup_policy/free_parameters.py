"""The parameters that a client may write, by autopilot: groups of names, each with the reason.

Of the recorded lists these are 10 of a PX4 1.14.3's 874 and 32 of an ArduCopter 4.7-dev's 1,369;
what a row says of its names is from memory of the firmwares' own descriptions.  A name that is in
`safety_parameters.py`, too, is guarded.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from gcs.bridge.setup_policy.safety_parameters import group_of, pattern_of


@dataclass(frozen=True, slots=True)
class FreeGroup:
    """Parameters that are free for one reason; `why` continues "NAME is free: "."""

    why: str
    names: re.Pattern[str]


def _free(why: str, names: str) -> FreeGroup:
    return FreeGroup(why, pattern_of(names.split()))


_LOG: Final = "it says what the vehicle writes into its log"
_COUNTS: Final = "the vehicle counts with it, and flies by nothing of that"
_CAMERA: Final = "it says how a camera is worked and pointed, which moves the vehicle nowhere"
_SHOWN: Final = "it says what lights, sounds and screens show"

PX4: Final = (
    _free(_LOG, "SDLOG_*"),
    _free(_COUNTS, "COM_FLIGHT_UUID"),
    _free(_CAMERA, "CAM_* TRIG_* MNT_*"),
    _free("it tells ground stations what the vehicle is used for", "COM_FLT_PROFILE"),
)
ARDUCOPTER: Final = (
    _free(
        _LOG,
        "LOG_BITMASK LOG_DISARMED LOG_FILE_* LOG_MAX_FILES LOG_BLK_RATEMAX LOG_DARM_RATEMAX"
        " LOG_REPLAY",
    ),
    _free(_COUNTS, "STAT_*"),
    _free(_CAMERA, "CAM* MNT*"),
    _free(_SHOWN, "NTF_* OSD* MSP_* NMEA_*"),
)

BY_AUTOPILOT: Final[Mapping[str, tuple[FreeGroup, ...]]] = MappingProxyType(
    {"px4": PX4, "ardupilot": ARDUCOPTER}
)


def free_group_of(autopilot: str, name: str) -> FreeGroup | None:
    """The group by which the parameter is free; None where it is not."""
    if group_of(autopilot, name) is not None:
        return None
    groups = BY_AUTOPILOT.get(autopilot, ())
    return next((each for each in groups if each.names.fullmatch(name)), None)
