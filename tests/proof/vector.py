"""What a gate remembers, and the time, as a list of numbers.

That is what the explorer keeps of each situation, and what a decision tree is walked with: a
time as it is, in nanoseconds, and of everything else a code.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import fields
from typing import Any, Final, TypeAlias

from gcs.gate.machine.memory import Memory, Task

Vector: TypeAlias = list[int | None]
"""At `NOW` the time, then a number for each of `PLACE`.  None is a time that there is not."""

NOW: Final = 0
FIELDS: Final = tuple(field.name for field in fields(Memory))
TASK_FIELDS: Final = tuple(field.name for field in fields(Task))
PLACE: Final = {name: place for place, name in enumerate((*FIELDS, *TASK_FIELDS), start=NOW + 1)}
"""Where each field of a memory stands, and behind them each of the request under way.  At "task"
itself stands only whether there is one."""

TIMES: Final = frozenset(name for name in PLACE if name.endswith("_ns"))
"""The fields that are times: every name carries its unit."""

NEVER_NONE: Final = TIMES & {field.name for field in fields(Memory) if field.type == "int"}
"""The times that are always there."""


def values_of(memory: Memory) -> Iterator[tuple[str, Any]]:
    """Each name of `PLACE`, and the value there."""
    for name in FIELDS:
        yield name, memory.task is not None if name == "task" else getattr(memory, name)
    yield from task_values(memory.task)


def task_values(task: Task | None) -> Iterator[tuple[str, Any]]:
    for name in TASK_FIELDS:
        yield name, None if task is None else getattr(task, name)


class Codes:
    """Every value that a field ever had, numbered in the order they came."""

    def __init__(self) -> None:
        self._values: dict[str, list[object]] = {name: [] for name in PLACE}

    def encode(self, name: str, value: object) -> int:
        """Values are few, and not all of them can be hashed: they are compared."""
        values = self._values[name]
        for code, other in enumerate(values):
            if value is other or value == other:
                return code
        values.append(value)
        return len(values) - 1

    def decode(self, name: str, code: int | None) -> Any:
        assert code is not None
        return self._values[name][code]

    def vector_of(self, memory: Memory, now_ns: int) -> Vector:
        vector: Vector = [now_ns]
        for name, value in values_of(memory):
            vector.append(value if name in TIMES else self.encode(name, value))
        return vector

    def memory_of(self, vector: Vector) -> Memory:
        values: dict[str, Any] = {
            name: vector[place] if name in TIMES else self.decode(name, vector[place])
            for name, place in PLACE.items()
        }
        task = {name: values.pop(name) for name in TASK_FIELDS}
        values["task"] = Task(**task) if values["task"] else None
        return Memory(**values)
