"""kill -9 of the link in mid-recording, 20 times: what is lost, by a listener on the wire.

Run: python -m tests.bench.measure_kills
"""

from __future__ import annotations

import os
import random
import tempfile
from pathlib import Path

from tests.system.killed_station import Loss, kill_and_recover

KILLS = 20


def main() -> None:
    rng = random.Random(1)
    losses: list[Loss] = []
    for _ in range(KILLS):
        with tempfile.TemporaryDirectory() as folder:
            losses.append(kill_and_recover(Path(folder), rng.uniform(0.8, 2.0)))
    received = sorted(loss.received_s for loss in losses)
    print(f"{KILLS} kills, every record recovered whole")
    print(f"received frames lost: median {received[KILLS // 2]:.2f} s, worst {received[-1]:.2f} s")
    print(f"sent frames lost: worst {max(loss.sent_s for loss in losses):.2f} s")
    print(f"load {os.getloadavg()[0]:.2f}")


if __name__ == "__main__":
    main()
