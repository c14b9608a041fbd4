"""Arming, and modes that are asked for, on the ground: sent, and complete when they are seen."""

from __future__ import annotations

import pytest

from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import CancelCommand, CommandKind, Ruling
from gcs.gate.inputs import CommandEnded, ConditionChanged, OperatorLost
from gcs.gate.refusal import Code
from gcs.gate.requests import (
    Abort,
    Arm,
    BeginStream,
    Disarm,
    GoTo,
    Hold,
    Land,
    Request,
    ReturnHome,
    SetMode,
    SwitchFence,
    TakeControl,
    TakeOff,
)
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.reactions import default_policy, ended, state_of
from tests.unit.gate.script import Script, policy

HOLD, ARM = CommandKind.HOLD, CommandKind.ARM


def landed_in(mode: FlightMode) -> Script:
    """A px4 on the ground, disarmed, in `mode`."""
    script = Script(policy("default"))
    script.mode = mode
    script.connect()
    script.heartbeat(mode)
    script.land_state(LandedState.ON_GROUND)
    script.forget()
    return script


class TestArmingFromOffboard:
    """autopilots.md 2: PX4 is in OFFBOARD again after a flight in it, and does not arm there."""

    def test_it_is_left_and_seen_left_first(self) -> None:
        script = landed_in(FlightMode.GUIDED)
        request_id = script.ask(Arm())
        script.answer(HOLD, 0)
        script.heartbeat(FlightMode.GUIDED)
        assert script.commands() == [HOLD]
        script.heartbeat(FlightMode.HOLD)
        assert script.commands() == [HOLD, ARM]
        script.heartbeat(armed=True)
        assert ended(script, request_id) == "complete"
        script.forget()
        script.wait(3.0)
        assert script.commands() == []

    def test_the_mode_is_asked_for_until_it_is_seen(self) -> None:
        script = landed_in(FlightMode.GUIDED)
        script.ask(Arm())
        script.wait(3.5)
        assert script.commands() == [HOLD] * 4

    def test_the_deadline_ends_it(self) -> None:
        script = landed_in(FlightMode.GUIDED)
        request_id = script.ask(Arm())
        script.wait(5.1)
        assert ended(script, request_id) == "timed out NO_ANSWER"
        script.forget()
        script.wait(3.0)
        assert script.commands() == []

    def test_a_refusal_of_the_mode_is_told_at_once(self) -> None:
        """station.md, bug 12: it was NO_ANSWER after five seconds."""
        script = landed_in(FlightMode.GUIDED)
        request_id = script.ask(Arm())
        script.answer(HOLD, 2)
        assert ended(script, request_id) == "aborted VEHICLE_REFUSED"
        script.forget()
        script.wait(3.0)
        assert script.commands() == []


