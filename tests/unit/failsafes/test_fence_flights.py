"""Across the fence, and what the parameters make of it; returns to rally points."""

from __future__ import annotations

from math import hypot

import pytest

from tests.unit.autopilot.flight import Flight, item
from tests.unit.failsafes.ground import box, fenced, point, said
from vehicle_sim.autopilot.interface import PlanItem, Result, Setpoint
from vehicle_sim.autopilot.modes import Personality

BOTH: tuple[Personality, ...] = ("px4", "ardupilot")
either = pytest.mark.parametrize("personality", BOTH)
CRITICAL = 5


def outwards(flight: Flight, seconds: float) -> None:
    """ArduCopter in GUIDED: northwards by velocity, which no goal check can refuse."""
    for _ in range(round(seconds * 10)):
        flight.vehicle.set_setpoint(Setpoint(v_ned=(4.0, 0.0, 0.0)))
        flight.fly(0.1)


def steer(flight: Flight, seconds: float) -> None:
    """PX4 in OFFBOARD: the same."""
    stream = Setpoint(v_ned=(4.0, 0.0, 0.0))
    flight.stream(stream, 1.2)
    flight.vehicle.set_mode_kind("guided")
    flight.stream(stream, seconds)


@pytest.mark.parametrize(
    ("action", "mode"),
    [(1, "OFFBOARD"), (2, "AUTO.LOITER"), (3, "AUTO.RTL"), (5, "AUTO.LAND")],
)
def test_px4_does_what_gf_action_says(action: int, mode: str) -> None:
    flight = fenced(Flight.hovering("px4", 5.0), box("px4", 20.0))
    flight.vehicle.parameters.set("GF_ACTION", action)
    flight.vehicle.parameters.set("COM_FAIL_ACT_T", 0.0)
    flight.vehicle.parameters.set("COM_OF_LOSS_T", 60.0)
    steer(flight, 4.0)
    assert not said(flight, "Geofence violation")
    steer(flight, 4.0)
    assert said(flight, "Preflight Fail: Geofence violation")
    assert flight.vehicle.mode_name == mode
    assert (flight.vehicle.system_status == CRITICAL) == (action > 1)


def test_px4_without_an_action_flies_on_and_by_default_holds() -> None:
    flight = fenced(Flight.hovering("px4", 5.0), box("px4", 15.0))
    assert flight.vehicle.parameters.get("GF_ACTION") == 2
    flight.vehicle.parameters.set("GF_ACTION", 0)
    steer(flight, 6.0)
    assert flight.pos[0] > 18.0
    assert flight.vehicle.mode_name == "OFFBOARD"
    assert not said(flight, "Geofence")


def test_px4_terminates_where_it_is_told_to() -> None:
    flight = fenced(Flight.hovering("px4", 5.0), box("px4", 10.0))
    flight.vehicle.parameters.set("GF_ACTION", 4)
    steer(flight, 5.0)
    assert said(flight, "triggering Terminate")
    assert flight.vehicle.motor_outputs == (0.0, 0.0, 0.0, 0.0)
    assert flight.vehicle.system_status == 8


def test_px4_holds_before_it_returns_so_that_somebody_can_take_over() -> None:
    flight = fenced(Flight.hovering("px4", 5.0), box("px4", 12.0))
    flight.vehicle.parameters.set("GF_ACTION", 3)
    steer(flight, 5.0)
    assert said(flight, "Failsafe activated, triggering RTL in 5 seconds")
    assert flight.vehicle.mode_name == "AUTO.LOITER"
    assert flight.vehicle.system_status == CRITICAL
    flight.fly(5.5)
    assert flight.vehicle.mode_name == "AUTO.RTL"


def test_who_takes_over_while_px4_holds_keeps_the_vehicle() -> None:
    flight = fenced(Flight.hovering("px4", 5.0), box("px4", 12.0))
    flight.vehicle.parameters.set("GF_ACTION", 3)
    steer(flight, 5.0)
    for _ in range(80):
        flight.vehicle.joystick(0, 0, 500, 0, flight.vehicle.time_ns)
        flight.vehicle.set_mode_kind("position")
        flight.fly(0.1)
    assert flight.vehicle.mode_name == "POSCTL"
    assert flight.vehicle.system_status != CRITICAL


@pytest.mark.parametrize("name", ["GF_MAX_HOR_DIST", "GF_MAX_VER_DIST"])
def test_px4_minds_its_distances_from_home(name: str) -> None:
    flight = Flight.hovering("px4", 5.0)
    flight.fly(1.0)
    assert not said(flight, "Geofence")
    flight.vehicle.parameters.set(name, 4.0)
    if name == "GF_MAX_HOR_DIST":
        flight.vehicle.parameters.set("GF_MAX_HOR_DIST", 10.0)
        steer(flight, 5.0)
    flight.fly(0.3)
    assert said(flight, "Preflight Fail: Geofence violation")
    assert flight.vehicle.mode_name == "AUTO.LOITER"


