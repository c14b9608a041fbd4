"""On the ground: rest, friction, landing, and lying on its back."""

from __future__ import annotations

from dataclasses import replace
from math import sqrt

import pytest

from tests.unit.model.bodies import DT_S, OFF, PLANTS, airborne, energy_of, run, standing
from vehicle_sim.numerics.gravity import GRAVITY_M_S2
from vehicle_sim.plant.airframe import AirframeError, load
from vehicle_sim.plant.constants import Plant, plant_of
from vehicle_sim.plant.quad import advance

EVERY = pytest.mark.parametrize("plant", PLANTS.values(), ids=PLANTS)


def wind_it_bears(plant: Plant) -> float:
    """The wind whose drag is mu m g."""
    hold_n = plant.friction * plant.mass_kg * GRAVITY_M_S2
    return sqrt(hold_n / plant.drag_n_per_m2_s2)


@EVERY
def test_a_fresh_vehicle_rests_at_height_zero(plant: Plant) -> None:
    body = standing(plant)
    run(body, plant, 10.0)
    assert body.touching
    assert abs(body.pos_d) < 1e-9
    assert (body.pos_n, body.pos_e, body.qw) == (0.0, 0.0, 1.0)
    assert body.sf_d == pytest.approx(-GRAVITY_M_S2, rel=1e-9)


@EVERY
def test_idling_in_a_gusty_wind_it_does_not_creep(plant: Plant) -> None:
    body = standing(plant)
    body.wind_n, body.wind_e, body.gust_m_s = 6.0, -5.0, 1.0
    run(body, plant, 10.0, (plant.idle,) * 4)
    n, e = body.pos_n, body.pos_e
    run(body, plant, 50.0, (plant.idle,) * 4)
    assert abs(body.pos_n - n) + abs(body.pos_e - e) < 1e-3
    assert abs(body.qz) < 1e-4


@EVERY
def test_friction_holds_up_to_coulombs_limit_and_not_beyond(plant: Plant) -> None:
    held, blown = standing(plant), standing(plant)
    held.wind_n = held.flow_n = 0.9 * wind_it_bears(plant)
    blown.wind_n = blown.flow_n = 1.1 * wind_it_bears(plant)
    run(held, plant, 5.0)
    run(blown, plant, 5.0)
    assert abs(held.vel_n) < 1e-9
    assert blown.vel_n > 0.5


@EVERY
def test_it_slides_as_far_as_coulomb_says(plant: Plant) -> None:
    """Without air: v^2 / (2 mu g)."""
    plant = replace(plant, drag_n_per_m2_s2=0.0)
    body = standing(plant)
    body.vel_n, body.vel_e = 1.8, -2.4
    run(body, plant, 3.0)
    far_m = 3.0**2 / (2.0 * plant.friction * GRAVITY_M_S2)
    assert sqrt(body.pos_n**2 + body.pos_e**2) == pytest.approx(far_m, rel=0.02)
    assert body.pos_e / body.pos_n == pytest.approx(-4.0 / 3.0, rel=0.01)
    assert abs(body.vel_n) + abs(body.vel_e) < 1e-6


@EVERY
def test_friction_stops_a_spin(plant: Plant) -> None:
    body = standing(plant)
    body.rate_z = 4.0
    run(body, plant, 3.0)
    assert abs(body.rate_z) < 1e-6
    assert abs(body.pos_n) + abs(body.pos_e) < 0.01
    assert abs(body.qz) > 0.01


@EVERY
@pytest.mark.parametrize("up_m", [0.3, 1.0, 3.0])
@pytest.mark.parametrize("lean", [0.0, 0.1, 0.3])
def test_a_drop_gains_no_energy_and_ends_at_rest(plant: Plant, up_m: float, lean: float) -> None:
    body = airborne(plant, up_m)
    body.vel_n = 0.5
    body.qx, body.qy = lean, -0.5 * lean
    body.qw = sqrt(1.0 - body.qx**2 - body.qy**2)
    before = free = energy_of(body, plant)
    for k in range(1, 2501):
        advance(body, *OFF, plant, k)
        # What the springs hold while they touch comes back or goes, but never grows.
        assert energy_of(body, plant) <= before + 1e-9
        if not body.touching:
            assert energy_of(body, plant) <= free + 1e-9
            free = energy_of(body, plant)
    assert free < before
    upright = body.qw**2 + body.qz**2 > 0.5  # the hardest drops end on the back
    assert upright or lean > 0.0
    rest_d = 0.0 if upright else plant.foot_down_m - plant.top_up_m
    assert body.pos_d == pytest.approx(rest_d, abs=1e-6)
    assert max(abs(body.vel_n), abs(body.vel_e), abs(body.vel_d)) < 1e-6
    level = body.qx**2 + body.qy**2
    assert (level if upright else 1.0 - level) < 1e-9


@EVERY
def test_a_level_landing_does_not_bounce(plant: Plant) -> None:
    body = standing(plant)
    body.pos_d, body.vel_d = -0.2, 0.7
    touched, highest = False, 0.0
    for k in range(1, 1001):
        advance(body, *OFF, plant, k)
        touched = touched or body.touching
        if touched:
            highest = max(highest, -body.pos_d)
    assert touched
    assert highest < 0.05


@EVERY
def test_turned_over_it_lies_on_its_propellers(plant: Plant) -> None:
    body = airborne(plant, 1.0)
    body.qw, body.qx = 0.05, sqrt(1.0 - 0.05 * 0.05)
    run(body, plant, 10.0)
    assert body.touching
    assert body.pos_d == pytest.approx(plant.foot_down_m - plant.top_up_m, abs=1e-6)
    assert max(abs(body.vel_n), abs(body.vel_e), abs(body.vel_d)) < 1e-6


@EVERY
def test_a_leap_forgets_where_friction_held(plant: Plant) -> None:
    body = standing(plant)
    body.wind_n = body.flow_n = 0.5 * wind_it_bears(plant)
    run(body, plant, 2.0)
    assert body.grip_n1 > 0.0
    body.vel_d = -5.0
    run(body, plant, 0.1)
    assert not body.touching
    assert body.grip_n1 == body.grip_n2 == body.grip_n3 == body.grip_n4 == 0.0


def test_what_the_steps_cannot_follow_is_refused_with_the_range_that_they_can() -> None:
    airframe = load()
    stiff = replace(airframe, gear=replace(airframe.gear, damping_n_s_per_m=400.0))
    slow = replace(airframe, motors=replace(airframe.motors, time_constant_s=0.001))
    with pytest.raises(AirframeError, match=r"s500: steps of 4 ms .* must be between 2\.4 and"):
        plant_of(stiff, DT_S)
    with pytest.raises(AirframeError, match="time_constant_s"):
        plant_of(slow, DT_S)
