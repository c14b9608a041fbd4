"""kill -9 of a station that records 100 and 2,000 messages a second: what is lost, 20 times.

Run: python -m tools.measure_kills [RERUN]
RERUN is the path of rerun-sdk's program, whose `mcap check` then looks at each recovered file.
"""

from __future__ import annotations

import random
import socket
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from gcs.config import StationConfig, encode
from gcs.record import ros1
from gcs.record.check import check
from gcs.record.recover import recover
from tests.unit.record.flights import messages_of, position_frame

KILLS = 20
RATES_HZ = (100, 2000)
BURST_S = 0.005
FIRST_NUMBER = 4


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def lost_s(folder: Path, rate_hz: int, seconds: float, rerun: str) -> float:
    """Since the first frame that is not in the recovered record was sent."""
    port = free_port()
    config = StationConfig(
        endpoints=[f"udpin://127.0.0.1:{port}"], log_dir=str(folder), connect_timeout_s=60.0
    )
    command = [sys.executable, "-m", "gcs.shell.station", encode(config)]
    quiet = subprocess.DEVNULL
    with (
        subprocess.Popen(command, stdin=subprocess.PIPE, stdout=quiet, stderr=quiet) as process,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender,
    ):
        while not list(folder.glob("*.mcap")):
            time.sleep(0.01)
        sender.connect(("127.0.0.1", port))
        sent_ns = send(sender, rate_hz, seconds)
        process.kill()
        killed_ns = time.monotonic_ns()
        process.wait()
    (broken,) = folder.glob("*.mcap")
    saved = folder / "saved.mcap"
    recover(broken, saved)
    assert check(saved).good, check(saved).findings
    if rerun:
        subprocess.run([rerun, "mcap", "check", str(saved)], check=True, capture_output=True)
    frames = [
        ros1.rebuild(message.data)
        for message in messages_of(saved)
        if message.topic == "/mavlink/1/1/LOCAL_POSITION_NED"
    ]
    last = int(struct.unpack_from("<I", frames[-1], 10)[0])
    assert len(frames) == last + 1 - FIRST_NUMBER
    return (killed_ns - sent_ns[last + 1 - FIRST_NUMBER]) / 1e9


def send(sender: socket.socket, rate_hz: int, seconds: float) -> list[int]:
    """When each frame was sent; the last one is not, it only tells when it would have been."""
    sent_ns: list[int] = []
    begun = time.monotonic()
    while (elapsed_s := time.monotonic() - begun) < seconds:
        while len(sent_ns) < elapsed_s * rate_hz:
            sender.send(position_frame(len(sent_ns) + FIRST_NUMBER).raw)
            sent_ns.append(time.monotonic_ns())
        time.sleep(BURST_S)
    return [*sent_ns, time.monotonic_ns()]


def main() -> None:
    rng = random.Random(1)
    rerun = sys.argv[1] if sys.argv[1:] else ""
    for rate_hz in RATES_HZ:
        losses = []
        for _ in range(KILLS):
            with tempfile.TemporaryDirectory() as name:
                losses.append(lost_s(Path(name), rate_hz, rng.uniform(1.5, 3.5), rerun))
        losses.sort()
        print(
            f"{rate_hz} messages/s: {KILLS} kills, every record recovered and checked; "
            f"lost: median {losses[KILLS // 2]:.2f} s, worst {losses[-1]:.2f} s",
            flush=True,
        )


if __name__ == "__main__":
    main()
