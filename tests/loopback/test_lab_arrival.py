"""The lab's checkpoints about arriving: L4, L6, L7, L8, L9, L14."""

from __future__ import annotations

import math

import pytest

from gcs.frames import enu_from_ned
from gcs.gate.states import State
from tests.loopback.flight import PERSONALITIES, POLICIES, Flight, Personality, lab_policy

both_personalities = pytest.mark.parametrize("personality", PERSONALITIES)
both_policies = pytest.mark.parametrize("policy", POLICIES)
TICK_S = 0.05


def completed(flight: Flight) -> list[str]:
    return [line for line in flight.lines("state_and_safety") if line.startswith("Complete")]


@both_policies
@both_personalities
def test_L04_without_a_position_nothing_is_complete_and_the_station_says_so(
    personality: Personality, policy: str
) -> None:
    flight = Flight(personality, policy=POLICIES[policy]).hovering(1.0)
    ask = flight.goto(4.0, 0.0, 1.0)
    flight.run(0.3)
    before = completed(flight)
    flight.positions_lost = True
    flight.run(POLICIES[policy].position_age_s + 2 * TICK_S)
    assert flight.is_in(State.STALE)
    assert flight.states()[-1] == "STALE"
    flight.run(30.0)
    assert completed(flight) == before
    [ending] = flight.endings(ask)
    assert (ending.ended, ending.code) == ("aborted", "STALE")
    assert flight.vehicle.mode_name in ("AUTO.LOITER", "BRAKE")


@both_personalities
def test_L06_arrival_is_complete_and_the_stream_goes_on_at_the_same_goal(
    personality: Personality,
) -> None:
    flight = Flight(personality, policy=lab_policy()).hovering(1.0)
    assert flight.done(flight.goto(1.0, 0.0, 0.5)) == "complete"
    assert flight.is_in(State.HOVERING)
    assert completed(flight)[-1] == "Complete: goto"
    since_ns = flight.now_ns
    flight.run(2.0)
    stream = flight.setpoints(since_ns + 1)
    assert len(stream) == 40
    assert {setpoint.pos_ned for setpoint in stream} == {(0.0, 1.0, -0.5)}
    assert math.dist(flight.truth_enu(), (1.0, 0.0, 0.5)) < 0.5


@both_personalities
def test_L07_then_a_second_goal_is_flown(personality: Personality) -> None:
    flight = Flight(personality, policy=lab_policy()).hovering(1.0)
    assert flight.done(flight.goto(1.0, 0.0, 0.5)) == "complete"
    assert flight.done(flight.goto(-1.0, 2.0, 1.5)) == "complete"
    flight.run(3.0)
    assert math.dist(flight.truth_enu(), (-1.0, 2.0, 1.5)) < 0.5


def test_L08_at_exactly_half_a_metre_it_is_not_complete_just_below_it_is() -> None:
    flight = Flight(policy=lab_policy()).hovering(1.0)
    ask = flight.goto(1.0, 0.0, 1.0)
    flight.run(0.06)
    assert flight.is_in(State.MOVING)
    flight.positions_lost = True
    flight.run(TICK_S)  # so that the first report is no jump
    for _ in range(20):
        flight.report((0.5, 0.0, 1.0))
        flight.run(TICK_S)
    assert flight.is_in(State.MOVING)
    assert flight.outcome(ask) is None
    just_below_m = math.nextafter(0.5, 1.0) + 2.0**-24
    flight.report((just_below_m, 0.0, 1.0))
    flight.run(TICK_S)
    assert flight.outcome(ask) == "complete"
    assert flight.is_in(State.HOVERING)


@both_personalities
def test_L09_the_goal_one_is_at_is_one_tick_of_moving(personality: Personality) -> None:
    flight = Flight(personality, policy=lab_policy()).hovering(1.0)
    assert flight.session.gate.pos_ned is not None
    since_ns = flight.now_ns
    ask = flight.goto(*enu_from_ned(flight.session.gate.pos_ned))
    flight.until(lambda: flight.state is State.MOVING, 0.06)
    moving_ns = flight.now_ns
    flight.until(lambda: flight.outcome(ask) == "complete", 0.06)
    assert flight.now_ns - moving_ns == 50_000_000
    assert flight.states(since_ns) == ["VERIFYING", "MOVING", "HOVERING"]


@both_policies
@both_personalities
def test_L14_positions_stop_just_before_the_goal_and_nothing_is_complete(
    personality: Personality, policy: str
) -> None:
    flight = Flight(personality, policy=POLICIES[policy]).hovering(1.0)
    ask = flight.goto(4.0, 0.0, 1.0)
    flight.until(lambda: flight.truth_enu()[0] > 2.0)
    before = completed(flight)
    flight.positions_lost = True
    flight.run(POLICIES[policy].position_age_s + 2 * TICK_S)
    assert flight.is_in(State.STALE)
    flight.run(3.0)
    flight.positions_lost = False
    flight.run(5.0)
    assert completed(flight) == before
    assert flight.outcome(ask) == "aborted STALE"
    assert not flight.is_in(State.MOVING)
