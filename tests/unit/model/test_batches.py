"""A batch of bodies ends in the very bytes that each body reaches by itself."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest

from tests.unit.model.bodies import PLANTS, Motors, standing, state_bytes
from vehicle_sim.numerics.lanes import Lanes, batched
from vehicle_sim.numerics.noise import key_of
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.constants import Plant
from vehicle_sim.plant.quad import advance, begin

STEPS = 2000


def scene(body: Body, index: int) -> None:
    """On the ground, flying, falling, tumbling, in wind, with dead motors and lost cells."""
    body.gust_key = key_of(9, index, 0)
    if index % 2:
        body.pos_d = -6.0 * index
    if index % 3 == 0:
        body.vel_n, body.vel_d, body.rate_x = 3.0, -1.0, 0.5 * index % 7.0
        body.qw, body.qx = sqrt(1.0 - 0.3 * 0.3), 0.3
    if index % 5 == 4:
        body.health_2, body.health_3 = 0.0, 0.6
    if index % 7 == 2:
        body.cells_lost = 1.0
    if index % 6 == 5:
        body.payload_kg, body.mass_off_x, body.mass_off_y = 0.05 * index, 0.01, -0.02
        body.inertia_scale, body.thrust_scale = 1.5, 0.9
        body.resistance_scale, body.capacity_scale = 2.0, 0.5
    body.wind_e, body.gust_m_s = 0.7 * (index % 11), 0.4 * (index % 4)


def commands(k: int) -> Motors:
    wave = (k % 100) * 0.001
    lift = 0.70 if k < STEPS // 2 else 0.3
    return (lift + wave, lift, lift - 0.01, lift + 0.02 - wave)


@pytest.mark.parametrize("count", [1, 7, pytest.param(100, marks=pytest.mark.thorough)])
@pytest.mark.parametrize("plant", PLANTS.values(), ids=PLANTS)
def test_a_batch_flies_as_each_by_itself(plant: Plant, count: int) -> None:
    alone = [standing(plant) for _ in range(count)]
    together = Lanes(Body, count)
    batched(begin)(together.all, 1, plant)
    for index, body in enumerate(alone):
        scene(body, index)
        scene(together.lane(index), index)
    step = batched(advance)
    with np.errstate(all="raise", under="ignore"):
        for k in range(1, STEPS + 1):
            u = commands(k)
            for body in alone:
                advance(body, *u, plant, k)
            step(together.all, *u, plant, k)
    ends = [state_bytes(body) for body in alone]
    assert [state_bytes(together.lane(index)) for index in range(count)] == ends
    assert len(set(ends)) == count
    if count == 100:
        assert 0 < sum(body.touching for body in alone) < count