def test_px4_looks_ahead_where_gf_predict_says_so() -> None:
    crossed: list[float] = []
    for ahead in (0, 1):
        flight = fenced(Flight.hovering("px4", 5.0), box("px4", 20.0))
        flight.vehicle.parameters.set("GF_PREDICT", ahead)
        flight.stream(Setpoint(v_ned=(4.0, 0.0, 0.0)), 1.2)
        flight.vehicle.set_mode_kind("guided")
        for _ in range(200):
            flight.stream(Setpoint(v_ned=(4.0, 0.0, 0.0)), 0.05)
            if flight.vehicle.mode_name != "OFFBOARD":
                break
        crossed.append(flight.pos[0])
    assert crossed[0] > 19.5
    assert crossed[1] < 19.0


@pytest.mark.parametrize(
    ("action", "mode"),
    [(0, "GUIDED"), (1, "RTL"), (2, "LAND"), (3, "RTL"), (4, "BRAKE"), (5, "LAND")],
)
def test_ardupilot_does_what_fence_action_says(action: int, mode: str) -> None:
    flight = fenced(Flight.hovering("ardupilot", 5.0), box("ardupilot", 15.0))
    flight.vehicle.parameters.set("FENCE_ACTION", action)
    outwards(flight, 6.0)
    assert said(flight, "Polygon fence breached")
    assert flight.vehicle.mode_name == mode
    assert flight.vehicle.fence_state.breached == (flight.pos[0] > 15.0)
    assert flight.vehicle.fence_state.count == 1
    assert (flight.vehicle.system_status == CRITICAL) == (action > 0)


def test_ardupilot_fences_nothing_until_it_is_on() -> None:
    flight = Flight.hovering("ardupilot", 5.0)
    flight.vehicle.load_fence(box("ardupilot", 10.0))
    outwards(flight, 4.0)
    assert flight.vehicle.mode_name == "GUIDED"
    assert flight.vehicle.enable_fence(1) is Result.ACCEPTED
    outwards(flight, 0.3)
    assert flight.vehicle.mode_name == "RTL"
    assert Flight("px4").vehicle.enable_fence(1) is Result.UNSUPPORTED


@pytest.mark.parametrize(
    ("kinds", "name", "value", "text"),
    [
        (1, "FENCE_ALT_MAX", 12.0, "Max Alt fence breached"),
        (2, "FENCE_RADIUS", 30.0, "Circle fence breached"),
    ],
)
def test_ardupilot_minds_height_and_distance(
    kinds: int, name: str, value: float, text: str
) -> None:
    flight = Flight.hovering("ardupilot", 11.0)
    flight.vehicle.parameters.set("FENCE_ENABLE", 1)
    flight.vehicle.parameters.set("FENCE_TYPE", kinds)
    flight.vehicle.parameters.set(name, value)
    for _ in range(100):
        flight.vehicle.set_setpoint(Setpoint(v_ned=(4.0, 0.0, -1.0)))
        flight.fly(0.1)
    assert [said for said in flight.texts() if "breached" in said] == [text]
    assert flight.vehicle.mode_name == "RTL"


def test_ardupilots_floor_counts_once_it_was_above_and_not_for_a_landing() -> None:
    flight = Flight("ardupilot")
    for name, value in (("FENCE_ENABLE", 1), ("FENCE_TYPE", 8), ("FENCE_ALT_MIN", 3.0)):
        flight.vehicle.parameters.set(name, value)
    flight.airborne(8.0)
    assert not said(flight, "Min Alt")
    flight.vehicle.land()
    flight.fly(10.0)
    assert not said(flight, "Min Alt")
    again = Flight("ardupilot")
    for name, value in (("FENCE_ENABLE", 1), ("FENCE_TYPE", 8), ("FENCE_ALT_MIN", 3.0)):
        again.vehicle.parameters.set(name, value)
    again.airborne(8.0)
    for _ in range(80):
        again.vehicle.set_setpoint(Setpoint(v_ned=(0.0, 0.0, 1.0)))
        again.fly(0.1)
    assert said(again, "Min Alt fence breached")
    assert again.vehicle.mode_name == "RTL"
    barred = Flight.hovering("ardupilot", 8.0)
    for name, value in (("FENCE_ENABLE", 1), ("FENCE_TYPE", 8), ("FENCE_ALT_MIN", 3.0)):
        barred.vehicle.parameters.set(name, value)
    barred.vehicle.enable_fence(2)
    for _ in range(80):
        barred.vehicle.set_setpoint(Setpoint(v_ned=(0.0, 0.0, 1.0)))
        barred.fly(0.1)
    assert not said(barred, "Min Alt")


