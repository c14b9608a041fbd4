"""Armed, disarmed, airborne and landed, as reported, in each state."""

from __future__ import annotations

import pytest

from gcs.gate.condition import Condition
from gcs.gate.effects import CommandKind
from gcs.gate.inputs import (
    ConditionChanged,
    MissionLoaded,
)
from gcs.gate.requests import Abort, Disarm, Hold, Land, Request, ReturnHome, StartMission
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.reactions import (
    FLIGHT,
    GUIDED_STATES,
    HELD,
    Reaction,
    ended,
    flight,
    reaction,
    remember,
    state_of,
    streams,
    take_off,
)
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import UP, lead_to


class TestArmedAndDisarmed:
    def test_arming_is_complete_when_it_is_shown(self) -> None:
        script, request_id = flight(State.GROUNDED)
        assert reaction(script, request_id, lambda s: s.heartbeat(armed=True)) == Reaction(
            State.GROUNDED, Control.NONE, [], "complete"
        )

    def test_being_armed_by_somebody_completes_no_disarm(self) -> None:
        script = Script(policy("default"))
        lead_to(State.GROUNDED, script)
        script.heartbeat(armed=False)
        script.ask(Abort())
        script.heartbeat(armed=True)
        disarm = script.ask(Disarm())
        script.heartbeat(armed=True)
        assert ended(script, disarm) == ""

    @pytest.mark.parametrize("state", [*FLIGHT, State.HOLDING])
    def test_being_armed_in_flight_changes_nothing(self, state: State) -> None:
        script, request_id = flight(state)
        control = script.gate.control
        remember(script, armed=False)
        assert reaction(script, request_id, lambda s: s.heartbeat(armed=True)) == Reaction(
            state, control, [], ""
        )

    COMES_DOWN = (State.RETURNING, State.LANDING, State.FLYING_MISSION, State.EXTERNAL)

    @pytest.mark.parametrize("state", [*FLIGHT, State.HOLDING, State.EXTERNAL])
    def test_disarmed_it_is_nobodys_and_what_ends_there_is_complete(self, state: State) -> None:
        script, request_id = flight(state)
        how = "complete" if state in self.COMES_DOWN else "taken over NOT_ARMED"
        assert reaction(script, request_id, lambda s: s.heartbeat(armed=False)) == Reaction(
            State.GROUNDED, Control.NONE, [], how
        )
        assert not streams(script)

    @pytest.mark.parametrize("wanted", [Abort(), Disarm(), Disarm(force=True), Land()])
    def test_on_the_ground_it_completes_what_ends_there(
        self, wanted: Abort | Disarm | Land
    ) -> None:
        script = Script(policy("default"))
        take_off(script)
        script.answer(CommandKind.TAKE_OFF, None)
        request_id = script.ask(wanted)
        assert reaction(script, request_id, lambda s: s.heartbeat(armed=False)) == Reaction(
            State.GROUNDED, Control.NONE, [], "complete"
        )

    def test_a_hold_of_what_may_lift_off_is_over_with_the_disarm(self) -> None:
        script = Script(policy("default"))
        take_off(script)
        script.answer(CommandKind.TAKE_OFF, None)
        script.ask(Hold())
        script.heartbeat(armed=False)
        assert reaction(script, 0, lambda s: s.wait(3.0)).sent == []

    def test_nothing_of_ours_ends_with_the_disarm_of_a_vehicle_that_stands(self) -> None:
        script = Script(policy("default"))
        lead_to(State.GROUNDED, script)
        assert reaction(script, 0, lambda s: s.heartbeat(armed=False)) == Reaction(
            State.GROUNDED, Control.NONE, [], ""
        )


