"""Which generations of either autopilot can be played, and the version that each one tells."""

from __future__ import annotations

from typing import Final, Literal

from vehicle_sim.autopilot.modes import Personality

Firmware = Literal["1.14", "1.15", "4.5", "4.7"]

FIRMWARES: Final[dict[Personality, tuple[Firmware, ...]]] = {
    "px4": ("1.14", "1.15"),
    "ardupilot": ("4.5", "4.7"),
}
"""The first one is played unless another is asked for."""

FLIGHT_SW_VERSION: Final[dict[Firmware, int]] = {
    "1.14": 0x010E03FF,
    "1.15": 0x010F00FF,
    "4.5": 0x040507FF,
    "4.7": 0x04070000,
}
"""AUTOPILOT_VERSION.flight_sw_version: major, minor, patch, type (255 release, 0 development).

1.14.3 and 4.7.0-dev are what the recorded autopilots told.
"""


class FirmwareError(ValueError):
    """A generation that this autopilot never had."""


def firmware_of(personality: Personality, asked: str | None) -> Firmware:
    """The one asked for, or the usual one.  Raises FirmwareError."""
    known = FIRMWARES[personality]
    if asked is None:
        return known[0]
    for firmware in known:
        if firmware == asked:
            return firmware
    raise FirmwareError(
        f"firmware {asked} is not one of {personality}'s: it is played as {' or '.join(known)}"
    )
