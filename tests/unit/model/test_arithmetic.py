"""The same bits everywhere: the arithmetic core has a golden hash and uses plain arithmetic."""

from __future__ import annotations

import ast
import hashlib
import inspect
from types import ModuleType

import pytest

from tests.unit.model.bodies import PLANTS, standing, state_bytes
from vehicle_sim.numerics import noise
from vehicle_sim.numerics.lanes import batched
from vehicle_sim.plant import battery, cell_voltage, ground, motors, quad, rigid_body, wind
from vehicle_sim.plant.quad import advance

GOLDEN = {
    "racer250": "2957251567d2040ae295e5f8bd82efad381c6443df14306cfdefdcbce1a24848",
    "s500": "d77498848f165525af89ddf326c69ae4e2233193a33474248f908134cf3d5c45",
    "sih": "1ad62ba39e2d609008e90de69cbb0483dff51cf98834f553ba0c1a5ba9607fd4",
}
"""SHA-256 over the states of the flight below.  A change of the physics changes it, on purpose;
a different machine or Python must not."""

MODULES = [battery, cell_voltage, ground, motors, noise, quad, rigid_body, wind]


@pytest.mark.parametrize("name", PLANTS)
def test_the_arithmetic_core_has_its_golden_hash(name: str) -> None:
    """Take-off in gusty wind, a tumble, a motor that dies, and the fall back on the ground."""
    plant = PLANTS[name]
    body = standing(plant, gust_key=0x123456789ABCDEF0)
    body.wind_n, body.wind_e, body.gust_m_s = 5.0, -3.0, 1.5
    digest = hashlib.sha256()
    for k in range(1, 2001):
        wave = (k % 100) * 0.002
        lift = 0.7 if k < 500 else 0.0
        body.health_4 = 1.0 if k < 400 else 0.0
        advance(body, lift + wave, lift, lift - 0.01, lift + 0.2 - wave, plant, k)
        digest.update(state_bytes(body))
    assert body.touching
    assert digest.hexdigest() == GOLDEN[name]


@pytest.mark.parametrize("module", MODULES, ids=lambda module: str(module.__name__))
def test_the_step_uses_plain_arithmetic_only(module: ModuleType) -> None:
    tree = ast.parse(inspect.getsource(module))
    for node in ast.walk(tree):
        assert not isinstance(node, ast.Pow | ast.MatMult)
        if isinstance(node, ast.ImportFrom) and node.module == "math":
            assert [name.name for name in node.names] == ["sqrt"]
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
            assert node.func.id not in {"sum", "pow", "hypot", "dot", "min", "max", "abs", "round"}


@pytest.mark.parametrize("module", MODULES, ids=lambda module: str(module.__name__))
def test_each_function_of_the_step_is_a_kernel(module: ModuleType) -> None:
    own = [
        f
        for _, f in inspect.getmembers(module, inspect.isfunction)
        if f.__module__ == module.__name__
    ]
    assert own
    for function in own:
        batched(function)  # raises for what is none
