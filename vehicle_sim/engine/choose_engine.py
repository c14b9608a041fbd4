"""Chooses the engine that is the faster for so many vehicles."""

from __future__ import annotations

from collections.abc import Sequence
from types import FunctionType
from typing import Final

from vehicle_sim.engine.scalar_engine import ScalarEngine
from vehicle_sim.engine.step import Engine, VehicleSpec, live
from vehicle_sim.plant.airframe import Airframe
from vehicle_sim.plant.sensors import MEMS, SensorGrade

BATCH_FROM: Final = 20
"""Vehicles from which numpy is the faster."""
COMPILED: Final = not isinstance(live, FunctionType)
"""The kernels are compiled: one after the other they are faster than numpy's rows for some hundreds
of vehicles, and about as fast for 1,000."""


def engine_for(
    specs: Sequence[VehicleSpec], airframe: Airframe, grade: SensorGrade = MEMS
) -> Engine:
    """The faster engine for so many vehicles; the flights are the same."""
    if COMPILED or len(specs) < BATCH_FROM:
        return ScalarEngine(specs, airframe, grade)
    # numpy is imported only where it is needed
    from vehicle_sim.engine.batch_engine import BatchEngine

    return BatchEngine(specs, airframe, grade)