class TestLandedAndAirborne:
    ON, AIR = LandedState.ON_GROUND, LandedState.IN_AIR

    @pytest.mark.parametrize("state", [*GUIDED_STATES, State.EXTERNAL])
    def test_one_that_stands_is_not_flown_any_more(self, state: State) -> None:
        script, request_id = flight(state)
        assert reaction(script, request_id, lambda s: s.land_state(self.ON)) == Reaction(
            State.GROUNDED, Control.NONE, [], "taken over NOT_FLYING"
        )
        assert not streams(script)

    @pytest.mark.parametrize("wanted", [Hold(), Abort()])
    def test_standing_is_as_good_as_held(self, wanted: Hold | Abort) -> None:
        script, _ = flight(State.MOVING)
        request_id = script.ask(wanted)
        assert reaction(script, request_id, lambda s: s.land_state(self.ON)) == Reaction(
            State.GROUNDED, Control.NONE, [], "complete"
        )

    def test_what_was_to_do_otherwise_is_not(self) -> None:
        script, _ = flight(State.MOVING)
        script.ask(Land())
        script.answer(CommandKind.LAND, 2)
        assert state_of(script) is State.HOLDING
        script.heartbeat(FlightMode.HOLD)
        assert reaction(script, 0, lambda s: s.land_state(self.ON)) == Reaction(
            State.GROUNDED, Control.NONE, [], ""
        )

    @pytest.mark.parametrize("state", [State.RETURNING, State.LANDING])
    def test_coming_down_is_complete_on_the_ground_and_disarmed(self, state: State) -> None:
        script, request_id = flight(state)
        assert reaction(script, request_id, lambda s: s.land_state(self.ON)) == Reaction(
            State.GROUNDED, Control.NONE, [], ""
        )
        assert reaction(script, request_id, lambda s: s.heartbeat(armed=False)) == Reaction(
            State.GROUNDED, Control.NONE, [], "complete"
        )

    @pytest.mark.parametrize("state", [State.RETURNING, State.LANDING, State.FLYING_MISSION])
    def test_or_three_seconds_later(self, state: State) -> None:
        script, request_id = flight(state)
        if state is State.FLYING_MISSION:
            remember(script, lifted=True)
        script.land_state(self.ON)
        assert reaction(script, request_id, lambda s: s.wait(2.9)).ended == ""
        assert reaction(script, request_id, lambda s: s.wait(0.2)) == Reaction(
            State.GROUNDED, Control.NONE, [], "complete"
        )

    @pytest.mark.parametrize("state", [State.RETURNING, State.LANDING, State.FLYING_MISSION])
    def test_or_at_once_where_it_is_disarmed_already(self, state: State) -> None:
        script, request_id = flight(state)
        remember(script, lifted=True)
        remember(script, armed=False)
        assert reaction(script, request_id, lambda s: s.land_state(self.ON)) == Reaction(
            State.GROUNDED, Control.NONE, [], "complete"
        )

    @pytest.mark.parametrize("kind", ["take off", "mission"])
    def test_before_the_lift_off_the_ground_is_nothing_new(self, kind: str) -> None:
        script = Script(policy("default"))
        if kind == "take off":
            request_id = take_off(script)
        else:
            lead_to(State.GROUNDED, script)
            script.feed(MissionLoaded("square", 4))
            request_id = script.ask(StartMission())
            script.heartbeat(FlightMode.MISSION)
        state = state_of(script)
        for armed in (True, False):
            remember(script, armed=armed)
            script.land_state(LandedState.UNDEFINED)
            assert reaction(script, request_id, lambda s: s.land_state(self.ON)) == Reaction(
                state, Control.OURS, [], ""
            )
        remember(script, armed=True)
        script.land_state(self.AIR)
        after = reaction(script, request_id, lambda s: s.land_state(self.ON))
        assert after[:3] == (State.GROUNDED, Control.NONE, [])
        assert after.ended == ("taken over NOT_FLYING" if kind == "take off" else "")

    @pytest.mark.parametrize("state", [*FLIGHT, State.HOLDING, State.EXTERNAL])
    def test_the_air_is_nothing_new_to_what_flies(self, state: State) -> None:
        script, request_id = flight(state)
        control = script.gate.control
        script.land_state(LandedState.UNDEFINED)
        assert reaction(script, request_id, lambda s: s.land_state(self.AIR)) == Reaction(
            state, control, [], ""
        )

    @pytest.mark.parametrize("state", [State.STALE, State.GROUNDED])
    def test_the_ground_is_nothing_new_to_what_stands(self, state: State) -> None:
        script, request_id = flight(State.GROUNDED)
        if state is State.STALE:
            script.reports_position = False
            script.wait(1.2)
        script.land_state(LandedState.UNDEFINED)
        assert reaction(script, request_id, lambda s: s.land_state(self.ON)) == Reaction(
            state, Control.NONE, [], ""
        )

    @pytest.mark.parametrize(
        ("mode", "after"),
        [
            (FlightMode.OTHER, State.EXTERNAL),
            (FlightMode.HOLD, State.EXTERNAL),
            (FlightMode.LAND, State.LANDING),
            (FlightMode.RETURN, State.RETURNING),
        ],
    )
    def test_what_lifts_off_without_us_is_somebody_elses_or_what_its_mode_says(
        self, mode: FlightMode, after: State
    ) -> None:
        script = Script(policy("default"))
        lead_to(State.GROUNDED, script)
        script.heartbeat(mode)
        request_id = script.ask(Disarm())
        how = "taken over MODE_CHANGED" if after is State.EXTERNAL else "taken over IN_AIR"
        assert reaction(script, request_id, lambda s: s.land_state(self.AIR)) == Reaction(
            after, Control.NONE, [], how
        )

    @pytest.mark.parametrize(
        ("asked", "mode", "after"),
        [
            (Land(), FlightMode.LAND, State.LANDING),
            (ReturnHome(), FlightMode.LAND, State.LANDING),
            (ReturnHome(), FlightMode.RETURN, State.RETURNING),
        ],
    )
    def test_a_landing_that_bounces_goes_on(
        self, asked: Request, mode: FlightMode, after: State
    ) -> None:
        """station.md, bug 11: it timed out three seconds later."""
        script = Script(policy("default")).take_control(UP)
        request_id = script.ask(asked)
        script.heartbeat(mode)
        script.land_state(LandedState.ON_GROUND)
        assert state_of(script) is State.GROUNDED
        script.wait(1.0)
        script.land_state(self.AIR)
        script.wait(10.0)
        assert (state_of(script), ended(script, request_id)) == (after, "")
        script.land_state(LandedState.ON_GROUND)
        script.heartbeat(armed=False)
        assert (state_of(script), ended(script, request_id)) == (State.GROUNDED, "complete")

    def test_our_own_take_off_that_comes_late_is_held(self) -> None:
        script = Script(policy("default"))
        take_off(script)
        script.answer(CommandKind.TAKE_OFF, None)
        request_id = script.ask(Disarm())
        assert reaction(script, request_id, lambda s: s.land_state(self.AIR)) == Reaction(
            *HELD, "aborted OPERATOR"
        )

    def test_ten_seconds_later_it_is_somebody_elses(self) -> None:
        script = Script(policy("default"))
        take_off(script)
        script.answer(CommandKind.TAKE_OFF, None)
        script.heartbeat(FlightMode.OTHER)
        script.wait(10.1)
        assert reaction(script, 0, lambda s: s.land_state(self.AIR)) == Reaction(
            State.EXTERNAL, Control.NONE, [], ""
        )

    def test_a_mission_that_lifts_off_again_goes_on(self) -> None:
        script, request_id = flight(State.FLYING_MISSION)
        remember(script, lifted=True)
        script.land_state(self.ON)
        assert state_of(script) is State.GROUNDED
        script.land_state(self.AIR)
        assert state_of(script) is State.FLYING_MISSION
        assert not script.ended(request_id)

    def test_a_mission_that_lifts_off_again_is_ours_so_that_it_is_braked(self) -> None:
        script, _ = flight(State.FLYING_MISSION)
        remember(script, lifted=True)
        script.land_state(self.ON)
        script.land_state(self.AIR)
        assert script.gate.control is Control.OURS

    def test_a_mission_that_lifts_off_again_is_held_where_nothing_may_fly(self) -> None:
        """(Hostile run 43013300: it flew on, and the explorer took it for a mission that had been
        taken over.)"""
        script, request_id = flight(State.FLYING_MISSION)
        remember(script, lifted=True)
        script.land_state(self.ON)
        script.feed(ConditionChanged(Condition.GPS_LOST, True, "no fix"))
        assert state_of(script) is State.GROUNDED
        script.forget()
        script.land_state(self.AIR)
        assert state_of(script) is State.HOLDING
        assert script.commands() == [CommandKind.HOLD]
        assert ended(script, request_id) == "aborted SEVERITY"

    def test_a_mission_that_lifts_off_again_is_held_where_its_operator_is_lost(self) -> None:
        script, request_id = flight(State.FLYING_MISSION)
        remember(script, lifted=True, operator_lost=True)
        script.land_state(self.ON)
        script.land_state(self.AIR)
        assert state_of(script) is State.HOLDING
        assert ended(script, request_id) == "aborted OPERATOR_LOST"
