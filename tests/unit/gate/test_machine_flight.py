"""One flight after the other: control, take-off, goals, pictures, missions, and coming down."""

from __future__ import annotations

import pytest

from gcs.gate.effects import CancelCommand, CommandKind, OutcomeKind, Ruling, Say, SendCommand
from gcs.gate.inputs import CommandEnded, MissionLoaded, MissionSeen, PhotoSeen, ReturnHeightSeen
from gcs.gate.refusal import Code
from gcs.gate.requests import (
    Abort,
    Arm,
    Disarm,
    GoTo,
    Hold,
    Land,
    Resume,
    ReturnHome,
    SetMode,
    StartMission,
    TakeControl,
    TakeOff,
    TakePhoto,
)
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.script import MS, Script, policy
from tests.unit.gate.situations import UP, lead_to


def in_state(state: State, autopilot: str = "px4") -> Script:
    script = Script(policy("default"), autopilot)
    lead_to(state, script)
    assert script.gate.state is state
    script.forget()
    return script


class TestControl:
    def test_a_vehicle_that_already_flies_is_external(self) -> None:
        script = Script(policy("default")).fly(UP)
        assert script.gate.state is State.EXTERNAL
        assert script.refusal(script.goto(1.0, 0.0, UP)) is Code.NOT_IN_CONTROL

    def test_ardupilot_is_asked_at_once(self) -> None:
        script = Script(policy("default"), "ardupilot").fly(UP)
        script.ask(TakeControl())
        script.tick()
        assert script.commands() == [CommandKind.GUIDED]

    def test_the_guided_command_carries_a_permit_and_a_deadline(self) -> None:
        script = Script(policy("default"), "ardupilot").fly(UP)
        script.ask(TakeControl())
        script.tick()
        (sent,) = script.all(SendCommand)
        assert sent.permit is not None
        assert sent.deadline_ns == script.now_ns + 5_000 * MS

    def test_control_that_is_not_confirmed_ends_in_hold_and_external(self) -> None:
        script = Script(policy("default")).fly(UP)
        requested = script.ask(TakeControl())
        script.wait(6.1)
        assert script.outcome(requested).kind is OutcomeKind.TIMED_OUT
        assert script.gate.state is State.EXTERNAL
        assert script.commands() == [CommandKind.GUIDED, CommandKind.HOLD]

    def test_guided_that_comes_after_giving_up_is_held(self) -> None:
        script = Script(policy("default")).fly(UP)
        script.ask(TakeControl())
        script.wait(6.1)
        script.forget()
        script.heartbeat(FlightMode.GUIDED)
        assert script.commands() == [CommandKind.HOLD]

    def test_a_vehicle_that_refuses_guided_ends_the_request(self) -> None:
        script = Script(policy("default")).fly(UP)
        requested = script.ask(TakeControl())
        script.wait(1.1)
        script.answer(CommandKind.GUIDED, 1, "no position")
        outcome = script.outcome(requested)
        assert (outcome.kind, outcome.code) == (OutcomeKind.ABORTED, Code.VEHICLE_REFUSED)
        assert "no position" in outcome.sentence
        assert "TEMPORARILY_REJECTED" in outcome.sentence

    def test_on_the_ground_there_is_no_control_to_take(self) -> None:
        script = Script(policy("default")).connect()
        assert script.refusal(script.ask(TakeControl())) is Code.NOT_FLYING
        assert script.gate.control is Control.NONE

    def test_a_mode_that_we_did_not_command_takes_the_vehicle_over(self) -> None:
        script = in_state(State.MOVING)
        script.heartbeat(FlightMode.OTHER)
        assert script.gate.state is State.EXTERNAL
        assert script.gate.control is Control.NONE
        script.forget()
        script.wait(1.0)
        assert not list(script.setpoints())

    @pytest.mark.parametrize(
        ("mode", "state"),
        [(FlightMode.RETURN, State.RETURNING), (FlightMode.LAND, State.LANDING)],
    )
    def test_a_failsafe_of_the_vehicle_is_seen_as_what_it_is(
        self, mode: FlightMode, state: State
    ) -> None:
        script = in_state(State.MOVING)
        script.heartbeat(mode)
        assert script.gate.state is state
        assert script.gate.control is Control.NONE

    def test_the_goal_that_flies_is_taken_over_by_a_mode_change(self) -> None:
        script = in_state(State.HOVERING)
        requested = script.goto(3.0, 0.0, UP)
        script.tick()
        script.heartbeat(FlightMode.HOLD)
        assert script.outcome(requested).kind is OutcomeKind.TAKEN_OVER

    def test_the_old_mode_is_tolerated_while_our_command_is_under_way(self) -> None:
        script = in_state(State.HOVERING)
        requested = script.ask(Land())
        script.heartbeat(FlightMode.GUIDED)
        script.heartbeat(FlightMode.HOLD)
        assert script.gate.state is State.LANDING
        assert not script.ended(requested)


