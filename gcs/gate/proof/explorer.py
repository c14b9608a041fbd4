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
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Hashable, Iterator
from dataclasses import dataclass
from functools import partial
from itertools import chain, islice
from typing import TypeAlias, TypeVar, cast

from gcs.gate.condition import Condition, Severity
from gcs.gate.inputs import ClimbEndSeen, ReturnHeightSeen
from gcs.gate.machine.events import Event
from gcs.gate.machine.gate import Gate
from gcs.gate.machine.memory import SECOND_NS
from gcs.gate.machine.table import TABLE, Table
from gcs.gate.proof.alphabet import ALPHABET, Letter, becomes_known
from gcs.gate.proof.decision_tree import DecisionTree, Leaf
from gcs.gate.proof.edge import Objection, severity_of
from gcs.gate.proof.invariants import objections_to_memory
from gcs.gate.proof.outcome import Outcome
from gcs.gate.proof.questions import Instant, Questions, WatchedMemory
from gcs.gate.proof.situation import PARTS, Part
from gcs.gate.proof.taking import take
from gcs.gate.proof.vector import NOW, PLACE, Codes, Vector
from gcs.gate.proof.world import World
from gcs.gate.states import Control, State

T = TypeVar("T")

Combination: TypeAlias = tuple[State, Severity, Control, Condition | None]


@dataclass(frozen=True, slots=True)
class Fault:
    """A broken invariant and the shortest way to it, letter by letter with the state reached."""

    objection: Objection
    trace: tuple[tuple[str, State], ...]

    def __str__(self) -> str:
        lines = [f"{self.objection}", "shortest trace:"]
        lines += [f"  {letter:<32} -> {state.name}" for letter, state in self.trace]
        return "\n".join(lines)


@dataclass(frozen=True, slots=True)
class Explored:
    """What the walk saw.  `combinations` are the (state, severity, control, condition) met."""

    situations: int
    edges: int
    combinations: frozenset[Combination]
    fault: Fault | None


class Explorer:
    """Explores one world, and keeps what it learnt: of a table in which few cells are altered,
    only that is run anew which meets those cells, and the walk begins where it first meets one."""

    def __init__(self, world: World) -> None:
        self._world = world
        self.codes = Codes()
        self._questions = Questions(self.codes)
        self._memory = WatchedMemory(self._questions)
        self._now_ns = cast(int, Instant(self._questions, NOW))
        self._outcomes = self._outcomes_by(TABLE)
        self.parts = [self._tree(partial(self._number, part, {})) for part in PARTS]
        self.objections = self._tree(self._objections_to_memory)
        self._whole = _Walk(self, TABLE)

    def explore(self, table: Table = TABLE) -> Explored:
        """Breadth first until nothing new is met; stops at the first broken invariant."""
        explored = self._whole.run()
        altered = {cell for cell in TABLE if table[cell] != TABLE[cell]}
        if not altered:
            return explored
        if self.starts(table) != self.starts(TABLE):
            return _Walk(self, table).run()
        return _Walk(self, table, self._whole.before(altered)).run()

    @property
    def entered(self) -> frozenset[tuple[State, Event]]:
        """The cells of the real table that have a part in its exploration."""
        self._whole.run()
        return frozenset(self._whole.first_met)

    def starts(self, table: Table) -> tuple[Vector, Vector]:
        """A gate that has heard nobody, with home, fence and mission known and without."""
        gate = Gate(self._world.policy, self._world.verifier.autopilot, SECOND_NS, table)
        gate.handle(ReturnHeightSeen(self._world.return_up_m), SECOND_NS)
        gate.handle(ClimbEndSeen(self._world.climb_ends_within_m), SECOND_NS)
        unknown = self.codes.vector_of(gate.memory, SECOND_NS)
        for given in becomes_known(self._world):
            gate.handle(given, SECOND_NS)
        return self.codes.vector_of(gate.memory, SECOND_NS), unknown

    def letters(self, table: Table) -> Callable[[Vector], Iterator[tuple[str, Outcome]]]:
        """The outcome of every letter that makes sense, by what the gate remembers."""
        altered = {cell for cell in TABLE if table[cell] != TABLE[cell]}
        anew = self._outcomes_by(table)

        def outcomes(vector: Vector) -> Iterator[tuple[str, Outcome]]:
            for letter, tree in self._outcomes.items():
                outcome = tree(vector).result
                if altered and not altered.isdisjoint(outcome.cells):
                    outcome = anew[letter](vector).result
                if outcome.sensible:
                    yield letter, outcome

        return outcomes

    def combination(self, vector: Vector) -> Iterator[Combination]:
        memory = self.codes.memory_of(vector)
        severity = severity_of(self._world.policy, memory)
        conditions: list[Condition | None] = [name for name, _ in memory.conditions]
        for condition in conditions or [None]:
            yield memory.state, severity, memory.control, condition

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


