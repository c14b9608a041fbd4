"""The engine for few vehicles: the kernels in plain floats, vehicle by vehicle."""

from __future__ import annotations

from collections.abc import Sequence

from vehicle_sim.control_loops.believed import believed_of
from vehicle_sim.control_loops.flight import Flight
from vehicle_sim.engine.step import DT_S, Blocks, StepCount, VehicleSpec, begin, live
from vehicle_sim.estimation.estimated import Estimated
from vehicle_sim.plant.airframe import Airframe
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.constants import plant_of
from vehicle_sim.plant.sensed import Sensed
from vehicle_sim.plant.sensors import MEMS, SensorGrade


class ScalarEngine:
    """An engine in plain floats."""

    def __init__(
        self, specs: Sequence[VehicleSpec], airframe: Airframe, grade: SensorGrade = MEMS
    ) -> None:
        self.steps = StepCount()
        self.believed = believed_of(airframe, DT_S)
        self._plant = plant_of(airframe, DT_S)
        self._grade = grade
        self._vehicles = [Blocks(Body(), Sensed(), Estimated(), Flight()) for _ in specs]
        # What a step reads of them, in a form that costs a step nothing.
        self._rows = [(each.body, each.sensed, each.est, each.flight) for each in self._vehicles]
        for blocks, spec in zip(self._vehicles, specs, strict=True):
            begin(blocks, spec, self._plant, self.believed, grade)

    def blocks(self, lane: int) -> Blocks:
        return self._vehicles[lane]

    def step(self) -> None:
        self.steps.k = k = self.steps.k + 1
        plant, believed, grade = self._plant, self.believed, self._grade
        for body, sensed, est, flight in self._rows:
            live(body, sensed, est, flight, plant, believed, grade, k)
