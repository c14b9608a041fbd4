"""The mode that the heartbeat shows moves the state: DESIGN 4, control and streaming.

A mode change that we did not command leads to EXTERNAL, or to RETURNING or LANDING where the mode
says so; a mode that was commanded is waited for as long as the policy says.
"""

from __future__ import annotations

import pytest

from gcs.gate.effects import CommandKind, Say
from gcs.gate.inputs import HeartbeatSeen, MissionLoaded
from gcs.gate.requests import (
    Arm,
    Hold,
    Land,
    Resume,
    ReturnHome,
    StartMission,
    TakeControl,
    TakeOff,
)
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.reactions import (
    FLIGHT,
    Reaction,
    flight,
    reaction,
    state_of,
    streams,
    take_off,
)
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import UP, lead_to

FLIES_IN = {
    State.TAKING_OFF: {FlightMode.TAKEOFF, FlightMode.HOLD, FlightMode.GUIDED},
    State.HOVERING: {FlightMode.GUIDED},
    State.MOVING: {FlightMode.GUIDED},
    State.TAKING_PICTURE: {FlightMode.GUIDED},
    State.FLYING_MISSION: {FlightMode.MISSION},
    State.RETURNING: {FlightMode.RETURN},
    State.LANDING: {FlightMode.LAND},
    State.HOLDING: {FlightMode.HOLD},
}
"""A climb is flown in the take-off mode and ends in hold (px4), or in guided (ardupilot)."""

SAFE_MODES = {FlightMode.RETURN: State.RETURNING, FlightMode.LAND: State.LANDING}

FOREIGN = [
    (state, mode)
    for state in (*FLIGHT, State.HOLDING)
    for mode in FlightMode
    if mode not in FLIES_IN[state] and mode not in SAFE_MODES
]
PARTS_OF_A_FLIGHT = [
    (State.FLYING_MISSION, FlightMode.RETURN),
    (State.FLYING_MISSION, FlightMode.LAND),
    (State.RETURNING, FlightMode.LAND),
]
"""A mission may end in a return or a landing, and a return ends in a landing."""

FAILSAFES = [
    (state, mode)
    for state in (*FLIGHT, State.HOLDING)
    for mode in SAFE_MODES
    if mode not in FLIES_IN[state] and (state, mode) not in PARTS_OF_A_FLIGHT
]


def settled(state: State) -> tuple[Script, int]:
    """In `state` with every commanded mode shown, and too late for a guided mode of ours."""
    if state is State.HOVERING:
        script = Script(policy("default"))
        lead_to(State.HOVERING, script)
        return script, 0
    script, request_id = flight(state)
    if state is State.HOLDING:
        script.heartbeat(FlightMode.HOLD)
        script.wait(12.0)
    return script, request_id


@pytest.mark.parametrize(("state", "mode"), FOREIGN)
def test_a_mode_of_somebody_elses_takes_the_vehicle_over(state: State, mode: FlightMode) -> None:
    script, request_id = settled(state)
    taken = "" if state in (State.HOLDING, State.HOVERING) else "taken over MODE_CHANGED"
    assert reaction(script, request_id, lambda s: s.heartbeat(mode)) == Reaction(
        State.EXTERNAL, Control.NONE, [], taken
    )
    assert not streams(script)
    assert script.gate.active_goal_ned is None


@pytest.mark.parametrize(("state", "mode"), FAILSAFES)
def test_a_return_or_a_landing_of_the_vehicles_own_is_seen_as_one(
    state: State, mode: FlightMode
) -> None:
    script, request_id = settled(state)
    taken = "" if state in (State.HOLDING, State.HOVERING) else "taken over MODE_CHANGED"
    assert reaction(script, request_id, lambda s: s.heartbeat(mode)) == Reaction(
        SAFE_MODES[mode], Control.NONE, [], taken
    )
    assert not streams(script)


@pytest.mark.parametrize(("state", "mode"), PARTS_OF_A_FLIGHT)
def test_the_return_or_landing_that_belongs_to_the_flight_is_part_of_the_request(
    state: State, mode: FlightMode
) -> None:
    script, request_id = settled(state)
    assert reaction(script, request_id, lambda s: s.heartbeat(mode)) == Reaction(
        SAFE_MODES[mode], Control.OURS, [], ""
    )


