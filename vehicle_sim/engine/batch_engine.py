"""The engine for fleets: every number of all vehicles in one numpy row, every step over rows."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vehicle_sim.control_loops.believed import believed_of
from vehicle_sim.control_loops.flight import Flight
from vehicle_sim.engine.step import DT_S, Blocks, StepCount, VehicleSpec, begin, live
from vehicle_sim.estimation.estimated import Estimated
from vehicle_sim.numerics.lanes import Lanes, batched
from vehicle_sim.plant.airframe import Airframe
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.constants import plant_of
from vehicle_sim.plant.sensed import Sensed
from vehicle_sim.plant.sensors import MEMS, SensorGrade


class BatchEngine:
    """An engine over rows; see `step.Engine`."""

    def __init__(
        self, specs: Sequence[VehicleSpec], airframe: Airframe, grade: SensorGrade = MEMS
    ) -> None:
        self.steps = StepCount()
        self.believed = believed_of(airframe, DT_S)
        self._plant = plant_of(airframe, DT_S)
        self._grade = grade
        count = len(specs)
        self._bodies = Lanes(Body, count)
        self._sensed = Lanes(Sensed, count)
        self._estimated = Lanes(Estimated, count)
        self._flights = Lanes(Flight, count)
        self._live = batched(live)
        for lane, spec in enumerate(specs):
            begin(self.blocks(lane), spec, self._plant, self.believed, grade)

    def blocks(self, lane: int) -> Blocks:
        return Blocks(
            self._bodies.lane(lane),
            self._sensed.lane(lane),
            self._estimated.lane(lane),
            self._flights.lane(lane),
        )

    def step(self) -> None:
        self.steps.k += 1
        # Both sides of a choice are computed here; the one that is not taken may be no number.
        with np.errstate(all="ignore"):
            self._live(
                self._bodies.all,
                self._sensed.all,
                self._estimated.all,
                self._flights.all,
                self._plant,
                self.believed,
                self._grade,
                self.steps.k,
            )
