"""The estimate against the truth, in flights that are flown by the estimate."""

from __future__ import annotations

from math import hypot, pi, sqrt
from statistics import fmean

import pytest

from tests.unit.estimator.flown import STEPS_A_SECOND, Flown, attitude_error_deg
from vehicle_sim.estimation.corrections import hold_position
from vehicle_sim.estimation.estimated import Estimated
from vehicle_sim.estimation.estimator import align, estimate, health
from vehicle_sim.numerics.gravity import GRAVITY_M_S2
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.sensed import Sensed
from vehicle_sim.plant.sensors import IDEAL, MEMS, sense, switch_on

SEEDS = range(4)
AIRFRAMES = ("s500", "racer250")


def stand(body: Body, seconds: float, seed: int = 1) -> tuple[Estimated, Sensed]:
    """A body that does not move, seen for so long from power-up."""
    sensed, est = Sensed(), Estimated()
    switch_on(sensed, seed, 0, 47.4, MEMS)
    for k in range(1, round(seconds * STEPS_A_SECOND) + 1):
        sense(sensed, body, MEMS, k)
        estimate(est, sensed, k)
    return est, sensed


# ----------------------------------------------------------------------------------- start


def test_it_is_aligned_in_0_4_s_and_has_a_position_soon_after() -> None:
    vehicle = Flown()
    seen: dict[str, int] = {}
    for k in range(1, 301):
        vehicle.engine.step()
        judged = health(vehicle.est, vehicle.sensed)
        for name in ("attitude_ok", "gps_ok", "position_ok", "velocity_ok", "height_ok"):
            if getattr(judged, name):
                seen.setdefault(name, k)
    assert seen["attitude_ok"] == seen["gps_ok"] == 100
    assert seen["position_ok"] == seen["velocity_ok"] == 120
    assert seen["height_ok"] == 100
    assert vehicle.est.resets == 0


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    "q",
    [(1.0, 0.0, 0.0, 0.0), (0.7, 0.0, 0.0, -0.7), (0.05, 0.02, -0.04, 1.0), (0.9, 0.2, 0.1, 0.3)],
)
def test_it_finds_its_attitude_whatever_the_heading_and_the_slope(
    q: tuple[float, float, float, float], seed: int
) -> None:
    size = sqrt(sum(part * part for part in q))
    w, x, y, z = (part / size for part in q)
    body = Body(qw=w, qx=x, qy=y, qz=z)
    est, sensed = stand(body, 0.4, seed)
    same = abs(est.qw * body.qw + est.qx * body.qx + est.qy * body.qy + est.qz * body.qz)
    # 2.5 degrees altogether: accelerometer bias, hard iron and noise over a steep field.
    assert 2.0 * sqrt(max(0.0, 1.0 - same * same)) < 2.5 * pi / 180.0
    assert est.gyro_bias_x == pytest.approx(sensed.gyro_bias_x, abs=0.0015)
    assert est.gyro_bias_z == pytest.approx(sensed.gyro_bias_z, abs=0.0015)


def test_align_forgets_everything() -> None:
    vehicle = Flown()
    vehicle.fly(2.0)
    align(vehicle.est)
    assert vehicle.est == Estimated()


def test_a_reboot_in_flight_aligns_when_it_has_come_to_rest() -> None:
    vehicle = Flown()
    vehicle.lift_off(up_m=6.0)
    align(vehicle.est)
    vehicle.flight.flying = False
    vehicle.flight.idle = 0.0
    vehicle.fly(0.5)
    assert not health(vehicle.est, vehicle.sensed).attitude_ok
    vehicle.fly(8.0)
    judged = health(vehicle.est, vehicle.sensed)
    assert judged.attitude_ok
    assert judged.position_ok
    rest = vehicle.fly(2.0)
    assert rest.tilt_deg < 1.0
    assert rest.pos_m < 0.8


