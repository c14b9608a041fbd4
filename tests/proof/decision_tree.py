"""A function of what the gate remembers, run once for each distinct way through its questions.

The first run notes every question that the function asks (`questions.py`) and hangs its result
at the end of their answers.  A vector that gives the same answers gets that result without a
run; so do many vectors at once (`split`), each question asked of all of them together.  Where an
answer is new, the function runs again and the tree grows a branch: results are never guessed, and
no question that the function asks is left out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any, Final, Generic, TypeAlias, TypeVar, cast

import numpy as np

from tests.proof.columns import NEVER, Columns, Numbers, vector_at
from tests.proof.questions import KNOWN, VALUE, Question, Questions
from tests.proof.vector import NOW, Vector

T = TypeVar("T")

FOREVER_NS: Final = 1 << 62
FEW: Final = 16
"""So many vectors are quicker one by one than together."""

Branches: TypeAlias = dict[int | None, Any]
"""Where each answer leads: to the next question, or to a `Leaf`."""


class Leaf(Generic[T]):
    """The end of one way through the questions; `result` is what the function gave there."""

    __slots__ = ("result",)

    def __init__(self, result: T) -> None:
        self.result = result


class DecisionTree(Generic[T]):
    """`tree(vector).result` is what `function()` gives when `questions` looks at `vector`.

    The function must be without side effects, and read nothing that varies but through
    `questions`.  `known` are questions whose answers are the same for every vector that this
    tree is asked about.
    """

    def __init__(
        self,
        questions: Questions,
        function: Callable[[], T],
        known: Mapping[Question, int] | None = None,
    ) -> None:
        self._questions = questions
        self._function = function
        self._known = known or {}
        self._top: Branches = {}
        self.leaves = 0

    @property
    def constant(self) -> bool:
        """It was asked once, and nothing in the vector mattered."""
        return isinstance(self._top.get(None), Leaf)

    def __call__(self, vector: Vector) -> Leaf[T]:
        node = self._top.get(None)
        while node.__class__ is tuple:
            place, other, by_ns, branches = node
            if other == VALUE:
                node = branches.get(vector[place])
            elif other == KNOWN:
                node = branches.get(vector[place] is not None)
            else:
                later: Any = vector[place]
                node = branches.get(later - vector[other] > by_ns)
        return self._grow(vector) if node is None else cast("Leaf[T]", node)

    def split(
        self, columns: Columns, rows: list[list[int]] | None = None
    ) -> Iterator[tuple[T, Numbers]]:
        """Each result with the numbers of the vectors that have it, in rising order.

        `rows` are the same vectors one by one: where few go the same way, they go by themselves.
        """
        few = 0 if rows is None else FEW
        ends: dict[Leaf[T], list[int]] = {}
        todo: list[tuple[Branches, int | None, Numbers]] = []
        if columns.shape[1]:
            todo.append((self._top, None, np.arange(columns.shape[1])))
        while todo:
            branches, answer, numbers = todo.pop()
            node = branches.get(answer)
            if node is None:
                self._grow(vector_at(columns, int(numbers[0])))
                node = branches[answer]
            if node.__class__ is not tuple:
                if node in ends:
                    ends[node] += numbers.tolist()
                elif few:
                    ends[node] = numbers.tolist()
                else:
                    yield node.result, numbers
            elif rows is not None and len(numbers) <= few:
                for number in numbers.tolist():
                    leaf = self._end(node, rows[number])
                    ends.setdefault(leaf, []).append(number)
            else:
                place, other, by_ns, onward = node
                given = _answers(columns, place, other, by_ns, numbers)
                todo += ((onward, each, among) for each, among in _sorted_out(given, numbers))
        for leaf, among_all in ends.items():
            yield leaf.result, np.array(sorted(among_all))

    def _end(self, node: Any, row: list[int]) -> Leaf[T]:
        """Where the way of one vector ends that goes on from `node`."""
        while node.__class__ is tuple:
            place, other, by_ns, branches = node
            if other == VALUE:
                node = branches.get(row[place])
            elif other == KNOWN:
                node = branches.get(row[place] != NEVER)
            else:
                node = branches.get(row[place] - row[other] > by_ns)
        if node is None:
            return self._grow([None if value == NEVER else value for value in row])
        return cast("Leaf[T]", node)

    def steady_ns(self, columns: Columns) -> Numbers:
        """For how long each vector has the result that it has now, if only time passes."""
        steady_ns = np.full(columns.shape[1], FOREVER_NS)
        for _ in self.split(columns):
            pass  # from here on every way is known
        todo: list[tuple[Any, Numbers]] = [(self._top.get(None), np.arange(columns.shape[1]))]
        while todo:
            node, numbers = todo.pop()
            if node.__class__ is not tuple:
                continue
            place, other, by_ns, onward = node
            given = _answers(columns, place, other, by_ns, numbers)
            if other >= NOW and NOW in (place, other):
                left_ns = by_ns - columns[place][numbers] + columns[other][numbers]
                becomes = ~given if place == NOW else given
                left_ns = left_ns if place == NOW else -left_ns - 1
                at = numbers[becomes]
                steady_ns[at] = np.minimum(steady_ns[at], left_ns[becomes])
            todo += ((onward[each], among) for each, among in _sorted_out(given, numbers))
        return steady_ns

    def _grow(self, vector: Vector) -> Leaf[T]:
        self._questions.look_at(vector)
        result = self._function()
        self.leaves += 1
        branches, answer = self._top, cast("int | None", None)
        for question, given in self._questions.asked.items():
            if question in self._known:
                continue
            node = branches.get(answer)
            if node is None:
                node = branches[answer] = (*question, {})
            assert node[:3] == question, "the function asked in another order than before"
            branches, answer = node[3], given
        leaf = branches[answer] = Leaf(result)
        return leaf


def _answers(columns: Columns, place: int, other: int, by_ns: int, numbers: Numbers) -> Numbers:
    """What each of the vectors with these numbers answers to the question."""
    values: Numbers = columns[place][numbers]
    if other == VALUE:
        return values
    if other == KNOWN:
        return cast(Numbers, values != NEVER)
    return cast(Numbers, values - columns[other][numbers] > by_ns)


def _sorted_out(given: Numbers, numbers: Numbers) -> Iterator[tuple[int, Numbers]]:
    """Each answer, and which of the numbered vectors gave it."""
    while len(numbers):
        answer = given[0]
        same = given == answer
        if same.all():
            yield int(answer), numbers
            return
        yield int(answer), numbers[same]
        given, numbers = given[~same], numbers[~same]
