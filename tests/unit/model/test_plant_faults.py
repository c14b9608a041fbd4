"""Faults of the plant alone: the body shows each by its physics, and the autopilot goes on
believing its data sheet."""

from __future__ import annotations

import pytest

from tests.unit.model.bodies import PLANTS, airborne, hover_motors, hovering, run, standing
from vehicle_sim.control_loops.believed import believed_of
from vehicle_sim.engine.scalar_engine import ScalarEngine
from vehicle_sim.engine.step import DT_S, VehicleSpec
from vehicle_sim.engine.truth import inject
from vehicle_sim.numerics.gravity import GRAVITY_M_S2
from vehicle_sim.plant.airframe import load
from vehicle_sim.plant.battery import drain
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.constants import Plant
from vehicle_sim.plant.faults import (
    CentreOfMass,
    InertiaScale,
    ModelFault,
    MotorFault,
    Payload,
    ThrustScale,
    WeakBattery,
)
from vehicle_sim.plant.sensed import Sensed

EVERY = pytest.mark.parametrize("plant", PLANTS.values(), ids=PLANTS)


def faulty(body: Body, fault: ModelFault) -> Body:
    fault.inject(body, Sensed())
    return body


@EVERY
def test_a_payload_of_half_the_weight_makes_hover_thrust_too_little(plant: Plant) -> None:
    """At 1.5 times the mass two thirds of the thrust are there: it falls with g / 3 at first."""
    body = faulty(hovering(plant), Payload(0.5 * plant.mass_kg))
    run(body, plant, 0.1, hover_motors(body, plant))
    assert body.vel_d == pytest.approx(GRAVITY_M_S2 / 3.0 * 0.1, rel=0.1)


@EVERY
def test_no_payload_makes_a_body_without_mass(plant: Plant) -> None:
    """A quarter of the data sheet's mass is left: four times the thrust to weight in hover."""
    body = faulty(hovering(plant), Payload(-100.0))
    run(body, plant, 3.0 * plant.dt_s, hover_motors(body, plant))
    assert body.vel_d == pytest.approx(-3.0 * GRAVITY_M_S2 * 3.0 * plant.dt_s, rel=0.1)


@EVERY
@pytest.mark.parametrize(
    ("fault", "axis", "way"),
    [
        (CentreOfMass(forward_m=0.005), "rate_y", -1.0),
        (CentreOfMass(forward_m=-0.005), "rate_y", 1.0),
        (CentreOfMass(right_m=0.005), "rate_x", 1.0),
    ],
)
def test_a_centre_of_mass_off_the_middle_turns_the_body_to_its_side(
    plant: Plant, fault: CentreOfMass, axis: str, way: float
) -> None:
    """Nose-heavy, the nose sinks: weight times lever over inertia, while nothing damps it yet."""
    body = faulty(hovering(plant), fault)
    run(body, plant, 0.02, hover_motors(body, plant))
    inertia = plant.inertia_xx_kg_m2 if axis == "rate_x" else plant.inertia_yy_kg_m2
    rate = plant.mass_kg * GRAVITY_M_S2 * 0.005 / inertia * 0.02
    assert getattr(body, axis) == pytest.approx(way * rate, rel=0.2)


@EVERY
def test_on_the_ground_the_heavy_side_sinks_in_and_stays(plant: Plant) -> None:
    body = faulty(standing(plant), CentreOfMass(forward_m=0.02))
    run(body, plant, 2.0)
    assert -0.1 < body.qy < 0.0, "the nose is lower"
    assert abs(body.rate_y) < 1e-3


@EVERY
def test_another_propeller_lifts_its_part(plant: Plant) -> None:
    body = faulty(hovering(plant), ThrustScale(0.7))
    run(body, plant, 0.1, hover_motors(body, plant))
    assert body.vel_d == pytest.approx(0.3 * GRAVITY_M_S2 * 0.1, rel=0.1)


@EVERY
def test_twice_the_inertia_turns_half_as_fast(plant: Plant) -> None:
    def turned(scale: float) -> float:
        body = faulty(hovering(plant), InertiaScale(scale))
        u, _, _, _ = hover_motors(body, plant)
        run(body, plant, 0.02, (u, 1.05 * u, 1.05 * u, u))
        return body.rate_x

    assert turned(2.0) == pytest.approx(0.5 * turned(1.0), rel=0.03)


@EVERY
@pytest.mark.parametrize("scale", [0.5, 4.0])
def test_it_lands_hard_and_rests_with_any_inertia_that_a_file_may_ask_for(
    plant: Plant, scale: float
) -> None:
    body = faulty(airborne(plant, 0.3), InertiaScale(scale))
    run(body, plant, 5.0)
    assert body.touching
    assert abs(body.vel_d) < 0.01
    assert abs(body.rate_x) + abs(body.rate_y) + abs(body.rate_z) < 0.05


@EVERY
def test_a_weak_battery_sags_more_and_is_empty_earlier(plant: Plant) -> None:
    def drained(fault: WeakBattery) -> Body:
        body = faulty(standing(plant), fault)
        body.s1 = body.s2 = body.s3 = body.s4 = 0.7
        for _ in range(100):
            drain(body, plant)
        return body

    sound, old = drained(WeakBattery()), drained(WeakBattery(resistance_scale=3.0))
    assert sound.voltage_v - old.voltage_v > 1.5 * sound.current_a * plant.resistance_ohm
    small = drained(WeakBattery(capacity_scale=0.5))
    assert 1.0 - small.remaining == pytest.approx(2.0 * (1.0 - sound.remaining), rel=0.05)


@pytest.mark.parametrize(
    "fault",
    [
        Payload(0.5),
        CentreOfMass(0.02, 0.0),
        WeakBattery(3.0, 0.5),
        ThrustScale(0.7),
        InertiaScale(2.0),
        MotorFault(1, 0.7),
    ],
)
def test_the_autopilot_is_not_told(fault: ModelFault) -> None:
    engine = ScalarEngine([VehicleSpec(1, 0, 47.4)], load())
    blocks = engine.blocks(0)
    before = (engine.believed, repr(blocks.sensed), repr(blocks.est), repr(blocks.flight))
    inject(fault, blocks)
    assert blocks.body != Body()
    assert (engine.believed, repr(blocks.sensed), repr(blocks.est), repr(blocks.flight)) == before
    assert engine.believed == believed_of(load(), DT_S)
