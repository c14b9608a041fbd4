"""The words of PX4's events that are told: id and arguments become the text that goes with them.

PX4 says most of these as a STATUSTEXT too; the words here are those of the text, so that either can
stand for the other.  Ids, layouts and words are those recorded of PX4 1.14.3 (`event_catalogue` of
the recorded scenarios and the texts beside the events); what is from memory of PX4's sources is
marked so.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from gcs.protocol.px4_events import ARMING_SUMMARY, CHECKS, HEALTH_SUMMARY
from gcs.wire.messages import Event

PROTOCOL_ONLY: Final = 8
"""Log levels from this on are never shown."""

REASONS: Final[Mapping[int, str]] = MappingProxyType(
    {
        4: "external command",
        6: "landing",
        7: "auto preflight disarming",
        # From memory:
        1: "RC",
        2: "RC switch",
        3: "internal command",
        5: "mission start",
        8: "kill-switch",
        9: "lockdown",
        10: "failsafe",
    }
)
"""arm_disarm_reason_t."""
MODES: Final[Mapping[int, str]] = MappingProxyType(
    {
        3: "AUTO_MISSION",
        7: "OFFBOARD",
        # From memory:
        0: "MANUAL",
        1: "ALTCTL",
        2: "POSCTL",
        4: "AUTO_LOITER",
        5: "AUTO_RTL",
        6: "ACRO",
        8: "STABILIZED",
        10: "AUTO_TAKEOFF",
        11: "AUTO_LAND",
        12: "AUTO_FOLLOW_TARGET",
        13: "AUTO_PRECLAND",
        14: "POSCTL_ORBIT",
    }
)
"""navigation_mode_t."""
ACTIONS: Final[Mapping[int, str]] = MappingProxyType(
    {
        2: "Position mode",
        5: "Hold",
        6: "RTL",
        7: "Land",
        # From memory:
        3: "Altitude mode",
        4: "Stabilized mode",
        8: "Descend",
        9: "Disarm",
        10: "Terminate",
    }
)
"""failsafe_action_t."""


@dataclass(frozen=True, slots=True)
class _Words:
    """`layout` of the arguments (`struct`, little-endian), which stand for {0}, {1}, ... in
    `text`; those in `names` by name.  `begins`: how the vehicle's own text of it begins."""

    text: str
    layout: str = ""
    names: tuple[tuple[int, Mapping[int, str]], ...] = ()
    begins: str = ""


_TABLE: Final[Mapping[int, _Words]] = MappingProxyType(
    {
        26266355: _Words("Armed by {0}", "B", ((0, REASONS),)),
        32794487: _Words("Disarmed by {0}", "B", ((0, REASONS),)),
        21054825: _Words("Takeoff detected"),
        26622124: _Words("Landing detected"),
        27280279: _Words("Switching to {1} is currently not available", "IB", ((1, MODES),)),
        23844490: _Words("Mission start denied! No valid mission"),
        31928670: _Words("Takeoff to {0:.1f} meters above home", "f"),
        24580612: _Words("Mission finished, landed"),
        21455606: _Words("Mission finished, loitering"),
        20167372: _Words("No valid mission available, loitering"),
        26093318: _Words("DO JUMP repetitions completed."),
        18740064: _Words("Mission item index out of bound, index: {0}, max: {1}.", "HH"),
        33469040: _Words("IGN MISSION_ITEM: Invalid item"),
        19608877: _Words("Geofence violation for waypoint {0}", "B"),
        # Of these four the event's own message is recorded, the text beside it is not.
        22901736: _Words("Mission rejected: starts with landing"),
        33440290: _Words("Mission rejected: takeoff is not the first waypoint item"),
        25552931: _Words("Mission rejected: item {0}: unsupported command: {1}", "HH"),
        31368072: _Words("Waypoint {0} below home", "H"),
        18121339: _Words("RTL HOME activated"),
        27934633: _Words("RTL: landing at home position."),
        25988105: _Words("RTL: climb to {0} m ({1} m above destination)", "ii"),
        32911184: _Words("RTL: return at {0} m ({1} m above destination)", "ii"),
        28905952: _Words("RTL: descend to {0} m ({1} m above destination)", "ii"),
        16962474: _Words("RTL: land at destination"),
        27571288: _Words("Connection to ground station lost"),
        31011876: _Words("GCS connection regained"),
        17738815: _Words("Pilot took over using sticks"),
        22511653: _Words("command denied during calibration: {0}", "B"),
        21279712: _Words(
            "Failsafe activated, triggering {1} in {2} seconds",
            "IBH",
            ((1, ACTIONS),),
            "Failsafe activated",
        ),
        31382480: _Words(
            "Failsafe activated, triggering {1}", "IB", ((1, ACTIONS),), "Failsafe activated"
        ),
        # How its text begins is from memory.
        17980399: _Words(
            "logging: opening log file {0}-{1:02}-{2:02}/{3:02}_{4:02}_{5:02}.ulg",
            "HBBBBB",
            begins="[logger]",
        ),
    }
)


@dataclass(frozen=True, slots=True)
class WordedEvent:
    """`severity` is MAV_SEVERITY; `begins` is how the vehicle's own text of it begins."""

    severity: int
    text: str
    begins: str


def worded(event: Event) -> WordedEvent | None:
    """What is told of the event; None: it is not known here, or is not for people."""
    words, severity = _TABLE.get(event.id), event.log_levels & 0xF
    if words is None or severity >= PROTOCOL_ONLY:
        return None
    values: list[int | float | str] = list(
        struct.unpack_from("<" + words.layout, bytes(event.arguments))
    )
    for place, names in words.names:
        number = values[place]
        assert isinstance(number, int)
        values[place] = names.get(number, f"{number} (not known here)")
    begins = words.begins or words.text.partition("{")[0]
    return WordedEvent(severity, words.text.format(*values), begins)


def is_known(event: Event) -> bool:
    """Whether it is worded here, or is part of the report of the arming checks."""
    return event.id in _TABLE or event.id in CHECKS or event.id in (ARMING_SUMMARY, HEALTH_SUMMARY)
