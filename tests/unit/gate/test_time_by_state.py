"""What time alone does in each state: arrival, deadlines, the end of a climb, repeated holds."""

from __future__ import annotations

import pytest

from gcs.frames import ned_from_enu
from gcs.gate.effects import CommandKind, SendCommand
from gcs.gate.inputs import PositionSeen, Tick
from gcs.gate.requests import Arm, Disarm, GoTo, Hold, Land, ReturnHome, TakeControl, TakeOff
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.reactions import (
    FLIGHT,
    HELD,
    Reaction,
    default_policy,
    ended,
    flight,
    reaction,
    remember,
    state_of,
    streams,
    take_off,
)
from tests.unit.gate.script import MS, SECOND, Script, policy
from tests.unit.gate.situations import UP, lead_to


def just_before(script: Script, seconds: float) -> None:
    """The last tick before `seconds` from now are over."""
    script.wait(seconds - 0.05)


class TestDeadlines:
    def test_a_goal_has_twice_the_time_of_the_slowest_flight(self) -> None:
        """60 m at 2 m/s, twice: 60 s."""
        script = Script(policy("default")).take_control(UP)
        request_id = script.ask(GoTo((0.0, 60.0, -UP)))
        script.tick()
        just_before(script, 60.0)
        assert not script.ended(request_id)
        assert reaction(script, request_id, lambda s: s.wait(0.1)) == Reaction(
            *HELD, "timed out DEADLINE"
        )

    @pytest.mark.parametrize(
        ("up", "goal_up", "deadline_s"),
        [(1.5, 22.5, 2.0 * 21.0 / 0.7), (22.5, 1.5, 2.0 * 21.0 / 0.5)],
        ids=["climb", "descent"],
    )
    def test_a_climb_and_a_descent_have_the_time_of_theirs(
        self, up: float, goal_up: float, deadline_s: float
    ) -> None:
        script = Script(policy("default")).take_control(up)
        request_id = script.ask(GoTo((0.0, 0.0, -goal_up)))
        script.tick()
        just_before(script, deadline_s)
        assert not script.ended(request_id)
        script.wait(0.1)
        assert ended(script, request_id) == "timed out DEADLINE"

    def test_the_level_and_the_climb_add_up(self) -> None:
        """30 m east and 40 m north at 2 m/s, 7 m up at 0.7 m/s, twice: 70 s."""
        script = Script(policy("default")).take_control(UP)
        request_id = script.ask(GoTo((40.0, 30.0, -UP - 7.0)))
        script.tick()
        just_before(script, 70.0)
        assert not script.ended(request_id)
        script.wait(0.1)
        assert ended(script, request_id) == "timed out DEADLINE"

    def test_a_short_flight_has_twenty_seconds(self) -> None:
        script, request_id = flight(State.MOVING)
        just_before(script, 20.0)
        assert not script.ended(request_id)
        assert reaction(script, request_id, lambda s: s.wait(0.1)) == Reaction(
            *HELD, "timed out DEADLINE"
        )

    def test_a_picture_has_ten_seconds_and_hovering_goes_on(self) -> None:
        script, request_id = flight(State.TAKING_PICTURE)
        just_before(script, 10.0)
        assert not script.ended(request_id)
        assert reaction(script, request_id, lambda s: s.wait(0.1)) == Reaction(
            State.HOVERING, Control.OURS, [], "timed out DEADLINE"
        )

    def test_a_landing_has_three_minutes_and_goes_on(self) -> None:
        script, request_id = flight(State.LANDING)
        just_before(script, 180.0)
        assert not script.ended(request_id)
        assert reaction(script, request_id, lambda s: s.wait(0.1)) == Reaction(
            State.LANDING, Control.OURS, [], "timed out DEADLINE"
        )

    def test_a_landing_whose_report_was_missed_is_complete_on_the_ground(self) -> None:
        script, request_id = flight(State.LANDING, land_timeout_s=10.0)
        script.reports_landed = False
        remember(script, armed=False)
        script.armed = False
        script.wait(9.9)
        assert reaction(script, request_id, lambda s: s.wait(0.1)) == Reaction(
            State.GROUNDED, Control.NONE, [], "complete"
        )

    @pytest.mark.slow
    @pytest.mark.parametrize("state", [State.RETURNING, State.FLYING_MISSION])
    def test_a_return_and_a_mission_have_as_long_as_it_takes(self, state: State) -> None:
        script, request_id = flight(state)
        assert reaction(script, request_id, lambda s: s.wait(400.0)) == Reaction(
            state, Control.OURS, [], ""
        )

    def test_a_take_off_has_a_minute(self) -> None:
        script, request_id = flight(State.TAKING_OFF, takeoff=policy("default").takeoff)
        just_before(script, 58.0)
        assert not script.ended(request_id)
        found = reaction(script, request_id, lambda s: s.wait(2.05))
        assert found[:2] == (State.HOLDING, Control.OURS)
        assert set(found.sent) == {CommandKind.HOLD}
        assert found.ended == "timed out DEADLINE"

    def test_on_the_ground_it_is_given_up_there(self) -> None:
        script = Script(policy("default"))
        request_id = take_off(script)
        just_before(script, 60.0)
        assert not script.ended(request_id)
        assert reaction(script, request_id, lambda s: s.wait(0.1)) == Reaction(
            State.GROUNDED,
            Control.NONE,
            [CommandKind.HOLD, CommandKind.DISARM],
            "timed out DEADLINE",
        )

    @pytest.mark.parametrize("wanted", [Arm(), Disarm()])
    def test_arming_and_disarming_have_five_seconds(self, wanted: Arm | Disarm) -> None:
        script = Script(policy("default")).connect()
        if isinstance(wanted, Disarm):
            script.heartbeat(armed=True)
        request_id = script.ask(wanted)
        just_before(script, 5.0)
        assert not script.ended(request_id)
        assert reaction(script, request_id, lambda s: s.wait(0.1)) == Reaction(
            State.GROUNDED, Control.NONE, [], "timed out NO_ANSWER"
        )

    def test_a_forced_disarm_has_five_seconds(self) -> None:
        script, request_id = flight(State.EXTERNAL)
        just_before(script, 5.0)
        assert not script.ended(request_id)
        assert reaction(script, request_id, lambda s: s.wait(0.1)) == Reaction(
            State.EXTERNAL, Control.NONE, [], "timed out NO_ANSWER"
        )

    def test_a_hold_has_five_seconds_and_is_repeated_all_the_same(self) -> None:
        script, request_id = flight(State.HOLDING)
        just_before(script, 5.0)
        assert not script.ended(request_id)
        script.wait(0.1)
        assert ended(script, request_id) == "timed out NO_ANSWER"
        assert (
            reaction(script, request_id, lambda s: s.wait(2.1))
            == Reaction(State.HOLDING, Control.OURS, [CommandKind.HOLD] * 2, "timed out NO_ANSWER")
            or ended(script, request_id) == ""
        )
        assert script.commands() == [CommandKind.HOLD] * 2

    @pytest.mark.parametrize("state", [State.GROUNDED, State.STALE])
    def test_so_it_is_with_one_whose_take_off_may_come_yet(self, state: State) -> None:
        script = Script(policy("default"))
        take_off(script)
        script.answer(CommandKind.TAKE_OFF, None)
        if state is State.STALE:
            script.reports_position = False
            script.wait(1.2)
        request_id = script.ask(Hold())
        script.wait(5.1)
        assert ended(script, request_id) == "timed out NO_ANSWER"
        script.forget()
        script.wait(2.1)
        assert script.commands() == [CommandKind.HOLD] * 2

    def test_control_has_the_time_to_stream_and_five_seconds(self) -> None:
        script, request_id = flight(State.HOVERING)
        just_before(script, 6.05)
        assert not script.ended(request_id)
        script.wait(0.1)
        assert ended(script, request_id) == "timed out NO_ANSWER"
        assert (state_of(script), script.gate.control) == (State.EXTERNAL, Control.NONE)

    @pytest.mark.parametrize("wanted", [Land(), ReturnHome()])
    def test_what_came_down_while_its_position_was_too_old_is_complete(
        self, wanted: Land | ReturnHome
    ) -> None:
        script = Script(policy("default")).take_control(UP)
        request_id = script.ask(wanted)
        script.land_state(LandedState.ON_GROUND)
        script.reports_position = False
        script.wait(1.2)
        assert state_of(script) is State.STALE
        assert reaction(script, request_id, lambda s: s.wait(2.0)) == Reaction(
            State.STALE, Control.NONE, [], "complete"
        )

    def test_an_arming_whose_position_is_too_old_ends_all_the_same(self) -> None:
        script, request_id = flight(State.GROUNDED)
        script.reports_position = False
        script.wait(1.2)
        assert reaction(script, request_id, lambda s: s.wait(4.0)) == Reaction(
            State.STALE, Control.NONE, [], "timed out NO_ANSWER"
        )

    def test_a_goal_whose_time_is_over_within_the_grace_is_held(self) -> None:
        script, request_id = flight(State.MOVING)
        script.wait(18.8)
        script.reports_position = False
        script.wait(1.15)
        assert state_of(script) is State.STALE
        assert not script.ended(request_id)
        found = reaction(script, request_id, lambda s: s.wait(0.1))
        assert found == Reaction(
            State.STALE, Control.OURS, [CommandKind.HOLD], "timed out DEADLINE"
        )
        assert not streams(script)
        script.reports_position = True
        script.tick()
        assert state_of(script) is State.HOLDING


