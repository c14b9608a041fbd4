"""What a severity demands in each state, and what the loss of the operator does."""

from __future__ import annotations

import pytest

from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import CommandKind, Say
from gcs.gate.inputs import ConditionChanged, OperatorLost, ReturnHeightSeen
from gcs.gate.requests import Arm, Disarm, Hold, Land
from gcs.gate.states import Control, FlightMode, State
from tests.unit.gate.reactions import (
    FLIGHT,
    GUIDED_STATES,
    HELD,
    Reaction,
    default_policy,
    ended,
    flight,
    reaction,
    state_of,
    streams,
    take_off,
)
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import UP, lead_to

RETURNS = (State.RETURNING, Control.OURS, [CommandKind.RETURN])
LANDS = (State.LANDING, Control.OURS, [CommandKind.LAND])
UNSAFE = [Severity.HOLD, Severity.RETURN, Severity.LAND, Severity.TERMINATE]
OURS = (State.TAKING_OFF, *GUIDED_STATES, State.FLYING_MISSION)
EVERYWHERE = [*FLIGHT, State.GROUNDED, State.STALE, State.HOLDING, State.EXTERNAL, State.NO_VEHICLE]


def at_severity(
    state: State, severity: Severity, **changes: object
) -> tuple[Script, int, ConditionChanged]:
    """`state`, its request, and what raises the severity."""
    severities = {**policy("default").severities, Condition.BATTERY_LOW: severity}
    script, request_id = flight(state, severities=severities, allow_force_disarm=True, **changes)
    return script, request_id, ConditionChanged(Condition.BATTERY_LOW, True, "low")


@pytest.mark.parametrize("severity", UNSAFE)
@pytest.mark.parametrize("state", OURS)
def test_what_we_fly_does_what_the_severity_says(state: State, severity: Severity) -> None:
    script, request_id, raised = at_severity(state, severity)
    after = {Severity.HOLD: HELD, Severity.RETURN: RETURNS}.get(severity, LANDS)
    assert reaction(script, request_id, lambda s: s.feed(raised)) == Reaction(
        *after, "aborted SEVERITY"
    )
    assert script.gate.severity is severity


@pytest.mark.parametrize(
    ("blocked", "after"), [("hold", HELD), ("land", LANDS), ("forward", RETURNS)]
)
@pytest.mark.parametrize("state", OURS)
def test_a_return_that_is_blocked_is_what_the_policy_says(
    state: State, blocked: str, after: tuple[State, Control, list[CommandKind]]
) -> None:
    script, request_id, raised = at_severity(state, Severity.RETURN, rtl_blocked=blocked)
    script.feed(ReturnHeightSeen(80.0))
    assert reaction(script, request_id, lambda s: s.feed(raised)) == Reaction(
        *after, "aborted SEVERITY"
    )


@pytest.mark.parametrize("severity", UNSAFE)
def test_a_take_off_that_stands_is_given_up(severity: Severity) -> None:
    severities = {**policy("default").severities, Condition.BATTERY_LOW: severity}
    script = Script(default_policy(severities=severities))
    request_id = take_off(script)
    raised = ConditionChanged(Condition.BATTERY_LOW, True)
    assert reaction(script, request_id, lambda s: s.feed(raised)) == Reaction(
        State.GROUNDED,
        Control.NONE,
        [CommandKind.HOLD, CommandKind.DISARM],
        "aborted SEVERITY",
    )
    assert reaction(script, request_id, lambda s: s.wait(1.1)).sent == [CommandKind.HOLD]


@pytest.mark.parametrize("severity", UNSAFE)
def test_arming_is_given_up(severity: Severity) -> None:
    script, request_id, raised = at_severity(State.GROUNDED, severity)
    assert reaction(script, request_id, lambda s: s.feed(raised)) == Reaction(
        State.GROUNDED, Control.NONE, [], "aborted SEVERITY"
    )


@pytest.mark.parametrize("severity", UNSAFE)
def test_a_disarm_goes_on(severity: Severity) -> None:
    script, _, raised = at_severity(State.GROUNDED, severity)
    disarm = script.ask(Disarm())
    assert reaction(script, disarm, lambda s: s.feed(raised)) == Reaction(
        State.GROUNDED, Control.NONE, [], ""
    )


