"""A hold that is commanded and not shown yet: on the ground, with old positions, past its time."""

from __future__ import annotations

import pytest

from gcs.gate.effects import CommandKind, SendCommand
from gcs.gate.inputs import CommandEnded
from gcs.gate.machine.memory import GATE
from gcs.gate.requests import Abort, Disarm, Hold, TakeControl, TakePhoto
from gcs.gate.states import Control, FlightMode, LandedState, State
from tests.unit.gate.reactions import (
    HELD,
    Reaction,
    default_policy,
    ended,
    flight,
    reaction,
    remember,
    state_of,
    take_off,
)
from tests.unit.gate.script import MS, Script, policy
from tests.unit.gate.situations import UP

FAILED = 4


def given_up(wanted: Hold | Abort, after_s: float = 0.0) -> tuple[Script, int]:
    """A take-off that is stopped on the ground `after_s` after it was commanded."""
    script = Script(policy("default"))
    take_off(script)
    script.wait(after_s)
    request_id = script.ask(wanted)
    assert script.commands()[-2:] == [CommandKind.HOLD, CommandKind.DISARM]
    return script, request_id


def test_a_hold_of_what_is_disarmed_is_not_repeated() -> None:
    script, request_id = given_up(Abort())
    script.heartbeat(armed=False)
    assert ended(script, request_id) == "complete"
    script.forget()
    script.wait(3.0)
    assert script.commands() == []


@pytest.mark.parametrize("old", [True, False])
def test_nor_is_one_of_what_refuses_to_disarm_and_cannot_lift_off_any_more(old: bool) -> None:
    """Ten seconds after it was commanded our own take-off comes no more."""
    script, request_id = given_up(Abort(), 9.5)
    script.reports_position = not old
    script.wait(1.2)
    assert state_of(script) is (State.STALE if old else State.GROUNDED)
    script.answer(CommandKind.DISARM, FAILED)
    assert ended(script, request_id) == "aborted VEHICLE_REFUSED"
    script.forget()
    script.wait(3.0)
    assert script.commands() == []


def test_what_lifts_off_all_the_same_is_held_in_the_air() -> None:
    script, request_id = given_up(Hold())
    script.wait(10.5)
    assert state_of(script) is State.GROUNDED
    found = reaction(script, request_id, lambda s: s.land_state(LandedState.IN_AIR))
    assert found[:3] == HELD


def hold_not_shown(state: State) -> tuple[Script, int]:
    """A hold was asked for in `state`, this instant, and is not shown."""
    if state is State.HOLDING:
        return flight(state)
    script = Script(policy("default"))
    take_off(script)
    script.answer(CommandKind.TAKE_OFF, None)
    if state is State.STALE:
        script.reports_position = False
        script.wait(1.2)
    request_id = script.ask(Hold())
    assert state_of(script) is state
    return script, request_id


@pytest.mark.parametrize("state", [State.GROUNDED, State.STALE, State.HOLDING])
def test_past_its_request_it_is_repeated_at_once_in_the_gates_own_name(state: State) -> None:
    script, request_id = hold_not_shown(state)
    script.wait(4.95)
    assert not script.ended(request_id)
    script.forget()
    script.now_ns += 50 * MS
    script.ask(TakePhoto())
    assert ended(script, request_id) == "timed out NO_ANSWER"
    assert [(s.request_id, s.kind) for s in script.all(SendCommand)] == [(GATE, CommandKind.HOLD)]


def test_the_one_hold_for_our_late_guided_is_the_gates_own() -> None:
    """The request under way is a forced disarm, and has nothing to do with it."""
    script = Script(default_policy(allow_force_disarm=True)).fly(UP)
    script.ask(TakeControl())
    script.wait(1.1)
    assert script.commands() == [CommandKind.GUIDED]
    script.ask(Disarm(force=True))
    request_id = script.ask(Disarm(force=True))
    script.forget()
    script.heartbeat(FlightMode.GUIDED)
    assert state_of(script) is State.EXTERNAL
    assert not script.ended(request_id)
    assert [(s.request_id, s.kind) for s in script.all(SendCommand)] == [(GATE, CommandKind.HOLD)]


@pytest.mark.parametrize("state", [State.GROUNDED, State.STALE, State.HOLDING, State.EXTERNAL])
def test_another_mode_that_is_shown_completes_no_hold(state: State) -> None:
    script, request_id = hold_not_shown(State.HOLDING)
    remember(script, state=state, hold_again_ns=None, asked_mode=FlightMode.LAND, back_to=None)
    script.heartbeat(FlightMode.LAND)
    assert not script.ended(request_id)


def test_a_hold_that_is_refused_ends_its_request_where_somebody_else_flies() -> None:
    script, request_id = hold_not_shown(State.HOLDING)
    remember(script, state=State.EXTERNAL, control=Control.NONE)
    refused = CommandEnded(request_id, CommandKind.HOLD, FAILED, "")
    assert reaction(script, request_id, lambda s: s.feed(refused)) == Reaction(
        State.EXTERNAL, Control.NONE, [], "aborted VEHICLE_REFUSED"
    )
