"""The point mass keeps to what the policy says of its kind, and is no kinder than that.

A hold takes `[braking]` from the command on.  On the way to a goal it leads no farther past that
than `[overshoot]`, or than `[approach]` or a recorded hold takes from there, whichever is the most.
"""

from __future__ import annotations

import math
import random

import pytest

from gcs.frames import Vec3
from gcs.gate.airspace.stopping import travel_m
from gcs.gate.effects import CommandKind, SendCommand
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.states import FlightMode, LandedState
from tests.soak.point_mass import RECORDED_HOLDS, STEP_S, PointMass

BOTH = pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
STOPS = pytest.mark.parametrize("stop", ["hold", "land", "brake, then hold"])
GOAL_M = 60.0
FAST_M_S = 12.0


def flying(autopilot: str, cruise_m_s: float) -> PointMass:
    """Level to a goal 60 m north; it acts on a hold after all of the time that it may take."""
    vehicle = PointMass(autopilot, DEFAULT, random.Random(7))
    vehicle.armed, vehicle.landed = True, LandedState.IN_AIR
    vehicle.pos = [0.0, 0.0, -10.0]
    vehicle.cruise_m_s = cruise_m_s
    vehicle.hold_react_s = vehicle.braking.react_s
    vehicle.hears_setpoint((GOAL_M, 0.0, -10.0), None)
    vehicle.mode = FlightMode.GUIDED
    return vehicle


def flies_until(vehicle: PointMass, north_m: float) -> None:
    while vehicle.reported()[0] < north_m:
        vehicle.setpoint_s = vehicle.now_s
        vehicle.step()


def stops(vehicle: PointMass, stop: str) -> float:
    """Metres from where it was told to."""
    told_m = vehicle.pos[0]
    if stop == "brake, then hold":
        brake_ned: Vec3 = (vehicle.reported()[0] + 8.0, 0.0, -10.0)
        vehicle.hears_setpoint(brake_ned, None)
        vehicle.step()
    kind = CommandKind.LAND if stop == "land" else CommandKind.HOLD
    vehicle.hears_command(SendCommand(1, kind, 0))
    for _ in range(1000):
        vehicle.step()
    assert math.hypot(*vehicle.vel[:2]) < 0.01
    return vehicle.pos[0] - told_m


@BOTH
@STOPS
def test_far_from_its_goal_it_takes_all_of_what_braking_says(autopilot: str, stop: str) -> None:
    vehicle = flying(autopilot, 5.0)
    flies_until(vehicle, 15.0)
    v, b = vehicle.vel[0], vehicle.braking
    expected_m = travel_m(v, b.react_s, b.a_brake_h_m_s2)
    assert stops(vehicle, stop) == pytest.approx(expected_m, abs=2.0 * v * STEP_S)


@BOTH
@STOPS
@pytest.mark.parametrize("north_m", [25.0, 40.0, 45.0, 55.0, 59.0])
def test_on_its_way_to_a_goal_it_does_not_fly_past_it_farther_than_by_itself(
    autopilot: str, stop: str, north_m: float
) -> None:
    """At 12 m/s braking alone would take 44 m (px4) and 50 m (ardupilot)."""
    vehicle = flying(autopilot, FAST_M_S)
    flies_until(vehicle, north_m)
    v, a = vehicle.vel[0], vehicle.approach
    fast_m_s, took_m = RECORDED_HOLDS[autopilot]
    at_m = vehicle.pos[0]
    rest_m = at_m + stops(vehicle, stop)
    farthest_m = max(
        GOAL_M + vehicle.overshoot.most_h_m + vehicle.braking.position_error_h_m,
        at_m + travel_m(v, a.react_s, a.a_brake_h_m_s2),
        at_m + took_m * min(1.0, v / fast_m_s),
    )
    assert rest_m < farthest_m + v * STEP_S


@BOTH
def test_it_is_no_kinder_than_the_recorded_hold(autopilot: str) -> None:
    """At the place on its way to the goal where that is the most."""
    fast_m_s, took_m = RECORDED_HOLDS[autopilot]
    vehicle = flying(autopilot, fast_m_s)
    a = vehicle.approach
    flies_until(vehicle, GOAL_M - travel_m(fast_m_s, a.react_s, a.a_brake_h_m_s2))
    assert vehicle.vel[0] == pytest.approx(fast_m_s, abs=0.1)
    assert stops(vehicle, "hold") == pytest.approx(took_m, abs=0.25)


@BOTH
def test_its_guidance_flies_by_the_position_that_it_reports(autopilot: str) -> None:
    vehicle = flying(autopilot, 3.0)
    for _ in range(3000):
        vehicle.setpoint_s = vehicle.now_s
        vehicle.step()
    assert math.dist(vehicle.reported()[:2], (GOAL_M, 0.0)) < 0.2
    assert math.dist(vehicle.pos[:2], (GOAL_M, 0.0)) > 0.3


@BOTH
def test_sent_back_at_speed_it_brakes_already_when_it_is_told_to_hold(autopilot: str) -> None:
    vehicle = flying(autopilot, FAST_M_S)
    flies_until(vehicle, 15.0)
    vehicle.hears_command(SendCommand(1, CommandKind.RETURN, 0))
    a, braking = vehicle.approach, vehicle.braking
    expected_m = travel_m(vehicle.vel[0], a.react_s, a.a_brake_h_m_s2)
    assert stops(vehicle, "hold") == pytest.approx(expected_m, abs=1.0)
    assert expected_m < 0.6 * travel_m(FAST_M_S, braking.react_s, braking.a_brake_h_m_s2)


@BOTH
def test_it_climbs_on_no_longer_than_a_hold_takes_even_where_it_flies_on_to_its_goal(
    autopilot: str,
) -> None:
    """One that climbed on as long as it flew on was 5 m above its ceiling (seed 41088575)."""
    vehicle = flying(autopilot, FAST_M_S)
    vehicle.climb_m_s = 3.0
    vehicle.setpoint = (GOAL_M, 0.0, -40.0)
    flies_until(vehicle, 12.0)
    up_m, climbs_m_s, b = -vehicle.pos[2], -vehicle.vel[2], vehicle.braking
    stops(vehicle, "hold")
    expected_m = travel_m(climbs_m_s, b.react_s, b.a_brake_v_m_s2)
    assert climbs_m_s > 2.0
    assert -vehicle.pos[2] - up_m == pytest.approx(expected_m, abs=2.0 * climbs_m_s * STEP_S)