class TestArrival:
    """Closer than 0.5 m, slower than 0.5 m/s, for 0.5 s."""

    def moving(self) -> tuple[Script, int]:
        script = Script(policy("default")).take_control(UP)
        request_id = script.ask(GoTo((0.0, 3.0, -UP)))
        script.tick()
        return script, request_id

    def test_there_and_slow_and_for_long_enough_it_hovers_at_the_goal(self) -> None:
        script, request_id = self.moving()
        script.at(3.0, 0.0, UP)
        script.wait(0.45)
        assert state_of(script) is State.MOVING
        assert reaction(script, request_id, lambda s: s.wait(0.1)) == Reaction(
            State.HOVERING, Control.OURS, [], "complete"
        )
        assert script.gate.hold_goal_ned == ned_from_enu((3.0, 0.0, UP))
        assert streams(script)

    @pytest.mark.parametrize(
        ("east", "speed", "arrives"),
        [
            (2.5, 0.0, False),  # 0.5 m away is not closer than 0.5 m
            (2.5625, 0.0, True),
            (3.0, 0.5, True),
            (3.0, 0.5625, False),
        ],
    )
    def test_the_limits_of_place_and_speed(self, east: float, speed: float, arrives: bool) -> None:
        script, request_id = self.moving()
        script.at(east, 0.0, UP, (speed, 0.0, 0.0))
        script.wait(0.6)
        assert script.ended(request_id) is arrives

    def test_leaving_begins_the_time_anew(self) -> None:
        script, request_id = self.moving()
        script.at(3.0, 0.0, UP)
        script.wait(0.3)
        script.at(2.0, 0.0, UP)
        script.tick()
        script.at(3.0, 0.0, UP)
        script.wait(0.4)
        assert not script.ended(request_id)
        script.wait(0.1)
        assert script.ended(request_id)

    def test_a_goal_where_it_is_begins_its_time_with_the_verdict(self) -> None:
        script = Script(policy("default")).take_control(UP)
        request_id = script.ask(GoTo((0.0, 0.25, -UP)))
        script.tick()
        script.wait(0.45)
        assert not script.ended(request_id)
        script.wait(0.05)
        assert ended(script, request_id) == "complete"

    def test_without_a_position_nobody_arrives(self) -> None:
        script, request_id = self.moving()
        script.at(3.0, 0.0, UP)
        script.reports_position = False
        script.wait(0.45)
        script.now_ns += SECOND
        script.feed(Tick(0))
        assert not script.ended(request_id)

    def test_any_speed_will_do_where_the_policy_asks_for_none(self) -> None:
        arrival = policy("lab").arrival
        assert arrival.speed_m_s is None
        script = Script(default_policy(arrival=arrival)).take_control(UP)
        request_id = script.ask(GoTo((0.0, 3.0, -UP)))
        script.tick()
        script.at(3.0, 0.0, UP, (4.0, 0.0, 0.0))
        script.wait(arrival.dwell_s + 0.1)
        assert script.ended(request_id)


