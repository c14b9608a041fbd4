"""The same bits everywhere: the arithmetic core has a golden hash, and noise has no state."""

from __future__ import annotations

import ast
import hashlib
import inspect
from types import ModuleType

import pytest

from vehicle_sim.model import airframe, battery, ground, motors, noise, quad, rigid_body
from vehicle_sim.model.noise import key_of, normal
from vehicle_sim.model.quad import Quad
from vehicle_sim.model.sensors import EVERY, Sensors

GOLDEN = "945d42d5a015853ab7eda6291ac5c10b12d5154b46b16ddb1d5e767881fd9932"
"""SHA-256 over the states of the flight below.  A change of the physics changes it, on purpose;
a different machine or Python must not."""


def fly(steps: int) -> tuple[Quad, str]:
    body = Quad(airframe.load(), 0.004)
    digest = hashlib.sha256()
    for step in range(steps):
        wave = (step % 100) * 0.002
        body.step(0.7 + wave, 0.7, 0.65, 0.72 - wave)
        digest.update(body.state_bytes())
    return body, digest.hexdigest()


def test_the_arithmetic_core_has_its_golden_hash() -> None:
    assert fly(2000)[1] == GOLDEN


@pytest.mark.parametrize("module", [battery, ground, motors, noise, quad, rigid_body])
def test_the_step_uses_plain_arithmetic_only(module: ModuleType) -> None:
    tree = ast.parse(inspect.getsource(module))
    for node in ast.walk(tree):
        assert not isinstance(node, ast.Pow | ast.MatMult)
        if isinstance(node, ast.ImportFrom) and node.module == "math":
            assert [name.name for name in node.names] == ["sqrt"]
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            assert node.func.id not in {"sum", "pow", "hypot", "dot"}


def test_noise_is_centred_and_has_unit_variance() -> None:
    key = key_of(1, 0, 0)
    draws = [normal(key, step) for step in range(20_000)]
    mean = sum(draws) / len(draws)
    variance = sum((x - mean) ** 2 for x in draws) / len(draws)
    assert abs(mean) < 0.03
    assert variance == pytest.approx(1.0, abs=0.03)
    assert max(map(abs, draws)) < 3.5


def test_seeds_vehicles_sources_and_steps_draw_apart() -> None:
    draws = {
        normal(key_of(seed, vehicle, source), step)
        for seed in range(3)
        for vehicle in range(3)
        for source in range(3)
        for step in range(10)
    }
    assert len(draws) == 3 * 3 * 3 * 10


def test_the_wander_stays_as_wide_as_it_began() -> None:
    sensors = Sensors(7, 0, 0.004)
    squares = 0.0
    moves = 20_000
    for move in range(1, moves + 1):
        sensors.wander(move * EVERY)
        squares += sensors.err_pos_n * sensors.err_pos_n
    assert (squares / moves) ** 0.5 == pytest.approx(0.05, rel=0.15)


def test_asking_for_the_gyro_changes_nothing() -> None:
    body, _ = fly(100)
    asked, silent = Sensors(1, 0, 0.004), Sensors(1, 0, 0.004)
    for step in range(1, 50):
        asked.gyro(body.body, step)
        asked.accel(body.body, step)
    assert asked.gyro(body.body, 50) == silent.gyro(body.body, 50)


def test_standing_still_the_accelerometer_feels_one_g_upwards() -> None:
    body = Quad(airframe.load(), 0.004)
    for _ in range(500):
        body.step(0.0, 0.0, 0.0, 0.0)
    _, _, z = Sensors(1, 0, 0.004).accel(body.body, 500)
    assert z == pytest.approx(-9.80665, abs=0.25)
