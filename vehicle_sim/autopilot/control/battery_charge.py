"""How full the battery is, by the voltage and the current that are measured."""

from __future__ import annotations

from itertools import pairwise

from vehicle_sim.control_loops.believed import Believed
from vehicle_sim.plant.cell_voltage import CURVE
from vehicle_sim.plant.sensed import Sensed


def resting_v(sensed: Sensed, believed: Believed) -> float:
    """The voltage of one cell, freed from the sag under load that the data sheet gives."""
    return (sensed.battery_v + sensed.battery_a * believed.resistance_ohm) / believed.cells


def charge_by_voltage(sensed: Sensed, believed: Believed) -> float:
    """The charge (0..1) that the voltage speaks of.

    That of a sound battery; one that has lost cells looks emptier than it is.
    """
    volts = resting_v(sensed, believed)
    for (low_v, low), (high_v, high) in pairwise(CURVE):
        if volts < high_v:
            part = (volts - low_v) / (high_v - low_v)
            return low + part * (high - low) if part > 0.0 else low
    return 1.0


def voltage_of(charge: float) -> float:
    """The resting voltage of one cell that speaks of this charge, which may be beyond 0..1."""
    for (low_v, low), (high_v, high) in pairwise(CURVE):
        if charge <= high:
            return low_v + (charge - low) / (high - low) * (high_v - low_v)
    return CURVE[-1][0] + (charge - 1.0)
