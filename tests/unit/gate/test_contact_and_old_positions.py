"""A vehicle that is not heard, and one whose position is too old: the grace, and what ends it."""

from __future__ import annotations

import pytest

from gcs.gate.effects import CancelCommand, CommandKind
from gcs.gate.inputs import (
    HomeSeen,
    Input,
    LandedSeen,
    MessageSeen,
    MissionLoaded,
    OperatorLost,
    VerifierChanged,
)
from gcs.gate.machine.memory import GATE
from gcs.gate.refusal import Code
from gcs.gate.requests import (
    Abort,
    Hold,
    Land,
    Request,
    Resume,
    SetMode,
    StartMission,
    TakeControl,
)
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.reactions import (
    HEARD,
    HELD,
    VERIFIED,
    Reaction,
    elsewhere,
    ended,
    flight,
    reaction,
    remember,
    sample,
    stale,
    state_of,
    streams,
)
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import UP


class TestContact:
    @pytest.mark.parametrize("state", HEARD)
    def test_a_vehicle_that_is_not_heard_any_more_is_nobodys(self, state: State) -> None:
        script, request_id = flight(state)
        script.heartbeat()
        script.reports_heartbeat = False
        script.wait(3.4)
        assert (state_of(script), ended(script, request_id)) == (state, "")
        script.wait(0.2)
        assert (state_of(script), script.gate.control) == (State.NO_VEHICLE, Control.NONE)
        assert ended(script, request_id) == "aborted LINK_LOST"
        memory = script.gate.memory
        assert (memory.armed, memory.mode, memory.landed) == (False, None, LandedState.UNDEFINED)
        held = [(GATE, CommandKind.HOLD)] if state is State.HOLDING else []
        assert list(memory.outstanding) == held
        assert not streams(script)

    def test_a_hold_that_was_asked_for_is_asked_for_until_it_is_shown(self) -> None:
        script, request_id = flight(State.HOLDING)
        script.reports_heartbeat = script.reports_position = False
        script.wait(4.0)
        assert (state_of(script), ended(script, request_id)) == (
            State.NO_VEHICLE,
            "aborted LINK_LOST",
        )
        script.forget()
        script.wait(5.0)
        assert script.commands() == [CommandKind.HOLD] * 5
        script.reports_heartbeat = script.reports_position = True
        script.heartbeat(FlightMode.GUIDED)
        script.land_state(LandedState.IN_AIR)
        script.tick()
        assert state_of(script) is State.HOLDING
        script.heartbeat(FlightMode.HOLD)
        script.forget()
        script.wait(3.0)
        assert script.commands() == []

    @pytest.mark.parametrize("given", [MessageSeen(), LandedSeen(LandedState.IN_AIR)])
    def test_any_message_is_a_sign_of_life(self, given: Input) -> None:
        """autopilots.md 7: without its heartbeats a vehicle was lost that told all else."""
        script, request_id = flight(State.MOVING)
        script.reports_heartbeat = False
        for _ in range(5):
            script.wait(1.0)
            script.feed(MessageSeen())
        script.feed(given)
        assert (state_of(script), ended(script, request_id)) == (State.MOVING, "")

    def test_a_message_of_a_vehicle_that_was_lost_tells_no_mode(self) -> None:
        script = Script(policy("default"))
        script.feed(MessageSeen())
        assert state_of(script) is State.NO_VEHICLE
        script, _ = flight(State.NO_VEHICLE)
        script.feed(MessageSeen())
        assert state_of(script) is State.NO_VEHICLE

    @pytest.mark.parametrize(
        ("asked", "kind"),
        [
            (Hold(), CommandKind.HOLD),
            (Abort(), CommandKind.HOLD),
            (Land(), CommandKind.LAND),
            (SetMode("AUTO.LOITER", FlightMode.HOLD), CommandKind.HOLD),
        ],
    )
    def test_a_stop_goes_out_to_a_vehicle_that_was_heard_once(
        self, asked: Request, kind: CommandKind
    ) -> None:
        script = Script(policy("default")).take_control(UP)
        script.reports_heartbeat = script.reports_position = False
        script.wait(4.0)
        script.forget()
        request_id = script.ask(asked)
        assert (script.commands(), ended(script, request_id)) == ([kind], "")
        fresh = Script(policy("default"))
        assert fresh.refusal(fresh.ask(asked)) is Code.NO_VEHICLE

    @pytest.mark.parametrize("result", [None, 2])
    def test_a_landing_that_is_not_heard_of_is_told(self, result: int | None) -> None:
        script = Script(policy("default")).take_control(UP)
        script.reports_heartbeat = script.reports_position = False
        script.wait(4.0)
        request_id = script.ask(Land())
        script.answer(CommandKind.LAND, result)
        wanted = "timed out NO_ANSWER" if result is None else "aborted VEHICLE_REFUSED"
        assert ended(script, request_id) == wanted

    def test_a_landing_that_was_not_heard_of_is_complete_where_it_is_seen(self) -> None:
        script = Script(policy("default")).take_control(UP)
        script.reports_heartbeat = script.reports_position = False
        script.wait(4.0)
        request_id = script.ask(Land())
        script.answer(CommandKind.LAND, 0)
        script.reports_heartbeat = script.reports_position = True
        script.heartbeat(FlightMode.LAND)
        script.land_state(LandedState.IN_AIR)
        script.wait(10.0)
        assert (state_of(script), ended(script, request_id)) == (State.LANDING, "")
        script.land_state(LandedState.ON_GROUND)
        script.heartbeat(armed=False)
        assert ended(script, request_id) == "complete"

    @pytest.mark.parametrize(
        ("state", "sent"),
        [
            (State.MOVING, [CommandKind.HOLD]),
            (State.FLYING_MISSION, [CommandKind.HOLD]),
            (State.RETURNING, []),
            (State.LANDING, []),
            (State.EXTERNAL, []),
            (State.GROUNDED, []),
        ],
    )
    def test_who_quits_holds_what_we_flew_when_it_was_heard_last(
        self, state: State, sent: list[CommandKind]
    ) -> None:
        script, _ = flight(state)
        script.heartbeat()
        script.reports_heartbeat = False
        script.wait(4.0)
        assert state_of(script) is State.NO_VEHICLE
        script.forget()
        script.feed(OperatorLost("quit"))
        assert (script.commands(), script.gate.settled) == (sent, sent == [])

    def test_who_quits_asks_nothing_of_nobody(self) -> None:
        script = Script(policy("default"))
        script.feed(OperatorLost("quit"))
        assert (script.commands(), script.gate.settled) == ([], True)

    def test_who_quits_does_not_take_back_the_landing_of_what_is_not_heard(self) -> None:
        script = Script(policy("default")).take_control(UP)
        script.reports_heartbeat = script.reports_position = False
        script.wait(4.0)
        request_id = script.ask(Land())
        script.forget()
        script.feed(OperatorLost("quit"))
        assert script.commands() == []
        assert ended(script, request_id) == "aborted OPERATOR_LOST"
        assert script.all(CancelCommand) == []
        assert not script.gate.settled

    def test_nor_of_one_that_is_back_and_does_not_show_it_yet(self) -> None:
        script = Script(policy("default")).take_control(UP)
        script.reports_heartbeat = script.reports_position = False
        script.wait(4.0)
        request_id = script.ask(Land())
        script.heartbeat(FlightMode.HOLD)
        script.position()
        assert (state_of(script), ended(script, request_id)) == (State.EXTERNAL, "")
        script.forget()
        script.feed(OperatorLost("quit"))
        assert ended(script, request_id) == "aborted OPERATOR_LOST"
        assert script.commands() == []
        assert script.all(CancelCommand) == []
        assert script.gate.settled

    def test_so_it_is_where_the_position_went_first(self) -> None:
        script, request_id = flight(State.MOVING)
        script.reports_heartbeat = script.reports_position = False
        assert reaction(script, request_id, lambda s: s.wait(4.0)) == Reaction(
            State.NO_VEHICLE, Control.NONE, [CommandKind.HOLD] * 2, "aborted STALE"
        )

    def test_somebody_who_is_heard_first_is_stale_until_a_position_comes(self) -> None:
        script = Script(policy("default"))
        script.heartbeat()
        assert state_of(script) is State.STALE
        script.tick()
        assert state_of(script) is State.GROUNDED

    @pytest.mark.parametrize(
        ("mode", "after"),
        [
            (FlightMode.RETURN, State.RETURNING),
            (FlightMode.LAND, State.LANDING),
            (FlightMode.HOLD, State.EXTERNAL),
            (FlightMode.GUIDED, State.EXTERNAL),
        ],
    )
    def test_what_flies_when_it_is_first_heard_is_where_its_mode_says(
        self, mode: FlightMode, after: State
    ) -> None:
        script = Script(policy("default"))
        script.heartbeat(mode, armed=True)
        script.land_state(LandedState.IN_AIR)
        script.position()
        assert (state_of(script), script.gate.control) == (after, Control.NONE)

    def test_armed_and_not_known_to_stand_is_somebody_elses(self) -> None:
        script = Script(policy("default"))
        script.heartbeat(FlightMode.HOLD, armed=True)
        script.position()
        assert state_of(script) is State.EXTERNAL

    def test_a_hold_that_was_commanded_to_nobody_is_commanded_to_whoever_is_heard(self) -> None:
        script, abort = flight(State.NO_VEHICLE)
        script.heartbeat(FlightMode.GUIDED)
        script.land_state(LandedState.IN_AIR)
        found = reaction(script, abort, lambda s: s.position())
        assert found[:3] == HELD
        assert not streams(script)

    def test_disarmed_and_not_known_to_fly_stands(self) -> None:
        script = Script(policy("default"))
        script.heartbeat(FlightMode.LAND, armed=False)
        script.position()
        assert state_of(script) is State.GROUNDED

    def test_disarmed_is_believed_before_the_landed_state(self) -> None:
        script = Script(policy("default"))
        script.heartbeat(FlightMode.LAND, armed=False)
        script.land_state(LandedState.IN_AIR)
        script.position()
        assert state_of(script) is State.GROUNDED


