"""What is not known for certain: late positions, an old landed state, a fence that moves."""

from __future__ import annotations

from dataclasses import replace

import pytest

from gcs.frames import ned_from_enu
from gcs.gate.airspace.verifier import Verifier, verifier_for
from gcs.gate.airspace.zones import Zone
from gcs.gate.effects import CommandKind, OutcomeKind, Ruling, Say
from gcs.gate.geometry import Circle
from gcs.gate.inputs import (
    CommandEnded,
    HomeSeen,
    MissionLoaded,
    OperatorLost,
    PhotoSeen,
    PositionSeen,
    VerifierChanged,
)
from gcs.gate.refusal import Code
from gcs.gate.requests import (
    Abort,
    Arm,
    Disarm,
    Hold,
    Land,
    Request,
    Resume,
    ReturnHome,
    StartMission,
    SwitchFence,
    TakeControl,
    TakeOff,
    TakePhoto,
)
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.script import MS, SECOND, Script, policy
from tests.unit.gate.situations import UP, lead_to


def in_state(state: State, autopilot: str = "px4") -> Script:
    script = Script(policy("default"), autopilot)
    lead_to(state, script)
    assert script.gate.state is state
    script.forget()
    return script


def armed(autopilot: str = "px4") -> Script:
    """On the ground, armed."""
    script = Script(policy("default"), autopilot).connect()
    script.ask(Arm())
    script.heartbeat(armed=True)
    script.wait(1.0)
    return script


def climbing(up: float = 10.0) -> Script:
    """A take-off to `up` that was commanded and shown, and nothing seen of it yet."""
    script = armed()
    script.ask(TakeOff(up))
    script.heartbeat(FlightMode.TAKEOFF)
    return script


class TestSlowPositions:
    """Slower than the policy's age, faster than age and grace: each arrives in STALE."""

    @pytest.mark.parametrize("period_s", [0.5, 1.1, 1.3, 1.45])
    @pytest.mark.parametrize("state", [State.MOVING, State.HOVERING, State.FLYING_MISSION])
    def test_every_sample_is_predicted(self, state: State, period_s: float) -> None:
        script = in_state(state)
        script.reports_position = False
        east = 0.0
        while east < 150.0 and script.gate.state is not State.HOLDING:
            script.wait(period_s)
            east += 8.0 * period_s
            script.pos_ned, script.v_ned = ned_from_enu((east, 0.0, UP)), (0.0, 8.0, 0.0)
            script.position()
        assert script.gate.state is State.HOLDING
        script.wait(2.0)  # setpoints stop it in 0.3 s + 8 / 5 s
        assert CommandKind.HOLD in script.commands()
        assert all(place[0] < 150.0 for _, place in script.setpoints())

    def test_the_brake_leaves_with_the_sample_that_comes_late(self) -> None:
        script = in_state(State.HOVERING)
        goto = script.goto(100.0, 0.0, UP)
        script.at(100.0, 0.0, UP, (12.0, 0.0, 0.0))
        script.reports_position = False
        script.wait(1.2)
        assert script.gate.state is State.STALE
        script.forget()
        script.pos_ned = ned_from_enu((134.0, 0.0, UP))
        script.position()
        assert script.commands() == []
        assert len(list(script.setpoints())) == 1
        assert script.states() == [State.HOLDING]
        assert script.outcome(goto).code is Code.FENCE_BREACH
        script.wait(2.75)  # setpoints stop it in 0.3 s + 12 / 5 s
        assert set(script.commands()) == {CommandKind.HOLD}