@dataclass(slots=True)
class _Node:
    """A situation, by the memory that it was first met with, and how that was reached.

    `parts` are the parts of the situation, `objections` what the invariants have against the
    memory; each knows what it looked at.  `number` is its place among the nodes.
    """

    vector: Vector
    parts: list[Leaf[int]]
    objections: Leaf[list[Objection]]
    parent: _Node | None
    letter: str
    number: int = -1


@dataclass(frozen=True, slots=True)
class _Begun:
    """A walk as it was when the node `at` had its turn: `nodes` are those that were met by then."""

    nodes: list[_Node]
    at: int


class _Walk:
    """One exploration.  `first_met` has, for each cell, the node of which a letter first met it."""

    def __init__(self, explorer: Explorer, table: Table, begun: _Begun | None = None) -> None:
        self._explorer = explorer
        self._letters = explorer.letters(table)
        self._nodes: list[_Node] = []
        self._at = 0
        self._over: Explored | None = None
        self._edges = 0
        self.first_met: dict[tuple[State, Event], int] = {}
        self._situations: set[tuple[int, ...]] = set()
        self._met: dict[tuple[int | None, ...], Vector] = {}
        if begun is not None:
            self._nodes, self._at = list(begun.nodes), begun.at
            self._situations = {_situation(node) for node in begun.nodes}
            return
        for start in explorer.starts(table):
            parts = [part(start) for part in explorer.parts]
            self._enter(_Node(start, parts, explorer.objections(start), None, ""))

    def before(self, cells: set[tuple[State, Event]]) -> _Begun:
        """This walk, which is over, up to the first node of which a letter meets one of `cells`.

        Until then a walk through a table that differs in those cells is the same.
        """
        at = min((self.first_met.get(cell, len(self._nodes)) for cell in cells), default=0)
        met = bisect_left(self._nodes, at, key=lambda n: n.parent.number if n.parent else -1)
        return _Begun(self._nodes[:met], at)

    def run(self) -> Explored:
        """To the end, once."""
        self._over = self._over or self._run()
        return self._over

    def _run(self) -> Explored:
        for node in islice(self._nodes, self._at, None):
            before, steady_ns = node.vector, self._steady_ns(node)
            for letter, outcome in self._letters(before):
                self._edges += 1
                if outcome.unmet:
                    outcome.unmet = False
                    for cell in outcome.cells:
                        self.first_met.setdefault(cell, node.number)
                if outcome.doubtful:
                    for objection in outcome.objections(before):
                        return self._explored(objection, self._reached(node, letter, outcome))
                if outcome.idle_ns <= steady_ns:
                    continue  # only time passed, and not enough to make a difference
                reached = self._reached(node, letter, outcome)
                for objection in reached.objections.result:
                    return self._explored(objection, reached)
                self._enter(reached)
        return self._explored(None, None)

    def _steady_ns(self, node: _Node) -> int:
        """For how long a situation stays what it is if nothing happens."""
        steady_ns = min(part.steady_ns(node.vector) for part in self._explorer.parts)
        return min(steady_ns, self._explorer.objections.steady_ns(node.vector))

    def _reached(self, node: _Node, letter: str, outcome: Outcome) -> _Node:
        """Where `letter` leads.  What does not look at anything that changed is what it was."""
        vector, places = outcome.applied_to(node.vector), outcome.places
        parts = [
            tree(vector) if part.places & places else part
            for part, tree in zip(node.parts, self._explorer.parts, strict=True)
        ]
        objections = node.objections
        if objections.places & places:
            objections = self._explorer.objections(vector)
        return _Node(vector, parts, objections, node, letter)

    def _enter(self, node: _Node) -> None:
        """Go on from `node` too, if its situation is new."""
        vector = node.vector
        self._met.setdefault((vector[_STATE], vector[_CONTROL], vector[_CONDITIONS]), vector)
        situation = _situation(node)
        if situation not in self._situations:
            self._situations.add(situation)
            node.number = len(self._nodes)
            self._nodes.append(node)

    def _explored(self, objection: Objection | None, last: _Node | None) -> Explored:
        met = (self._explorer.combination(vector) for vector in self._met.values())
        fault = None if objection is None else Fault(objection, self._trace(last))
        return Explored(len(self._nodes), self._edges, frozenset(chain.from_iterable(met)), fault)

    def _trace(self, node: _Node | None) -> tuple[tuple[str, State], ...]:
        steps: list[tuple[str, State]] = []
        while node is not None and node.parent is not None:
            steps.append((node.letter, self._explorer.codes.memory_of(node.vector).state))
            node = node.parent
        return tuple(reversed(steps))


def _situation(node: _Node) -> tuple[int, ...]:
    return tuple([part.result for part in node.parts])


_STATE, _CONTROL, _CONDITIONS = PLACE["state"], PLACE["control"], PLACE["conditions"]
