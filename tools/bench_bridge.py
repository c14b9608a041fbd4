"""What it costs to have the gate between a vehicle and one client, beside MAVProxy as a forwarder.

    python -m tools.bench_bridge [--seconds 8] [--mavproxy PATH] [--highest]

One vehicle and one client, UDP on loopback, eight frames a datagram as vehicle-sim sends them.
`gcs bridge` is the real program: gate, record and all; its CPU is of all its processes.  MAVProxy
(`mavproxy.py` on the path, or `--mavproxy`; left out where there is none) forwards the same stream
with `--master` and `--out`; it records a .tlog.  Both are measured in one run, one after the other.
What the gate takes for a verdict is printed by `verdict_times`, in process.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import cast

WARM_S = 3.0
DRAIN_S = 1.0
"""After a stream: what stands in a queue still comes."""
SETTLE_S = 2.0
TRIES = 5
VERDICTS = (sys.executable, "-m", "tools.verdict_times")
LADDER = (60_000, 80_000, 100_000, 120_000, 150_000, 180_000, 220_000)


@dataclass(frozen=True, slots=True)
class Measured:
    """Of one program at one rate."""

    sent: int
    received: int
    cpu_us: float
    """A message that came through, of all its processes."""
    p50_us: float
    p99_us: float
    rate_hz: float

    @property
    def lost(self) -> int:
        return max(0, self.sent - self.received)


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sock:
        sock.bind(("127.0.0.1", 0))
        return int(sock.getsockname()[1])


def family(pid: int) -> list[int]:
    """The process and all that it has started."""
    found = [pid]
    for tasks in Path(f"/proc/{pid}/task").iterdir():
        for child in (tasks / "children").read_text().split():
            found += family(int(child))
    return found


def cpu_s(pids: list[int]) -> float:
    """Time on a CPU so far, of all threads; in ns, where `stat` has hundredths of a second."""
    total_ns = 0
    for pid in pids:
        for task in Path(f"/proc/{pid}/task").iterdir():
            total_ns += int((task / "schedstat").read_text().split()[0])
    return total_ns / 1e9


@contextmanager
def started(command: list[str], folder: str) -> Iterator[subprocess.Popen[bytes]]:
    process = subprocess.Popen(
        command,
        cwd=folder,
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": str(Path(__file__).parents[2])},
    )
    try:
        yield process
    finally:
        process.terminate()
        try:
            process.wait(20.0)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def end(*words: object) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "tools.bridge_ends", *map(str, words)]
    folder = Path(__file__).parents[2]
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd=folder)


def send(port: int, rate_hz: int, seconds: float) -> dict[str, float]:
    """The vehicle, from its beginning to its end."""
    return cast(
        "dict[str, float]", json.loads(end("send", port, rate_hz, seconds).communicate()[0])
    )


@contextmanager
def client_at(port: int, how: str) -> Iterator[Callable[[], dict[str, float]]]:
    """One client; what is called tells what it has received since the last call."""
    client = end("receive", how, port)
    assert client.stdin is not None
    assert client.stdout is not None
    given, told = client.stdin, client.stdout

    def heard() -> dict[str, float]:
        given.write(b"\n")
        given.flush()
        return cast("dict[str, float]", json.loads(told.readline()))

    try:
        yield heard
    finally:
        client.communicate()


def measure(program: str, rate_hz: int, seconds: float, mavproxy: str) -> Measured:
    vehicle, client = free_port(), free_port()
    with tempfile.TemporaryDirectory() as folder:
        if program == "gcs":
            command = [sys.executable, "-m", "gcs", "bridge", "--plain", "--log-dir", folder]
            command += ["--vehicle", f"udpin://127.0.0.1:{vehicle}"]
            command += ["--client", f"udpin://127.0.0.1:{client}"]
            how = "connect"
        else:
            command = [mavproxy, f"--master=udpin:127.0.0.1:{vehicle}", "--daemon"]
            command += [f"--out=udpout:127.0.0.1:{client}", "--streamrate=-1", "--state-basedir=."]
            command += ["--default-modules="]
            how = "listen"
        with started(command, folder) as process:
            time.sleep(SETTLE_S)
            return _stream(process, vehicle, client, how, rate_hz, seconds)


def _stream(
    process: subprocess.Popen[bytes],
    vehicle: int,
    client: int,
    how: str,
    rate_hz: int,
    seconds: float,
) -> Measured:
    """A short stream, so that the parameters and settings of the start are behind; then one that
    is measured.  One client hears both: one that has just gone would still be sent everything."""
    with client_at(client, how) as heard_since:
        for _ in range(TRIES):
            send(vehicle, 1000, WARM_S)
            time.sleep(DRAIN_S)
            if heard_since()["received"]:
                break
        else:
            raise SystemExit("nothing comes through: see what the program says when it is started")
        pids = family(process.pid)
        before_s = cpu_s(pids)
        said = send(vehicle, rate_hz, seconds)
        used_s = cpu_s(pids) - before_s
        time.sleep(DRAIN_S)
        heard = heard_since()
    return Measured(
        int(said["sent"]),
        int(heard["received"]),
        used_s / max(1, heard["received"]) * 1e6,
        heard["p50_us"],
        heard["p99_us"],
        said["sent"] / said["seconds"],
    )


def line(name: str, got: Measured) -> str:
    return (
        f"  {name:9} {got.rate_hz:8.0f}/s  {got.cpu_us:7.2f} us CPU a message  "
        f"lost {got.lost} of {got.sent}  latency p50 {got.p50_us:.0f} us, p99 {got.p99_us:.0f} us"
    )


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--seconds", type=float, default=8.0)
    parser.add_argument("--mavproxy", default=shutil.which("mavproxy.py") or "")
    parser.add_argument("--highest", action="store_true", help="look for the highest rate too")
    parser.add_argument("--no-verdicts", action="store_true", help="leave verdict_times out")
    asked = parser.parse_args()
    print(f"one vehicle, one client, 8 frames a datagram, load {os.getloadavg()[0]:.1f}")
    ours = measure("gcs", 1_000, asked.seconds, "")
    print(line("gcs", ours), flush=True)
    if asked.mavproxy:
        theirs = measure("mavproxy", 1_000, asked.seconds, asked.mavproxy)
        print(line("MAVProxy", theirs), flush=True)
        print(f"  ratio of CPU a message at 1000/s: 1/{theirs.cpu_us / ours.cpu_us:.1f}")
    else:
        print("  MAVProxy is not installed: no comparison")
    for rate_hz in (20_000, 100_000):
        print(line("gcs", measure("gcs", rate_hz, asked.seconds, "")), flush=True)
    if asked.highest:
        best = 0.0
        for rate_hz in LADDER:
            got = measure("gcs", rate_hz, asked.seconds, "")
            print(line("gcs", got), flush=True)
            if got.lost:
                break
            best = got.rate_hz
        print(f"  highest rate without loss: {best:.0f}/s")
    return 0 if asked.no_verdicts else subprocess.run(VERDICTS, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