def test_ardupilot_lets_nobody_leave_the_recovery_if_fence_options_say_so() -> None:
    flight = fenced(Flight.hovering("ardupilot", 5.0), box("ardupilot", 10.0))
    flight.vehicle.parameters.set("FENCE_OPTIONS", 1)
    outwards(flight, 4.5)
    assert flight.vehicle.mode_name == "RTL"
    assert flight.vehicle.fence_state.breached
    assert flight.vehicle.set_mode_kind("hold") is Result.FAILED
    assert flight.vehicle.reposition((2.0, 0.0, -5.0), None, None) is Result.FAILED
    flight.fly(0.1)
    assert said(flight, "Mode change to LOITER failed: in fence recovery")
    flight.vehicle.parameters.set("FENCE_OPTIONS", 0)
    assert flight.vehicle.set_mode_kind("hold") is Result.ACCEPTED
    flight.fly(2.0)
    assert flight.vehicle.mode_name == "LOITER"


def test_ardupilot_back_inside_says_so() -> None:
    flight = fenced(Flight.hovering("ardupilot", 5.0), box("ardupilot", 10.0))
    flight.vehicle.parameters.set("RTL_ALT", 500)
    outwards(flight, 4.5)
    flight.fly(8.0)
    assert said(flight, "Fence breach cleared")
    assert not flight.vehicle.fence_state.breached


def test_ardupilot_lands_where_it_is_far_outside() -> None:
    flight = Flight.hovering("ardupilot", 5.0)
    flight.vehicle.reposition((140.0, 0.0, -5.0), None, None)
    flight.fly(35.0)
    for name, value in (("FENCE_RADIUS", 30.0), ("FENCE_TYPE", 2), ("FENCE_ENABLE", 1)):
        flight.vehicle.parameters.set(name, value)
    flight.fly(0.3)
    assert flight.vehicle.mode_name == "LAND"


def test_one_of_two_inclusion_zones_is_enough_only_where_fence_options_say_so() -> None:
    two = (
        point("ardupilot", 0, 5003, (0.0, 0.0), 15.0),
        point("ardupilot", 1, 5003, (20.0, 0.0), 15.0),
    )
    for options, mode in ((1, "RTL"), (3, "GUIDED")):
        flight = Flight.hovering("ardupilot", 5.0)
        flight.vehicle.parameters.set("FENCE_OPTIONS", options)
        fenced(flight, two)
        flight.fly(0.3)
        assert flight.vehicle.mode_name == mode


@either
def test_a_goal_outside_the_fence_is_not_flown_to(personality: Personality) -> None:
    """PX4 accepts it, says so, and stays (scenario F2)."""
    flight = fenced(Flight.hovering(personality, 5.0), box(personality, 20.0))
    there = (30.0, 0.0, -5.0)
    expected = Result.ACCEPTED if personality == "px4" else Result.FAILED
    assert flight.vehicle.reposition(there, None, None) is expected
    flight.fly(3.0)
    assert flight.off((0.0, 0.0, -5.0)) < 1.0
    assert flight.vehicle.reposition((10.0, 0.0, -5.0), None, None) is Result.ACCEPTED


@either
def test_an_exclusion_zone_is_a_breach_from_inside(personality: Personality) -> None:
    flight = Flight.hovering(personality, 5.0)
    fenced(flight, (point(personality, 0, 5004, (3.0, 0.0), 8.0),))
    flight.fly(0.4)
    assert flight.vehicle.mode_name == ("AUTO.LOITER" if personality == "px4" else "RTL")
    assert flight.vehicle.fence_state.breached


@either
def test_outside_the_fence_it_does_not_arm(personality: Personality) -> None:
    flight = Flight(personality).boot()
    far = (point(personality, 0, 5003, (500.0, 0.0), 50.0),)
    fenced(flight, far)
    flight.fly(0.3)
    assert not flight.vehicle.armable
    assert flight.vehicle.arm(False) is not Result.ACCEPTED
    flight.fly(0.1)
    px4 = personality == "px4"
    assert said(flight, "Geofence violation" if px4 else "Arm: Vehicle breaching Polygon fence")
    flight.vehicle.load_fence(())
    flight.fly(0.3)
    assert flight.vehicle.armable


