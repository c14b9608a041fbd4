"""The setpoint stream and the memory of a station with a live view, and hostile viewers at it.

Run: python -m tests.bench.measure_live_view [COUNT]

The intervals between setpoints by a listener on the wire: without a live view, with one
and a viewer that reads one message in a while, with a hundred hostile viewers at a time, COUNT in
all; and how long an abort takes meanwhile from a viewer's call to the bytes on the wire.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from gcs.live.program import COMMAND, Wanted, opened_by
from gcs.shell import stations
from tests.bench.measure_abort import Stopwatch
from tests.bench.measure_hostile_clients import HOLD_MODE, tell
from tests.system.hostile_clients import intervals_ms, resident_kb
from tests.system.hostile_viewers import MODULE
from tests.system.slow_viewer import slow_viewer
from tests.system.station import Station, tapped
from tests.system.viewer import viewer
from tests.system.wire_tap import WireTap

VIEWERS = 1_000
ABORTS = 10
QUIET_S = 10.0


def program_of(pid: int) -> int:
    """The process of the live view of that station; Linux only."""
    for each in Path("/proc").glob("[0-9]*/cmdline"):
        words = each.read_bytes().split(b"\0")
        if COMMAND[-1].encode() in words and any(f'"pid":{pid},'.encode() in w for w in words):
            return int(each.parent.name)
    raise AssertionError(f"station {pid} has no live view")


def holds(operator: Station) -> bool:
    seen = operator.dialogue.snapshot
    return seen is not None and seen.mode == HOLD_MODE


def main(count: int) -> None:
    watch = Stopwatch()
    with (
        tempfile.TemporaryDirectory(prefix="gcs-") as folder,
        tempfile.TemporaryDirectory() as logs,
    ):
        os.environ["XDG_RUNTIME_DIR"] = folder
        with tapped(Path(logs), tap=WireTap(watch.hear)) as (operator, tap):

            def wait(seconds: float) -> tuple[int, int]:
                begin_ns = time.monotonic_ns()
                operator.dialogue.wait_until(lambda: False, seconds)
                return begin_ns, time.monotonic_ns()

            operator.fly("arm", "takeoff 3")
            (described,) = stations.running(stations.folder_of())
            tell("alone", intervals_ms(tap, *wait(QUIET_S)))
            live = opened_by(Wanted(described.pid, "127.0.0.1", 0))
            assert live is not None
            port = int(live.url.rpartition(":")[2])
            with slow_viewer(port):
                tell("slow", intervals_ms(tap, *wait(QUIET_S)))
            served = program_of(described.pid)
            before_kb = resident_kb(described.pid), resident_kb(served)
            most_kb = before_kb
            begin_ns = time.monotonic_ns()
            crowd = subprocess.Popen([sys.executable, "-m", MODULE, str(port), str(count), "1"])
            while crowd.poll() is None:
                operator.dialogue.wait_until(lambda: False, 0.2)
                now_kb = resident_kb(described.pid), resident_kb(served)
                most_kb = max(most_kb[0], now_kb[0]), max(most_kb[1], now_kb[1])
            end_ns = time.monotonic_ns()
            tell("hostile", intervals_ms(tap, begin_ns, end_ns))
            print(f"{count} viewers in {(end_ns - begin_ns) / 1e9:.0f} s")
            print(f"station: {before_kb[0]} kB before, at most {most_kb[0]} kB")
            print(f"live view: {before_kb[1]} kB before, at most {most_kb[1]} kB")
            crowd = subprocess.Popen([sys.executable, "-m", MODULE, str(port), "100000", "2"])
            with viewer(live.url) as looker:
                took = []
                for _ in range(ABORTS):
                    took.append(watch.latency_ms(lambda: looker.call("abort")))
                    operator.until(lambda: holds(operator), "a hold")
                    operator.fly("resume")
            crowd.terminate()
            crowd.wait()
            print(f"abort from a viewer meanwhile: worst of {ABORTS} {max(took):.1f} ms")
            operator.leave()
    print(f"load {os.getloadavg()[0]:.2f}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else VIEWERS)
