"""One vehicle's step against JSBSim's in the same run, and whole fleets by their size.

    python -m tools.bench_vehicle [--rounds 5] [--steps 2500]

A step of ours is all that runs at 250 Hz: guidance, control, motors, wind, physics, ground,
battery, sensors, estimator.  JSBSim's is `FGFDMExec.run()` of aircraft that its package ships: the
F450, a quadrotor with its own controllers and sensors, and the c172x.  Each round times one after
the other; the figures are the best round's and the median of the rounds' ratios.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import statistics
import tempfile
import time
from collections.abc import Callable, Iterator
from dataclasses import fields
from typing import NamedTuple

from vehicle_sim.engine.batch_engine import BatchEngine
from vehicle_sim.engine.scalar_engine import ScalarEngine
from vehicle_sim.engine.step import DT_S, VehicleSpec
from vehicle_sim.plant.airframe import load
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.constants import plant_of
from vehicle_sim.plant.quad import advance, begin

PEERS = ("F450", "c172x")
SIZES = (1, 10, 100, 1_000, 10_000)
HIGH_M = 5_000.0
HOVER_M = 10.0
ALIGNED_S = 2.0
RISE_S = 8.0
FEW_MOST = 100


class Timed(NamedTuple):
    name: str
    step: Callable[[], object]


def hovering(
    count: int, kind: type[ScalarEngine] | type[BatchEngine]
) -> ScalarEngine | BatchEngine:
    """Vehicles that hover by their estimates: one has risen, the others are its copies."""
    first = ScalarEngine(specs(1), load())
    blocks = first.blocks(0)
    for _ in range(round(ALIGNED_S / DT_S)):
        first.step()
    blocks.flight.flying, blocks.flight.goal_d = True, -HOVER_M
    for _ in range(round(RISE_S / DT_S)):
        first.step()
    assert abs(blocks.body.pos_d + HOVER_M) < 1.0
    engine = kind(specs(count), load())
    engine.steps.k = first.steps.k
    for lane in range(count):
        copy = engine.blocks(lane)
        for block in fields(blocks):
            whole, part = getattr(blocks, block.name), getattr(copy, block.name)
            for field in fields(whole):
                setattr(part, field.name, getattr(whole, field.name))
    return engine


def specs(count: int) -> list[VehicleSpec]:
    return [VehicleSpec(seed=1, index=index, lat_deg=47.4) for index in range(count)]


def ours() -> Timed:
    return Timed("physics and control", hovering(1, ScalarEngine).step)


def physics_only() -> Timed:
    plant, body = plant_of(load(), DT_S), Body()
    begin(body, 1, plant)
    body.pos_d = -HIGH_M
    k = 0

    def step() -> None:
        nonlocal k
        k += 1
        advance(body, 0.66, 0.66, 0.66, 0.66, plant, k)

    return Timed("physics alone", step)


def peers() -> list[Timed]:
    """JSBSim's aircraft, in the air with their engines on; none if it is not installed."""
    try:
        import jsbsim
    except ImportError:
        print("JSBSim is not installed (pip install 'mavgate[bench]'): nothing to compare with")
        return []
    timed = []
    for model in PEERS:
        with silence(), tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
            executive = jsbsim.FGFDMExec(None)
            executive.set_debug_level(0)
            # The c172x logs its flight into a file, which is made when the model is loaded: that
            # goes into a folder that does not stay, and nothing is logged while a step is timed.
            executive.set_output_path(folder)
            executive.load_model(model)
            executive.disable_output()
            executive.set_dt(DT_S)
            executive["ic/h-sl-ft"] = HIGH_M / 0.3048
            executive["propulsion/set-running"] = -1
            executive.run_ic()
        timed.append(Timed(f"JSBSim {jsbsim.__version__} {model}", executive.run))
    return timed


@contextlib.contextmanager
def silence() -> Iterator[None]:
    """JSBSim's C++ tells its aircraft's defects on standard output, whatever its debug level."""
    kept = os.dup(1)
    null = os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, 1)
    try:
        yield
    finally:
        os.dup2(kept, 1)
        os.close(kept)
        os.close(null)


def microseconds(step: Callable[[], object], steps: int) -> float:
    """Of processor time: what else the machine does counts little."""
    start_ns = time.process_time_ns()
    for _ in range(steps):
        step()
    return (time.process_time_ns() - start_ns) / 1e3 / steps


def one_vehicle(rounds: int, steps: int) -> None:
    mine, alone, theirs = ours(), physics_only(), peers()
    times = [
        [microseconds(timed.step, steps) for timed in (mine, alone, *theirs)] for _ in range(rounds)
    ]
    print(f"one vehicle, a step, best of {rounds} rounds of {steps}")
    for column, timed in enumerate((mine, alone, *theirs)):
        best = min(row[column] for row in times)
        ratio = statistics.median(row[column] / row[0] for row in times)
        compared = f", {ratio:4.2f} times ours" if column > 1 else ""
        print(f"  {timed.name:24} {best:7.2f} us{compared}")


def fleet(count: int, kind: type[ScalarEngine] | type[BatchEngine]) -> None:
    engine = hovering(count, kind)
    steps = max(25, min(1_000, 50_000 // count))
    microseconds(engine.step, 5)
    best_us = min(microseconds(engine.step, steps) for _ in range(3))
    print(
        f"  {count:6,} {kind.__name__:5} {best_us / 1e3:9.3f} ms a step"
        f" {1e6 / best_us * count:12,.0f} vehicle steps/s {DT_S * 1e6 / best_us:8.2f} x real time"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--steps", type=int, default=2_500)
    asked = parser.parse_args()
    one_vehicle(asked.rounds, asked.steps)
    print("fleets, one core: plain floats (ScalarEngine) and numpy rows (BatchEngine)")
    for count in SIZES:
        for kind in (ScalarEngine, BatchEngine):
            if kind is BatchEngine or count <= FEW_MOST:
                fleet(count, kind)


if __name__ == "__main__":
    main()
