"""How long a mission is in the air, against recorded flights of a PX4 and an ArduCopter."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from gcs.frames import Vec3
from gcs.gate.airspace.projection import Origin, Projection
from gcs.plan.flight_time import DAY_S, FlightTime, TimeWalk, flight_time, from_rest_s
from gcs.plan.legs import Ground, LandingPlace
from gcs.plan.model import AutopilotName, Frame, Geographic, Item, Local, Plan
from gcs.plan.settings import USUAL
from gcs.wire.ids import Cmd

HOME = (0.0, 0.0, 0.0)
IN_AIR = (0.0, 0.0, -10.0)
RETURN_UP_M: dict[AutopilotName, float] = {"px4": 30.0, "ardupilot": 15.0}

_WGS = Origin(47.397742, 8.545594, 488.0)


def ground(
    autopilot: AutopilotName = "px4", start_ned: Vec3 = IN_AIR, *, on_ground: bool = False
) -> Ground:
    return Ground(
        autopilot,
        HOME,
        start_ned,
        Projection(_WGS, autopilot).north_east,
        488.0,
        RETURN_UP_M[autopilot],
        USUAL[autopilot],
        on_ground=on_ground,
    )


def item(command: int, *params: float, to: tuple[float, float, float] = (0.0, 0.0, 10.0)) -> Item:
    north, east, up = to
    p1, p2, p3, p4 = (*params, 0.0, 0.0, 0.0, 0.0)[:4]
    return Item(command, Frame.LOCAL, (p1, p2, p3, p4), Local(north, east, up), 0)


def flight(*items: Item, over: Ground | None = None, most_s: float = DAY_S) -> FlightTime:
    numbered = tuple(replace(one, do_jump_id=n) for n, one in enumerate(items, start=1))
    plan = Plan("a test", None, None, numbered)
    if most_s == DAY_S:
        return flight_time(plan, over or ground())
    walk = TimeWalk(plan, over or ground(), most_s)
    for _ in walk.steps():
        pass
    assert walk.result is not None
    return walk.result


# --------------------------------------------------------------------- recorded flights


def here(command: int, *params: float, up: float) -> Item:
    """Its place is 0, 0: wherever the vehicle is."""
    place = Geographic(0.0, 0.0, up)
    return replace(item(command, *params), place=place, frame=Frame.HOME)


# Armed and in mission mode until disarmed, by the heartbeats of `scenarios_px4.json` (PX4 1.14.3)
# and `scenarios_arducopter.json` (ArduCopter 4.7); the items as they were uploaded, in metres.
RECORDED: dict[str, tuple[AutopilotName, tuple[Item, ...], float]] = {
    "C12_plan_without_takeoff_modes": (
        "px4",
        (
            item(Cmd.NAV_WAYPOINT, to=(8.0, 0.0, 5.0)),
            item(Cmd.NAV_WAYPOINT, to=(8.0, 8.0, 5.0)),
            item(Cmd.NAV_LAND, to=(0.0, 0.0, 0.0)),
        ),
        34.2,
    ),
    "C6_plan_without_takeoff": (
        "px4",
        (
            item(Cmd.NAV_WAYPOINT, to=(15.0, 0.0, 8.0)),
            item(Cmd.NAV_WAYPOINT, to=(15.0, 15.0, 8.0)),
            item(Cmd.NAV_RETURN_TO_LAUNCH),
        ),
        77.4,
    ),
    "C9d_jump_and_delay_flown": (
        "px4",
        (
            item(Cmd.NAV_TAKEOFF, to=(0.0, 0.0, 5.0)),
            item(Cmd.NAV_WAYPOINT, to=(8.0, 0.0, 5.0)),
            item(Cmd.NAV_WAYPOINT, to=(0.0, 0.0, 5.0)),
            item(Cmd.DO_JUMP, 2.0, 1.0),
            item(Cmd.NAV_DELAY, 3.0, -1.0, -1.0, -1.0),
            item(Cmd.NAV_LOITER_TIME, 4.0, 0.0, 5.0, to=(0.0, 0.0, 5.0)),
            item(Cmd.NAV_LAND, to=(0.0, 0.0, 0.0)),
        ),
        43.2,
    ),
    "C1_items_at_zero_position": (
        "ardupilot",
        (
            here(Cmd.NAV_TAKEOFF, up=8.0),
            here(Cmd.NAV_WAYPOINT, up=12.0),
            here(Cmd.NAV_LOITER_TURNS, 1.0, 0.0, 8.0, up=10.0),
            here(Cmd.NAV_SPLINE_WAYPOINT, up=10.0),
            item(Cmd.NAV_WAYPOINT, to=(15.0, 0.0, 10.0)),
            here(Cmd.NAV_WAYPOINT, up=0.0),
            here(Cmd.NAV_LAND, up=0.0),
        ),
        78.3,
    ),
    "C2_do_items_before_takeoff": (
        "ardupilot",
        (
            item(Cmd.DO_CHANGE_SPEED, 1.0, 3.0, -1.0),
            item(Cmd.NAV_DELAY, 5.0, -1.0, -1.0, -1.0),
            here(Cmd.NAV_TAKEOFF, up=8.0),
            item(Cmd.NAV_WAYPOINT, to=(0.0, 0.0, 8.0)),
            item(Cmd.NAV_RETURN_TO_LAUNCH),
        ),
        39.4,
    ),
}


@pytest.mark.parametrize("name", RECORDED)
def test_a_recorded_flight_took_as_long_or_less(name: str) -> None:
    autopilot, items, recorded_s = RECORDED[name]
    found = flight(*items, over=ground(autopilot, HOME, on_ground=True))
    assert found.whole
    # C2 returns from over home, where an ArduCopter does not climb to its return height.
    most = 1.6 if name.startswith("C2_") else 1.3
    assert recorded_s <= found.time_s <= most * recorded_s


# ------------------------------------------------------------------------------- jumps

OUT = item(Cmd.NAV_WAYPOINT, to=(50.0, 0.0, 10.0))
BACK = item(Cmd.NAV_WAYPOINT, to=(0.0, 0.0, 10.0))
DOWN = item(Cmd.NAV_LAND, to=(0.0, 0.0, 0.0))


def test_every_repetition_of_a_jump_is_counted() -> None:
    plain = flight(BACK, OUT, BACK, DOWN).time_s
    once = flight(BACK, OUT, BACK, item(Cmd.DO_JUMP, 2.0, 1.0), DOWN).time_s - plain
    ten_times = flight(BACK, OUT, BACK, item(Cmd.DO_JUMP, 2.0, 10.0), DOWN).time_s - plain
    assert once > 2 * 50.0 / 5.0
    assert ten_times == pytest.approx(10.0 * once)
    never = flight(BACK, OUT, BACK, item(Cmd.DO_JUMP, 2.0, 0.0), DOWN)
    assert never.time_s == pytest.approx(plain)


def test_a_jump_within_a_jump_is_counted_once_for_the_whole_flight() -> None:
    inner, outer = item(Cmd.DO_JUMP, 2.0, 3.0), item(Cmd.DO_JUMP, 2.0, 2.0)
    both = flight(BACK, OUT, BACK, inner, outer, DOWN).time_s
    five = flight(BACK, OUT, BACK, item(Cmd.DO_JUMP, 2.0, 5.0), DOWN).time_s
    assert both == pytest.approx(five)


def test_a_jump_to_a_tag_takes_as_long_as_one_to_its_item() -> None:
    tag = item(Cmd.JUMP_TAG, 5.0)
    for repeats in (0.0, 3.0, -1.0):
        by_tag = flight(BACK, tag, OUT, BACK, item(Cmd.DO_JUMP_TAG, 5.0, repeats), DOWN)
        assert by_tag == flight(BACK, tag, OUT, BACK, item(Cmd.DO_JUMP, 2.0, repeats), DOWN)


def test_a_jump_for_ever_is_counted_to_the_end_of_the_time_and_named() -> None:
    found = flight(BACK, OUT, BACK, item(Cmd.DO_JUMP, 2.0, -1.0), DOWN, most_s=600.0)
    assert (found.whole, found.endless) == (False, 3)
    assert 600.0 < found.time_s < 640.0
    assert flight(BACK, OUT, BACK, item(Cmd.DO_JUMP, 2.0, -1.0), DOWN).time_s == DAY_S


def test_a_jump_ahead_for_ever_ends() -> None:
    found = flight(BACK, item(Cmd.DO_JUMP, 4.0, -1.0), OUT, DOWN)
    assert (found.whole, found.endless, found.item) == (True, None, 3)


def test_many_items_that_take_no_time_are_as_long_as_a_day() -> None:
    photo = item(Cmd.IMAGE_START_CAPTURE)
    found = flight(photo, item(Cmd.DO_JUMP, 1.0, -1.0))
    assert (found.time_s, found.whole, found.endless) == (DAY_S, False, 1)


# ------------------------------------------------------------------------- waits, speeds


@pytest.mark.parametrize(
    ("waiting", "longer_s"),
    [
        (item(Cmd.NAV_DELAY, 90.0, -1.0, -1.0, -1.0), 90.0),
        (item(Cmd.NAV_DELAY, 0.0, -1.0, -1.0, -1.0), 0.0),
        (item(Cmd.CONDITION_DELAY, 90.0), 0.0),  # only of the next command that moves nothing
        (item(Cmd.NAV_LOITER_TIME, 90.0), 91.0),
        (item(Cmd.NAV_WAYPOINT, 90.0), 91.0),
        (item(Cmd.NAV_WAYPOINT, math.nan), 1.0),
    ],
)
def test_what_waits_is_counted(waiting: Item, longer_s: float) -> None:
    plain = flight(BACK, DOWN, over=ground("ardupilot")).time_s
    found = flight(BACK, waiting, DOWN, over=ground("ardupilot")).time_s
    assert found - plain == pytest.approx(longer_s)


def test_a_delay_until_a_time_of_day_is_as_long_as_a_day() -> None:
    found = flight(BACK, item(Cmd.NAV_DELAY, 0.0, 14.0, 30.0, 0.0), DOWN)
    assert found.time_s == DAY_S


def test_the_speed_that_an_item_sets_is_counted_with() -> None:
    far = item(Cmd.NAV_WAYPOINT, to=(600.0, 0.0, 10.0))

    def leg_s(*before: Item) -> float:
        return flight(*before, far, BACK, DOWN).time_s

    own_s = leg_s()
    slow_s = leg_s(item(Cmd.DO_CHANGE_SPEED, 1.0, 1.0, -1.0))
    assert slow_s - own_s == pytest.approx(1200.0 - 1200.0 / 5.0, rel=0.02)
    # 40 m/s are flown by no quadrotor: no faster than 12 are counted on.
    fast_s = leg_s(item(Cmd.DO_CHANGE_SPEED, 1.0, 40.0, -1.0))
    assert own_s - fast_s == pytest.approx(1200.0 / 5.0 - 1200.0 / 12.0, rel=0.1)
    own_again = item(Cmd.DO_CHANGE_SPEED, 1.0, -1.0, -1.0)
    assert leg_s(item(Cmd.DO_CHANGE_SPEED, 1.0, 1.0, -1.0), own_again) == pytest.approx(own_s)


def test_of_a_speed_before_the_first_item_to_fly_only_a_slower_one_counts() -> None:
    far = item(Cmd.NAV_WAYPOINT, to=(600.0, 0.0, 10.0))
    own_s = flight(far, DOWN).time_s
    begun = replace(ground(), begin_item=1)

    def after(speed_m_s: float) -> float:
        return flight(item(Cmd.DO_CHANGE_SPEED, 1.0, speed_m_s, -1.0), far, DOWN, over=begun).time_s

    assert after(12.0) == pytest.approx(own_s)
    assert after(1.0) > 2.0 * own_s


def test_a_circle_is_flown_as_often_as_it_says() -> None:
    def turning(turns: float) -> float:
        circle = item(Cmd.NAV_LOITER_TURNS, turns, 0.0, 8.0)
        return flight(circle, DOWN, over=ground("ardupilot")).time_s

    # Recorded (C1): one turn of 8 m radius at 2.8 m/s.
    assert turning(3.0) - turning(2.0) == pytest.approx(2.0 * math.pi * 8.0 / 2.8, rel=0.02)


# --------------------------------------------------------------------------- the way home


def test_what_ends_in_the_air_has_its_way_home_counted() -> None:
    far = item(Cmd.NAV_WAYPOINT, to=(100.0, 0.0, 10.0))
    returned = flight(far, item(Cmd.NAV_RETURN_TO_LAUNCH))
    hovers = flight(far)
    assert hovers.time_s == pytest.approx(returned.time_s)
    stays = flight(far, item(Cmd.NAV_LOITER_UNLIM, to=(100.0, 0.0, 10.0)), OUT)
    assert (stays.whole, stays.item) == (True, 1)
    assert stays.time_s == pytest.approx(returned.time_s + 1.0)
    landed = flight(far, item(Cmd.NAV_LAND, to=(100.0, 0.0, 0.0)))
    assert landed.time_s < returned.time_s - 20.0


def test_the_farthest_place_where_a_return_may_end_counts() -> None:
    far = item(Cmd.NAV_WAYPOINT, to=(100.0, 0.0, 10.0))
    rally = LandingPlace("rally point 1", (700.0, 0.0, 0.0))
    beside = replace(ground("ardupilot"), rally=(rally,))
    home_s = flight(far, over=ground("ardupilot")).time_s
    assert flight(far, over=beside).time_s - home_s == pytest.approx(500.0 / 10.0)


def test_on_the_ground_without_anything_to_fly_it_takes_no_time() -> None:
    photo = item(Cmd.IMAGE_START_CAPTURE)
    assert flight(photo, over=ground("px4", HOME, on_ground=True)) == FlightTime(0.0, 0, True)


def test_from_rest_to_rest() -> None:
    assert from_rest_s(0.0, 5.0, 2.0, 4.0) == 0.0
    assert from_rest_s(100.0, 5.0, 2.0, math.inf) == pytest.approx(100.0 / 5.0 + 5.0 / 2.0)
    assert from_rest_s(2.0, 5.0, 2.0, math.inf) == pytest.approx(2.0)
    assert from_rest_s(2.0, 0.0, 2.0, math.inf) == math.inf


# --------------------------------------------------------------------- by hand, to the second

HIGH_HOME = replace(ground(), home_ned=(3.0, 4.0, -2.0), start_ned=(3.0, 4.0, -12.0))
"""Home is 2 m above the local origin; the vehicle hovers 10 m above it."""
PX4_LEVEL = (5.0, 0.6 * 3.0, 4.0)
"""MPC_XY_CRUISE; 60 % of MPC_ACC_HOR; MPC_JERK_AUTO."""
UP_DOWN = (1.5, 1.0, 4.0)
"""MPC_TKO_SPEED and MPC_Z_V_AUTO_DN; WP_ACC_Z; MPC_JERK_AUTO."""


def long_way_s(way_m: float, speed_m_s: float, accel_m_s2: float, jerk_m_s3: float) -> float:
    return way_m / speed_m_s + speed_m_s / accel_m_s2 + accel_m_s2 / jerk_m_s3


def test_a_leg_and_a_landing() -> None:
    there = item(Cmd.NAV_WAYPOINT, 0.5, to=(100.0, 0.0, 10.0))
    found = flight(there, item(Cmd.NAV_LAND, to=(100.0, 0.0, 0.0)), over=HIGH_HOME)
    leg_s = long_way_s(100.0, *PX4_LEVEL) + 0.5 + 1.0
    assert found.time_s == pytest.approx(leg_s + 10.0 / 0.7 + 5.0 + 1.0)


def test_a_landing_from_high_above_is_slow_only_at_its_end() -> None:
    over = replace(HIGH_HOME, start_ned=(3.0, 4.0, -42.0))
    found = flight(item(Cmd.NAV_LAND, to=(0.0, 0.0, 0.0)), over=over)
    assert found.time_s == pytest.approx(long_way_s(30.0, *UP_DOWN) + 10.0 / 0.7 + 5.0 + 1.0)


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_a_take_off_that_has_a_place(autopilot: AutopilotName) -> None:
    """ArduCopter ignores it, and lands where it has climbed; PX4 flies there and back."""
    over = ground(autopilot, HOME, on_ground=True)
    up = item(Cmd.NAV_TAKEOFF, to=(100.0, 0.0, 10.0))
    found = flight(up, DOWN, over=over)
    climb = (1.5, 1.0, 4.0) if autopilot == "px4" else (2.5, 1.0, 1.0)
    there_and_back_s = 2.0 * long_way_s(100.0, *PX4_LEVEL) if autopilot == "px4" else 0.0
    land_m_s = 0.7 if autopilot == "px4" else 0.5
    expected_s = 5.0 + long_way_s(10.0, *climb) + 1.0 + there_and_back_s
    assert found.time_s == pytest.approx(expected_s + 10.0 / land_m_s + 5.0 + 1.0)


def test_an_ardupilot_s_flight_is_over_where_it_lands_whatever_follows() -> None:
    over = ground("ardupilot")
    again = item(Cmd.NAV_TAKEOFF), item(Cmd.NAV_WAYPOINT, to=(90.0, 0.0, 10.0)), DOWN
    found = flight(DOWN, *again, over=over)
    assert (found.item, found.whole) == (0, True)
    assert found.time_s == flight(DOWN, over=over).time_s


def test_a_px4_that_lands_amid_its_mission_goes_on() -> None:
    found = flight(DOWN, item(Cmd.NAV_WAYPOINT, to=(90.0, 0.0, 10.0)), DOWN)
    assert (found.item, found.whole) == (2, True)
    assert found.time_s > 2.0 * flight(DOWN).time_s


@pytest.mark.parametrize(("up_m", "climbs_m"), [(1.0, 2.5), (20.0, 20.0)])
def test_without_a_take_off_it_climbs_first_as_a_px4_does(up_m: float, climbs_m: float) -> None:
    over = replace(HIGH_HOME, start_ned=(3.0, 4.0, -2.0), on_ground=True)
    there = item(Cmd.NAV_WAYPOINT, to=(100.0, 0.0, up_m))
    found = flight(there, item(Cmd.NAV_LAND, to=(100.0, 0.0, 0.0)), over=over)
    slow_m, fast_m = min(up_m, 10.0), max(0.0, up_m - 10.0)
    down_s = slow_m / 0.7 + (long_way_s(fast_m, *UP_DOWN) if fast_m else 0.0)
    climb_s = 5.0 + long_way_s(climbs_m, *UP_DOWN)
    leg_s = long_way_s(100.0, *PX4_LEVEL) + 1.0
    assert found.time_s == pytest.approx(climb_s + leg_s + down_s + 5.0 + 1.0)


@pytest.mark.parametrize("waits_s", [0.0, 30.0, math.inf])
def test_a_return_is_flown_at_the_vehicles_own_speed_and_hovers_before_it_lands(
    waits_s: float,
) -> None:
    faster = item(Cmd.DO_CHANGE_SPEED, 0.0, 10.0, -1.0)
    settings = replace(USUAL["px4"], return_waits_s=waits_s)
    over = replace(HIGH_HOME, start_ned=(103.0, 4.0, -12.0), settings=settings)
    found = flight(faster, item(Cmd.NAV_RETURN_TO_LAUNCH), over=over)
    up_s, back_s = long_way_s(20.0, *UP_DOWN), long_way_s(100.0, *PX4_LEVEL)
    down_s = long_way_s(20.0, *UP_DOWN) + 10.0 / 0.7
    assert found.time_s == pytest.approx(min(up_s + back_s + down_s + 5.0 + waits_s, DAY_S))


@pytest.mark.parametrize("kind", [0.0, 1.0])
def test_a_speed_over_ground_and_one_through_the_air_count(kind: float) -> None:
    far = item(Cmd.NAV_WAYPOINT, to=(600.0, 0.0, 10.0))
    slow = item(Cmd.DO_CHANGE_SPEED, kind, 2.0, -1.0)
    down = item(Cmd.NAV_LAND, to=(600.0, 0.0, 0.0))
    leg_s = long_way_s(600.0, 2.0, *PX4_LEVEL[1:]) + 1.0
    assert flight(slow, far, down).time_s == pytest.approx(leg_s + 10.0 / 0.7 + 5.0 + 1.0)


@pytest.mark.parametrize("p", [(2.0, 2.0), (3.0, 2.0), (0.0, math.nan)])
def test_what_is_no_speed_over_ground_does_not_count(p: tuple[float, float]) -> None:
    far, none = item(Cmd.NAV_WAYPOINT, to=(600.0, 0.0, 10.0)), item(Cmd.DO_CHANGE_SPEED, *p, -1.0)
    over = ground("ardupilot")
    found = flight(none, far, DOWN, over=over)
    assert found.time_s == pytest.approx(flight(far, DOWN, over=over).time_s)


@pytest.mark.parametrize("kind", [2.0, 3.0])
def test_a_px4_takes_any_speed_for_that_of_its_legs(kind: float) -> None:
    far, slow = item(Cmd.NAV_WAYPOINT, to=(600.0, 0.0, 10.0)), (2.0, -1.0)
    found = flight(item(Cmd.DO_CHANGE_SPEED, kind, *slow), far, DOWN)
    assert found.time_s == flight(item(Cmd.DO_CHANGE_SPEED, 1.0, *slow), far, DOWN).time_s


@pytest.mark.parametrize(("kind", "up_m"), [(2.0, 60.0), (3.0, 0.0)])
def test_an_ardupilot_that_is_to_climb_or_to_descend_slowly_takes_longer(
    kind: float, up_m: float
) -> None:
    over = ground("ardupilot", (0.0, 0.0, -30.0))
    there = item(Cmd.NAV_WAYPOINT, to=(0.0, 0.0, up_m))

    def time_s(speed_m_s: float) -> float:
        return flight(item(Cmd.DO_CHANGE_SPEED, kind, speed_m_s, -1.0), there, over=over).time_s

    assert time_s(0.05) - time_s(9.0) > 500.0
    assert time_s(9.0) == flight(there, over=over).time_s


def test_a_wide_circle_is_flown_as_fast_as_half_the_acceleration_bends_it() -> None:
    def turning(turns: float) -> float:
        circle = item(Cmd.NAV_LOITER_TURNS, turns, 0.0, 40.0)
        return flight(circle, DOWN, over=ground("ardupilot")).time_s

    speed_m_s = math.sqrt(0.5 * 2.5 * 40.0)
    assert turning(2.0) - turning(1.0) == pytest.approx(2.0 * math.pi * 40.0 / speed_m_s)


@pytest.mark.parametrize("circle", [(1.0, 0.0, 0.0), (math.nan, 0.0, 8.0)])
def test_a_circle_that_is_none_ends_the_count(circle: tuple[float, float, float]) -> None:
    found = flight(item(Cmd.NAV_LOITER_TURNS, *circle), OUT, DOWN, over=ground("ardupilot"))
    assert found.item == 0


@pytest.mark.parametrize(
    ("delay", "waits_s"),
    [
        ((0.5, -1.0, -1.0, -1.0), 0.5),
        ((0.0, -1.0, -1.0, 0.0), DAY_S),
        ((-1.0, 0.0, -1.0, -1.0), DAY_S),
        ((-1.0, -1.0, -1.0, -1.0), 0.0),
    ],
)
def test_a_delay_counts(delay: tuple[float, float, float, float], waits_s: float) -> None:
    plain = flight(BACK, DOWN).time_s
    found = flight(BACK, item(Cmd.NAV_DELAY, *delay), DOWN).time_s
    assert found == pytest.approx(min(plain + waits_s, DAY_S))


def test_a_jump_to_itself_without_end_is_one_without_end() -> None:
    found = flight(BACK, item(Cmd.DO_JUMP, 2.0, -1.0), most_s=50.0)
    assert (found.whole, found.endless) == (False, 1)
    once = flight(BACK, OUT, BACK, item(Cmd.DO_JUMP, 2.0, 1.0), DOWN)
    assert (once.whole, once.endless) == (True, None)


def test_less_than_a_metre_takes_its_time_too() -> None:
    assert from_rest_s(0.5, 5.0, 2.0, math.inf) == pytest.approx(1.0)
    up = item(Cmd.NAV_WAYPOINT, to=(0.0, 0.0, 10.5))
    slow_up = replace(ground(), settings=replace(USUAL["px4"], climb_m_s=0.01))
    assert flight(up, DOWN, over=slow_up).time_s > 50.0