class TestTakeOff:
    def script(self, autopilot: str = "px4") -> Script:
        script = Script(policy("default"), autopilot).connect()
        script.ask(Arm())
        script.heartbeat(armed=True)
        return script

    def test_arm_is_complete_when_the_heartbeat_shows_it(self) -> None:
        script = Script(policy("default")).connect()
        requested = script.ask(Arm())
        script.answer(CommandKind.ARM, 0)
        assert not script.ended(requested)
        script.heartbeat(armed=True)
        assert script.outcome(requested).kind is OutcomeKind.COMPLETE

    def test_not_armed_no_take_off(self) -> None:
        script = Script(policy("default")).connect()
        assert script.refusal(script.ask(TakeOff(2.0))) is Code.NOT_ARMED

    def test_a_climb_that_leaves_the_limits_is_refused(self) -> None:
        script = self.script()
        requested = script.ask(TakeOff(500.0))
        assert script.refusal(requested) is Code.TOO_HIGH
        assert script.gate.state is State.GROUNDED

    def test_it_ends_hovering_under_confirmed_control(self) -> None:
        script = self.script()
        requested = script.ask(TakeOff(2.0))
        assert script.commands()[-1] is CommandKind.TAKE_OFF
        script.heartbeat(FlightMode.TAKEOFF)
        script.land_state(LandedState.TAKEOFF)
        script.at(0.0, 0.0, 1.0, v_enu=(0.0, 0.0, 1.0))
        script.land_state(LandedState.IN_AIR)
        script.tick()
        assert script.gate.state is State.TAKING_OFF
        assert not list(script.setpoints())
        script.at(0.0, 0.0, 2.0)
        script.heartbeat(FlightMode.HOLD)
        script.tick()
        assert (script.gate.state, script.gate.control) == (State.HOVERING, Control.TAKING)
        assert not script.ended(requested)
        script.wait(1.1)
        script.heartbeat(FlightMode.GUIDED)
        assert (script.gate.state, script.gate.control) == (State.MOVING, Control.OURS)
        script.wait(script.policy.arrival.dwell_s)
        assert script.outcome(requested).kind is OutcomeKind.COMPLETE
        assert (script.gate.state, script.gate.control) == (State.HOVERING, Control.OURS)

    def test_the_hold_mode_of_an_old_heartbeat_is_not_the_end_of_the_climb(self) -> None:
        script = self.script()
        script.ask(TakeOff(2.0))
        script.land_state(LandedState.IN_AIR)
        script.at(0.0, 0.0, 0.3, v_enu=(0.0, 0.0, 1.0))
        script.heartbeat(FlightMode.HOLD)
        script.wait(0.5)
        assert script.gate.state is State.TAKING_OFF

    def test_ardupilot_goes_guided_before_it_arms_and_climbs(self) -> None:
        script = Script(policy("default"), "ardupilot").connect()
        arm = script.ask(Arm())
        assert script.commands() == [CommandKind.GUIDED]
        script.heartbeat(FlightMode.GUIDED)
        assert script.commands() == [CommandKind.GUIDED, CommandKind.ARM]
        script.heartbeat(armed=True)
        assert script.outcome(arm).kind is OutcomeKind.COMPLETE
        script.ask(TakeOff(2.0))
        assert script.commands()[-1] is CommandKind.TAKE_OFF

    def test_px4_leaves_land_mode_before_it_arms(self) -> None:
        script = Script(policy("default"))
        script.mode = FlightMode.LAND
        script.connect()
        script.ask(Arm())
        assert script.commands() == [CommandKind.HOLD]
        script.heartbeat(FlightMode.HOLD)
        assert script.commands() == [CommandKind.HOLD, CommandKind.ARM]

    def test_a_take_off_that_nobody_answers_and_comes_late_is_held(self) -> None:
        script = self.script()
        requested = script.ask(TakeOff(2.0))
        script.wait(5.0)
        script.answer(CommandKind.TAKE_OFF, None)
        assert script.outcome(requested).code is Code.NO_ANSWER
        assert script.states()[-1] is State.GROUNDED
        script.land_state(LandedState.IN_AIR)
        assert script.gate.state is State.HOLDING
        assert script.commands()[-1] is CommandKind.HOLD

    def test_a_late_answer_to_arm_is_reported_and_not_acted_on(self) -> None:
        script = Script(policy("default")).connect()
        requested = script.ask(Arm())
        script.wait(5.1)
        assert script.outcome(requested).kind is OutcomeKind.TIMED_OUT
        assert CancelCommand(requested, CommandKind.ARM) in script.all(CancelCommand)
        before = script.gate.memory
        effects = script.feed(CommandEnded(requested, CommandKind.ARM, 0))
        assert script.gate.memory == before
        assert all(isinstance(effect, Say) for effect in effects)

    @pytest.mark.parametrize(
        ("result", "said"),
        [
            (0, "A late answer to arm, not acted on"),
            (None, "No answer to arm, which is waited for no longer: no answer to 2 tries"),
        ],
    )
    def test_silence_is_not_told_as_a_late_answer(self, result: int | None, said: str) -> None:
        script = Script(policy("default")).connect()
        requested = script.ask(Arm())
        script.wait(5.1)
        why = "no answer to 2 tries" if result is None else ""
        effects = script.feed(CommandEnded(requested, CommandKind.ARM, result, why))
        assert [effect.text for effect in effects if isinstance(effect, Say)] == [said]

    def test_abort_before_it_lifts_off_disarms(self) -> None:
        script = self.script()
        take_off = script.ask(TakeOff(2.0))
        abort = script.ask(Abort())
        assert script.outcome(take_off).code is Code.OPERATOR
        assert script.commands()[-1] is CommandKind.DISARM
        script.heartbeat(armed=False)
        assert script.outcome(abort).kind is OutcomeKind.COMPLETE