@pytest.mark.parametrize("state", [*FLIGHT, State.HOLDING])
def test_the_modes_that_a_state_is_flown_in_change_nothing(state: State) -> None:
    script, request_id = settled(state)
    control = script.gate.control
    for mode in sorted(FLIES_IN[state]):
        script.heartbeat(mode)
        assert reaction(script, request_id, lambda s: s.heartbeat()) == Reaction(
            state, control, [], ""
        )


@pytest.mark.parametrize("mode", list(FlightMode))
def test_on_the_ground_no_mode_moves_anything(mode: FlightMode) -> None:
    script, request_id = flight(State.GROUNDED)
    assert reaction(script, request_id, lambda s: s.heartbeat(mode)) == Reaction(
        State.GROUNDED, Control.NONE, [], ""
    )


@pytest.mark.parametrize("mode", list(FlightMode))
def test_of_a_vehicle_that_somebody_else_flies_a_return_and_a_landing_are_seen(
    mode: FlightMode,
) -> None:
    script, request_id = flight(State.EXTERNAL)
    if mode is FlightMode.HOLD:
        script.heartbeat(FlightMode.OTHER)
    after = SAFE_MODES.get(mode, State.EXTERNAL)
    ended = "taken over MODE_CHANGED" if mode in SAFE_MODES else ""
    assert reaction(script, request_id, lambda s: s.heartbeat(mode)) == Reaction(
        after, Control.NONE, [], ended
    )


class TestWhileAModeIsWaitedFor:
    @pytest.mark.parametrize("mode", [m for m in FlightMode if m is not FlightMode.HOLD])
    def test_a_hold_that_is_not_shown_yet_is_not_given_up_for_another_mode(
        self, mode: FlightMode
    ) -> None:
        script, request_id = flight(State.HOLDING)
        script.heartbeat(FlightMode.OTHER if mode is FlightMode.GUIDED else FlightMode.GUIDED)
        assert reaction(script, request_id, lambda s: s.heartbeat(mode)) == Reaction(
            State.HOLDING, Control.OURS, [], ""
        )
        script.wait(1.1)
        assert script.commands() == [CommandKind.HOLD]

    @pytest.mark.parametrize(
        ("wanted", "state", "own"),
        [
            (Land(), State.LANDING, FlightMode.LAND),
            (ReturnHome(), State.RETURNING, FlightMode.RETURN),
            (StartMission(), State.FLYING_MISSION, FlightMode.MISSION),
        ],
        ids=["land", "return", "mission"],
    )
    @pytest.mark.parametrize("mode", list(FlightMode))
    def test_other_modes_are_still_those_of_before(
        self, wanted: Land | ReturnHome | StartMission, state: State, own: FlightMode,
        mode: FlightMode,
    ) -> None:  # fmt: skip
        script = Script(policy("default")).take_control(UP)
        script.feed(MissionLoaded("square", 5))
        request_id = script.ask(wanted)
        after = state
        if mode in SAFE_MODES and (state, mode) in PARTS_OF_A_FLIGHT:
            after = SAFE_MODES[mode]
        other = FlightMode.OTHER if mode is FlightMode.GUIDED else FlightMode.GUIDED
        script.heartbeat(other)
        assert state_of(script) is state
        assert reaction(script, request_id, lambda s: s.heartbeat(mode)) == Reaction(
            after, Control.OURS, [], ""
        )

    def test_control_is_confirmed_by_guided_and_by_nothing_else(self) -> None:
        script, request_id = flight(State.HOVERING)
        script.wait(1.2)
        script.heartbeat(FlightMode.HOLD)
        assert script.gate.control is Control.TAKING
        assert reaction(script, request_id, lambda s: s.heartbeat(FlightMode.GUIDED)) == Reaction(
            State.HOVERING, Control.OURS, [], "complete"
        )

    def test_while_control_is_taken_the_mode_of_a_pilot_ends_it(self) -> None:
        script, request_id = flight(State.HOVERING)
        script.wait(1.2)
        assert reaction(script, request_id, lambda s: s.heartbeat(FlightMode.OTHER)) == Reaction(
            State.EXTERNAL, Control.NONE, [], "taken over MODE_CHANGED"
        )

    def test_a_hold_shown_while_control_is_taken_is_the_mode_of_before(self) -> None:
        script = Script(policy("default"))
        script.mode = FlightMode.OTHER
        script.fly(UP)
        request_id = script.ask(TakeControl())
        assert reaction(script, request_id, lambda s: s.heartbeat(FlightMode.HOLD)) == Reaction(
            State.HOVERING, Control.TAKING, [], ""
        )


