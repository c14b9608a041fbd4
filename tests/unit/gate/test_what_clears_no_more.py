"""A jump, a home or a fence that moved, a breach ahead: what was verified is so no more."""

from __future__ import annotations

import pytest

from gcs.frames import ned_from_enu
from gcs.gate.effects import CommandKind, Say, SendSetpoint
from gcs.gate.inputs import (
    HeartbeatSeen,
    HomeSeen,
    LandedSeen,
    PositionSeen,
    VerifierChanged,
)
from gcs.gate.states import Control, FlightMode, State
from tests.unit.gate.reactions import (
    FLIGHT,
    HEARD,
    HELD,
    STILL,
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
    take_off,
)
from tests.unit.gate.script import MS, SECOND, Script, policy
from tests.unit.gate.situations import UP


def braked(state: State) -> Reaction:
    """One that follows setpoints is stopped by them, and told its hold mode when it is slow."""
    by_setpoints = state in (State.MOVING, State.TAKING_PICTURE)
    after, control, held = HELD
    return Reaction(after, control, [] if by_setpoints else held, "aborted FENCE_BREACH")


class TestJump:
    @pytest.mark.parametrize("state", [*VERIFIED, State.RETURNING])
    def test_it_holds_and_the_place_is_verified_anew(self, state: State) -> None:
        script, request_id = flight(state)
        found = reaction(script, request_id, lambda s: s.feed(sample(s, 20.0, reset=True)))
        assert found == Reaction(*HELD, "aborted ESTIMATOR_RESET")
        script.pos_ned = ned_from_enu((20.0, 0.0, UP))
        assert script.gate.hold_goal_ned == ned_from_enu((20.0, 0.0, UP))
        assert streams(script)

    def test_a_held_vehicle_is_held_at_its_new_place(self) -> None:
        script, request_id = flight(State.HOLDING)
        found = reaction(script, request_id, lambda s: s.feed(sample(s, 20.0, reset=True)))
        assert found == Reaction(State.HOLDING, Control.OURS, [], "")
        assert script.gate.hold_goal_ned == ned_from_enu((20.0, 0.0, UP))

    def test_or_in_silence_where_that_does_not_clear(self) -> None:
        script, _ = flight(State.HOLDING)
        script.feed(sample(script, 170.0, reset=True))
        script.pos_ned = ned_from_enu((170.0, 0.0, UP))
        assert script.gate.hold_goal_ned is None
        assert not streams(script)

    @pytest.mark.parametrize("state", [State.GROUNDED, State.LANDING, State.EXTERNAL])
    def test_it_is_nothing_to_what_we_do_not_fly_to_a_place(self, state: State) -> None:
        script, request_id = flight(state)
        control = script.gate.control
        found = reaction(script, request_id, lambda s: s.feed(sample(s, 20.0, reset=True)))
        assert found == Reaction(state, control, [], "")

    def test_nor_to_a_return_of_the_vehicles_own(self) -> None:
        script = Script(policy("default")).fly(UP)
        script.heartbeat(FlightMode.RETURN)
        assert state_of(script) is State.RETURNING
        found = reaction(script, 0, lambda s: s.feed(sample(s, 20.0, reset=True)))
        assert found == Reaction(State.RETURNING, Control.NONE, [], "")


class TestHomeMoved:
    FAR, NEAR = HomeSeen((0.0, 5.0, 0.0)), HomeSeen((0.0, 0.9, 0.0))

    @pytest.mark.parametrize("state", [*VERIFIED, State.RETURNING])
    def test_it_holds(self, state: State) -> None:
        script, request_id = flight(state)
        assert reaction(script, request_id, lambda s: s.feed(self.FAR)) == Reaction(
            *HELD, "aborted HOME_MOVED"
        )

    @pytest.mark.parametrize("state", VERIFIED)
    def test_a_little_is_no_move(self, state: State) -> None:
        script, request_id = flight(state)
        control = script.gate.control
        assert reaction(script, request_id, lambda s: s.feed(self.NEAR)) == Reaction(
            state, control, [], ""
        )

    def test_a_held_vehicle_is_verified_anew(self) -> None:
        script, request_id = flight(State.HOLDING)
        script.feed(sample(script, 3.0))
        assert reaction(script, request_id, lambda s: s.feed(self.FAR)) == Reaction(
            State.HOLDING, Control.OURS, [], ""
        )
        assert script.gate.hold_goal_ned == ned_from_enu((3.0, 0.0, UP))

    @pytest.mark.parametrize("state", [State.GROUNDED, State.LANDING, State.EXTERNAL])
    def test_it_is_nothing_to_what_we_do_not_fly_to_a_place(self, state: State) -> None:
        script, request_id = flight(state)
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
    @pytest.mark.parametrize("state", VERIFIED)
    def test_what_clears_no_more_is_held_with_the_reason(self, state: State) -> None:
        script, request_id = flight(state)
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
        script, request_id = flight(State.HOLDING)
        assert streams(script)
        found = reaction(script, request_id, lambda s: s.feed(VerifierChanged(elsewhere(s))))
        assert found == Reaction(State.HOLDING, Control.OURS, [], "")
        assert not streams(script)

    @pytest.mark.parametrize(
        "state", [State.GROUNDED, State.RETURNING, State.LANDING, State.EXTERNAL]
    )
    def test_it_is_nothing_to_what_we_do_not_fly_to_a_place(self, state: State) -> None:
        script, request_id = flight(state)
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
        script, request_id = flight(state)
        script.forget()
        self.dash(script)
        found = Reaction(
            state_of(script), script.gate.control, script.commands(), ended(script, request_id)
        )
        assert found == braked(state)
        (brake,) = script.all(SendSetpoint)
        assert brake.permit.pos_ned is not None
        assert script.gate.hold_goal_ned is not None
        back_m = 2.5 / 0.95  # [pace]: it is asked to fly back at 2.5 m/s
        assert 140.0 - back_m <= brake.permit.pos_ned[0] <= script.gate.hold_goal_ned[0] < 148.0

    @pytest.mark.parametrize("state", [State.LANDING, State.HOLDING, State.EXTERNAL])
    def test_what_lands_or_is_held_or_is_not_ours_is_left_alone(self, state: State) -> None:
        script, _ = flight(state)
        if state is State.HOLDING:
            script.heartbeat(FlightMode.HOLD)
        control = script.gate.control
        self.dash(script)
        assert (state_of(script), script.gate.control) == (state, control)
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
        assert reaction(script, request_id, lambda s: s.feed(given)) == braked(state)
        assert len(script.all(SendSetpoint)) == 1

    def test_what_is_held_already_is_not_braked_when_its_sample_comes_late(self) -> None:
        script, _ = flight(State.HOLDING)
        script.heartbeat(FlightMode.HOLD)
        script.reports_position = False
        script.wait(1.2)
        assert state_of(script) is State.STALE
        self.dash(script)
        assert script.commands() == []
        assert state_of(script) is State.HOLDING


def test_a_sample_of_the_ordinary_says_nothing() -> None:
    for state in HEARD:
        script, _ = flight(state)
        effects = script.feed(PositionSeen(script.pos_ned, STILL, script.now_ns // MS))
        assert [e for e in effects if not isinstance(e, Say)] == []
