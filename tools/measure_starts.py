"""How long programs take from their start: help, the vehicle's first heartbeat, the demo.

Run: python -m tools.measure_starts [--demo]
"""

from __future__ import annotations

import os
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from gcs.wire.frame import Frame, split
from gcs.wire.ids import MsgId
from tests.system.programs import GCS

ROUNDS = 5
VEHICLE_SIM = str(Path(sys.executable).with_name("vehicle-sim"))


def whole_ms(*command: str) -> float:
    began_ns = time.perf_counter_ns()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    return (time.perf_counter_ns() - began_ns) / 1e6


def first_heartbeat_ms() -> float:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as station:
        station.bind(("127.0.0.1", 0))
        station.settimeout(10.0)
        url = f"udpout://127.0.0.1:{station.getsockname()[1]}"
        began_ns = time.perf_counter_ns()
        vehicle = subprocess.Popen([VEHICLE_SIM, "--link", url], stdout=subprocess.DEVNULL)
        try:
            while not any(is_heartbeat(item) for item in split(station.recv(65_536))):
                pass
            return (time.perf_counter_ns() - began_ns) / 1e6
        finally:
            vehicle.terminate()
            vehicle.wait()


def is_heartbeat(item: object) -> bool:
    return isinstance(item, Frame) and item.msgid == MsgId.HEARTBEAT


def demo() -> None:
    with tempfile.TemporaryDirectory() as folder:
        began_s = time.perf_counter()
        ended = subprocess.run(
            [GCS, "demo", "--log-dir", folder], stdout=subprocess.DEVNULL, check=False
        )
        took_s = time.perf_counter() - began_s
    print(f"gcs demo: exit {ended.returncode} after {took_s:.1f} s, load {os.getloadavg()[0]:.2f}")


def main() -> None:
    commands = {
        "python -c pass": (sys.executable, "-c", "pass"),
        "gcs --help": (GCS, "--help"),
        "gcs fly --help": (GCS, "fly", "--help"),
    }
    spent: dict[str, list[float]] = {name: [] for name in commands}
    for command in commands.values():
        whole_ms(*command)
    for _ in range(ROUNDS):
        for name, command in commands.items():
            spent[name].append(whole_ms(*command))
    bare = spent["python -c pass"]
    for name, each in spent.items():
        print(
            f"{name:16} best of {ROUNDS} {min(each):.1f} ms (+{min(each) - min(bare):.1f}), "
            f"median {statistics.median(each):.1f} "
            f"(+{statistics.median(each) - statistics.median(bare):.1f})"
        )
    beats = [first_heartbeat_ms() for _ in range(ROUNDS)]
    print(
        f"first heartbeat of vehicle-sim: best of {ROUNDS} {min(beats):.0f} ms, "
        f"median {statistics.median(beats):.0f}, worst {max(beats):.0f}"
    )
    print(f"load {os.getloadavg()[0]:.2f}")
    if "--demo" in sys.argv[1:]:
        demo()


if __name__ == "__main__":
    main()
