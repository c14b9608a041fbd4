"""The estimator's attitude, one sample or step at a time: alignment, levelling, heading, and how a
step carries it on.

The numbers are the design of `corrections.py` and `estimator.py`, written as what they do.
"""

from __future__ import annotations

from math import asin, atan2, cos, pi, sin, sqrt

import pytest

from tests.unit.estimator.aligned import BEGAN_S, G, flying
from vehicle_sim.estimation.corrections import hold_attitude
from vehicle_sim.estimation.estimated import Estimated
from vehicle_sim.estimation.estimator import estimate
from vehicle_sim.plant.sensed import Sensed

# ------------------------------------------------------------------------ attitude, 25 Hz


def field(north: float, east: float, fresh: bool = True) -> Sensed:
    return Sensed(mag_x=north, mag_y=east, mag_z=0.4, mag_fresh=fresh)


def test_the_field_turns_the_nose_by_0_5_a_second() -> None:
    est = flying()
    hold_attitude(est, field(0.3, 0.4))
    off = 0.8  # sine of the angle between north and where the field seems to come from
    assert 2.0 * est.qz == pytest.approx(-0.5 * 0.04 * off, rel=1e-3)
    assert est.gyro_bias_z == pytest.approx(0.1 * 0.5 * 0.04 * off, rel=1e-3)
    assert est.mag_ratio == pytest.approx(0.2 * off / 0.5)
    assert est.mag_s == 0.0
    assert est.age_s == pytest.approx(BEGAN_S + 0.04)
    behind = flying(mag_ratio=0.5)
    hold_attitude(behind, field(-0.3, -0.1))
    assert 2.0 * behind.qz == pytest.approx(0.5 * 0.04, rel=1e-3)
    assert behind.mag_ratio == pytest.approx(0.5 + 0.2 * (2.0 - 0.5))


def test_without_the_field_the_nose_stays_and_time_counts() -> None:
    est = flying(mag_ratio=0.3)
    hold_attitude(est, field(0.3, 0.4, fresh=False))
    assert (est.qz, est.mag_ratio) == (0.0, 0.3)
    assert est.mag_s == 0.04


@pytest.mark.parametrize(
    ("force", "levels"), [(0.97, False), (0.98, True), (1.02, True), (1.03, False)]
)
def test_without_gps_gravity_levels_where_its_square_is_within_5_percent(
    force: float, levels: bool
) -> None:
    """`acc_d` is without gravity: at rest 0, in a fall g."""
    est = flying(gps_used=False, acc_d=G * (1.0 - force))
    hold_attitude(est, field(0.4, 0.0))
    assert (est.qx, est.qy) == (0.0, 0.0)
    leaning = flying(gps_used=False, acc_n=0.1 * G, acc_d=G * (1.0 - sqrt(force**2 - 0.01)))
    hold_attitude(leaning, field(0.4, 0.0))
    # 0.05 /s of the angle; the gyroscope's bias learns 0.02 of the turn.
    assert 2.0 * leaning.qy == pytest.approx(0.05 * 0.04 * 0.1 if levels else 0.0, rel=1e-3)
    assert leaning.gyro_bias_y == pytest.approx(
        -0.02 * 0.05 * 0.04 * 0.1 if levels else 0.0, rel=1e-3
    )
    sideways = flying(gps_used=False, acc_e=0.1 * G, acc_d=G * (1.0 - sqrt(force**2 - 0.01)))
    hold_attitude(sideways, field(0.4, 0.0))
    assert 2.0 * sideways.qx == pytest.approx(-0.05 * 0.04 * 0.1 if levels else 0.0, rel=1e-3)


def test_with_gps_gravity_levels_nothing() -> None:
    est = flying(acc_n=0.1 * G)
    hold_attitude(est, field(0.4, 0.0))
    assert est.qy == 0.0


def test_a_bias_of_the_gyroscope_ends_at_0_1_rad_s() -> None:
    for sign in (1.0, -1.0):
        est = flying(gyro_bias_z=sign * 0.0999, gyro_bias_x=sign * 0.2, gyro_bias_y=-sign * 0.2)
        hold_attitude(est, field(0.0, sign * 0.4))
        assert (est.gyro_bias_x, est.gyro_bias_y) == (sign * 0.1, -sign * 0.1)
        assert est.gyro_bias_z == sign * 0.1


