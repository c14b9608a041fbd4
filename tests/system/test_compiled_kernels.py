"""Vehicles with compiled kernels fly to the same bytes as the plain ones."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FLIGHTS = """
import hashlib
from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.interface import Geodetic
from vehicle_sim.engine.choose_engine import COMPILED, engine_for
from vehicle_sim.engine.step import VehicleSpec, state_bytes
from vehicle_sim.plant.airframe import load, shipped
from vehicle_sim.plant.sensors import GRADES

print(COMPILED)
for personality in ("px4", "ardupilot"):
    vehicle = Autopilot(personality, Geodetic(47.0, 8.0, 488.0), 3)
    digest = hashlib.sha256()
    for k in range(6000):
        if k == 2000:
            if personality == "ardupilot":
                vehicle.set_mode_kind("guided")
            assert vehicle.arm(False) == vehicle.take_off(10.0) == 0
        if k == 4500:
            vehicle.blocks.body.wind_n, vehicle.blocks.body.gust_m_s = 6.0, 2.0
        if k == 5500:
            vehicle.blocks.body.health_2 = 0.0
        vehicle.step()
        digest.update(vehicle.state_bytes())
    assert not vehicle.truth.landed
    print(digest.hexdigest())
for airframe in shipped():
    specs = [VehicleSpec(5, index, 47.0) for index in range(25)]
    fleet = engine_for(specs, load(airframe), GRADES["real"])
    for _ in range(300):
        fleet.step()
    whole = b"".join(state_bytes(fleet.blocks(index)) for index in range(25))
    print(hashlib.sha256(whole).hexdigest())
"""


def _flown(path: Path) -> list[str]:
    done = subprocess.run(
        [sys.executable, "-c", FLIGHTS],
        env={**os.environ, "PYTHONPATH": str(path)},
        cwd="/",
        capture_output=True,
        text=True,
        check=True,
    )
    return done.stdout.splitlines()


@pytest.mark.thorough
@pytest.mark.skipif(not (shutil.which("cc") and os.name == "posix"), reason="no C compiler here")
def test_compiled_kernels_fly_to_the_same_bytes(tmp_path: Path) -> None:
    """One vehicle of either autopilot in wind and without a motor; a fleet of each airframe, which
    is flown in numpy's rows where nothing is compiled."""
    subprocess.run([sys.executable, "-m", "tools.compile_kernels", tmp_path], cwd=ROOT, check=True)
    plain, compiled = _flown(ROOT), _flown(tmp_path)
    assert (plain[0], compiled[0]) == ("False", "True")
    assert compiled[1:] == plain[1:]
    assert len(plain) == 6
