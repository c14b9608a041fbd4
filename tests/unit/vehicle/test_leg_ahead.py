"""The speeds along a leg: found a few at a time, told once, anew for another goal or fence."""

from __future__ import annotations

import math

import pytest

from gcs.gate.airspace.verifier import verifier_for
from gcs.gate.machine.memory import Goal, Memory
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.states import State
from gcs.report import LegItem
from gcs.vehicle.leg_ahead import MOST_PLACES, PLACES_A_LOOK, LegAhead


def moving(goal_m: float) -> Memory:
    """From the origin, 20 m up, to the north."""
    return Memory(
        "px4",
        state=State.MOVING,
        pos_ned=(0.0, 0.0, -20.0),
        goal=Goal((goal_m, 0.0, -20.0), None, ()),
        verifier=verifier_for(DEFAULT, "px4", (0.0, 0.0, 0.0), None),
    )


def told(legs: LegAhead, memory: Memory) -> LegItem:
    """After as many looks as a long leg takes."""
    looks = [legs.look(memory, 1) for _ in range(math.ceil(MOST_PLACES / PLACES_A_LOOK))]
    (item,) = [each for each in looks if each is not None]
    return item


def test_a_leg_is_told_once_from_the_vehicle_to_its_goal() -> None:
    legs, memory = LegAhead(), moving(100.0)
    leg = told(legs, memory)
    assert (len(leg.places_ned), leg.places_ned[0], leg.places_ned[-1]) == (
        MOST_PLACES,
        (0.0, 0.0, -20.0),
        (100.0, 0.0, -20.0),
    )
    assert (leg.speeds_m_s[0], leg.speeds_m_s[-1]) == (12.0, 0.0)
    assert list(leg.speeds_m_s) == sorted(leg.speeds_m_s, reverse=True)
    # As it flies on, the leg is the one that it was.
    memory.pos_ned = (30.0, 0.0, -20.0)
    assert [legs.look(memory, 1) for _ in range(20)] == [None] * 20


def test_a_short_leg_has_few_places() -> None:
    assert len(told(LegAhead(), moving(3.0)).places_ned) == 6


@pytest.mark.parametrize("what", ["goal", "fence"])
def test_another_goal_and_another_fence_are_another_leg(what: str) -> None:
    legs, memory = LegAhead(), moving(100.0)
    before = told(legs, memory)
    if what == "goal":
        memory.goal = Goal((0.0, 50.0, -20.0), None, ())
    else:
        memory.verifier = verifier_for(DEFAULT, "px4", (-45.0, 0.0, 0.0), None)
    after = told(legs, memory)
    assert after.speeds_m_s != before.speeds_m_s


def test_what_is_over_is_told_once() -> None:
    legs, memory = LegAhead(), moving(100.0)
    told(legs, memory)
    memory.state = State.HOVERING
    assert [legs.look(memory, 1), legs.look(memory, 1)] == [LegItem(1, (), ()), None]
