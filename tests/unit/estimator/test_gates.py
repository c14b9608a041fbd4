"""The estimator's gates, times and gains, one sample at a time: what a sensor may say, and how much
of it is believed.

The numbers are the design of `corrections.py` (its poles and gates), written here as what one
sample does to an estimate.
"""

from __future__ import annotations

from math import inf

import pytest

from tests.unit.estimator.aligned import G, flying
from vehicle_sim.estimation.corrections import hold_height, hold_position
from vehicle_sim.estimation.estimated import Estimated
from vehicle_sim.estimation.estimator import booted, health, position_ok
from vehicle_sim.plant.sensed import Sensed


def fix(**values: float) -> Sensed:
    """A fresh fix at the place where the estimate is."""
    sensed = Sensed(gps_fresh=True, gps_fix=3.0)
    for name, value in values.items():
        setattr(sensed, name, value)
    return sensed


def silent() -> Sensed:
    return Sensed(gps_fresh=False)


# -------------------------------------------------------------------------- position, 5 Hz


@pytest.mark.parametrize(
    ("off", "used"),
    [
        ({"gps_n": 3.49}, True),
        ({"gps_n": 3.51}, False),
        ({"gps_e": -3.49}, True),
        ({"gps_e": -3.51}, False),
        ({"gps_n": 2.5, "gps_e": 2.5}, False),
        ({"gps_vel_n": 1.99}, True),
        ({"gps_vel_n": 2.01}, False),
        ({"gps_vel_e": -2.01}, False),
        ({"gps_d": 40.0}, True),
        ({"gps_vel_d": 40.0}, True),
    ],
)
def test_a_fix_is_refused_beyond_3_5_m_or_2_m_s(off: dict[str, float], used: bool) -> None:
    est = flying()
    hold_position(est, fix(**off))
    assert est.gps_used is used
    assert est.dead_s == pytest.approx(0.0 if used else 0.2)
    if not used:
        assert (est.pos_n, est.pos_e, est.vel_n, est.vel_e) == (0.0, 0.0, 0.0, 0.0)


def test_a_fix_on_the_gate_is_still_used() -> None:
    for off in ({"gps_n": 3.5}, {"gps_vel_e": 2.0}):
        est = flying()
        hold_position(est, fix(**off))
        assert est.gps_used


def test_a_fix_moves_the_estimate_by_its_gains() -> None:
    """At 5 Hz: position 0.6 /s, velocity 1.5 /s, climb 0.5 /s, the barometer's shift 1/60 /s."""
    est = flying()
    sensed = fix(gps_n=1.0, gps_e=-2.0, gps_d=3.0, gps_vel_n=0.5, gps_vel_e=-0.25, gps_vel_d=2.0)
    hold_position(est, sensed)
    assert (est.pos_n, est.pos_e) == pytest.approx((0.12, -0.24))
    assert (est.vel_n, est.vel_e) == pytest.approx((0.15, -0.075))
    assert est.vel_d == pytest.approx(0.2)
    assert est.baro_shift_m == pytest.approx(3.0 / 300.0)
    assert est.pos_d == 0.0
    # A velocity to the north that was missed is a nose that is lower than believed: 0.75 /s / g.
    assert 2.0 * est.qy == pytest.approx(-0.75 * 0.2 / G * 0.5, rel=1e-3)
    assert 2.0 * est.qx == pytest.approx(-0.75 * 0.2 / G * 0.25, rel=1e-3)
    assert est.gyro_bias_y == pytest.approx(0.12 * 0.75 * 0.2 / G * 0.5, rel=1e-3)
    assert est.gyro_bias_x == pytest.approx(0.12 * 0.75 * 0.2 / G * 0.25, rel=1e-3)
    assert est.gyro_bias_z == pytest.approx(0.0, abs=1e-12)


def test_it_is_compared_with_the_estimate_of_when_it_was_taken() -> None:
    est = flying(then_n=5.0, then_e=6.0, then_d=7.0, then_vel_n=1.0, then_vel_e=2.0, then_vel_d=3.0)
    hold_position(
        est,
        fix(gps_n=5.0, gps_e=6.0, gps_d=7.0, gps_vel_n=1.0, gps_vel_e=2.0, gps_vel_d=3.0),
    )
    assert est.gps_used
    assert (est.pos_n, est.pos_e, est.pos_d, est.vel_n, est.vel_e, est.vel_d) == (0.0,) * 6


def test_a_height_of_the_receiver_counts_5_m_off_at_most_and_a_climb_5_m_s() -> None:
    for down_m, counted_m in ((40.0, 5.0), (-40.0, -5.0), (4.0, 4.0)):
        est = flying(baro_s=0.0)
        hold_position(est, fix(gps_d=down_m, gps_vel_d=down_m))
        assert est.baro_shift_m == pytest.approx(counted_m / 300.0)
        assert est.vel_d == pytest.approx(0.1 * counted_m)