class TestArmingWithoutAPosition:
    """autopilots.md 9: an estimator that starts has no position yet."""

    def started(self, autopilot: str = "px4") -> Script:
        script = Script(policy("default"), autopilot)
        script.reports_position = False
        script.place()
        script.heartbeat()
        script.tick()
        assert state_of(script) is State.STALE
        return script

    @pytest.mark.parametrize("request_", [TakeOff(2.0), GoTo((0.0, 0.0, -2.0))])
    def test_no_position_yet_is_not_one_too_old(self, request_: Request) -> None:
        script = self.started()
        verdict = script.verdict(script.ask(request_))
        assert verdict.refusal is not None
        assert verdict.refusal.code is Code.NO_POSITION
        assert "no position yet (the estimator is starting)" in verdict.refusal.sentence

    def test_arming_waits_for_it(self) -> None:
        script = self.started()
        request_id = script.ask(Arm())
        script.wait(40.0)
        assert (script.commands(), ended(script, request_id)) == ([], "")
        script.reports_position = True
        script.tick()
        assert (state_of(script), script.commands()) == (State.GROUNDED, [ARM])
        script.heartbeat(armed=True)
        assert ended(script, request_id) == "complete"

    def test_ardupilot_is_put_into_guided_when_it_comes(self) -> None:
        script = self.started("ardupilot")
        script.ask(Arm())
        script.reports_position = True
        script.tick()
        assert script.commands() == [CommandKind.GUIDED]
        script.heartbeat(FlightMode.GUIDED)
        assert script.commands() == [CommandKind.GUIDED, ARM]

    def test_for_as_long_as_the_policy_says(self) -> None:
        script = self.started()
        request_id = script.ask(Arm())
        script.wait(script.policy.arm_timeout_s + 0.1)
        assert ended(script, request_id) == "timed out NO_POSITION"
        assert script.commands() == []

    def test_a_position_that_was_there_and_is_too_old_is_not_waited_for(self) -> None:
        script = landed_in(FlightMode.HOLD)
        script.reports_position = False
        script.wait(1.2)
        assert script.refusal(script.ask(Arm())) is Code.STALE

    def test_a_second_request_finds_it_busy(self) -> None:
        script = self.started()
        script.ask(Arm())
        assert script.refusal(script.ask(Arm())) is Code.BUSY

    @pytest.mark.parametrize("stop", [Hold(), Abort()])
    def test_a_stop_ends_the_wait(self, stop: Request) -> None:
        script = self.started()
        request_id = script.ask(Arm())
        script.ask(stop)
        assert ended(script, request_id) == "aborted OPERATOR"
        script.reports_position = True
        script.wait(1.0)
        assert ARM not in script.commands()

    def test_so_do_severity_and_a_lost_operator(self) -> None:
        script = Script(default_policy(severities=dict.fromkeys(Condition, Severity.HOLD)))
        script.reports_position = False
        script.place()
        script.heartbeat()
        request_id = script.ask(Arm())
        script.feed(ConditionChanged(Condition.BATTERY_LOW, True))
        assert ended(script, request_id) == "aborted SEVERITY"
        script = self.started()
        request_id = script.ask(Arm())
        script.feed(OperatorLost("quit"))
        assert ended(script, request_id) == "aborted OPERATOR_LOST"


class TestHoldMode:
    """autopilots.md 2: `mode LOITER` on the ground was complete, and nothing was sent."""

    @pytest.mark.parametrize("asked", [Hold(), SetMode("AUTO.LOITER", FlightMode.HOLD)])
    def test_it_is_sent_and_complete_when_it_is_seen(self, asked: Request) -> None:
        script = landed_in(FlightMode.GUIDED)
        request_id = script.ask(asked)
        script.answer(HOLD, 0)
        assert (script.commands(), ended(script, request_id)) == ([HOLD], "")
        script.heartbeat(FlightMode.HOLD)
        assert (state_of(script), ended(script, request_id)) == (State.GROUNDED, "complete")

    def test_so_it_is_without_a_position(self) -> None:
        script = landed_in(FlightMode.GUIDED)
        script.reports_position = False
        script.wait(1.2)
        script.forget()
        request_id = script.ask(Hold())
        script.heartbeat(FlightMode.HOLD)
        assert script.commands() == [HOLD]
        assert (state_of(script), ended(script, request_id)) == (State.STALE, "complete")

    def test_a_refusal_ends_it_where_it_stands(self) -> None:
        script = landed_in(FlightMode.GUIDED)
        request_id = script.ask(Hold())
        script.answer(HOLD, 2)
        assert ended(script, request_id) == "aborted VEHICLE_REFUSED"
        script.forget()
        script.wait(3.0)
        assert script.commands() == []


