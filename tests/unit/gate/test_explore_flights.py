"""The explorer near the usual flights: all that happens within a few letters of each.

That is the share of `test_explore.py` that `make test` has.  The walk does not begin on the ground
only but in every state, so that most of what is planted is met within two or three letters.
"""

from __future__ import annotations

from functools import cache
from typing import Final

import pytest

from gcs.gate.machine.table import TABLE
from gcs.gate.states import State
from tests.proof.explorer import Explorer
from tests.proof.vector import Vector
from tests.proof.walk import Begun, Walk
from tests.unit.gate.explored import WORLDS
from tests.unit.gate.planted import FAULTS, Planted

HEARD: Final = ("guided mode", "position")
ARMED: Final = (*HEARD, "armed or disarmed", "on the ground")
FLIES: Final = (*HEARD, "in the air")
HOVERS: Final = (*FLIES, "ask: control", "wait: landed too old", "guided mode")
FLIGHTS: Final[dict[State, tuple[str, ...]]] = {
    State.NO_VEHICLE: (),
    State.STALE: HEARD[:1],
    State.GROUNDED: HEARD,
    State.EXTERNAL: FLIES,
    State.LANDING: (*FLIES, "land mode"),
    State.RETURNING: (*FLIES, "return mode"),
    State.HOLDING: (*FLIES, "ask: hold"),
    State.TAKING_OFF: (*ARMED, "ask: take off"),
    State.FLYING_MISSION: (*ARMED, "ask: mission"),
    State.HOVERING: HOVERS,
    State.TAKING_PICTURE: (*HOVERS, "ask: photo"),
    State.STREAMING: (*HOVERS, "ask: stream begin"),
    State.MOVING: (*HOVERS, "ask: goto inside", "tick"),
}
"""The letters that lead to each state, from a gate that knows home, fence and mission."""
BETWEEN: Final = (
    (*ARMED, "ask: return"),
    (*ARMED, "ask: hold"),
    (*HEARD[:1], "armed or disarmed", "ask: land"),
    (*FLIES, "ask: control"),
    (*ARMED, "ask: take off", "position short of the top"),
)
"""What a gate has asked for and not seen yet."""
NODES: Final = 1_000
"""So many of the situations that are nearest; there are 149,587 in all on a PX4."""
CELLS: Final = {"px4": 650, "ardupilot": 640}
"""At least so many of the 668 cells that can be entered have a part in that."""
FARTHER: Final = frozenset(
    {
        "a take-off is complete where the vehicle ends its climb",
        "the place where the climb ended is held, and not its top",
        "what is under way in HOLDING is left without its ending",
    }
)
"""Planted faults that are not met so near."""


@cache
def explorer(name: str) -> Explorer:
    return Explorer(WORLDS[name])


@cache
def walk(name: str) -> Walk:
    """The real table, as far as it is walked here."""
    learnt = explorer(name)
    known, unknown = learnt.starts(TABLE)
    flights = [flown(learnt, known, letters) for letters in (*FLIGHTS.values(), *BETWEEN)]
    unfenced = [flown(learnt, unknown, letters) for letters in ((), ARMED, FLIES)]
    walk = Walk(learnt.letters(TABLE), learnt.judge, Begun.from_starts((*flights, *unfenced)))
    walk.run(NODES)
    return walk


def flown(learnt: Explorer, vector: Vector, letters: tuple[str, ...]) -> Vector:
    outcomes = learnt.letters(TABLE)
    for letter in letters:
        vector = outcomes.outcome(letter, vector).applied_to(vector)
    return vector


@pytest.mark.parametrize("name", WORLDS)
def test_each_flight_leads_to_its_state(name: str) -> None:
    learnt = explorer(name)
    known, _ = learnt.starts(TABLE)
    for state, letters in FLIGHTS.items():
        assert learnt.codes.memory_of(flown(learnt, known, letters)).state is state
    assert FLIGHTS.keys() == set(State) - {State.VERIFYING}


@pytest.mark.parametrize("name", WORLDS)
def test_near_every_flight_every_invariant_is_kept(name: str) -> None:
    fault = walk(name).run(NODES).fault
    assert fault is None, str(fault)
    assert len(walk(name).first_met) >= CELLS[name]


@pytest.mark.parametrize(
    "planted", [p for p in FAULTS if p.what not in FARTHER], ids=lambda planted: planted.what
)
def test_a_planted_fault_is_found(planted: Planted) -> None:
    """Which invariant finds it first, and by which way, is told in `test_explore.py`."""
    learnt = explorer(planted.world)
    begun = walk(planted.world).before(set(planted.cells))
    altered = Walk(learnt.letters({**TABLE, **planted.cells}), learnt.judge, begun)
    assert altered.run(NODES).fault is not None
