"""Sentences of the design, each flown: forced disarm, failsafes, returns, missions, refused holds.

What is expected here stands in the design's chapter on the gate, not in the table.
"""

from __future__ import annotations

from dataclasses import replace

import pytest
from msgspec import structs

from gcs.gate.airspace.verifier import verifier_for
from gcs.gate.airspace.zones import Zone
from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import CommandKind, OutcomeKind, Ruling, SendSetpoint
from gcs.gate.geometry import Circle
from gcs.gate.inputs import (
    ConditionChanged,
    MissionLoaded,
    OperatorLost,
    PositionSeen,
    Requested,
    ReturnHeightSeen,
    VerifierChanged,
)
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code
from gcs.gate.requests import (
    Abort,
    Disarm,
    Hold,
    ReturnHome,
    StartMission,
    SwitchFence,
    TakeControl,
)
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.script import MS, Script, policy
from tests.unit.gate.situations import UP, lead_to

FLOWN = [
    State.STALE,
    State.TAKING_OFF,
    State.HOVERING,
    State.MOVING,
    State.TAKING_PICTURE,
    State.FLYING_MISSION,
    State.RETURNING,
    State.LANDING,
    State.HOLDING,
    State.EXTERNAL,
]


def in_flight(state: State, rules: Policy | None = None) -> Script:
    """In `state`, and reported in the air."""
    script = Script(rules or policy("default"))
    lead_to(state, script)
    if state is State.TAKING_OFF:
        script.land_state(LandedState.IN_AIR)
    assert script.gate.state is state
    assert script.gate.memory.airborne
    script.forget()
    return script


class TestForcedDisarm:
    """Force-disarm in the air needs policy permission and a second, explicit request."""

    def script(self, state: State = State.HOVERING) -> Script:
        return in_flight(state, structs.replace(policy("default"), allow_force_disarm=True))

    @pytest.mark.parametrize("state", FLOWN, ids=lambda s: s.name)
    def test_the_first_request_is_refused_and_the_motors_keep_turning(self, state: State) -> None:
        script = self.script(state)
        first = script.ask(Disarm(force=True))
        assert script.refusal(first) is Code.IN_AIR
        assert CommandKind.FORCE_DISARM not in script.commands()
        assert script.gate.state is state

    @pytest.mark.parametrize("state", FLOWN, ids=lambda s: s.name)
    def test_the_second_request_is_accepted(self, state: State) -> None:
        script = self.script(state)
        script.ask(Disarm(force=True))
        second = script.ask(Disarm(force=True))
        assert script.verdict(second).ruling is Ruling.ACCEPTED
        assert script.commands() == [CommandKind.FORCE_DISARM]
        script.heartbeat(armed=False)
        assert script.outcome(second).kind is OutcomeKind.COMPLETE

    def test_it_may_come_within_five_seconds(self) -> None:
        script = self.script()
        script.ask(Disarm(force=True))
        script.wait(4.9)
        assert script.verdict(script.ask(Disarm(force=True))).ruling is Ruling.ACCEPTED

    def test_one_that_comes_later_is_a_first_request_again(self) -> None:
        script = self.script()
        script.ask(Disarm(force=True))
        script.wait(5.1)
        assert script.refusal(script.ask(Disarm(force=True))) is Code.IN_AIR
        assert CommandKind.FORCE_DISARM not in script.commands()
        script.wait(4.9)
        assert script.verdict(script.ask(Disarm(force=True))).ruling is Ruling.ACCEPTED

    def test_a_disarm_without_force_is_no_first_request(self) -> None:
        script = self.script()
        assert script.refusal(script.ask(Disarm())) is Code.IN_AIR
        assert script.refusal(script.ask(Disarm(force=True))) is Code.IN_AIR
        assert CommandKind.FORCE_DISARM not in script.commands()

    def test_without_permission_no_number_of_requests_is_enough(self) -> None:
        script = in_flight(State.HOVERING)
        for _ in range(3):
            assert script.refusal(script.ask(Disarm(force=True))) is Code.POLICY
        assert not script.commands()


