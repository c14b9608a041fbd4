"""What fleets cost over real sockets: CPU time, whether they keep up, and memory.

Run: python -m tools.measure_fleet [--seconds 10]

All vehicles hover while they are measured.  CPU time is the program's own (user and system), the
pace is the vehicles' time stamps against the wall: below 1 where the machine has no core to spare.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from dataclasses import dataclass

from tools.fleet_listener import Fleet, fleet


@dataclass(frozen=True)
class Case:
    name: str
    count: int
    own: bool
    shared: bool
    sparse: bool


CASES = (
    Case("1, all that px4 sends, two links", 1, own=True, shared=True, sparse=False),
    Case("10, all that px4 sends, own and shared links", 10, own=True, shared=True, sparse=False),
    Case("100, all that px4 sends, own links", 100, own=True, shared=False, sparse=False),
    Case("100, all that px4 sends, own and shared links", 100, own=True, shared=True, sparse=False),
    Case("250, 10 Hz position, one shared link", 250, own=False, shared=True, sparse=True),
    Case("1,000, 10 Hz position, own links", 1_000, own=True, shared=False, sparse=True),
)
HOVER_M = 18.0
GIVE_UP_S = 120.0


def measure(case: Case, flying: Fleet, seconds: float) -> str:
    listener = flying.listener
    listener.listen(3.0)
    on_ground_mib = flying.resident_mib
    flying.take_off()
    end_s = time.monotonic() + GIVE_UP_S
    while listener.height_m < HOVER_M and time.monotonic() < end_s:
        listener.listen(1.0)
    if listener.height_m < HOVER_M:
        return f"{case.name}: did not take off ({listener.height_m:.1f} m)"
    listener.forget()
    cpu_s, boot_ms, start_s = flying.cpu_s, listener.boot_ms, time.monotonic()
    listener.listen(seconds)
    wall_s = time.monotonic() - start_s
    cpu = (flying.cpu_s - cpu_s) / wall_s
    pace = (listener.boot_ms - boot_ms) / 1e3 / wall_s
    heard = len(listener.positions) if case.own else case.count
    rate = sum(listener.positions.values()) / wall_s / case.count
    return (
        f"{case.name}:\n"
        f"  CPU {cpu / pace:.3f} s per simulated second, of which {pace:.3f} a second; "
        f"{listener.datagrams / wall_s:,.0f} datagrams/s, "
        f"{listener.data_bytes / wall_s / 1e6:.2f} MB/s, "
        f"{rate:.1f} positions/s from each of {heard}\n"
        f"  resident {flying.resident_mib:.0f} MiB ({on_ground_mib:.0f} at the start)"
    )


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--smallest", type=int, default=1)
    parser.add_argument("--largest", type=int, default=1_000)
    asked = parser.parse_args()
    if not sys.platform.startswith("linux"):
        print("CPU time and memory of another program are read from /proc, which is not here")
        return 0
    for case in CASES:
        if not asked.smallest <= case.count <= asked.largest:
            continue
        with fleet(case.count, own=case.own, shared=case.shared, sparse=case.sparse) as flying:
            print(measure(case, flying, asked.seconds))
            print(f"  load {os.getloadavg()[0]:.1f}", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
