"""What the operator is told of verdicts and outcomes, and how loudly."""

from __future__ import annotations

import pytest

from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import CommandKind, Level, Outcome, Ruling, Say, SendCommand
from gcs.gate.inputs import ConditionChanged
from gcs.gate.machine.events import Event, event_of
from gcs.gate.refusal import Code
from gcs.gate.requests import Arm, GoTo, Hold, SetMode, TakeOff, TakePhoto
from gcs.gate.states import FlightMode, LandedState, State
from tests.unit.gate.reactions import default_policy, flight, remember, take_off
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import UP

WRONG = ConditionChanged(Condition.BATTERY_LOW, True, "low")


def severe(severity: Severity) -> dict[str, object]:
    """A policy's severities with BATTERY_LOW this bad."""
    return {"severities": {**policy("default").severities, Condition.BATTERY_LOW: severity}}


class TestLines:
    def test_a_refusal_is_one_warning_with_its_code_and_its_sentence(self) -> None:
        script, _ = flight(State.MOVING)
        request_id = script.ask(TakePhoto())
        refusal = script.verdict(request_id).refusal
        assert refusal is not None
        assert script.all(Say) == [Say(Level.WARNING, f"Refused (BUSY): {refusal.sentence}")]

    def test_a_goal_that_a_newer_one_replaces_before_its_tick_is_not_refused(self) -> None:
        script = Script(policy("default")).take_control(UP)
        script.forget()
        older = script.ask(GoTo((0.0, 3.0, -UP)))
        script.ask(GoTo((0.0, 4.0, -UP)))
        assert script.verdict(older).ruling is Ruling.SUPERSEDED
        assert script.refusal(older) is Code.SUPERSEDED
        assert {said.level for said in script.all(Say)} == {Level.INFO}

    def test_what_is_accepted_is_not_refused(self) -> None:
        script = Script(policy("default")).connect()
        script.forget()
        assert script.verdict(script.ask(Arm())).ruling is Ruling.ACCEPTED
        assert script.all(Say) == []

    def test_completion_is_told_and_is_no_warning(self) -> None:
        script = Script(policy("default")).connect()
        script.ask(Arm())
        script.forget()
        script.heartbeat(armed=True)
        assert script.all(Say) == [Say(Level.INFO, "Complete")]

    def test_any_other_end_is_a_warning_with_the_request_and_the_reason(self) -> None:
        script = Script(policy("default")).take_control(UP)
        script.ask(GoTo((0.0, 3.0, -UP)))
        script.tick()
        script.forget()
        script.ask(Hold())
        told = [said for said in script.all(Say) if said.level is not Level.INFO]
        assert told == [Say(Level.WARNING, "goto: aborted: stopped by the operator")]


class TestReasons:
    def test_the_severity_is_told_with_what_is_wrong(self) -> None:
        script, _ = flight(State.MOVING, **severe(Severity.HOLD))
        script.feed(WRONG)
        (outcome,) = script.all(Outcome)
        assert outcome.code is Code.SEVERITY
        assert outcome.sentence == "severity is HOLD: battery_low"

    def test_also_where_the_return_that_it_demands_is_blocked(self) -> None:
        """Why the way home does not clear is not why the request ended."""
        script, _ = flight(State.MOVING, **severe(Severity.RETURN))
        remember(script, return_up_m=None)
        script.feed(WRONG)
        (outcome,) = script.all(Outcome)
        assert outcome.code is Code.SEVERITY
        assert outcome.sentence == "severity is RETURN: battery_low"

    @pytest.mark.parametrize("mode", [FlightMode.HOLD, FlightMode.TAKEOFF, FlightMode.OTHER])
    def test_a_pilots_mode_is_why_a_goal_that_waits_for_its_tick_is_refused(
        self, mode: FlightMode
    ) -> None:
        script = Script(policy("default")).take_control(UP)
        request_id = script.ask(GoTo((0.0, 3.0, -UP)))
        script.heartbeat(mode)
        assert script.refusal(request_id) is Code.MODE_CHANGED


class TestRecorder:
    FAILED = ConditionChanged(Condition.RECORDER_FAILED, True, "disk full")
    LOW = ConditionChanged(Condition.BATTERY_LOW, True, "low")

    @pytest.mark.parametrize("wanted", [True, False])
    @pytest.mark.parametrize("failed", [True, False])
    def test_arming_needs_it_where_the_policy_does_whatever_else_is_wrong(
        self, wanted: bool, failed: bool
    ) -> None:
        mild = {
            Condition.RECORDER_FAILED: Severity.CAUTION,
            Condition.BATTERY_LOW: Severity.CAUTION,
        }
        severities = {**policy("default").severities, **mild}
        rules = default_policy(arm_requires_recording=wanted, severities=severities)
        script = Script(rules).connect()
        script.feed(self.LOW)
        if failed:
            script.feed(self.FAILED)
        verdict = script.verdict(script.ask(Arm()))
        if wanted and failed:
            assert verdict.refusal is not None
            assert verdict.refusal.code is Code.RECORDER_DOWN
        else:
            assert verdict.ruling is Ruling.ACCEPTED


ASKED = {
    FlightMode.GUIDED: Event.CONTROL,
    FlightMode.HOLD: Event.HOLD,
    FlightMode.TAKEOFF: Event.OTHER_MODE,
    FlightMode.MISSION: Event.MISSION,
    FlightMode.RETURN: Event.RETURN,
    FlightMode.LAND: Event.LAND,
    FlightMode.OTHER: Event.OTHER_MODE,
}


@pytest.mark.parametrize("mode", FlightMode)
def test_a_mode_by_its_name_is_the_request_that_means_the_same(mode: FlightMode) -> None:
    """A take-off has a height, which a mode has not: it is no way to take off."""
    assert event_of(SetMode("its name", mode)) is ASKED[mode]


class TestClimbs:
    def test_the_command_that_waited_for_its_mode_has_the_height(self) -> None:
        script = Script(policy("default"), "ardupilot").connect()
        script.heartbeat(FlightMode.HOLD, armed=True)
        request_id = script.ask(TakeOff(3.0))
        script.heartbeat(FlightMode.GUIDED)
        sent = script.all(SendCommand)
        assert [s.kind for s in sent] == [CommandKind.GUIDED, CommandKind.TAKE_OFF]
        assert (sent[-1].request_id, sent[-1].up_m) == (request_id, 3.0)

    def test_the_ground_is_as_far_down_as_where_it_stands(self) -> None:
        """Ten metres east of home, on the ground: it stands, and an abort disarms it."""
        script = Script(policy("default"))
        script.pos_ned = (0.0, 10.0, 0.0)
        take_off(script)
        script.ask(Hold())
        assert script.gate.state is State.GROUNDED
        assert script.commands()[-2:] == [CommandKind.HOLD, CommandKind.DISARM]

    @pytest.mark.parametrize("up", [5.5, 5.75, 5.9375])
    def test_a_climb_that_ended_less_than_a_metre_above_is_told_as_above(self, up: float) -> None:
        script = Script(policy("default"))
        request_id = take_off(script, 5.0)
        script.land_state(LandedState.TAKEOFF)
        script.v_ned = (0.0, 0.0, -1.0)
        script.at(0.0, 0.0, up, (0.0, 0.0, 1.0))
        script.land_state(LandedState.IN_AIR)
        script.v_ned = (0.0, 0.0, 0.0)
        script.heartbeat(FlightMode.HOLD)
        script.tick()
        assert "m above the height asked for" in script.outcome(request_id).sentence