class TestLandedState:
    def test_it_ages_while_the_vehicle_is_heard(self) -> None:
        script = armed()
        script.reports_landed = False
        script.wait(4.0)
        assert script.gate.memory.landed is LandedState.UNDEFINED
        assert script.gate.state is State.GROUNDED

    @pytest.mark.parametrize(
        ("wanted", "command", "state"),
        [
            (Hold(), CommandKind.HOLD, State.HOLDING),
            (Abort(), CommandKind.HOLD, State.HOLDING),
            (Land(), CommandKind.LAND, State.LANDING),
            (ReturnHome(), CommandKind.RETURN, State.RETURNING),
        ],
        ids=["hold", "abort", "land", "return"],
    )
    def test_armed_and_not_known_to_stand_is_commanded_and_not_complete_at_once(
        self, wanted: Request, command: CommandKind, state: State
    ) -> None:
        script = armed()
        script.reports_landed = False
        script.wait(4.0)
        script.forget()
        requested = script.ask(wanted)
        assert script.commands() == [command]
        assert script.gate.state is state
        assert not script.ended(requested)

    def test_what_climbed_does_not_stand_whatever_was_reported_last(self) -> None:
        script = armed()
        script.reports_landed = False
        script.at(0.0, 0.0, 0.8)
        script.forget()
        requested = script.ask(Hold())
        assert script.commands() == [CommandKind.HOLD]
        assert not script.ended(requested)

    @pytest.mark.parametrize("wanted", [Land(), ReturnHome()], ids=["land", "rtl"])
    def test_what_is_reported_to_stand_has_nothing_left_to_do(self, wanted: Request) -> None:
        script = armed()
        assert script.outcome(script.ask(wanted)).kind is OutcomeKind.COMPLETE

    def test_abort_in_a_climb_whose_landed_state_is_lost_holds(self) -> None:
        script = climbing()
        script.reports_landed = False
        script.at(0.0, 0.0, 1.0)
        script.forget()
        script.ask(Abort())
        assert script.commands() == [CommandKind.HOLD]
        assert script.gate.state is State.HOLDING

    def test_abort_before_the_lift_off_is_seen_holds_as_well_as_it_disarms(self) -> None:
        script = climbing()
        script.forget()
        abort = script.ask(Abort())
        assert script.commands() == [CommandKind.HOLD, CommandKind.DISARM]
        script.heartbeat(FlightMode.HOLD)
        assert not script.ended(abort)
        script.heartbeat(armed=False)
        assert script.outcome(abort).kind is OutcomeKind.COMPLETE

    def test_a_disarm_refused_in_the_air_is_a_hold(self) -> None:
        script = armed()
        script.reports_landed = False
        script.wait(4.0)
        disarm = script.ask(Disarm())
        script.forget()
        script.feed(CommandEnded(disarm, CommandKind.DISARM, 4))
        assert script.outcome(disarm).code is Code.VEHICLE_REFUSED
        assert script.commands() == [CommandKind.HOLD]
        assert script.gate.state is State.HOLDING

    def test_a_hold_after_a_take_off_that_nobody_answered_is_commanded(self) -> None:
        script = climbing()
        script.heartbeat(FlightMode.HOLD)
        script.answer(CommandKind.TAKE_OFF, None)
        assert script.gate.state is State.GROUNDED
        assert script.commands()[-2:] == [CommandKind.HOLD, CommandKind.DISARM]
        script.forget()
        hold = script.ask(Hold())
        assert script.commands() == [CommandKind.HOLD]
        assert not script.ended(hold)

    def test_no_take_off_from_what_is_not_known_to_stand(self) -> None:
        script = armed()
        script.reports_landed = False
        script.wait(4.0)
        assert script.refusal(script.ask(TakeOff(2.0))) is Code.IN_AIR


def elsewhere(script: Script, east: float = 500.0) -> Verifier:
    """The same fence about another home."""
    home_ned = ned_from_enu((east, 0.0, 0.0))
    return verifier_for(script.policy, script.autopilot, home_ned, None)


