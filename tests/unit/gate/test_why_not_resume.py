"""Whether a vehicle may arm, and whether one that is held would be flown on: asked before."""

from __future__ import annotations

from copy import deepcopy

import pytest

from gcs.gate.condition import Condition
from gcs.gate.inputs import ConditionChanged
from gcs.gate.machine.could import why_not_arm, why_not_resume
from gcs.gate.refusal import Code
from gcs.gate.requests import Hold, Resume
from gcs.gate.states import State
from tests.unit.gate.flight_words import Flight
from tests.unit.gate.script import Script, policy
from tests.unit.gate.situations import flight

FLIES_ITSELF = [State.RETURNING, State.FLYING_MISSION]


def why(script: Script) -> Code | None:
    """What it answers; that it changes nothing is looked at, too."""
    before = deepcopy(script.gate.memory)
    refusal = why_not_resume(policy("default"), script.gate.memory, script.now_ns)
    assert script.gate.memory == before
    return None if refusal is None else refusal.code


@pytest.mark.parametrize("state", FLIES_ITSELF)
def test_nothing_stands_in_its_way(state: State) -> None:
    script, _ = flight(state)
    assert why(script) is None


@pytest.mark.parametrize("state", FLIES_ITSELF)
def test_a_severity_does_and_the_gate_says_the_same_after_a_hold(state: State) -> None:
    script, _ = flight(state)
    script.feed(ConditionChanged(Condition.BATTERY_CRITICAL, True))
    assert why(script) is Code.SEVERITY
    script.ask(Hold())
    script.tick()
    assert script.refusal(script.ask(Resume())) is Code.SEVERITY


@pytest.mark.parametrize("state", FLIES_ITSELF)
def test_a_position_that_is_too_old_does(state: State) -> None:
    script, _ = flight(state)
    script.reports_position = False
    script.wait(1.2)
    assert why(script) is Code.STALE


def test_standing_on_the_ground_does() -> None:
    script, _ = flight(State.GROUNDED)
    assert why(script) is Code.NOT_FLYING


def test_being_outside_does_not_where_the_way_back_clears() -> None:
    script = Script(policy("default")).fly(20.0)
    script.ask(Hold())
    script.at(155.0, 0.0, 20.0)
    script.feed(ConditionChanged(Condition.FENCE_BREACHED, True))
    assert why(script) is None
    script.feed(ConditionChanged(Condition.ESTIMATOR_UNRELIABLE, True))
    assert why(script) is Code.SEVERITY


@pytest.mark.parametrize(
    ("situation", "code"),
    [
        ("connected", None),
        ("connected; raised BATTERY_CRITICAL", Code.SEVERITY),
        ("connected; no positions; wait 2", Code.STALE),
        ("in HOVERING", Code.ALREADY_FLYING),
    ],
)
def test_it_may_arm_where_the_gate_would_arm_it(situation: str, code: Code | None) -> None:
    script = Flight.begun(situation, {}).script
    before = deepcopy(script.gate.memory)
    refusal = why_not_arm(script.policy, script.gate.memory, script.now_ns)
    assert script.gate.memory == before
    assert (None if refusal is None else refusal.code) is code
