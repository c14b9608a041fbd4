"""Whom an ArduPilot hears that was told to hear its own ground station alone.

SYSID_ENFORCE is 1 (from 4.7 on bit 0 of MAV_OPTIONS, from memory), and the station is SYSID_MYGCS
(MAV_GCS_SYSID, up to MAV_GCS_SYSID_HI where that is larger).  Frames of any other system id it
drops without a word.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

from gcs.protocol.lock_parameters import ENFORCE
from gcs.protocol.parameter_names import names_of

OPTIONS: Final = "MAV_OPTIONS"
STATION: Final = "MAV_GCS_SYSID"
LAST_STATION: Final = "MAV_GCS_SYSID_HI"
NAMES_OF_ENFORCED: Final[Mapping[str, tuple[str, ...]]] = {
    "ardupilot": (OPTIONS, STATION, LAST_STATION)
}
"""By autopilot, the newest names of what is read for it."""


@dataclass(frozen=True, slots=True)
class Hears:
    """The system ids that a vehicle hears alone, from `first` to `last`; `named` is the parameter
    that has it so, as the vehicle calls it."""

    first: int
    last: int
    named: str

    def __contains__(self, sysid: int) -> bool:
        return self.first <= sysid <= self.last

    @property
    def words(self) -> str:
        return str(self.first) if self.first == self.last else f"{self.first} to {self.last}"


def hears_alone(autopilot: str, parameters: Mapping[str, float]) -> Hears | None:
    """None where it hears everybody, or where that is not known.

    `parameters` are those that the vehicle has told, under its own names.
    """
    if autopilot not in NAMES_OF_ENFORCED:
        return None
    options, station = _told(OPTIONS, parameters), _told(STATION, parameters)
    if options is None or station is None or not options[1] & ENFORCE:
        return None
    last = _told(LAST_STATION, parameters)
    first_id = station[1]
    return Hears(first_id, max(first_id, last[1] if last else 0), options[0])


def _told(newest: str, parameters: Mapping[str, float]) -> tuple[str, int] | None:
    """A parameter under the name that the vehicle has for it, and its value."""
    for each in names_of(newest):
        value = parameters.get(each.name, math.nan)
        if math.isfinite(value):
            return each.name, int(value)
    return None
