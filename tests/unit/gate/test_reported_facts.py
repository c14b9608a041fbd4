"""What a report means: which samples are positions, what is a jump, what stands, what is new."""

from __future__ import annotations

import math

import pytest

from gcs.gate.condition import Condition
from gcs.gate.effects import CommandKind, Say
from gcs.gate.inputs import (
    CommandEnded,
    ConditionChanged,
    HomeSeen,
    LandedSeen,
    MissionLoaded,
    MissionSeen,
    PhotoSeen,
    PositionSeen,
)
from gcs.gate.requests import Abort, Disarm, Hold, Land, TakeControl
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.reactions import (
    STILL,
    flight,
    reaction,
    state_of,
    take_off,
)
from tests.unit.gate.script import MS, SECOND, Script, policy
from tests.unit.gate.situations import UP, lead_to


def hovering() -> Script:
    script = Script(policy("default"))
    lead_to(State.HOVERING, script)
    script.position()
    return script


def stamped(script: Script, east: float, *, after_ms: int, arrives_ms: int) -> State:
    """A sample so far east, stamped and arriving so long after the last; the state it leads to."""
    boot_ms = script.gate.memory.boot_ms + after_ms
    script.now_ns += arrives_ms * MS
    script.feed(PositionSeen((0.0, east, -UP), STILL, boot_ms))
    return state_of(script)


class TestJump:
    """Faster than 30 m/s and half a metre."""

    @pytest.mark.parametrize(
        ("east", "after_ms", "arrives_ms", "state"),
        [
            (3.5, 100, 100, State.HOVERING),
            (3.5625, 100, 100, State.HOLDING),
            (3.5, 100, 1, State.HOVERING),  # by the vehicle's clock: samples may queue
            (3.5625, 100, 1, State.HOLDING),
            (3.5, 0, 100, State.HOVERING),  # its clock stands still: by ours
            (3.5625, 0, 100, State.HOLDING),
            (0.5, 0, 0, State.HOVERING),
            (0.5625, 0, 0, State.HOLDING),
        ],
    )
    def test_by_the_time_between_two_samples(
        self, east: float, after_ms: int, arrives_ms: int, state: State
    ) -> None:
        assert stamped(hovering(), east, after_ms=after_ms, arrives_ms=arrives_ms) is state

    def test_a_stamp_no_further_ahead_than_a_position_stays_fresh_is_believed(self) -> None:
        assert stamped(hovering(), 0.0, after_ms=1_100, arrives_ms=100) is State.HOVERING

    def test_a_stamp_that_is_further_ahead_is_a_clock_that_was_set(self) -> None:
        assert stamped(hovering(), 0.0, after_ms=1_101, arrives_ms=100) is State.HOLDING

    def test_the_first_position_is_no_jump(self) -> None:
        script = Script(policy("default"))
        script.heartbeat(FlightMode.HOLD, armed=True)
        script.land_state(LandedState.IN_AIR)
        script.feed(PositionSeen((90.0, 0.0, -UP), STILL, 5_000))
        assert state_of(script) is State.EXTERNAL
        assert script.gate.pos_ned == (90.0, 0.0, -UP)


