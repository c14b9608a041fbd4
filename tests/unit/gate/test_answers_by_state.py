"""What the answers of the vehicle do in each state: an answer only ends a command (DESIGN 4)."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from gcs.gate.effects import CommandKind, Say
from gcs.gate.inputs import CommandEnded, MissionLoaded, MissionSeen, PhotoSeen
from gcs.gate.requests import (
    Abort,
    Arm,
    Disarm,
    Hold,
    Land,
    Request,
    ReturnHome,
    StartMission,
    TakeOff,
)
from gcs.gate.states import Control, FlightMode, State
from tests.unit.gate.reactions import (
    HELD,
    Reaction,
    flight,
    reaction,
    remember,
    state_of,
    streams,
    take_off,
)
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import UP, lead_to

REFUSED, SILENT = 2, None
GIVEN_UP = (State.EXTERNAL, Control.NONE, [CommandKind.HOLD])

COMMAND = {
    State.GROUNDED: CommandKind.ARM,
    State.TAKING_OFF: CommandKind.TAKE_OFF,
    State.HOVERING: CommandKind.GUIDED,
    State.TAKING_PICTURE: CommandKind.PHOTO,
    State.FLYING_MISSION: CommandKind.START_MISSION,
    State.RETURNING: CommandKind.RETURN,
    State.LANDING: CommandKind.LAND,
    State.HOLDING: CommandKind.HOLD,
    State.EXTERNAL: CommandKind.FORCE_DISARM,
}
"""What a state waits for an answer to."""

COMES_DOWN: dict[State, Request] = {State.RETURNING: ReturnHome(), State.LANDING: Land()}

LEADS_TO = {
    State.GROUNDED: (State.GROUNDED, Control.NONE, []),
    State.TAKING_OFF: HELD,
    State.HOVERING: GIVEN_UP,
    State.TAKING_PICTURE: (State.HOVERING, Control.OURS, []),
    State.FLYING_MISSION: HELD,
    State.RETURNING: HELD,
    State.LANDING: HELD,
    State.EXTERNAL: (State.EXTERNAL, Control.NONE, []),
}
"""What follows where the vehicle does not do it: a vehicle of ours that would fly on by itself, or
whose control we asked for, is held; with a picture missing, hovering goes on."""


def asked(state: State) -> tuple[Script, int]:
    """The command has left, and is not answered; the vehicle shows the mode it was in before."""
    if state in COMES_DOWN:
        script, _ = flight(State.HOVERING)
        script.wait(2.0)
        return script, script.ask(COMES_DOWN[state])
    script, request_id = flight(state)
    if state is State.HOVERING:
        script.wait(1.2)
    return script, request_id


@pytest.mark.parametrize("state", COMMAND)
def test_an_acknowledgement_moves_nothing(state: State) -> None:
    script, request_id = asked(state)
    control = script.gate.control
    told = CommandEnded(request_id, COMMAND[state], 0)
    assert reaction(script, request_id, lambda s: s.feed(told)) == Reaction(state, control, [], "")


@pytest.mark.parametrize(
    ("result", "how"), [(REFUSED, "aborted VEHICLE_REFUSED"), (SILENT, "timed out NO_ANSWER")]
)
@pytest.mark.parametrize("state", LEADS_TO)
def test_a_refusal_or_no_answer_ends_the_request(
    state: State, result: int | None, how: str
) -> None:
    script, request_id = asked(state)
    if state in (State.TAKING_OFF, State.FLYING_MISSION):
        remember(script, mode=FlightMode.HOLD)
    told = CommandEnded(request_id, COMMAND[state], result)
    assert reaction(script, request_id, lambda s: s.feed(told)) == Reaction(*LEADS_TO[state], how)


@pytest.mark.parametrize(
    ("state", "shown"),
    [
        (State.RETURNING, FlightMode.RETURN),
        (State.RETURNING, FlightMode.LAND),
        (State.LANDING, FlightMode.LAND),
        (State.TAKING_OFF, FlightMode.TAKEOFF),
        (State.FLYING_MISSION, FlightMode.MISSION),
    ],
)
@pytest.mark.parametrize(
    ("result", "after", "how"),
    [
        (SILENT, None, ""),
        (REFUSED, HELD, "aborted VEHICLE_REFUSED"),
    ],
)
def test_a_lost_answer_is_nothing_where_the_vehicle_shows_that_it_does_it(
    state: State,
    shown: FlightMode,
    result: int | None,
    after: tuple[State, Control, list[CommandKind]] | None,
    how: str,
) -> None:
    script, request_id = asked(state)
    script.heartbeat(shown)
    came = state_of(script)
    told = CommandEnded(request_id, COMMAND[state], result)
    wanted = Reaction(*(after or (came, script.gate.control, [])), how)
    assert reaction(script, request_id, lambda s: s.feed(told)) == wanted


@pytest.mark.parametrize(
    ("result", "sent", "how"),
    [
        (REFUSED, [], "aborted VEHICLE_REFUSED"),
        (SILENT, [CommandKind.HOLD, CommandKind.DISARM], "timed out NO_ANSWER"),
    ],
)
@pytest.mark.parametrize("kind", [CommandKind.TAKE_OFF, CommandKind.START_MISSION])
def test_what_did_not_leave_the_ground_stays_there(
    kind: CommandKind, result: int | None, sent: list[CommandKind], how: str
) -> None:
    """A command that may come late yet finds a vehicle that is disarmed."""
    script = Script(policy("default"))
    if kind is CommandKind.TAKE_OFF:
        request_id = take_off(script)
        remember(script, mode=FlightMode.HOLD)
    else:
        lead_to(State.GROUNDED, script)
        script.feed(MissionLoaded("square", 4))
        request_id = script.ask(StartMission())
    told = CommandEnded(request_id, kind, result)
    assert reaction(script, request_id, lambda s: s.feed(told)) == Reaction(
        State.GROUNDED, Control.NONE, sent, how
    )


@pytest.mark.parametrize(
    ("result", "how"), [(REFUSED, "aborted VEHICLE_REFUSED"), (SILENT, "timed out NO_ANSWER")]
)
@pytest.mark.parametrize("state", [State.TAKING_PICTURE, State.FLYING_MISSION, State.TAKING_OFF])
def test_with_a_position_too_old_the_stream_ends_and_the_vehicle_is_held(
    state: State, result: int | None, how: str
) -> None:
    script, request_id = asked(state)
    script.reports_position = False
    script.wait(1.2)
    assert state_of(script) is State.STALE
    told = CommandEnded(request_id, COMMAND[state], result)
    assert reaction(script, request_id, lambda s: s.feed(told)) == Reaction(
        State.STALE, Control.OURS, [CommandKind.HOLD], how
    )
    assert not streams(script)
    script.reports_position = True
    script.tick()
    assert state_of(script) is State.HOLDING


@pytest.mark.parametrize(
    ("result", "how"), [(REFUSED, "aborted VEHICLE_REFUSED"), (SILENT, "timed out NO_ANSWER")]
)
def test_an_arming_that_fails_while_the_position_is_too_old_just_ends(
    result: int | None, how: str
) -> None:
    script, request_id = asked(State.GROUNDED)
    script.reports_position = False
    script.wait(1.2)
    told = CommandEnded(request_id, CommandKind.ARM, result)
    assert reaction(script, request_id, lambda s: s.feed(told)) == Reaction(
        State.STALE, Control.NONE, [], how
    )


@pytest.mark.parametrize("state", [*COMMAND, State.MOVING, State.STALE, State.NO_VEHICLE])
def test_an_answer_that_nobody_waits_for_is_told_and_not_acted_on(state: State) -> None:
    script, _ = flight(state)
    before = script.gate.memory
    for result in (0, REFUSED, SILENT):
        effects = script.feed(CommandEnded(-1, CommandKind.LAND, result))
        assert all(isinstance(effect, Say) for effect in effects)
    assert script.gate.memory == before


class TestHold:
    @pytest.mark.parametrize("state", [State.HOLDING, State.STALE, State.NO_VEHICLE])
    def test_no_answer_is_asked_again_at_the_next_second(self, state: State) -> None:
        script, _ = flight(state)
        hold = script.ask(Abort()) if state is not State.HOLDING else script._next_id
        after = state_of(script)
        told = CommandEnded(hold, CommandKind.HOLD, SILENT)
        assert reaction(script, hold, lambda s: s.feed(told)).ended == ""
        assert reaction(script, hold, lambda s: s.wait(1.1)).sent == [CommandKind.HOLD]
        assert state_of(script) is after

    def test_a_refusal_of_the_gates_own_hold_ends_no_request_and_it_is_asked_again(self) -> None:
        script, request_id = flight(State.TAKING_OFF)
        script.feed(CommandEnded(request_id, CommandKind.TAKE_OFF, REFUSED))
        assert state_of(script) is State.HOLDING
        for _ in range(3):
            script.forget()
            script.feed(CommandEnded(0, CommandKind.HOLD, REFUSED))
            script.wait(1.1)
            assert script.commands() == [CommandKind.HOLD]
        assert state_of(script) is State.HOLDING

    @pytest.mark.parametrize("wanted", [Hold(), Abort()])
    def test_a_refused_hold_ends_the_request_for_it(self, wanted: Hold | Abort) -> None:
        script, _ = flight(State.MOVING)
        request_id = script.ask(wanted)
        script.feed(CommandEnded(request_id, CommandKind.HOLD, REFUSED))
        assert script.outcome(request_id).code == "VEHICLE_REFUSED"
        assert state_of(script) is State.HOLDING


class TestDisarm:
    def standing(self) -> tuple[Script, int]:
        script = Script(policy("default"))
        lead_to(State.GROUNDED, script)
        return script, script.ask(Disarm())

    def test_refused_on_the_ground_it_just_ends(self) -> None:
        script, request_id = self.standing()
        told = CommandEnded(request_id, CommandKind.DISARM, REFUSED)
        assert reaction(script, request_id, lambda s: s.feed(told)) == Reaction(
            State.GROUNDED, Control.NONE, [], "aborted VEHICLE_REFUSED"
        )

    def test_refused_where_a_take_off_may_come_yet_it_is_held(self) -> None:
        script = Script(policy("default"))
        take_off(script)
        request_id = script.ask(Disarm())
        assert state_of(script) is State.GROUNDED
        told = CommandEnded(request_id, CommandKind.DISARM, REFUSED)
        assert reaction(script, request_id, lambda s: s.feed(told)) == Reaction(
            State.GROUNDED, Control.NONE, [CommandKind.HOLD], "aborted VEHICLE_REFUSED"
        )
        assert reaction(script, request_id, lambda s: s.wait(1.1)).sent == [CommandKind.HOLD]

    def test_refused_where_it_is_not_known_to_stand_it_is_held(self) -> None:
        script = Script(policy("default"))
        lead_to(State.GROUNDED, script)
        script.reports_landed = False
        script.wait(4.0)
        request_id = script.ask(Disarm())
        told = CommandEnded(request_id, CommandKind.DISARM, REFUSED)
        assert reaction(script, request_id, lambda s: s.feed(told)) == Reaction(
            *HELD, "aborted VEHICLE_REFUSED"
        )

    def test_refused_while_the_position_is_too_old_it_just_ends(self) -> None:
        script, request_id = self.standing()
        script.reports_position = False
        script.wait(1.2)
        assert state_of(script) is State.STALE
        told = CommandEnded(request_id, CommandKind.DISARM, REFUSED)
        assert reaction(script, request_id, lambda s: s.feed(told)) == Reaction(
            State.STALE, Control.NONE, [], "aborted VEHICLE_REFUSED"
        )

    def test_or_is_held_where_a_take_off_may_come_yet(self) -> None:
        script = Script(policy("default"))
        take_off(script)
        script.reports_position = False
        script.wait(1.2)
        request_id = script.ask(Disarm())
        told = CommandEnded(request_id, CommandKind.DISARM, REFUSED)
        assert reaction(script, request_id, lambda s: s.feed(told)) == Reaction(
            State.STALE, Control.NONE, [CommandKind.HOLD], "aborted VEHICLE_REFUSED"
        )

    def test_not_answered_it_is_timed_out(self) -> None:
        script, request_id = self.standing()
        told = CommandEnded(request_id, CommandKind.DISARM, SILENT)
        assert reaction(script, request_id, lambda s: s.feed(told)) == Reaction(
            State.GROUNDED, Control.NONE, [], "timed out NO_ANSWER"
        )


class TestPictures:
    @pytest.mark.parametrize(
        "state",
        [s for s in (*COMMAND, State.MOVING, State.STALE) if s is not State.TAKING_PICTURE],
    )
    @pytest.mark.parametrize("ok", [True, False])
    def test_one_that_nobody_asked_for_changes_nothing(self, state: State, ok: bool) -> None:
        script, request_id = flight(state)
        control = script.gate.control
        assert reaction(script, request_id, lambda s: s.feed(PhotoSeen(4, ok))) == Reaction(
            state, control, [], ""
        )

    @pytest.mark.parametrize(
        ("ok", "how"), [(True, "complete"), (False, "aborted VEHICLE_REFUSED")]
    )
    def test_ours_ends_the_request(self, ok: bool, how: str) -> None:
        script, request_id = flight(State.TAKING_PICTURE)
        assert reaction(script, request_id, lambda s: s.feed(PhotoSeen(4, ok))) == Reaction(
            State.HOVERING, Control.OURS, [], how
        )


def ends_with(seen: MissionSeen | None) -> Callable[[Script], None]:
    """A mission ends: it is reported, or (None) shown by the hold mode."""

    def happens(script: Script) -> None:
        if seen is None:
            script.heartbeat(FlightMode.HOLD)
        else:
            script.feed(seen)

    return happens


class TestMissions:
    @pytest.mark.parametrize("finished", [True, False])
    @pytest.mark.parametrize(
        "state",
        [s for s in (*COMMAND, State.MOVING, State.STALE) if s is not State.FLYING_MISSION],
    )
    def test_items_of_a_mission_that_does_not_fly_change_nothing(
        self, state: State, finished: bool
    ) -> None:
        script, request_id = flight(state)
        control = script.gate.control
        seen = MissionSeen(3, 4, finished)
        assert reaction(script, request_id, lambda s: s.feed(seen)) == Reaction(
            state, control, [], ""
        )

    def test_an_item_changes_nothing(self) -> None:
        script, request_id = flight(State.FLYING_MISSION)
        seen = MissionSeen(3, 5, finished=False)
        assert reaction(script, request_id, lambda s: s.feed(seen)) == Reaction(
            State.FLYING_MISSION, Control.OURS, [], ""
        )

    def test_after_the_last_control_is_taken_at_the_place(self) -> None:
        script, request_id = flight(State.FLYING_MISSION)
        seen = MissionSeen(4, 5, finished=True)
        assert reaction(script, request_id, lambda s: s.feed(seen)) == Reaction(
            State.HOVERING, Control.TAKING, [], ""
        )
        assert streams(script)

    def test_where_the_place_does_not_clear_it_is_complete_and_held(self) -> None:
        """Inside the fence, and higher than the policy lets a vehicle hover."""
        for end in (MissionSeen(4, 5, finished=True), None):
            script, request_id = flight(State.FLYING_MISSION, max_up_m=10.0)
            script.feed(MissionSeen(4, 5, finished=False))
            script.at(0.0, 0.0, 12.0)
            assert state_of(script) is State.FLYING_MISSION
            assert reaction(script, request_id, ends_with(end)) == Reaction(*HELD, "complete")

    def test_on_the_ground_the_landing_completes_it(self) -> None:
        script = Script(policy("default"))
        lead_to(State.GROUNDED, script)
        script.feed(MissionLoaded("square", 4))
        request_id = script.ask(StartMission())
        script.heartbeat(FlightMode.MISSION)
        seen = MissionSeen(3, 4, finished=True)
        assert reaction(script, request_id, lambda s: s.feed(seen)) == Reaction(
            State.FLYING_MISSION, Control.OURS, [], ""
        )

    def test_px4_shows_its_end_by_the_hold_mode(self) -> None:
        script, request_id = flight(State.FLYING_MISSION)
        script.feed(MissionSeen(4, 5, finished=False))
        assert reaction(script, request_id, lambda s: s.heartbeat(FlightMode.HOLD)) == Reaction(
            State.HOVERING, Control.TAKING, [], ""
        )

    def test_not_known_to_fly_it_is_complete_and_held(self) -> None:
        for end in (MissionSeen(4, 5, finished=True), None):
            script, request_id = flight(State.FLYING_MISSION)
            script.feed(MissionSeen(4, 5, finished=False))
            script.reports_landed = False
            script.wait(4.0)
            assert reaction(script, request_id, ends_with(end)) == Reaction(*HELD, "complete")


class TestCommandsThatWaitForAMode:
    def test_ardupilot_climbs_once_it_shows_guided(self) -> None:
        script = Script(policy("default"), "ardupilot").connect()
        script.ask(Arm())
        script.heartbeat(FlightMode.GUIDED)
        script.heartbeat(armed=True)
        script.heartbeat(FlightMode.HOLD)
        request_id = script.ask(TakeOff(UP))
        assert script.commands()[-1] is CommandKind.GUIDED
        assert reaction(script, request_id, lambda s: s.heartbeat(FlightMode.GUIDED)) == Reaction(
            State.TAKING_OFF, Control.OURS, [CommandKind.TAKE_OFF], ""
        )
        assert script.gate.memory.asked_mode is None
        assert reaction(script, request_id, lambda s: s.wait(6.0)) == Reaction(
            State.TAKING_OFF, Control.OURS, [], ""
        )

    def test_ardupilot_arms_once_it_shows_guided(self) -> None:
        script = Script(policy("default"), "ardupilot").connect()
        request_id = script.ask(Arm())
        found = reaction(script, request_id, lambda s: s.heartbeat(FlightMode.GUIDED))
        assert found.sent == [CommandKind.ARM]
        assert script.gate.memory.asked_mode is None

    def test_a_mode_for_arming_that_never_comes_is_not_waited_for_longer(self) -> None:
        script = Script(policy("default"), "ardupilot").connect()
        request_id = script.ask(Arm())
        assert reaction(script, request_id, lambda s: s.wait(5.1)) == Reaction(
            State.GROUNDED, Control.NONE, [], "timed out NO_ANSWER"
        )
        assert reaction(script, request_id, lambda s: s.heartbeat(FlightMode.GUIDED)).sent == []
