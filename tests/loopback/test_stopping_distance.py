"""What a hold takes, flown: predicted no shorter than the truth, and not much longer.

Each vehicle flies to a goal far away, and is aborted on the way.
"""

from __future__ import annotations

import math

import pytest

from gcs.gate.airspace.stopping import travel_m
from gcs.gate.policy.parse import DEFAULT, parse_policy
from gcs.gate.states import State
from tests.loopback.flight import Flight

VEHICLES = pytest.mark.parametrize("kind", ["px4", "ardupilot"])
RESTS_WITHIN_S = 12.0
TIGHT = 2.5
"""A prediction this many times as long as what is flown is too long to be of use."""


def flight_of(kind: str, policy: str = "") -> Flight:
    parsed = parse_policy(policy, "my.toml")
    return Flight("ardupilot" if kind == "ardupilot" else "px4", policy=parsed)


def velocity_enu(flight: Flight) -> tuple[float, float, float]:
    body = flight.vehicle.blocks.body
    return (body.vel_e, body.vel_n, -body.vel_d)


def speed_m_s(flight: Flight) -> float:
    east, north, _ = velocity_enu(flight)
    return math.hypot(east, north)


def rest(flight: Flight) -> None:
    """Until it rests: an estimate may wander on."""
    flight.run(0.5)
    flight.until(lambda: math.hypot(*velocity_enu(flight)) < 0.1, RESTS_WITHIN_S)


@pytest.mark.parametrize(
    ("kind", "faster_than_m_s"),
    [
        *(("px4", speed) for speed in (1.5, 3.0, 4.5, 7.0, 9.5)),
        *(("ardupilot", speed) for speed in (1.5, 3.0, 4.5, 7.0, 9.5)),
    ],
)
def test_an_abort_takes_what_was_predicted(kind: str, faster_than_m_s: float) -> None:
    flight = flight_of(kind).hovering(3.0)
    flight.goto(0.0, 130.0, 3.0)
    flight.until(lambda: speed_m_s(flight) >= faster_than_m_s)
    from_enu, v_m_s = flight.truth_enu(), speed_m_s(flight)
    flight.say("abort")
    rest(flight)
    flown_m = math.dist(flight.truth_enu()[:2], from_enu[:2])
    braking = DEFAULT.braking_of(flight.personality)
    predicted_m = travel_m(v_m_s, braking.react_s, braking.a_brake_h_m_s2)
    assert flown_m <= predicted_m + braking.position_error_h_m
    assert predicted_m <= TIGHT * flown_m


@pytest.mark.parametrize(
    ("kind", "from_up_m", "to_up_m"),
    [
        ("px4", 3.0, 40.0),
        ("px4", 28.0, 3.0),
        ("ardupilot", 3.0, 40.0),
        ("ardupilot", 28.0, 3.0),
    ],
)
def test_an_abort_of_a_climb_or_descent_takes_what_was_predicted(
    kind: str, from_up_m: float, to_up_m: float
) -> None:
    flight = flight_of(kind).hovering(from_up_m)
    flight.goto(0.0, 0.0, to_up_m)
    flight.run(4.0)
    from_enu, v_m_s = flight.truth_enu(), abs(velocity_enu(flight)[2])
    assert v_m_s > 1.4
    flight.say("abort")
    rest(flight)
    flown_m = abs(flight.truth_enu()[2] - from_enu[2])
    braking = DEFAULT.braking_of(flight.personality)
    predicted_m = travel_m(v_m_s, braking.react_s, braking.a_brake_v_m_s2)
    assert flown_m <= predicted_m + braking.position_error_v_m
    assert predicted_m <= TIGHT * flown_m


HALL = """
[[fence]]
name = "hall"
kind = "box"
frame = "home"
east_m = [-60.0, 60.0]
north_m = [-60.0, {north_m}]
floor_up_m = 0.0
ceiling_up_m = 20.0
"""


def pushed(kind: str, gust_m_s: float, wall_m: float) -> tuple[Flight, int]:
    """It flies east at 3 m/s, and a wall stands in the north, where a gust drives it."""
    flight = flight_of(kind, HALL.format(north_m=wall_m)).hovering(3.0)
    goto = flight.goto(50.0, 0.0, 3.0)
    flight.until(lambda: speed_m_s(flight) >= 3.0)
    east, _, up = velocity_enu(flight)
    flight.push((east, gust_m_s, up))
    return flight, goto


@VEHICLES
@pytest.mark.parametrize(("gust_m_s", "wall_m"), [(2.0, 3.5), (3.0, 5.5), (5.0, 11.0)])
def test_a_vehicle_that_is_pushed_off_its_leg_stays_inside(
    kind: str, gust_m_s: float, wall_m: float
) -> None:
    """A hold of px4 would go 3.9, 6.1 and 11.4 m north, one of ardupilot 4.2, 6.3 and 11 m: its
    setpoints stop it sooner."""
    flight, _ = pushed(kind, gust_m_s, wall_m)
    farthest_m = 0.0
    for _ in range(200):
        flight.run(0.05)
        farthest_m = max(farthest_m, flight.truth_enu()[1])
    assert farthest_m < wall_m


@VEHICLES
def test_one_that_setpoints_cannot_stop_inside_either_is_braked_at_once(kind: str) -> None:
    """6 m/s north and 3 m/s east, by its approach: px4 5.8 m north, ardupilot 12.5 m."""
    flight, goto = pushed(kind, 6.0, 5.0)
    flight.until(lambda: flight.is_in(State.HOLDING), 0.3)
    assert flight.outcome(goto) == "aborted FENCE_BREACH"


@pytest.mark.parametrize("kind", ["px4", "ardupilot"])
def test_a_goal_at_the_margin_is_flown_to_from_afar_and_not_braked_for(kind: str) -> None:
    flight = flight_of(kind, HALL.format(north_m=52.0)).hovering(3.0)
    goal_enu = (0.0, 49.6, 3.0)
    assert flight.done(flight.goto(*goal_enu)) == "complete"
    flight.run(5.0)
    assert flight.is_in(State.HOVERING)
    assert math.dist(flight.truth_enu(), goal_enu) < 1.0


def test_a_step_of_offboard_as_recorded_is_not_braked_for() -> None:
    """10 m, the longest that was recorded, to 3 m from the wall."""
    flight = flight_of("px4", HALL.format(north_m=13.0)).hovering(3.0)
    assert flight.done(flight.goto(0.0, 10.0, 3.0)) == "complete"
    flight.run(5.0)
    assert flight.is_in(State.HOVERING)


def test_a_vehicle_too_fast_for_its_goal_is_slowed_down_by_its_setpoints() -> None:
    """A gust from behind: from 8 m/s a hold takes 20.8 m, to 28 m and more; the wall is at 25 m.

    By the approach it rests 8.8 m on, well inside, and is not braked.
    """
    flight = flight_of("px4", HALL.format(north_m=25.0)).hovering(3.0)
    goto = flight.goto(0.0, 12.0, 3.0)
    flight.until(lambda: flight.truth_enu()[1] >= 7.0)
    flight.push((0.0, 8.0, 0.0))
    farthest_m = 0.0
    for _ in range(200):
        flight.run(0.05)
        farthest_m = max(farthest_m, flight.truth_enu()[1])
    assert farthest_m < 25.0 - 1.0
    assert flight.outcome(goto) == "complete"