# ------------------------------------------------------------------------------- alignment


def standing(**values: float) -> Sensed:
    """At rest on level ground, nose north, in a field that dips."""
    sensed = Sensed(accel_z=-G, mag_x=0.2, mag_z=0.4, mag_fresh=True)
    for name, value in values.items():
        setattr(sensed, name, value)
    return sensed


def aligned(sensed: Sensed, samples: int = 1) -> Estimated:
    est = Estimated()
    for _ in range(samples):
        hold_attitude(est, sensed)
    return est


@pytest.mark.parametrize("axis", ["gyro_x", "gyro_y", "gyro_z"])
def test_it_aligns_turning_slower_than_0_1_rad_s(axis: str) -> None:
    for rate, still in ((0.099, True), (0.101, False), (-0.099, True), (-0.101, False)):
        est = aligned(standing(**{axis: rate}), 5)
        assert est.age_s == pytest.approx(0.2 if still else 0.0)
        assert getattr(est, axis.replace("gyro", "gyro_bias")) == pytest.approx(
            rate if still else 0.0, abs=1e-3
        )


@pytest.mark.parametrize(
    ("acc_d", "still"),
    [(0.0, True), (0.10 * G, True), (0.11 * G, False), (-0.09 * G, True), (-0.10 * G, False)],
)
def test_it_aligns_under_about_gravity(acc_d: float, still: bool) -> None:
    """Its square within a fifth: from 0.894 to 1.095 g."""
    est = Estimated(acc_d=acc_d)
    hold_attitude(est, standing())
    assert est.age_s == pytest.approx(0.04 if still else 0.0)


@pytest.mark.parametrize("heading_rad", [0.3, 1.5, 2.5, -0.4, -1.6, -3.0])
def test_the_first_sample_gives_the_heading_at_once(heading_rad: float) -> None:
    est = aligned(standing(mag_x=0.2 * cos(heading_rad), mag_y=-0.2 * sin(heading_rad)))
    yaw = atan2(2.0 * est.qw * est.qz, 1.0 - 2.0 * est.qz * est.qz)
    assert yaw == pytest.approx(heading_rad, abs=1e-6)


@pytest.mark.parametrize(("roll_rad", "pitch_rad"), [(0.3, 0.0), (0.0, 0.25), (-0.2, -0.15)])
def test_the_first_sample_gives_the_slope_at_once(roll_rad: float, pitch_rad: float) -> None:
    # The specific force and a field to the north that dips, as they are seen from there.
    cr, sr, cp, sp = cos(roll_rad), sin(roll_rad), cos(pitch_rad), sin(pitch_rad)

    def seen(n: float, d: float) -> tuple[float, float, float]:
        x, z = cp * n - sp * d, sp * n + cp * d
        return x, sr * z, cr * z

    accel, mag = seen(0.0, -G), seen(0.2, 0.4)
    est = aligned(
        standing(
            accel_x=accel[0], accel_y=accel[1], accel_z=accel[2],
            mag_x=mag[0], mag_y=mag[1], mag_z=mag[2],
        )
    )  # fmt: skip
    w, x, y, z = est.qw, est.qx, est.qy, est.qz
    assert atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)) == pytest.approx(
        roll_rad, abs=1e-6
    )
    assert asin(2.0 * (w * y - z * x)) == pytest.approx(pitch_rad, abs=1e-6)
    assert atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)) == pytest.approx(0.0, abs=1e-6)


def test_the_biases_are_the_mean_of_what_was_heard_standing() -> None:
    est = Estimated()
    for rate in (0.02, 0.04, 0.06, 0.08):
        hold_attitude(est, standing(gyro_x=rate, gyro_y=-rate, gyro_z=0.5 * rate))
    assert (est.gyro_bias_x, est.gyro_bias_y, est.gyro_bias_z) == pytest.approx(
        (0.05, -0.05, 0.025), abs=1e-4
    )