class TestMovedFence:
    def test_a_goal_that_clears_no_more_is_held_with_the_reason(self) -> None:
        script = in_state(State.HOVERING)
        goto = script.goto(100.0, 0.0, UP)
        script.wait(0.5)
        script.feed(VerifierChanged(elsewhere(script, -100.0)))
        outcome = script.outcome(goto)
        assert (outcome.kind, outcome.code) == (OutcomeKind.ABORTED, Code.OUTSIDE_FENCE)
        assert script.gate.state is State.HOLDING
        assert script.commands() == [CommandKind.HOLD]

    def test_the_fence_switched_on_again_stops_a_flight_outside(self) -> None:
        script = Script(policy("lab")).take_control(0.5)
        script.ask(SwitchFence(on=False))
        goto = script.goto(30.0, 0.0, 1.0)
        script.tick()
        assert script.states()[-1] is State.MOVING
        script.ask(SwitchFence(on=True))
        assert script.outcome(goto).kind is OutcomeKind.ABORTED
        assert script.gate.state is State.HOLDING

    def test_a_hover_outside_the_new_fence_streams_nothing_more(self) -> None:
        script = in_state(State.HOVERING)
        script.feed(VerifierChanged(elsewhere(script)))
        assert script.gate.state is State.HOLDING
        script.forget()
        script.wait(1.0)
        assert not list(script.setpoints())

    def test_a_mission_flies_on_only_in_the_fence_that_it_was_verified_by(self) -> None:
        script = in_state(State.FLYING_MISSION)
        tower = Zone("tower", False, Circle((90.0, 90.0), 5.0), 0.0, 20.0)
        verifier = elsewhere(script, 0.0)
        script.feed(VerifierChanged(replace(verifier, zones=(*verifier.zones, tower))))
        assert script.gate.state is State.HOLDING

    def test_the_same_fence_told_again_changes_nothing(self) -> None:
        script = in_state(State.MOVING)
        script.place()
        assert script.gate.state is State.MOVING

    @pytest.mark.parametrize("state", [State.HOVERING, State.MOVING, State.RETURNING])
    def test_home_that_moves_in_flight_holds_and_is_told(self, state: State) -> None:
        script = in_state(state)
        script.feed(HomeSeen((0.0, 2.0, 0.0)))
        assert script.gate.state is State.HOLDING
        assert script.commands() == [CommandKind.HOLD]
        assert "Home moved by 2.0 m while the vehicle flies" in [s.text for s in script.all(Say)]

    def test_arming_moves_home_by_centimetres(self) -> None:
        script = in_state(State.MOVING)
        script.feed(HomeSeen((0.05, 0.0, 0.0)))
        assert script.gate.state is State.MOVING


class TestOperatorGone:
    @pytest.mark.parametrize(
        "wanted", [Resume(), TakeControl(), ReturnHome(), Arm(), TakeOff(2.0), TakePhoto()]
    )
    @pytest.mark.parametrize("state", [State.HOVERING, State.GROUNDED, State.EXTERNAL])
    def test_nothing_withdraws_the_hold(self, state: State, wanted: Request) -> None:
        script = in_state(state)
        script.feed(OperatorLost("quit"))
        script.heartbeat(FlightMode.HOLD)
        after = script.gate.state
        assert script.refusal(script.ask(wanted)) is Code.OPERATOR_LOST
        assert script.gate.state is after

    @pytest.mark.parametrize("wanted", [Abort(), Hold(), Land()], ids=["abort", "hold", "land"])
    def test_what_makes_it_safer_is_heard(self, wanted: Request) -> None:
        script = in_state(State.HOVERING)
        script.feed(OperatorLost("quit"))
        assert script.verdict(script.ask(wanted)).ruling is Ruling.ACCEPTED

    def test_so_is_a_disarm_on_the_ground(self) -> None:
        script = in_state(State.GROUNDED)
        script.feed(OperatorLost("quit"))
        assert script.verdict(script.ask(Disarm())).ruling is Ruling.ACCEPTED


