"""One step of a vehicle: body, sensors, estimator and controllers, and the blocks they run on.

An engine owns the blocks of vehicles that share an airframe, and gives each vehicle a `Seat`
at its own.  `ScalarEngine` runs the kernels in plain floats, vehicle by vehicle; `BatchEngine`
(which needs numpy) over all of them at once, to the same bytes.

Vehicles do not meet: each has a local frame of its own, with its own start as the origin.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass, fields
from typing import Final, Protocol

from vehicle_sim.control_loops.believed import Believed
from vehicle_sim.control_loops.cascade import stabilise, tune
from vehicle_sim.control_loops.flight import Flight
from vehicle_sim.control_loops.guidance import guide
from vehicle_sim.estimation.estimated import Estimated
from vehicle_sim.estimation.estimator import align, estimate
from vehicle_sim.numerics.noise import key_of
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.constants import Plant
from vehicle_sim.plant.quad import advance
from vehicle_sim.plant.quad import begin as begin_body
from vehicle_sim.plant.sensed import Sensed
from vehicle_sim.plant.sensors import SensorGrade, measure_power, sense, switch_on

DT_NS: Final = 4_000_000
DT_S: Final = DT_NS / 1e9
GUIDE_EVERY: Final = 5  # 50 Hz
_GUIDE_S: Final = DT_S * GUIDE_EVERY
_GUST_SOURCE: Final = 0  # of noise; the sensors' begin further up


@dataclass(frozen=True, slots=True)
class VehicleSpec:
    """One vehicle of an engine; `index` tells vehicles of one seed apart.

    The latitude is that of its start: it has a part in the magnetic field.
    """

    seed: int
    index: int
    lat_deg: float


@dataclass(frozen=True, slots=True)
class Blocks:
    """The numeric state of one vehicle."""

    body: Body
    sensed: Sensed
    est: Estimated
    flight: Flight


@dataclass(slots=True)
class StepCount:
    """`k` is the number of the engine's last step; 0 before the first."""

    k: int = 0


class Engine(Protocol):
    """Steps all its vehicles together."""

    @property
    def steps(self) -> StepCount: ...
    @property
    def believed(self) -> Believed: ...
    def blocks(self, lane: int) -> Blocks: ...
    def step(self) -> None:
        """One step of `DT_S`."""
        ...


@dataclass(frozen=True, slots=True)
class Onboard:
    """What the autopilot of one vehicle has of it: sensors, estimate, control loops, and what it
    believes of its airframe.  The body, which is the truth, is not among it."""

    steps: StepCount
    sensed: Sensed
    est: Estimated
    flight: Flight
    believed: Believed


@dataclass(frozen=True, slots=True)
class Seat:
    """A vehicle's place in an engine."""

    engine: Engine
    lane: int

    @property
    def onboard(self) -> Onboard:
        blocks, engine = self.engine.blocks(self.lane), self.engine
        return Onboard(engine.steps, blocks.sensed, blocks.est, blocks.flight, engine.believed)


def live(
    body: Body,
    sensed: Sensed,
    est: Estimated,
    flight: Flight,
    plant: Plant,
    believed: Believed,
    grade: SensorGrade,
    k: int,
) -> None:
    """Step number `k` of one vehicle."""
    if k % GUIDE_EVERY == 0:
        guide(flight, est, believed, _GUIDE_S)
    stabilise(flight, est, believed)
    advance(body, flight.u1, flight.u2, flight.u3, flight.u4, plant, k)
    sense(sensed, body, grade, k)
    estimate(est, sensed, k)


def begin(
    blocks: Blocks, spec: VehicleSpec, plant: Plant, believed: Believed, grade: SensorGrade
) -> None:
    """Make fresh blocks a vehicle on its home ground, seen from power-up."""
    begin_body(blocks.body, key_of(spec.seed, spec.index, _GUST_SOURCE), plant)
    switch_on(blocks.sensed, spec.seed, spec.index, spec.lat_deg, grade)
    measure_power(blocks.sensed, blocks.body, grade, 0)
    tune(blocks.flight, believed)


def restart(blocks: Blocks, believed: Believed) -> None:
    """The autopilot's computer starts anew: it knows nothing, and its motors stop."""
    align(blocks.est)
    fresh = Flight()
    for field in fields(Flight):
        setattr(blocks.flight, field.name, getattr(fresh, field.name))
    tune(blocks.flight, believed)


_LETTERS: Final[dict[type, str]] = {float: "d", int: "Q", bool: "?"}


def state_bytes(blocks: Blocks) -> bytes:
    """The whole numeric state of a vehicle, little-endian: equal bytes are an equal flight."""
    parts = (
        (Body(), blocks.body),
        (Sensed(), blocks.sensed),
        (Estimated(), blocks.est),
        (Flight(), blocks.flight),
    )
    return b"".join(
        struct.pack("<" + _LETTERS[type(getattr(fresh, field.name))], getattr(block, field.name))
        for fresh, block in parts
        for field in fields(fresh)
    )
