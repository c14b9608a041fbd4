"""A lithium-polymer battery: charge counted, voltage from the charge and the sag."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

from vehicle_sim.numerics.kernel import kernel
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.frame import AirframeConstants

BATTERY_EVERY: Final = 25
"""Steps between two updates of the battery, whose voltage moves slowly."""

FULL_CELL_V: Final = 4.20

_COLLAPSE_V: Final = 60.0
"""What a cell loses for each part of its capacity that is drawn beyond all of it: 3 V in 5 %."""

_WEAKEST: Final = 0.25
"""Below this part of the full voltage the motors draw no more for it."""


@kernel
def cell_v(remaining: float) -> float:
    """Open-circuit voltage of one cell over its charge: the usual shape of a LiPo's curve,
    straight between the points (0, 3.00), (0.05, 3.45), (0.10, 3.60), (0.20, 3.70), (0.40, 3.78),
    (0.60, 3.88), (0.80, 4.02), (1, 4.20)."""
    return (
        4.02 + (remaining - 0.80) * 0.90
        if remaining > 0.80
        else 3.88 + (remaining - 0.60) * 0.70
        if remaining > 0.60
        else 3.78 + (remaining - 0.40) * 0.50
        if remaining > 0.40
        else 3.70 + (remaining - 0.20) * 0.40
        if remaining > 0.20
        else 3.60 + (remaining - 0.10) * 1.00
        if remaining > 0.10
        else 3.45 + (remaining - 0.05) * 3.00
        if remaining > 0.05
        else 3.00 + remaining * 9.00
    )


_POINTS: Final = (
    (3.00, 0.0), (3.45, 0.05), (3.60, 0.10), (3.70, 0.20), (3.78, 0.40), (3.88, 0.60),
    (4.02, 0.80), (4.20, 1.0),
)  # fmt: skip
"""`cell_v` the other way round."""


def charge_by_voltage(body: Body, frame: AirframeConstants) -> float:
    """The charge (0..1) that the voltage speaks of, freed from the sag under load.

    That of a sound battery; one that has lost cells looks emptier than it is.
    """
    volts = (body.voltage_v + body.current_a * frame.resistance_ohm) / frame.cells
    for (low_v, low), (high_v, high) in pairwise(_POINTS):
        if volts < high_v:
            part = (volts - low_v) / (high_v - low_v)
            return low + part * (high - low) if part > 0.0 else low
    return 1.0


@kernel
def drain(body: Body, frame: AirframeConstants) -> None:
    """`BATTERY_EVERY` steps of the battery under the motors' load.

    A propeller's power goes with the cube of its speed, and current is power over voltage: a
    sagging battery is drained faster.  A lost cell takes its voltage with it, not the charge.
    """
    s1 = body.s1
    s2 = body.s2
    s3 = body.s3
    s4 = body.s4
    cubes = s1 * s1 * s1 + s2 * s2 * s2 + (s3 * s3 * s3 + s4 * s4 * s4)
    strength = body.strength
    current_a = frame.idle_current_a + frame.motor_current_max_a * cubes / (
        strength if strength > _WEAKEST else _WEAKEST
    )
    consumed_mah = body.consumed_mah + current_a * (frame.dt_s * BATTERY_EVERY / 3.6)
    left = 1.0 - consumed_mah / frame.capacity_mah
    body.current_a = current_a
    body.consumed_mah = consumed_mah
    body.remaining = left if left > 0.0 else 0.0
    settle(body, frame)


@kernel
def settle(body: Body, frame: AirframeConstants) -> None:
    """Voltage and strength for the charge that is left and the current that flows.

    An empty battery does not hold its last voltage: drawn on, its cells collapse.
    """
    cells = frame.cells - body.cells_lost
    over = body.consumed_mah / frame.capacity_mah - 1.0
    open_v = cell_v(body.remaining) - (_COLLAPSE_V * over if over > 0.0 else 0.0)
    voltage_v = cells * open_v - body.current_a * frame.resistance_ohm
    voltage_v = voltage_v if voltage_v > 0.0 else 0.0
    body.voltage_v = voltage_v
    body.strength = voltage_v / (frame.cells * FULL_CELL_V)