def test_it_does_not_align_while_it_is_carried_about() -> None:
    body = Body(rate_z=0.5)
    est, sensed = stand(body, 2.0)
    assert not health(est, sensed).attitude_ok
    body.rate_z = 0.0
    for k in range(501, 611):
        sense(sensed, body, MEMS, k)
        estimate(est, sensed, k)
    assert health(est, sensed).attitude_ok
    assert est.gyro_bias_z == pytest.approx(sensed.gyro_bias_z, abs=0.0015)


# ---------------------------------------------------------------------------------- flight


@pytest.mark.parametrize("airframe", AIRFRAMES)
def test_with_ideal_sensors_the_estimate_is_the_truth(airframe: str) -> None:
    vehicle = Flown(airframe=airframe, grade=IDEAL)
    vehicle.lift_off()
    vehicle.go_at(8.0, -6.0)
    vehicle.turn(2.0)
    worst = vehicle.fly(5.0)
    assert worst.true_tilt_deg > 25.0
    assert worst.tilt_deg < 1e-5
    assert worst.yaw_deg < 1e-5
    assert worst.pos_m < 1e-6
    assert worst.vel_m_s < 1e-6
    assert worst.height_m < 1e-6


@pytest.mark.parametrize("airframe", AIRFRAMES)
@pytest.mark.parametrize("seed", SEEDS)
def test_hovering_it_is_close_to_the_truth(seed: int, airframe: str) -> None:
    vehicle = Flown(seed, airframe)
    vehicle.lift_off()
    vehicle.fly(5.0)
    tilt, position, height = [], [], []
    for _ in range(10 * STEPS_A_SECOND):
        vehicle.engine.step()
        body, est = vehicle.body, vehicle.est
        tilt.append(attitude_error_deg(vehicle.blocks)[0])
        position.append(hypot(est.pos_n - body.pos_n, est.pos_e - body.pos_e))
        height.append(abs(est.pos_d - body.pos_d))
    assert fmean(tilt) < 0.5
    assert max(tilt) < 0.7
    assert max(position) < 0.6
    assert max(height) < 0.4
    # It is a real estimate: it errs.
    assert fmean(tilt) > 0.02
    assert max(position) > 0.03


@pytest.mark.parametrize("airframe", AIRFRAMES)
@pytest.mark.parametrize("seed", SEEDS)
def test_attitude_survives_hard_manoeuvres(seed: int, airframe: str) -> None:
    vehicle = Flown(seed, airframe)
    vehicle.lift_off()
    for north_m_s, east_m_s in ((12.0, 0.0), (0.0, 12.0), (-12.0, 0.0), (0.0, -12.0)):
        vehicle.go_at(north_m_s, east_m_s)
        vehicle.turn(pi / 2.0)
        worst = vehicle.fly(5.0)
        assert worst.true_tilt_deg > 30.0
        assert worst.tilt_deg < 2.0
        assert worst.yaw_deg < 4.0
        assert worst.vel_m_s < 0.4
        assert worst.pos_m < 0.8


def test_a_circle_of_a_minute_does_not_wear_it_down() -> None:
    vehicle = Flown()
    vehicle.lift_off()
    flight = vehicle.flight
    flight.speed_m_s = 8.0
    flight.centre_n, flight.centre_e = vehicle.est.pos_n, vehicle.est.pos_e - 20.0
    flight.turn_rad_s = 0.3  # 6 m/s at 20 m: 1.8 m/s^2, always leaning the same way
    vehicle.fly(10.0)
    worst = vehicle.fly(50.0)
    assert worst.true_tilt_deg > 8.0
    assert worst.tilt_deg < 1.0
    assert worst.pos_m < 0.8


def test_a_gyroscope_that_drifts_is_learnt_and_shows_meanwhile() -> None:
    vehicle = Flown()
    vehicle.lift_off()
    vehicle.sensed.gyro_off_x = 0.03
    shown = vehicle.fly(3.0)
    assert 0.8 < shown.tilt_deg < 8.0
    vehicle.fly(30.0)
    est, sensed = vehicle.est, vehicle.sensed
    assert est.gyro_bias_x == pytest.approx(sensed.gyro_bias_x + 0.03, abs=0.002)
    assert vehicle.fly(3.0).tilt_deg < 1.0


