"""PX4's health and arming report: which modes can be armed in and flown, and what is against it.

The report is a row of events: a summary of the arming checks, one event for each check that fails,
and a summary of the sensors' health.  Ids, levels, arguments and their order as recorded from PX4
1.14.3; what `Checked` does not ask for is never wrong here.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import Final, NamedTuple

from vehicle_sim.services.events.px4_events import INFO, PROTOCOL, PX4Event

ALL_MODES: Final = 0xFFFF_FFFF
# navigation_mode_group_t
MISSION: Final = 0x8
BY_STICKS: Final = 0x8407
"""manual, altctl, posctl, acro, stab."""
OFFBOARD: Final = 0x4000
BY_LOCAL_POSITION: Final = 0x007E_003C
BY_GLOBAL_POSITION: Final = 0x38
BY_ATTITUDE: Final = 0x007E_D03E
NOT_TO_ARM_IN: Final = 0x003C_3020
"""rtl, land, follow_target, precland, orbit and two without a name."""

# health_component_t, as a number in a check and as a bit in a summary
REMOTE_CONTROL: Final = 7
COMMUNICATION_LINKS: Final = 12
LOCAL_POSITION: Final = 17
SYSTEM: Final = 20
GPS: Final = 3
ALWAYS_PRESENT: Final = 0x2802_0802
"""Pressure sensor, gyroscope, magnetometer, battery and others that the vehicle always has."""

FENCE_VIOLATION: Final = 2


class Checked(NamedTuple):
    """What the report is about."""

    attitude: bool = True
    velocity: bool = True
    local_position: bool = True
    global_position: bool = True
    gps: bool = True
    mission: bool = False
    offboard: bool = False
    sticks: bool = False
    station: bool = True
    station_needed: bool = False
    """By NAV_DLL_ACT."""
    within_fence: bool = True
    mode_to_arm_in: bool = True
    """The present mode is one in which PX4 can be armed."""


class _Failed(NamedTuple):
    """A check that failed: the event, and which summaries have which bits of it."""

    id: int
    log_levels: int
    modes: int
    component: int
    error: bool = False
    warning: bool = False
    cannot_arm: int = 0
    """Modes in which it is not to be armed, of `modes` or all of them."""
    cannot_run: int = 0
    extra: bytes = b""

    @property
    def event(self) -> PX4Event:
        arguments = struct.pack("<IB", self.modes, self.component) + self.extra
        return PX4Event(self.id, self.log_levels, arguments)


def _of_modes(number: int, log_levels: int, modes: int, error: bool = True) -> _Failed:
    return _Failed(
        number, log_levels, modes, SYSTEM, error=error, cannot_arm=modes, cannot_run=modes
    )


def _failed(seen: Checked) -> Iterator[_Failed]:
    """In the order in which they are told."""
    if not seen.velocity and seen.attitude:
        yield _Failed(
            25679424, 0x33, BY_ATTITUDE, LOCAL_POSITION, error=True, cannot_arm=BY_ATTITUDE
        )
    if not seen.attitude:
        yield _of_modes(27227279, 0x22, BY_ATTITUDE)
    if not seen.local_position:
        yield _of_modes(30612409, 0x33, BY_LOCAL_POSITION)
    if not seen.global_position:
        yield _of_modes(26788467, 0x33, BY_GLOBAL_POSITION)
    if not seen.mode_to_arm_in:
        yield _Failed(18648929, INFO, NOT_TO_ARM_IN, SYSTEM, cannot_arm=NOT_TO_ARM_IN)
    if not seen.mission:
        yield _of_modes(17154777, INFO, MISSION, error=False)
    if not seen.offboard:
        yield _of_modes(19865031, 0x33, OFFBOARD)
    if not seen.sticks:
        yield _Failed(
            17231145,
            0x44,
            ALL_MODES,
            REMOTE_CONTROL,
            warning=True,
            cannot_arm=BY_STICKS,
            cannot_run=BY_STICKS,
        )
    if not seen.within_fence:
        extra = struct.pack("<B", FENCE_VIOLATION)
        yield _Failed(
            29908441, 0x33, ALL_MODES, SYSTEM, error=True, cannot_arm=ALL_MODES, extra=extra
        )
    if not seen.station:
        yield _Failed(
            23579003,
            0x33 if seen.station_needed else INFO,
            ALL_MODES,
            COMMUNICATION_LINKS,
            error=seen.station_needed,
            cannot_arm=ALL_MODES if seen.station_needed else 0,
        )


def report(seen: Checked) -> tuple[PX4Event, ...]:
    """All events of one report, in order."""
    failed = tuple(_failed(seen))
    error = warning = 0
    can_arm = can_run = ALL_MODES
    for each in failed:
        error |= each.error << each.component
        warning |= each.warning << each.component
        can_arm &= ~each.cannot_arm
        can_run &= ~each.cannot_run
    present = ALWAYS_PRESENT | seen.gps << GPS | seen.station << COMMUNICATION_LINKS
    arming = struct.pack("<BIIII", 0, error, warning, can_arm, can_run)
    health = struct.pack("<BIII", 0, present, 0, 0)
    return (
        PX4Event(27825120, PROTOCOL, arming),
        *(each.event for each in failed),
        PX4Event(18691879, PROTOCOL, health),
    )
