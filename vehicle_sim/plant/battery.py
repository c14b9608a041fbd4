"""A lithium-polymer battery: charge counted, voltage from the charge and the sag."""

from __future__ import annotations

from typing import Final

from vehicle_sim.plant.body import Body
from vehicle_sim.plant.cell_voltage import cell_v
from vehicle_sim.plant.constants import Plant

BATTERY_EVERY: Final = 25
"""Steps between two updates of the battery, whose voltage moves slowly."""

FULL_CELL_V: Final = 4.20

_COLLAPSE_V: Final = 60.0
"""What a cell loses for each part of its capacity that is drawn beyond all of it: 3 V in 5 %."""

_WEAKEST: Final = 0.25
"""Below this part of the full voltage the motors draw no more for it."""


def drain(body: Body, plant: Plant) -> None:
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
    current_a = plant.idle_current_a + plant.motor_current_max_a * cubes / (
        strength if strength > _WEAKEST else _WEAKEST
    )
    consumed_mah = body.consumed_mah + current_a * (plant.dt_s * BATTERY_EVERY / 3.6)
    left = 1.0 - consumed_mah / (plant.capacity_mah * body.capacity_scale)
    body.current_a = current_a
    body.consumed_mah = consumed_mah
    body.remaining = left if left > 0.0 else 0.0
    settle(body, plant)


def settle(body: Body, plant: Plant) -> None:
    """Voltage and strength for the charge that is left and the current that flows.

    An empty battery does not hold its last voltage: drawn on, its cells collapse.
    """
    cells = plant.cells - body.cells_lost
    over = body.consumed_mah / (plant.capacity_mah * body.capacity_scale) - 1.0
    open_v = cell_v(body.remaining) - (_COLLAPSE_V * over if over > 0.0 else 0.0)
    resistance_ohm = plant.resistance_ohm * body.resistance_scale
    voltage_v = cells * open_v - body.current_a * resistance_ohm
    voltage_v = voltage_v if voltage_v > 0.0 else 0.0
    body.voltage_v = voltage_v
    body.strength = voltage_v / (plant.cells * FULL_CELL_V)
