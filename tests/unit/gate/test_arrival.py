"""How near to a goal is there: by the policy, by what the vehicle says of its own accuracy, and by
where its nose points."""

from __future__ import annotations

import math

import pytest
from msgspec import structs

from gcs.gate.inputs import AccuracySeen
from gcs.gate.machine.progress import arrival_radius_h_m
from gcs.gate.policy.policy import Policy
from gcs.gate.requests import GoTo
from gcs.gate.states import State
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import UP

ARRIVAL = policy("default").arrival
PX4_ACCURACY_M, NAV_ACC_RAD = 0.32, 2.0
"""ESTIMATOR_STATUS.pos_horiz_accuracy of px4_1_14_flight.tlog; px4_1_14_params.json."""


@pytest.mark.parametrize(
    ("accuracy_m", "acceptance_m", "radius_m"),
    [
        (PX4_ACCURACY_M, NAV_ACC_RAD, 0.82),
        (PX4_ACCURACY_M, None, 0.82),
        (0.0, 2.0, 0.5),
        (0.9, 2.0, 1.0),  # max_radius_m: PX4's GPS alone
        (0.9, 0.7, 0.7),  # nearer than the vehicle itself takes it as reached
        (0.9, 0.2, 0.5),  # but never nearer than the policy asks for
        (None, 2.0, None),
        (math.nan, 2.0, None),
        (-1.0, 2.0, None),
        (0.3, math.nan, 0.8),
    ],
)
def test_the_radius_grows_by_the_accuracy_within_its_bounds(
    accuracy_m: float | None, acceptance_m: float | None, radius_m: float | None
) -> None:
    found = arrival_radius_h_m(ARRIVAL, AccuracySeen(accuracy_m, acceptance_m))
    assert found == (None if radius_m is None else pytest.approx(radius_m))


def test_the_lab_s_radius_does_not_grow() -> None:
    lab = policy("lab").arrival
    assert arrival_radius_h_m(lab, AccuracySeen(5.0, 5.0)) == lab.radius_m == 0.5


def flown(seen: AccuracySeen | None, rules: Policy | None = None) -> tuple[Script, int]:
    """On its way ten metres to the east."""
    script = Script(rules or policy("default")).take_control(UP)
    if seen is not None:
        script.feed(seen)
    goal = script.ask(GoTo((0.0, 10.0, -UP)))
    script.tick()
    assert script.gate.state is State.MOVING
    return script, goal


def wander(script: Script, seconds: float, off_m: float = 0.75) -> None:
    """Round about the goal, as PX4 SIH's estimate does: 0.5 to 0.9 m."""
    for n in range(round(seconds * 20)):
        angle = n / 7.0
        script.at(10.0 + off_m * math.cos(angle), off_m * math.sin(angle), UP)
        script.tick()


def test_an_estimate_that_wanders_by_its_own_accuracy_has_arrived() -> None:
    """autopilots.md, defect 11: 17 to 19 s for 10 m three times, and one DEADLINE."""
    script, goal = flown(None)
    wander(script, 8.0)
    assert not script.ended(goal)
    script, goal = flown(AccuracySeen(PX4_ACCURACY_M, NAV_ACC_RAD))
    wander(script, 1.0)
    assert script.outcome(goal).kind == "complete"
    assert script.gate.state is State.HOVERING


@pytest.mark.parametrize(("up_off_m", "arrives"), [(0.4, True), (0.6, False), (-0.6, False)])
def test_above_and_below_it_the_policy_s_radius_stays(up_off_m: float, arrives: bool) -> None:
    script, goal = flown(AccuracySeen(PX4_ACCURACY_M, NAV_ACC_RAD))
    for _ in range(30):
        script.at(10.0, 0.0, UP + up_off_m)
        script.tick()
    assert script.ended(goal) is arrives


def test_what_is_held_is_the_goal_and_not_where_it_arrived() -> None:
    script, goal = flown(AccuracySeen(PX4_ACCURACY_M, NAV_ACC_RAD))
    wander(script, 2.0)
    assert script.ended(goal)
    script.forget()
    script.tick(4)
    assert {pos for _, pos in script.setpoints()} == {(10.0, 0.0, UP)}


