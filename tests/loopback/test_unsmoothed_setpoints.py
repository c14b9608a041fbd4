"""PX4's OFFBOARD as recorded: setpoints are steps, and it flies past them.

Scenario I1_step_response of PX4 1.14.3: a step of 10 m is within 0.5 m first after 3.3 s, for good
after 6.1 to 6.4 s, and overshot by 0.5 to 0.6 m.
"""

from __future__ import annotations

import math

import pytest

from gcs.frames import enu_from_ned
from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from tests.loopback.flight import POLICIES, Flight, lab_policy

Vec3 = tuple[float, float, float]
SETTLES_S = 6.44 - 3.31

TIGHT = parse_policy(
    """
margin_h_m = 0.8
brake_slack_h_m = 0.5
margin_v_m = 0.3
[[fence]]
name = "hall"
kind = "box"
frame = "home"
east_m = [-20.0, 9.0]
north_m = [-20.0, 20.0]
floor_up_m = 0.0
ceiling_up_m = 9.0
""",
    "tight.toml",
)


@pytest.mark.parametrize("goal_enu", [(7.0, 0.0, 3.0), (0.0, 0.0, 8.5), (7.0, 0.0, 8.5)])
def test_a_goal_at_the_margin_that_is_accepted_is_reached_and_never_braked_for(
    goal_enu: Vec3,
) -> None:
    flight = Flight(policy=TIGHT).hovering(3.0)
    assert flight.done(flight.goto(*goal_enu)) == "complete"
    flight.run(2.0 * SETTLES_S)
    assert flight.is_in(State.HOVERING)
    assert math.dist(flight.truth_enu(), goal_enu) < 0.5


@pytest.mark.parametrize("goal_enu", [(0.0, 0.0, 8.6), (7.8, 0.0, 3.0)])
def test_a_goal_past_which_it_would_be_braked_is_refused(goal_enu: Vec3) -> None:
    """Both keep the margin; 1.2 m from the wall and 0.4 m below the ceiling are not enough."""
    flight = Flight(policy=TIGHT).hovering(3.0)
    assert flight.done(flight.goto(*goal_enu)) == "refused TOO_CLOSE"
    [verdict] = flight.verdicts(flight.last_id)
    assert "the vehicle may fly" in verdict.sentence


def test_L13_without_the_fence_the_goal_is_flown_and_settles_as_recorded() -> None:
    flight = Flight(policy=lab_policy()).hovering(1.0)
    goal_enu = (7.0, 0.0, 1.0)
    assert flight.done(flight.goto(*goal_enu)) == "refused OUTSIDE_FENCE"
    assert flight.done(flight.say("fence", on=False)) == "complete"
    assert flight.done(flight.goto(*goal_enu)) == "complete"
    flight.run(SETTLES_S)
    assert flight.truth_enu()[0] == pytest.approx(7.0, abs=0.5)


@pytest.mark.parametrize(
    ("goal_enu", "outcome"),
    [((5.0, 5.0, 2.0), "accepted"), ((5.01, 0.0, 1.0), "refused"), ((0.0, 0.0, -0.1), "refused")],
)
def test_L12_what_is_refused_never_appears_on_the_wire(goal_enu: Vec3, outcome: str) -> None:
    flight = Flight(policy=lab_policy()).hovering(1.0)
    ask = flight.goto(*goal_enu)
    flight.run(10.0)
    [verdict] = flight.verdicts(ask)
    assert verdict.outcome == outcome
    flown = {enu_from_ned(setpoint.pos_ned) for setpoint in flight.setpoints()}
    assert (goal_enu in flown) == (outcome == "accepted")


@pytest.mark.parametrize("policy", POLICIES)
def test_L15_an_abort_while_it_moves_holds_it(policy: str) -> None:
    """Recorded: 6.5 m from 2.75 m/s after the last setpoint, of which 1.0 s went by unbraked."""
    flight = Flight(policy=POLICIES[policy]).hovering(1.0)
    flight.goto(4.0, 1.0, 1.5)
    flight.run(0.8)
    assert flight.is_in(State.MOVING)
    since_ns, at_enu = flight.now_ns, flight.truth_enu()
    assert flight.done(flight.say("abort")) == "complete"
    flight.run(3.0)
    rest_enu = flight.truth_enu()
    assert math.dist(at_enu, rest_enu) < 6.5 - 2.75
    flight.run(2.0)
    assert flight.is_in(State.HOLDING)
    assert math.dist(flight.truth_enu(), rest_enu) < 0.2
    flown = {setpoint.pos_ned for setpoint in flight.setpoints(since_ns + 1)}
    assert (1.0, 4.0, -1.5) not in flown
