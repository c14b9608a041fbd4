"""What the gate does by itself: old positions, breaches, jumps, severity, a lost operator."""

from __future__ import annotations

import pytest
from msgspec.structs import replace

from gcs.frames import enu_from_ned
from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import CancelCommand, CommandKind, OutcomeKind, Ruling, Say, SendSetpoint
from gcs.gate.inputs import (
    ConditionChanged,
    HeartbeatSeen,
    Input,
    OperatorLost,
    PositionSeen,
    ReturnHeightSeen,
    Tick,
)
from gcs.gate.machine.gate import Gate
from gcs.gate.refusal import Code
from gcs.gate.requests import Abort, Arm, Disarm, Land, Request, ReturnHome, TakeOff
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.script import MS, SECOND, Script, policy
from tests.unit.gate.situations import UP, lead_to

FLOWN = [
    State.TAKING_OFF,
    State.HOVERING,
    State.MOVING,
    State.TAKING_PICTURE,
    State.FLYING_MISSION,
    State.RETURNING,
    State.LANDING,
]
HELD_WHEN_LEFT = FLOWN[:5]


def in_state(state: State, **severities: Severity) -> Script:
    rules = policy("default")
    chosen = {Condition(name): severity for name, severity in severities.items()}
    script = Script(replace(rules, severities={**rules.severities, **chosen}))
    lead_to(state, script)
    if state is State.TAKING_OFF:
        script.land_state(LandedState.IN_AIR)
        script.at(0.0, 0.0, 1.0)
    assert script.gate.state is state
    script.forget()
    return script


