"""A function of what the gate remembers, run once for each distinct way through its questions.

The first run notes every question that the function asks (`questions.py`) and hangs its result
at the end of their answers.  A vector that gives the same answers gets that result without a
run.  Where an answer is new, the function runs again and the tree grows a branch: results are
never guessed, and no question that the function asks is left out.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Generic, TypeAlias, TypeVar, cast

from gcs.gate.proof.questions import KNOWN, VALUE, Question, Questions
from gcs.gate.proof.vector import NOW, Vector

T = TypeVar("T")

Branches: TypeAlias = dict[int | None, Any]
"""Where each answer leads: to the next question, or to a `Leaf`."""


class Leaf(Generic[T]):
    """The end of one way through the questions.

    `result` is what the function gave there.  `places` are those of the vector that the way
    asks about, one bit each: another vector that differs from it elsewhere ends here too.
    """

    __slots__ = ("places", "result")

    def __init__(self, result: T, places: int) -> None:
        self.result, self.places = result, places


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

    def steady_ns(self, vector: Vector) -> int:
        """For how long `vector` ends at the same leaf if nothing but the time changes; -1 where
        that is not known."""
        now_ns, steady_ns = cast(int, vector[NOW]), 1 << 62
        node = self._top.get(None)
        while node.__class__ is tuple:
            place, other, by_ns, branches = node
            if other == VALUE:
                node = branches.get(vector[place])
            elif other == KNOWN:
                node = branches.get(vector[place] is not None)
            else:
                later, earlier = cast(int, vector[place]), cast(int, vector[other])
                answer = later - earlier > by_ns
                if place == NOW and not answer:
                    steady_ns = min(steady_ns, earlier + by_ns - now_ns)
                elif other == NOW and answer:
                    steady_ns = min(steady_ns, later - by_ns - 1 - now_ns)
                node = branches.get(answer)
        return -1 if node is None else steady_ns

    def _grow(self, vector: Vector) -> Leaf[T]:
        self._questions.look_at(vector)
        result = self._function()
        self.leaves += 1
        branches, answer, places = self._top, cast("int | None", None), 0
        for question, given in self._questions.asked.items():
            if question in self._known:
                continue
            node = branches.setdefault(answer, (*question, {}))
            assert node[:3] == question, "the function asked in another order than before"
            branches, answer = node[3], given
            places |= 1 << question[0]
            if question[1] >= NOW:
                places |= 1 << question[1]
        leaf = branches[answer] = Leaf(result, places)
        return leaf
