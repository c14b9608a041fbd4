"""In which states setpoints leave, and to which goal (invariant 1)."""

from __future__ import annotations

import pytest

from gcs.gate.airspace.pace import Paced
from gcs.gate.effects import SendSetpoint
from gcs.gate.inputs import Tick
from gcs.gate.machine.memory import Goal
from gcs.gate.machine.table import STREAMS, Streams
from gcs.gate.requests import GoTo
from gcs.gate.states import Control, State
from tests.unit.gate.script import SECOND, Script, policy
from tests.unit.gate.situations import STATES, UP, flight, remember

# Within half a metre the goal itself is sent.
HELD = Goal((0.1, 0.2, -UP), None, ())
FLOWN_TO = Goal((0.3, -0.3, -UP), None, ())

STREAMED = {
    State.HOVERING: HELD,
    State.MOVING: FLOWN_TO,
    State.STREAMING: HELD,
    State.TAKING_PICTURE: HELD,
    State.HOLDING: HELD,
}
"""All others send none; STALE goes on as before for its grace.  STREAMING holds in place of the
stream as long as no sample is flown."""


def sent(script: Script) -> list[tuple[float, float, float] | None]:
    effects = script.feed(Tick(0))
    return [effect.permit.pos_ned for effect in effects if isinstance(effect, SendSetpoint)]


@pytest.mark.parametrize("state", [s for s in (*STATES, State.STREAMING) if s is not State.STALE])
def test_a_tick_sends_the_goal_of_the_state_or_nothing(state: State) -> None:
    """Also where memory holds goals, control and a grace that the state never has."""
    script, _ = flight(State.MOVING if state is State.STREAMING else state)
    remember(
        script,
        state=state,
        control=Control.OURS,
        hold=HELD,
        goal=FLOWN_TO,
        back_to=State.HOVERING,
        grace_until_ns=script.now_ns + SECOND,
    )
    expected = STREAMED.get(state)
    assert sent(script) == ([] if expected is None else [expected.pos_ned])


@pytest.mark.parametrize("before", [State.HOVERING, State.MOVING, State.FLYING_MISSION])
@pytest.mark.parametrize("in_grace", [True, False])
def test_with_a_position_too_old_it_goes_on_as_before_for_the_grace_only(
    before: State, in_grace: bool
) -> None:
    """With what was sent last on the way to its goal; on another way nothing is sent."""
    goal = STREAMED.get(before)
    for on_this_way in (True, False):
        script, _ = flight(State.STALE)
        until_ns = script.now_ns + SECOND if in_grace else None
        remember(script, hold=HELD, goal=FLOWN_TO, back_to=before, grace_until_ns=until_ns)
        to_ned = goal.pos_ned if goal is not None and on_this_way else (9.0, 9.0, -UP)
        last_ned = (0.05, 0.06, -UP)
        remember(script, paced=Paced(to_ned, last_ned, (0.1, 0.1, 0.0)))
        goes_on = goal is not None and in_grace and on_this_way
        assert sent(script) == ([last_ned] if goes_on else [])


def test_while_a_goal_is_judged_the_hold_goal_is_the_one_that_is_sent() -> None:
    """VERIFYING ends within its tick, so no tick of its own shows it."""
    script = Script(policy("default")).take_control(UP)
    script.ask(GoTo((0.0, 3.0, -UP)))
    script.forget()
    script.tick()
    assert script.states() == [State.VERIFYING, State.MOVING]
    assert len(script.all(SendSetpoint)) == 1
    assert STREAMS[State.VERIFYING] is Streams.HOLD_GOAL
