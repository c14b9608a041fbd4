"""The explorer finds nothing in the real table, and finds what is planted.

All of it takes minutes: `make test` walks what is near the usual flights
(`test_explore_flights.py`), `make thorough` this.
"""

from __future__ import annotations

import gc
import random
from collections.abc import Iterator
from functools import cache

import numpy as np
import pytest

from gcs.frames import Vec3
from gcs.gate.condition import Severity
from gcs.gate.effects import CommandKind
from gcs.gate.machine import commanding, gate
from gcs.gate.machine.events import Event
from gcs.gate.machine.rows.row import Branch
from gcs.gate.machine.step_context import StepContext
from gcs.gate.machine.table import TABLE
from gcs.gate.refusal import Code
from gcs.gate.states import Control, State
from tests.proof.alphabet import ALPHABET
from tests.proof.edge import Objection
from tests.proof.explorer import Explorer
from tests.proof.invariants import objections
from tests.proof.situation import FINER
from tests.proof.taking import take
from tests.proof.unexplored_memories import LeftOut
from tests.proof.walk import Begun, Explored, Walk
from tests.proof.world import CONDITIONS, World
from tests.soaking import SOAKING, Counted
from tests.unit.gate.explored import WORLDS
from tests.unit.gate.planted import FAULTS, Planted
from tests.unit.gate.unreached import UNREACHED

pytestmark = pytest.mark.thorough


@pytest.fixture(scope="module", autouse=True)
def _only_here() -> Iterator[None]:
    """What the exploration learns is millions of objects and no garbage: looking through them for
    garbage costs a fifth of the walk, and of all tests after it while they are there."""
    gc.disable()
    yield
    explorer.cache_clear()
    explored.cache_clear()
    gc.enable()
    gc.collect()


@cache
def explorer(name: str) -> Explorer:
    """One for all tests: what it learns of the real table holds for most of an altered one."""
    return Explorer(WORLDS[name])


@cache
def explored(name: str) -> Explored:
    return explorer(name).explore()


@pytest.mark.parametrize("name", WORLDS)
def test_every_reachable_combination_keeps_every_invariant(name: str) -> None:
    fault = explored(name).fault
    assert fault is None, str(fault)


@pytest.mark.parametrize("name", WORLDS)
def test_every_state_is_reached_at_every_severity_and_with_every_control(name: str) -> None:
    combinations = explored(name).combinations
    assert {state for state, *_ in combinations} == set(State) - {State.VERIFYING}
    for state in (State.NO_VEHICLE, State.GROUNDED, State.EXTERNAL, State.STALE, State.HOLDING):
        met = {severity for s, severity, *_ in combinations if s is state}
        assert met >= set(CONDITIONS.values()) - {Severity.TERMINATE}
    controls = {c for s, _, c, _ in combinations if s is State.HOVERING}
    assert controls == {Control.TAKING, Control.OURS}


def test_every_cell_is_entered_but_those_that_are_listed() -> None:
    entered: set[tuple[State, Event]] = set()
    for name in WORLDS:
        assert explored(name).fault is None
        entered |= explorer(name).entered
    listed = {entry for unreached in UNREACHED for entry in unreached.entries}
    left = {
        f"{state.name} / {event.value}"
        for (state, event), cell in TABLE.items()
        if cell and (state, event) not in entered
    }
    assert left == listed


@pytest.mark.parametrize("name", WORLDS)
def test_an_outcome_that_was_learnt_is_the_outcome_of_a_run(name: str) -> None:
    """Random walks: each step is looked up in what the exploration learnt, and run as well."""
    assert explored(name).fault is None
    for seed in range(2_000 if SOAKING else 40):
        follow(explorer(name), WORLDS[name], random.Random(seed), 100)


def follow(learnt: Explorer, here: World, choice: random.Random, steps: int) -> None:
    outcomes = learnt.letters(TABLE)
    vector = choice.choice(learnt.starts(TABLE))
    for _ in range(steps):
        letter, outcome = choice.choice(list(outcomes(vector)))
        now_ns = vector[0]
        assert now_ns is not None
        taken = take(ALPHABET[letter], here, TABLE, learnt.codes.memory_of(vector), now_ns)
        assert taken is not None
        assert list(outcome.objections(vector)) == []
        assert [o for step in taken.steps for o in objections(step)] == []
        vector = outcome.applied_to(vector)
        assert vector == learnt.codes.vector_of(taken.memory, taken.now_ns), letter


