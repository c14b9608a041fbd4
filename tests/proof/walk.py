"""The walk of the explorer: breadth first, many situations at a time.

A *node* is a situation by the memory that it was first met with; nodes have numbers, in the order
in which they were met, and their turn in that order.  A batch is all nodes that wait for their
turn, up to a limit.  Each letter is taken in all nodes of a batch together, and what that reaches
is put back into the order of nodes and letters before it is looked at: so the nodes, their
numbers and the first broken invariant are those of a walk that goes edge by edge.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import chain
from typing import Final, TypeAlias, cast

import numpy as np

from gcs.gate.condition import Condition, Severity
from gcs.gate.machine.events import Event
from gcs.gate.states import Control, State
from tests.proof.columns import Columns, Growing, Numbers, columns_of, vector_at
from tests.proof.decision_tree import DecisionTree
from tests.proof.edge import Objection
from tests.proof.letters import Cells, Letters
from tests.proof.outcome import CHANGES, Outcome
from tests.proof.vector import PLACE, Codes, Vector

Combination: TypeAlias = tuple[State, Severity, Control, Condition | None]

BATCH: Final = 8_192
"""So many nodes at once: fewer cost more calls, more cost memory."""
FIRST_BATCH: Final = 16
"""The first is small, each other one twice as large: a planted fault is often met at once."""
EDGES: Final = 100_000
"""What so many edges reach is looked at together."""
_STATE, _CONTROL, _CONDITIONS = PLACE["state"], PLACE["control"], PLACE["conditions"]


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
    """What the walk saw, to the end of the batch in which it met a fault, if it met one.
    `combinations` are the (state, severity, control, condition) met."""

    situations: int
    edges: int
    combinations: frozenset[Combination]
    fault: Fault | None


@dataclass(frozen=True, slots=True)
class Judge:
    """What the walk asks about a memory: the parts of its situation, each with the bits for its
    number, the invariants' objections, and which combinations it is."""

    parts: list[tuple[DecisionTree[int], int]]
    objections: DecisionTree[list[Objection]]
    combinations: Callable[[Vector], Iterator[Combination]]
    codes: Codes

    def situations(self, columns: Columns) -> Numbers:
        """One number for each vector, equal for those that are one situation."""
        whole = np.zeros(columns.shape[1], dtype=np.int64)
        for tree, bits in self.parts:
            whole <<= bits
            for part, numbers in tree.split(columns):
                assert part < 1 << bits
                whole[numbers] += part
        return whole

    def steady_ns(self, columns: Columns) -> Numbers:
        """For how long a situation stays what it is if nothing happens."""
        times = [tree.steady_ns(columns) for tree, _ in self.parts]
        return cast(Numbers, np.minimum.reduce([*times, self.objections.steady_ns(columns)]))

    def first_objected(self, columns: Columns) -> int | None:
        """The first of these vectors that breaks an invariant as it is."""
        split = self.objections.split(columns)
        return min((int(numbers[0]) for found, numbers in split if found), default=None)


@dataclass(frozen=True, slots=True)
class Begun:
    """A walk as it was when the node `at` had its turn: the nodes that were met by then, and for
    each the edge that led to it first, which is -1 for the starts."""

    nodes: Columns
    edges: list[int]
    at: int

    @classmethod
    def from_starts(cls, starts: tuple[Vector, ...]) -> Begun:
        return cls(columns_of(starts), [-1] * len(starts), 0)


@dataclass(frozen=True, slots=True)
class _Group:
    """The edges of one letter that have one outcome; `rows` are the places of their nodes in the
    batch, `edges` their own numbers."""

    outcome: Outcome
    rows: Numbers
    edges: Numbers


