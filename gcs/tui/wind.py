"""The wind as the vehicle reports it: PX4 by WIND_COV, ArduPilot by WIND."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from gcs import ipc
from gcs.protocol.autopilot import ARDUPILOT, PX4

MESSAGE_OF: Final = {PX4.name: "WIND_COV", ARDUPILOT.name: "WIND"}
"""What the station is asked for; another autopilot tells none that we know."""
OLD_NS: Final = 5_000_000_000


@dataclass(frozen=True, slots=True)
class Wind:
    """`from_deg`: where it comes from, clockwise from north."""

    speed_m_s: float
    from_deg: float
    told_ns: int

    def words(self, now_ns: int) -> str:
        """`6.2 m/s from 270°`; a dash once it is not told any more."""
        if now_ns - self.told_ns > OLD_NS:
            return "-"
        return f"{self.speed_m_s:.1f} m/s from {round(self.from_deg) % 360:03d}°"


def message_for(vehicle: str) -> str:
    """The message to subscribe to, of a vehicle as a snapshot calls it; empty for none."""
    names = (message for name, message in MESSAGE_OF.items() if f" {name} " in f"{vehicle} ")
    return next(names, "")


def wind_of(event: ipc.MessageEvent, before: Wind | None) -> Wind | None:
    """What a message tells of the wind; `before` where it tells nothing."""
    match event.name, event.fields:
        case "WIND_COV", {"wind_x": int() | float() as north, "wind_y": int() | float() as east}:
            speed_m_s, from_deg = math.hypot(north, east), math.degrees(math.atan2(-east, -north))
        case "WIND", {"speed": int() | float() as speed_m_s, "direction": int() | float() as deg}:
            from_deg = deg
        case _:
            return before
    return Wind(speed_m_s, from_deg, event.time_ns)
