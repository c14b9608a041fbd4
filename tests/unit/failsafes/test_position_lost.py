"""When an estimate of the position is lost, and what is done then: on both sides of each number.

PX4's are those of its parameter reference, ArduCopter's of its parameter list and ekf_check.cpp.
"""

from __future__ import annotations

from dataclasses import replace

import pytest

from tests.unit.failsafes.failsafe_inputs import (
    BAD,
    EKF_LIMIT,
    WELL,
    Look,
    acts,
    clears,
    warns,
)
from vehicle_sim.autopilot.failsafes.failsafe import (
    Action,
    Cause,
)
from vehicle_sim.estimation.estimator import Health


def test_px4_has_lost_its_position_beyond_com_pos_fs_eph() -> None:
    """5 m, and descends; less than zero is no limit."""
    look = Look("px4")
    assert not look.sees(health=replace(WELL, accuracy_m=5.0))
    assert acts(look.sees(health=replace(WELL, accuracy_m=5.1)), Cause.POSITION) == [Action.DESCEND]
    assert look.position_lost()
    assert not look.sees(), "once"
    assert clears(look.sees(health=WELL), Cause.POSITION)
    assert not look.position_lost()
    look.parameters.set("COM_POS_FS_EPH", -1.0)
    assert not look.sees(health=replace(WELL, accuracy_m=900.0))
    lost = replace(WELL, position_ok=False)
    assert acts(look.sees(health=lost), Cause.POSITION) == [Action.DESCEND]
    assert not look.sees(needs_position=False)
    assert look.position_lost(), "what is flown meanwhile needs none"


@pytest.mark.parametrize(
    ("mode", "sticks", "navl", "action"),
    [
        ("POSCTL", True, 0, Action.ALTITUDE),
        ("POSCTL", True, 1, Action.DESCEND),
        ("POSCTL", False, 0, Action.DESCEND),
        ("AUTO.LOITER", True, 0, Action.DESCEND),
    ],
)
def test_px4_keeps_its_height_by_hand_where_com_posctl_navl_is_0(
    mode: str, sticks: bool, navl: int, action: Action
) -> None:
    look = Look("px4", {"COM_POSCTL_NAVL": navl})
    struck = look.sees(
        mode=look.modes[mode], sticks=sticks, health=replace(WELL, position_ok=False)
    )
    assert acts(struck, Cause.POSITION) == [action]


def test_px4_does_not_mind_where_no_position_is_needed() -> None:
    look = Look("px4")
    assert not look.sees(needs_position=False, health=replace(WELL, position_ok=False))


@pytest.mark.parametrize(
    ("health", "bad"),
    [
        (replace(WELL, mag_ratio=2.0), False),
        (replace(WELL, mag_ratio=2.0, vel_ratio=0.79), False),
        (BAD, True),
        (replace(WELL, pos_ratio=EKF_LIMIT, vel_ratio=EKF_LIMIT), True),
        (replace(WELL, position_ok=False), True),
    ],
)
def test_ardupilots_estimate_is_bad_where_two_of_three_variances_reach_fs_ekf_thresh(
    health: Health, bad: bool
) -> None:
    """ekf_check.cpp: 0.8, ten times in a row."""
    look = Look("ardupilot")
    for _ in range(9):
        assert not look.sees(health=health)
    assert acts(look.sees(), Cause.POSITION) == ([Action.DESCEND] if bad else [])
    assert look.position_lost() is bad


def test_ardupilot_needs_as_many_good_checks_as_it_had_bad_ones() -> None:
    look = Look("ardupilot")
    for _ in range(9):
        look.sees(health=BAD)
    look.sees(health=WELL)
    assert not look.sees(health=BAD), "8, then 9"
    assert acts(look.sees(), Cause.POSITION)
    for _ in range(5):
        assert not look.sees(), "no more than ten are counted"
    for _ in range(9):
        assert not look.sees(health=WELL)
    assert clears(look.sees(), Cause.POSITION)
    assert not look.position_lost()
    for _ in range(9):
        assert not look.sees(health=BAD)
    assert acts(look.sees(), Cause.POSITION)


@pytest.mark.parametrize(
    ("choice", "needs", "action"),
    [
        (0, True, []),
        (1, True, [Action.DESCEND]),
        (2, True, [Action.ALTITUDE]),
        (3, True, [Action.DESCEND]),
        (1, False, []),
        (2, False, []),
        (3, False, [Action.DESCEND]),
    ],
)
def test_ardupilot_does_what_fs_ekf_action_says(
    choice: int, needs: bool, action: list[Action]
) -> None:
    look = Look("ardupilot", {"FS_EKF_ACTION": choice})
    for _ in range(9):
        look.sees(health=BAD, needs_position=needs)
    struck = look.sees()
    assert warns(struck, Cause.POSITION)
    assert acts(struck, Cause.POSITION) == action


def test_ardupilot_does_not_look_at_the_estimate_with_fs_ekf_thresh_0() -> None:
    look = Look("ardupilot", {"FS_EKF_THRESH": 0.0})
    for _ in range(20):
        assert not look.sees(health=BAD)