def test_what_aligns_does_not_move_and_what_flies_does() -> None:
    est = Estimated(vel_n=1.0, vel_e=2.0, vel_d=3.0)
    hold_attitude(est, standing())
    assert (est.vel_n, est.vel_e, est.vel_d) == (0.0, 0.0, 0.0)
    free = flying(vel_n=1.0, vel_e=2.0, vel_d=3.0)
    hold_attitude(free, standing())
    assert (free.vel_n, free.vel_e, free.vel_d) == (1.0, 2.0, 3.0)


# -------------------------------------------------------------------------- one step, 250 Hz


def test_a_step_turns_by_the_mean_rate_and_moves_by_the_mean_velocity() -> None:
    est = flying(gyro_bias_x=0.1, gyro_bias_y=-0.1, gyro_bias_z=0.2, rate_x=0.5, acc_off_d=0.25)
    sensed = Sensed(
        gyro_x=1.1, gyro_y=0.4, gyro_z=-0.2, accel_x=1.0, accel_y=-2.0, accel_z=-G + 0.5
    )
    estimate(est, sensed, 1)
    assert (est.rate_x, est.rate_y, est.rate_z) == pytest.approx((1.0, 0.5, -0.4))
    assert 2.0 * est.qx == pytest.approx(0.75 * 0.004, rel=1e-4)
    assert 2.0 * est.qy == pytest.approx(0.25 * 0.004, rel=1e-4)
    assert 2.0 * est.qz == pytest.approx(-0.2 * 0.004, rel=1e-4)
    assert (est.acc_n, est.acc_e, est.acc_d) == pytest.approx((1.0, -2.0, 0.25), abs=0.05)
    assert (est.vel_n, est.vel_e, est.vel_d) == pytest.approx(
        (0.004 * est.acc_n, 0.004 * est.acc_e, 0.004 * est.acc_d)
    )
    assert (est.pos_n, est.pos_e, est.pos_d) == pytest.approx(
        (0.002 * est.vel_n, 0.002 * est.vel_e, 0.002 * est.vel_d)
    )


def test_the_specific_force_is_turned_from_the_body_to_ned() -> None:
    half = sqrt(0.5)
    est = flying(qw=half, qz=half)  # nose east
    estimate(est, Sensed(accel_x=1.0, accel_y=2.0, accel_z=-G), 1)
    assert (est.acc_n, est.acc_e, est.acc_d) == pytest.approx((-2.0, 1.0, 0.0))
    upside_down = flying(qw=0.0, qx=1.0)
    estimate(upside_down, Sensed(accel_x=1.0, accel_y=2.0, accel_z=-G), 1)
    assert (upside_down.acc_n, upside_down.acc_e, upside_down.acc_d) == pytest.approx(
        (1.0, -2.0, 2.0 * G)
    )
    on_its_nose = flying(qw=half, qy=-half)
    estimate(on_its_nose, Sensed(accel_x=1.0, accel_y=2.0, accel_z=-G), 1)
    assert (on_its_nose.acc_n, on_its_nose.acc_e, on_its_nose.acc_d) == pytest.approx(
        (G, 2.0, G + 1.0)
    )


def test_sensors_are_heard_at_their_rates() -> None:
    """The magnetometer and the barometer at 25 Hz, the receiver at 5 Hz, of 250 steps a second."""
    ages, heights, fixes = set(), set(), set()
    for k in range(1, 251):
        est = flying()
        estimate(est, Sensed(accel_z=-G, mag_x=0.2, baro_fresh=False, gps_fresh=False), k)
        ages |= {k} if est.age_s != BEGAN_S else set()
        heights |= {k} if est.baro_s != 0.0 else set()
        fixes |= {k} if est.dead_s != 0.0 else set()
    assert (len(ages), len(heights), len(fixes)) == (25, 25, 5)
    assert not ages & heights
    assert fixes <= ages


def test_a_turn_keeps_the_quaternion_a_rotation() -> None:
    est = flying(qw=0.5, qx=0.5, qy=-0.5, qz=0.5)
    sensed = Sensed(gyro_x=pi, gyro_y=-2.0 * pi, gyro_z=3.0 * pi, mag_x=0.2, mag_fresh=True)
    for k in range(1, 501):
        estimate(est, sensed, k)
    assert est.qw**2 + est.qx**2 + est.qy**2 + est.qz**2 == pytest.approx(1.0, abs=1e-12)