class TestOldPosition:
    @pytest.mark.parametrize("state", [*VERIFIED, State.HOLDING])
    def test_what_is_streamed_goes_on_for_the_grace_and_then_it_is_held(self, state: State) -> None:
        script, request_id = flight(state)
        streamed = streams(script)
        script.reports_position = False
        script.forget()
        script.wait(1.0)
        assert state_of(script) is state
        script.wait(0.1)
        assert state_of(script) is State.STALE
        assert streams(script) is streamed
        sent_before = script.commands().count(CommandKind.HOLD)
        script.forget()
        script.wait(0.4)
        # A hold that was asked for goes on until it is seen.
        assert ended(script, request_id) == ("" if state is State.HOLDING else "aborted STALE")
        assert state is State.HOLDING or CommandKind.HOLD in script.commands()
        assert sent_before == 0 or state is State.HOLDING
        assert not streams(script)
        assert (state_of(script), script.gate.control) == (State.STALE, Control.OURS)

    @pytest.mark.parametrize("state", [*VERIFIED, State.HOLDING])
    def test_a_position_within_the_grace_goes_on_where_it_was(self, state: State) -> None:
        script, request_id = stale(state)
        control = script.gate.control
        script.reports_position = True
        assert reaction(script, request_id, lambda s: s.position()) == Reaction(
            state, control, [], ""
        )

    @pytest.mark.parametrize("state", VERIFIED)
    def test_a_position_after_the_grace_finds_it_held(self, state: State) -> None:
        script, request_id = stale(state)
        script.wait(0.5)
        assert reaction(script, request_id, lambda s: s.position())[:2] == (
            State.HOLDING,
            Control.OURS,
        )

    @pytest.mark.parametrize("state", [State.RETURNING, State.LANDING])
    def test_a_return_and_a_landing_are_the_vehicles_own_business(self, state: State) -> None:
        script, request_id = flight(state)
        script.reports_position = False
        assert reaction(script, request_id, lambda s: s.wait(3.0)) == Reaction(
            state, Control.OURS, [], ""
        )

    @pytest.mark.parametrize("state", [State.GROUNDED, State.EXTERNAL])
    def test_what_we_do_not_fly_is_stale_and_comes_back_and_nothing_is_sent(
        self, state: State
    ) -> None:
        script, request_id = stale(state)
        assert reaction(script, request_id, lambda s: s.wait(1.0)) == Reaction(
            State.STALE, Control.NONE, [], ""
        )
        assert reaction(script, request_id, lambda s: s.position()) == Reaction(
            state, Control.NONE, [], ""
        )


