"""The point mass keeps to what the policy says of its kind, and is no kinder than that.

Flying to a position that it was sent it takes all of `[braking]` for a hold, from the command on.
On a path of its own it leads no farther past the end of its leg than `[approach]` or a recorded
hold takes from there, whichever is the most.
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


def flying(autopilot: str, cruise_m_s: float, mode: FlightMode = FlightMode.GUIDED) -> PointMass:
    """Level to a place 60 m north; it acts on a hold after all of the time that it may take."""
    vehicle = PointMass(autopilot, DEFAULT, random.Random(7))
    vehicle.armed, vehicle.landed = True, LandedState.IN_AIR
    vehicle.pos = [0.0, 0.0, -10.0]
    vehicle.cruise_m_s = cruise_m_s
    vehicle.hold_react_s = vehicle.braking.react_s
    vehicle.hears_setpoint((GOAL_M, 0.0, -10.0), None)
    vehicle.path = [(GOAL_M, 0.0, -10.0)]
    vehicle.mode = mode
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
def test_told_to_stop_it_takes_all_of_what_braking_says(autopilot: str, stop: str) -> None:
    vehicle = flying(autopilot, 5.0)
    flies_until(vehicle, 15.0)
    v, b = vehicle.vel[0], vehicle.braking
    expected_m = travel_m(v, b.react_s, b.a_brake_h_m_s2)
    assert stops(vehicle, stop) == pytest.approx(expected_m, abs=2.0 * v * STEP_S)


@BOTH
@pytest.mark.parametrize("stop", ["hold", "land"])
@pytest.mark.parametrize("north_m", [25.0, 40.0, 45.0, 55.0, 59.0])
def test_on_a_path_of_its_own_it_does_not_fly_past_it_farther_than_by_itself(
    autopilot: str, stop: str, north_m: float
) -> None:
    """At 12 m/s braking alone would take 38 m (px4) and 30 m (ardupilot)."""
    vehicle = flying(autopilot, FAST_M_S, FlightMode.MISSION)
    flies_until(vehicle, north_m)
    v, a = vehicle.vel[0], vehicle.approach
    fast_m_s, took_m = RECORDED_HOLDS[autopilot]
    at_m = vehicle.pos[0]
    rest_m = at_m + stops(vehicle, stop)
    farthest_m = max(
        GOAL_M + vehicle.braking.position_error_h_m,
        at_m + travel_m(v, a.react_s, a.a_brake_h_m_s2),
        at_m + took_m * min(1.0, v / fast_m_s),
    )
    assert rest_m < farthest_m + v * STEP_S


@BOTH
def test_it_is_no_kinder_than_the_recorded_hold(autopilot: str) -> None:
    """At the place on its way where that is the most."""
    fast_m_s, took_m = RECORDED_HOLDS[autopilot]
    vehicle = flying(autopilot, fast_m_s, FlightMode.MISSION)
    a = vehicle.approach
    flies_until(vehicle, GOAL_M - travel_m(fast_m_s, a.react_s, a.a_brake_h_m_s2))
    assert vehicle.vel[0] == pytest.approx(fast_m_s, abs=0.1)
    assert stops(vehicle, "hold") == pytest.approx(took_m, abs=0.25)


@BOTH
def test_it_slows_down_as_late_as_its_lag_and_no_harder_than_its_approach(autopilot: str) -> None:
    """Sent a position 4 m ahead at 5 m/s: the speed that it is to have there is what its autopilot
    flies at 4 m away, 0.95 x 4 m/s (px4) or sqrt(2 x 2.5 (4 - 2.5 / 2)) m/s (ardupilot)."""
    wanted_m_s = {"px4": 3.8, "ardupilot": 3.70810}[autopilot]
    lag_s, most_m_s2 = {"px4": (2.5, 5.0), "ardupilot": (0.6, 2.0)}[autopilot]
    vehicle = flying(autopilot, 5.0)
    flies_until(vehicle, 15.0)
    here = vehicle.reported()[0]
    vehicle.hears_setpoint((here + 4.0, 0.0, -10.0), None)
    vehicle.step()
    slowed_m_s2 = (5.0 - vehicle.vel[0]) / STEP_S
    assert slowed_m_s2 == pytest.approx(min((5.0 - wanted_m_s) / lag_s, most_m_s2), rel=0.1)


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
    v = vehicle.vel[0]
    by_itself_m = travel_m(v, a.react_s, a.a_brake_h_m_s2)
    held_m = travel_m(v, braking.react_s, braking.a_brake_h_m_s2)
    assert stops(vehicle, "hold") == pytest.approx(min(by_itself_m, held_m), abs=1.0)


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
