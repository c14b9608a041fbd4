"""All mutants of a target: which there are, which tests each has to face, and what became of it."""

from __future__ import annotations

import ast
import contextlib
import gc
import importlib
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from tests.mutants.child import Answer, ask, ask_all
from tests.mutants.coverage import Coverage, measure
from tests.mutants.loading import load_altered
from tests.mutants.mutant import Fate, Mutant, Result
from tests.mutants.names import Mentions, Uses
from tests.mutants.run_tests import Outcome, run_tests
from tests.mutants.settings import settings_mutants
from tests.mutants.source import Enums, enums_of, mutants_of
from tests.mutants.targets import Target

CPU_LEAST_S = 5.0
CPU_FACTOR = 10.0
"""A mutant has so much more time than its tests take, and then it is endless."""


class BaselineError(Exception):
    """The tests do not pass on the code as it stands."""


def generate(target: Target) -> tuple[list[Mutant], Enums]:
    """Every mutant: source text, settings, then tables; the same order each time."""
    trees = {path: ast.parse(path.read_text(encoding="utf-8")) for path in target.sources()}
    enums = enums_of(list(trees.values()))
    mutants = []
    for path in trees:
        mutants += mutants_of(path, target.root, module_name(path, target.root), enums)
    for settings in target.settings:
        mutants += settings_mutants(target.root / settings, target.root)
    for i in range(len(target.tables)):
        mutants += ask(lambda i=i: table_mutants(target, i))  # type: ignore[misc]
    return mutants, enums


def module_name(path: Path, root: Path) -> str:
    parts = path.relative_to(root).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def table_mutants(target: Target, index: int) -> list[Mutant]:
    """Imports the package under test: to be called in a process of its own."""
    table = target.tables[index]
    module = importlib.import_module(table.module)
    value = getattr(module, table.attribute)
    file = Path(str(module.__file__)).relative_to(target.root).as_posix()
    return [
        Mutant(
            f"{table.attribute} {made.name}: {made.before} -> {made.after}",
            file,
            0,
            made.kind,
            f"{made.name}: {made.before}",
            made.after,
            number,
            table.module,
            cells=made.cells,
            table=index,
        )
        for number, made in enumerate(importlib.import_module(table.alterations).alterations(value))
    ]


@dataclass(frozen=True, slots=True)
class Baseline:
    """The tests as they pass: seconds by test, what each runs, and what they import."""

    seconds: Mapping[str, float]
    coverage: Coverage
    imported: tuple[str, ...]


def baseline(target: Target, *, slow: bool) -> Baseline:
    """Raises BaselineError where a test fails already."""
    jobs: list[Callable[[], Outcome | Coverage | tuple[str, ...]]] = [
        lambda: run_tests(target, target.tests, skip=() if slow else target.slow),
        lambda: measure(target, slow=slow),
        lambda: libraries(target),
    ]
    answers = dict(ask_all(range(3), lambda i: jobs[i], lambda _: 3600.0, 2))
    plain, coverage, imported = (answers[i].value for i in range(3))
    assert isinstance(plain, Outcome)
    assert isinstance(coverage, Coverage)
    assert isinstance(imported, tuple)
    for outcome in (plain, coverage.outcome):
        if outcome.failed:
            raise BaselineError(f"{outcome.failed} fails with nothing altered")
    return Baseline(plain.seconds, coverage, imported)


def libraries(target: Target) -> tuple[str, ...]:
    """Modules that the tests import and that are not the project's own."""
    run_tests(target, target.tests, order=())
    own = {path.stem for path in target.root.iterdir()}
    return tuple(name for name in sys.modules if name.partition(".")[0] not in own)


def preload(names: Sequence[str]) -> None:
    """Import what every child would import again.  None of it knows the package under test."""
    for name in names:
        with contextlib.suppress(Exception):
            importlib.import_module(name)
    gc.collect()
    gc.freeze()  # else every child copies the pages of all this when it collects


class Chooser:
    """The tests that a mutant has to face, the quickest first."""

    def __init__(self, target: Target, base: Baseline, uses: Uses, mentions: Mentions) -> None:
        self._target, self._base, self._uses = target, base, uses
        self._mentions = mentions
        self._quickest = sorted(base.seconds, key=lambda test: (base.seconds[test], test))

    def tests_for(self, mutant: Mutant) -> list[str]:
        near = self._target.tests_near(mutant.file)
        return [test for test in self._reaching(mutant) if test.startswith(near)]

    def _reaching(self, mutant: Mutant) -> list[str]:
        coverage = self._base.coverage
        if mutant.cells:
            places = [coverage.cells.get(cell, set()) for cell in mutant.cells]
        else:
            lines = [(mutant.file, line) for line in mutant.lines]
            lines += self._uses.of(mutant.names)
            if not lines:
                return self._quickest
            places = [coverage.lines.get(line, set()) for line in lines]
        chosen = set().union(*places)
        files = self._mentions.of(self._uses.made_of(mutant.names))
        return [
            test for test in self._quickest if test in chosen or test.partition("::")[0] in files
        ]

    def seconds_for(self, mutant: Mutant) -> float:
        return sum(self._base.seconds[test] for test in self.tests_for(mutant))


def judge(
    target: Target, enums: Enums, mutants: Sequence[Mutant], chooser: Chooser, workers: int
) -> Iterator[Result]:
    """What became of each, as it becomes known; those that no test runs come first."""
    faced = []
    for mutant in mutants:
        if chooser.tests_for(mutant):
            faced.append(mutant)
        else:
            yield Result(mutant, Fate.UNTESTED, "", 0, 0.0)

    def work_of(mutant: Mutant) -> Callable[[], Outcome]:
        return lambda: face(target, enums, mutant, chooser.tests_for(mutant))

    def limit_s(mutant: Mutant) -> float:
        return CPU_LEAST_S + CPU_FACTOR * chooser.seconds_for(mutant)

    for mutant, answer in ask_all(faced, work_of, limit_s, workers):
        yield _result(mutant, answer)


def face(target: Target, enums: Enums, mutant: Mutant, tests: Sequence[str]) -> Outcome:
    """To be called in a process of its own."""
    load_altered(target, mutant, enums)
    files = list(dict.fromkeys(test.partition("::")[0] for test in tests))
    return run_tests(target, files, order=tests)


def _result(mutant: Mutant, answer: Answer[Outcome]) -> Result:
    outcome = answer.value
    if outcome is None:
        fate = Fate.TIMED_OUT if answer.timed_out else Fate.KILLED
        return Result(mutant, fate, "the process ended", 0, answer.cpu_s)
    fate = Fate.KILLED if outcome.failed else Fate.SURVIVED
    return Result(mutant, fate, outcome.failed, len(outcome.seconds), answer.cpu_s)