class TestTheEndOfAClimb:
    def climbed(self, up: float, v_up: float = 0.0, autopilot: str = "px4") -> tuple[Script, int]:
        """A take-off to 5 m that is in the air at `up`, its mode shown."""
        script = Script(policy("default"), autopilot)
        request_id = take_off(script, 5.0)
        script.land_state(LandedState.TAKEOFF)
        script.v_ned = (0.0, 0.0, -1.0)
        script.at(0.0, 0.0, up, (0.0, 0.0, v_up))
        script.land_state(LandedState.IN_AIR)
        return script, request_id

    @pytest.mark.parametrize(
        ("up", "v_up", "there"),
        [
            (4.5, 0.0, False),  # 0.5 m below is not within 0.5 m
            (4.5625, 0.0, True),
            (5.4375, 0.0, True),
            (5.5, 0.0, False),
            (5.0, 0.25, True),
            (5.0, 0.3, False),  # it is over when it is slower than 0.3 m/s
        ],
    )
    def test_near_the_top_and_slow_control_is_taken(
        self, up: float, v_up: float, there: bool
    ) -> None:
        script, request_id = self.climbed(up, v_up)
        script.tick()
        after = (State.HOVERING, Control.TAKING) if there else (State.TAKING_OFF, Control.OURS)
        assert (state_of(script), script.gate.control) == after
        assert not script.ended(request_id)

    def test_px4_says_by_its_hold_mode_that_it_is_up(self) -> None:
        script, _ = self.climbed(5.0, 1.0)
        script.tick()
        assert state_of(script) is State.TAKING_OFF
        script.heartbeat(FlightMode.HOLD)
        script.tick()
        assert state_of(script) is State.HOVERING

    def test_far_below_and_slow_the_climb_ended_there(self) -> None:
        script, request_id = self.climbed(3.0)
        script.heartbeat(FlightMode.HOLD)
        script.pos_ned = ned_from_enu((0.0, 0.0, 3.0))
        assert reaction(script, request_id, lambda s: s.tick()) == Reaction(
            *HELD, "aborted VEHICLE_REFUSED"
        )
        assert "2.0 m below" in script.outcome(request_id).sentence

    def test_far_below_in_take_off_mode_it_climbs_on(self) -> None:
        script, request_id = self.climbed(3.0)
        assert reaction(script, request_id, lambda s: s.wait(1.0)) == Reaction(
            State.TAKING_OFF, Control.OURS, [], ""
        )

    def test_above_and_slow_the_climb_ended_there(self) -> None:
        script, request_id = self.climbed(6.0)
        script.heartbeat(FlightMode.HOLD)
        assert reaction(script, request_id, lambda s: s.tick()) == Reaction(
            *HELD, "aborted VEHICLE_REFUSED"
        )
        assert "1.0 m above" in script.outcome(request_id).sentence

    @pytest.mark.parametrize(("up", "too_high"), [(6.5, False), (6.5625, True)])
    def test_a_metre_above_the_arrival_radius_is_too_high(self, up: float, too_high: bool) -> None:
        script, request_id = self.climbed(up, 1.0)
        found = reaction(script, request_id, lambda s: s.tick())
        if too_high:
            assert found == Reaction(*HELD, "aborted TOO_HIGH")
        else:
            assert found == Reaction(State.TAKING_OFF, Control.OURS, [], "")

    def test_at_the_top_and_not_allowed_to_hover_it_is_held(self) -> None:
        script, request_id = self.climbed(5.0)
        remember(script, pos_ned=ned_from_enu((170.0, 0.0, 5.0)))
        found = reaction(script, request_id, lambda s: s.feed(Tick(0)))
        assert found == Reaction(*HELD, "aborted TOO_CLOSE")

    def test_ardupilot_ends_slow_and_in_guided(self) -> None:
        script, request_id = self.climbed(5.0, autopilot="ardupilot")
        script.tick()
        assert (state_of(script), script.gate.control) == (State.HOVERING, Control.TAKING)
        assert not script.ended(request_id)

    def test_what_is_not_known_to_fly_has_not_climbed(self) -> None:
        script, request_id = self.climbed(5.0)
        remember(script, landed=LandedState.UNDEFINED)
        assert reaction(script, request_id, lambda s: s.tick()) == Reaction(
            State.TAKING_OFF, Control.OURS, [], ""
        )


