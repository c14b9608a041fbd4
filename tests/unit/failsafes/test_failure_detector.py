"""Attitude, thrust and motors: the limits and times of PX4's failure detector and ArduCopter's
crash check and thrust loss check, on both sides of each.

PX4: the parameters FD_*, FailureDetector.cpp, and failsafe.cpp for the first 3 s.  ArduCopter:
crash_check.cpp (CRASH_CHECK_ANGLE_DEVIATION_DEG 30, CRASH_CHECK_ACCEL_MAX 3, 2 s;
THRUST_LOSS_CHECK_ANGLE_DEVIATION_CD 15 degrees, THRUST_LOSS_CHECK_MINIMUM_THROTTLE 0.9, 1 s).
"""

from __future__ import annotations

from dataclasses import replace
from math import cos, radians
from typing import Final

import pytest

from tests.unit.failsafes.failsafe_inputs import MS, S, parameters_of
from vehicle_sim.autopilot.failsafes.failsafe import Action, Failsafe
from vehicle_sim.autopilot.failsafes.failure_detector import (
    FAILURE_DETECTORS,
    FailureDetector,
    Posture,
)
from vehicle_sim.autopilot.modes import Personality

HOVER: Final = (0.4, 0.4, 0.4, 0.4)
LEVEL: Final = Posture(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, HOVER, HOVER)
ARMED_NS: Final = 50 * S


def detector(personality: Personality, **values: float) -> FailureDetector:
    """Armed at `ARMED_NS`, and looked at once."""
    made = FAILURE_DETECTORS[personality](parameters_of(personality, values))
    assert not made.check(LEVEL, True, False, ARMED_NS)
    return made


def struck(
    of: FailureDetector,
    posture: Posture,
    at_ns: int,
    *,
    flying: bool = True,
    by_rates: bool = False,
) -> list[Action]:
    return [each.action for each in found(of, posture, at_ns, flying, by_rates)]


def found(
    of: FailureDetector, posture: Posture, at_ns: int, flying: bool = True, by_rates: bool = False
) -> list[Failsafe]:
    return of.check(posture, flying, by_rates, ARMED_NS + at_ns)


# ---------------------------------------------------------------------------------- attitude


def tilted(axis: str, angle_rad: float) -> Posture:
    if axis == "roll":
        return replace(LEVEL, roll_rad=angle_rad)
    return replace(LEVEL, pitch_rad=angle_rad)


@pytest.mark.parametrize("axis", ["roll", "pitch"])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_px4_is_upset_beyond_60_degrees_for_0_3_s(axis: str, sign: float) -> None:
    upset = tilted(axis, sign * radians(60.1))
    of = detector("px4", CBRK_FLIGHTTERM=0)
    assert not struck(of, tilted(axis, sign * radians(59.9)), 10 * S)
    assert not struck(of, upset, 20 * S)
    # 0.3 s as a float32 is 12 ns more.
    assert not struck(of, upset, 20 * S + 300 * MS)
    assert struck(of, upset, 20 * S + 300 * MS + 20) == [Action.TERMINATE]
    assert not struck(of, upset, 21 * S), "once"
    assert not struck(of, LEVEL, 22 * S)
    assert not struck(of, upset, 23 * S)
    assert not struck(of, upset, 23 * S + 299 * MS)
    assert struck(of, upset, 23 * S + 301 * MS) == [Action.TERMINATE]


def test_px4_disarms_in_the_first_3_s_and_the_breaker_makes_it_only_tell() -> None:
    upset = replace(LEVEL, roll_rad=radians(70.0))
    for since_ns, breaker, action in (
        (3 * S - 1, 0, Action.DISARM),
        (3 * S, 0, Action.TERMINATE),
        (3 * S - 1, 121212, Action.DISARM),
        (3 * S, 121212, Action.WARN),
    ):
        of = detector("px4", CBRK_FLIGHTTERM=breaker)
        struck(of, upset, since_ns - S)
        assert struck(of, upset, since_ns) == [action]


def test_px4_does_not_mind_the_attitude_by_rates_nor_with_a_limit_of_0() -> None:
    upset = replace(LEVEL, roll_rad=radians(170.0), pitch_rad=radians(80.0))
    of = detector("px4")
    for at_ns in (10 * S, 20 * S):
        assert not struck(of, upset, at_ns, by_rates=True)
    off = detector("px4", FD_FAIL_R=0, FD_FAIL_P=0)
    for at_ns in (10 * S, 20 * S):
        assert not struck(off, upset, at_ns)


