"""What all tests share: how many examples, which are for `make soak`, and what is said of skips.

`make test` looks at the same examples each time: a run that must pass before a change lands must
not fail for another change's sake.  `make quick` looks at a quarter as many.  New examples are for
`make soak`, which draws them at random, draws more of them, and flies the tests that are marked
`soak` as well.
"""

from __future__ import annotations

import gc
import os
import sys
import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, settings

from tests.lanes import in_real_time, share, turn
from tests.sample_files import ELSEWHERE, NOT_HERE

SOAKING = "MAVGATE_SOAK" in os.environ
UNIT = Path(__file__).parent / "unit"
FLOWN = tuple(
    UNIT / folder
    for folder in ("autopilot", "estimator", "failsafes", "faults", "model", "parameters")
)
"""Folders whose tests step a vehicle through minutes of its time."""
OUTSIDE = ("subprocess.Popen", "os.posix_spawn", "os.fork", "socket.bind", "socket.connect")
"""Audit events of what a test may do only if it is marked slow."""
GIVES_WAY_BY = 5
"""How much nicer a worker is that computes than the programs others wait for in real time."""

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
    """Mark what is slow, before `-m` looks at it; leave to `make soak` what is its own."""
    for item in items:
        if is_slow(item.path):
            item.add_marker(pytest.mark.slow)
    left = [] if SOAKING else [item for item in items if item.get_closest_marker("soak")]
    if left:
        config.hook.pytest_deselected(items=left)
    flown = [item for item in items if item not in left]
    items[:] = sorted(flown, key=lambda item: turn(item.nodeid))


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


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """With `-n`, shares the tests out as `tests/lanes.py` says; `--dist` chooses another way."""
    if config.getvalue("dist") != "load":
        return None
    from xdist.scheduler import LoadScopeScheduling

    config.option.loadscopereorder = False
    scheduler = LoadScopeScheduling(config, log)
    scheduler._split_scope = share
    return scheduler


@cache
def _give_way() -> None:
    """Once, and for as long as this worker lives."""
    if hasattr(os, "nice"):
        os.nice(GIVES_WAY_BY)


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Whoever computes takes nothing from the programs that others wait for in real time."""
    if "PYTEST_XDIST_WORKER" in os.environ and not in_real_time(item.nodeid):
        _give_way()


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


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Says how many tests had no data to look at, so that nobody takes silence for a pass."""
    reasons = [str(report.longrepr) for report in terminalreporter.stats.get("skipped", [])]
    count = sum(NOT_HERE in reason for reason in reasons)
    if count:
        what = "1 test was" if count == 1 else f"{count} tests were"
        terminalreporter.write_line(
            f"{what} skipped: sample data from outside the repository is not in {ELSEWHERE}; "
            "tests/samples/README.md says how to get it"
        )
