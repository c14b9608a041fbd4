"""The highest factor that one vehicle's time reaches with no client attached.

Run: python -m tests.bench.measure_highest [--seconds 15]

The vehicle is asked for the most that `--speedup` takes.  What it reaches depends on the core
that it gets; what it would reach with a core to itself is told by its CPU time.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
import time

from vehicle_sim.options import SPEEDUP_MAX

NOBODY = "udpin://127.0.0.1:0"
LIVED = re.compile(r"([\d.]+) simulated seconds, ([\d.]+) times real time")


def measure(personality: str, seconds: float) -> str:
    before = os.times()
    asked = ["--autopilot", personality, "--speedup", str(SPEEDUP_MAX)]
    process = subprocess.Popen(
        [sys.executable, "-m", "vehicle_sim", "--lifeline", *asked, "--link", NOBODY],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdin is not None
    assert process.stdout is not None
    time.sleep(seconds)
    process.stdin.close()
    said = process.stdout.read()
    process.stdout.close()
    process.wait(10.0)
    after = os.times()
    cpu_s = after.children_user + after.children_system
    cpu_s -= before.children_user + before.children_system
    found = LIVED.search(said)
    if found is None:
        return f"{personality}: it did not say how fast it was:\n{said}"
    lived_s, reached = float(found[1]), float(found[2])
    return f"{personality}: {reached:.0f} times real time, {lived_s / cpu_s:.0f} by its CPU time"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=15.0)
    asked = parser.parse_args()
    print(f"asked for {SPEEDUP_MAX}, at rest on the ground, no client")
    for personality in ("px4", "ardupilot"):
        print(measure(personality, asked.seconds), f"(load {os.getloadavg()[0]:.1f})", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