class TestSamples:
    @pytest.mark.parametrize("axis", range(6))
    @pytest.mark.parametrize("wrong", [math.nan, math.inf])
    def test_one_number_that_is_none_makes_it_no_position(self, axis: int, wrong: float) -> None:
        script = hovering()
        n, e, d, vn, ve, vd = (wrong if i == axis else 0.25 for i in range(6))
        script.feed(PositionSeen((n, e, d), (vn, ve, vd), script.now_ns // MS))
        assert script.gate.pos_ned == (0.0, 0.0, -UP)

    def test_one_of_the_same_stamp_counts_and_an_older_one_does_not(self) -> None:
        script = hovering()
        stamped(script, 0.25, after_ms=0, arrives_ms=10)
        assert script.gate.pos_ned == (0.0, 0.25, -UP)
        stamped(script, 0.0, after_ms=-1, arrives_ms=10)
        assert script.gate.pos_ned == (0.0, 0.25, -UP)

    def test_after_a_reset_the_clock_begins_anew(self) -> None:
        script = hovering()
        script.feed(PositionSeen((0.0, 0.25, -UP), STILL, 1, reset=True))
        assert script.gate.pos_ned == (0.0, 0.25, -UP)
        assert state_of(script) is State.HOLDING

    def test_without_reset_and_no_jump_nothing_is_held(self) -> None:
        script = hovering()
        script.feed(PositionSeen((0.0, 0.25, -UP), STILL, script.now_ns // MS))
        assert state_of(script) is State.HOVERING

    @pytest.mark.parametrize("landed", [LandedState.IN_AIR, LandedState.UNDEFINED])
    def test_the_floor_counts_for_what_is_known_to_fly(self, landed: LandedState) -> None:
        """Sinking at 2 m/s from 1.5 m: it stops 1.3 m lower, 0.2 m above the floor."""
        script = hovering()
        script.feed(LandedSeen(landed))
        script.feed(PositionSeen((0.0, 0.0, -UP), (0.0, 0.0, 2.5), script.now_ns // MS))
        flies = landed is LandedState.IN_AIR
        assert state_of(script) is (State.HOLDING if flies else State.HOVERING)

    @pytest.mark.parametrize("state", [State.TAKING_OFF, State.RETURNING, State.LANDING])
    def test_it_does_not_count_for_what_begins_or_ends_on_the_ground(self, state: State) -> None:
        script, _ = flight(state)
        script.land_state(LandedState.IN_AIR)
        north, east, down = script.pos_ned
        script.feed(PositionSeen((north, east, down), (0.0, 0.0, 3.0), script.now_ns // MS))
        assert state_of(script) is state

    def test_while_control_is_being_taken_it_is_predicted_already(self) -> None:
        script, _ = flight(State.HOVERING)
        assert script.gate.control is Control.TAKING
        sample = PositionSeen((0.0, 0.0, -UP), (12.0, 0.0, 0.0), script.now_ns // MS)
        script.feed(sample)
        assert state_of(script) is State.HOVERING
        script.feed(PositionSeen((0.0, 0.0, -UP), (60.0, 0.0, 0.0), script.now_ns // MS))
        assert state_of(script) is State.HOLDING


class TestStanding:
    """Half a metre above where it stood, it does not stand, whatever is reported."""

    @pytest.mark.parametrize(("up", "stands"), [(0.5, True), (0.5625, False)])
    def test_a_vehicle_that_climbed_flies(self, up: float, stands: bool) -> None:
        script = Script(policy("default"))
        script.pos_ned = (3.0, 4.0, -7.0)
        lead_to(State.GROUNDED, script)
        script.wait(1.0)
        script.reports_landed = False
        script.feed(PositionSeen((3.0, 4.0, -7.0 - up), STILL, script.now_ns // MS + 200))
        landing = script.ask(Land())
        assert script.ended(landing) is stands

    def test_each_report_that_it_stands_is_of_where_it_is_now(self) -> None:
        script = Script(policy("default"))
        lead_to(State.GROUNDED, script)
        script.at(0.0, 0.0, 0.45)
        script.land_state(LandedState.ON_GROUND)
        script.at(0.0, 0.0, 0.9)
        assert script.ended(script.ask(Land()))
        script.at(0.0, 0.0, 1.0)
        assert not script.ended(script.ask(Land()))

    def test_but_not_during_a_take_off(self) -> None:
        """px4 says ON_GROUND for up to a second into a climb."""
        script = Script(policy("default"))
        take_off(script)
        script.v_ned = (0.0, 0.0, -1.0)
        script.at(0.0, 0.0, 1.0)
        script.land_state(LandedState.ON_GROUND)
        script.forget()
        script.ask(Abort())
        assert script.commands() == [CommandKind.HOLD]
        assert state_of(script) is State.HOLDING

    def test_nor_while_one_that_was_given_up_may_come_late(self) -> None:
        script = Script(policy("default"))
        take_off(script)
        script.answer(CommandKind.TAKE_OFF, 2)
        assert state_of(script) is State.GROUNDED
        script.v_ned = (0.0, 0.0, -1.0)
        script.at(0.0, 0.0, 1.0)
        script.land_state(LandedState.ON_GROUND)
        script.ask(Hold())
        assert state_of(script) is State.HOLDING

    @pytest.mark.parametrize(
        "landed", [LandedState.IN_AIR, LandedState.TAKEOFF, LandedState.LANDING]
    )
    def test_taking_off_and_landing_are_in_the_air(self, landed: LandedState) -> None:
        script = Script(policy("default"))
        lead_to(State.GROUNDED, script)
        script.land_state(landed)
        assert state_of(script) is State.EXTERNAL

    def test_not_known_is_neither(self) -> None:
        script = Script(policy("default"))
        lead_to(State.GROUNDED, script)
        script.land_state(LandedState.UNDEFINED)
        assert state_of(script) is State.GROUNDED
        assert not script.ended(script.ask(Land()))

    def test_what_is_reported_again_is_nothing_new(self) -> None:
        script, request_id = flight(State.MOVING)
        script.land_state(LandedState.TAKEOFF)
        assert reaction(script, request_id, lambda s: s.land_state(LandedState.LANDING)).ended == ""
        assert state_of(script) is State.MOVING

    def test_a_report_without_a_position_says_nothing_of_height(self) -> None:
        script = Script(policy("default"))
        script.heartbeat(armed=True)
        script.land_state(LandedState.ON_GROUND)
        script.at(0.0, 0.0, 40.0)
        assert state_of(script) is State.GROUNDED
        assert script.ended(script.ask(Land()))

    def test_after_a_jump_heights_of_before_say_nothing(self) -> None:
        script = Script(policy("default"))
        lead_to(State.GROUNDED, script)
        script.reports_landed = False
        script.feed(PositionSeen((0.0, 0.0, -40.0), STILL, 1, reset=True))
        assert script.ended(script.ask(Land()))


class TestHome:
    @pytest.mark.parametrize(("moved", "state"), [(1.0, State.HOVERING), (1.0625, State.HOLDING)])
    def test_it_moved_when_it_is_more_than_a_metre_away(self, moved: float, state: State) -> None:
        script = hovering()
        script.feed(HomeSeen((0.0, moved, 0.0)))
        assert state_of(script) is state

    def test_a_first_home_did_not_move(self) -> None:
        script = Script(policy("default"))
        script.heartbeat(FlightMode.HOLD, armed=True)
        script.land_state(LandedState.IN_AIR)
        script.position()
        script.feed(HomeSeen((50.0, 0.0, 0.0)))
        assert not [s for s in script.all(Say) if "moved" in s.text]

    def test_on_the_ground_it_may_move(self) -> None:
        script = Script(policy("default")).connect()
        script.feed(HomeSeen((50.0, 0.0, 0.0)))
        assert not [s for s in script.all(Say) if "moved" in s.text]


class TestMission:
    """px4 shows the end of a mission by its hold mode: after the last item it is the end."""

    def end(self, *seen: MissionSeen | MissionLoaded) -> State:
        script, _ = flight(State.FLYING_MISSION)
        for report in seen:
            script.feed(report)
        script.heartbeat(FlightMode.HOLD)
        return state_of(script)

    @pytest.mark.parametrize(
        ("seq", "total", "over"),
        [
            (3, 5, False),
            (4, 5, True),
            (5, 5, True),
            (0, 1, True),
            (0, 2, False),
            (0, 0, False),
            (3, 0, False),
        ],
    )
    def test_the_last_item_is_the_end(self, seq: int, total: int, over: bool) -> None:
        state = self.end(MissionSeen(seq, total, finished=False))
        assert state is (State.HOVERING if over else State.EXTERNAL)

    def test_nothing_reported_is_no_end(self) -> None:
        assert self.end() is State.EXTERNAL

    def test_a_mission_loaded_since_is_not_over(self) -> None:
        reports = (MissionSeen(4, 5, finished=False), MissionLoaded("other", 3))
        assert self.end(*reports) is State.EXTERNAL

    def test_finished_is_the_end_at_any_item(self) -> None:
        script = Script(policy("default"))
        lead_to(State.GROUNDED, script)
        script.feed(MissionSeen(0, 5, finished=True))
        assert script.gate.memory.mission_over


class TestPictures:
    def test_the_very_first_picture_is_a_picture(self) -> None:
        script, request_id = flight(State.TAKING_PICTURE)
        script.feed(PhotoSeen(0, ok=True))
        assert script.ended(request_id)

    def test_a_picture_that_failed_is_told_again_as_nothing(self) -> None:
        script = Script(policy("default"))
        lead_to(State.HOVERING, script)
        script.feed(PhotoSeen(1, ok=False))
        lead_to_picture = script.ask(Hold())
        assert not script.ended(lead_to_picture)
        assert script.gate.memory.photo_index == 1


class TestConditions:
    def test_each_stands_by_itself(self) -> None:
        script = Script(policy("default")).connect()
        script.feed(ConditionChanged(Condition.BATTERY_LOW, True, "20 %"))
        script.feed(ConditionChanged(Condition.OTHER_STATION, True, "255"))
        script.feed(ConditionChanged(Condition.BATTERY_LOW, True, "19 %"))
        assert script.gate.memory.conditions == (
            (Condition.BATTERY_LOW, "19 %"),
            (Condition.OTHER_STATION, "255"),
        )
        script.feed(ConditionChanged(Condition.BATTERY_LOW, False))
        assert script.gate.conditions == (Condition.OTHER_STATION,)


class TestAnswers:
    def test_one_answer_ends_one_command(self) -> None:
        script = Script(policy("default"))
        take_off(script)
        abort = script.ask(Abort())
        assert self.outstanding(script) == [CommandKind.HOLD, CommandKind.DISARM]
        script.feed(CommandEnded(abort, CommandKind.HOLD, 0))
        assert self.outstanding(script) == [CommandKind.DISARM]
        script.feed(CommandEnded(abort, CommandKind.DISARM, 4))
        assert script.outcome(abort).code == "VEHICLE_REFUSED"

    def outstanding(self, script: Script) -> list[CommandKind]:
        return [kind for _, kind in script.gate.memory.outstanding]

    def silences(self, script: Script) -> int:
        return len([s for s in script.all(Say) if s.text.startswith("No answer")])

    def test_silence_is_told_again_after_an_answer(self) -> None:
        script, hold = flight(State.HOLDING)
        for result, told in ((None, 1), (None, 1), (0, 1), (None, 2)):
            script.wait(1.0)
            script.feed(CommandEnded(hold, CommandKind.HOLD, result))
            assert self.silences(script) == told

    def test_silence_about_something_else_is_told(self) -> None:
        script = Script(policy("default"))
        take_off(script)
        abort = script.ask(Abort())
        script.feed(CommandEnded(abort, CommandKind.HOLD, None))
        script.feed(CommandEnded(abort, CommandKind.DISARM, None))
        assert self.silences(script) == 2


class TestArmedWithoutHeartbeat:
    """A disarm of a vehicle that was never seen armed is over with its answer and a heartbeat."""

    @pytest.mark.parametrize("wanted", [Disarm(), Disarm(force=True), Abort()])
    def test_it_ends_with_the_answer_and_a_heartbeat(self, wanted: Disarm | Abort) -> None:
        script, _ = flight(State.GROUNDED)
        request_id = script.ask(wanted)
        script.heartbeat(armed=False)
        assert not script.ended(request_id)
        script.answer(CommandKind.DISARM, 0)
        assert not script.ended(request_id)
        script.heartbeat(armed=False)
        assert str(script.outcome(request_id).kind) == "complete"

    def test_an_arming_does_not(self) -> None:
        script, request_id = flight(State.GROUNDED)
        script.feed(CommandEnded(request_id, CommandKind.ARM, 0))
        script.heartbeat(armed=False)
        assert not script.ended(request_id)


def test_control_of_a_vehicle_that_is_taken_in_stale_is_refused() -> None:
    script = Script(policy("default")).fly(UP)
    script.reports_position = False
    script.now_ns += 2 * SECOND
    assert script.refusal(script.ask(TakeControl())) == "STALE"