class TestRepeated:
    @pytest.mark.parametrize("state", [*FLIGHT, State.GROUNDED])
    def test_a_tick_sends_no_command(self, state: State) -> None:
        script, request_id = flight(state)
        control = script.gate.control
        assert reaction(script, request_id, lambda s: s.tick(3)) == Reaction(state, control, [], "")

    def test_guided_is_asked_for_once_when_the_stream_is_a_second_old(self) -> None:
        script = Script(policy("default")).fly(UP)
        request_id = script.ask(TakeControl())
        first_ns = None
        sent_ns = []
        for _ in range(60):
            script.forget()
            script.tick()
            if first_ns is None and list(script.setpoints()):
                first_ns = script.now_ns
            if CommandKind.GUIDED in script.commands():
                sent_ns.append(script.now_ns)
        assert first_ns is not None
        assert sent_ns == [first_ns + 1_000 * MS]
        assert not script.ended(request_id)

    def test_ardupilot_needs_no_stream_before(self) -> None:
        script = Script(policy("default"), "ardupilot").fly(UP)
        request_id = script.ask(TakeControl())
        assert reaction(script, request_id, lambda s: s.tick()).sent == [CommandKind.GUIDED]

    def test_a_hold_is_repeated_each_second(self) -> None:
        script, _ = flight(State.HOLDING)
        for _ in range(3):
            script.forget()
            script.wait(0.95)
            assert not script.commands()
            script.wait(0.05)
            assert script.commands() == [CommandKind.HOLD]


def test_the_take_off_command_names_the_height() -> None:
    script = Script(policy("default"))
    lead_to(State.GROUNDED, script)
    script.ask(TakeOff(7.0))
    sent = script.all(SendCommand)[-1]
    assert (sent.kind, sent.up_m) == (CommandKind.TAKE_OFF, 7.0)


def test_a_sample_between_two_ticks_is_no_arrival() -> None:
    script = Script(policy("default")).take_control(UP)
    request_id = script.ask(GoTo((0.0, 3.0, -UP)))
    script.tick()
    script.at(3.0, 0.0, UP)
    script.now_ns += 900 * MS
    script.feed(PositionSeen(script.pos_ned, (0.0, 0.0, 0.0), script.now_ns // MS))
    assert not script.ended(request_id)
    script.feed(Tick(0))
    assert script.ended(request_id)
