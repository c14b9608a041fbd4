"""GPS lost and GPS wrong, in a hover and in a mission: what the vehicle does, in truth."""

from __future__ import annotations

from math import hypot

import pytest

from tests.unit.autopilot.flight import item
from tests.unit.faults.stage import HOVERS, S, Stage, aloft, far
from vehicle_sim.autopilot.interface import Truth
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.wire import messages as m

BOTH: tuple[Personality, ...] = ("px4", "ardupilot")
either = pytest.mark.parametrize("personality", BOTH)
LANDS: dict[Personality, str] = {"px4": "AUTO.LAND", "ardupilot": "LAND"}
NOT_ARMED: dict[Personality, tuple[str, ...]] = {
    "px4": ("Preflight Fail: no valid position estimate",),
    "ardupilot": (
        "Mode change to Guided failed: requires position",
        "Arm: Land mode not armable",
    ),
}
FOR_10_S = "[[fault]]\nat_s = 20\nfor_s = 10\nkind = 'gps_lost'\n"
FOR_GOOD = "[[fault]]\nat_s = 20\nkind = 'gps_lost'\n"
NO_FIX, FIX_3D = 1, 3
CRITICAL, EMERGENCY = 5, 6
PRED_POS_HORIZ_ABS = 512


def glitch(north_m: float, for_s: float | None = None) -> str:
    lasts = "" if for_s is None else f"for_s = {for_s}\n"
    return f"[[fault]]\nat_s = 20\n{lasts}kind = 'gps_glitch'\noffset_ned_m = [{north_m}, 0, 0]\n"


class Wanderer:
    """How far from a place the truth has been at most."""

    def __init__(self, stage: Stage) -> None:
        self.from_ned = stage.truth.pos_ned
        self.most_m = 0.0

    def __call__(self, truth: Truth) -> None:
        self.most_m = max(self.most_m, far(truth, self.from_ned))


def test_px4_without_gps_for_10_s_descends_meanwhile_and_goes_on_where_it_is() -> None:
    stage = aloft("px4", FOR_10_S)
    away = Wanderer(stage)
    stage.run(4.5, away)
    assert stage.last(m.GpsRawInt).fix_type == NO_FIX
    assert stage.mode == "AUTO.LOITER", "dead reckoning is good for five seconds"
    stage.run(1.0, away)
    assert stage.said("Failsafe activated")
    assert stage.mode == "AUTO.LAND"
    assert stage.last(m.Heartbeat).system_status == EMERGENCY
    stage.run_to(30.0)
    low_m = stage.up_m
    assert 2.0 < low_m < 8.5
    stage.run(1.5, away)
    assert stage.last(m.GpsRawInt).fix_type == FIX_3D
    assert stage.mode == "AUTO.LOITER"
    stage.run(8.0, away)
    assert stage.mode == "AUTO.LOITER"
    assert abs(stage.up_m - low_m) < 1.5, "it does not climb back by itself"
    assert stage.speed_m_s < 0.3
    assert stage.astray_m < 1.0
    assert away.most_m < 3.0


def test_ardupilot_without_gps_for_10_s_lands_and_goes_on_landing() -> None:
    stage = aloft("ardupilot", FOR_10_S)
    away = Wanderer(stage)
    stage.run(5.5, away)
    assert stage.mode == "GUIDED"
    stage.run(1.0, away)
    assert stage.said("EKF Failsafe: changed to Land Mode")
    assert stage.mode == "LAND"
    stage.run(5.0, away)
    assert stage.said("EKF Failsafe Cleared")
    stage.until(lambda: not stage.armed, 40.0)
    assert stage.mode == "LAND"
    assert stage.up_m < 0.1
    assert away.most_m < 4.0


@either
def test_without_gps_for_good_it_comes_down_near_by_and_does_not_arm_again(
    personality: Personality,
) -> None:
    stage = aloft(personality, FOR_GOOD)
    away = Wanderer(stage)
    fell: list[float] = []
    stage.run(8.0, away)
    assert stage.mode == LANDS[personality]
    while stage.armed:
        stage.run(0.1, away)
        fell.append(stage.truth.v_ned[2])
        assert stage.now_ns < 70 * S
    assert max(fell) < 2.5, "a descent, not a fall"
    assert stage.up_m < 0.1
    assert away.most_m < 5.0
    if personality == "ardupilot":
        assert stage.command(176, 1, 4) != 0
    assert stage.command(400, 1) != 0
    for words in NOT_ARMED[personality]:
        assert stage.said(words)