class TestAModeThatNeverComes:
    """The policy's time for the heartbeat to show a commanded mode is 5 s."""

    def overdue(self, wanted: Land | ReturnHome, mode: FlightMode) -> tuple[Script, int]:
        script = Script(policy("default")).take_control(UP)
        request_id = script.ask(wanted)
        script.heartbeat(mode)
        script.forget()
        script.wait(4.9)
        assert not script.ended(request_id)
        return script, request_id

    @pytest.mark.parametrize("wanted", [Land(), ReturnHome()], ids=["land", "return"])
    def test_a_vehicle_still_in_our_guided_mode_is_held(self, wanted: Land | ReturnHome) -> None:
        script, request_id = self.overdue(wanted, FlightMode.GUIDED)
        assert reaction(script, request_id, lambda s: s.wait(0.2)) == Reaction(
            State.HOLDING, Control.OURS, [CommandKind.HOLD], "timed out NO_ANSWER"
        )

    @pytest.mark.parametrize("wanted", [Land(), ReturnHome()], ids=["land", "return"])
    def test_a_vehicle_in_another_mode_is_somebody_elses(self, wanted: Land | ReturnHome) -> None:
        script, request_id = self.overdue(wanted, FlightMode.OTHER)
        assert reaction(script, request_id, lambda s: s.wait(0.2)) == Reaction(
            State.EXTERNAL, Control.NONE, [], "timed out NO_ANSWER"
        )

    def test_a_return_that_lands_at_once_shows_a_mode_of_its_own(self) -> None:
        script, request_id = self.overdue(ReturnHome(), FlightMode.LAND)
        assert reaction(script, request_id, lambda s: s.wait(0.2)) == Reaction(
            State.LANDING, Control.OURS, [], ""
        )
        assert reaction(script, request_id, lambda s: s.heartbeat(FlightMode.RETURN)) == Reaction(
            State.RETURNING, Control.NONE, [], "taken over MODE_CHANGED"
        )

    @pytest.mark.parametrize(
        ("mode", "after", "control", "sent"),
        [
            (FlightMode.GUIDED, State.HOLDING, Control.OURS, [CommandKind.HOLD]),
            (FlightMode.OTHER, State.EXTERNAL, Control.NONE, []),
        ],
    )
    def test_so_it_is_with_a_mission(
        self, mode: FlightMode, after: State, control: Control, sent: list[CommandKind]
    ) -> None:
        script = Script(policy("default")).take_control(UP)
        script.feed(MissionLoaded("square", 5))
        request_id = script.ask(StartMission())
        script.heartbeat(mode)
        script.wait(4.9)
        assert reaction(script, request_id, lambda s: s.wait(0.2)) == Reaction(
            after, control, sent, "timed out NO_ANSWER"
        )

    def test_a_mission_that_does_not_begin_on_the_ground_leaves_the_vehicle_there(self) -> None:
        script = Script(policy("default")).connect()
        script.ask(Arm())
        script.heartbeat(armed=True)
        script.feed(MissionLoaded("square", 5))
        request_id = script.ask(StartMission())
        script.wait(4.9)
        assert reaction(script, request_id, lambda s: s.wait(0.2)) == Reaction(
            State.GROUNDED, Control.NONE, [], "timed out NO_ANSWER"
        )

    def climb(self) -> tuple[Script, int]:
        """A take-off whose mode is not shown."""
        script = Script(policy("default")).connect()
        script.ask(Arm())
        script.heartbeat(armed=True)
        return script, script.ask(TakeOff(UP))

    def test_px4_may_have_passed_through_take_off_to_hold_unseen(self) -> None:
        script, request_id = self.climb()
        assert reaction(script, request_id, lambda s: s.wait(5.2)) == Reaction(
            State.TAKING_OFF, Control.OURS, [], ""
        )
        script.land_state(LandedState.IN_AIR)
        script.v_ned = (0.0, 0.0, -1.0)
        script.at(0.0, 0.0, UP, (0.0, 0.0, 1.0))
        script.tick()
        assert state_of(script) is State.HOVERING  # hold mode says that the climb is over

    def test_a_take_off_in_a_pilots_mode_stays_on_the_ground(self) -> None:
        script, request_id = self.climb()
        script.heartbeat(FlightMode.OTHER)
        assert reaction(script, request_id, lambda s: s.wait(5.2)) == Reaction(
            State.GROUNDED, Control.NONE, [], "timed out NO_ANSWER"
        )

    def test_a_take_off_in_a_pilots_mode_in_the_air_is_the_pilots(self) -> None:
        script, request_id = self.climb()
        script.heartbeat(FlightMode.OTHER)
        script.land_state(LandedState.IN_AIR)
        assert state_of(script) is State.TAKING_OFF
        assert reaction(script, request_id, lambda s: s.wait(5.2)) == Reaction(
            State.EXTERNAL, Control.NONE, [], "timed out NO_ANSWER"
        )

    def test_a_pilots_mode_after_the_take_off_mode_was_shown_ends_it_on_the_ground(self) -> None:
        script = Script(policy("default"))
        request_id = take_off(script)
        assert reaction(script, request_id, lambda s: s.heartbeat(FlightMode.OTHER)) == Reaction(
            State.GROUNDED, Control.NONE, [], "taken over MODE_CHANGED"
        )


