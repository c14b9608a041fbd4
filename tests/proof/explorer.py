"""Walk every combination that the gate can reach, and check its invariants on every step.

The words, as of automata:

- A *letter* is one thing that can happen next: a request, a report of the vehicle, an answer, or
  a wait.  It is a short run of inputs, each with the time that passes before it.  All letters
  together are the *alphabet* (`alphabet.py`).
- A *situation* is what the gate remembers, reduced to what can still make a difference
  (`situation.py`).
- An *edge* is one letter taken in one situation: it leads to another one, or to the same.

The walk is breadth first from a gate that has heard nobody, and knows the fence or does not.
Every letter is taken in every situation that is reached, by the real machine and the real table,
and every step is checked (`invariants.py`).  As the walk is breadth first, the trace to the first
broken invariant is the shortest one there is.

Most edges differ from another one only in what the gate does not look at.  So each letter is a
decision tree (`decision_tree.py`) over what the gate remembers: the machine runs once for each
distinct set of answers, and every edge with those answers has that outcome.  No edge is left out.
The walk (`walk.py`) takes each letter in all situations that wait for their turn at once.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Sequence
from functools import partial
from typing import TypeVar, cast

from gcs.gate.condition import Condition
from gcs.gate.inputs import ClimbEndSeen, ReturnHeightSeen, ReturnPlacesSeen
from gcs.gate.machine.events import Event
from gcs.gate.machine.gate import Gate
from gcs.gate.machine.memory import SECOND_NS
from gcs.gate.machine.table import TABLE, Table
from gcs.gate.states import State
from tests.proof.alphabet import ALPHABET, Letter, becomes_known
from tests.proof.decision_tree import DecisionTree
from tests.proof.edge import Objection, severity_of
from tests.proof.invariants import objections_to_memory
from tests.proof.letters import Letters
from tests.proof.outcome import Outcome
from tests.proof.questions import Instant, Questions, WatchedMemory
from tests.proof.situation import USUAL, Part, ToldApart, parts
from tests.proof.taking import take
from tests.proof.vector import NOW, Codes, Vector
from tests.proof.walk import Begun, Combination, Explored, Judge, Walk
from tests.proof.world import World

T = TypeVar("T")


class Explorer:
    """Explores one world, and keeps what it learnt: of a table in which few cells are altered,
    only that is run anew which meets those cells, and the walk begins where it first meets one."""

    def __init__(self, world: World, apart: ToldApart = USUAL) -> None:
        self._world = world
        self.codes = Codes()
        self._questions = Questions(self.codes)
        self._memory = WatchedMemory(self._questions)
        self._now_ns = cast(int, Instant(self._questions, NOW))
        self._outcomes = self._outcomes_by(TABLE)
        self.objections = self._tree(self._objections_to_memory)
        self.judge = self.judge_by(parts(apart))
        self._whole = self._walk(TABLE)

    def explore(self, table: Table = TABLE) -> Explored:
        """Breadth first until nothing new is met; stops at the first broken invariant."""
        explored = self._whole.run()
        altered = {cell for cell in TABLE if table[cell] != TABLE[cell]}
        if not altered:
            return explored
        if self.starts(table) != self.starts(TABLE):
            return self._walk(table).run()
        return self._walk(table, self._whole.before(altered)).run()

    @property
    def entered(self) -> frozenset[tuple[State, Event]]:
        """The cells of the real table that have a part in its exploration."""
        self._whole.run()
        return frozenset(self._whole.first_met)

    @property
    def met(self) -> Begun:
        """The walk through the real table, with all its nodes."""
        self._whole.run()
        return self._whole.met

    def starts(self, table: Table) -> tuple[Vector, Vector]:
        """A gate that has heard nobody, with home, fence and mission known and without."""
        gate = Gate(self._world.policy, self._world.verifier.autopilot, SECOND_NS, table)
        gate.handle(ReturnHeightSeen(self._world.return_up_m), SECOND_NS)
        gate.handle(ReturnPlacesSeen(()), SECOND_NS)
        gate.handle(ClimbEndSeen(self._world.climb_ends_within_m), SECOND_NS)
        unknown = self.codes.vector_of(gate.memory, SECOND_NS)
        for given in becomes_known(self._world):
            gate.handle(given, SECOND_NS)
        return self.codes.vector_of(gate.memory, SECOND_NS), unknown

    def letters(self, table: Table) -> Letters:
        """The outcome of every letter that makes sense, by what the gate remembers."""
        altered = {cell for cell in TABLE if table[cell] != TABLE[cell]}
        return Letters(self._outcomes, self._outcomes_by(table), altered)

    def judge_by(self, parts: Sequence[tuple[Part, int]]) -> Judge:
        """Tells situations apart by these parts, each with the bits for its number."""
        trees = [(self._tree(partial(self._number, part, {})), bits) for part, bits in parts]
        return Judge(trees, self.objections, self.combination, self.codes)

    def combination(self, vector: Vector) -> Iterator[Combination]:
        memory = self.codes.memory_of(vector)
        severity = severity_of(self._world.policy, memory)
        conditions: list[Condition | None] = [name for name, _ in memory.conditions]
        for condition in conditions or [None]:
            yield memory.state, severity, memory.control, condition

    def _walk(self, table: Table, begun: Begun | None = None) -> Walk:
        begun = begun or Begun.from_starts(self.starts(table))
        return Walk(self.letters(table), self.judge, begun)

    # ------------------------------------------------------------------------------- learning

    def _outcomes_by(self, table: Table) -> dict[str, DecisionTree[Outcome]]:
        return {
            name: self._tree(partial(self._outcome, letter, table))
            for name, letter in ALPHABET.items()
        }

    def _tree(self, function: Callable[[], T]) -> DecisionTree[T]:
        return DecisionTree(self._questions, function)

    def _outcome(self, letter: Letter, table: Table) -> Outcome:
        taken = take(letter, self._world, table, self._memory.copy(), self._now_ns)
        return Outcome(self._questions, taken)

    def _number(self, part: Part, numbers: dict[Hashable, int]) -> int:
        """The number of what `part` of the situation is, in the order they were met."""
        met = part(self._world.policy, self._memory.copy(), self._now_ns)
        return numbers.setdefault(met, len(numbers))

    def _objections_to_memory(self) -> list[Objection]:
        return list(objections_to_memory(self._world.policy, self._memory.copy()))