@either
def test_a_small_glitch_is_believed_and_flown_after(personality: Personality) -> None:
    """Two metres are within the gate: who trusts its receiver goes where that puts it."""
    stage = aloft(personality, glitch(2.0))
    at = stage.truth.pos_ned
    stage.run(15.0)
    assert stage.mode == HOVERS[personality]
    assert stage.truth.pos_ned[0] - at[0] == pytest.approx(-2.0, abs=0.6)
    assert abs(stage.truth.pos_ned[1] - at[1]) < 0.6


@either
def test_a_large_glitch_that_ends_in_time_is_not_flown_after(personality: Personality) -> None:
    stage = aloft(personality, glitch(60.0, for_s=3.0))
    away, told_before = Wanderer(stage), stage.texts
    stage.run(1.0, away)
    raw, told = stage.last(m.GpsRawInt), stage.last(m.GlobalPositionInt)
    assert (raw.lat - told.lat) * 0.0111 == pytest.approx(60.0, abs=3.0), "the receiver says so"
    stage.run(14.0, away)
    assert stage.mode == HOVERS[personality]
    assert stage.texts == told_before
    assert stage.vehicle.health.resets == 0
    assert away.most_m < 0.8


def test_px4_takes_a_glitch_that_stays_for_its_place_and_holds_there() -> None:
    """Refused for five seconds, then the estimate is set on it: the map moves, not the vehicle."""
    stage = aloft("px4", glitch(60.0))
    away = Wanderer(stage)
    stage.run(4.5, away)
    assert stage.astray_m < 1.0
    stage.run(20.0, away)
    assert stage.said("Failsafe activated")
    assert stage.mode == "AUTO.LOITER"
    assert stage.vehicle.health.resets == 1
    assert stage.astray_m == pytest.approx(60.0, abs=2.0)
    assert away.most_m < 1.5


def test_ardupilot_flies_to_its_goal_on_the_map_that_a_glitch_has_moved() -> None:
    stage = aloft("ardupilot", glitch(60.0))
    away = Wanderer(stage)
    at = stage.truth.pos_ned
    stage.run(30.0, away)
    assert stage.mode == "GUIDED"
    assert stage.truth.pos_ned[0] - at[0] == pytest.approx(-60.0, abs=2.0)
    assert away.most_m < 62.0
    assert abs(stage.up_m - 10.0) < 1.0


@either
def test_a_mission_without_gps_is_left_and_ends_near_the_line(personality: Personality) -> None:
    stage = aloft(personality, FOR_GOOD)
    vehicle = stage.vehicle
    north = tuple(item(seq, 16, 20.0 * seq, 0.0, 10.0) for seq in range(6))
    assert vehicle.check_plan(north) is None
    vehicle.load_plan(north)
    assert stage.command(300) == 0
    stage.run_to(27.0)
    assert stage.mode == LANDS[personality]
    stage.until(lambda: not stage.armed, 60.0)
    assert stage.up_m < 0.1
    north_m, east_m, _ = stage.truth.pos_ned
    # Level without a position it does not brake: it coasts until the air has stopped it.
    assert abs(east_m) < 8.0
    assert 5.0 < north_m < 100.0


def test_px4_goes_on_with_its_mission_when_gps_is_back() -> None:
    stage = aloft("px4", FOR_10_S)
    vehicle = stage.vehicle
    plan = tuple(item(seq, 16, 15.0 * seq, 0.0, 10.0) for seq in range(4))
    vehicle.load_plan(plan)
    assert stage.command(300) == 0
    stage.run_to(29.0)
    assert stage.mode == "AUTO.LAND"
    stage.run_to(31.5)
    assert stage.mode == "AUTO.MISSION"
    stage.until(lambda: stage.mode == "AUTO.LOITER", 60.0)
    north_m, east_m, down_m = stage.truth.pos_ned
    assert hypot(north_m - 45.0, east_m) < 2.5
    assert abs(down_m + 10.0) < 1.5


def test_px4_that_trusts_longer_descends_later() -> None:
    """COM_POS_FS_EPH limits the trust in dead reckoning; the estimator's own five seconds too."""
    early = aloft("px4", FOR_GOOD, parameters={"COM_POS_FS_EPH": 1.0})
    assert early.until(lambda: early.mode == "AUTO.LAND") < 3.5
    late = aloft("px4", FOR_GOOD)
    assert 4.5 < late.until(lambda: late.mode == "AUTO.LAND") < 5.8


def test_ekf_status_report_tells_of_the_lost_position() -> None:
    stage = aloft("ardupilot", FOR_GOOD)
    assert stage.last(m.EkfStatusReport).flags & PRED_POS_HORIZ_ABS
    stage.run(8.0)
    assert not stage.last(m.EkfStatusReport).flags & PRED_POS_HORIZ_ABS
