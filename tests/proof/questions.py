"""Run the gate on a memory that notes what is asked of it.

Whatever code reads from a `WatchedMemory` is noted as a question with its answer: which value a
field has, or how two times compare.  The answers are all that the outcome depends on.  Another
memory that gives the same answers leads to the same outcome, whatever else it holds, and
`decision_tree.py` makes use of that.

Times are handed out as `Instant` and `Span`, which can be moved and compared and nothing else,
so that no code can depend on a time in a way that is not noted.
"""

from __future__ import annotations

import math
from typing import TypeAlias

from gcs.gate.machine.memory import Memory, Task
from tests.proof.vector import FIELDS, NEVER_NONE, PLACE, TIMES, Codes, Vector

Question: TypeAlias = tuple[int, int, int]
"""`(place, VALUE, 0)`: which code is there?  `(place, KNOWN, 0)`: is there a time?
`(later, earlier, by_ns)`: is the time at `later` more than `by_ns` after the one at `earlier`?"""

VALUE = -1
KNOWN = -2


class Questions:
    """Answers from one vector at a time, and notes every question that it was asked."""

    def __init__(self, codes: Codes) -> None:
        self.codes = codes
        self.look_at([])

    def look_at(self, vector: Vector) -> None:
        """Answer from `vector` from here on, with nothing noted yet."""
        self._vector = vector
        self.values: dict[str, object] = {}
        self.asked: dict[Question, int] = {}

    def later_by(self, later: int, earlier: int, by_ns: int) -> bool:
        a_ns, b_ns = self._vector[later], self._vector[earlier]
        assert a_ns is not None
        assert b_ns is not None
        answer = a_ns - b_ns > by_ns
        self.asked[later, earlier, by_ns] = answer
        return answer

    def value(self, name: str) -> object:
        """The value of a field: the same object each time, until another vector is looked at."""
        if name not in self.values:
            self.values[name] = self._time(name) if name in TIMES else self._value(name)
        return self.values[name]

    def _value(self, name: str) -> object:
        place = PLACE[name]
        code = self._vector[place]
        assert code is not None
        self.asked[place, VALUE, 0] = code
        value = self.codes.decode(name, code)
        if name == "task":
            return WatchedTask(self) if value else None
        return value

    def _time(self, name: str) -> Instant | None:
        place = PLACE[name]
        if name not in NEVER_NONE:
            known = self._vector[place] is not None
            self.asked[place, KNOWN, 0] = known
            if not known:
                return None
        return Instant(self, place)


class Span:
    """How long it is from one time to another, in nanoseconds, times a factor, plus something."""

    __slots__ = ("_earlier", "_factor", "_later", "_plus", "_questions")
    __hash__ = None  # type: ignore[assignment]

    def __init__(
        self, questions: Questions, later: int, earlier: int, plus: float, factor: float = 1
    ) -> None:
        assert factor > 0
        self._questions = questions
        self._later, self._earlier, self._plus, self._factor = later, earlier, plus, factor

    def after(self, start: Instant) -> Instant:
        """This long after `start`, from where the span is measured."""
        assert (self._earlier, self._factor) == (start.place, 1)
        assert isinstance(self._plus, int)
        return Instant(self._questions, self._later, start.plus_ns + self._plus)

    def __add__(self, more: float) -> Span:
        return Span(self._questions, self._later, self._earlier, self._plus + more, self._factor)

    def __mul__(self, by: float) -> Span:
        plus, factor = self._plus * by, self._factor * by
        return Span(self._questions, self._later, self._earlier, plus, factor)

    def __truediv__(self, by: float) -> Span:
        return self * (1 / by)

    def __gt__(self, than: float) -> bool:
        return self._exceeds(math.floor((than - self._plus) / self._factor))

    def __ge__(self, than: float) -> bool:
        return self._exceeds(math.ceil((than - self._plus) / self._factor) - 1)

    def __lt__(self, than: float) -> bool:
        return not self >= than

    def __le__(self, than: float) -> bool:
        return not self > than

    def __bool__(self) -> bool:
        raise TypeError("a span is compared, and nothing else")

    def _exceeds(self, ns: int) -> bool:
        return self._questions.later_by(self._later, self._earlier, ns)

    __radd__ = __add__
    __rmul__ = __mul__


class Instant:
    """The time at a place of the vector, and nanoseconds added to it."""

    __slots__ = ("_questions", "place", "plus_ns")
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, questions: Questions, place: int, plus_ns: int = 0) -> None:
        self._questions, self.place, self.plus_ns = questions, place, plus_ns

    def __add__(self, ns: int | Span) -> Instant:
        if isinstance(ns, Span):
            return ns.after(self)
        return Instant(self._questions, self.place, self.plus_ns + ns)

    def __sub__(self, other: Instant) -> Span | int:
        plus_ns = self.plus_ns - other.plus_ns
        if self.place == other.place:
            return plus_ns
        return Span(self._questions, self.place, other.place, plus_ns)

    def __gt__(self, other: Instant) -> bool:
        return self - other > 0

    def __ge__(self, other: Instant) -> bool:
        return self - other >= 0

    def __lt__(self, other: Instant) -> bool:
        return self - other < 0

    def __le__(self, other: Instant) -> bool:
        return self - other <= 0

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Instant) and self >= other and self <= other

    def __bool__(self) -> bool:
        raise TypeError("a time is compared, and nothing else")


class WatchedMemory(Memory):
    """A memory that is read through `Questions`.

    It has no field of its own to begin with.  What is read or written is kept in it, so that
    each field is asked for once; a vector that is looked at later needs a fresh one.
    """

    def __init__(self, questions: Questions) -> None:
        self.questions = questions

    def copy(self) -> WatchedMemory:
        twin = object.__new__(WatchedMemory)
        twin.__dict__.update(self.__dict__)
        return twin

    def written(self) -> dict[str, object]:
        """The fields that were written, and what they are now."""
        read = self.questions.values
        nothing = object()
        return {
            name: value
            for name, value in self.__dict__.items()
            if name in PLACE and value is not read.get(name, nothing)
        }

    def unread(self) -> WatchedMemory:
        """Another one with what was written, and nothing that was read."""
        twin = WatchedMemory(self.questions)
        twin.__dict__.update(self.written())
        return twin


class _WatchedField:
    """Gives way to what the memory holds itself: it has no `__set__`."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __get__(self, memory: WatchedMemory, _owner: type) -> object:
        value = memory.__dict__[self._name] = memory.questions.value(self._name)
        return value


for _name in FIELDS:
    setattr(WatchedMemory, _name, _WatchedField(_name))


class WatchedTask:
    """A request under way of which only that is asked which is read.

    It passes for a `Task`, and a changed copy of it is one.
    """

    __dataclass_fields__ = Task.__dataclass_fields__

    def __init__(self, questions: Questions) -> None:
        self._questions = questions

    @property  # type: ignore[misc]  # as unittest.mock does
    def __class__(self) -> type:
        return Task

    def __getattr__(self, name: str) -> object:
        return self._questions.value(name)