class TestWhileThePositionIsTooOld:
    FLOWN = (State.MOVING, State.TAKING_PICTURE, State.FLYING_MISSION)

    @pytest.mark.parametrize("mode", [FlightMode.OTHER, FlightMode.TAKEOFF, FlightMode.HOLD])
    @pytest.mark.parametrize("state", FLOWN)
    def test_a_pilot_takes_over(self, state: State, mode: FlightMode) -> None:
        script, request_id = stale(state)
        assert reaction(script, request_id, lambda s: s.heartbeat(mode)) == Reaction(
            State.STALE, Control.NONE, [], "taken over MODE_CHANGED"
        )
        assert not streams(script)
        assert reaction(script, request_id, lambda s: s.wait(1.0)).sent == []
        script.reports_position = True
        script.tick()
        assert state_of(script) is State.EXTERNAL

    @pytest.mark.parametrize(
        ("mode", "after"),
        [(FlightMode.RETURN, State.RETURNING), (FlightMode.LAND, State.LANDING)],
    )
    @pytest.mark.parametrize("state", FLOWN)
    def test_a_failsafe_of_the_vehicles_own_is_seen(
        self, state: State, mode: FlightMode, after: State
    ) -> None:
        script, request_id = stale(state)
        assert reaction(script, request_id, lambda s: s.heartbeat(mode)) == Reaction(
            after, Control.NONE, [], "taken over MODE_CHANGED"
        )

    @pytest.mark.parametrize("mode", [FlightMode.RETURN, FlightMode.LAND])
    def test_on_the_ground_it_is_a_mode_and_nothing_more(self, mode: FlightMode) -> None:
        script, request_id = stale(State.GROUNDED)
        assert reaction(script, request_id, lambda s: s.heartbeat(mode)) == Reaction(
            State.STALE, Control.NONE, [], ""
        )

    @pytest.mark.parametrize("mode", [m for m in FlightMode if m is not FlightMode.HOLD])
    def test_a_hold_that_is_not_shown_yet_is_waited_for(self, mode: FlightMode) -> None:
        script, request_id = stale(State.MOVING)
        script.ask(Hold())
        script.heartbeat(FlightMode.OTHER if mode is FlightMode.GUIDED else FlightMode.GUIDED)
        assert reaction(script, request_id, lambda s: s.heartbeat(mode)) == Reaction(
            State.STALE, Control.OURS, [], ""
        )

    @pytest.mark.parametrize("wanted", [Hold(), Abort()])
    def test_the_hold_that_is_shown_completes_the_request_for_it(
        self, wanted: Hold | Abort
    ) -> None:
        script, _ = stale(State.MOVING)
        asked = script.ask(wanted)
        assert reaction(script, asked, lambda s: s.heartbeat(FlightMode.HOLD)) == Reaction(
            State.STALE, Control.OURS, [], "complete"
        )
        assert reaction(script, asked, lambda s: s.wait(2.0)).sent == []

    def test_the_gates_own_hold_that_is_shown_is_not_repeated(self) -> None:
        script, request_id = stale(State.MOVING)
        script.wait(0.5)
        assert ended(script, request_id) == "aborted STALE"
        script.heartbeat(FlightMode.HOLD)
        assert reaction(script, request_id, lambda s: s.wait(2.0)).sent == []

    def test_a_commanded_mode_that_is_not_shown_yet_is_waited_for(self) -> None:
        script, _ = flight(State.TAKING_PICTURE)
        script = Script(policy("default")).take_control(UP)
        script.feed(MissionLoaded("square", 4))
        mission = script.ask(StartMission())
        script.reports_position = False
        script.wait(1.1)
        assert state_of(script) is State.STALE
        for mode in (FlightMode.OTHER, FlightMode.RETURN, FlightMode.LAND, FlightMode.GUIDED):
            assert reaction(script, mission, lambda s, m=mode: s.heartbeat(m)) == Reaction(  # type: ignore[misc]
                State.STALE, Control.OURS, [], ""
            )

    @pytest.mark.parametrize("state", FLOWN)
    def test_the_modes_it_was_flown_in_change_nothing(self, state: State) -> None:
        script, request_id = stale(state)
        assert reaction(script, request_id, lambda s: s.heartbeat()) == Reaction(
            State.STALE, Control.OURS, [], ""
        )
        assert streams(script) is (state is not State.FLYING_MISSION)

    def test_guided_shown_for_a_hover_whose_control_is_being_taken_changes_nothing(self) -> None:
        script = Script(policy("default"))
        script.mode = FlightMode.OTHER
        script.fly(UP)
        request_id = script.ask(TakeControl())
        script.reports_position = False
        script.wait(1.04)
        script.wait(0.06)
        assert state_of(script) is State.STALE
        assert reaction(script, request_id, lambda s: s.heartbeat(FlightMode.HOLD)) == Reaction(
            State.STALE, Control.TAKING, [], ""
        )

    @pytest.mark.parametrize("state", FLOWN)
    def test_a_disarmed_vehicle_is_nobodys(self, state: State) -> None:
        script, request_id = stale(state)
        assert reaction(script, request_id, lambda s: s.heartbeat(armed=False)) == Reaction(
            State.STALE,
            Control.NONE,
            [],
            "complete" if state is State.FLYING_MISSION else "taken over NOT_ARMED",
        )
        assert not streams(script)
        assert reaction(script, request_id, lambda s: s.wait(1.0)).sent == []
        script.reports_position = True
        script.tick()
        assert state_of(script) is State.GROUNDED

    @pytest.mark.parametrize("state", FLOWN)
    def test_one_that_stands_is_nobodys(self, state: State) -> None:
        script, request_id = stale(state)
        assert reaction(
            script, request_id, lambda s: s.land_state(LandedState.ON_GROUND)
        ) == Reaction(State.STALE, Control.NONE, [], "taken over NOT_FLYING")
        assert not streams(script)
        assert reaction(script, request_id, lambda s: s.wait(1.0)).sent == []

    def test_the_ground_is_nothing_new_to_what_stood(self) -> None:
        script, request_id = stale(State.GROUNDED)
        script.land_state(LandedState.UNDEFINED)
        assert reaction(
            script, request_id, lambda s: s.land_state(LandedState.ON_GROUND)
        ) == Reaction(State.STALE, Control.NONE, [], "")

    def test_the_disarm_of_a_vehicle_that_somebody_else_flies_is_nothing_to_us(self) -> None:
        script = Script(policy("default")).fly(UP)
        script.reports_position = False
        script.wait(1.1)
        assert reaction(script, 0, lambda s: s.heartbeat(armed=False)) == Reaction(
            State.STALE, Control.NONE, [], ""
        )

    def test_arming_is_complete_all_the_same(self) -> None:
        script, request_id = stale(State.GROUNDED)
        assert reaction(script, request_id, lambda s: s.heartbeat(armed=True)) == Reaction(
            State.STALE, Control.NONE, [], "complete"
        )

    def test_being_armed_completes_no_other_request(self) -> None:
        script, request_id = stale(State.MOVING)
        script.armed = False
        remember(script, armed=False)
        assert reaction(script, request_id, lambda s: s.heartbeat(armed=True)) == Reaction(
            State.STALE, Control.OURS, [], ""
        )

    @pytest.mark.parametrize(
        ("happens", "code"),
        [
            (lambda s: s.feed(sample(s, 20.0, reset=True)), "ESTIMATOR_RESET"),
            (lambda s: s.feed(HomeSeen((0.0, 5.0, 0.0))), "HOME_MOVED"),
            (lambda s: s.feed(VerifierChanged(elsewhere(s))), None),
        ],
        ids=["jumped", "home moved", "fence moved"],
    )
    @pytest.mark.parametrize("state", FLOWN)
    def test_what_is_verified_no_more_is_held_and_not_streamed(
        self, state: State, happens: object, code: str | None
    ) -> None:
        script, request_id = stale(state)
        assert callable(happens)
        found = reaction(script, request_id, happens)
        assert found[1:3] == (Control.OURS, [CommandKind.HOLD])
        if code is not None:
            assert found.ended == f"aborted {code}"
        assert found.state in (State.STALE, State.HOLDING)
        script.heartbeat(FlightMode.HOLD)
        script.reports_position = True
        script.tick()
        assert state_of(script) is State.HOLDING

    @pytest.mark.parametrize(
        ("happens", "code"),
        [
            (lambda s: s.feed(HomeSeen((0.0, 5.0, 0.0))), Code.HOME_MOVED),
            (lambda s: s.feed(VerifierChanged(elsewhere(s))), None),
        ],
        ids=["home moved", "fence moved"],
    )
    @pytest.mark.parametrize("state", FLOWN)
    def test_the_stream_ends_with_the_reason(
        self, state: State, happens: object, code: Code | None
    ) -> None:
        script, request_id = stale(state)
        assert callable(happens)
        happens(script)
        assert not streams(script)
        assert code in (None, script.outcome(request_id).code)
        assert state_of(script) is State.STALE


def test_a_resume_from_the_grace_of_a_hold_is_refused() -> None:
    script, _ = stale(State.HOLDING)
    assert script.refusal(script.ask(Resume())) is Code.STALE


@pytest.mark.parametrize("state", [State.RETURNING, State.LANDING])
def test_who_leaves_after_a_landing_whose_positions_are_old_is_told_how_it_ended(
    state: State,
) -> None:
    """`random_flight.flown(394015001986)`: landed, still armed, and no position any more."""
    script, request_id = flight(state)
    script.at(0.0, 0.0, 0.0)
    script.land_state(LandedState.ON_GROUND)
    script.reports_position = False
    script.wait(2.0)
    assert (state_of(script), ended(script, request_id)) == (State.STALE, "")
    sent = script.commands()
    script.feed(OperatorLost("quit"))
    assert ended(script, request_id) == "aborted OPERATOR_LOST"
    assert script.commands() == sent