@pytest.mark.parametrize("east_m", [147.99, 148.01])
def test_no_margin_shrinks_by_it(east_m: float) -> None:
    """The default fence is a circle of 150 m with a margin of 2 m."""
    answers = []
    for seen in (None, AccuracySeen(5.0, 50.0)):
        script = Script(structs.replace(policy("default"), max_up_m=120.0)).take_control(UP)
        if seen is not None:
            script.feed(seen)
        asked = script.ask(GoTo((0.0, east_m, -UP)))
        script.tick()
        answers.append(script.verdict(asked))
    assert answers[0].ruling == answers[1].ruling
    assert answers[0].evidence == answers[1].evidence
    assert answers[0].refusal == answers[1].refusal


# -------------------------------------------------------------------------------- the heading


def turning(
    asked_deg: float, told_deg: float | None, rules: Policy | None = None
) -> tuple[Script, int]:
    """At its goal, and asked for a heading there."""
    script = Script(rules or policy("default")).take_control(UP)
    script.yaw_rad = None if told_deg is None else math.radians(told_deg)
    script.tick()
    return script, script.ask(GoTo((0.0, 0.0, -UP), math.radians(asked_deg)))


@pytest.mark.parametrize(
    ("asked_deg", "told_deg", "arrives"),
    [
        (90.0, 88.1, True),
        (90.0, 87.9, False),
        (-180.0, 179.0, True),  # the shorter way round
        (-180.0, 177.0, False),
        (450.0, 91.0, True),
        (0.0, 180.0, False),
        (0.0, None, True),  # told by nobody
    ],
)
def test_a_goal_with_a_heading_is_reached_when_the_nose_points_there(
    asked_deg: float, told_deg: float | None, arrives: bool
) -> None:
    script, goal = turning(asked_deg, told_deg)
    script.wait(5.0)
    assert script.ended(goal) is arrives
    assert script.gate.state is (State.HOVERING if arrives else State.MOVING)


def test_the_nose_is_there_for_the_dwell() -> None:
    script, goal = turning(90.0, 0.0)
    script.wait(1.0)
    script.yaw_rad = math.radians(89.0)
    script.wait(0.45)
    assert not script.ended(goal)
    script.yaw_rad = math.radians(93.0)  # past it
    script.wait(0.2)
    script.yaw_rad = math.radians(91.5)
    script.wait(0.5)
    assert not script.ended(goal)
    script.wait(0.1)
    assert script.outcome(goal).kind == "complete"
    script.yaw_rad = 0.0
    script.wait(1.0)
    assert script.gate.state is State.HOVERING, "reached once, it is held"


@pytest.mark.parametrize(("name", "arrives"), [("default", False), ("lab", True)])
def test_the_lab_waits_for_no_heading(name: str, arrives: bool) -> None:
    script, goal = turning(90.0, 0.0, policy(name))
    script.wait(2.0)
    assert script.ended(goal) is arrives


@pytest.mark.parametrize(("told_deg", "most_s"), [(0.0, 24.0), (170.0, 20.0)])
def test_a_nose_that_never_turns_ends_at_the_deadline_which_has_room_for_the_turn(
    told_deg: float, most_s: float
) -> None:
    """180 deg at [speeds] turn_deg_s, twice; 20 s at least."""
    script, goal = turning(180.0, told_deg)
    script.wait(most_s - 0.1)
    assert not script.ended(goal)
    script.wait(0.2)
    outcome = script.outcome(goal)
    assert (outcome.kind, outcome.code) == ("timed out", "DEADLINE")
    off_deg = 180.0 - told_deg
    assert f"the nose points {off_deg:.0f} deg from the heading" in outcome.sentence
    assert script.gate.state is State.HOLDING


def test_a_deadline_short_of_the_place_says_nothing_of_the_nose() -> None:
    script = Script(policy("default")).take_control(UP)
    script.yaw_rad = 0.0
    script.tick()
    goal = script.ask(GoTo((0.0, 10.0, -UP), 0.0))
    script.wait(21.0)
    assert script.outcome(goal).sentence == "it took longer than its deadline"