class TestClimb:
    def test_hold_mode_far_below_the_height_is_no_take_off(self) -> None:
        script = climbing(10.0)
        take_off = script._next_id
        script.land_state(LandedState.IN_AIR)
        script.at(0.0, 0.0, 4.0)
        script.heartbeat(FlightMode.HOLD)
        script.tick()
        outcome = script.outcome(take_off)
        assert (outcome.kind, outcome.code) == (OutcomeKind.ABORTED, Code.VEHICLE_REFUSED)
        assert "6.0 m below the height" in outcome.sentence
        assert script.gate.state is State.HOLDING
        assert script.gate.hold_goal_ned == (0.0, 0.0, -4.0)

    def test_hold_mode_shown_while_it_still_climbs_is_waited_out(self) -> None:
        script = climbing(10.0)
        script.land_state(LandedState.IN_AIR)
        script.at(0.0, 0.0, 9.0, v_enu=(0.0, 0.0, 0.8))
        script.heartbeat(FlightMode.HOLD)
        script.tick()
        assert script.gate.state is State.TAKING_OFF
        script.at(0.0, 0.0, 9.8)
        script.tick()
        assert (script.gate.state, script.gate.control) == (State.HOVERING, Control.TAKING)

    def test_higher_than_verified_is_held(self) -> None:
        script = climbing(5.0)
        take_off = script._next_id
        script.land_state(LandedState.IN_AIR)
        script.v_ned = (0.0, 0.0, -1.0)
        script.at(0.0, 0.0, 6.8, v_enu=(0.0, 0.0, 1.0))
        script.tick()
        assert script.outcome(take_off).code is Code.TOO_HIGH
        assert script.gate.state is State.HOLDING


class TestClockOfTheVehicle:
    def test_a_stamp_far_ahead_hides_no_jump(self) -> None:
        script = in_state(State.HOVERING)
        script.now_ns += 50 * MS
        script.feed(PositionSeen(ned_from_enu((40.0, 0.0, UP)), (0.0, 0.0, 0.0), 2**32 - 1))
        assert script.gate.state is State.HOLDING

    def test_samples_that_queued_and_come_at_once_are_no_jump(self) -> None:
        script = in_state(State.MOVING)
        script.now_ns += SECOND // 2
        first_ms = script.now_ns // MS - 400
        for i in range(4):
            east = 1.5 * i
            place = ned_from_enu((east, 0.0, UP))
            script.feed(PositionSeen(place, (0.0, 15.0, 0.0), first_ms + 100 * i))
        assert script.gate.state is State.MOVING


class TestPictures:
    def test_a_picture_seen_before_ours_was_asked_for_is_not_ours(self) -> None:
        script = in_state(State.HOVERING)
        script.feed(PhotoSeen(7, ok=True))
        photo = script.ask(TakePhoto())
        script.feed(PhotoSeen(7, ok=True))
        assert not script.ended(photo)
        script.feed(PhotoSeen(8, ok=True))
        assert script.outcome(photo).kind is OutcomeKind.COMPLETE


class TestWords:
    def test_a_refused_mode_is_called_by_its_name(self) -> None:
        script = in_state(State.EXTERNAL)
        requested = script.ask(TakeControl())
        script.wait(1.1)
        script.answer(CommandKind.GUIDED, 4)
        assert script.outcome(requested).sentence == "the vehicle refused guided mode (FAILED)"

    def test_a_hold_that_nobody_answers_is_told_once(self) -> None:
        script = in_state(State.MOVING)
        script.ask(Hold())
        for _ in range(3):
            script.answer(CommandKind.HOLD, None)
            script.wait(1.0)
        told = [s.text for s in script.all(Say) if s.text.startswith("No answer")]
        assert told == ["No answer to the request for hold mode"]

    def test_one_that_is_answered_neither_now_nor_later_is_told_once_too(self) -> None:
        """The command's last try may end after the hold was commanded anew."""
        script = in_state(State.MOVING)
        script.ask(Hold())
        for _ in range(3):
            script.answer(CommandKind.HOLD, None)
            script.answer(CommandKind.HOLD, None)
            script.wait(1.0)
        assert len([s for s in script.all(Say) if s.text.startswith("No answer")]) == 1


def test_a_mission_waits_for_a_vehicle_that_is_known_to_stand() -> None:
    script = armed()
    script.feed(MissionLoaded("square", 4))
    script.reports_landed = False
    script.wait(4.0)
    assert script.refusal(script.ask(StartMission())) is Code.IN_AIR