class TestBreachWhileTakingControl:
    """Invariant 6 begins with the first setpoint, not with the confirmation of control."""

    def test_a_vehicle_that_rushes_for_the_fence_is_braked_and_held(self) -> None:
        script = in_flight(State.EXTERNAL)
        script.at(130.0, 0.0, UP)
        control = script.ask(TakeControl())
        script.wait(0.3)
        assert (script.gate.state, script.gate.control) == (State.HOVERING, Control.TAKING)
        script.forget()
        script.now_ns += 500 * MS
        script.feed(PositionSeen((0.0, 142.0, -UP), (0.0, 12.0, 0.0), script.now_ns // MS))
        (brake,) = script.all(SendSetpoint)
        assert brake.permit.reason.startswith("brake")
        assert brake.permit.pos_ned is not None
        assert brake.permit.pos_ned[1] < 150.0
        assert script.commands() == [CommandKind.HOLD]
        assert script.gate.state is State.HOLDING
        assert script.outcome(control).code is Code.FENCE_BREACH


class TestSeverityWhileStale:
    """What a severity demands is done as soon as a fresh position allows it."""

    @pytest.mark.parametrize("seconds", [0.1, 2.0], ids=["in the grace", "after the grace"])
    def test_a_return_that_was_due_is_flown_when_the_position_is_back(self, seconds: float) -> None:
        script = in_flight(State.MOVING)
        script.reports_position = False
        script.wait(script.policy.position_age_s + seconds)
        assert script.states() == [State.STALE]
        script.feed(ConditionChanged(Condition.BATTERY_CRITICAL, True, "5 %"))
        assert script.gate.severity is Severity.RETURN
        assert CommandKind.RETURN not in script.commands()
        script.reports_position = True
        script.tick()
        assert script.gate.state is State.RETURNING
        assert script.commands()[-1] is CommandKind.RETURN

    def test_a_condition_that_is_over_by_then_demands_nothing(self) -> None:
        script = in_flight(State.MOVING)
        script.reports_position = False
        script.wait(script.policy.position_age_s + 0.1)
        script.feed(ConditionChanged(Condition.BATTERY_CRITICAL, True, "5 %"))
        script.feed(ConditionChanged(Condition.BATTERY_CRITICAL, False))
        script.reports_position = True
        script.tick()
        assert script.gate.state is State.HOLDING
        assert CommandKind.RETURN not in script.commands()


class TestDescentAtHome:
    """The whole way home is judged, its descent too."""

    def script(self, ceiling_up_m: float) -> Script:
        """Hovering 20 m east of home, where an exclusion zone hangs between 5 m and a ceiling."""
        script = in_flight(State.HOVERING)
        fence = verifier_for(script.policy, "px4", (0.0, 0.0, 0.0), None)
        net = Zone("net", False, Circle((0.0, 0.0), 4.0), 5.0, ceiling_up_m)
        script.feed(VerifierChanged(replace(fence, zones=(*fence.zones, net))))
        script.feed(ReturnHeightSeen(10.0))
        script.goto(20.0, 0.0, UP)
        script.wait(0.1)
        script.at(20.0, 0.0, UP)
        script.wait(1.0)
        assert script.gate.state is State.HOVERING
        script.forget()
        return script

    def test_one_that_leads_through_a_zone_blocks_the_return_and_names_it(self) -> None:
        script = self.script(8.0)
        refusal = script.verdict(script.ask(ReturnHome())).refusal
        assert refusal is not None
        assert (refusal.code, refusal.zone) == (Code.RTL_BLOCKED, "net")
        assert "the descent at home" in refusal.sentence
        assert "land instead" in refusal.sentence
        assert script.gate.state is State.HOLDING
        assert script.commands() == [CommandKind.HOLD]

    def test_severity_finds_it_blocked_too(self) -> None:
        script = self.script(8.0)
        script.feed(ConditionChanged(Condition.BATTERY_CRITICAL, True, "5 %"))
        assert script.gate.state is State.HOLDING
        assert script.commands() == [CommandKind.HOLD]


class TestMissionWithoutFence:
    """Unknown never permits more than known: no mission starts while the fence is not known."""

    def test_none_starts_on_the_ground(self) -> None:
        script = Script(policy("default"))
        script.heartbeat(FlightMode.HOLD, armed=True)
        script.land_state(LandedState.ON_GROUND)
        script.position()
        script.feed(MissionLoaded("square", 4))
        script.forget()
        assert script.refusal(script.ask(StartMission())) is Code.NO_ORIGIN
        assert not script.commands()
        assert script.gate.state is State.GROUNDED

    def test_none_starts_in_flight_between_the_switch_of_the_fence_and_the_new_one(self) -> None:
        script = Script(policy("lab")).take_control(UP)
        script.feed(MissionLoaded("square", 4))
        script.forget()
        script.gate.handle(Requested(99, "keyboard", SwitchFence(on=True)), script.now_ns)
        assert script.refusal(script.ask(StartMission())) is Code.NO_ORIGIN
        assert not script.commands()
        assert script.gate.state is State.HOVERING


class TestRefusedHold:
    """Every accepted request has exactly one outcome; the hold of the gate itself goes on."""

    def expect_refused(self, script: Script, requested: int) -> None:
        script.answer(CommandKind.HOLD, 2, "not now")
        outcome = script.outcome(requested)
        assert (outcome.kind, outcome.code) == (OutcomeKind.ABORTED, Code.VEHICLE_REFUSED)
        assert outcome.sentence == "the vehicle refused hold mode (DENIED): not now"

    @pytest.mark.parametrize("wanted", [Hold(), Abort()], ids=["hold", "abort"])
    @pytest.mark.parametrize("state", [State.MOVING, State.EXTERNAL], ids=lambda s: s.name)
    def test_it_ends_in_holding(self, state: State, wanted: Hold | Abort) -> None:
        script = in_flight(state)
        requested = script.ask(wanted)
        self.expect_refused(script, requested)
        assert script.gate.state is State.HOLDING

    @pytest.mark.parametrize("wanted", [Hold(), Abort()], ids=["hold", "abort"])
    def test_it_ends_while_the_position_is_too_old(self, wanted: Hold | Abort) -> None:
        script = in_flight(State.STALE)
        requested = script.ask(wanted)
        self.expect_refused(script, requested)
        assert script.gate.state is State.STALE

    def test_it_ends_on_the_ground_where_a_take_off_may_come_late(self) -> None:
        script = Script(policy("default"))
        lead_to(State.TAKING_OFF, script)
        script.answer(CommandKind.TAKE_OFF, None)
        assert script.gate.state is State.GROUNDED
        requested = script.ask(Hold())
        self.expect_refused(script, requested)
        assert script.gate.state is State.GROUNDED

    def test_it_ends_where_the_vehicle_is_not_heard_any_more(self) -> None:
        script = in_flight(State.MOVING)
        script.reports_heartbeat = script.reports_position = False
        script.wait(5.0)
        assert script.gate.state is State.NO_VEHICLE
        requested = script.ask(Abort())
        self.expect_refused(script, requested)

    @pytest.mark.parametrize("wanted", [Hold(), Abort()], ids=["hold", "abort"])
    @pytest.mark.parametrize("state", [State.MOVING, State.STALE], ids=lambda s: s.name)
    def test_it_goes_on_being_commanded_at_1_hz_though_its_request_has_ended(
        self, state: State, wanted: Hold | Abort
    ) -> None:
        script = in_flight(state)
        self.expect_refused(script, script.ask(wanted))
        before = len(script.commands())
        for count in (1, 2, 3):
            script.wait(1.1)
            assert script.commands()[before:] == [CommandKind.HOLD] * count
            script.answer(CommandKind.HOLD, 2, "not now")

    def test_it_ends_once_the_heartbeat_shows_hold(self) -> None:
        script = in_flight(State.MOVING)
        self.expect_refused(script, script.ask(Hold()))
        script.wait(1.1)
        script.heartbeat(FlightMode.HOLD)
        script.heartbeat(FlightMode.HOLD)
        before = len(script.commands())
        script.wait(5.0)
        assert script.commands()[before:] == []

    def test_the_gates_own_hold_is_commanded_at_1_hz_whatever_the_answer(self) -> None:
        script = in_flight(State.MOVING)
        script.feed(OperatorLost("quit"))
        for count in (1, 2, 3):
            assert script.commands() == [CommandKind.HOLD] * count
            script.answer(CommandKind.HOLD, 2)
            script.wait(1.0)
        script.heartbeat(FlightMode.HOLD)
        script.forget()
        script.wait(3.0)
        assert not script.commands()
