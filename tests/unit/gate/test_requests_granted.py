"""What is granted, what it begins, and which request it displaces."""

from __future__ import annotations

import pytest

from gcs.gate.effects import CommandKind, Outcome, Ruling, SwitchedFence
from gcs.gate.inputs import (
    HomeSeen,
    MissionLoaded,
    PhotoSeen,
    VerifierChanged,
)
from gcs.gate.refusal import Code
from gcs.gate.requests import (
    GoTo,
    Hold,
    Request,
    Resume,
    StartMission,
    SwitchFence,
    TakeControl,
    TakePhoto,
)
from gcs.gate.states import Control, FlightMode, State
from tests.unit.gate.reactions import (
    AIRBORNE,
    FLIGHT,
    GUIDED_STATES,
    MODE_STATES,
    STATES,
    Reaction,
    ended,
    flight,
    reaction,
    state_of,
    streams,
)
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import UP, lead_to

GOAL = GoTo((0.0, 4.0, -UP))


class TestGranted:
    @pytest.mark.parametrize("wanted", [TakeControl(), Resume()], ids=["control", "resume"])
    def test_control_that_is_ours_is_complete_at_once(self, wanted: Request) -> None:
        script = Script(policy("default"))
        lead_to(State.HOVERING, script)
        before = script.gate.memory
        asked = script.ask(wanted)
        assert ended(script, asked) == "complete"
        assert script.gate.memory == before

    @pytest.mark.parametrize(
        ("state", "wanted"),
        [
            (State.EXTERNAL, TakeControl()),
            (State.EXTERNAL, Resume()),
            (State.HOLDING, Resume()),
        ],
    )
    def test_control_is_taken_at_the_present_place(self, state: State, wanted: Request) -> None:
        script, request_id = flight(state)
        assert reaction(script, request_id, lambda s: s.ask(wanted)) == Reaction(
            State.HOVERING, Control.TAKING, [], "superseded SUPERSEDED"
        )
        assert script.gate.hold_goal_ned == (0.0, 0.0, -UP)
        assert streams(script)

    def test_a_picture_is_asked_for_and_the_place_is_streamed(self) -> None:
        script = Script(policy("default"))
        lead_to(State.HOVERING, script)
        asked = script.ask(TakePhoto())
        assert reaction(script, asked, lambda s: None) == Reaction(
            State.TAKING_PICTURE, Control.OURS, [], ""
        )
        assert script.gate.memory.outstanding == ((asked, CommandKind.PHOTO),)
        assert streams(script)
        script.feed(PhotoSeen(1, ok=True))
        assert ended(script, asked) == "complete"
        assert state_of(script) is State.HOVERING

    @pytest.mark.parametrize("state", [State.GROUNDED, State.HOVERING])
    def test_a_mission_is_started_and_then_nothing_is_streamed(self, state: State) -> None:
        script = Script(policy("default"))
        lead_to(state, script)
        script.feed(MissionLoaded("square", 4))
        asked = script.ask(StartMission())
        assert (state_of(script), script.gate.control) == (State.FLYING_MISSION, Control.OURS)
        assert script.gate.memory.outstanding == ((asked, CommandKind.START_MISSION),)
        assert streams(script) is (state is State.HOVERING), "held until it shows the mode"
        script.heartbeat(FlightMode.MISSION)
        assert not streams(script)

    @pytest.mark.parametrize("state", STATES)
    def test_the_fence_is_switched_where_the_policy_lets_it(self, state: State) -> None:
        script, request_id = flight(state, fence_switchable=True)
        asked = script.ask(SwitchFence(on=True))
        assert ended(script, asked) == "complete"
        assert script.all(SwitchedFence) == [SwitchedFence(on=True)]
        if state is State.FLYING_MISSION:
            assert ended(script, request_id) == "aborted BAD_MISSION"  # verified by another fence
            return
        assert state_of(script) is state
        assert not script.commands()
        assert not script.ended(request_id)

    def test_a_newer_goal_takes_the_place_of_one_that_waits_for_its_tick(self) -> None:
        script = Script(policy("default"))
        lead_to(State.HOVERING, script)
        first, second = script.ask(GoTo((5.0, 0.0, -UP))), script.ask(GOAL)
        assert script.verdict(first).ruling is Ruling.SUPERSEDED
        script.tick()
        assert script.gate.active_goal_ned == GOAL.goal_ned
        assert script.verdict(second).ruling is Ruling.ACCEPTED
        assert not script.ended(first)

    def test_the_owner_of_a_goal_may_replace_it_where_the_policy_says_so(self) -> None:
        script, request_id = flight(State.MOVING, retarget="replace")
        assert script.refusal(script.ask(GOAL, source="somebody else")) is Code.BUSY
        script.ask(GOAL)
        assert not script.ended(request_id)
        assert reaction(script, request_id, lambda s: s.tick()) == Reaction(
            State.MOVING, Control.OURS, [], "superseded SUPERSEDED"
        )
        assert script.gate.active_goal_ned == GOAL.goal_ned

    def test_one_that_does_not_clear_leaves_the_goal_that_flies(self) -> None:
        script, request_id = flight(State.MOVING, retarget="replace")
        goal_ned = script.gate.active_goal_ned
        asked = script.ask(GoTo((0.0, 500.0, -UP)))
        assert reaction(script, request_id, lambda s: s.tick()) == Reaction(
            State.MOVING, Control.OURS, [], ""
        )
        assert script.refusal(asked) is Code.OUTSIDE_FENCE
        assert script.gate.active_goal_ned == goal_ned

    def test_a_goal_that_does_not_clear_leaves_the_hover(self) -> None:
        script = Script(policy("default"))
        lead_to(State.HOVERING, script)
        asked = script.ask(GoTo((0.0, 500.0, -UP)))
        assert reaction(script, asked, lambda s: s.tick()) == Reaction(
            State.HOVERING, Control.OURS, [], ""
        )
        assert script.refusal(asked) is Code.OUTSIDE_FENCE
        assert streams(script)


def test_every_accepted_request_has_one_outcome_and_every_refused_none() -> None:
    script, request_id = flight(State.MOVING)
    refused = script.ask(TakePhoto())
    accepted = script.ask(Hold())
    script.heartbeat(FlightMode.HOLD)
    ids = [outcome.request_id for outcome in script.all(Outcome)]
    assert ids == [request_id, accepted]
    assert refused not in ids


def test_states_named_here_are_all_that_can_be_reached() -> None:
    assert {*AIRBORNE, State.NO_VEHICLE, State.STALE, State.GROUNDED} == set(STATES)
    assert {State.TAKING_OFF, *GUIDED_STATES, *MODE_STATES} == set(FLIGHT)


def test_home_and_fence_told_again_on_the_ground_change_nothing() -> None:
    script, request_id = flight(State.GROUNDED)
    verifier = script.gate.memory.verifier
    assert verifier is not None
    assert reaction(script, request_id, lambda s: s.feed(VerifierChanged(verifier))).ended == ""
    assert reaction(script, request_id, lambda s: s.feed(HomeSeen((0.0, 5.0, 0.0)))).ended == ""
