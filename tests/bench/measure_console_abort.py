"""From an abort, typed into a console that waits for something else, to its bytes on the wire.

Run: python -m tests.bench.measure_console_abort [TIMES]

Each time a new vehicle and `gcs fly --plain` on a pipe: arm, takeoff 3, goto 60 0 3 at once, and
`abort` while it climbs.  An independent listener on the wire notes when the hold command passes.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time

from tests.bench.measure_abort import Stopwatch, tell
from tests.system.programs import GCS, running
from tests.system.vehicle_program import free_port, vehicle_sim
from tests.system.wire_tap import WireTap

TIMES = 20
CLIMBS_S = 2.5


def once() -> float:
    watch, port = Stopwatch(), free_port()
    with WireTap(watch.hear) as tap, tempfile.TemporaryDirectory() as folder:
        tap.connect(port)
        link = ("--link", f"udpin://127.0.0.1:{port}", "--log-dir", folder)
        with (
            vehicle_sim("--link", f"udpout://127.0.0.1:{tap.vehicle_port}"),
            running(GCS, "fly", "--plain", *link) as program,
        ):
            program.type("arm", "takeoff 3", "goto 60 0 3")
            program.until_out("takeoff 3: accepted")
            time.sleep(CLIMBS_S)
            took_ms = watch.latency_ms(lambda: program.type("abort"))
            program.until_out("abort: complete")
            assert not any(line.startswith("goto 60 0 3: accepted") for line in program.out)
    return took_ms


def main() -> None:
    times = int(sys.argv[1]) if len(sys.argv) > 1 else TIMES
    tell("a line into a console", [once() for _ in range(times)])
    print(f"load {os.getloadavg()[0]:.2f}")


if __name__ == "__main__":
    main()
