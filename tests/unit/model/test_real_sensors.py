"""`--sensors real`: how far GPS wanders, the barometer drifts and the rotors shake, as in life.

The figures are those of the review of the vehicle: "0.15 m wander against 0.5-1.5; baro drift 0.1 m
in 120 s against 1-2", and a VIBRATION that "reads a hundredth of life" (a hover of a sound frame
reads some m/s^2: ArduPilot's page on vibrations calls less than 15 good; by memory).
"""

from __future__ import annotations

from math import hypot, sqrt
from statistics import fmean

import pytest

from tests.unit.autopilot.flight import HOMES, Flight
from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.engine.choose_engine import engine_for
from vehicle_sim.engine.step import Seat, VehicleSpec
from vehicle_sim.plant.airframe import load
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.sensed import Sensed
from vehicle_sim.plant.sensors import (
    BARO_AT,
    BARO_EVERY,
    GPS_EVERY,
    GPS_TAKEN_AT,
    MEMS,
    REAL,
    SensorGrade,
    sense,
    switch_on,
)

STEPS_PER_S = 250


def standing_sensors(vehicle: int, grade: SensorGrade) -> Sensed:
    sensed = Sensed()
    switch_on(sensed, 1, vehicle, 47.4, grade)
    return sensed


def wander_m(grade: SensorGrade) -> float:
    """Root mean square of the horizontal error of a fix, of 20 receivers over a minute."""
    squares = []
    for vehicle in range(20):
        sensed = standing_sensors(vehicle, grade)
        for k in range(GPS_TAKEN_AT, 60 * STEPS_PER_S, GPS_EVERY):
            sense(sensed, Body(), grade, k)
            squares.append(hypot(sensed.taken_n, sensed.taken_e) ** 2)
    return sqrt(fmean(squares))


def drift_m(grade: SensorGrade) -> float:
    """Root mean square of what the height by pressure of one at rest changes in 120 s."""
    squares = []
    for vehicle in range(40):
        sensed = standing_sensors(vehicle, grade)
        heights = []
        for k in range(BARO_AT, 125 * STEPS_PER_S, BARO_EVERY):
            sense(sensed, Body(), grade, k)
            heights.append(sensed.baro_up_m)
        a_second = STEPS_PER_S // BARO_EVERY
        squares.append((fmean(heights[-a_second:]) - fmean(heights[:a_second])) ** 2)
    return sqrt(fmean(squares))


def flight(personality: Personality, grade: SensorGrade, seed: int = 1) -> Flight:
    home = HOMES[personality]
    engine = engine_for([VehicleSpec(seed, 0, home.lat_deg)], load(), grade)
    made = Flight(personality, seed)
    made.vehicle = Autopilot(personality, home, seed, seat=Seat(engine, 0))
    return made.airborne(10.0)


def test_gps_wanders_by_half_a_metre_to_one_and_a_half() -> None:
    assert 0.5 < wander_m(REAL) < 1.5
    assert wander_m(MEMS) < 0.4


def test_the_barometer_drifts_by_one_to_two_metres_in_two_minutes() -> None:
    assert 1.0 < drift_m(REAL) < 2.0
    assert drift_m(MEMS) < 0.2


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_the_rotors_shake_as_a_sound_frames_do(personality: Personality) -> None:
    shaken = flight(personality, REAL).vehicle.vibration_m_s2
    assert all(3.0 < axis < 15.0 for axis in shaken)
    steady = flight(personality, MEMS).vehicle.vibration_m_s2
    assert all(axis < 0.3 for axis in steady)


def test_what_shakes_adds_up_to_no_speed() -> None:
    body, sensed = Body(), standing_sensors(0, REAL)
    body.s1 = body.s2 = body.s3 = body.s4 = 1.0
    still = standing_sensors(0, REAL)
    gained_m_s, felt = 0.0, []
    for k in range(1, 10 * STEPS_PER_S):
        sense(sensed, body, REAL, k)
        sense(still, Body(), REAL, k)
        felt.append(sensed.accel_x - still.accel_x)
        gained_m_s += felt[-1] / STEPS_PER_S
    assert sqrt(fmean(x * x for x in felt)) == pytest.approx(REAL.vibration_m_s2, rel=0.1)
    assert abs(gained_m_s) < 0.15


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
@pytest.mark.parametrize("seed", [1, 2])
def test_it_still_hovers_and_lands(personality: Personality, seed: int) -> None:
    made = flight(personality, REAL, seed)
    far_m = 0.0
    for _ in range(60):
        made.fly(1.0)
        n, e, d = made.vehicle.truth.pos_ned
        far_m = max(far_m, hypot(n, e), abs(-d - 10.0))
    assert 0.5 < far_m < 6.0, "as far as its sensors wander"
    assert made.vehicle.land() is Result.ACCEPTED
    made.fly(60.0, lambda: not made.vehicle.armed)
    assert made.vehicle.truth.landed