class Walk:
    """One exploration.  `first_met` has, for each cell, the node of which a letter first met it.

    An edge has a number: that of its node, times the number of letters, plus that of its letter.
    """

    def __init__(self, letters: Letters, judge: Judge, begun: Begun, batch: int = BATCH) -> None:
        self._letters, self._judge, self._most = letters, judge, batch
        self._size = min(FIRST_BATCH, batch)
        self.first_met: dict[tuple[State, Event], int] = {}
        self._nodes = Growing(begun.nodes)
        self._edge_to = list(begun.edges)
        self._at = begun.at
        self._situations = set(judge.situations(begun.nodes).tolist())
        self._edges = 0
        self._combinations: dict[tuple[int, ...], Vector] = {}
        self._note_combinations(begun.nodes)
        self._over: Explored | None = None

    def before(self, cells: Cells) -> Begun:
        """This walk, which is over, up to the first node of which a letter meets one of `cells`.

        Until then a walk through a table that differs in those cells is the same.
        """
        end = self._nodes.count
        at = min([self.first_met.get(cell, end) for cell in cells], default=0)
        met = bisect_left(self._edge_to, at * len(self._letters.names))
        return Begun(self._nodes.some(0, met), self._edge_to[:met], at)

    @property
    def met(self) -> Begun:
        """This walk with all its nodes, none of which waits for its turn any more."""
        return Begun(self._nodes.some(0, self._nodes.count), list(self._edge_to), self._at)

    def run(self, most: int | None = None) -> Explored:
        """To the end, once; or until at least `most` nodes have had their turn."""
        while self._over is None:
            if most is not None and self._at >= most:
                return self._explored(None)
            fault = self._take_batch(self._at, min(self._at + self._size, self._nodes.count))
            if fault is not None or self._at == self._nodes.count:
                self._over = self._explored(fault)
        return self._over

    def _take_batch(self, first: int, end: int) -> Fault | None:
        """Every letter in every node from `first` on, before `end`; the first fault, if any."""
        before = self._nodes.some(first, end)
        steady_ns = self._judge.steady_ns(before)
        one_by_one = before.T.tolist()
        groups: list[_Group] = []
        objected: list[int] = []
        for number, name in enumerate(self._letters.names):
            for outcome, rows in self._letters.split(name, before, one_by_one):
                self._edges += len(rows)
                self._note_cells(outcome, first + int(rows[0]))
                edges = (first + rows) * len(self._letters.names) + number
                if outcome.doubtful:
                    at = outcome.first_objected(before[:, rows])
                    objected += [] if at is None else [int(edges[at])]
                if outcome.idle_ns < CHANGES:
                    # Where time passes that makes no difference, nothing new is reached.
                    moves = outcome.idle_ns > steady_ns[rows]
                    rows, edges = rows[moves], edges[moves]
                groups.append(_Group(outcome, rows, edges))
        new = self._look_at_all(before, groups, objected)
        self._at = end
        self._size = min(2 * self._size, self._most)
        if objected:
            return self._fault(min(objected))
        self._enter(new)
        return None

    def _note_cells(self, outcome: Outcome, node: int) -> None:
        if outcome.unmet:
            outcome.unmet = False
            for cell in outcome.cells:
                self.first_met[cell] = min(self.first_met.get(cell, node), node)

    def _look_at_all(
        self, before: Columns, groups: list[_Group], objected: list[int]
    ) -> dict[int, int]:
        """The new situations that are reached, each with the first edge that leads to it.

        Edges to a memory that breaks an invariant are added to `objected`.
        """
        new: dict[int, int] = {}
        waiting: list[_Group] = []
        count = 0
        for group in groups:
            waiting.append(group)
            count += len(group.rows)
            if count >= EDGES:
                self._look_at(before, waiting, new, objected)
                waiting, count = [], 0
        if waiting:
            self._look_at(before, waiting, new, objected)
        return new

    def _look_at(
        self, before: Columns, groups: list[_Group], new: dict[int, int], objected: list[int]
    ) -> None:
        edges = np.concatenate([group.edges for group in groups])
        after = before[:, np.concatenate([group.rows for group in groups])]
        begin = 0
        for group in groups:
            end = begin + len(group.rows)
            group.outcome.write(before, group.rows, after[:, begin:end])
            begin = end
        in_turn = np.argsort(edges)
        edges, after = edges[in_turn], after[:, in_turn]
        at = self._judge.first_objected(after)
        objected += [] if at is None else [int(edges[at])]
        self._note_combinations(after)
        reached, first = np.unique(self._judge.situations(after), return_index=True)
        for situation, edge in zip(reached.tolist(), edges[first].tolist(), strict=True):
            if situation not in self._situations:
                new[situation] = min(new.get(situation, edge), edge)

    def _enter(self, new: dict[int, int]) -> None:
        """Go on from each new situation too, in the order in which they are met."""
        self._situations |= new.keys()
        edges = sorted(new.values())
        self._nodes.add(columns_of([self._reached(edge) for edge in edges]))
        self._edge_to += edges

    def _note_combinations(self, columns: Columns) -> None:
        looked_at = columns[[_STATE, _CONTROL, _CONDITIONS]]
        met, first = np.unique(looked_at, axis=1, return_index=True)
        for combination, number in zip(met.T.tolist(), first.tolist(), strict=True):
            if tuple(combination) not in self._combinations:
                self._combinations[tuple(combination)] = vector_at(columns, number)

    # ------------------------------------------------------------------------------- edge by edge

    def _edge(self, edge: int) -> tuple[Vector, str, Outcome]:
        """The vector from which it leads, its letter, and the outcome."""
        node, letter = divmod(edge, len(self._letters.names))
        vector, name = vector_at(self._nodes.some(node, node + 1), 0), self._letters.names[letter]
        return vector, name, self._letters.outcome(name, vector)

    def _reached(self, edge: int) -> Vector:
        vector, _, outcome = self._edge(edge)
        return outcome.applied_to(vector)

    def _fault(self, edge: int) -> Fault:
        vector, _, outcome = self._edge(edge)
        against_edge = list(outcome.objections(vector))
        against_memory = self._judge.objections(outcome.applied_to(vector)).result
        return Fault((against_edge + against_memory)[0], self._trace(edge))

    def _trace(self, edge: int) -> tuple[tuple[str, State], ...]:
        steps: list[tuple[str, State]] = []
        while edge >= 0:
            vector, letter, outcome = self._edge(edge)
            reached = self._judge.codes.memory_of(outcome.applied_to(vector))
            steps.append((letter, reached.state))
            edge = self._edge_to[edge // len(self._letters.names)]
        return tuple(reversed(steps))

    def _explored(self, fault: Fault | None) -> Explored:
        met = (self._judge.combinations(vector) for vector in self._combinations.values())
        return Explored(self._nodes.count, self._edges, frozenset(chain.from_iterable(met)), fault)
