"""What the vehicle reports moves the state: contact, position, home, fence, armed, landed."""

from __future__ import annotations

from dataclasses import replace

import pytest

from gcs.frames import ned_from_enu
from gcs.gate.airspace.verifier import Verifier, verifier_for
from gcs.gate.airspace.zones import Zone
from gcs.gate.effects import CommandKind, Say, SendSetpoint
from gcs.gate.geometry import Circle
from gcs.gate.inputs import (
    HeartbeatSeen,
    HomeSeen,
    LandedSeen,
    MissionLoaded,
    PositionSeen,
    VerifierChanged,
)
from gcs.gate.refusal import Code
from gcs.gate.requests import Abort, Disarm, Hold, Land, Resume, StartMission, TakeControl
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.reactions import (
    FLIGHT,
    GUIDED_STATES,
    Reaction,
    ended,
    flight,
    reaction,
    remember,
    streams,
    take_off,
)
from tests.unit.gate.script import MS, SECOND, Script, policy
from tests.unit.gate.situations import UP, lead_to

STILL = (0.0, 0.0, 0.0)
HELD = (State.HOLDING, Control.OURS, [CommandKind.HOLD])
JUDGED = (State.TAKING_OFF, *GUIDED_STATES, State.FLYING_MISSION)
"""Where a place is flown to or held at that was verified."""
EVERYWHERE = [*FLIGHT, State.GROUNDED, State.HOLDING, State.EXTERNAL]


def busy(state: State) -> tuple[Script, int]:
    return flight(state, allow_force_disarm=True)


def stale(state: State) -> tuple[Script, int]:
    """`state` with a position just too old, within its grace."""
    script, request_id = busy(state)
    script.reports_position = False
    script.wait(1.1)
    assert script.gate.state is State.STALE
    return script, request_id