class TestModesThatAreNotSent:
    @pytest.mark.parametrize(
        ("asked", "words"),
        [
            (SetMode("LOITER", FlightMode.OTHER, "BRAKE"), "this station sends BRAKE in its place"),
            (SetMode("ACRO", FlightMode.OTHER), "no key of the policy allows it"),
            (SetMode("AUTO.TAKEOFF", FlightMode.TAKEOFF), "`takeoff` climbs to a height"),
        ],
    )
    def test_the_refusal_says_why(self, asked: SetMode, words: str) -> None:
        script = landed_in(FlightMode.HOLD)
        refusal = script.verdict(script.ask(asked)).refusal
        assert refusal is not None
        assert refusal.code is Code.UNSUPPORTED
        assert words in refusal.sentence

    @pytest.mark.parametrize(
        "asked",
        [
            SetMode("AUTO.LAND", FlightMode.LAND),
            SetMode("AUTO.RTL", FlightMode.RETURN),
            SetMode("OFFBOARD", FlightMode.GUIDED),
        ],
    )
    def test_modes_of_flight_are_refused_on_the_ground(self, asked: SetMode) -> None:
        script = landed_in(FlightMode.HOLD)
        request_id = script.ask(asked)
        assert script.refusal(request_id) is Code.NOT_FLYING
        assert not script.ended(request_id)
        assert script.commands() == []


class TestWhatIsSoAlready:
    @pytest.mark.parametrize(
        ("request_", "sentence"),
        [
            (Land(), "the vehicle stands on the ground"),
            (ReturnHome(), "the vehicle stands on the ground"),
            (Disarm(), "the vehicle is disarmed already"),
            (Disarm(force=True), "the vehicle is disarmed already"),
            (Abort(), "the vehicle stands on the ground, disarmed"),
        ],
    )
    def test_is_said(self, request_: Request, sentence: str) -> None:
        script = landed_in(FlightMode.HOLD)
        assert script.outcome(script.ask(request_)).sentence == sentence

    def test_armed(self) -> None:
        script = landed_in(FlightMode.HOLD)
        script.heartbeat(armed=True)
        assert script.outcome(script.ask(Arm())).sentence == "the vehicle is armed already"

    @pytest.mark.parametrize(
        ("on", "sentence"), [(True, "the fence is on"), (False, "the fence is off")]
    )
    def test_the_fence(self, on: bool, sentence: str) -> None:
        script = Script(default_policy(fence_switchable=True)).connect()
        assert script.outcome(script.ask(SwitchFence(on))).sentence == sentence


class TestKeysOfThePolicy:
    """newcomer.md 22: a refusal by the policy names its key."""

    def test_fence(self) -> None:
        script = landed_in(FlightMode.HOLD)
        refusal = script.verdict(script.ask(SwitchFence(False))).refusal
        assert refusal is not None
        assert refusal.sentence == "the policy does not allow it: fence_switchable = false"

    def test_forced_disarm(self) -> None:
        script = Script(policy("default")).fly(2.0)
        refusal = script.verdict(script.ask(Disarm(force=True))).refusal
        assert refusal is not None
        assert refusal.sentence.endswith("in the air: allow_force_disarm = false")

    def test_recorder(self) -> None:
        script = Script(default_policy(arm_requires_recording=True)).connect()
        script.feed(ConditionChanged(Condition.RECORDER_FAILED, True))
        refusal = script.verdict(script.ask(Arm())).refusal
        assert refusal is not None
        assert refusal.sentence.endswith("arm_requires_recording = true")

    def test_another_goal(self) -> None:
        script = Script(policy("default")).take_control(2.0)
        script.goto(9.0, 0.0, 2.0)
        script.tick()
        verdict = script.verdict(script.goto(3.0, 0.0, 2.0))
        assert verdict.ruling is Ruling.REFUSED
        assert verdict.refusal is not None
        assert verdict.refusal.sentence.endswith('(policy: retarget = "clients")')

    @pytest.mark.parametrize("asked", [GoTo((0.0, 3.0, -2.0)), BeginStream()])
    def test_another_operators_goal_is_not_replaced(self, asked: Request) -> None:
        """The key that it would cite is the one that lets an operator replace its own."""
        script = Script(default_policy(retarget="replace")).take_control(2.0)
        script.goto(9.0, 0.0, 2.0)
        script.tick()
        refusal = script.verdict(script.ask(asked, source="somebody else")).refusal
        assert refusal is not None
        assert refusal.code is Code.BUSY
        assert refusal.sentence.startswith("another operator's request is flown: MOVING, goal")
        assert "hold it first, or wait for its end" in refusal.sentence

    def test_a_stream_that_does_not_begin_before_ones_own_goal_is_decided(self) -> None:
        script = Script(default_policy(retarget="replace")).take_control(2.0)
        script.goto(9.0, 0.0, 2.0)
        script.tick()
        script.goto(5.0, 0.0, 2.0)
        refusal = script.verdict(script.ask(BeginStream())).refusal
        assert refusal is not None
        assert refusal.sentence.startswith("another request is under way: MOVING, goal")
        assert "retarget" not in refusal.sentence


