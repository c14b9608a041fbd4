"""The lab's acceptance tests L1 to L17, as far as they are the gate's, under a fake clock."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest

from gcs.frames import ned_from_enu
from gcs.gate.effects import CommandKind, OutcomeKind, Ruling, SendSetpoint, Transition, Verdict
from gcs.gate.inputs import PhotoSeen, PositionSeen
from gcs.gate.refusal import Code
from gcs.gate.requests import Abort, GoTo, SwitchFence, TakeControl, TakeOff, TakePhoto
from gcs.gate.states import FlightMode, LandedState, State
from tests.unit.gate.script import MS, SECOND, TICK, Script, policy
from tests.unit.gate.situations import lead_to

BOTH = pytest.mark.parametrize("name", ["lab", "default"])


def hovering(name: str = "lab") -> Script:
    """Hovering under our control; with room below and around for the default margins."""
    script = Script(policy(name)).take_control(0.5 if name == "lab" else 5.0)
    script.forget()
    return script


def near(name: str) -> tuple[float, float, float]:
    return (1.0, 0.0, 0.5) if name == "lab" else (3.0, 0.0, 5.0)


def test_L01_hovering_streams_at_20_hz_and_up_is_minus_down() -> None:
    script = hovering()
    script.wait(2.0)
    times = [now_ns for now_ns, _ in script.setpoints()]
    assert len(times) == 40
    assert {b - a for a, b in pairwise(times)} == {TICK}
    assert {sent.permit.pos_ned for sent in script.all(SendSetpoint)} == {(0.0, 0.0, -0.5)}


def test_L03_enter_gives_requested_verified_moving_in_that_order() -> None:
    script = hovering()
    requested = script.goto(1.0, 0.0, 0.5)
    assert script.gate.state is State.HOVERING
    assert not script.all(Verdict)
    script.tick()
    told = [e for _, e in script.effects if isinstance(e, Transition | Verdict)]
    first, verdict, second = told
    assert isinstance(first, Transition)
    assert isinstance(second, Transition)
    assert (first.before, first.after) == (State.HOVERING, State.VERIFYING)
    assert isinstance(verdict, Verdict)
    assert (verdict.request_id, verdict.ruling) == (requested, Ruling.ACCEPTED)
    assert verdict.evidence
    assert (second.before, second.after) == (State.VERIFYING, State.MOVING)


@BOTH
def test_L04_moving_without_positions_never_completes(name: str) -> None:
    script = hovering(name)
    requested = script.goto(*near(name))
    script.tick()
    script.reports_position = False
    script.wait(script.policy.position_age_s + 0.1)
    assert script.gate.state is State.STALE
    script.wait(20.0)
    assert script.outcome(requested).code is Code.STALE


@BOTH
def test_L05_second_request_is_refused_busy(name: str) -> None:
    script = hovering(name)
    goal = near(name)
    first = script.goto(*goal)
    script.wait(0.2)
    second = script.goto(goal[0], 2.0, goal[2])
    verdict = script.verdict(second)
    assert script.refusal(second) is Code.BUSY
    assert verdict.active_goal_ned == ned_from_enu(goal)
    script.wait(0.5)
    script.at(*goal)
    script.wait(5.0)
    assert script.outcome(first).kind is OutcomeKind.COMPLETE
    assert (goal[0], 2.0, goal[2]) not in {place for _, place in script.setpoints()}


def test_L06_in_range_is_complete_and_the_stream_goes_on_at_the_goal() -> None:
    script = hovering()
    requested = script.goto(1.0, 0.0, 0.5)
    script.wait(0.5)
    script.at(0.9, 0.0, 0.5)
    script.tick()
    assert script.outcome(requested).kind is OutcomeKind.COMPLETE
    assert script.gate.state is State.HOVERING
    script.forget()
    script.wait(1.0)
    assert [place for _, place in script.setpoints()] == [(1.0, 0.0, 0.5)] * 20


def test_L07_then_a_second_goal_is_accepted_and_flown() -> None:
    script = hovering()
    script.goto(1.0, 0.0, 0.5)
    script.tick()
    script.at(1.0, 0.0, 0.5)
    script.tick()
    requested = script.goto(1.0, 1.0, 0.5)
    script.tick()
    assert script.verdict(requested).ruling is Ruling.ACCEPTED
    assert script.gate.state is State.MOVING
    assert list(script.setpoints())[-1][1] == (1.0, 1.0, 0.5)


def test_L08_exactly_at_the_radius_is_not_complete_and_just_below_is() -> None:
    script = hovering()
    requested = script.goto(1.0, 0.0, 0.5)
    script.tick()
    script.at(0.5, 0.0, 0.5)
    script.wait(1.0)
    assert not script.ended(requested)
    script.at(math.nextafter(0.5, 1.0), 0.0, 0.5)
    script.tick()
    assert script.outcome(requested).kind is OutcomeKind.COMPLETE


def test_L09_the_present_position_as_goal_is_one_tick_of_moving_then_complete() -> None:
    script = hovering()
    requested = script.goto(0.0, 0.0, 0.5)
    script.tick()
    assert script.states() == [State.VERIFYING, State.MOVING]
    assert not script.ended(requested)
    script.tick()
    assert script.states()[2:] == [State.HOVERING]
    assert script.outcome(requested).kind is OutcomeKind.COMPLETE


def test_L10_of_two_requests_in_one_tick_the_second_wins() -> None:
    script = hovering()
    first = script.goto(1.0, 0.0, 0.5)
    second = script.goto(0.0, 1.0, 0.5)
    script.tick()
    assert script.verdict(first).ruling is Ruling.SUPERSEDED
    assert script.verdict(second).ruling is Ruling.ACCEPTED
    assert (1.0, 0.0, 0.5) not in {place for _, place in script.setpoints()}
    assert not script.ended(first)


@BOTH
@pytest.mark.parametrize("fence_on", [True, False])
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_L11_a_goal_that_is_no_number_is_refused(
    name: str, fence_on: bool, bad: float, axis: int
) -> None:
    script = hovering(name)
    script.place(fence_on=fence_on)
    goal = list(near(name))
    goal[axis] = bad
    requested = script.goto(*goal)
    script.wait(0.5)
    assert script.refusal(requested) is Code.NON_FINITE
    assert script.gate.state is State.HOVERING
    assert all(math.isfinite(x) for _, place in script.setpoints() for x in place)


@pytest.mark.parametrize(
    ("goal", "accepted"),
    [((5.0, 5.0, 2.0), True), ((5.01, 0.0, 1.0), False), ((0.0, 0.0, -0.1), False)],
)
def test_L12_the_bounds_of_the_cage_are_inclusive(
    goal: tuple[float, float, float], accepted: bool
) -> None:
    script = hovering()
    requested = script.goto(*goal)
    script.wait(0.2)
    verdict = script.verdict(requested)
    assert (verdict.ruling is Ruling.ACCEPTED) is accepted
    assert (goal in {place for _, place in script.setpoints()}) is accepted
    if not accepted:
        assert verdict.refusal is not None
        assert verdict.refusal.zone == "cage"
        assert verdict.refusal.numbers


def test_L13_a_refused_goal_is_gone_and_flies_only_when_sent_again() -> None:
    script = hovering()
    requested = script.goto(8.0, 0.0, 1.0)
    script.tick()
    assert script.verdict(requested).ruling is Ruling.REFUSED
    switch = script.ask(SwitchFence(on=False))
    assert script.outcome(switch).kind is OutcomeKind.COMPLETE
    script.wait(3.0)
    assert script.gate.state is State.HOVERING
    assert (8.0, 0.0, 1.0) not in {place for _, place in script.setpoints()}
    again = script.goto(8.0, 0.0, 1.0)
    script.tick()
    assert script.verdict(again).ruling is Ruling.ACCEPTED
    assert list(script.setpoints())[-1][1] == (8.0, 0.0, 1.0)


def test_L13_any_other_policy_refuses_to_switch_the_fence() -> None:
    script = hovering("default")
    assert script.refusal(script.ask(SwitchFence(on=False))) is Code.POLICY


@BOTH
def test_L14_a_position_that_stops_arriving_degrades_within_the_limit(name: str) -> None:
    script = hovering(name)
    requested = script.goto(*near(name))
    script.wait(0.5)
    script.reports_position = False
    stopped_ns = script.now_ns
    while script.gate.state is not State.STALE:
        script.tick()
    limit_ns = round(script.policy.position_age_s * SECOND) + TICK
    assert script.now_ns - stopped_ns <= limit_ns
    script.wait(script.policy.stale_grace_s + 0.05)
    assert script.outcome(requested).kind is OutcomeKind.ABORTED
    assert script.commands()[-1] is CommandKind.HOLD
    script.forget()
    script.wait(5.0)
    assert not list(script.setpoints())


def _situation(state: State, name: str) -> Script:
    """A vehicle that flies (or stands) in `state`, by the inputs that lead there."""
    script = Script(policy(name))
    lead_to(state, script)
    return script


@BOTH
@pytest.mark.parametrize(
    "state",
    [s for s in State if s not in (State.NO_VEHICLE, State.VERIFYING, State.STREAMING)],
    ids=lambda s: s.name,
)
def test_L15_abort_in_each_state_holds_and_no_arrival_revives_the_goal(
    state: State, name: str
) -> None:
    script = _situation(state, name)
    goal = script.gate.active_goal_ned
    assert script.gate.state is state
    script.forget()
    abort = script.ask(Abort())
    assert script.verdict(abort).ruling is Ruling.ACCEPTED
    if state in (State.GROUNDED, State.TAKING_OFF):
        held = [CommandKind.HOLD] if state is State.TAKING_OFF else []
        assert script.commands() == [*held, CommandKind.DISARM]
        assert script.gate.state is State.GROUNDED
    else:
        assert CommandKind.HOLD in script.commands()
        assert script.gate.state in (State.HOLDING, State.STALE)
    if goal is not None:
        script.feed(PositionSeen(goal, (0.0, 0.0, 0.0), script.now_ns // MS))
    script.wait(3.0)
    assert script.gate.state in (State.HOLDING, State.STALE, State.GROUNDED)
    others = [e for e in script.all(Verdict) if e.request_id != abort]
    assert not others
    assert State.MOVING not in script.states()
    assert State.HOVERING not in script.states()


@BOTH
def test_L16_a_move_while_a_picture_is_taken_is_refused_busy(name: str) -> None:
    script = hovering(name)
    photo = script.ask(TakePhoto())
    assert script.gate.state is State.TAKING_PICTURE
    assert script.commands() == [CommandKind.PHOTO]
    move = script.goto(*near(name))
    script.wait(1.0)
    assert script.refusal(move) is Code.BUSY
    script.feed(PhotoSeen(0, ok=True))
    assert script.outcome(photo).kind is OutcomeKind.COMPLETE
    again = script.goto(*near(name))
    script.tick()
    assert script.verdict(again).ruling is Ruling.ACCEPTED


def test_nothing_is_streamed_before_the_operator_takes_control() -> None:
    script = Script(policy("lab")).fly()
    assert script.gate.state is State.EXTERNAL
    script.wait(5.0)
    assert not list(script.setpoints())
    assert not script.commands()


def test_no_acceptance_without_a_position() -> None:
    script = Script(policy("lab"))
    script.heartbeat()
    script.land_state(LandedState.IN_AIR)
    script.place()
    for request in (GoTo((0.0, 0.0, -1.0)), TakeControl(), TakeOff(1.0)):
        assert script.refusal(script.ask(request)) is Code.NO_POSITION


def test_arrival_by_the_expert_rules_waits_for_speed_and_dwell() -> None:
    script = hovering("default")
    requested = script.goto(3.0, 0.0, 5.0)
    script.tick()
    script.v_ned = (0.0, 1.0, 0.0)
    script.at(2.8, 0.0, 5.0, v_enu=(1.0, 0.0, 0.0))
    script.wait(1.0)
    assert not script.ended(requested)
    script.at(3.0, 0.0, 5.0)
    script.wait(0.45)
    assert not script.ended(requested)
    script.wait(0.1)
    assert script.outcome(requested).kind is OutcomeKind.COMPLETE


def test_the_heartbeat_confirms_control_and_a_goal_before_that_waits_for_it() -> None:
    script = Script(policy("lab")).fly()
    control = script.ask(TakeControl())
    script.tick()
    early = script.goto(1.0, 0.0, 0.5)
    assert not script.all(Verdict)[1:]
    script.wait(0.9)
    assert not script.commands()
    script.wait(0.1)
    assert script.commands() == [CommandKind.GUIDED]
    script.answer(CommandKind.GUIDED, 0)
    assert not script.ended(control)
    assert script.gate.state.name == "HOVERING"
    script.heartbeat(FlightMode.GUIDED)
    assert script.outcome(control).kind is OutcomeKind.COMPLETE
    script.tick()
    assert script.verdict(early).ruling is Ruling.ACCEPTED
    assert script.gate.state is State.MOVING