@pytest.mark.parametrize(("silent_s", "by_gps"), [(0.96, False), (1.0, True), (5.0, True)])
def test_without_the_barometer_for_1_s_gps_holds_the_height(silent_s: float, by_gps: bool) -> None:
    est = flying(baro_s=silent_s)
    hold_position(est, fix(gps_d=2.0))
    assert est.pos_d == pytest.approx(0.2 if by_gps else 0.0)
    assert est.baro_shift_m == pytest.approx(0.0 if by_gps else 2.0 / 300.0)


def test_after_5_s_of_refused_fixes_it_jumps_to_the_next_one() -> None:
    est = flying()
    far = fix(gps_n=30.0, gps_e=-40.0, gps_vel_n=4.0, gps_vel_e=5.0, gps_vel_d=2.0)
    for _ in range(25):
        hold_position(est, far)
    assert (est.resets, est.pos_n, est.gps_used) == (0, 0.0, False)
    assert est.dead_s == pytest.approx(5.0)
    hold_position(est, far)
    assert (est.resets, est.gps_used, est.dead_s) == (1, True, 0.0)
    assert (est.pos_n, est.pos_e) == (30.0, -40.0)
    assert (est.vel_n, est.vel_e, est.vel_d) == (4.0, 5.0, 2.0)
    assert (est.qx, est.qy, est.gyro_bias_x, est.gyro_bias_y) == (0.0,) * 4
    assert est.baro_shift_m == 0.0


def test_the_time_to_a_jump_is_ekf2_noaid_tout() -> None:
    for no_aid_s, refused in ((2.0, 10), (1.0, 5)):
        est = flying(no_aid_s=no_aid_s)
        far = fix(gps_n=30.0)
        for _ in range(refused):
            hold_position(est, far)
        assert est.resets == 0
        hold_position(est, far)
        assert est.resets == 1


def test_after_silence_a_near_fix_makes_no_jump() -> None:
    est = flying(dead_s=20.0)
    hold_position(est, fix(gps_n=1.0))
    assert est.resets == 0
    assert est.pos_n == pytest.approx(0.12)


def test_the_first_fix_is_taken_whole_and_is_no_reset() -> None:
    est = flying(placed=False)
    hold_position(est, fix(gps_n=100.0, gps_e=7.0))
    assert (est.pos_n, est.pos_e, est.resets, est.placed) == (100.0, 7.0, 0, True)


@pytest.mark.parametrize(("age_s", "used"), [(0.36, False), (0.4, True)])
def test_no_fix_is_used_before_0_4_s_of_alignment(age_s: float, used: bool) -> None:
    est = flying(age_s=age_s, placed=False, gps_used=False)
    hold_position(est, fix())
    assert est.gps_used is used
    assert est.placed is used


def test_without_fixes_the_accuracy_is_0_4_m_and_0_2_t_and_0_02_t_squared() -> None:
    est = flying()
    for _ in range(50):
        hold_position(est, silent())
    assert est.dead_s == pytest.approx(10.0)
    assert est.accuracy_m == pytest.approx(0.4 + 2.0 + 2.0)
    assert not est.gps_used
    est.dead_s = 400.0
    hold_position(est, silent())
    assert est.accuracy_m == 1000.0
    hold_position(est, fix())
    assert est.accuracy_m == 0.4


def test_the_ratios_are_a_fifth_of_the_newest_and_only_of_fixes() -> None:
    est = flying(pos_ratio=0.5, vel_ratio=0.5)
    hold_position(est, fix(gps_n=7.0, gps_vel_e=3.0))
    assert est.pos_ratio == pytest.approx(0.5 + 0.2 * (2.0 - 0.5))
    assert est.vel_ratio == pytest.approx(0.5 + 0.2 * (1.5 - 0.5))
    before = (est.pos_ratio, est.vel_ratio)
    hold_position(est, silent())
    assert (est.pos_ratio, est.vel_ratio) == before


# ------------------------------------------------------------------------- height, 25 Hz


def pressure(up_m: float) -> Sensed:
    return Sensed(baro_up_m=up_m, baro_fresh=True)


