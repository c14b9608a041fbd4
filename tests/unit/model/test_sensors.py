"""Each sensor by its figures: mean, spread, rate, latency, bias, limits."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, sin, sqrt
from statistics import fmean, pstdev

import pytest

from vehicle_sim.numerics.gravity import GRAVITY_M_S2
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.sensed import Sensed
from vehicle_sim.plant.sensors import (
    BARO_AT,
    BARO_EVERY,
    GPS_EVERY,
    GPS_TAKEN_AT,
    IDEAL,
    MAG_EVERY,
    MEMS,
    SensorGrade,
    sense,
    switch_on,
)

ZURICH_DEG = 47.4
STEP_S = 0.004


def on(seed: int = 1, vehicle: int = 0, grade: SensorGrade = MEMS) -> Sensed:
    sensed = Sensed()
    switch_on(sensed, seed, vehicle, ZURICH_DEG, grade)
    return sensed


def listen(
    read: Callable[[Sensed], float],
    steps: range,
    grade: SensorGrade = MEMS,
    body: Body | None = None,
    seed: int = 1,
) -> list[float]:
    """What `read` finds after each of `steps`."""
    sensed = on(seed, grade=grade)
    body = body or Body()
    heard = []
    for k in steps:
        sense(sensed, body, grade, k)
        heard.append(read(sensed))
    return heard


def correlation(values: list[float], lag: int) -> float:
    mean = fmean(values)
    spread = fmean((x - mean) ** 2 for x in values)
    pairs = zip(values[lag:], values[:-lag], strict=True)
    return fmean((a - mean) * (b - mean) for a, b in pairs) / spread


# ------------------------------------------------------------------------------------- IMU


@pytest.mark.parametrize("axis", "xyz")
@pytest.mark.parametrize(
    ("sensor", "white", "down"),
    [("gyro", MEMS.gyro_rad_s, 0.0), ("accel", MEMS.accel_m_s2, -GRAVITY_M_S2)],
)
def test_imu_noise_is_white_about_truth_and_bias(
    sensor: str, white: float, down: float, axis: str
) -> None:
    steps = range(1, 4001)
    heard = listen(lambda s: getattr(s, f"{sensor}_{axis}"), steps)
    bias = fmean(listen(lambda s: getattr(s, f"{sensor}_bias_{axis}"), steps))
    truth = down if axis == "z" else 0.0
    assert fmean(heard) == pytest.approx(truth + bias, abs=4.0 * white / sqrt(4000))
    assert pstdev(heard) == pytest.approx(white, rel=0.06)
    assert abs(correlation(heard, 1)) < 0.05


def test_the_axes_of_the_imu_err_independently() -> None:
    def read(sensed: Sensed) -> tuple[float, ...]:
        return (sensed.gyro_x, sensed.gyro_y, sensed.gyro_z, sensed.accel_x, sensed.accel_y)

    sensed, body = on(), Body()
    rows = []
    for k in range(1, 3001):
        sense(sensed, body, MEMS, k)
        rows.append(read(sensed))
    columns = []
    for column in zip(*rows, strict=True):
        mean, deviation = fmean(column), pstdev(column)
        columns.append([(x - mean) / deviation for x in column])
    for i, one in enumerate(columns):
        for other in columns[:i]:
            assert abs(fmean(a * b for a, b in zip(one, other, strict=True))) < 0.08


def test_biases_are_of_the_power_up_and_spread_as_the_data_sheet_says() -> None:
    many = [on(seed=3, vehicle=vehicle) for vehicle in range(400)]
    assert pstdev(s.gyro_bias_x for s in many) == pytest.approx(MEMS.gyro_bias_rad_s, rel=0.12)
    assert pstdev(s.accel_bias_y for s in many) == pytest.approx(MEMS.accel_bias_m_s2, rel=0.12)
    assert pstdev(s.mag_iron_z for s in many) == pytest.approx(MEMS.mag_iron_gauss, rel=0.12)
    assert fmean(s.gyro_bias_x for s in many) == pytest.approx(0.0, abs=0.001)
    assert on(seed=3).gyro_bias_x == many[0].gyro_bias_x
    assert on(seed=4).gyro_bias_x != many[0].gyro_bias_x


def test_biases_walk_with_the_root_of_time() -> None:
    seconds = 100
    moved = []
    for vehicle in range(150):
        sensed, body = on(vehicle=vehicle), Body()
        before = sensed.gyro_bias_x
        for second in range(1, seconds + 1):
            sense(sensed, body, MEMS, 250 * second)
        moved.append(sensed.gyro_bias_x - before)
    assert pstdev(moved) == pytest.approx(MEMS.gyro_walk_rad_s * sqrt(seconds), rel=0.2)


def test_the_accelerometer_feels_the_specific_force_in_its_own_axes() -> None:
    lean = 0.3  # rad to the right
    body = Body(qw=cos(0.5 * lean), qx=sin(0.5 * lean))
    sensed = on(grade=IDEAL)
    sense(sensed, body, IDEAL, 1)
    assert sensed.accel_x == 0.0
    assert sensed.accel_y == pytest.approx(-GRAVITY_M_S2 * sin(lean), rel=1e-12)
    assert sensed.accel_z == pytest.approx(-GRAVITY_M_S2 * cos(lean), rel=1e-12)


def test_the_imu_clips_and_never_says_what_is_no_number() -> None:
    sensed = on(grade=IDEAL)
    sense(sensed, Body(rate_x=1e3, rate_y=-1e3, sf_n=1e6, sf_e=-1e6), IDEAL, 1)
    assert (sensed.gyro_x, sensed.gyro_y) == (34.9, -34.9)
    assert (sensed.accel_x, sensed.accel_y) == (156.9, -156.9)
    sense(sensed, Body(rate_z=float("nan"), sf_d=float("nan")), IDEAL, 2)
    assert (sensed.gyro_z, sensed.accel_z) == (34.9, 156.9)


def test_a_fault_of_the_imu_adds_to_what_it_says() -> None:
    sound, faulty = on(), on()
    faulty.gyro_off_z = 0.2
    faulty.accel_off_x = -1.5
    for sensed in (sound, faulty):
        sense(sensed, Body(), MEMS, 7)
    assert faulty.gyro_z - sound.gyro_z == pytest.approx(0.2)
    assert faulty.accel_x - sound.accel_x == pytest.approx(-1.5)


def test_noise_belongs_to_the_step_whoever_asked_before() -> None:
    often, once = on(), on()
    for k in range(1, 100):
        sense(often, Body(), MEMS, k)
    sense(once, Body(), MEMS, 99)
    assert (often.gyro_x, often.accel_z) == (once.gyro_x, once.accel_z)


# ---------------------------------------------------------------------------- magnetometer


def test_the_field_in_body_axes_follows_the_heading() -> None:
    sensed = on(grade=IDEAL)
    sense(sensed, Body(), IDEAL, MAG_EVERY)
    north = (sensed.mag_x, sensed.mag_y, sensed.mag_z)
    # The dipole at 47.4 degrees north: 0.21 gauss flat, 0.456 down.
    assert north == pytest.approx((0.2098, 0.0, 0.4564), abs=1e-4)
    half = sqrt(0.5)
    sense(sensed, Body(qw=half, qz=half), IDEAL, 2 * MAG_EVERY)  # the nose to the east
    assert (sensed.mag_x, sensed.mag_y) == pytest.approx((0.0, -north[0]), abs=1e-12)


def test_the_field_points_up_in_the_south_and_never_vanishes_at_a_pole() -> None:
    sensed = Sensed()
    switch_on(sensed, 1, 0, -35.4, MEMS)
    assert sensed.field_d == pytest.approx(-0.359, abs=1e-3)
    switch_on(sensed, 1, 0, 90.0, MEMS)
    assert sensed.field_n > 0.0


def test_the_magnetometer_answers_at_25_hz_with_noise_about_its_iron() -> None:
    steps = range(1, 20001)
    fresh = [k for k, new in zip(steps, listen(lambda s: s.mag_fresh, steps), strict=True) if new]
    assert fresh == list(range(MAG_EVERY, 20001, MAG_EVERY))
    heard = listen(lambda s: s.mag_y, range(MAG_EVERY, 20001, MAG_EVERY))
    assert fmean(heard) == pytest.approx(on().mag_iron_y, abs=4.0 * MEMS.mag_gauss / sqrt(2000))
    assert pstdev(heard) == pytest.approx(MEMS.mag_gauss, rel=0.07)


def test_a_lost_magnetometer_is_silent() -> None:
    sensed = on()
    sense(sensed, Body(), MEMS, MAG_EVERY)
    last = sensed.mag_x
    sensed.mag_lost = True
    sense(sensed, Body(), MEMS, 2 * MAG_EVERY)
    assert (sensed.mag_x, sensed.mag_fresh) == (last, False)


# ------------------------------------------------------------------------------- barometer


def test_the_barometer_answers_at_25_hz_with_noise_and_slow_drift() -> None:
    steps = range(BARO_AT, 200_000, BARO_EVERY)
    heard = listen(lambda s: s.baro_up_m, steps)
    drift = listen(lambda s: s.baro_drift_m, steps)
    white = [a - b for a, b in zip(heard, drift, strict=True)]
    assert pstdev(white) == pytest.approx(MEMS.baro_m, rel=0.05)
    assert abs(fmean(white)) < 0.01
    assert abs(correlation(white, 1)) < 0.05
    # A Gauss-Markov process of two minutes, seen for thirteen.
    assert 0.4 * MEMS.baro_drift_m < sqrt(fmean(x * x for x in drift)) < 1.6 * MEMS.baro_drift_m
    assert correlation(drift, 250) > 0.7
    fresh = listen(lambda s: s.baro_fresh, range(1, 41))
    assert [k for k, new in enumerate(fresh, 1) if new] == [5, 15, 25, 35]


def test_the_barometer_lags_by_fifty_milliseconds() -> None:
    grade = SensorGrade(baro_m=0.0, baro_drift_m=0.0)
    sensed = on(grade=grade)
    climbed = Body(pos_d=-10.0)
    heard = []
    for sample in range(20):
        sense(sensed, climbed, grade, BARO_AT + sample * BARO_EVERY)
        heard.append(sensed.baro_up_m)
    # Backward Euler of a first-order lag: 1 - (tau / (tau + T))^n.
    keep = 0.05 / (0.05 + 0.04)
    assert heard == pytest.approx([10.0 * (1.0 - keep ** (n + 1)) for n in range(20)])


def test_a_lost_barometer_is_silent_and_a_faulty_one_is_off() -> None:
    sound, faulty = on(), on()
    faulty.baro_off_m = 12.0
    for sensed in (sound, faulty):
        sense(sensed, Body(), MEMS, BARO_AT)
    assert faulty.baro_up_m - sound.baro_up_m == pytest.approx(12.0)
    last = faulty.baro_up_m
    faulty.baro_lost = True
    sense(faulty, Body(), MEMS, BARO_AT + BARO_EVERY)
    assert (faulty.baro_up_m, faulty.baro_fresh) == (last, False)


# ------------------------------------------------------------------------------------- GPS


def test_a_fix_comes_at_5_hz_and_is_120_ms_old() -> None:
    sensed, body = on(grade=IDEAL), Body(vel_n=10.0)
    assert sensed.gps_fix == 0.0
    fixes = {}
    for k in range(1, 501):
        body.pos_n = body.vel_n * k * STEP_S
        sense(sensed, body, IDEAL, k)
        if sensed.gps_fresh:
            fixes[k] = sensed.gps_n
    assert list(fixes) == list(range(GPS_EVERY, 501, GPS_EVERY))
    late = [10.0 * k * STEP_S - north for k, north in fixes.items()]
    assert late == pytest.approx([1.2] * 10)
    assert sensed.gps_vel_n == 10.0
    assert sensed.gps_fix == 3.0


def test_fixes_are_noisy_about_a_slow_wander() -> None:
    sensed, body = on(seed=5), Body()
    white, wander, speed = [], [], []
    for fix in range(6000):
        sense(sensed, body, MEMS, GPS_TAKEN_AT + fix * GPS_EVERY)
        sense(sensed, body, MEMS, (fix + 1) * GPS_EVERY)
        wander.append(sensed.gps_wander_n)
        white.append(sensed.gps_n - sensed.gps_wander_n)
        speed.append(sensed.gps_vel_e)
    assert pstdev(white) == pytest.approx(MEMS.gps_m, rel=0.04)
    assert pstdev(speed) == pytest.approx(MEMS.gps_m_s, rel=0.04)
    assert abs(fmean(speed)) < 0.003
    assert sqrt(fmean(x * x for x in wander)) == pytest.approx(MEMS.gps_wander_m, rel=0.4)
    # It forgets with a minute: e^(-10/60) after ten seconds.
    assert correlation(wander, 50) == pytest.approx(0.85, abs=0.1)


def test_without_satellites_there_is_no_fix_and_the_last_position_stays() -> None:
    sensed, body = on(), Body(pos_e=5.0)
    for k in range(1, 101):
        sense(sensed, body, MEMS, k)
    last = sensed.gps_e
    sensed.gps_lost = True
    body.pos_e = 50.0
    for k in range(101, 301):
        sense(sensed, body, MEMS, k)
        assert not sensed.gps_fresh
    assert (sensed.gps_fix, sensed.gps_e) == (0.0, last)
    sensed.gps_lost = False
    for k in range(301, 352):
        sense(sensed, body, MEMS, k)
    assert sensed.gps_fix == 3.0
    assert sensed.gps_e == pytest.approx(50.0, abs=1.0)


def test_a_glitch_moves_every_fix() -> None:
    sound, glitching = on(), on()
    glitching.gps_off_n, glitching.gps_off_d = 30.0, -4.0
    for sensed in (sound, glitching):
        for k in range(1, 51):
            sense(sensed, Body(), MEMS, k)
    assert glitching.gps_n - sound.gps_n == pytest.approx(30.0)
    assert glitching.gps_d - sound.gps_d == pytest.approx(-4.0)
