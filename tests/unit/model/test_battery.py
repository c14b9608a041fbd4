"""The battery is spent by what is flown."""

from __future__ import annotations

import pytest

from tests.unit.model.bodies import PLANTS, hover_speed, standing
from vehicle_sim.plant.battery import BATTERY_EVERY, FULL_CELL_V, drain, settle
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.cell_voltage import cell_v
from vehicle_sim.plant.constants import Plant

EVERY = pytest.mark.parametrize("plant", PLANTS.values(), ids=PLANTS)
UPDATE_S = 0.1
CURVE = (
    *((0.0, 3.00), (0.05, 3.45), (0.10, 3.60), (0.20, 3.70)),
    *((0.40, 3.78), (0.60, 3.88), (0.80, 4.02), (1.0, 4.20)),
)


def turning(plant: Plant, speed: float) -> Body:
    body = standing(plant)
    body.s1 = body.s2 = body.s3 = body.s4 = speed
    return body


@EVERY
def test_a_fresh_battery_is_full(plant: Plant) -> None:
    body = standing(plant)
    idle_sag_v = plant.idle_current_a * plant.resistance_ohm
    assert body.remaining == 1.0
    assert body.voltage_v == pytest.approx(plant.cells * FULL_CELL_V - idle_sag_v)
    assert body.strength == pytest.approx(1.0, abs=0.002)


@EVERY
def test_current_over_time_is_charge(plant: Plant) -> None:
    body, flown_mah = turning(plant, 0.5), 0.0
    assert plant.dt_s * BATTERY_EVERY == pytest.approx(UPDATE_S)
    for _ in range(600):
        drain(body, plant)
        flown_mah += body.current_a * UPDATE_S / 3.6
    assert body.consumed_mah == pytest.approx(flown_mah)
    assert body.remaining == pytest.approx(1.0 - flown_mah / plant.capacity_mah)


@EVERY
def test_power_goes_with_the_cube_of_the_speed(plant: Plant) -> None:
    def motor_w(speed: float) -> float:
        body = turning(plant, speed)
        for _ in range(20):
            drain(body, plant)
            body.consumed_mah = 0.0
        return (body.current_a - plant.idle_current_a) * body.voltage_v

    assert motor_w(0.8) == pytest.approx(8.0 * motor_w(0.4), rel=1e-6)


@EVERY
def test_the_voltage_sags_by_current_times_resistance(plant: Plant) -> None:
    body = turning(plant, 0.9)
    drain(body, plant)
    open_v = plant.cells * cell_v(body.remaining)
    assert open_v - body.voltage_v == pytest.approx(body.current_a * plant.resistance_ohm)
    assert open_v - body.voltage_v > 0.5


@EVERY
def test_a_sagging_battery_turns_the_motors_less(plant: Plant) -> None:
    body = turning(plant, 1.0)
    drain(body, plant)
    assert body.strength == pytest.approx(body.voltage_v / (plant.cells * FULL_CELL_V))
    assert body.strength < 0.95


def test_the_curve_goes_through_its_points_and_never_falls() -> None:
    assert [cell_v(charge) for charge, _ in CURVE] == pytest.approx([volts for _, volts in CURVE])
    volts = [cell_v(step / 1000.0) for step in range(1001)]
    assert volts == sorted(volts)


@pytest.mark.parametrize(("name", "low_min", "high_min"), [("s500", 10, 20), ("racer250", 4, 8)])
def test_it_hovers_as_long_as_its_class_does(name: str, low_min: float, high_min: float) -> None:
    """To a fifth of the charge, where pilots land."""
    plant = PLANTS[name]
    body, seconds = turning(plant, hover_speed(plant)), 0.0
    while body.remaining > 0.2:
        drain(body, plant)
        seconds += UPDATE_S
    assert low_min < seconds / 60.0 < high_min
    assert body.voltage_v / plant.cells > 3.5
    assert body.strength > hover_speed(plant)


@EVERY
def test_drained_to_the_end_it_is_empty_and_its_voltage_never_rose(
    plant: Plant,
) -> None:
    body, volts = turning(plant, hover_speed(plant)), []
    while body.remaining > 0.0:
        drain(body, plant)
        volts.append(body.voltage_v)
    sag_v = body.current_a * plant.resistance_ohm
    assert volts[-1] == pytest.approx(plant.cells * 3.0 - sag_v, rel=0.05)
    while body.consumed_mah < 1.1 * plant.capacity_mah:
        drain(body, plant)
        volts.append(body.voltage_v)
    assert volts == sorted(volts, reverse=True)
    assert volts[-1] == 0.0, "it does not hold its last voltage for ever"


@EVERY
def test_a_lost_cell_takes_its_voltage_and_leaves_the_charge(plant: Plant) -> None:
    body = turning(plant, 0.0)
    drain(body, plant)
    before_v, left = body.voltage_v, body.remaining
    body.cells_lost = 1.0
    settle(body, plant)
    assert before_v - body.voltage_v == pytest.approx(cell_v(left))
    assert body.remaining == left
    assert body.strength == pytest.approx(0.75, abs=0.01)


@EVERY
def test_without_cells_there_is_no_voltage_and_no_thrust(plant: Plant) -> None:
    body = turning(plant, 0.5)
    body.cells_lost = plant.cells
    drain(body, plant)
    assert (body.voltage_v, body.strength) == (0.0, 0.0)
