"""COMMAND_LONG and COMMAND_INT as one: the same parameters, whichever message carried them."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gcs.bridge.translate.places import DEGREES_PER_UNIT, UNSET
from gcs.wire.messages import CommandInt, CommandLong


@dataclass(frozen=True, slots=True)
class Command:
    """A command of a client.  Angles and heights as the command has them."""

    number: int
    """MAV_CMD."""
    p1: float
    p2: float
    p3: float
    p4: float
    p5: float
    """Latitude in degrees where the command has a place; NaN: not given."""
    p6: float
    """Longitude."""
    p7: float
    """Height; NaN: not given."""
    frame: int | None
    """MAV_FRAME of COMMAND_INT; COMMAND_LONG has none."""

    @property
    def has_place(self) -> bool:
        """Neither unset nor 0, 0, which stands for "here" in both autopilots."""
        unset = math.isnan(self.p5) and math.isnan(self.p6)
        return not unset and (self.p5, self.p6) != (0.0, 0.0)

    def whole(self, value: float) -> int | None:
        """A parameter that stands for a whole number; None where it is none."""
        return int(value) if math.isfinite(value) and value == int(value) else None


def command_of(message: CommandLong | CommandInt) -> Command:
    """In COMMAND_INT, x and y are 1e-7 degrees, both INT32_MAX where they are not given."""
    if isinstance(message, CommandLong):
        place, frame = (message.param5, message.param6, message.param7), None
    else:
        unset = message.x == UNSET and message.y == UNSET
        lat_deg = math.nan if unset else message.x * DEGREES_PER_UNIT
        lon_deg = math.nan if unset else message.y * DEGREES_PER_UNIT
        place, frame = (lat_deg, lon_deg, message.z), message.frame
    first = (message.param1, message.param2, message.param3, message.param4)
    return Command(message.command, *first, *place, frame=frame)
