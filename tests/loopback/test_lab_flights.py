"""The lab's cage: its fence, and what counts as arrived."""

from __future__ import annotations

import math

import pytest

from gcs.frames import enu_from_ned, ned_from_enu
from gcs.gate.states import State
from tests.loopback.flight import POLICIES, Flight, Personality, lab_policy

# ------------------------------------------------------------------------------
# The lab's checkpoints about its cage, and about which way is up: L12, L13, L18.

Vec3 = tuple[float, float, float]


@pytest.mark.parametrize(
    ("goal_enu", "expected"),
    [
        ((5.0, 5.0, 2.0), "complete"),
        ((-5.0, -5.0, 2.0), "complete"),
        ((5.01, 0.0, 1.0), "refused OUTSIDE_FENCE"),
        ((0.0, -5.01, 1.0), "refused OUTSIDE_FENCE"),
        ((0.0, 0.0, 2.01), "refused OUTSIDE_FENCE"),
        ((0.0, 0.0, -0.1), "refused OUTSIDE_FENCE"),
    ],
)
def test_L12_the_cage_of_5_5_2_has_inclusive_bounds(
    personality: Personality, goal_enu: Vec3, expected: str
) -> None:
    flight = Flight(personality, policy=lab_policy()).hovering(1.0)
    ask = flight.goto(*goal_enu)
    assert flight.done(ask) == expected
    flight.run(1.0)
    assert flight.is_in(State.HOVERING)
    flown = [enu_from_ned(setpoint.pos_ned) for setpoint in flight.setpoints()]
    assert (goal_enu in flown) == (expected == "complete")
    assert all(abs(e) <= 5.0 and abs(n) <= 5.0 and 0.0 <= u <= 2.0 for e, n, u in flown)
    [verdict] = flight.verdicts(ask)
    if verdict.outcome == "refused":
        assert verdict.zone == "cage"
        assert verdict.numbers


def test_L13_what_the_fence_refused_is_flown_only_when_sent_again_without_it() -> None:
    flight = Flight(policy=lab_policy()).hovering(1.0)
    goal_enu = (7.0, 0.0, 1.0)
    assert flight.done(flight.goto(*goal_enu)) == "refused OUTSIDE_FENCE"
    assert flight.done(flight.say("fence", on=False)) == "complete"
    flight.run(0.1)
    since_ns = flight.now_ns
    flight.run(5.0)
    assert flight.states(since_ns) == []
    assert (0.0, 7.0, -1.0) not in {setpoint.pos_ned for setpoint in flight.setpoints()}
    assert flight.done(flight.goto(*goal_enu)) == "complete"
    flight.run(4.0)  # a PX4 that is sent the bare goal flies past it, and back
    assert flight.truth_enu()[0] == pytest.approx(7.0, abs=0.5)


def test_L13_the_default_policy_has_no_switch() -> None:
    flight = Flight().hovering(2.0)
    assert flight.done(flight.say("fence", on=False)) == "refused POLICY"
    assert flight.done(flight.goto(500.0, 0.0, 2.0)).startswith("refused")


EAST_NORTH_UP_TO_WIRE: dict[Vec3, Vec3] = {
    # east, north, up           x (north), y (east), z (down)
    (1.0, 0.0, 1.0): (0.0, 1.0, -1.0),
    (-1.0, 0.0, 1.0): (0.0, -1.0, -1.0),
    (0.0, 1.0, 1.0): (1.0, 0.0, -1.0),
    (0.0, -1.0, 1.0): (-1.0, 0.0, -1.0),
    (0.0, 0.0, 2.0): (0.0, 0.0, -2.0),
    (0.0, 0.0, 1.0): (0.0, 0.0, -1.0),
}


def test_L18_each_axis_is_on_the_wire_as_the_table_says() -> None:
    flight = Flight(policy=lab_policy()).hovering(1.0)
    for goal_enu, wire_ned in EAST_NORTH_UP_TO_WIRE.items():
        assert flight.done(flight.goto(*goal_enu)) == "complete"
        flight.run(0.2)
        sent = flight.setpoints(flight.now_ns - 60_000_000)[-1]
        assert sent.pos_ned == wire_ned
        assert enu_from_ned(sent.pos_ned) == goal_enu
        assert enu_from_ned(ned_from_enu(goal_enu)) == goal_enu
        flight.run(3.0)
        # By its own position: the truth is off by the error of its GPS receiver.
        assert enu_from_ned(flight.vehicle.estimate.pos_ned) == pytest.approx(goal_enu, abs=0.3)


# ------------------------------------------------------------------------------
# The lab's checkpoints about arriving: L4, L6, L7, L8, L9, L14.

both_policies = pytest.mark.parametrize("policy", POLICIES)
TICK_S = 0.05


def completed(flight: Flight) -> list[str]:
    return [line for line in flight.lines("state_and_safety") if line.startswith("Complete")]


@both_policies
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
