"""In which states a stream begins, and why it does not in the others."""

from __future__ import annotations

import pytest

from gcs.gate.condition import Condition
from gcs.gate.effects import OutcomeKind, Ruling, SendSetpoint, StreamVerdict
from gcs.gate.inputs import ConditionChanged, OperatorLost, StreamSeen, Tick
from gcs.gate.refusal import Code
from gcs.gate.requests import BeginStream, EndStream, GoTo, TakeControl
from gcs.gate.states import FlightMode, State
from tests.unit.gate.reactions import STATES, default_policy, flight, stale, state_of
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import UP

SAMPLE = StreamSeen("keyboard", None, (0.0, 1.0, 0.0), None, None, None)

REFUSED = {
    State.NO_VEHICLE: Code.NO_VEHICLE,
    State.STALE: Code.STALE,
    State.GROUNDED: Code.NOT_FLYING,
    State.TAKING_OFF: Code.BUSY,
    State.MOVING: Code.BUSY,
    State.TAKING_PICTURE: Code.BUSY,
    State.FLYING_MISSION: Code.BUSY,
    State.RETURNING: Code.BUSY,
    State.LANDING: Code.BUSY,
    State.HOLDING: Code.HOLDING,
    State.EXTERNAL: Code.NOT_IN_CONTROL,
}
"""As a goal is; a return and a landing here are ours."""


def codes(script: Script) -> list[Code | None]:
    return [v.refusal.code if v.refusal else None for v in script.all(StreamVerdict)]


@pytest.mark.parametrize("state", [s for s in STATES if s is not State.HOVERING])
def test_samples_are_refused_with_the_reason_of_the_state_and_dropped(state: State) -> None:
    script, _ = flight(state)
    script.feed(SAMPLE)
    assert codes(script) == [REFUSED[state]]
    assert state_of(script) is state
    script.feed(Tick(0))
    assert all(sent.permit.v_ned is None for sent in script.all(SendSetpoint))


@pytest.mark.parametrize("state", [s for s in STATES if s is not State.HOVERING])
def test_a_request_to_stream_is_refused_with_the_same_reason(state: State) -> None:
    script, _ = flight(state)
    assert script.refusal(script.ask(BeginStream())) is REFUSED[state]
    assert state_of(script) is state


@pytest.mark.parametrize("state", [s for s in STATES if s is not State.STALE])
def test_the_end_of_no_stream_changes_nothing(state: State) -> None:
    script, request_id = flight(state)
    assert script.outcome(script.ask(EndStream())).kind is OutcomeKind.COMPLETE
    assert state_of(script) is state
    assert request_id == 0 or not script.ended(request_id)


def test_the_end_of_a_stream_is_not_decided_on_a_position_too_old() -> None:
    script, _ = stale(State.HOVERING)
    assert script.refusal(script.ask(EndStream())) is Code.STALE


@pytest.mark.parametrize("mode", [FlightMode.RETURN, FlightMode.LAND])
def test_a_return_or_landing_of_the_vehicle_s_own_is_not_in_our_control(mode: FlightMode) -> None:
    script = Script(policy("default")).take_control(UP)
    script.heartbeat(mode)
    script.forget()
    script.feed(SAMPLE)
    assert codes(script) == [Code.NOT_IN_CONTROL]
    assert script.refusal(script.ask(BeginStream())) is Code.NOT_IN_CONTROL


def test_while_control_is_taken_it_waits() -> None:
    script = Script(policy("default")).fly(UP)
    script.ask(TakeControl())
    script.forget()
    script.feed(SAMPLE)
    assert codes(script) == [Code.CONTROL_PENDING]
    assert script.refusal(script.ask(BeginStream())) is Code.CONTROL_PENDING


@pytest.mark.parametrize("state", [State.HOVERING, State.MOVING])
def test_while_a_goal_waits_for_its_tick_it_is_busy(state: State) -> None:
    script = Script(default_policy(retarget="replace")).take_control(UP)
    if state is State.MOVING:
        script.goto(5.0, 0.0, UP)
        script.tick()
    goal = script.ask(GoTo((0.0, 3.0, -UP)))
    script.feed(SAMPLE)
    assert codes(script) == [Code.BUSY]
    assert script.refusal(script.ask(BeginStream())) is Code.BUSY
    script.tick()
    assert script.verdict(goal).ruling is Ruling.ACCEPTED


def test_a_severity_of_hold_ends_it_and_lets_none_begin() -> None:
    script = Script(policy("default")).take_control(UP)
    begun = script.ask(BeginStream())
    script.feed(SAMPLE)
    script.feed(ConditionChanged(Condition.GPS_LOST, True, "no fix"))
    assert state_of(script) is State.HOLDING
    assert script.outcome(begun).code is Code.SEVERITY


def test_an_operator_that_leaves_ends_it() -> None:
    script = Script(policy("default")).take_control(UP)
    begun = script.ask(BeginStream())
    script.feed(SAMPLE)
    script.feed(OperatorLost("gone", for_good=False))
    assert state_of(script) is State.HOLDING
    assert script.outcome(begun).code is Code.OPERATOR_LOST


def test_a_refused_first_sample_where_a_goal_may_be_replaced_leaves_the_goal_flown() -> None:
    script = Script(default_policy(retarget="replace")).take_control(UP)
    goal = script.goto(5.0, 0.0, UP)
    script.tick()
    script.feed(StreamSeen("keyboard", None, (50.0, 0.0, 0.0), None, None, None))
    assert codes(script) == [Code.POLICY]
    assert state_of(script) is State.MOVING
    assert not script.ended(goal)