def test_arming_has_its_whole_time_after_the_mode_that_it_needs() -> None:
    """A PX4 that refuses again and again ends it, not the time that the mode took."""
    script = landed_in(FlightMode.LAND)
    request_id = script.ask(Arm())
    script.wait(4.0)
    script.heartbeat(mode=FlightMode.HOLD)
    script.wait(4.0)
    assert (script.commands()[-1], ended(script, request_id)) == (ARM, "")
    script.feed(CommandEnded(request_id, ARM, 1, "High Accelerometer Bias"))
    ending = script.outcome(request_id)
    assert (ending.code, "High Accelerometer Bias" in ending.sentence) == (
        Code.VEHICLE_REFUSED,
        True,
    )


def test_an_arming_that_is_taken_back_is_not_sent_again() -> None:
    script = landed_in(FlightMode.HOLD)
    request_id = script.ask(Arm())
    script.ask(Hold())
    assert CancelCommand(request_id, ARM) in script.all(CancelCommand)


class TestArmingAgainInGuided:
    """An ArduCopter keeps a take-off that it was told in GUIDED until it leaves that mode, over a
    disarming too (from memory of its source), so a guided mode in which it was armed is left."""

    def armed_once(self) -> Script:
        """It was armed in GUIDED, and stands there disarmed."""
        script = Script(policy("default"), "ardupilot")
        script.mode = FlightMode.OTHER
        script.connect()
        script.heartbeat(FlightMode.GUIDED, armed=False)
        script.heartbeat(armed=True)
        script.heartbeat(armed=False)
        script.forget()
        return script

    def test_it_is_left_and_entered_again_first(self) -> None:
        script = self.armed_once()
        request_id = script.ask(Arm())
        assert script.commands() == [HOLD]
        script.answer(HOLD, 0)
        script.heartbeat(FlightMode.HOLD)
        assert script.commands() == [HOLD, CommandKind.GUIDED]
        script.answer(CommandKind.GUIDED, 0)
        script.heartbeat(FlightMode.GUIDED)
        assert script.commands() == [HOLD, CommandKind.GUIDED, ARM]
        script.heartbeat(armed=True)
        assert ended(script, request_id) == "complete"
        script.forget()
        script.wait(3.0)
        assert script.commands() == []

    def test_a_guided_mode_that_was_entered_since_is_a_new_one(self) -> None:
        script = self.armed_once()
        script.heartbeat(FlightMode.OTHER)
        script.heartbeat(FlightMode.GUIDED)
        script.ask(Arm())
        assert script.commands() == [ARM]

    def test_what_it_was_told_before_it_was_heard_nobody_knows(self) -> None:
        script = Script(policy("default"), "ardupilot")
        script.mode = FlightMode.GUIDED
        script.connect()
        script.forget()
        script.ask(Arm())
        assert script.commands() == [HOLD]

    def test_nor_while_it_was_lost(self) -> None:
        script = Script(policy("default"), "ardupilot")
        script.mode = FlightMode.OTHER
        script.connect()
        script.heartbeat(FlightMode.GUIDED)
        script.reports_heartbeat = False
        script.wait(6.0)
        script.heartbeat()
        script.land_state(LandedState.ON_GROUND)
        script.tick()
        script.forget()
        script.ask(Arm())
        assert script.commands() == [HOLD]

    def test_the_deadline_ends_it(self) -> None:
        script = self.armed_once()
        request_id = script.ask(Arm())
        script.wait(3.0)
        script.heartbeat(FlightMode.HOLD)
        script.wait(2.1)
        assert ended(script, request_id) == "timed out NO_ANSWER"
        script.heartbeat(FlightMode.GUIDED)
        assert ARM not in script.commands()

    def test_a_hold_that_is_refused_ends_it(self) -> None:
        script = self.armed_once()
        request_id = script.ask(Arm())
        script.answer(HOLD, 4)
        assert ended(script, request_id) == "aborted VEHICLE_REFUSED"

    def test_px4_has_no_such_mode(self) -> None:
        script = landed_in(FlightMode.HOLD)
        script.heartbeat(armed=True)
        script.heartbeat(armed=False)
        script.ask(Arm())
        assert script.commands() == [ARM]


