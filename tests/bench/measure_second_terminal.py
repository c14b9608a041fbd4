"""From the word in a second program to the bytes of the hold on the wire.

Run: python -m tests.bench.measure_second_terminal

Twenty times each: `gcs abort`, the Python library, and `abort` typed into `gcs attach --plain`.
The time of the word is that of the program's own write to the station's socket; for the typed line
it is that of the write into its pipe.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from tests.bench.measure_abort import tell
from tests.system.flight_log import AUTO_LOITER
from tests.system.programs import GCS, Running, running
from tests.system.second_program import HoldWatch, loiter_seen_ns, noted_ns
from tests.system.station import Station, tapped
from tests.system.wire_tap import WireTap

TIMES = 20


def measure(
    name: str,
    watch: HoldWatch,
    tap: WireTap,
    operator: Station,
    abort: Callable[[], tuple[int, int]],
) -> None:
    """`abort` returns when it asked and when it was told that it is complete."""
    found, early = [], 0
    for _ in range(TIMES):
        goto = operator.send("goto 60 0 3")
        known = len(watch.passed_ns)
        asked_ns, complete_ns = abort()
        operator.until(lambda: goto.settled, "its ending")  # noqa: B023
        found.append((watch.passed_ns[known] - asked_ns) / 1e6)
        early += complete_ns < loiter_seen_ns(tap, AUTO_LOITER, asked_ns)
        operator.fly("resume", "goto 0 0 3")
    tell(name, found)
    print(f"  said complete before the hold was seen: {early} of {TIMES}")


def by_line(console: Running) -> tuple[int, int]:
    known = len(console.out)
    asked_ns = time.monotonic_ns()
    console.type("abort")
    while not any("abort: complete" in line for line in console.out[known:]):
        time.sleep(0.0005)
    return asked_ns, time.monotonic_ns()


def by_program(program: str) -> tuple[int, int]:
    noted = noted_ns(program)
    return noted.sent_ns, noted.complete_ns


def main() -> None:
    watch = HoldWatch()
    with (
        tempfile.TemporaryDirectory(prefix="gcs-") as folder,
        tempfile.TemporaryDirectory() as logs,
    ):
        os.environ["XDG_RUNTIME_DIR"] = folder
        with tapped(Path(logs), tap=WireTap(watch.hear)) as (operator, tap):
            operator.fly("arm", "takeoff 3")
            for program in ("gcs abort", "python"):
                measure(program, watch, tap, operator, lambda: by_program(program))  # noqa: B023
            with running(GCS, "attach", "--plain") as console:
                console.type("state")
                console.until_out("state:")
                measure("a typed line", watch, tap, operator, lambda: by_line(console))
                console.type("quit")
            operator.leave()
    print(f"load {os.getloadavg()[0]:.2f}")


if __name__ == "__main__":
    main()
