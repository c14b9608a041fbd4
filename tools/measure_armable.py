"""How long a user of MAVSDK waits: from the start of `vehicle-sim` to heard, and to armable.

Run: python -m tools.measure_armable [--rounds 5]
MAVSDK is there first and waits, at speed 1; armable is all of its health flags.
"""

from __future__ import annotations

import argparse
import os
import statistics
import sys
import time

from tests.clients.client_script import CLIENTS, end, start
from tests.system.vehicle_program import free_port, vehicle_sim

CLIENT = "mavsdk"


def waited_s() -> tuple[float, float]:
    """From the start to the first heartbeat that MAVSDK noticed, and to armable."""
    place = f"127.0.0.1:{free_port()}"
    script = start(CLIENT, "mavsdk_start.py", f"udpin://{place}")
    assert script.stdout is not None
    try:
        script.stdout.readline()
        began_ns = time.time_ns()
        with vehicle_sim("--link", f"udpout://{place}"):
            rest, _ = script.communicate(timeout=30.0)
    finally:
        end(script)
    times = {event: int(at_ns) for event, at_ns in map(str.split, rest.splitlines())}
    return (times["heard"] - began_ns) * 1e-9, (times["armable"] - began_ns) * 1e-9


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=5)
    rounds = parser.parse_args().rounds
    if not (CLIENTS / CLIENT / "bin" / "python").exists():
        print("MAVSDK's environment is not there: make .clients/mavsdk/.installed")
        return 0
    both = [waited_s() for _ in range(rounds)]
    for name, each in zip(("heard", "armable"), zip(*both, strict=True), strict=True):
        print(
            f"vehicle-sim {name} by MAVSDK: best of {rounds} {min(each):.2f} s, "
            f"median {statistics.median(each):.2f}, worst {max(each):.2f}, "
            f"load {os.getloadavg()[0]:.2f}"
        )
    return 0


if __name__ == "__main__":
    sys.exit(main())
