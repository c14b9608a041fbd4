"""What all tests share: how many examples, which are for `make thorough` and for `make soak`, and
what is said of those that were left out.

`make test` looks at the same examples each time: a run that must pass before a change lands must
not fail for another change's sake.  What is exhaustive, or one thing many times over, is marked
`thorough`: `make test` has a share of it, `make thorough` the rest, and four times as many examples
of each property.  New examples are for `make soak`, which draws them at random, draws more of them,
and flies the tests that are marked `soak` as well.
"""

from __future__ import annotations

import gc
import sys
import tempfile
from collections.abc import Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

from tests.sample_files import ELSEWHERE, NOT_HERE
from tests.shares import other_flights
from tests.soaking import SOAKING, counts, left_out

UNIT = Path(__file__).parent / "unit"
FLOWN = tuple(
    UNIT / folder
    for folder in ("autopilot", "estimator", "failsafes", "faults", "model", "parameters")
)
"""Folders whose tests step a vehicle through minutes of its time."""
OUTSIDE = ("subprocess.Popen", "os.posix_spawn", "os.fork", "socket.bind", "socket.connect")
"""Audit events of what a test may do only if it is marked slow."""

# How quickly this machine draws examples is nothing that a test is about.
ON_ANY_MACHINE = settings(deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.register_profile("steady", ON_ANY_MACHINE, derandomize=True)
settings.register_profile("quick", ON_ANY_MACHINE, derandomize=True, max_examples=25)
settings.register_profile("soak", ON_ANY_MACHINE, max_examples=2_000)
settings.load_profile("soak" if SOAKING else "steady")


@cache
def is_slow(path: Path) -> bool:
    """By where it is; single files say it themselves (`pytestmark`)."""
    flown = any(path.is_relative_to(folder) for folder in FLOWN)
    return flown or not path.is_relative_to(UNIT) or path.name.startswith("test_explore")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Leave to `make soak` what is its own; mark what is slow and what is `thorough`, before `-m`
    looks at it."""
    left = left_out(items)
    if left:
        config.hook.pytest_deselected(items=left)
    out = set(left)
    flown = [item for item in items if item not in out]
    for item in other_flights(flown):
        item.add_marker(pytest.mark.thorough)
    for item in flown:
        if is_slow(item.path) or item.get_closest_marker("thorough"):
            item.add_marker(pytest.mark.slow)
    items[:] = flown


@pytest.fixture(scope="session", autouse=True)
def _stations_of_its_own() -> Iterator[None]:
    """No test finds a station that this user runs, nor one of another worker's tests."""
    with (
        tempfile.TemporaryDirectory(prefix="gcs-") as folder,
        pytest.MonkeyPatch.context() as patch,
    ):
        patch.setenv("XDG_RUNTIME_DIR", folder)
        yield


def pytest_collection_finish() -> None:
    """Thousands of tests stay to the end: no use in looking through them for garbage each time."""
    gc.freeze()


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Collecting is a good part of a run: no file is looked into of which no test is wanted."""
    if config.getoption("markexpr") == "not slow" and collection_path.name.startswith("test_"):
        return is_slow(collection_path) or None
    return None


_quick: list[str] = []
"""The test under way, if it is none of the slow ones."""


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Iterator[None]:
    """Holds a test to what it says of itself: without `slow`, no process and no socket."""
    _quick[:] = [] if item.get_closest_marker("slow") else [item.nodeid]
    try:
        yield
    finally:
        _quick.clear()


def _watch(event: str, _details: tuple[object, ...]) -> None:
    if _quick and event in OUTSIDE:
        raise RuntimeError(f"{event} in a test that is not marked slow: {_quick[0]}")


sys.addaudithook(_watch)


LEFT_OUT = pytest.StashKey[int]()
"""How many tests that are marked `thorough` this run leaves out."""


def pytest_deselected(items: Sequence[pytest.Item]) -> None:
    for item in items:
        asked = "thorough" in item.config.getoption("markexpr")
        rarer = item.get_closest_marker("soak")
        if asked and item.get_closest_marker("thorough") and not rarer:
            item.config.stash[LEFT_OUT] = item.config.stash.get(LEFT_OUT, 0) + 1


def pytest_sessionfinish(session: pytest.Session) -> None:
    """A worker tells the process that sums up; all workers left out the same tests."""
    worker: dict[str, object] | None = getattr(session.config, "workeroutput", None)
    if worker is not None:
        worker["left_out"] = session.config.stash.get(LEFT_OUT, 0)


@pytest.hookimpl(optionalhook=True)
def pytest_testnodedown(node: Any) -> None:
    left_out = getattr(node, "workeroutput", {}).get("left_out", 0)
    node.config.stash[LEFT_OUT] = max(left_out, node.config.stash.get(LEFT_OUT, 0))


def pytest_terminal_summary(
    terminalreporter: pytest.TerminalReporter, config: pytest.Config
) -> None:
    """Says what a soak counted, and how many tests were left out or had no data to look at, so that
    nobody takes silence for a pass."""
    for line in counts(terminalreporter.stats.get("passed", [])):
        terminalreporter.write_line(line)
    if left_out := config.stash.get(LEFT_OUT, 0):
        terminalreporter.write_line(f"{left_out} longer tests are left to `make thorough`")
    reasons = [str(report.longrepr) for report in terminalreporter.stats.get("skipped", [])]
    count = sum(NOT_HERE in reason for reason in reasons)
    if count:
        what = "1 test was" if count == 1 else f"{count} tests were"
        terminalreporter.write_line(
            f"{what} skipped: sample data from outside the repository is not in {ELSEWHERE}; "
            "tests/samples/README.md says how to get it"
        )
