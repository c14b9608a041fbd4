"""One command as it was asked for, whichever of COMMAND_LONG and COMMAND_INT carried it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Final

from vehicle_sim.autopilot.interface import Result
from vehicle_sim.effects import Client, Effect
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import ABSOLUTE, RELATIVE

INT32_MAX: Final = 0x7FFFFFFF


@dataclass(frozen=True, slots=True)
class Order:
    """`p5` and `p6` are degrees where they are a place, in both carriers.

    `frame` is None for COMMAND_LONG, which has none.  NaN = not given.
    """

    client: Client
    command: int
    p1: float
    p2: float
    p3: float
    p4: float
    p5: float
    p6: float
    p7: float
    frame: int | None = None

    @property
    def located(self) -> Order:
        """With COMMAND_INT's 1e-7 degrees as degrees."""
        if self.frame is None:
            return self
        return replace(self, p5=self.p5 * 1e-7, p6=self.p6 * 1e-7)

    @property
    def relative(self) -> bool:
        """The height counts from home."""
        return self.frame is not None and self.frame in RELATIVE

    @property
    def global_frame(self) -> bool:
        return self.frame is None or self.frame in RELATIVE or self.frame in ABSOLUTE

    def whole(self, value: float) -> int | None:
        """A parameter that stands for a number or an id; None if it is no whole number."""
        return int(value) if math.isfinite(value) and value == int(value) else None


@dataclass(frozen=True, slots=True)
class Answer:
    """The result for the ack, and what follows the ack.

    `acked` False: no ack is sent now; one of IN_PROGRESS gets only its final one.
    """

    result: Result
    after: tuple[Effect, ...] = ()
    acked: bool = True


def from_long(client: Client, asked: m.CommandLong) -> Order:
    return Order(client, asked.command, *asked[:7])


def from_int(client: Client, asked: m.CommandInt) -> Order:
    x, y = (math.nan if value == INT32_MAX else float(value) for value in (asked.x, asked.y))
    return Order(client, asked.command, *asked[:4], x, y, asked.z, frame=asked.frame)