class TestComingDown:
    def test_a_landing_is_complete_on_the_ground_and_disarmed(self) -> None:
        script = in_state(State.HOVERING)
        requested = script.ask(Land())
        script.heartbeat(FlightMode.LAND)
        script.land_state(LandedState.ON_GROUND)
        assert script.gate.state is State.GROUNDED
        assert not script.ended(requested)
        script.heartbeat(armed=False)
        assert script.outcome(requested).kind is OutcomeKind.COMPLETE

    def test_a_vehicle_that_stays_armed_is_waited_for_shortly(self) -> None:
        script = in_state(State.HOVERING)
        requested = script.ask(Land())
        script.heartbeat(FlightMode.LAND)
        script.land_state(LandedState.ON_GROUND)
        script.wait(3.1)
        assert script.outcome(requested).kind is OutcomeKind.COMPLETE

    def test_a_bounce_goes_on_landing(self) -> None:
        script = in_state(State.HOVERING)
        requested = script.ask(Land())
        script.heartbeat(FlightMode.LAND)
        script.land_state(LandedState.ON_GROUND)
        script.land_state(LandedState.IN_AIR)
        assert script.gate.state is State.LANDING
        assert not script.ended(requested)

    @pytest.mark.parametrize("wanted", [Hold(), Land(), Abort()], ids=["hold", "land", "abort"])
    @pytest.mark.parametrize(
        "state",
        sorted(set(State) - {State.NO_VEHICLE, State.VERIFYING, State.STREAMING}),
        ids=lambda s: s.name,
    )
    def test_never_refused(self, state: State, wanted: Hold | Land | Abort) -> None:
        script = in_state(state)
        assert script.verdict(script.ask(wanted)).ruling is Ruling.ACCEPTED

    def test_in_the_air_nobody_disarms(self) -> None:
        script = in_state(State.EXTERNAL)
        assert script.refusal(script.ask(Disarm())) is Code.IN_AIR
        assert script.refusal(script.ask(Disarm(force=True))) is Code.POLICY

    def test_a_clear_return_is_flown(self) -> None:
        script = in_state(State.MOVING)
        requested = script.ask(ReturnHome())
        assert script.verdict(requested).ruling is Ruling.ACCEPTED
        assert script.commands() == [CommandKind.RETURN]
        script.heartbeat(FlightMode.RETURN)
        script.land_state(LandedState.ON_GROUND)
        script.heartbeat(armed=False)
        assert script.outcome(requested).kind is OutcomeKind.COMPLETE

    def test_a_blocked_return_holds_at_once_and_offers_to_land(self) -> None:
        script = in_state(State.HOVERING)
        script.feed(ReturnHeightSeen(80.0))
        requested = script.ask(ReturnHome())
        refusal = script.verdict(requested).refusal
        assert refusal is not None
        assert refusal.code is Code.RTL_BLOCKED
        assert refusal.zone == "home"
        assert "land instead" in refusal.sentence
        assert script.gate.state is State.HOLDING
        assert script.commands() == [CommandKind.HOLD]

    def test_a_return_while_the_position_is_too_old_is_blocked(self) -> None:
        script = in_state(State.STALE)
        assert script.refusal(script.ask(ReturnHome())) is Code.RTL_BLOCKED