# ------------------------------------------------------------------------------------ motors


def test_px4s_motor_is_dead_after_100_ms_with_less_than_a_tenth_of_what_was_asked() -> None:
    dead = replace(LEVEL, thrust=(0.4, 0.4, 0.039, 0.4))
    of = detector("px4")
    assert not struck(of, replace(dead, thrust=(0.4, 0.4, 0.041, 0.4)), 5 * S)
    assert not struck(of, dead, 10 * S)
    assert not struck(of, dead, 10 * S + 100 * MS - 1)
    (told,) = found(of, dead, 10 * S + 100 * MS)
    assert (told.action, "3" in told.text) == (Action.WARN, True)
    struck(of, LEVEL, 11 * S)
    struck(of, dead, 12 * S)
    assert not struck(of, dead, 13 * S), "each motor once a flight"
    of.reset()
    struck(of, dead, 14 * S)
    assert struck(of, dead, 15 * S) == [Action.WARN]


def test_px4_looks_for_dead_motors_above_a_fifth_of_the_throttle_and_not_with_fd_act_en_0() -> None:
    for asked, enabled, dead in ((0.21, 1, True), (0.19, 1, False), (0.21, 0, False)):
        posture = replace(LEVEL, asked=(asked, 0.0, 0.0, 0.0), thrust=(0.0, 0.0, 0.0, 0.0))
        of = detector("px4", FD_ACT_EN=enabled)
        struck(of, posture, 10 * S)
        assert bool(struck(of, posture, 11 * S)) is dead


@pytest.mark.parametrize(
    ("value", "action", "delayed"),
    [(0, None, False), (1, Action.HOLD, True), (2, Action.LAND, True), (3, Action.RETURN, True),
     (4, Action.TERMINATE, False)],
)  # fmt: skip
def test_px4_does_what_com_act_fail_act_says(
    value: int, action: Action | None, delayed: bool
) -> None:
    dead = replace(LEVEL, thrust=(0.0, 0.4, 0.4, 0.4))
    of = detector("px4", COM_ACT_FAIL_ACT=value)
    struck(of, dead, 10 * S)
    told, *acted = found(of, dead, 11 * S)
    assert told.action is Action.WARN
    assert [(each.action, each.delayed) for each in acted] == (
        [(action, delayed)] if action else []
    )


# ------------------------------------------------------------------------------- ArduCopter

FALLEN: Final = replace(LEVEL, off_rad=radians(30.1))


def test_ardupilot_has_crashed_after_2_s_more_than_30_degrees_off() -> None:
    of = detector("ardupilot")
    almost = replace(LEVEL, off_rad=radians(29.9))
    assert not struck(of, almost, 1 * S)
    assert not struck(of, almost, 9 * S)
    assert not struck(of, FALLEN, 10 * S)
    assert not struck(of, FALLEN, 12 * S - 1)
    assert struck(of, FALLEN, 12 * S) == [Action.DISARM]
    assert not struck(of, FALLEN, 13 * S), "once"


def test_ardupilot_has_not_crashed_while_it_accelerates_on_the_ground_or_by_rates() -> None:
    off = detector("ardupilot", FS_CRASH_CHECK=0)
    pushed, flown_by_rates, standing = (detector("ardupilot") for _ in range(3))
    for tenth in range(100):
        at_ns = tenth * 100 * MS
        assert not struck(off, FALLEN, at_ns)
        assert not struck(pushed, replace(FALLEN, accel_m_s2=8.0), at_ns)
        assert not struck(flown_by_rates, FALLEN, at_ns, by_rates=True)
        assert not struck(standing, FALLEN, at_ns, flying=False)


@pytest.mark.parametrize(("accel_m_s2", "crashed"), [(2.9, True), (3.1, False)])
def test_ardupilots_crash_takes_less_than_3_m_s2(accel_m_s2: float, crashed: bool) -> None:
    of = detector("ardupilot")
    posture = replace(FALLEN, accel_m_s2=accel_m_s2)
    for tenth in range(50):
        struck(of, replace(posture, off_rad=0.0), tenth * 100 * MS)
    struck(of, posture, 5 * S)
    assert bool(struck(of, posture, 7 * S)) is crashed


