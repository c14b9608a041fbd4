"""At which nanosecond a thing is due, and what the gate answers when it is read."""

from __future__ import annotations

import pytest

from gcs.frames import Vec3
from gcs.gate.effects import CommandKind, Effect, OutcomeKind, SendCommand, Verdict
from gcs.gate.inputs import (
    CommandEnded,
    HeartbeatSeen,
    LandedSeen,
    MissionLoaded,
    OperatorLost,
    PositionSeen,
    Requested,
    Tick,
)
from gcs.gate.machine.gate import Gate
from gcs.gate.requests import (
    Abort,
    Arm,
    Disarm,
    GoTo,
    Hold,
    Land,
    Resume,
    ReturnHome,
    StartMission,
    TakeControl,
    TakeOff,
    TakePhoto,
)
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.reactions import (
    STILL,
    default_policy,
    ended,
    flight,
    state_of,
    take_off,
)
from tests.unit.gate.script import MS, SECOND, Script, policy
from tests.unit.gate.situations import UP, lead_to


def fresh(script: Script, *, position: bool = True) -> int:
    """Everything is reported this instant; the time of it."""
    script.feed(HeartbeatSeen(script.armed, script.mode, script.mode.value))
    script.feed(LandedSeen(script.landed))
    if position:
        script.position()
    return script.now_ns


def tick_at(script: Script, now_ns: int) -> list[Effect]:
    script.now_ns = now_ns
    return script.feed(Tick(0))


