"""Which tests run which line and read which entry of a table, and how long each takes."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from types import CodeType, FrameType
from typing import TypeAlias

from tests.mutants.loading import change_value
from tests.mutants.run_tests import Outcome, run_tests
from tests.mutants.targets import Target

Tracer: TypeAlias = Callable[[FrameType, str, object], "Tracer | None"]


@dataclass(slots=True)
class Coverage:
    """Tests by line of a file, and by name of a table's entry."""

    lines: dict[tuple[str, int], set[str]] = field(default_factory=dict)
    cells: dict[str, set[str]] = field(default_factory=dict)
    outcome: Outcome = field(default_factory=Outcome)


class _Watch:
    """Notes what runs while a test runs."""

    def __init__(self, target: Target) -> None:
        self.test = ""
        self.coverage = Coverage()
        self._files = {str(p): p.relative_to(target.root).as_posix() for p in target.sources()}
        self._lines: set[tuple[str, int]] = set()
        self._cells: set[str] = set()
        self._unseen: dict[CodeType, set[int]] = {}

    def watch(self, test: str) -> None:
        if test:
            self._lines, self._cells, self._unseen = set(), set(), {}
            self.test = test
            sys.settrace(self._called)
            return
        sys.settrace(None)
        for line in self._lines:
            self.coverage.lines.setdefault(line, set()).add(self.test)
        for cell in self._cells:
            self.coverage.cells.setdefault(cell, set()).add(self.test)
        self.test = ""

    def read(self, cell: str) -> None:
        if self.test:
            self._cells.add(cell)

    def _called(self, frame: FrameType, event: str, arg: object) -> Tracer | None:
        file = self._files.get(frame.f_code.co_filename)
        if file is None:
            return None
        code = frame.f_code
        known = self._unseen.get(code)
        if known is not None and not known:
            return None  # all of it has run: tracing it again would only take time
        unseen = self._unseen.setdefault(code, _lines_within(code))
        lines = self._lines

        def line(frame: FrameType, event: str, arg: object) -> Tracer | None:
            if event == "line":
                lines.add((file, frame.f_lineno))
                unseen.discard(frame.f_lineno)
            return line

        return line


def _lines_within(code: CodeType) -> set[int]:
    """Those that tell that they run; that of the `def` is told as a call."""
    return {line for _, _, line in code.co_lines() if line} - {code.co_firstlineno}


class _Recorded(Mapping[object, object]):
    """A mapping that tells which of its entries are read."""

    def __init__(
        self,
        mapping: Mapping[object, object],
        name: Callable[[object], str],
        read: Callable[[str], None],
    ) -> None:
        self._mapping, self._name, self._read = mapping, name, read

    def __getitem__(self, key: object) -> object:
        value = self._mapping[key]
        self._read(self._name(key))
        return value

    def __iter__(self) -> Iterator[object]:
        return iter(self._mapping)

    def __len__(self) -> int:
        return len(self._mapping)


def measure(target: Target, *, slow: bool) -> Coverage:
    """Runs every test once, traced.  To be called in a process of its own."""
    watch = _Watch(target)
    for table in target.tables:
        name_of = _namer(table.alterations)
        change_value(
            table,
            lambda value, name_of=name_of: _Recorded(value, name_of, watch.read),  # type: ignore[misc]
        )
    skip = () if slow else target.slow
    watch.coverage.outcome = run_tests(target, target.tests, skip=skip, watch=watch.watch)
    return watch.coverage


def _namer(module: str) -> Callable[[object], str]:
    def name(key: object) -> str:
        found: str = importlib.import_module(module).name_of(key)
        return found

    return name
