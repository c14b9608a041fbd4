"""Returns, clear and blocked, and disarming in the air, from each state that flies."""

from __future__ import annotations

import pytest

from gcs.gate.effects import CommandKind, Ruling
from gcs.gate.inputs import (
    OperatorLost,
    ReturnHeightSeen,
)
from gcs.gate.refusal import Code
from gcs.gate.requests import (
    Disarm,
    ReturnHome,
)
from gcs.gate.states import Control, FlightMode, State
from tests.unit.gate.reactions import (
    AIRBORNE,
    Reaction,
    flight,
    follows_setpoints,
    reaction,
    state_of,
    streams,
    take_off,
)
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import lead_to

BLOCKED = [state for state in AIRBORNE if state is not State.LANDING]


class TestReturn:
    @pytest.mark.parametrize("state", AIRBORNE)
    def test_a_clear_one_is_commanded_and_takes_the_place_of_what_was_under_way(
        self, state: State
    ) -> None:
        script, request_id = flight(state)
        followed = follows_setpoints(script)
        assert reaction(script, request_id, lambda s: s.ask(ReturnHome())) == Reaction(
            State.RETURNING, Control.OURS, [CommandKind.RETURN], "superseded SUPERSEDED"
        )
        assert streams(script) is followed, "held in its place until it shows the mode"
        script.heartbeat(FlightMode.RETURN)
        assert not streams(script)

    def blocked(self, state: State, rtl_blocked: str) -> tuple[Script, int]:
        script, request_id = flight(state, rtl_blocked=rtl_blocked)
        script.feed(ReturnHeightSeen(80.0))
        return script, request_id

    @pytest.mark.parametrize("state", BLOCKED)
    def test_a_blocked_one_holds_at_once(self, state: State) -> None:
        script, request_id = self.blocked(state, "hold")
        assert reaction(script, request_id, lambda s: s.ask(ReturnHome())) == Reaction(
            State.HOLDING, Control.OURS, [CommandKind.HOLD], "aborted OPERATOR"
        )
        assert script.refusal(script._next_id) is Code.RTL_BLOCKED

    @pytest.mark.parametrize("state", BLOCKED)
    def test_or_lands_where_the_policy_says_so(self, state: State) -> None:
        script, request_id = self.blocked(state, "land")
        assert reaction(script, request_id, lambda s: s.ask(ReturnHome())) == Reaction(
            State.LANDING, Control.OURS, [CommandKind.LAND], "aborted OPERATOR"
        )
        assert script.refusal(script._next_id) is Code.RTL_BLOCKED

    @pytest.mark.parametrize("state", AIRBORNE)
    def test_or_is_forwarded_where_the_policy_says_so(self, state: State) -> None:
        script, request_id = self.blocked(state, "forward")
        assert reaction(script, request_id, lambda s: s.ask(ReturnHome())) == Reaction(
            State.RETURNING, Control.OURS, [CommandKind.RETURN], "superseded SUPERSEDED"
        )
        assert script.verdict(script._next_id).ruling is Ruling.ACCEPTED

    @pytest.mark.parametrize("rtl_blocked", ["hold", "land"])
    def test_a_landing_goes_on_where_the_return_is_blocked(self, rtl_blocked: str) -> None:
        script, request_id = self.blocked(State.LANDING, rtl_blocked)
        assert reaction(script, request_id, lambda s: s.ask(ReturnHome())) == Reaction(
            State.LANDING, Control.OURS, [], ""
        )
        assert script.refusal(script._next_id) is Code.RTL_BLOCKED

    @pytest.mark.parametrize("state", [State.MOVING, State.FLYING_MISSION])
    def test_with_a_position_too_old_it_is_blocked_and_holds(self, state: State) -> None:
        script, request_id = flight(state)
        script.reports_position = False
        script.wait(1.1)
        assert reaction(script, request_id, lambda s: s.ask(ReturnHome())) == Reaction(
            State.STALE, Control.OURS, [CommandKind.HOLD], "aborted OPERATOR"
        )
        assert script.refusal(script._next_id) is Code.RTL_BLOCKED
        assert not streams(script)
        script.reports_position = True
        script.tick()
        assert state_of(script) is State.HOLDING


class TestDisarmInTheAir:
    @pytest.mark.parametrize("state", [*AIRBORNE, State.STALE])
    def test_it_is_refused(self, state: State) -> None:
        script, request_id = flight(state)
        for force in (False, True):
            before = script.gate.memory
            asked = script.ask(Disarm(force=force))
            permitted = state is State.EXTERNAL
            if force and permitted:
                continue
            assert script.refusal(asked) is (Code.POLICY if force else Code.IN_AIR)
            assert script.gate.memory == before
        assert not script.ended(request_id) or state is State.EXTERNAL

    @pytest.mark.parametrize("state", [*AIRBORNE, State.STALE])
    def test_forced_it_needs_the_policy_and_a_second_request(self, state: State) -> None:
        script, request_id = flight(state, allow_force_disarm=True)
        if state is State.EXTERNAL:
            script.wait(6.0)
        control = script.gate.control
        first = reaction(script, request_id, lambda s: s.ask(Disarm(force=True)))
        assert first[1:3] == (control, [])
        assert script.refusal(script._next_id) is Code.IN_AIR
        second = reaction(script, request_id, lambda s: s.ask(Disarm(force=True)))
        assert second[:3] == (State.EXTERNAL, Control.NONE, [CommandKind.FORCE_DISARM])
        if state is not State.EXTERNAL:
            assert second.ended == "superseded SUPERSEDED"
        assert not streams(script)
        script.position()
        if state is not State.STALE:
            assert state_of(script) is State.EXTERNAL

    @pytest.mark.parametrize("state", AIRBORNE)
    def test_without_an_operator_no_motor_is_stopped_in_the_air(self, state: State) -> None:
        script, _ = flight(state, allow_force_disarm=True)
        if state is State.EXTERNAL:
            script.wait(6.0)
        script.ask(Disarm(force=True))
        script.feed(OperatorLost("quit"))
        assert script.refusal(script.ask(Disarm(force=True))) is Code.OPERATOR_LOST

    @pytest.mark.parametrize("force", [False, True])
    def test_on_the_ground_a_take_off_is_disarmed(self, force: bool) -> None:
        script = Script(policy("default"))
        request_id = take_off(script)
        assert reaction(script, request_id, lambda s: s.ask(Disarm(force=force))) == Reaction(
            State.GROUNDED, Control.NONE, [CommandKind.DISARM], "superseded SUPERSEDED"
        )

    def test_without_an_operator_it_is_disarmed_on_the_ground_all_the_same(self) -> None:
        script = Script(policy("default"))
        lead_to(State.GROUNDED, script)
        script.feed(OperatorLost("quit"))
        for force in (False, True):
            assert script.verdict(script.ask(Disarm(force=force))).ruling is Ruling.ACCEPTED
