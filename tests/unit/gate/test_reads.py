"""What the gate answers when it is read, and how requests end."""

from __future__ import annotations

import pytest

from gcs.frames import Vec3
from gcs.gate.effects import CommandKind, OutcomeKind, Verdict
from gcs.gate.inputs import (
    CommandEnded,
    MissionLoaded,
    PositionSeen,
    Tick,
)
from gcs.gate.machine.gate import Gate
from gcs.gate.requests import (
    Abort,
    Disarm,
    GoTo,
    Land,
    Request,
    Resume,
    ReturnHome,
    StartMission,
    TakePhoto,
)
from gcs.gate.states import FlightMode, LandedState, State
from tests.unit.gate.script import MS, SECOND, Script, policy
from tests.unit.gate.situations import (
    STILL,
    UP,
    flight,
    lead_to,
    state_of,
    take_off,
)


class TestSettled:
    """The vehicle may be left: seen holding, on the ground, or not ours to hold."""

    def test_not_while_we_fly_it(self) -> None:
        script, _ = flight(State.MOVING)
        assert not script.gate.settled

    @pytest.mark.parametrize(
        ("request_", "mode"),
        [(ReturnHome(), FlightMode.RETURN), (Land(), FlightMode.LAND)],
    )
    def test_coming_down_once_it_is_shown(self, request_: Request, mode: FlightMode) -> None:
        script = Script(policy("default")).take_control(UP)
        script.ask(request_)
        assert not script.gate.settled
        script.heartbeat(mode)
        assert script.gate.settled

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
        assert self.goals(script) == (None, here), "held in its place until it shows the mode"
        script.heartbeat(FlightMode.LAND)
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