class TestHolding:
    def test_hold_is_repeated_at_1_hz_until_the_heartbeat_shows_it(self) -> None:
        script = in_state(State.MOVING)
        requested = script.ask(Hold())
        script.wait(2.5)
        assert script.commands() == [CommandKind.HOLD] * 3
        script.heartbeat(FlightMode.HOLD)
        assert script.outcome(requested).kind is OutcomeKind.COMPLETE
        script.forget()
        script.wait(3.0)
        assert not script.commands()

    def test_the_held_point_is_streamed_where_it_was_verified(self) -> None:
        script = in_state(State.MOVING)
        script.at(1.0, 0.0, UP)
        script.ask(Hold())
        script.forget()
        script.wait(1.0)
        assert {place for _, place in script.setpoints()} == {(1.0, 0.0, UP)}

    def test_what_somebody_else_flew_is_held_in_silence(self) -> None:
        script = in_state(State.EXTERNAL)
        script.ask(Hold())
        script.wait(1.0)
        assert script.gate.state is State.HOLDING
        assert not list(script.setpoints())

    def test_only_resume_leads_back_to_hovering_and_the_goal_is_gone(self) -> None:
        script = in_state(State.HOLDING)
        assert script.refusal(script.goto(3.0, 0.0, UP)) is Code.HOLDING
        assert script.refusal(script.ask(TakeControl())) is Code.HOLDING
        resume = script.ask(Resume())
        script.wait(1.1)
        script.heartbeat(FlightMode.GUIDED)
        assert script.outcome(resume).kind is OutcomeKind.COMPLETE
        assert script.gate.state is State.HOVERING
        assert script.gate.hold_goal_ned == (0.0, 0.0, -UP)

    def test_our_own_guided_that_comes_after_the_hold_is_held_again(self) -> None:
        script = in_state(State.HOLDING)
        script.ask(Resume())
        script.wait(1.1)
        script.ask(Abort())
        script.heartbeat(FlightMode.HOLD)
        script.forget()
        script.heartbeat(FlightMode.GUIDED)
        assert script.gate.state is State.HOLDING
        assert script.commands() == [CommandKind.HOLD]


class TestPictureAndMission:
    def test_a_picture_that_never_comes_is_timed_out_and_hovering_goes_on(self) -> None:
        script = in_state(State.HOVERING)
        requested = script.ask(TakePhoto())
        script.wait(10.1)
        assert script.outcome(requested).kind is OutcomeKind.TIMED_OUT
        assert script.gate.state is State.HOVERING

    def test_a_camera_that_fails_ends_the_request(self) -> None:
        script = in_state(State.TAKING_PICTURE)
        script.feed(PhotoSeen(0, ok=False))
        assert script.gate.state is State.HOVERING

    def test_without_a_verified_mission_none_is_started(self) -> None:
        script = in_state(State.HOVERING)
        assert script.refusal(script.ask(StartMission())) is Code.NO_MISSION

    def test_control_is_retaken_after_the_last_item(self) -> None:
        script = in_state(State.HOVERING)
        script.feed(MissionLoaded("square", 4))
        requested = script.ask(StartMission())
        script.heartbeat(FlightMode.MISSION)
        script.forget()
        script.wait(1.0)
        assert not list(script.setpoints())
        script.feed(MissionSeen(3, 4, finished=True))
        assert script.gate.state is State.HOVERING
        script.wait(1.1)
        script.heartbeat(FlightMode.GUIDED)
        assert script.outcome(requested).kind is OutcomeKind.COMPLETE

    def test_a_mission_that_ends_in_a_landing_is_complete_on_the_ground(self) -> None:
        script = in_state(State.HOVERING)
        script.feed(MissionLoaded("there and down", 4))
        requested = script.ask(StartMission())
        script.heartbeat(FlightMode.MISSION)
        script.heartbeat(FlightMode.LAND)
        assert script.gate.state is State.LANDING
        assert not script.ended(requested)
        script.land_state(LandedState.ON_GROUND)
        script.heartbeat(armed=False)
        assert script.outcome(requested).kind is OutcomeKind.COMPLETE

    def test_a_mission_that_somebody_pauses_is_taken_over(self) -> None:
        script = in_state(State.FLYING_MISSION)
        script.heartbeat(FlightMode.HOLD)
        assert script.gate.state is State.EXTERNAL

    def test_a_mode_by_its_name_is_the_request_it_means(self) -> None:
        script = in_state(State.MOVING)
        requested = script.ask(SetMode("AUTO.LAND", FlightMode.LAND))
        assert script.verdict(requested).ruling is Ruling.ACCEPTED
        assert script.commands() == [CommandKind.LAND]
        assert script.refusal(script.ask(SetMode("ACRO", FlightMode.OTHER))) is Code.UNSUPPORTED

    def test_a_goal_that_takes_too_long_is_held_and_timed_out(self) -> None:
        script = in_state(State.HOVERING)
        requested = script.ask(GoTo((0.0, 3.0, -UP)))
        script.wait(20.2)
        assert script.outcome(requested).kind is OutcomeKind.TIMED_OUT
        assert script.gate.state is State.HOLDING
        assert CommandKind.HOLD in script.commands()