class TestWhatComesDownAlready:
    @pytest.mark.parametrize("severity", [Severity.HOLD, Severity.RETURN])
    def test_a_return_goes_on(self, severity: Severity) -> None:
        script, request_id, raised = at_severity(State.RETURNING, severity)
        assert reaction(script, request_id, lambda s: s.feed(raised)) == Reaction(
            State.RETURNING, Control.OURS, [], ""
        )

    @pytest.mark.parametrize("severity", [Severity.LAND, Severity.TERMINATE])
    def test_it_lands_where_that_is_demanded(self, severity: Severity) -> None:
        script, request_id, raised = at_severity(State.RETURNING, severity)
        assert reaction(script, request_id, lambda s: s.feed(raised)) == Reaction(
            *LANDS, "aborted SEVERITY"
        )

    @pytest.mark.parametrize("severity", UNSAFE)
    def test_a_return_of_the_vehicles_own_goes_on(self, severity: Severity) -> None:
        severities = {**policy("default").severities, Condition.BATTERY_LOW: severity}
        script = Script(default_policy(severities=severities)).fly(UP)
        script.heartbeat(FlightMode.RETURN)
        raised = ConditionChanged(Condition.BATTERY_LOW, True)
        assert reaction(script, 0, lambda s: s.feed(raised)) == Reaction(
            State.RETURNING, Control.NONE, [], ""
        )

    @pytest.mark.parametrize("severity", UNSAFE)
    def test_a_landing_goes_on(self, severity: Severity) -> None:
        script, request_id, raised = at_severity(State.LANDING, severity)
        assert reaction(script, request_id, lambda s: s.feed(raised)) == Reaction(
            State.LANDING, Control.OURS, [], ""
        )


class TestWhatIsHeld:
    def test_it_stays_held(self) -> None:
        script, request_id, raised = at_severity(State.HOLDING, Severity.HOLD)
        assert reaction(script, request_id, lambda s: s.feed(raised)) == Reaction(
            State.HOLDING, Control.OURS, [], ""
        )

    @pytest.mark.parametrize(
        ("severity", "blocked", "height", "after"),
        [
            (Severity.RETURN, "hold", 1.5, RETURNS),
            (Severity.RETURN, "forward", 80.0, RETURNS),
            (Severity.RETURN, "land", 80.0, LANDS),
            (Severity.LAND, "hold", 1.5, LANDS),
            (Severity.TERMINATE, "hold", 1.5, LANDS),
        ],
    )
    def test_it_returns_or_lands_where_that_is_demanded(
        self,
        severity: Severity,
        blocked: str,
        height: float,
        after: tuple[State, Control, list[CommandKind]],
    ) -> None:
        script, request_id, raised = at_severity(State.HOLDING, severity, rtl_blocked=blocked)
        script.feed(ReturnHeightSeen(height))
        assert reaction(script, request_id, lambda s: s.feed(raised)) == Reaction(
            *after, "aborted SEVERITY"
        )

    def test_it_stays_held_where_the_return_is_blocked(self) -> None:
        script, request_id, raised = at_severity(State.HOLDING, Severity.RETURN)
        script.feed(ReturnHeightSeen(80.0))
        assert reaction(script, request_id, lambda s: s.feed(raised)) == Reaction(
            State.HOLDING, Control.OURS, [], ""
        )


class TestWithAnOldPosition:
    @pytest.mark.parametrize("severity", [Severity.HOLD, Severity.RETURN])
    def test_it_is_held_and_streams_no_more(self, severity: Severity) -> None:
        script, request_id, raised = at_severity(State.STALE, severity)
        assert reaction(script, request_id, lambda s: s.feed(raised)) == Reaction(
            State.STALE, Control.OURS, [CommandKind.HOLD], "aborted SEVERITY"
        )
        assert not streams(script)
        script.feed(ConditionChanged(Condition.BATTERY_LOW, False))
        script.reports_position = True
        script.tick()
        assert state_of(script) is State.HOLDING

    @pytest.mark.parametrize("severity", [Severity.LAND, Severity.TERMINATE])
    def test_it_lands_where_that_is_demanded(self, severity: Severity) -> None:
        script, request_id, raised = at_severity(State.STALE, severity)
        assert reaction(script, request_id, lambda s: s.feed(raised)) == Reaction(
            *LANDS, "aborted SEVERITY"
        )

    @pytest.mark.parametrize("severity", UNSAFE)
    def test_what_we_do_not_fly_is_left_alone(self, severity: Severity) -> None:
        script, request_id, raised = at_severity(State.GROUNDED, severity)
        script.reports_position = False
        script.wait(1.2)
        assert reaction(script, request_id, lambda s: s.feed(raised)) == Reaction(
            State.STALE, Control.NONE, [], "aborted SEVERITY"
        )

    def test_what_is_held_already_waits_for_its_position(self) -> None:
        script, _, raised = at_severity(State.STALE, Severity.RETURN)
        hold = script.ask(Hold())
        assert reaction(script, hold, lambda s: s.feed(raised)) == Reaction(
            State.STALE, Control.OURS, [], ""
        )
        script.reports_position = True
        assert reaction(script, hold, lambda s: s.position()) == Reaction(
            *RETURNS, "aborted SEVERITY"
        )


