"""How the tests of a run are shared out among its workers, so that all of them end together.

Some workers have a lane each, in which programs wait for real time, and the others compute
meanwhile.  All else goes out by file, so that what a file prepares is prepared once, but for the
files of which single tests are long.  To collect all tests costs a worker seven seconds of
computing, so in a run of all tests each collects only those that it may be given.
"""

from __future__ import annotations

from tests.soaking import SOAKING

LANES = {
    "other stations through the bridge": ("tests/clients/test_bridge_peers.py",),
    "other stations": ("tests/clients/",),
    "programs, a to k": tuple(f"tests/system/test_{letter}" for letter in "abcdefghijk"),
    "programs, l to z": ("tests/system/",),
}
"""Separate processes over real sockets, which mostly wait: the first lane that a test fits in.
They last about as long, and not longer than two workers compute."""
COMPUTING = "what computes"
"""The part of the workers that have no lane."""
EARLY = ("tests/unit/gate/test_explore",)
"""Files that take as long as many others together; what their first test prepares, all share."""
LONG = ("tests/loopback/test_random_flights.py", "tests/soak/test_hostile_gate.py")
"""Files of which a single test takes as long as others as a whole."""


def lane(nodeid: str) -> str | None:
    return next((name for name, tests in LANES.items() if nodeid.startswith(tests)), None)


def part(worker: str, count: int) -> str | None:
    """What one of so many workers (gw0, gw1 and so on) collects: a lane, what computes, or all.

    All with fewer workers than lanes and two that compute, or in the place of one that died.
    """
    number = int(worker.removeprefix("gw"))
    if count < len(LANES) + 2 or number >= count:
        return None
    return list(LANES)[number] if number < len(LANES) else COMPUTING


def looks_into(path: str, own: str) -> bool:
    """Whether a worker with this part collects a file, or looks into a folder (it ends with /)."""
    if own == COMPUTING:
        return lane(path) is None
    if path.endswith("/"):
        return any(path.startswith(tests) or tests.startswith(path) for tests in LANES[own])
    return lane(path) == own


def share(nodeid: str) -> str:
    """What one worker does in a row: a whole lane, one long test, or a file.

    In a soak single tests are long, but for those that share an exploration.
    """
    if nodeid.startswith(LONG) or (SOAKING and not nodeid.startswith(EARLY)):
        return nodeid
    return lane(nodeid) or nodeid.partition("::")[0]


def turn(nodeid: str) -> int:
    """What begins first is what ends last."""
    if lane(nodeid):
        return 0
    return 1 if nodeid.startswith((*EARLY, *LONG)) else 2
