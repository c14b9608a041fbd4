"""The modes in which a vehicle flies what we commanded, and what else shows that it does not.

They are asked for in STALE, where the state that was interrupted counts, and where a mode that
was commanded is overdue.
"""

from __future__ import annotations

import pytest

from gcs.gate.effects import CommandKind
from gcs.gate.inputs import Tick
from gcs.gate.requests import Abort, TakeControl
from gcs.gate.states import Control, FlightMode, State
from tests.unit.gate.reactions import Reaction, flight, reaction, remember, stale, state_of
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import UP

GUIDED = {FlightMode.GUIDED}

FLOWN_IN = {
    State.TAKING_OFF: {FlightMode.TAKEOFF, FlightMode.HOLD, FlightMode.GUIDED},
    State.HOVERING: GUIDED,
    State.MOVING: GUIDED,
    State.STREAMING: GUIDED,
    State.TAKING_PICTURE: GUIDED,
    State.FLYING_MISSION: {FlightMode.MISSION},
    State.HOLDING: {FlightMode.HOLD},
}

SEEN = (
    FlightMode.GUIDED,
    FlightMode.HOLD,
    FlightMode.TAKEOFF,
    FlightMode.MISSION,
    FlightMode.OTHER,
)
"""Return and land are the vehicle's own way down, whatever was interrupted."""


def another(mode: FlightMode) -> FlightMode:
    return FlightMode.OTHER if mode is not FlightMode.OTHER else FlightMode.HOLD


def interrupted(state: State, mode: FlightMode) -> tuple[Script, int]:
    """STALE out of `state`, under our control, with another mode shown and none awaited."""
    script, request_id = stale(State.MOVING if state is State.STREAMING else state)
    remember(
        script,
        back_to=state,
        control=Control.OURS,
        mode=another(mode),
        asked_mode=None,
        hold_again_ns=None,
    )
    return script, request_id


@pytest.mark.parametrize("mode", SEEN)
@pytest.mark.parametrize("state", FLOWN_IN)
def test_a_mode_that_belongs_to_what_was_interrupted_takes_nothing_over(
    state: State, mode: FlightMode
) -> None:
    script, request_id = interrupted(state, mode)
    fits = mode in FLOWN_IN[state]
    assert reaction(script, request_id, lambda s: s.heartbeat(mode)) == Reaction(
        State.STALE,
        Control.OURS if fits else Control.NONE,
        [],
        "" if fits else "taken over MODE_CHANGED",
    )


@pytest.mark.parametrize("mode", SEEN)
def test_while_control_is_being_taken_the_hold_of_before_fits_too(mode: FlightMode) -> None:
    script, request_id = interrupted(State.HOVERING, mode)
    remember(script, control=Control.TAKING)
    fits = mode in {FlightMode.GUIDED, FlightMode.HOLD}
    assert reaction(script, request_id, lambda s: s.heartbeat(mode)) == Reaction(
        State.STALE,
        Control.TAKING if fits else Control.NONE,
        [],
        "" if fits else "taken over MODE_CHANGED",
    )


AWAITED = {
    State.TAKING_OFF: FlightMode.TAKEOFF,
    State.FLYING_MISSION: FlightMode.MISSION,
    State.RETURNING: FlightMode.RETURN,
    State.LANDING: FlightMode.LAND,
}

ON_ITS_WAY = {
    State.TAKING_OFF: FLOWN_IN[State.TAKING_OFF],
    State.FLYING_MISSION: FLOWN_IN[State.FLYING_MISSION],
    State.RETURNING: {FlightMode.RETURN, FlightMode.LAND},
    State.LANDING: {FlightMode.LAND},
}


@pytest.mark.parametrize(
    ("state", "mode"),
    [(state, mode) for state, modes in ON_ITS_WAY.items() for mode in sorted(modes)],
)
def test_an_awaited_mode_that_is_overdue_is_no_loss_in_a_mode_that_fits(
    state: State, mode: FlightMode
) -> None:
    script, request_id = flight(state)
    remember(
        script,
        mode=mode,
        asked_mode=AWAITED[state],
        asked_until_ns=script.now_ns,
        v_ned=(0.0, 0.0, -1.0),
    )
    assert reaction(script, request_id, lambda s: s.feed(Tick(0))) == Reaction(
        state, Control.OURS, [], ""
    )
    assert script.gate.memory.asked_mode is None


@pytest.mark.parametrize("state", AWAITED)
def test_in_any_other_mode_somebody_else_flies(state: State) -> None:
    script, request_id = flight(state)
    remember(
        script,
        mode=FlightMode.OTHER,
        asked_mode=AWAITED[state],
        asked_until_ns=script.now_ns,
    )
    assert reaction(script, request_id, lambda s: s.feed(Tick(0))) == Reaction(
        State.EXTERNAL, Control.NONE, [], "timed out NO_ANSWER"
    )


@pytest.mark.parametrize(
    "mode",
    [
        FlightMode.TAKEOFF,
        FlightMode.MISSION,
        FlightMode.RETURN,
        FlightMode.LAND,
        FlightMode.OTHER,
    ],
)
def test_a_hold_that_was_refused_is_asked_for_again_whatever_the_mode(mode: FlightMode) -> None:
    """Its request ended with the refusal; the hold itself is still wanted."""
    script, _ = stale(State.MOVING)
    request_id = script.ask(Abort())
    script.answer(CommandKind.HOLD, 4)
    assert reaction(script, request_id, lambda s: s.heartbeat(mode)) == Reaction(
        State.STALE, Control.OURS, [], ""
    )
    script.position()
    assert state_of(script) is State.HOLDING


def test_guided_is_asked_for_and_awaited_only_with_a_fresh_position() -> None:
    """The time of the request began with it: what the outage took is not given back."""
    script = Script(policy("default")).fly(UP)
    request_id = script.ask(TakeControl())
    script.reports_position = False
    script.wait(1.3)
    assert state_of(script) is State.STALE
    assert script.commands() == []
    script.reports_position = True
    script.tick()
    assert script.commands() == [CommandKind.GUIDED]
    assert state_of(script) is State.HOVERING
    script.wait(4.65)
    assert not script.ended(request_id)
    assert reaction(script, request_id, lambda s: s.wait(0.1)) == Reaction(
        State.EXTERNAL, Control.NONE, [CommandKind.HOLD], "timed out NO_ANSWER"
    )