@pytest.mark.parametrize("severity", list(Severity)[1:])
def test_where_somebody_else_flies_nothing_is_sent(severity: Severity) -> None:
    script, request_id, raised = at_severity(State.EXTERNAL, severity)
    assert reaction(script, request_id, lambda s: s.feed(raised)) == Reaction(
        State.EXTERNAL, Control.NONE, [], ""
    )


@pytest.mark.parametrize("severity", UNSAFE)
def test_nor_where_nobody_is_heard(severity: Severity) -> None:
    script, request_id, raised = at_severity(State.NO_VEHICLE, severity)
    assert reaction(script, request_id, lambda s: s.feed(raised)) == Reaction(
        State.NO_VEHICLE, Control.NONE, [], ""
    )


@pytest.mark.parametrize("severity", [Severity.NOMINAL, Severity.CAUTION])
@pytest.mark.parametrize("state", EVERYWHERE)
def test_what_comes_and_goes_and_is_not_severe_changes_nothing(
    state: State, severity: Severity
) -> None:
    script, request_id, raised = at_severity(state, severity)
    control = script.gate.control
    before = script.gate.memory
    eased = ConditionChanged(Condition.BATTERY_LOW, False)
    assert reaction(script, request_id, lambda s: [s.feed(raised), s.feed(eased)]) == Reaction(
        state, control, [], ""
    )
    assert script.gate.memory == before
    assert all(isinstance(effect, Say) for _, effect in script.effects)


@pytest.mark.parametrize("severity", UNSAFE)
@pytest.mark.parametrize("state", [State.HOLDING, State.EXTERNAL, State.GROUNDED])
def test_what_is_over_changes_nothing_more(state: State, severity: Severity) -> None:
    script, _, raised = at_severity(state, severity, rtl_blocked="hold")
    script.feed(ReturnHeightSeen(80.0))
    script.feed(raised)
    before = script.gate.memory
    script.feed(ConditionChanged(Condition.BATTERY_LOW, False))
    after = script.gate.memory
    assert (after.state, after.control, after.task) == (before.state, before.control, before.task)
    assert script.gate.severity is Severity.NOMINAL


def test_a_second_condition_that_is_no_worse_demands_nothing_new() -> None:
    severities = {
        **policy("default").severities,
        Condition.BATTERY_LOW: Severity.HOLD,
        Condition.OTHER_STATION: Severity.HOLD,
    }
    script = Script(default_policy(severities=severities))
    lead_to(State.HOLDING, script)
    script.feed(ConditionChanged(Condition.BATTERY_LOW, True))
    script.forget()
    script.feed(ConditionChanged(Condition.OTHER_STATION, True))
    assert script.commands() == []
    script.feed(ConditionChanged(Condition.OTHER_STATION, False))
    assert script.gate.severity is Severity.HOLD


COMING_DOWN = (State.RETURNING, State.LANDING)