def test_px4_keeps_a_mission_out_of_bounds_and_does_not_fly_it() -> None:
    flight = fenced(Flight.hovering("px4", 5.0), box("px4", 20.0))
    plan = (item(0, 16, 10.0, 0.0, 5.0), item(1, 16, 40.0, 0.0, 5.0))
    assert flight.vehicle.check_plan(plan) is None
    flight.vehicle.load_plan(plan)
    flight.fly(0.1)
    assert said(flight, "Geofence violation for waypoint 2")
    assert flight.vehicle.set_mode_kind("mission") is not Result.ACCEPTED
    flight.vehicle.load_fence(box("px4", 60.0))
    assert flight.vehicle.set_mode_kind("mission") is not Result.ACCEPTED, "judged when it came: F7"
    flight.vehicle.load_plan(plan)
    assert flight.vehicle.set_mode_kind("mission") is Result.ACCEPTED
    flight.vehicle.load_fence(box("px4", 20.0))
    flight.vehicle.set_mode_kind("hold")
    assert flight.vehicle.set_mode_kind("mission") is Result.ACCEPTED


def test_ardupilots_mission_turns_the_fence_on_and_off() -> None:
    flight = Flight.hovering("ardupilot", 5.0)
    plan = (
        item(0, 16),
        PlanItem(1, 2, 207, 1.0, 0.0, 0.0, 0.0, 0, 0, 0.0, 1),
        item(2, 16, 5.0, 0.0, 5.0),
        PlanItem(3, 2, 207, 0.0, 0.0, 0.0, 0.0, 0, 0, 0.0, 1),
        item(4, 16, 10.0, 0.0, 5.0),
    )
    assert flight.vehicle.check_plan(plan) is None
    flight.vehicle.load_plan(plan)
    flight.vehicle.set_mode_kind("mission")
    flight.fly(1.0)
    assert flight.vehicle.parameters.get("FENCE_ENABLE") == 1
    flight.fly(12.0)
    assert flight.vehicle.parameters.get("FENCE_ENABLE") == 0


# ------------------------------------------------------------------------------------ rally


def returned(flight: Flight) -> tuple[float, float]:
    """Where it stands after its return."""
    assert flight.vehicle.return_home() is Result.ACCEPTED
    flight.fly(150.0, lambda: not flight.vehicle.armed)
    return flight.pos[0], flight.pos[1]


def near_the_point(flight: Flight) -> Flight:
    name, unit = ("RTL_RETURN_ALT", 1.0) if flight.personality == "px4" else ("RTL_ALT", 100.0)
    flight.vehicle.parameters.set(name, 8.0 * unit)
    flight.vehicle.load_rally((point(flight.personality, 0, 5100, (40.0, 0.0), up_m=0.0),))
    flight.vehicle.reposition((30.0, 0.0, -5.0), None, None)
    flight.fly(12.0)
    return flight


@either
def test_a_return_goes_to_the_nearest_of_home_and_rally_points(personality: Personality) -> None:
    north, east = returned(near_the_point(Flight.hovering(personality, 5.0)))
    assert hypot(north - 40.0, east) < 1.0
    home = near_the_point(Flight.hovering(personality, 5.0))
    home.vehicle.reposition((15.0, 0.0, -5.0), None, None)
    home.fly(8.0)
    north, east = returned(home)
    assert hypot(north, east) < 1.0


@pytest.mark.parametrize(
    ("personality", "name", "value", "there"),
    [
        ("px4", "RTL_TYPE", 1, True),
        ("ardupilot", "RALLY_INCL_HOME", 0, True),
        ("ardupilot", "RALLY_LIMIT_KM", 0.01, False),
    ],
)
def test_the_parameters_choose_between_them(
    personality: Personality, name: str, value: float, there: bool
) -> None:
    flight = near_the_point(Flight.hovering(personality, 5.0))
    flight.vehicle.parameters.set(name, value)
    flight.vehicle.reposition((15.0 if there else 25.0, 0.0, -5.0), None, None)
    flight.fly(8.0)
    north, _ = returned(flight)
    assert north == pytest.approx(40.0 if there else 0.0, abs=1.0)


def test_ardupilot_flies_to_a_rally_point_at_its_height_and_never_to_one_outside_the_fence() -> (
    None
):
    flight = near_the_point(Flight.hovering("ardupilot", 5.0))
    flight.vehicle.load_rally((point("ardupilot", 0, 5100, (40.0, 0.0), up_m=14.0),))
    flight.vehicle.return_home()
    flight.fly(8.0)
    assert flight.up_m == pytest.approx(14.0, abs=1.0)
    fenced_in = fenced(near_the_point(Flight.hovering("ardupilot", 5.0)), box("ardupilot", 35.0))
    north, east = returned(fenced_in)
    assert hypot(north, east) < 1.0
