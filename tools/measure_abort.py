"""From an abort to its bytes on the wire: a key in a terminal, and a line into the station itself.

Run: python -m tools.measure_abort

50 times each: resume, wait a moment of random length, abort, and see when the hold command
passes an independent listener on the wire.
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from gcs import ipc
from gcs.operator.conversation import TrackedRequest
from tests.system.programs import GCS
from tests.system.second_program import Stopwatch
from tests.system.station import tapped
from tests.system.terminal import terminal
from tests.system.typed_flight import take_off
from tests.system.vehicle_program import free_port, vehicle_sim
from tests.system.wire_tap import WireTap

ABORTS = 50


def by_key(folder: str) -> list[float]:
    watch, port = Stopwatch(), free_port()
    found = []
    with WireTap(watch.hear) as tap:
        tap.connect(port)
        link = ("--link", f"udpin://127.0.0.1:{port}", "--log-dir", folder)
        with (
            vehicle_sim("--link", f"udpout://127.0.0.1:{tap.vehicle_port}"),
            terminal(GCS, "fly", *link) as screen,
        ):
            take_off(screen)
            for _ in range(ABORTS):
                found.append(watch.latency_ms(lambda: screen.press(" ")))
                screen.until_text("abort: complete")
                screen.press("e")
                screen.until_text("resume: complete")
            screen.press("\x03")
            screen.process.wait(10.0)
    return found


def by_line(folder: Path) -> list[float]:
    watch = Stopwatch()
    found = []
    with tapped(folder, tap=WireTap(watch.hear)) as (operator, _):
        operator.fly("arm", "takeoff 1.5")
        requests: list[TrackedRequest] = []

        def abort() -> None:
            requests.append(operator.dialogue.send(ipc.Ask(0, "abort")))

        for _ in range(ABORTS):
            found.append(watch.latency_ms(abort))
            operator.see_completed(requests[-1])
            operator.fly("resume")
        operator.leave()
    return found


def tell(name: str, found: list[float]) -> None:
    found.sort()
    print(
        f"{name:22} best {found[0]:.2f}, median {found[len(found) // 2]:.2f}, "
        f"p90 {found[len(found) * 9 // 10]:.2f}, worst of {len(found)} {found[-1]:.2f} ms"
    )


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        tell("key in a terminal", by_key(folder))
        print(f"load {os.getloadavg()[0]:.2f}")
    with tempfile.TemporaryDirectory() as folder:
        tell("line into the station", by_line(Path(folder)))
        print(f"load {os.getloadavg()[0]:.2f}")


if __name__ == "__main__":
    main()