def test_an_accelerometer_that_errs_upwards_is_learnt() -> None:
    vehicle = Flown()
    vehicle.lift_off()
    vehicle.sensed.accel_off_z = 0.3
    assert vehicle.fly(5.0).climb_m_s > 0.1
    vehicle.fly(20.0)
    bias = vehicle.sensed.accel_bias_z + 0.3
    assert vehicle.est.acc_off_d == pytest.approx(bias, abs=0.05)
    assert vehicle.fly(3.0).climb_m_s < 0.2


# ------------------------------------------------------------------------------------- GPS


@pytest.mark.parametrize("seed", SEEDS)
def test_without_gps_it_drifts_by_metres_in_ten_seconds_and_tens_in_half_a_minute(
    seed: int,
) -> None:
    vehicle = Flown(seed)
    vehicle.lift_off()
    vehicle.fly(10.0)
    vehicle.sensed.gps_lost = True
    ten = vehicle.fly(10.0)
    thirty = vehicle.fly(20.0)
    assert 0.3 < ten.pos_m < 8.0
    assert 2.0 < thirty.pos_m < 60.0
    assert thirty.tilt_deg < 2.0
    assert thirty.height_m < 0.6  # the barometer holds it
    est = vehicle.est
    assert est.dead_s == pytest.approx(30.0, abs=0.21)
    # What it says of its own accuracy is of the right size, and on the safe side.
    assert thirty.pos_m * 0.8 < est.accuracy_m < 60.0
    judged = health(est, vehicle.sensed)
    assert (judged.gps_fix, judged.satellites) == (1, 0)
    assert (judged.position_ok, judged.velocity_ok, judged.gps_ok) == (False,) * 3
    assert judged.attitude_ok
    assert judged.height_ok


def test_a_position_is_good_for_five_seconds_without_a_fix() -> None:
    vehicle = Flown()
    vehicle.lift_off()
    vehicle.sensed.gps_lost = True
    vehicle.fly(4.0)
    judged = health(vehicle.est, vehicle.sensed)
    assert (judged.gps_ok, judged.position_ok) == (False, True)
    vehicle.fly(2.0)
    assert not health(vehicle.est, vehicle.sensed).position_ok


def test_when_gps_comes_back_the_position_jumps_to_it_once() -> None:
    vehicle = Flown()
    vehicle.lift_off()
    vehicle.sensed.gps_lost = True
    vehicle.sensed.accel_off_x = 0.1
    lost = vehicle.fly(20.0)
    assert lost.pos_m > 5.0
    vehicle.sensed.gps_lost = False
    vehicle.sensed.accel_off_x = 0.0
    vehicle.fly(0.4)
    assert vehicle.est.resets == 1
    assert vehicle.fly(5.0).pos_m < 0.8
    assert vehicle.est.resets == 1
    judged = health(vehicle.est, vehicle.sensed)
    assert judged.position_ok
    assert judged.dead_s == 0.0
    assert judged.accuracy_m < 1.0


def test_after_a_short_silence_nothing_jumps() -> None:
    vehicle = Flown()
    vehicle.lift_off()
    vehicle.sensed.gps_lost = True
    vehicle.fly(8.0)
    vehicle.sensed.gps_lost = False
    vehicle.fly(3.0)
    assert vehicle.est.resets == 0
    assert vehicle.est.gps_used


def test_a_glitch_is_refused_for_five_seconds_then_believed() -> None:
    vehicle = Flown()
    vehicle.lift_off()
    vehicle.fly(5.0)
    vehicle.sensed.gps_off_e = 15.0
    refused = vehicle.fly(4.5)
    assert refused.pos_m < 2.0
    assert (vehicle.est.resets, vehicle.est.gps_used) == (0, False)
    assert vehicle.est.pos_ratio > 1.0
    vehicle.fly(1.2)
    assert (vehicle.est.resets, vehicle.est.gps_used) == (1, True)
    assert vehicle.est.pos_e - vehicle.body.pos_e == pytest.approx(15.0, abs=1.0)