def sample(script: Script, east: float, *, reset: bool = False) -> PositionSeen:
    return PositionSeen(ned_from_enu((east, 0.0, UP)), STILL, script.now_ns // MS, reset)


class TestContact:
    @pytest.mark.parametrize("state", EVERYWHERE)
    def test_a_vehicle_that_is_not_heard_any_more_is_nobodys(self, state: State) -> None:
        script, request_id = busy(state)
        script.heartbeat()
        script.reports_heartbeat = False
        script.wait(3.4)
        assert (script.gate.state, ended(script, request_id)) == (state, "")
        script.wait(0.2)
        assert (script.gate.state, script.gate.control) == (State.NO_VEHICLE, Control.NONE)
        assert ended(script, request_id) == "aborted LINK_LOST"
        memory = script.gate.memory
        assert (memory.armed, memory.mode, memory.landed) == (False, None, LandedState.UNDEFINED)
        assert memory.outstanding == ()
        assert not streams(script)

    def test_so_it_is_where_the_position_went_first(self) -> None:
        script, request_id = busy(State.MOVING)
        script.reports_heartbeat = script.reports_position = False
        assert reaction(script, request_id, lambda s: s.wait(4.0)) == Reaction(
            State.NO_VEHICLE, Control.NONE, [CommandKind.HOLD] * 2, "aborted STALE"
        )

    def test_somebody_who_is_heard_first_is_stale_until_a_position_comes(self) -> None:
        script = Script(policy("default"))
        script.heartbeat()
        assert script.gate.state.name == "STALE"
        script.tick()
        assert script.gate.state is State.GROUNDED

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
        assert (script.gate.state, script.gate.control) == (after, Control.NONE)

    def test_armed_and_not_known_to_stand_is_somebody_elses(self) -> None:
        script = Script(policy("default"))
        script.heartbeat(FlightMode.HOLD, armed=True)
        script.position()
        assert script.gate.state is State.EXTERNAL

    def test_a_hold_that_was_commanded_to_nobody_is_commanded_to_whoever_is_heard(self) -> None:
        script, abort = busy(State.NO_VEHICLE)
        script.heartbeat(FlightMode.GUIDED)
        script.land_state(LandedState.IN_AIR)
        found = reaction(script, abort, lambda s: s.position())
        assert found[:3] == HELD
        assert not streams(script)

    def test_disarmed_and_not_known_to_fly_stands(self) -> None:
        script = Script(policy("default"))
        script.heartbeat(FlightMode.LAND, armed=False)
        script.position()
        assert script.gate.state is State.GROUNDED

    def test_disarmed_is_believed_before_the_landed_state(self) -> None:
        script = Script(policy("default"))
        script.heartbeat(FlightMode.LAND, armed=False)
        script.land_state(LandedState.IN_AIR)
        script.position()
        assert script.gate.state is State.GROUNDED


class TestOldPosition:
    @pytest.mark.parametrize("state", [*JUDGED, State.HOLDING])
    def test_what_is_streamed_goes_on_for_the_grace_and_then_it_is_held(self, state: State) -> None:
        script, request_id = busy(state)
        streamed = streams(script)
        script.reports_position = False
        script.forget()
        script.wait(1.0)
        assert script.gate.state is state
        script.wait(0.1)
        assert script.gate.state is State.STALE
        assert streams(script) is streamed
        sent_before = script.commands().count(CommandKind.HOLD)
        script.forget()
        script.wait(0.4)
        assert ended(script, request_id) == "aborted STALE"
        assert CommandKind.HOLD in script.commands()
        assert sent_before == 0 or state is State.HOLDING
        assert not streams(script)
        assert (script.gate.state, script.gate.control) == (State.STALE, Control.OURS)

    @pytest.mark.parametrize("state", [*JUDGED, State.HOLDING])
    def test_a_position_within_the_grace_goes_on_where_it_was(self, state: State) -> None:
        script, request_id = stale(state)
        control = script.gate.control
        script.reports_position = True
        assert reaction(script, request_id, lambda s: s.position()) == Reaction(
            state, control, [], ""
        )

    @pytest.mark.parametrize("state", JUDGED)
    def test_a_position_after_the_grace_finds_it_held(self, state: State) -> None:
        script, request_id = stale(state)
        script.wait(0.5)
        assert reaction(script, request_id, lambda s: s.position())[:2] == (
            State.HOLDING,
            Control.OURS,
        )

    @pytest.mark.parametrize("state", [State.RETURNING, State.LANDING])
    def test_a_return_and_a_landing_are_the_vehicles_own_business(self, state: State) -> None:
        script, request_id = busy(state)
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
        assert script.gate.state is State.EXTERNAL

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
        script, _ = busy(State.TAKING_PICTURE)
        script = Script(policy("default")).take_control(UP)
        script.feed(MissionLoaded("square", 4))
        mission = script.ask(StartMission())
        script.reports_position = False
        script.wait(1.1)
        assert script.gate.state is State.STALE
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
        assert script.gate.state is State.STALE
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
        assert script.gate.state is State.GROUNDED

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
        assert script.gate.state is State.HOLDING

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
        assert script.gate.state is State.STALE


def elsewhere(script: Script) -> Verifier:
    """A fence that holds no place where the vehicle is."""
    verifier = verifier_for(script.policy, script.autopilot, (0.0, 0.0, 0.0), None)
    yard = Zone("elsewhere", True, Circle((900.0, 0.0), 20.0), 0.0, 30.0)
    return replace(verifier, zones=(*verifier.zones, yard))


class TestJump:
    @pytest.mark.parametrize("state", [*JUDGED, State.RETURNING])
    def test_it_holds_and_the_place_is_verified_anew(self, state: State) -> None:
        script, request_id = busy(state)
        found = reaction(script, request_id, lambda s: s.feed(sample(s, 20.0, reset=True)))
        assert found == Reaction(*HELD, "aborted ESTIMATOR_RESET")
        script.pos_ned = ned_from_enu((20.0, 0.0, UP))
        assert script.gate.hold_goal_ned == ned_from_enu((20.0, 0.0, UP))
        assert streams(script)

    def test_a_held_vehicle_is_held_at_its_new_place(self) -> None:
        script, request_id = busy(State.HOLDING)
        found = reaction(script, request_id, lambda s: s.feed(sample(s, 20.0, reset=True)))
        assert found == Reaction(State.HOLDING, Control.OURS, [], "")
        assert script.gate.hold_goal_ned == ned_from_enu((20.0, 0.0, UP))

    def test_or_in_silence_where_that_does_not_clear(self) -> None:
        script, _ = busy(State.HOLDING)
        script.feed(sample(script, 170.0, reset=True))
        script.pos_ned = ned_from_enu((170.0, 0.0, UP))
        assert script.gate.hold_goal_ned is None
        assert not streams(script)

    @pytest.mark.parametrize("state", [State.GROUNDED, State.LANDING, State.EXTERNAL])
    def test_it_is_nothing_to_what_we_do_not_fly_to_a_place(self, state: State) -> None:
        script, request_id = busy(state)
        control = script.gate.control
        found = reaction(script, request_id, lambda s: s.feed(sample(s, 20.0, reset=True)))
        assert found == Reaction(state, control, [], "")

    def test_nor_to_a_return_of_the_vehicles_own(self) -> None:
        script = Script(policy("default")).fly(UP)
        script.heartbeat(FlightMode.RETURN)
        assert script.gate.state is State.RETURNING
        found = reaction(script, 0, lambda s: s.feed(sample(s, 20.0, reset=True)))
        assert found == Reaction(State.RETURNING, Control.NONE, [], "")


class TestHomeMoved:
    FAR, NEAR = HomeSeen((0.0, 5.0, 0.0)), HomeSeen((0.0, 0.9, 0.0))

    @pytest.mark.parametrize("state", [*JUDGED, State.RETURNING])
    def test_it_holds(self, state: State) -> None:
        script, request_id = busy(state)
        assert reaction(script, request_id, lambda s: s.feed(self.FAR)) == Reaction(
            *HELD, "aborted HOME_MOVED"
        )

    @pytest.mark.parametrize("state", JUDGED)
    def test_a_little_is_no_move(self, state: State) -> None:
        script, request_id = busy(state)
        control = script.gate.control
        assert reaction(script, request_id, lambda s: s.feed(self.NEAR)) == Reaction(
            state, control, [], ""
        )

    def test_a_held_vehicle_is_verified_anew(self) -> None:
        script, request_id = busy(State.HOLDING)
        script.feed(sample(script, 3.0))
        assert reaction(script, request_id, lambda s: s.feed(self.FAR)) == Reaction(
            State.HOLDING, Control.OURS, [], ""
        )
        assert script.gate.hold_goal_ned == ned_from_enu((3.0, 0.0, UP))

    @pytest.mark.parametrize("state", [State.GROUNDED, State.LANDING, State.EXTERNAL])
    def test_it_is_nothing_to_what_we_do_not_fly_to_a_place(self, state: State) -> None:
        script, request_id = busy(state)
        control = script.gate.control
        assert reaction(script, request_id, lambda s: s.feed(self.FAR)) == Reaction(
            state, control, [], ""
        )

    def test_nor_to_a_return_of_the_vehicles_own(self) -> None:
        script = Script(policy("default")).fly(UP)
        script.heartbeat(FlightMode.RETURN)
        assert reaction(script, 0, lambda s: s.feed(self.FAR)) == Reaction(
            State.RETURNING, Control.NONE, [], ""
        )


class TestFenceMoved:
    @pytest.mark.parametrize("state", JUDGED)
    def test_what_clears_no_more_is_held_with_the_reason(self, state: State) -> None:
        script, request_id = busy(state)
        found = reaction(script, request_id, lambda s: s.feed(VerifierChanged(elsewhere(s))))
        code = "BAD_MISSION" if state is State.FLYING_MISSION else "OUTSIDE_FENCE"
        assert found == Reaction(*HELD, f"aborted {code}")

    def test_a_take_off_that_stands_is_given_up(self) -> None:
        script = Script(policy("default"))
        request_id = take_off(script)
        found = reaction(script, request_id, lambda s: s.feed(VerifierChanged(elsewhere(s))))
        assert found == Reaction(
            State.GROUNDED,
            Control.NONE,
            [CommandKind.HOLD, CommandKind.DISARM],
            "aborted OUTSIDE_FENCE",
        )
        assert reaction(script, request_id, lambda s: s.wait(1.1)).sent == [CommandKind.HOLD]

    def test_a_held_vehicle_is_held_in_silence(self) -> None:
        script, request_id = busy(State.HOLDING)
        assert streams(script)
        found = reaction(script, request_id, lambda s: s.feed(VerifierChanged(elsewhere(s))))
        assert found == Reaction(State.HOLDING, Control.OURS, [], "")
        assert not streams(script)

    @pytest.mark.parametrize(
        "state", [State.GROUNDED, State.RETURNING, State.LANDING, State.EXTERNAL]
    )
    def test_it_is_nothing_to_what_we_do_not_fly_to_a_place(self, state: State) -> None:
        script, request_id = busy(state)
        control = script.gate.control
        found = reaction(script, request_id, lambda s: s.feed(VerifierChanged(elsewhere(s))))
        assert found == Reaction(state, control, [], "")


class TestBreach:
    def dash(self, script: Script) -> None:
        """Ten metres from the fence, at twelve metres a second towards it."""
        script.now_ns += 5 * SECOND
        script.feed(HeartbeatSeen(script.armed, script.mode, script.mode.value))
        script.feed(LandedSeen(script.landed))
        script.forget()
        script.feed(PositionSeen((140.0, 0.0, -UP), (12.0, 0.0, 0.0), script.now_ns // MS))

    @pytest.mark.parametrize("state", [s for s in FLIGHT if s is not State.LANDING])
    def test_it_is_braked_in_the_instant_of_the_sample(self, state: State) -> None:
        script, request_id = busy(state)
        script.forget()
        self.dash(script)
        found = Reaction(
            script.gate.state, script.gate.control, script.commands(), ended(script, request_id)
        )
        assert found == Reaction(*HELD, "aborted FENCE_BREACH")
        (brake,) = script.all(SendSetpoint)
        assert script.gate.hold_goal_ned == brake.permit.pos_ned

    @pytest.mark.parametrize("state", [State.LANDING, State.HOLDING, State.EXTERNAL])
    def test_what_lands_or_is_held_or_is_not_ours_is_left_alone(self, state: State) -> None:
        script, _ = busy(state)
        if state is State.HOLDING:
            script.heartbeat(FlightMode.HOLD)
        control = script.gate.control
        self.dash(script)
        assert (script.gate.state, script.gate.control) == (state, control)
        assert script.commands() == []
        assert script.all(SendSetpoint) == []

    @pytest.mark.parametrize("state", [State.MOVING, State.TAKING_PICTURE, State.FLYING_MISSION])
    def test_it_is_braked_by_a_sample_that_comes_late(self, state: State) -> None:
        script, request_id = stale(state)
        script.pos_ned = ned_from_enu((0.0, 140.0, UP))
        sample_ns = script.now_ns + 300 * MS
        remember(script, pos_ned=ned_from_enu((0.0, 139.0, UP)))
        script.now_ns = sample_ns
        given = PositionSeen((140.0, 0.0, -UP), (12.0, 0.0, 0.0), script.now_ns // MS)
        assert reaction(script, request_id, lambda s: s.feed(given)) == Reaction(
            *HELD, "aborted FENCE_BREACH"
        )
        assert len(script.all(SendSetpoint)) == 1

    def test_what_is_held_already_is_not_braked_when_its_sample_comes_late(self) -> None:
        script, _ = busy(State.HOLDING)
        script.heartbeat(FlightMode.HOLD)
        script.reports_position = False
        script.wait(1.2)
        assert script.gate.state.name == "STALE"
        self.dash(script)
        assert script.commands() == []
        assert script.gate.state is State.HOLDING


class TestArmedAndDisarmed:
    def test_arming_is_complete_when_it_is_shown(self) -> None:
        script, request_id = busy(State.GROUNDED)
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
        script, request_id = busy(state)
        control = script.gate.control
        remember(script, armed=False)
        assert reaction(script, request_id, lambda s: s.heartbeat(armed=True)) == Reaction(
            state, control, [], ""
        )

    COMES_DOWN = (State.RETURNING, State.LANDING, State.FLYING_MISSION, State.EXTERNAL)

    @pytest.mark.parametrize("state", [*FLIGHT, State.HOLDING, State.EXTERNAL])
    def test_disarmed_it_is_nobodys_and_what_ends_there_is_complete(self, state: State) -> None:
        script, request_id = busy(state)
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
        script, request_id = busy(state)
        assert reaction(script, request_id, lambda s: s.land_state(self.ON)) == Reaction(
            State.GROUNDED, Control.NONE, [], "taken over NOT_FLYING"
        )
        assert not streams(script)

    @pytest.mark.parametrize("wanted", [Hold(), Abort()])
    def test_standing_is_as_good_as_held(self, wanted: Hold | Abort) -> None:
        script, _ = busy(State.MOVING)
        request_id = script.ask(wanted)
        assert reaction(script, request_id, lambda s: s.land_state(self.ON)) == Reaction(
            State.GROUNDED, Control.NONE, [], "complete"
        )

    def test_what_was_to_do_otherwise_is_not(self) -> None:
        script, _ = busy(State.MOVING)
        script.ask(Land())
        script.answer(CommandKind.LAND, 2)
        assert script.gate.state is State.HOLDING
        script.heartbeat(FlightMode.HOLD)
        assert reaction(script, 0, lambda s: s.land_state(self.ON)) == Reaction(
            State.GROUNDED, Control.NONE, [], ""
        )

    @pytest.mark.parametrize("state", [State.RETURNING, State.LANDING])
    def test_coming_down_is_complete_on_the_ground_and_disarmed(self, state: State) -> None:
        script, request_id = busy(state)
        assert reaction(script, request_id, lambda s: s.land_state(self.ON)) == Reaction(
            State.GROUNDED, Control.NONE, [], ""
        )
        assert reaction(script, request_id, lambda s: s.heartbeat(armed=False)) == Reaction(
            State.GROUNDED, Control.NONE, [], "complete"
        )

    @pytest.mark.parametrize("state", [State.RETURNING, State.LANDING, State.FLYING_MISSION])
    def test_or_three_seconds_later(self, state: State) -> None:
        script, request_id = busy(state)
        if state is State.FLYING_MISSION:
            remember(script, lifted=True)
        script.land_state(self.ON)
        assert reaction(script, request_id, lambda s: s.wait(2.9)).ended == ""
        assert reaction(script, request_id, lambda s: s.wait(0.2)) == Reaction(
            State.GROUNDED, Control.NONE, [], "complete"
        )

    @pytest.mark.parametrize("state", [State.RETURNING, State.LANDING, State.FLYING_MISSION])
    def test_or_at_once_where_it_is_disarmed_already(self, state: State) -> None:
        script, request_id = busy(state)
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
        state = script.gate.state
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
        script, request_id = busy(state)
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
        how = "taken over MODE_CHANGED" if after is State.EXTERNAL else ""
        assert reaction(script, request_id, lambda s: s.land_state(self.AIR)) == Reaction(
            after, Control.NONE, [], how
        )

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
        script, request_id = busy(State.FLYING_MISSION)
        remember(script, lifted=True)
        script.land_state(self.ON)
        assert script.gate.state.name == "GROUNDED"
        script.land_state(self.AIR)
        assert script.gate.state is State.FLYING_MISSION
        assert not script.ended(request_id)


def test_a_resume_from_the_grace_of_a_hold_is_refused() -> None:
    script, _ = stale(State.HOLDING)
    assert script.refusal(script.ask(Resume())) is Code.STALE


def test_a_sample_of_the_ordinary_says_nothing() -> None:
    for state in EVERYWHERE:
        script, _ = busy(state)
        effects = script.feed(PositionSeen(script.pos_ned, STILL, script.now_ns // MS))
        assert [e for e in effects if not isinstance(e, Say)] == []
