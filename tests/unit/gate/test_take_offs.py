"""A take-off: what is commanded, how far up it is, and whether it has left the ground."""

from __future__ import annotations

from typing import Literal

import pytest

from gcs.gate.effects import CommandKind, Ruling, SendCommand, Verdict
from gcs.gate.machine.memory import Memory
from gcs.gate.refusal import Code
from gcs.gate.requests import Hold, Land, TakeOff
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.reactions import (
    HELD,
    Reaction,
    default_policy,
    elsewhere,
    ended,
    reaction,
    remember,
    state_of,
    take_off,
)
from tests.unit.gate.script import SECOND, Script, policy


class TestCommandAndHeight:
    def test_the_command_that_waited_for_its_mode_has_the_height(self) -> None:
        script = Script(policy("default"), "ardupilot").connect()
        script.heartbeat(FlightMode.HOLD, armed=True)
        request_id = script.ask(TakeOff(3.0))
        script.heartbeat(FlightMode.GUIDED)
        sent = script.all(SendCommand)
        assert [s.kind for s in sent] == [CommandKind.GUIDED, CommandKind.TAKE_OFF]
        assert (sent[-1].request_id, sent[-1].up_m) == (request_id, 3.0)

    def test_the_ground_is_as_far_down_as_where_it_stands(self) -> None:
        """Ten metres east of home, on the ground: it stands, and an abort disarms it."""
        script = Script(policy("default"))
        script.pos_ned = (0.0, 10.0, 0.0)
        take_off(script)
        script.ask(Hold())
        assert script.gate.state is State.GROUNDED
        assert script.commands()[-2:] == [CommandKind.HOLD, CommandKind.DISARM]

    @pytest.mark.parametrize("up", [5.5, 5.75, 5.9375])
    def test_a_climb_that_ended_less_than_a_metre_above_is_told_as_above(self, up: float) -> None:
        script = Script(policy("default"))
        request_id = take_off(script, 5.0)
        script.land_state(LandedState.TAKEOFF)
        script.v_ned = (0.0, 0.0, -1.0)
        script.at(0.0, 0.0, up, (0.0, 0.0, 1.0))
        script.land_state(LandedState.IN_AIR)
        script.v_ned = (0.0, 0.0, 0.0)
        script.heartbeat(FlightMode.HOLD)
        script.tick()
        assert "m above the height asked for" in script.outcome(request_id).sentence