class TestGuidedByItsName:
    """Clients of an ArduCopter set GUIDED before they arm: it moves nothing on the ground.  px4's
    OFFBOARD flies what a stream sends, and is not set there."""

    GUIDED = SetMode("guided", FlightMode.GUIDED)

    def standing(self, autopilot: str) -> Script:
        script = Script(policy("default"), autopilot).connect()
        script.forget()
        return script

    def test_it_is_sent_and_complete_when_it_is_seen(self) -> None:
        script = self.standing("ardupilot")
        request_id = script.ask(self.GUIDED)
        assert script.verdict(request_id).ruling is Ruling.ACCEPTED
        assert script.commands() == [CommandKind.GUIDED]
        script.answer(CommandKind.GUIDED, 0)
        assert ended(script, request_id) == ""
        script.heartbeat(FlightMode.GUIDED)
        assert (state_of(script), ended(script, request_id)) == (State.GROUNDED, "complete")
        assert script.gate.control is Control.NONE

    def test_an_armed_vehicle_on_the_ground_takes_it_too(self) -> None:
        script = self.standing("ardupilot")
        script.heartbeat(armed=True)
        script.ask(self.GUIDED)
        assert script.commands() == [CommandKind.GUIDED]

    def test_where_it_is_shown_nothing_is_sent(self) -> None:
        script = self.standing("ardupilot")
        script.heartbeat(FlightMode.GUIDED)
        assert ended(script, script.ask(self.GUIDED)) == "complete"
        assert script.commands() == []

    def test_a_refusal_of_the_vehicle_ends_it(self) -> None:
        script = self.standing("ardupilot")
        request_id = script.ask(self.GUIDED)
        script.answer(CommandKind.GUIDED, 4)
        assert ended(script, request_id) == "aborted VEHICLE_REFUSED"

    def test_without_a_heartbeat_that_shows_it_it_times_out(self) -> None:
        script = self.standing("ardupilot")
        request_id = script.ask(self.GUIDED)
        script.answer(CommandKind.GUIDED, 0)
        script.wait(5.1)
        assert ended(script, request_id) == "timed out NO_ANSWER"

    def test_another_request_under_way_is_not_replaced(self) -> None:
        script = self.standing("ardupilot")
        script.ask(Arm())
        assert script.refusal(script.ask(self.GUIDED)) is Code.BUSY

    def test_control_that_is_not_asked_for_by_the_mode_is_refused_as_before(self) -> None:
        script = self.standing("ardupilot")
        assert script.refusal(script.ask(TakeControl())) is Code.NOT_FLYING

    def test_px4_is_not_set_to_offboard_on_the_ground(self) -> None:
        script = self.standing("px4")
        assert script.refusal(script.ask(self.GUIDED)) is Code.NOT_FLYING
        assert script.commands() == []

    @pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
    def test_a_hold_mode_is_set_on_the_ground_of_either(self, autopilot: str) -> None:
        script = self.standing(autopilot)
        script.heartbeat(FlightMode.OTHER)
        request_id = script.ask(SetMode("hold", FlightMode.HOLD))
        assert script.commands() == [HOLD]
        script.heartbeat(FlightMode.HOLD)
        assert ended(script, request_id) == "complete"