def test_ardupilots_acceleration_is_smoothed_with_1_hz() -> None:
    """Two steps at 10 Hz of dt / (dt + 1 / 2 pi f), 0.386, after 8 m/s^2: 3.02, then 5.0 m/s^2."""
    for size_m_s2, crashed in ((7.7, True), (7.8, False)):
        of = detector("ardupilot")
        struck(of, FALLEN, 10 * S)
        assert bool(struck(of, replace(FALLEN, accel_m_s2=size_m_s2), 12 * S)) is crashed


LOST: Final = replace(LEVEL, asked=(0.4, 0.4, 0.95, 0.4), climb_m_s=-0.1)


def test_ardupilot_tells_of_thrust_loss_after_1_s() -> None:
    of = detector("ardupilot")
    assert not struck(of, LOST, 10 * S)
    assert not struck(of, LOST, 11 * S - 1)
    (told,) = found(of, LOST, 11 * S)
    assert (told.action, "(3)" in told.text) == (Action.WARN, True)


@pytest.mark.parametrize(
    ("posture", "lost"),
    [
        (replace(LOST, lean_rad=radians(14.9)), True),
        (replace(LOST, lean_rad=radians(15.1)), False),
        (replace(LOST, off_rad=radians(29.9)), True),
        (replace(LOST, climb_m_s=0.0), False),
        (replace(LOST, asked=(0.9, 0.4, 0.4, 0.4)), True),
        (replace(LOST, asked=(0.89, 0.4, 0.4, 0.4)), False),
    ],
)
def test_what_ardupilot_calls_thrust_loss(posture: Posture, lost: bool) -> None:
    of = detector("ardupilot")
    struck(of, posture, 10 * S)
    assert bool(struck(of, posture, 11 * S)) is lost


def test_beyond_30_degrees_off_it_is_a_crash_and_no_thrust_loss() -> None:
    of = detector("ardupilot", FS_CRASH_CHECK=0)
    for at_ns in (10 * S, 12 * S):
        assert not struck(of, replace(LOST, off_rad=radians(30.1)), at_ns)


# ---------------------------------------------------------------------------- the quick look


@pytest.mark.parametrize(("personality", "least_deg"), [("px4", 60.0), ("ardupilot", 15.0)])
def test_the_quick_look_is_calm_below_the_least_lean_that_counts(
    personality: Personality, least_deg: float
) -> None:
    of = detector(personality)
    inside, outside = cos(radians(least_deg - 0.1)), cos(radians(least_deg + 0.1))
    assert of.nominal(inside, inside, 0.89, 0.4)
    assert not of.nominal(outside, 1.0, 0.5, 0.4)
    assert not of.nominal(1.0, outside, 0.5, 0.4)
    assert not of.nominal(1.0, 1.0, 0.9, 0.4)
    assert of.nominal(1.0, 1.0, 0.5, 0.05)
    assert not of.nominal(1.0, 1.0, 0.5, 0.049)


def test_the_quick_look_follows_fd_fail_r_and_fd_fail_p() -> None:
    of = detector("px4", FD_FAIL_R=40, FD_FAIL_P=20)
    assert of.nominal(cos(radians(19.0)), 1.0, 0.5, 0.4)
    assert not of.nominal(cos(radians(21.0)), 1.0, 0.5, 0.4)
    off = detector("px4", FD_FAIL_R=0, FD_FAIL_P=0)
    assert off.nominal(cos(radians(89.0)), 1.0, 0.5, 0.4)
    assert not off.nominal(cos(radians(91.0)), 1.0, 0.5, 0.4)


def test_the_quick_look_is_not_calm_before_the_first_check_nor_while_something_lasts() -> None:
    of = FAILURE_DETECTORS["px4"](parameters_of("px4"))
    assert not of.nominal(1.0, 1.0, 0.5, 0.4)
    struck(of, replace(LEVEL, roll_rad=1.5), 0)
    assert not of.nominal(1.0, 1.0, 0.5, 0.4)
    struck(of, LEVEL, S)
    assert of.nominal(1.0, 1.0, 0.5, 0.4)