class TestTheEndOfTheClimb:
    """PX4's own tolerance is 0.8 m, the policy's arrival radius 0.5 m."""

    def climbed(self, up: float, autopilot: str = "px4") -> tuple[Script, int]:
        """A take-off to 5 m that the vehicle ends `up` metres high, two metres off its place."""
        script = Script(policy("default"), autopilot)
        request_id = take_off(script, 5.0)
        script.land_state(LandedState.TAKEOFF)
        script.at(2.0, 0.0, up, (0.0, 0.0, 1.0))
        script.land_state(LandedState.IN_AIR)
        script.v_ned = (0.0, 0.0, 0.0)
        script.heartbeat(FlightMode.HOLD if autopilot == "px4" else FlightMode.GUIDED)
        script.tick()
        return script, request_id

    def gained(self, script: Script) -> None:
        script.wait(1.1)
        script.heartbeat(FlightMode.GUIDED)

    @pytest.mark.parametrize("up", [3.75, 4.25, 4.75, 5.25])
    def test_the_top_that_was_verified_is_streamed_and_flown_to(self, up: float) -> None:
        script, request_id = self.climbed(up)
        assert script.gate.hold_goal_ned == (0.0, 0.0, -5.0)
        self.gained(script)
        assert {place for _, place in script.setpoints()} == {(0.0, 0.0, 5.0)}
        assert (state_of(script), ended(script, request_id)) == (State.MOVING, "")
        script.at(0.0, 0.0, 5.0)
        script.wait(1.0)
        assert (state_of(script), ended(script, request_id)) == (State.HOVERING, "complete")
        assert script.gate.hold_goal_ned == (0.0, 0.0, -5.0)

    @pytest.mark.parametrize(("up", "autopilot"), [(3.5, "px4"), (4.25, "ardupilot")])
    def test_a_climb_that_ended_further_below_is_not_over(self, up: float, autopilot: str) -> None:
        script, _ = self.climbed(up, autopilot)
        assert state_of(script) is not State.HOVERING

    def test_of_a_vehicle_that_told_no_tolerance_the_radius_counts(self) -> None:
        script = Script(policy("default"))
        take_off(script, 5.0)
        remember(script, climb_ends_within_m=Memory("px4").climb_ends_within_m)
        script.land_state(LandedState.IN_AIR)
        script.at(0.0, 0.0, 4.25)
        script.heartbeat(FlightMode.HOLD)
        script.tick()
        assert state_of(script) is State.HOLDING

    def test_a_vehicle_that_does_not_show_the_end_climbs_on(self) -> None:
        script, _ = self.climbed(3.5)
        remember(script, state=State.TAKING_OFF, mode=FlightMode.TAKEOFF)
        script.mode = FlightMode.TAKEOFF
        script.at(0.0, 0.0, 4.25)
        script.wait(0.2)
        assert state_of(script) is State.TAKING_OFF

    @pytest.mark.parametrize(("up", "how"), [(4.625, ""), (4.6875, "complete"), (5.375, "")])
    def test_it_is_complete_nearer_to_its_height_than_the_arrival_radius(
        self, up: float, how: str
    ) -> None:
        """That is half a metre; a PX4 may rest 0.28 m beside its height."""
        script, request_id = self.climbed(4.25)
        self.gained(script)
        script.at(0.0, 0.0, up)
        script.wait(1.0)
        assert ended(script, request_id) == how

    def test_the_rest_has_the_deadline_of_a_goal(self) -> None:
        script, request_id = self.climbed(4.25)
        self.gained(script)
        script.wait(script.policy.deadline_min_s + 0.1)
        assert state_of(script) is State.HOLDING
        assert ended(script, request_id) == "timed out DEADLINE"

    def test_a_top_that_clears_no_more_is_not_flown_to(self) -> None:
        script, request_id = self.climbed(4.25)
        script.wait(1.1)
        remember(script, verifier=elsewhere(script))
        assert reaction(script, request_id, lambda s: s.heartbeat(FlightMode.GUIDED)) == Reaction(
            *HELD, "aborted OUTSIDE_FENCE"
        )

    def test_guided_mode_that_is_shown_while_the_position_is_too_old_waits_for_a_fresh_one(
        self,
    ) -> None:
        script, request_id = self.climbed(4.25)
        script.wait(1.1)
        script.now_ns += round(1.1 * SECOND)
        script.heartbeat(FlightMode.GUIDED)
        assert (state_of(script), script.gate.control) == (State.HOVERING, Control.TAKING)
        script.position()
        script.heartbeat(FlightMode.GUIDED)
        assert (state_of(script), ended(script, request_id)) == (State.MOVING, "")

    def test_a_goal_that_comes_while_control_is_taken_waits_for_the_mode(self) -> None:
        """MAVSDK's examples send one five seconds after the take-off, wherever that is."""
        script, request_id = self.climbed(4.25)
        goal = script.goto(3.0, 0.0, 5.0)
        script.wait(1.1)
        assert goal not in {verdict.request_id for verdict in script.all(Verdict)}
        assert {place for _, place in script.setpoints()} == {(0.0, 0.0, 5.0)}
        script.heartbeat(FlightMode.GUIDED)
        script.tick()
        assert script.verdict(goal).ruling is Ruling.ACCEPTED
        assert script.gate.active_goal_ned == (0.0, 3.0, -5.0)
        assert ended(script, request_id) == "superseded SUPERSEDED"

    @pytest.mark.parametrize(
        ("retarget", "up", "refused"),
        [
            ("replace", 9.0625, None),
            ("replace", 8.9375, Code.BUSY),  # not in the last tenth of the climb
            ("refuse", 9.5, Code.BUSY),
        ],
    )
    def test_a_goal_in_the_last_tenth_of_the_climb_waits_for_its_end(
        self, retarget: Literal["replace", "refuse"], up: float, refused: Code | None
    ) -> None:
        """DroneKit's scripts send one at 95 % of the height, once."""
        script = Script(default_policy(retarget=retarget), "ardupilot")
        request_id = take_off(script, 10.0)
        script.land_state(LandedState.IN_AIR)
        script.at(0.0, 0.0, up, (0.0, 0.0, 1.0))
        goal = script.goto(3.0, 0.0, 10.0)
        script.tick()
        told = {v.request_id: v.refusal and v.refusal.code for v in script.all(Verdict)}
        assert told.get(goal) is refused
        assert state_of(script) is State.TAKING_OFF
        script.at(0.0, 0.0, 10.0)
        script.v_ned = (0.0, 0.0, 0.0)
        script.wait(1.1)
        script.heartbeat(FlightMode.GUIDED)
        script.tick()
        flown_ned = None if refused else (0.0, 3.0, -10.0)
        assert (script.gate.active_goal_ned == flown_ned) is (refused is None)
        assert (ended(script, request_id) == "superseded SUPERSEDED") is (refused is None)

    def test_it_is_refused_where_a_pilot_brakes_near_the_top(self) -> None:
        script = Script(default_policy(retarget="replace"), "ardupilot")
        take_off(script, 10.0)
        script.land_state(LandedState.IN_AIR)
        script.at(0.0, 0.0, 9.5, (0.0, 0.0, 1.0))
        goal = script.goto(3.0, 0.0, 10.0)
        script.v_ned = (0.0, 0.0, 0.0)
        script.at(0.0, 0.0, 9.6)
        script.heartbeat(FlightMode.HOLD)
        script.wait(0.2)
        assert script.refusal(goal) is Code.MODE_CHANGED

    def test_it_is_refused_where_the_climb_is_stopped(self) -> None:
        script = Script(default_policy(retarget="replace"), "ardupilot")
        take_off(script, 10.0)
        script.land_state(LandedState.IN_AIR)
        script.at(0.0, 0.0, 9.5, (0.0, 0.0, 1.0))
        goal = script.goto(3.0, 0.0, 10.0)
        script.ask(Hold())
        assert script.verdict(goal).ruling is Ruling.SUPERSEDED
        assert state_of(script) is State.HOLDING

    def test_it_is_refused_where_control_is_not_had_in_time(self) -> None:
        script, _ = self.climbed(4.25)
        goal = script.goto(3.0, 0.0, 5.0)
        script.wait(1.0 + script.policy.control.timeout_s + 0.1)
        assert script.refusal(goal) is Code.NO_ANSWER


class TestWhetherItStands:
    def test_a_climb_that_is_still_reported_to_stand_is_not_disarmed(self) -> None:
        """Its landed state lags for longer than our take-off may come late."""
        script = Script(policy("default"))
        request_id = take_off(script, 5.0)
        script.at(0.0, 0.0, 3.0, (0.0, 0.0, 1.0))
        script.wait(11.0)
        assert state_of(script) is State.TAKING_OFF
        assert reaction(script, request_id, lambda s: s.ask(Hold())) == Reaction(
            *HELD, "aborted OPERATOR"
        )

    def test_a_take_off_comes_late_until_its_time_and_not_at_it(self) -> None:
        """From then on what is reported to stand is believed to, wherever it is."""
        script = Script(policy("default")).connect()
        script.heartbeat(armed=True)
        script.land_state(LandedState.ON_GROUND)
        script.pos_ned = (0.0, 0.0, -1.0)
        script.tick()
        remember(script, takeoff_until_ns=script.now_ns)
        script.land_state(LandedState.ON_GROUND)
        assert ended(script, script.ask(Land())) == "complete"
        assert script.commands() == []
