"""A return is cleared by the ways to every place where it may end, and to home."""

from __future__ import annotations

import pytest

from gcs.gate.airspace.return_place import ReturnPlace
from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import CommandKind, Ruling
from gcs.gate.inputs import ConditionChanged, ReturnPlacesSeen
from gcs.gate.refusal import Code
from gcs.gate.requests import ReturnHome
from gcs.gate.states import State
from tests.unit.gate.airspace import at
from tests.unit.gate.script import policy
from tests.unit.gate.situations import AIRBORNE, flight, state_of

NEAR = ReturnPlace("rally point 1", at(2, 0, 0))
OUTSIDE = ReturnPlace("rally point 2", at(0, 500, 0))
TOO_HIGH = ReturnPlace("rally point 3", at(2, 0, 0), over_up_m=200.0)
BLOCKED = [state for state in AIRBORNE if state is not State.LANDING]


@pytest.mark.parametrize("state", AIRBORNE)
def test_clear_ways_to_home_and_to_each_place_clear_it(state: State) -> None:
    script, _ = flight(state)
    script.feed(ReturnPlacesSeen((NEAR,)))
    asked = script.ask(ReturnHome())
    assert script.verdict(asked).ruling is Ruling.ACCEPTED
    assert state_of(script) is State.RETURNING


@pytest.mark.parametrize("state", BLOCKED)
@pytest.mark.parametrize("bad", [OUTSIDE, TOO_HIGH])
def test_one_blocked_way_refuses_it_and_is_named(state: State, bad: ReturnPlace) -> None:
    script, _ = flight(state)
    script.feed(ReturnPlacesSeen((NEAR, bad)))
    asked = script.ask(ReturnHome())
    refusal = script.verdict(asked).refusal
    assert refusal is not None
    assert refusal.code is Code.RTL_BLOCKED
    assert bad.name in refusal.sentence or "climb to return height" in refusal.sentence
    assert refusal.sentence.endswith("land instead")
    assert state_of(script) is State.HOLDING


@pytest.mark.parametrize("state", BLOCKED)
def test_while_they_are_not_known_it_is_refused_with_the_reason(state: State) -> None:
    script, _ = flight(state)
    script.feed(ReturnPlacesSeen(None, "they are being read"))
    asked = script.ask(ReturnHome())
    refusal = script.verdict(asked).refusal
    assert refusal is not None
    assert refusal.code is Code.RTL_BLOCKED
    assert refusal.sentence == "they are being read: land instead"
    script.feed(ReturnPlacesSeen(()))
    assert script.verdict(script.ask(ReturnHome())).ruling is Ruling.ACCEPTED


def test_a_higher_way_to_a_place_counts_from_its_ground() -> None:
    """The yard's ceiling is 50 m up: 1.5 m above ground that lies 49 m up is too high."""
    script, _ = flight(State.HOVERING)
    script.feed(ReturnPlacesSeen((ReturnPlace("rally point 1", at(2, 0, 47.0)),)))
    assert script.verdict(script.ask(ReturnHome())).ruling is Ruling.ACCEPTED
    script, _ = flight(State.HOVERING)
    script.feed(ReturnPlacesSeen((ReturnPlace("rally point 1", at(2, 0, 49.0)),)))
    assert script.refusal(script.ask(ReturnHome())) is Code.RTL_BLOCKED


@pytest.mark.parametrize(
    ("choice", "does", "after"),
    [
        ("hold", CommandKind.HOLD, State.HOLDING),
        ("land", CommandKind.LAND, State.LANDING),
        ("forward", CommandKind.RETURN, State.RETURNING),
    ],
)
@pytest.mark.parametrize("seen", [ReturnPlacesSeen((OUTSIDE,)), ReturnPlacesSeen(None, "")])
def test_the_gate_s_own_return_is_judged_by_the_same_ways(
    choice: str, does: CommandKind, after: State, seen: ReturnPlacesSeen
) -> None:
    severities = {**policy("default").severities, Condition.BATTERY_LOW: Severity.RETURN}
    script, _ = flight(State.MOVING, severities=severities, rtl_blocked=choice)
    script.feed(seen)
    script.feed(ConditionChanged(Condition.BATTERY_LOW, True, "low"))
    assert script.commands() == [does]
    assert state_of(script) is after