class TestStale:
    def test_the_verified_stream_goes_on_for_the_grace_then_hold_then_silence(self) -> None:
        script = in_state(State.MOVING)
        script.reports_position = False
        start_ns = script.now_ns
        script.wait(4.0)
        last_ns = max(now_ns for now_ns, _ in script.setpoints())
        grace_ns = round((script.policy.position_age_s + script.policy.stale_grace_s) * SECOND)
        assert abs(last_ns - start_ns - grace_ns) <= 100 * MS
        assert script.commands()[0] is CommandKind.HOLD
        assert script.gate.state is State.STALE

    def test_a_position_within_the_grace_goes_on_as_before(self) -> None:
        script = in_state(State.MOVING)
        script.reports_position = False
        script.wait(1.2)
        assert script.states() == [State.STALE]
        script.reports_position = True
        script.tick()
        assert script.states() == [State.STALE, State.MOVING]

    def test_a_position_after_the_grace_finds_the_vehicle_held(self) -> None:
        script = in_state(State.MOVING)
        script.reports_position = False
        script.wait(2.0)
        script.reports_position = True
        script.tick()
        assert script.gate.state is State.HOLDING

    def test_a_landing_needs_no_position_of_ours(self) -> None:
        script = in_state(State.LANDING)
        script.reports_position = False
        script.wait(3.0)
        assert script.gate.state is State.LANDING
        assert not script.commands()

    def test_a_pending_goal_is_refused_when_the_position_is_too_old_at_the_tick(self) -> None:
        script = in_state(State.HOVERING)
        script.reports_position = False
        script.wait(1.0)
        requested = script.goto(3.0, 0.0, UP)
        script.tick()
        assert script.refusal(requested) is Code.STALE

    def test_a_sample_that_is_no_number_or_older_than_the_last_does_not_count(self) -> None:
        script = in_state(State.HOVERING)
        script.reports_position = False
        script.feed(PositionSeen((float("nan"), 0.0, 0.0), (0.0, 0.0, 0.0), script.now_ns // MS))
        script.feed(PositionSeen((9.0, 0.0, 0.0), (0.0, 0.0, 0.0), 1))
        assert script.gate.pos_ned == (0.0, 0.0, -UP)

    def test_no_heartbeat_is_no_vehicle_and_one_that_returns_is_somebody_elses(self) -> None:
        script = in_state(State.MOVING)
        script.reports_heartbeat = script.reports_position = False
        script.wait(5.0)
        assert script.states()[-1] is State.NO_VEHICLE
        assert script.gate.control is Control.NONE
        script.heartbeat(FlightMode.GUIDED)
        script.land_state(LandedState.IN_AIR)
        script.position()
        assert script.gate.state is State.EXTERNAL

    def test_abort_is_sent_even_to_a_vehicle_that_is_not_heard_any_more(self) -> None:
        script = in_state(State.MOVING)
        script.reports_heartbeat = script.reports_position = False
        script.wait(5.0)
        script.forget()
        abort = script.ask(Abort())
        assert script.commands() == [CommandKind.HOLD]
        script.wait(6.0)
        assert script.outcome(abort).kind is OutcomeKind.TIMED_OUT


class TestBreach:
    def dash(self, script: Script) -> PositionSeen:
        """Ten metres from the fence, at twelve metres a second towards it."""
        sample = PositionSeen((140.0, 0.0, -UP), (12.0, 0.0, 0.0), script.now_ns // MS + 5_000)
        script.now_ns += 5 * SECOND
        script.feed(HeartbeatSeen(True, script.mode, script.mode.value))
        return sample

    @pytest.mark.parametrize(
        "state", [s for s in FLOWN if s is not State.LANDING], ids=lambda s: s.name
    )
    def test_the_brake_leaves_in_the_instant_of_the_sample_and_then_hold(
        self, state: State
    ) -> None:
        """Where it follows setpoints those stop it sooner, in 0.3 s + 12 / 5 s; then it is held."""
        script, by_setpoints = (
            in_state(state),
            state
            in (
                State.HOVERING,
                State.MOVING,
                State.TAKING_PICTURE,
            ),
        )
        sample = self.dash(script)
        script.forget()
        script.feed(sample)
        (brake,) = script.all(SendSetpoint)
        assert brake.permit.pos_ned is not None
        assert brake.permit.reason.startswith("brake")
        assert script.commands() == ([] if by_setpoints else [CommandKind.HOLD])
        assert script.gate.state is State.HOLDING
        east, north, _ = enu_from_ned(brake.permit.pos_ned)
        assert (east * east + north * north) ** 0.5 < 150.0
        script.pos_ned = (148.0, 0.0, -UP)
        script.wait(2.65)
        assert (CommandKind.HOLD in script.commands()) is not by_setpoints
        script.wait(0.1)
        assert CommandKind.HOLD in script.commands()

    def test_the_goal_ends_with_the_breach_named(self) -> None:
        script = in_state(State.HOVERING)
        requested = script.goto(3.0, 0.0, UP)
        script.tick()
        script.feed(self.dash(script))
        outcome = script.outcome(requested)
        assert (outcome.kind, outcome.code) == (OutcomeKind.ABORTED, Code.FENCE_BREACH)
        assert "home" in outcome.sentence

    def test_what_somebody_else_flies_is_not_braked(self) -> None:
        script = in_state(State.EXTERNAL)
        script.feed(self.dash(script))
        assert script.gate.state is State.EXTERNAL
        assert not script.commands()


class TestJump:
    def test_a_jump_holds_and_is_verified_anew(self) -> None:
        script = in_state(State.HOVERING)
        requested = script.goto(3.0, 0.0, UP)
        script.tick()
        script.feed(PositionSeen((20.0, 0.0, -UP), (0.0, 0.0, 0.0), script.now_ns // MS))
        assert script.outcome(requested).code is Code.ESTIMATOR_RESET
        assert script.gate.state is State.HOLDING
        assert script.gate.hold_goal_ned == (20.0, 0.0, -UP)

    def test_a_reset_counter_says_the_same(self) -> None:
        script = in_state(State.HOVERING)
        script.feed(PositionSeen((0.0, 0.0, -UP), (0.0, 0.0, 0.0), 0, reset=True))
        assert script.gate.state is State.HOLDING


class TestSeverity:
    def raised(self, state: State, severity: Severity) -> Script:
        script = in_state(state, battery_low=severity)
        script.feed(ConditionChanged(Condition.BATTERY_LOW, True, "20 %"))
        return script

    @pytest.mark.parametrize("state", [State.HOVERING, State.MOVING, State.TAKING_PICTURE])
    @pytest.mark.parametrize(
        ("severity", "after", "command"),
        [
            (Severity.HOLD, State.HOLDING, CommandKind.HOLD),
            (Severity.RETURN, State.RETURNING, CommandKind.RETURN),
            (Severity.LAND, State.LANDING, CommandKind.LAND),
            (Severity.TERMINATE, State.LANDING, CommandKind.LAND),
        ],
    )
    def test_the_worst_condition_acts_where_we_have_control(
        self, state: State, severity: Severity, after: State, command: CommandKind
    ) -> None:
        script = self.raised(state, severity)
        assert script.gate.severity is severity
        assert script.gate.state is after
        assert script.commands() == [command]

    @pytest.mark.parametrize("severity", list(Severity)[1:])
    def test_where_somebody_else_flies_nothing_is_sent(self, severity: Severity) -> None:
        script = self.raised(State.EXTERNAL, severity)
        assert script.gate.state is State.EXTERNAL
        assert not script.commands()

    def test_caution_changes_nothing(self) -> None:
        script = self.raised(State.MOVING, Severity.CAUTION)
        assert script.gate.state is State.MOVING

    def test_a_return_that_is_blocked_is_a_hold(self) -> None:
        script = in_state(State.MOVING, battery_low=Severity.RETURN)
        script.feed(ReturnHeightSeen(80.0))
        script.feed(ConditionChanged(Condition.BATTERY_LOW, True))
        assert script.gate.state is State.HOLDING

    def test_motion_is_refused_until_it_is_over(self) -> None:
        script = in_state(State.GROUNDED, battery_low=Severity.HOLD)
        script.feed(ConditionChanged(Condition.BATTERY_LOW, True))
        assert script.refusal(script.ask(TakeOff(2.0))) is Code.SEVERITY
        script.feed(ConditionChanged(Condition.BATTERY_LOW, False))
        assert script.verdict(script.ask(TakeOff(2.0))).ruling is Ruling.ACCEPTED

    def test_of_two_conditions_the_worst_wins(self) -> None:
        script = in_state(State.HOVERING, battery_low=Severity.CAUTION, other_station=Severity.HOLD)
        script.feed(ConditionChanged(Condition.OTHER_STATION, True))
        script.feed(ConditionChanged(Condition.BATTERY_LOW, True))
        assert script.gate.severity is Severity.HOLD
        assert script.gate.conditions == (Condition.BATTERY_LOW, Condition.OTHER_STATION)

    def test_arming_wants_a_recorder_where_the_policy_does(self) -> None:
        script = Script(replace(policy("default"), arm_requires_recording=True)).connect()
        script.feed(ConditionChanged(Condition.RECORDER_FAILED, True))
        assert script.refusal(script.ask(Arm())) is Code.RECORDER_DOWN


class TestOperatorLost:
    @pytest.mark.parametrize("state", HELD_WHEN_LEFT, ids=lambda s: s.name)
    def test_what_we_fly_is_held_and_then_may_be_left(self, state: State) -> None:
        script = in_state(state)
        script.feed(OperatorLost("quit"))
        assert script.gate.state is State.HOLDING
        assert script.commands() == [CommandKind.HOLD]
        assert not script.gate.settled
        script.heartbeat(FlightMode.HOLD)
        assert script.gate.settled

    @pytest.mark.parametrize("state", [State.EXTERNAL, State.GROUNDED], ids=lambda s: s.name)
    def test_what_we_do_not_fly_is_left_at_once(self, state: State) -> None:
        script = in_state(state)
        script.feed(OperatorLost("quit"))
        assert not script.commands()
        assert script.gate.settled

    @pytest.mark.parametrize("state", [State.RETURNING, State.LANDING], ids=lambda s: s.name)
    def test_what_comes_down_goes_on_and_may_be_left(self, state: State) -> None:
        """newcomer.md 8: leaving a return put the vehicle into hold."""
        script = in_state(state)
        script.feed(OperatorLost("quit"))
        assert script.gate.state is state
        assert script.commands() == []
        assert script.gate.settled

    @pytest.mark.parametrize("request_", [ReturnHome(), Land()])
    def test_a_return_that_is_not_shown_yet_is_asked_for_on(self, request_: Request) -> None:
        script = in_state(State.HOVERING)
        requested = script.ask(request_)
        script.forget()
        script.feed(OperatorLost("quit"))
        assert script.outcome(requested).code is Code.OPERATOR_LOST
        assert script.outcome(requested).sentence.endswith("the vehicle goes on by itself")
        assert script.all(CancelCommand) == []
        assert not script.gate.settled

    def test_a_landing_that_severity_demands_goes_on(self) -> None:
        script = in_state(State.HOVERING, battery_critical=Severity.LAND)
        script.feed(ConditionChanged(Condition.BATTERY_CRITICAL, True))
        script.feed(OperatorLost("the terminal is gone"))
        assert script.gate.state is State.LANDING

    def test_arming_is_not_tried_on_without_an_operator(self) -> None:
        script = Script(policy("default")).connect()
        requested = script.ask(Arm())
        script.feed(OperatorLost("quit"))
        assert script.outcome(requested).code is Code.OPERATOR_LOST
        assert CancelCommand(requested, CommandKind.ARM) in script.all(CancelCommand)

    def test_an_arming_that_is_not_answered_is_not_left_open_where_the_vehicle_flies(self) -> None:
        script = Script(policy("default")).connect()
        script.heartbeat(FlightMode.GUIDED)
        requested = script.ask(Arm())
        script.land_state(LandedState.IN_AIR)
        script.heartbeat(FlightMode.HOLD)
        assert (script.gate.state, script.ended(requested)) == (State.HOLDING, False)
        script.feed(OperatorLost("quit"))
        assert script.outcome(requested).code is Code.OPERATOR_LOST
        assert script.gate.settled

    def test_nor_is_a_disarming_without_a_position(self) -> None:
        script = Script(policy("default")).connect()
        script.heartbeat(armed=True)
        script.reports_position = False
        script.wait(1.5)
        requested = script.ask(Disarm())
        script.wait(1.0)
        assert (script.gate.state, script.ended(requested)) == (State.STALE, False)
        script.feed(OperatorLost("quit"))
        assert script.outcome(requested).code is Code.OPERATOR_LOST


def test_without_a_verifier_nothing_that_moves_is_accepted() -> None:
    gate = Gate(policy("default"), "px4", 0)
    script = Script(policy("default"))
    script.gate = gate
    script.heartbeat(FlightMode.GUIDED, armed=True)
    script.land_state(LandedState.ON_GROUND)
    script.position()
    assert script.refusal(script.ask(TakeOff(2.0))) is Code.NO_ORIGIN


def test_the_deadline_is_the_next_thing_due_and_asking_changes_nothing() -> None:
    script = in_state(State.MOVING)
    before = script.gate.memory
    due_ns = script.gate.deadline_ns
    assert due_ns is not None
    assert due_ns == script.now_ns + round(script.policy.position_age_s * SECOND)
    assert script.gate.memory == before


@pytest.mark.parametrize("given", [Tick(0), OperatorLost("quit")], ids=["tick", "lost"])
def test_nobody_heard_nothing_sent(given: Input) -> None:
    effects = Gate(policy("default"), "", 0).handle(given, 1)
    assert all(isinstance(effect, Say) for effect in effects)
