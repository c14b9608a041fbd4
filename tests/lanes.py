"""How the tests of a run are shared out among its workers, so that all of them end together.

Four workers have the tests in which programs wait for real time, and the others compute meanwhile.
Tests go out by file, so that what a file prepares is prepared once, but for the files of which
single tests are long.  To collect all tests costs a worker seven seconds of computing, so in a run
of all tests each collects only those that it may be given.
"""

from __future__ import annotations

from tests.soaking import SOAKING

PROGRAMS = ("tests/clients/", "tests/system/")
"""Separate processes over real sockets, which mostly wait.  Four workers last no longer with them
than two with all that computes."""
WAITING, COMPUTING = "programs", "what computes"
"""The two parts of the tests."""
WAITERS = 4
EARLY = ("tests/unit/gate/test_explore",)
"""Files that take as long as many others together; what their first test prepares, all share."""
LONG = (
    "tests/clients/test_bridge_peers.py",
    "tests/loopback/test_random_flights.py",
    "tests/soak/test_hostile_gate.py",
)
"""Files of which a single test takes as long as others as a whole."""


def waits(nodeid: str) -> bool:
    return nodeid.startswith(PROGRAMS)


def part(worker: str, count: int) -> str | None:
    """What one of so many workers (gw0, gw1 and so on) collects: a part of the tests, or all.

    All with fewer workers than four that wait and two that compute, or in the place of one that
    died.
    """
    number = int(worker.removeprefix("gw"))
    if count < WAITERS + 2 or number >= count:
        return None
    return WAITING if number < WAITERS else COMPUTING


def looks_into(path: str, own: str) -> bool:
    """Whether a worker with this part collects a file, or looks into a folder (it ends with /)."""
    if own == COMPUTING:
        return not waits(path)
    return waits(path) or (path.endswith("/") and any(one.startswith(path) for one in PROGRAMS))


def share(nodeid: str) -> str:
    """What one worker does in a row: one long test, or a file.

    In a soak single tests are long, but for those that share an exploration.
    """
    if nodeid.startswith(LONG) or (SOAKING and not nodeid.startswith(EARLY)):
        return nodeid
    return nodeid.partition("::")[0]


def turn(nodeid: str) -> int:
    """What begins first is what ends last."""
    if waits(nodeid):
        return 0
    return 1 if nodeid.startswith((*EARLY, *LONG)) else 2