def test_a_short_glitch_leaves_no_trace() -> None:
    vehicle = Flown()
    vehicle.lift_off()
    vehicle.fly(5.0)
    vehicle.sensed.gps_off_n = -40.0
    assert vehicle.fly(3.0).pos_m < 1.5
    vehicle.sensed.gps_off_n = 0.0
    assert vehicle.fly(5.0).pos_m < 1.5
    assert vehicle.est.resets == 0


# ---------------------------------------------------------------------- the other sensors


def test_without_a_magnetometer_the_heading_keeps_for_a_minute() -> None:
    vehicle = Flown()
    vehicle.lift_off()
    vehicle.sensed.mag_lost = True
    worst = vehicle.fly(60.0)
    assert worst.yaw_deg < 10.0
    assert not health(vehicle.est, vehicle.sensed).mag_ok
    assert worst.pos_m < 1.0


def test_a_magnetometer_beside_iron_turns_the_heading() -> None:
    vehicle = Flown()
    vehicle.lift_off()
    before_deg = attitude_error_deg(vehicle.blocks)[1]
    vehicle.sensed.mag_off_y = 0.1
    vehicle.fly(20.0)
    assert abs(attitude_error_deg(vehicle.blocks)[1] - before_deg) > 10.0


def test_without_a_barometer_gps_holds_the_height() -> None:
    vehicle = Flown()
    vehicle.lift_off()
    vehicle.sensed.baro_lost = True
    worst = vehicle.fly(30.0)
    assert worst.height_m < 1.5
    judged = health(vehicle.est, vehicle.sensed)
    assert (judged.baro_ok, judged.height_ok) == (False, True)


def test_a_barometer_that_jumps_is_refused_then_set_anew() -> None:
    vehicle = Flown()
    vehicle.lift_off()
    vehicle.sensed.baro_off_m = 25.0
    assert vehicle.fly(4.0).height_m < 1.0
    assert not health(vehicle.est, vehicle.sensed).baro_ok
    vehicle.fly(3.0)
    assert health(vehicle.est, vehicle.sensed).baro_ok
    assert vehicle.fly(10.0).height_m < 1.0


def test_with_no_sensor_but_the_imu_the_height_runs_away_and_is_not_called_good() -> None:
    vehicle = Flown()
    vehicle.lift_off()
    vehicle.sensed.baro_lost = vehicle.sensed.gps_lost = True
    vehicle.fly(10.0)
    assert not health(vehicle.est, vehicle.sensed).height_ok


def test_standing_still_it_says_so() -> None:
    est, sensed = stand(Body(), 20.0)
    assert hypot(est.vel_n, est.vel_e) < 0.15
    assert abs(est.vel_d) < 0.15
    assert est.acc_d == pytest.approx(0.0, abs=0.2)
    assert sensed.accel_z == pytest.approx(-GRAVITY_M_S2, abs=0.3)
    judged = health(est, sensed)
    assert max(judged.pos_ratio, judged.vel_ratio, judged.height_ratio, judged.mag_ratio) < 0.3


@pytest.mark.parametrize(("off_m_s", "used"), [(1.9, True), (2.1, False)])
def test_a_velocity_that_is_more_than_2_m_s_off_is_refused(off_m_s: float, used: bool) -> None:
    """Five deviations of 0.4 m/s: between EKF2_GPS_V_NOISE (0.3) and EK3_VELNE_M_NSE (0.5)."""
    vehicle = Flown()
    vehicle.lift_off()
    vehicle.fly(10.0)
    est, sensed = vehicle.est, vehicle.sensed
    sensed.gps_fresh = True
    sensed.gps_n, sensed.gps_e, sensed.gps_d = est.then_n, est.then_e, est.then_d
    sensed.gps_vel_n, sensed.gps_vel_e = est.then_vel_n, est.then_vel_e + off_m_s
    hold_position(est, sensed)
    assert est.gps_used is used
