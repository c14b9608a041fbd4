"""`make bench`: every paired ratio, then every measurement in real time, one after the other.

Each is a program of its own too: `python -m tools.bench_wire`.
"""

from __future__ import annotations

import os
import subprocess
import sys

PROGRAMS = (
    "bench_wire",
    "bench_record",
    "bench_logfile",
    "bench_loop",
    "bench_bridge",
    "bench_vehicle",
    "measure_starts",
    "measure_armable",
    "measure_speedup",
    "measure_fleet",
    "measure_abort",
    "measure_stream",
    "measure_kills",
)


def main() -> int:
    """Run them all; the exit code of the worst."""
    worst = 0
    for program in PROGRAMS:
        load = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
        print(f"\n== {program}, load {load:.1f}", flush=True)
        done = subprocess.run([sys.executable, "-m", f"tools.{program}"], check=False)
        worst = max(worst, done.returncode)
    return worst


if __name__ == "__main__":
    sys.exit(main())