class TestGuidedThatComesLate:
    """Our own guided command may take effect after it was given up: within 10 s it is ours."""

    def given_up(self) -> Script:
        script = Script(policy("default")).fly(UP)
        script.ask(TakeControl())
        script.wait(6.2)
        assert state_of(script) is State.EXTERNAL
        return script

    def test_somebody_elses_vehicle_that_goes_guided_for_us_is_held_until_it_shows(self) -> None:
        script = self.given_up()
        unchanged = Reaction(State.EXTERNAL, Control.NONE, [], "")
        again = unchanged._replace(sent=[CommandKind.HOLD])
        assert reaction(script, 0, lambda s: s.heartbeat(FlightMode.GUIDED)) == again
        assert reaction(script, 0, lambda s: s.wait(1.0)) == again
        assert reaction(script, 0, lambda s: s.heartbeat(FlightMode.HOLD)) == unchanged
        assert reaction(script, 0, lambda s: s.wait(3.0)) == unchanged

    @pytest.mark.parametrize("mode", [FlightMode.OTHER, FlightMode.MISSION, FlightMode.TAKEOFF])
    def test_a_hold_that_nobody_asked_for_gives_way_to_a_mode_that_somebody_chose(
        self, mode: FlightMode
    ) -> None:
        script = self.given_up()
        script.heartbeat(FlightMode.GUIDED)
        unchanged = Reaction(State.EXTERNAL, Control.NONE, [], "")
        assert reaction(script, 0, lambda s: s.heartbeat(mode)) == unchanged
        assert reaction(script, 0, lambda s: s.wait(3.0)) == unchanged

    def test_later_it_is_somebody_elses(self) -> None:
        script = self.given_up()
        script.wait(5.0)
        assert reaction(script, 0, lambda s: s.heartbeat(FlightMode.GUIDED)) == Reaction(
            State.EXTERNAL, Control.NONE, [], ""
        )

    def test_a_held_vehicle_that_goes_guided_for_us_is_held_again_until_it_shows(self) -> None:
        script = Script(policy("default"))
        lead_to(State.HOLDING, script)
        script.ask(Resume())
        script.wait(1.2)
        script.ask(Hold())
        script.heartbeat(FlightMode.HOLD)
        assert reaction(script, 0, lambda s: s.heartbeat(FlightMode.GUIDED)) == Reaction(
            State.HOLDING, Control.OURS, [CommandKind.HOLD], ""
        )
        assert reaction(script, 0, lambda s: s.wait(1.1)).sent == [CommandKind.HOLD]


def test_a_mode_that_is_only_repeated_says_nothing() -> None:
    script, _ = flight(State.MOVING)
    beat = HeartbeatSeen(script.armed, script.mode, script.mode.value)
    assert [e for e in script.feed(beat) if not isinstance(e, Say)] == []