def test_a_sample_of_the_barometer_moves_height_climb_and_the_learnt_lift() -> None:
    """At 25 Hz: 2.1 /s, 1.47 /s^2, 0.34 /s^3."""
    est = flying()
    hold_height(est, pressure(1.0))
    assert est.pos_d == pytest.approx(-2.1 * 0.04)
    assert est.vel_d == pytest.approx(-1.47 * 0.04)
    assert est.acc_off_d == pytest.approx(0.34 * 0.04)
    assert est.height_ratio == pytest.approx(0.2 * 1.0 / 5.0)
    assert est.baro_s == 0.0
    shifted = flying(baro_shift_m=3.0, pos_d=2.0)
    hold_height(shifted, pressure(1.0))
    assert shifted.pos_d == 2.0


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_height_is_refused_more_than_5_m_off(sign: float) -> None:
    for off_m, used in ((4.99, True), (5.0, True), (5.01, False)):
        est = flying()
        hold_height(est, pressure(sign * off_m))
        assert (est.pos_d != 0.0) is used
        assert est.baro_s == (0.0 if used else 0.04)
        assert est.height_ratio == pytest.approx(0.2 * off_m / 5.0)


def test_a_height_refused_for_5_s_is_set_anew_where_the_estimate_is() -> None:
    est = flying(pos_d=-10.0)
    for _ in range(125):
        hold_height(est, pressure(20.0))
    assert est.baro_shift_m == 0.0
    hold_height(est, pressure(20.0))
    assert est.baro_shift_m == pytest.approx(10.0)
    assert (est.pos_d, est.vel_d, est.baro_s) == (-10.0, 0.0, 0.0)
    gone = flying(baro_s=9.0)
    hold_height(gone, Sensed(baro_up_m=20.0, baro_fresh=False))
    assert gone.baro_shift_m == 0.0


def test_without_a_sample_nothing_moves_and_time_counts() -> None:
    est = flying(height_ratio=0.3)
    hold_height(est, Sensed(baro_up_m=1.0, baro_fresh=False))
    assert (est.pos_d, est.vel_d, est.acc_off_d, est.height_ratio) == (0.0, 0.0, 0.0, 0.3)
    assert est.baro_s == 0.04


def test_the_learnt_lift_ends_at_1_m_s2() -> None:
    for sign in (1.0, -1.0):
        est = flying(acc_off_d=sign * 0.999)
        hold_height(est, pressure(sign * 4.0))
        assert est.acc_off_d == sign * 1.0


def test_while_it_aligns_the_height_is_a_running_mean_without_a_gate() -> None:
    est = Estimated(age_s=0.08)
    hold_height(est, pressure(100.0))
    assert est.pos_d == pytest.approx(-50.0)
    assert (est.vel_d, est.acc_off_d) == (0.0, 0.0)
    first = Estimated(age_s=0.0)
    hold_height(first, pressure(100.0))
    assert first.pos_d == pytest.approx(-100.0)
    almost = Estimated(age_s=0.36)
    hold_height(almost, pressure(9.0))
    assert almost.pos_d == pytest.approx(-1.0)
    aligned = Estimated(age_s=0.4)
    hold_height(aligned, pressure(9.0))
    assert aligned.pos_d == 0.0


# ---------------------------------------------------------------------------------- health


def test_what_health_calls_good() -> None:
    sensed = Sensed(gps_fix=3.0)
    good = health(flying(), sensed)
    assert good.attitude_ok
    assert good.position_ok
    assert good.velocity_ok
    assert good.height_ok
    assert good.mag_ok
    assert good.baro_ok
    assert (good.gps_fix, good.satellites, good.eph_m, good.epv_m) == (3, 12, 0.6, 0.9)
    assert not health(flying(mag_ratio=1.0), sensed).mag_ok
    assert health(flying(mag_ratio=0.99), sensed).mag_ok
    assert not health(flying(mag_s=1.0), sensed).mag_ok
    assert health(flying(mag_s=0.99), sensed).mag_ok
    assert not health(flying(baro_s=1.0), sensed).baro_ok
    assert health(flying(baro_s=0.99), sensed).baro_ok
    assert health(flying(baro_s=1.0), sensed).height_ok, "GPS carries it"
    assert health(flying(dead_s=9.0), sensed).height_ok, "the barometer carries it"
    assert not health(flying(baro_s=1.0, dead_s=9.0), sensed).height_ok
    none = health(flying(), Sensed(gps_fix=0.0))
    assert (none.gps_fix, none.satellites, none.eph_m, none.epv_m) == (1, 0, inf, inf)


def test_attitude_is_good_from_0_4_s_and_a_position_from_0_48_s() -> None:
    sensed = Sensed(gps_fix=3.0)
    young = health(flying(age_s=0.36), sensed)
    assert not young.attitude_ok
    assert not young.baro_ok
    assert not young.mag_ok
    assert not young.position_ok
    older = health(flying(age_s=0.40), sensed)
    assert older.attitude_ok
    assert not older.position_ok
    assert not booted(flying(age_s=0.44))
    assert booted(flying(age_s=0.48))
    assert position_ok(flying(age_s=0.48))


def test_a_position_is_good_until_5_s_without_a_fix() -> None:
    assert position_ok(flying(dead_s=4.99))
    assert not position_ok(flying(dead_s=5.0))
    assert not position_ok(flying(placed=False))
