"""How the tests of a run are shared out among its workers, so that all of them end together.

Two workers begin with a lane each, in which programs wait for real time, and the others compute
meanwhile.  All else goes out by file, so that what a file prepares is prepared once, but for the
files of which single tests are long.
"""

from __future__ import annotations

LANES = ("tests/system/", "tests/clients/")
"""Separate processes over real sockets, which mostly wait."""
EARLY = ("tests/unit/gate/test_explore",)
"""Files that take as long as many others together; what their first test prepares, all share."""
LONG = ("tests/loopback/test_random_flights.py",)
"""Files of which a single test takes as long as others as a whole."""


def in_real_time(nodeid: str) -> bool:
    return nodeid.startswith(LANES)


def share(nodeid: str) -> str:
    """What one worker does in a row: a whole lane, one long test, or a file."""
    if nodeid.startswith(LONG):
        return nodeid
    lane = next((lane for lane in LANES if nodeid.startswith(lane)), None)
    return lane or nodeid.partition("::")[0]


def turn(nodeid: str) -> int:
    """What begins first is what ends last."""
    if in_real_time(nodeid):
        return 0
    return 1 if nodeid.startswith((*EARLY, *LONG)) else 2