class TestDue:
    """Just before it is due nothing happens; at the very nanosecond it does."""

    def test_a_position_is_too_old_when_it_is_older_than_a_second(self) -> None:
        script, _ = flight(State.MOVING)
        now_ns = fresh(script)
        tick_at(script, now_ns + SECOND)
        assert state_of(script) is State.MOVING
        tick_at(script, now_ns + SECOND + 1)
        assert state_of(script) is State.STALE

    def test_the_grace_is_over_half_a_second_later(self) -> None:
        script, request_id = flight(State.MOVING)
        begun_ns = fresh(script) + SECOND + 1
        tick_at(script, begun_ns)
        tick_at(script, begun_ns + SECOND // 2 - 1)
        assert not script.ended(request_id)
        tick_at(script, begun_ns + SECOND // 2)
        assert ended(script, request_id) == "aborted STALE"

    def test_a_vehicle_is_lost_three_and_a_half_seconds_after_its_heartbeat(self) -> None:
        script, _ = flight(State.GROUNDED)
        now_ns = fresh(script)
        tick_at(script, now_ns + 3_500 * MS - 1)
        assert state_of(script) is State.STALE
        tick_at(script, now_ns + 3_500 * MS)
        assert state_of(script) is State.NO_VEHICLE

    def test_so_is_its_landed_state(self) -> None:
        script, _ = flight(State.GROUNDED)
        now_ns = fresh(script)
        script.now_ns = now_ns + 2 * SECOND
        script.heartbeat()
        for early_ns, landed in ((1, LandedState.ON_GROUND), (0, LandedState.UNDEFINED)):
            tick_at(script, now_ns + 3_500 * MS - early_ns)
            assert script.gate.memory.landed is landed

    def test_a_deadline(self) -> None:
        script, request_id = flight(State.TAKING_PICTURE)
        task = script.gate.memory.task
        assert task is not None
        assert task.deadline_ns is not None
        for now_ns, over in ((task.deadline_ns - 1, False), (task.deadline_ns, True)):
            script.now_ns = now_ns
            fresh(script)
            script.feed(Tick(0))
            assert script.ended(request_id) is over

    def test_a_mode_that_is_not_shown(self) -> None:
        script = Script(policy("default")).take_control(UP)
        request_id = script.ask(Land())
        asked_ns = script.now_ns
        for now_ns, over in ((asked_ns + 5 * SECOND - 1, False), (asked_ns + 5 * SECOND, True)):
            script.now_ns = now_ns
            fresh(script)
            script.feed(Tick(0))
            assert script.ended(request_id) is over

    def test_until_then_another_mode_is_that_of_before(self) -> None:
        for late_ns, state in ((5 * SECOND - 1, State.LANDING), (5 * SECOND, State.EXTERNAL)):
            script = Script(policy("default")).take_control(UP)
            script.ask(Land())
            script.now_ns += late_ns
            script.heartbeat(FlightMode.OTHER)
            assert state_of(script) is state

    def test_the_next_hold(self) -> None:
        script, _ = flight(State.HOLDING)
        asked_ns = script.now_ns
        tick_at(script, asked_ns + SECOND - 1)
        assert script.commands() == []
        tick_at(script, asked_ns + SECOND)
        assert script.commands() == [CommandKind.HOLD]

    def test_guided_of_ours_for_ten_seconds(self) -> None:
        for late_ns, sent in ((10 * SECOND - 1, [CommandKind.HOLD]), (10 * SECOND, [])):
            script = Script(policy("default"), "ardupilot").fly(UP)
            script.ask(TakeControl())
            script.tick()
            asked_ns = script.now_ns
            script.ask(Hold())
            script.heartbeat(FlightMode.HOLD)
            script.forget()
            script.now_ns = asked_ns + late_ns
            script.heartbeat(FlightMode.GUIDED)
            assert script.commands() == sent

    def test_a_take_off_of_ours_for_ten_seconds(self) -> None:
        for late_ns, state in ((10 * SECOND - 1, State.HOLDING), (10 * SECOND, State.EXTERNAL)):
            script = Script(policy("default"))
            lead_to(State.GROUNDED, script)
            script.ask(TakeOff(2.0))
            asked_ns = script.now_ns
            script.answer(CommandKind.TAKE_OFF, None)
            script.now_ns = asked_ns + late_ns
            fresh(script)
            script.land_state(LandedState.IN_AIR)
            assert state_of(script) is state

    def test_while_one_may_come_it_is_not_sure_to_stand(self) -> None:
        for late_ns, stands in ((10 * SECOND - 1, False), (10 * SECOND, True)):
            script = Script(policy("default"))
            lead_to(State.GROUNDED, script)
            script.ask(TakeOff(2.0))
            asked_ns = script.now_ns
            script.answer(CommandKind.TAKE_OFF, None)
            script.now_ns = asked_ns + late_ns
            fresh(script)
            assert script.ended(script.ask(Hold())) is stands

    @pytest.mark.parametrize("given", [Requested(9, "keyboard", TakePhoto()), OperatorLost("quit")])
    def test_a_request_and_a_lost_operator_are_judged_by_the_time_they_come(
        self, given: Requested | OperatorLost
    ) -> None:
        script, _ = flight(State.HOVERING)
        script.now_ns = fresh(script) + 2 * SECOND
        script.feed(given)
        assert State.STALE in script.states()

    def test_a_report_is_not(self) -> None:
        script, _ = flight(State.MOVING)
        script.now_ns = fresh(script) + 2 * SECOND
        script.heartbeat()
        assert state_of(script) is State.MOVING


class TestNextDue:
    """`deadline_ns` is the earliest of what is due; asking changes nothing."""

    def due(self, script: Script) -> int:
        due_ns = script.gate.deadline_ns
        assert due_ns is not None
        return due_ns - script.now_ns

    def test_nothing_is_due_with_nobody(self) -> None:
        assert Gate(policy("default"), "px4", 0).deadline_ns is None

    def test_the_position_goes_first(self) -> None:
        script, _ = flight(State.TAKING_PICTURE)
        fresh(script)
        assert self.due(script) == SECOND

    def test_in_stale_the_grace_and_then_the_heartbeat(self) -> None:
        script, _ = flight(State.MOVING)
        now_ns = fresh(script)
        tick_at(script, now_ns + SECOND + 1)
        assert self.due(script) == SECOND // 2
        script = Script(policy("default"))
        lead_to(State.GROUNDED, script)
        now_ns = fresh(script)
        tick_at(script, now_ns + SECOND + 1)
        assert self.due(script) == 2_500 * MS - 1

    @pytest.mark.parametrize(
        ("photo_s", "expected_ns"), [(0.75, 750 * MS), (1.25, SECOND)], ids=["task", "position"]
    )
    def test_the_task_where_it_is_earlier(self, photo_s: float, expected_ns: int) -> None:
        script = Script(default_policy(photo_timeout_s=photo_s)).take_control(UP)
        fresh(script)
        script.ask(TakePhoto())
        assert self.due(script) == expected_ns

    def test_the_hold_to_be_repeated(self) -> None:
        script, _ = flight(State.HOLDING)
        script.now_ns += 500 * MS
        fresh(script)
        assert self.due(script) == 500 * MS

    def test_control_to_be_asked_for(self) -> None:
        script = Script(policy("default")).fly(UP)
        script.ask(TakeControl())
        script.now_ns += 500 * MS
        fresh(script)
        assert self.due(script) == 550 * MS

    def test_the_mode_that_is_waited_for(self) -> None:
        script = Script(policy("default")).take_control(UP)
        script.ask(ReturnHome())
        script.now_ns += 4_500 * MS
        fresh(script)
        assert self.due(script) == 500 * MS
        script.heartbeat(FlightMode.RETURN)
        assert self.due(script) == SECOND


class TestSettled:
    """The vehicle may be left: seen holding, on the ground, or not ours to hold."""

    @pytest.mark.parametrize("state", [State.MOVING, State.RETURNING, State.LANDING])
    def test_not_while_we_fly_it(self, state: State) -> None:
        script, _ = flight(state)
        assert not script.gate.settled

    def test_not_while_control_is_being_taken(self) -> None:
        script, _ = flight(State.HOVERING)
        assert not script.gate.settled

    def test_held_once_it_is_shown(self) -> None:
        script, _ = flight(State.HOLDING)
        assert not script.gate.settled
        script.heartbeat(FlightMode.HOLD)
        assert script.gate.settled

    def test_not_in_another_state_that_shows_hold(self) -> None:
        script, _ = flight(State.TAKING_OFF)
        script.heartbeat(FlightMode.HOLD)
        assert not script.gate.settled

    def test_not_held_in_another_mode(self) -> None:
        script, _ = flight(State.HOLDING)
        script.heartbeat(FlightMode.HOLD)
        script.wait(12.0)
        script.heartbeat(FlightMode.HOLD)
        assert script.gate.settled
        memory = script.gate.memory
        memory.mode = FlightMode.GUIDED
        assert not Gate.resumed(script.policy, memory, script.now_ns).settled

    def test_on_the_ground_unless_a_command_waits_for_its_answer(self) -> None:
        script = Script(policy("default"))
        lead_to(State.GROUNDED, script)
        seen = [script.gate.settled]
        request_id = script.ask(Disarm())
        seen.append(script.gate.settled)
        script.feed(CommandEnded(request_id, CommandKind.DISARM, 0))
        seen.append(script.gate.settled)
        assert seen == [True, False, True]

    def test_somebody_elses_is_and_one_we_must_still_hold_is_not(self) -> None:
        script = Script(policy("default")).fly(UP)
        assert script.gate.settled
        script, _ = flight(State.NO_VEHICLE)
        assert not script.gate.settled


class TestReads:
    def goals(self, script: Script) -> tuple[Vec3 | None, Vec3 | None]:
        return script.gate.active_goal_ned, script.gate.hold_goal_ned

    def test_the_active_goal_is_the_one_it_flies_to_or_hovers_at(self) -> None:
        script = Script(policy("default")).take_control(UP)
        here, there = (0.0, 0.0, -UP), (0.0, 3.0, -UP)
        assert self.goals(script) == (here, here)
        script.goto(3.0, 0.0, UP)
        script.tick()
        assert self.goals(script) == (there, here)
        script.ask(Land())
        assert self.goals(script) == (None, None)

    def test_the_age_of_the_position(self) -> None:
        script = Script(policy("default"))
        assert script.gate.position_age_s(SECOND) is None
        script.position()
        assert script.gate.position_age_s(script.now_ns + SECOND // 4) == 0.25

    def test_a_verdict_names_the_goal_that_is_active(self) -> None:
        script, _ = flight(State.MOVING)
        refused = script.ask(TakePhoto())
        assert script.verdict(refused).active_goal_ned == (0.0, 3.0, -UP)
        refusal = script.verdict(refused).refusal
        assert refusal is not None
        assert "MOVING, goal (3.00 E, 0.00 N, 1.50 U)" in refusal.sentence
        script = Script(policy("default")).fly(UP)
        refused = script.ask(TakePhoto())
        assert script.verdict(refused).active_goal_ned is None

    def test_an_accepted_one_carries_the_numbers_it_was_cleared_on(self) -> None:
        script = Script(policy("default")).take_control(UP)
        asked = script.goto(3.0, 4.0, UP)
        script.tick()
        evidence = dict(script.verdict(asked).evidence)
        assert evidence["leg_m"] == 5.0
        refused = script.goto(500.0, 0.0, UP)
        script.tick()
        verdicts = {v.request_id: v for v in script.all(Verdict)}
        assert verdicts[asked].refusal is None
        assert verdicts[refused].refusal is not None


class TestCommands:
    def sent(self, script: Script) -> SendCommand:
        return script.all(SendCommand)[-1]

    def test_a_hold_is_tried_for_a_second_and_others_for_five(self) -> None:
        script = Script(policy("default")).take_control(UP)
        script.ask(Hold())
        assert self.sent(script).deadline_ns == script.now_ns + SECOND
        script.ask(Land())
        assert self.sent(script).deadline_ns == script.now_ns + 5 * SECOND

    def test_the_gates_own_are_nobodys(self) -> None:
        script = Script(policy("default")).fly(UP)
        script.ask(TakeControl())
        script.wait(6.2)
        assert (self.sent(script).kind, self.sent(script).request_id) == (CommandKind.HOLD, 0)

    def test_those_that_are_asked_for_carry_the_request(self) -> None:
        script = Script(policy("default")).take_control(UP)
        request_id = script.ask(Land())
        assert self.sent(script).request_id == request_id
        assert self.sent(script).up_m == 0.0

    def test_a_hold_that_is_repeated_waits_for_one_answer(self) -> None:
        script, hold = flight(State.HOLDING)
        script.wait(2.1)
        assert script.gate.memory.outstanding == ((hold, CommandKind.HOLD),)

    @pytest.mark.parametrize(
        ("wanted", "permitted"),
        [(Hold(), False), (Land(), True), (ReturnHome(), True), (TakePhoto(), False)],
    )
    def test_what_moves_the_vehicle_carries_a_permit(
        self, wanted: Hold | Land | ReturnHome | TakePhoto, permitted: bool
    ) -> None:
        script = Script(policy("default")).take_control(UP)
        script.ask(wanted)
        assert (self.sent(script).permit is not None) is permitted

    @pytest.mark.parametrize("force", [False, True])
    def test_a_disarm_carries_none(self, force: bool) -> None:
        script = Script(default_policy(allow_force_disarm=True))
        if force:
            script.fly(UP)
            script.ask(Disarm(force=True))
            script.ask(Disarm(force=True))
        else:
            lead_to(State.GROUNDED, script)
            script.ask(Disarm())
        assert self.sent(script).permit is None

    @pytest.mark.parametrize("mode", list(FlightMode))
    def test_px4_arms_in_every_mode_but_three(self, mode: FlightMode) -> None:
        script = Script(policy("default"))
        script.mode = mode
        script.connect()
        script.ask(Arm())
        waits = mode in (FlightMode.LAND, FlightMode.RETURN, FlightMode.MISSION)
        assert script.commands() == [CommandKind.HOLD if waits else CommandKind.ARM]

    @pytest.mark.parametrize("mode", list(FlightMode))
    def test_ardupilot_arms_in_guided_alone(self, mode: FlightMode) -> None:
        script = Script(policy("default"), "ardupilot")
        script.mode = mode
        script.connect()
        script.ask(Arm())
        waits = mode is not FlightMode.GUIDED
        assert script.commands() == [CommandKind.GUIDED if waits else CommandKind.ARM]

    @pytest.mark.parametrize("mode", list(FlightMode))
    def test_another_autopilot_in_any(self, mode: FlightMode) -> None:
        script = Script(policy("default"), "somebody")
        script.mode = mode
        script.connect()
        script.ask(Arm())
        assert script.commands() == [CommandKind.ARM]

    @pytest.mark.parametrize("autopilot", ["px4", "ardupilot", "somebody"])
    def test_a_climb_counts_from_where_it_stands(self, autopilot: str) -> None:
        script = Script(policy("default"), autopilot)
        script.pos_ned = (3.0, 4.0, -7.0)
        script.connect()
        script.heartbeat(FlightMode.GUIDED, armed=True)
        request_id = script.ask(TakeOff(5.0))
        assert script.gate.memory.top_ned == (3.0, 4.0, -12.0)
        assert not script.gate.memory.lifted
        assert script.gate.control is Control.OURS
        assert not script.ended(request_id)


def test_a_goal_that_clears_no_more_by_the_tick_is_refused_for_the_position() -> None:
    script = Script(policy("default")).take_control(UP)
    goto = script.ask(GoTo((3.0, 0.0, -UP)))
    script.now_ns += SECOND + 1
    script.feed(Tick(0))
    assert script.refusal(goto) == "STALE"


def test_a_request_ends_with_its_words() -> None:
    script, request_id = flight(State.MOVING)
    script.ask(Abort())
    outcome = script.outcome(request_id)
    assert (outcome.kind, outcome.sentence) == (OutcomeKind.ABORTED, "stopped by the operator")


def test_resume_at_once_after_a_hold_takes_the_place_of_before() -> None:
    script, _ = flight(State.HOLDING)
    script.feed(PositionSeen((0.0, 0.25, -UP), STILL, script.now_ns // MS + 50))
    script.ask(Resume())
    assert script.gate.hold_goal_ned == (0.0, 0.25, -UP)


def test_a_mission_is_refused_where_none_is_loaded_any_more() -> None:
    script = Script(policy("default")).take_control(UP)
    script.feed(MissionLoaded("square", 1))
    script.feed(MissionLoaded("", 0))
    assert script.refusal(script.ask(StartMission())) == "NO_MISSION"
    script.feed(MissionLoaded("point", 1))
    assert not script.ended(script.ask(StartMission()))
    assert state_of(script) is State.FLYING_MISSION


def test_a_take_off_says_where_the_top_is() -> None:
    script = Script(policy("default"))
    take_off(script, 4.0)
    script.land_state(LandedState.IN_AIR)
    script.v_ned = (0.0, 0.0, -1.0)
    script.at(0.0, 0.0, 4.25)
    script.heartbeat(FlightMode.HOLD)
    script.tick()
    assert state_of(script) is State.HOVERING