@pytest.mark.parametrize("name", WORLDS)
def test_what_the_walk_leaves_out_breaks_no_invariant_either(name: str) -> None:
    """It goes on from the first memory of each situation.  Here letters are taken in some of the
    others too, and whatever new they reach is walked to its end.

    It ought to be nothing new: `situation.py` still takes some memories for one that differ
    (docs/decisions.md).  16,000 others led to 10,041 more than PX4's 149,893, and to 5,970
    more than ArduPilot's 93,486.
    """
    assert explored(name).fault is None
    learnt, met = explorer(name), explorer(name).met
    left_out = LeftOut(learnt.letters(TABLE), learnt.judge, met, np.random.default_rng(1))
    left_out.choose(1_000, 4_000)
    left_out.choose_farther(4_000)
    assert left_out.count == 8_000
    further = left_out.walk().run()
    assert further.fault is None, str(further.fault)
    new = further.situations - len(met.edges) - left_out.count
    assert new < len(met.edges) / 10


@pytest.mark.soak
@pytest.mark.parametrize("name", WORLDS)
def test_told_apart_more_finely_every_combination_keeps_every_invariant_too(
    name: str, record_property: Counted
) -> None:
    """Most of what the usual walk takes for one situation and a later state tells apart."""
    found = Explorer(WORLDS[name], FINER).explore()
    record_property("situations, told apart more finely", found.situations)
    assert found.fault is None, str(found.fault)
    assert found.situations > 3 * explored(name).situations


@pytest.mark.parametrize("planted", FAULTS, ids=lambda planted: planted.what)
def test_a_planted_fault_is_found_with_its_shortest_trace(planted: Planted) -> None:
    fault = explorer(planted.world).explore({**TABLE, **planted.cells}).fault
    assert fault is not None
    assert fault.objection.invariant == planted.invariant, str(fault)
    assert fault.trace[-1][0] == planted.letter, str(fault)
    assert "shortest trace:" in str(fault)


def test_an_ardupilot_that_is_armed_again_in_the_same_guided_mode_is_found(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def at_once(step: StepContext, reason: str) -> None:
        step.command(CommandKind.ARM, reason)

    monkeypatch.setattr(commanding, "_arm_or_its_mode", at_once)
    fault = Explorer(WORLDS["ardupilot"]).explore().fault
    assert fault is not None
    assert "in which it was armed before" in fault.objection.sentence
    assert fault.trace[-1][0] == "ask: arm"


def test_a_goal_that_is_sent_bare_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    def bare(_step: StepContext, goal_ned: Vec3, *_beside: object, **_most: object) -> Vec3:
        return goal_ned

    monkeypatch.setattr(gate, "towards", bare)
    fault = Explorer(WORLDS["px4"]).explore().fault
    assert fault is not None
    assert fault.objection.invariant == 6
    assert "at no speed that was chosen" in fault.objection.sentence
    assert fault.trace[-1][0] == "wait: mode overdue"


def test_the_trace_is_the_shortest_there_is() -> None:
    table = {**TABLE, (State.EXTERNAL, Event.HOLD): (Branch(refuse=Code.NOT_IN_CONTROL),)}
    fault = explorer("px4").explore(table).fault
    assert fault is not None
    assert [letter for letter, _ in fault.trace] == [
        "guided mode",
        "position",
        "in the air",
        "ask: hold",
    ]
    assert fault.trace[-2][1] is State.EXTERNAL


@pytest.mark.parametrize("name", WORLDS)
def test_in_small_and_large_batches_the_walk_is_the_same(name: str) -> None:
    """A fault that is some letters away is met in many batches of few situations, or in one."""
    table = {**TABLE, (State.HOVERING, Event.GOTO): ()}
    learnt = explorer(name)
    faults = []
    for batch in (7, 10_000):
        begun = Begun.from_starts(learnt.starts(table))
        walk = Walk(learnt.letters(table), learnt.judge, begun, batch)
        fault = walk.run().fault
        assert fault is not None
        faults.append(fault)
    assert len(set(faults)) == 1


def test_the_fault_is_printed_step_by_step() -> None:
    table = {**TABLE, (State.GROUNDED, Event.ARMED): ()}
    assert str(explorer("px4").explore(table).fault).splitlines()[1:] == [
        "shortest trace:",
        "  guided mode                      -> STALE",
        "  position                         -> GROUNDED",
        "  armed or disarmed                -> GROUNDED",
    ]


def test_an_invariant_is_told_by_its_number() -> None:
    assert (
        str(Objection(5, "a goal outlives the abort")) == "invariant 5: a goal outlives the abort"
    )
