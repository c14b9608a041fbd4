"""Reports that are stored and lead to nothing: not one other fact of the gate's memory changes."""

from __future__ import annotations

import pytest

from gcs.gate.effects import CommandKind, Say
from gcs.gate.inputs import (
    CommandEnded,
    HeartbeatSeen,
    HomeSeen,
    Input,
    LandedSeen,
    MissionSeen,
    Tick,
)
from gcs.gate.refusal import Code
from gcs.gate.requests import Disarm
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import (
    UP,
    ended,
    flight,
    remember,
    sample,
    state_of,
    with_facts,
)

ACCEPTED = 0
FAILED = 4


def changes_only(script: Script, given: Input, **facts: object) -> None:
    """`given` stores these facts; nothing else changes, and nothing is sent."""
    before = script.gate.memory
    effects = script.feed(given)
    assert script.gate.memory == with_facts(before, **facts)
    assert [effect for effect in effects if not isinstance(effect, Say)] == []


def mode_seen(script: Script, mode: FlightMode, **facts: object) -> None:
    """The heartbeat shows `mode`; of the rest only `facts` change."""
    before = script.gate.memory
    given = HeartbeatSeen(before.armed, mode, mode.value)
    heard = {"heard_ns": script.now_ns, "mode": mode, "mode_name": mode.value}
    used = mode is FlightMode.GUIDED and (before.armed or before.guided_used)
    changes_only(script, given, **heard, guided_used=used, **facts)


class TestInTheAir:
    @pytest.mark.parametrize(
        "state",
        [
            State.NO_VEHICLE,
            State.STALE,
            State.HOVERING,
            State.MOVING,
            State.TAKING_PICTURE,
            State.RETURNING,
            State.LANDING,
            State.HOLDING,
            State.EXTERNAL,
        ],
    )
    def test_what_flies_by_our_knowledge_is_reported_to_fly_again(self, state: State) -> None:
        script, _ = flight(state)
        remember(script, landed=LandedState.UNDEFINED, lifted=False, mode=FlightMode.GUIDED)
        given = LandedSeen(LandedState.IN_AIR)
        changes_only(script, given, landed=LandedState.IN_AIR, landed_ns=script.now_ns)

    def test_the_ground_of_a_vehicle_that_is_not_heard_cancels_no_abort(self) -> None:
        script, _ = flight(State.NO_VEHICLE)
        assert script.gate.memory.outstanding
        given = LandedSeen(LandedState.ON_GROUND)
        changes_only(script, given, landed=LandedState.ON_GROUND, landed_ns=script.now_ns)

    def test_somebody_elses_vehicle_is_armed_after_it_was_seen_to_fly(self) -> None:
        script = Script(policy("default")).connect()
        script.land_state(LandedState.IN_AIR)
        assert state_of(script) is State.EXTERNAL
        heard = {"heard_ns": script.now_ns, "armed": True}
        given = HeartbeatSeen(True, script.mode, script.mode.value)
        changes_only(script, given, **heard)


class TestPlaces:
    @pytest.mark.parametrize("state", [State.NO_VEHICLE, State.LANDING, State.EXTERNAL])
    def test_home_that_moves_is_nothing_to_what_we_do_not_fly_to_a_place(
        self, state: State
    ) -> None:
        script, _ = flight(state)
        remember(script, landed=LandedState.IN_AIR, home_ned=(0.0, 0.0, 0.0))
        changes_only(script, HomeSeen((5.0, 0.0, 0.0)), home_ned=(5.0, 0.0, 0.0))

    def test_nor_to_what_is_armed_on_the_ground_and_not_reported_to_stand(self) -> None:
        script, _ = flight(State.GROUNDED)
        remember(script, landed=LandedState.UNDEFINED, armed=True)
        changes_only(script, HomeSeen((5.0, 0.0, 0.0)), home_ned=(5.0, 0.0, 0.0))

    def test_what_lands_has_no_held_point_that_a_jump_would_move(self) -> None:
        script, _ = flight(State.LANDING)
        script.feed(sample(script, 20.0, reset=True))
        assert state_of(script) is State.LANDING
        assert script.gate.active_goal_ned is None

    def test_what_is_held_has_its_point_verified_anew_when_home_moves(self) -> None:
        script, _ = flight(State.HOLDING)
        assert script.gate.hold_goal_ned == (0.0, 0.0, -UP)
        script.feed(sample(script, 0.25))
        script.feed(HomeSeen((5.0, 0.0, 0.0)))
        assert state_of(script) is State.HOLDING
        assert script.gate.hold_goal_ned == (0.0, 0.25, -UP)