class TestOperatorLost:
    QUIT = OperatorLost("quit")

    @pytest.mark.parametrize("state", [s for s in FLIGHT if s not in COMING_DOWN])
    def test_what_we_fly_is_held(self, state: State) -> None:
        script, request_id = flight(state)
        assert reaction(script, request_id, lambda s: s.feed(self.QUIT)) == Reaction(
            *HELD, "aborted OPERATOR_LOST"
        )

    def test_a_take_off_that_stands_is_given_up(self) -> None:
        script = Script(policy("default"))
        request_id = take_off(script)
        assert reaction(script, request_id, lambda s: s.feed(self.QUIT)) == Reaction(
            State.GROUNDED,
            Control.NONE,
            [CommandKind.HOLD, CommandKind.DISARM],
            "aborted OPERATOR_LOST",
        )
        assert reaction(script, request_id, lambda s: s.wait(1.1)).sent == [CommandKind.HOLD]

    def test_arming_is_given_up(self) -> None:
        script, request_id = flight(State.GROUNDED)
        assert reaction(script, request_id, lambda s: s.feed(self.QUIT)) == Reaction(
            State.GROUNDED, Control.NONE, [], "aborted OPERATOR_LOST"
        )

    def test_a_take_off_that_may_come_yet_is_held(self) -> None:
        script = Script(policy("default"))
        take_off(script)
        script.answer(CommandKind.TAKE_OFF, None)
        disarm = script.ask(Disarm())
        assert reaction(script, disarm, lambda s: s.feed(self.QUIT)) == Reaction(
            State.GROUNDED, Control.NONE, [CommandKind.HOLD], "aborted OPERATOR_LOST"
        )
        assert reaction(script, disarm, lambda s: s.wait(1.1)).sent == [CommandKind.HOLD]

    def test_but_not_of_a_vehicle_that_is_disarmed(self) -> None:
        script = Script(policy("default"))
        take_off(script)
        script.answer(CommandKind.TAKE_OFF, None)
        script.heartbeat(armed=False)
        arm = script.ask(Arm())
        assert reaction(script, arm, lambda s: s.feed(self.QUIT)) == Reaction(
            State.GROUNDED, Control.NONE, [], "aborted OPERATOR_LOST"
        )

    @pytest.mark.parametrize("state", [State.MOVING, State.FLYING_MISSION])
    def test_with_an_old_position_it_is_held_and_streams_no_more(self, state: State) -> None:
        script, request_id = flight(state)
        script.reports_position = False
        script.wait(1.1)
        assert reaction(script, request_id, lambda s: s.feed(self.QUIT)) == Reaction(
            State.STALE, Control.OURS, [CommandKind.HOLD], "aborted OPERATOR_LOST"
        )
        assert not streams(script)
        script.reports_position = True
        script.tick()
        assert state_of(script) is State.HOLDING

    def test_what_stands_with_an_old_position_is_left_alone(self) -> None:
        script, request_id = flight(State.GROUNDED)
        script.reports_position = False
        script.wait(1.2)
        assert reaction(script, request_id, lambda s: s.feed(self.QUIT)) == Reaction(
            State.STALE, Control.NONE, [], "aborted OPERATOR_LOST"
        )

    @pytest.mark.parametrize("state", [State.HOLDING, State.NO_VEHICLE])
    def test_a_hold_goes_on_until_it_is_shown(self, state: State) -> None:
        script, request_id = flight(state)
        control = script.gate.control
        assert reaction(script, request_id, lambda s: s.feed(self.QUIT)) == Reaction(
            state, control, [], ""
        )
        assert reaction(script, request_id, lambda s: s.wait(1.1)).sent == [CommandKind.HOLD]

    def test_what_somebody_else_flies_is_left_alone_and_nothing_is_left_open(self) -> None:
        """The station does not wait for what it does not fly."""
        script, request_id = flight(State.EXTERNAL)
        assert reaction(script, request_id, lambda s: s.feed(self.QUIT)) == Reaction(
            State.EXTERNAL, Control.NONE, [], "aborted OPERATOR_LOST"
        )

    @pytest.mark.parametrize("mode", [FlightMode.RETURN, FlightMode.LAND])
    def test_so_is_a_return_or_a_landing_of_the_vehicles_own(self, mode: FlightMode) -> None:
        script = Script(policy("default")).fly(UP)
        script.heartbeat(mode)
        state = state_of(script)
        assert reaction(script, 0, lambda s: s.feed(self.QUIT)) == Reaction(
            state, Control.NONE, [], ""
        )

    @pytest.mark.parametrize("severity", UNSAFE)
    @pytest.mark.parametrize("state", COMING_DOWN)
    def test_and_one_of_ours(self, state: State, severity: Severity) -> None:
        """newcomer.md 8: leaving a return put the vehicle into hold."""
        if state is State.RETURNING and severity not in (Severity.HOLD, Severity.RETURN):
            return
        script, request_id, raised = at_severity(state, severity)
        script.feed(raised)
        assert reaction(script, request_id, lambda s: s.feed(self.QUIT)) == Reaction(
            state, Control.OURS, [], "aborted OPERATOR_LOST"
        )

    def test_landing_can_still_be_asked_for_and_is_flown_to_its_end(self) -> None:
        script, _ = flight(State.MOVING)
        script.feed(self.QUIT)
        land = script.ask(Land())
        assert state_of(script) is State.LANDING
        assert ended(script, land) == ""
