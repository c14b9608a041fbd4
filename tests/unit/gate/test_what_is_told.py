"""What the operator is told of verdicts and outcomes, and how loudly."""

from __future__ import annotations

import pytest

from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import Level, Outcome, Ruling, Say
from gcs.gate.inputs import ConditionChanged
from gcs.gate.refusal import Code
from gcs.gate.requests import Arm, GoTo, Hold, TakePhoto
from gcs.gate.states import FlightMode, State
from tests.unit.gate.reactions import flight, remember
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
        assert script.all(Say) == [Say(Level.INFO, "Complete: arm")]

    def test_any_other_end_is_a_warning_with_the_request_and_the_reason(self) -> None:
        script = Script(policy("default")).take_control(UP)
        script.ask(GoTo((0.0, 3.0, -UP)))
        script.tick()
        script.forget()
        script.ask(Hold())
        told = [said for said in script.all(Say) if said.level is not Level.INFO]
        assert told == [Say(Level.WARNING, "goto: aborted: stopped by the operator")]

    def test_of_a_vehicle_that_another_flies_it_is_told_that_nothing_is_done(self) -> None:
        script, _ = flight(State.EXTERNAL, **severe(Severity.HOLD))
        script.feed(WRONG)
        (told,) = script.all(Say)
        assert told.text.startswith("HOLD: battery_low: low; nothing is done about it")
        script, _ = flight(State.EXTERNAL, **severe(Severity.CAUTION))
        script.feed(WRONG)
        assert [told.text for told in script.all(Say)] == ["CAUTION: battery_low: low"]


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
