"""What PX4's events say that matter here: the arming checks that fail, in words.

EVENT has a number in place of a text.  Numbers, messages and arguments are those of PX4 1.14.3; a
number is made of the event's name, so it means the same in every version that knows it.
A report is a summary of the arming checks, one event for each check that fails, and a summary of
the sensors' health (https://mavlink.io/en/services/events.html).
"""

from __future__ import annotations

import struct
from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

from gcs.wire.messages import Event

ARMING_SUMMARY: Final = 27825120
HEALTH_SUMMARY: Final = 18691879

CHECKS: Final[Mapping[int, str]] = MappingProxyType(
    {
        17154777: "No valid mission available",
        17231145: "No manual control input",
        18648929: "Mode not suitable for arming",
        19865031: "No offboard signal",
        23579003: "No connection to the ground control station",
        25679424: "Horizontal velocity unstable",
        26788467: "No valid global position estimate",
        27227279: "No valid attitude estimate",
        29908441: "Geofence violation",
        30612409: "No valid local position estimate",
    }
)
"""The arming checks among the events that were recorded."""

ALL_MODES: Final = 0xFFFF_FFFF
ERROR: Final = 3
"""MAV_SEVERITY_ERROR; the lower four bits of EVENT.log_levels are such a number."""

_BIT_OF_MODE: Final = {
    0x0001_0000: 0,  # MANUAL
    0x0002_0000: 1,  # ALTCTL
    0x0003_0000: 2,  # POSCTL
    0x0404_0000: 3,  # AUTO.MISSION
    0x0304_0000: 4,  # AUTO.LOITER
    0x0504_0000: 5,  # AUTO.RTL
    0x0005_0000: 10,  # ACRO
    0x0006_0000: 14,  # OFFBOARD
    0x0007_0000: 15,  # STABILIZED
    0x0204_0000: 17,  # AUTO.TAKEOFF
    0x0604_0000: 18,  # AUTO.LAND
    0x0804_0000: 19,  # AUTO.FOLLOW_TARGET
    0x0904_0000: 20,  # AUTO.PRECLAND
    0x0103_0000: 21,  # POSCTL.ORBIT
}
"""HEARTBEAT.custom_mode -> its bit in an event's set of modes (navigation_mode_group_t)."""


class ArmingChecks:
    """The latest report of the arming checks, event by event."""

    def __init__(self) -> None:
        self._coming: list[tuple[int, str]] | None = None
        self._failed: tuple[tuple[int, str], ...] = ()
        self._can_arm = self._can_arm_coming = ALL_MODES

    def heard(self, event: Event) -> None:
        """An event, of a report or not."""
        data = bytes(event.arguments)
        if event.id == ARMING_SUMMARY:
            self._coming = []
            (self._can_arm_coming,) = struct.unpack_from("<I", data, 9)
        elif event.id == HEALTH_SUMMARY:
            if self._coming is not None:
                self._failed, self._can_arm = tuple(self._coming), self._can_arm_coming
            self._coming = None
        elif event.id in CHECKS and self._coming is not None:
            (modes,) = struct.unpack_from("<I", data, 0)
            # A warning about all modes is no obstacle to any; one about some modes is to them.
            if modes != ALL_MODES or event.log_levels & 0xF <= ERROR:
                self._coming.append((modes, CHECKS[event.id]))

    def against_arming(self, custom_mode: int) -> tuple[str, ...]:
        """What keeps the vehicle from arming in that mode; nothing where the report allows it."""
        bit = _BIT_OF_MODE.get(custom_mode)
        mode = ALL_MODES if bit is None else 1 << bit
        if bit is not None and self._can_arm & mode:
            return ()
        return tuple(dict.fromkeys(text for modes, text in self._failed if modes & mode))