class TestModes:
    def test_guided_before_we_asked_for_it_is_not_yet_control(self) -> None:
        script, _ = flight(State.HOVERING)
        mode_seen(script, FlightMode.GUIDED)
        assert script.gate.control is Control.TAKING

    def test_a_hold_that_was_refused_and_is_shown_all_the_same_is_a_hold(self) -> None:
        script, request_id = flight(State.HOLDING)
        script.feed(CommandEnded(request_id, CommandKind.HOLD, FAILED, ""))
        mode_seen(script, FlightMode.HOLD)

    @pytest.mark.parametrize(
        ("state", "mode"),
        [
            (State.FLYING_MISSION, FlightMode.MISSION),
            (State.RETURNING, FlightMode.RETURN),
            (State.LANDING, FlightMode.LAND),
        ],
    )
    def test_the_mode_of_the_state_may_come_when_it_is_awaited_no_more(
        self, state: State, mode: FlightMode
    ) -> None:
        script, _ = flight(state)
        remember(script, mode=FlightMode.HOLD, asked_mode=None)
        mode_seen(script, mode)

    @pytest.mark.parametrize("state", [State.STALE, State.GROUNDED, State.EXTERNAL])
    def test_a_mode_that_is_overdue_is_awaited_no_more(self, state: State) -> None:
        script, _ = flight(state)
        remember(script, asked_mode=FlightMode.HOLD, asked_until_ns=script.now_ns, goal=None)
        changes_only(script, Tick(0), asked_mode=None)

    def test_nor_is_one_that_is_shown_in_a_hover(self) -> None:
        script = Script(policy("default")).take_control(UP)
        remember(script, asked_mode=FlightMode.GUIDED, asked_until_ns=script.now_ns + 1)
        mode_seen(script, FlightMode.GUIDED, asked_mode=None)

    def test_nor_is_the_one_hold_that_somebody_elses_vehicle_was_told(self) -> None:
        script, _ = flight(State.EXTERNAL)
        remember(script, asked_mode=FlightMode.HOLD, asked_until_ns=script.now_ns + 1)
        mode_seen(script, FlightMode.HOLD, asked_mode=None)


class TestAnswers:
    """An answer ends a command and nothing else."""

    @pytest.mark.parametrize("state", [State.NO_VEHICLE, State.STALE])
    def test_accepted(self, state: State) -> None:
        script, _ = flight(state)
        remember(script, outstanding=((0, CommandKind.HOLD),))
        changes_only(script, CommandEnded(0, CommandKind.HOLD, ACCEPTED, ""), outstanding=())

    @pytest.mark.parametrize("state", [State.RETURNING, State.LANDING])
    @pytest.mark.parametrize("kind", [CommandKind.DISARM, CommandKind.HOLD])
    def test_refused(self, state: State, kind: CommandKind) -> None:
        script, _ = flight(state)
        remember(script, outstanding=((0, kind),))
        changes_only(script, CommandEnded(0, kind, FAILED, ""), outstanding=())

    @pytest.mark.parametrize("state", [State.STALE, State.RETURNING, State.LANDING, State.EXTERNAL])
    def test_a_hold_without_an_answer(self, state: State) -> None:
        script, _ = flight(state)
        remember(script, outstanding=((0, CommandKind.HOLD),))
        given = CommandEnded(0, CommandKind.HOLD, None, "")
        changes_only(script, given, outstanding=(), silence_reported=CommandKind.HOLD)

    def test_a_disarm_that_is_refused_ends_its_request_where_somebody_else_flies(self) -> None:
        script, request_id = flight(State.EXTERNAL)
        remember(script, outstanding=((request_id, CommandKind.DISARM),))
        given = CommandEnded(request_id, CommandKind.DISARM, FAILED, "")
        script.feed(given)
        assert (state_of(script), script.commands()) == (State.EXTERNAL, [])
        assert ended(script, request_id) == f"aborted {Code.VEHICLE_REFUSED}"

    def test_a_disarm_asked_for_on_the_ground_ends_with_a_lift_off_in_return_mode(self) -> None:
        script = Script(policy("default")).connect()
        script.heartbeat(FlightMode.RETURN, armed=True)
        request_id = script.ask(Disarm())
        script.land_state(LandedState.IN_AIR)
        assert state_of(script) is State.RETURNING
        assert ended(script, request_id) == f"taken over {Code.IN_AIR}"
        script.answer(CommandKind.DISARM, FAILED)
        script.wait(5.1)
        assert state_of(script) is State.RETURNING


class TestMissions:
    @pytest.mark.parametrize("finished", [False, True])
    @pytest.mark.parametrize("state", [State.NO_VEHICLE, State.GROUNDED, State.HOVERING])
    def test_one_that_we_did_not_start(self, state: State, finished: bool) -> None:
        script, _ = flight(state)
        script.tick()
        landed = LandedState.UNDEFINED if state is State.GROUNDED else LandedState.IN_AIR
        remember(script, landed=landed, armed=True)
        changes_only(script, MissionSeen(1, 5, finished), mission_over=finished)
