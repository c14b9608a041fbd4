"""Some tests, in this process, in a given order, until the first that fails."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

import pytest
from hypothesis import Phase, settings

from tests.mutants.targets import Target

EXAMPLES = 50
"""Of each property, at most; the same ones each time, and not made smaller when one fails."""

STEADY = (Phase.explicit, Phase.generate)


@dataclass(slots=True)
class Outcome:
    """`failed` is the first test that failed, or "collection"; "" where none did."""

    failed: str = ""
    seconds: dict[str, float] = field(default_factory=dict)


class _Plugin:
    def __init__(
        self, order: Sequence[str] | None, skip: Sequence[str], watch: Callable[[str], None]
    ) -> None:
        self.outcome = Outcome()
        self._rank = None if order is None else {test: i for i, test in enumerate(order)}
        self._skip, self._watch = skip, watch

    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        kept = [i for i in items if not any(part in i.nodeid for part in self._skip)]
        if (rank := self._rank) is not None:
            kept = sorted((i for i in kept if i.nodeid in rank), key=lambda i: rank[i.nodeid])
        for item in kept:
            _fewer_examples(item)
        items[:] = kept

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        self._watch(item.nodeid)
        began = time.process_time()
        result = yield
        self.outcome.seconds[item.nodeid] = time.process_time() - began
        self._watch("")
        return result

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed and not self.outcome.failed:
            self.outcome.failed = report.nodeid

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        if report.failed and not self.outcome.failed:
            self.outcome.failed = "collection"


def run_tests(
    target: Target,
    paths: Sequence[str],
    *,
    order: Sequence[str] | None = None,
    skip: Sequence[str] = (),
    watch: Callable[[str], None] = lambda test: None,
) -> Outcome:
    """`order` are the tests to run, None for all; `watch` is told the one that runs, then "".

    To be called once in a process: the modules under test stay imported.
    """
    os.environ["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"
    plugin = _Plugin(order, (*target.deselect, *skip), watch)
    arguments = ["-x", f"--rootdir={target.root}", "--import-mode=importlib"]
    for idle in ("cacheprovider", "unraisableexception", "threadexception", "faulthandler"):
        arguments += ["-p", f"no:{idle}"]
    settled = target.root / "pyproject.toml"
    if settled.exists():
        arguments.append(f"--config-file={settled}")
    os.chdir(target.root)
    code = pytest.main([*arguments, *paths], plugins=[plugin])
    if code not in (0, 5) and not plugin.outcome.failed:
        plugin.outcome.failed = f"pytest ended with {int(code)}"
    return plugin.outcome


def _fewer_examples(item: pytest.Item) -> None:
    """A property keeps its own settings but for how many examples, which ones, and no shrinking."""
    test = getattr(item, "obj", item)
    test = getattr(test, "__func__", test)
    if getattr(test, "is_hypothesis_test", False):
        own: settings = getattr(test, "_hypothesis_internal_use_settings", None) or settings()
        fewer = settings(
            own,
            max_examples=min(EXAMPLES, own.max_examples),
            phases=STEADY,
            derandomize=True,
            database=None,
            deadline=None,
        )
        vars(test)["_hypothesis_internal_use_settings"] = fewer
