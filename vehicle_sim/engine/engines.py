"""Which engine for how many vehicles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from vehicle_sim.engine.few import Few
from vehicle_sim.engine.step import Engine, VehicleSpec
from vehicle_sim.plant.airframe import Airframe
from vehicle_sim.plant.sensors import MEMS, SensorGrade

MANY_FROM: Final = 20
"""Vehicles from which numpy is the faster."""


def engine_for(
    specs: Sequence[VehicleSpec], airframe: Airframe, grade: SensorGrade = MEMS
) -> Engine:
    """The faster engine for so many vehicles; the flights are the same."""
    if len(specs) < MANY_FROM:
        return Few(specs, airframe, grade)
    # numpy is imported only where it is needed
    from vehicle_sim.engine.many import Many

    return Many(specs, airframe, grade)
