"""A reduction of memories to situations that is too coarse shows in what its walk leaves out.

Here situations are told apart by little more than the state, which is a walk of seconds, of which
`make test` does one.  What the real reduction leaves out is sampled in `test_explore.py`.
"""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from gcs.gate.machine.table import TABLE, Table
from tests.proof.explorer import Explorer
from tests.proof.situation import USUAL, parts
from tests.proof.unexplored_memories import LeftOut
from tests.proof.walk import Begun, Explored, Judge, Walk
from tests.shares import one_in
from tests.unit.gate.explored import WORLDS
from tests.unit.gate.planted import FAULTS


@cache
def explorer() -> Explorer:
    return Explorer(WORLDS["px4"])


@cache
def by_state() -> Judge:
    return explorer().judge_by(parts(USUAL)[:1])


def walks(table: Table) -> tuple[Explored, LeftOut, Walk]:
    """The coarse walk, what it left out, and the walk that goes on from there."""
    letters = explorer().letters(table)
    coarse = Walk(letters, by_state(), Begun.from_starts(explorer().starts(table)))
    explored = coarse.run()
    left_out = LeftOut(letters, by_state(), coarse.met, np.random.default_rng(1))
    left_out.choose(explored.situations, 1200)
    left_out.choose_farther(1200)
    left_out.choose_farther(1200)
    return explored, left_out, left_out.walk()


@pytest.mark.thorough
def test_memories_that_differ_and_are_taken_for_one_show() -> None:
    explored, left_out, further = walks(TABLE)
    assert explored.fault is None
    assert left_out.count == 3600
    reached = further.run()
    assert reached.fault is None
    assert reached.situations > explored.situations + left_out.count


@pytest.mark.parametrize(
    "what",
    one_in(
        3,
        [
            "a hold is over at once though the vehicle may fly",
            "a landing is not asked of a vehicle that is not heard any more",
            "a hold that was asked for ends with the link",
        ],
    ),
)
def test_a_fault_that_the_coarse_walk_misses_is_found(what: str) -> None:
    """Faults that show whichever memories are drawn: five seeds of five found each."""
    planted = next(planted for planted in FAULTS if planted.what == what)
    explored, _, further = walks({**TABLE, **planted.cells})
    assert explored.fault is None
    fault = further.run().fault
    assert fault is not None
    assert fault.objection.invariant == planted.invariant, str(fault)
    assert len(fault.trace) > 1
