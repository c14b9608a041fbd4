"""The setpoint stream, the memory and an abort of a station with a crowd of hostile clients.

Run: python -m tests.bench.measure_hostile_clients [COUNT]

Garbage, floods, half lines and clients that never read, 24 at a time, 1,000 in all; the intervals
between setpoints from an independent listener on the wire, before and during.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from gcs import ipc
from gcs.operator.joined import JoinedStation
from gcs.shell import stations
from gcs.shell.stations import Description
from tests.bench.measure_abort import Stopwatch
from tests.system.hostile_clients import MODULE, intervals_ms, resident_kb
from tests.system.station import Station, tapped
from tests.system.wire_tap import WireTap

CLIENTS = 1_000
ABORTS = 20
HOLD_MODE = "AUTO.LOITER"
QUIET_S = 10.0


def tell(name: str, found: Sequence[float]) -> None:
    p1, p50, p99 = (found[len(found) * part // 100] for part in (1, 50, 99))
    print(
        f"{name:8} {len(found)} intervals, ms: p1 {p1:.2f}  p50 {p50:.2f}  p99 {p99:.2f}  "
        f"worst {found[-1]:.2f}"
    )


def abort_ms(watch: Stopwatch, described: Description, operator: Station) -> float:
    """Join as `gcs abort` does, ask at once; from the word to the bytes on the wire."""
    joined = JoinedStation.join(described, "measure", hold_on_leave=False)
    took_ms = watch.latency_ms(lambda: joined.send(ipc.Ask(1, "abort")))
    seen = operator.dialogue
    operator.until(lambda: seen.snapshot is not None and seen.snapshot.mode == HOLD_MODE, "a hold")
    joined.send(ipc.Leave("done"))
    joined.close()
    operator.fly("resume")
    return took_ms


def main(count: int) -> None:
    watch = Stopwatch()
    with (
        tempfile.TemporaryDirectory(prefix="gcs-") as folder,
        tempfile.TemporaryDirectory() as logs,
    ):
        os.environ["XDG_RUNTIME_DIR"] = folder
        with tapped(Path(logs), tap=WireTap(watch.hear)) as (operator, tap):
            operator.fly("arm", "takeoff 3")
            (described,) = stations.running(stations.folder_of())
            quiet_ns = time.monotonic_ns()
            operator.dialogue.wait_until(lambda: False, QUIET_S)
            begin_ns = time.monotonic_ns()
            before_kb = most_kb = resident_kb(described.pid)
            words = [sys.executable, "-m", MODULE]
            crowd = subprocess.Popen([*words, described.socket_path, str(count), "1"])
            while crowd.poll() is None:
                operator.dialogue.wait_until(lambda: False, 0.2)
                most_kb = max(most_kb, resident_kb(described.pid))
            end_ns = time.monotonic_ns()
            tell("quiet", intervals_ms(tap, quiet_ns, begin_ns))
            tell("crowded", intervals_ms(tap, begin_ns, end_ns))
            print(f"{count} clients in {(end_ns - begin_ns) / 1e9:.0f} s")
            print(f"memory: {before_kb} kB before, at most {most_kb} kB")
            crowd = subprocess.Popen([*words, described.socket_path, "100000", "2"])
            took = [abort_ms(watch, described, operator) for _ in range(ABORTS)]
            crowd.terminate()
            crowd.wait()
            print(f"abort from another program meanwhile: worst of {ABORTS} {max(took):.1f} ms")
            operator.leave()
    print(f"load {os.getloadavg()[0]:.2f}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else CLIENTS)
