"""The setpoint stream of a whole flight at the keyboard, with the screen redrawn at 10 Hz.

Run: python -m tools.measure_stream

Real keys in a pty; intervals once from the record's log times, once from an listener on the wire.
"""

from __future__ import annotations

import os
import statistics
import tempfile
import time
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

from gcs.wire.frame import Frame, split
from gcs.wire.ids import MsgId
from tests.system.flight_log import only_log, times_ns, whole
from tests.system.programs import GCS
from tests.system.terminal import Terminal, terminal
from tests.system.typed_flight import take_off
from tests.system.vehicle_program import free_port, vehicle_sim
from tests.system.wire_tap import WireTap

FLIGHT_S = 70.0
LEG = 6
"""Metres, one step a key."""


def fly(screen: Terminal) -> None:
    """Up, then to and fro until the time is over, then down by Ctrl-C's hold."""
    take_off(screen)
    screen.press("r")
    end_s = time.monotonic() + FLIGHT_S
    east = 0
    while time.monotonic() < end_s:
        for _ in range(LEG):
            screen.press("a" if east else "d")
            time.sleep(0.1)
        east = LEG - east
        screen.press("\r")
        screen.until_text(f"goto {east} 0 1.5: complete")
    screen.press("\x03")
    screen.process.wait(10.0)


def tell(name: str, at_ns: Sequence[int]) -> None:
    intervals_ms = sorted((after - before) / 1e6 for before, after in pairwise(at_ns))
    mean_hz = (len(at_ns) - 1) * 1e9 / (at_ns[-1] - at_ns[0])
    p50, p99 = (intervals_ms[len(intervals_ms) * part // 100] for part in (50, 99))
    p1 = intervals_ms[len(intervals_ms) // 100]
    print(
        f"{name:12} {len(at_ns)} setpoints, mean {mean_hz:.3f} Hz; intervals ms: "
        f"p1 {p1:.2f}  p50 {p50:.2f}  p99 {p99:.2f}  worst {intervals_ms[-1]:.2f}  "
        f"deviation {statistics.pstdev(intervals_ms):.2f}"
    )


def main() -> None:
    port = free_port()
    with tempfile.TemporaryDirectory() as folder, WireTap() as tap:
        tap.connect(port)
        link = ("--link", f"udpin://127.0.0.1:{port}", "--log-dir", folder)
        with (
            vehicle_sim("--link", f"udpout://127.0.0.1:{tap.vehicle_port}"),
            terminal(GCS, "fly", *link) as screen,
        ):
            fly(screen)
            load = os.getloadavg()[0]
        path = only_log(Path(folder))
        tell("log time", times_ns(path, "SET_POSITION_TARGET_LOCAL_NED"))
        tell("on the wire", [c.at_ns for c in tap.to_vehicle if is_setpoint(c.data)])
        print(f"flight of {whole(path).seconds:.0f} s, {len(screen.seen) / 1e6:.1f} MB of screen")
    print(f"load {load:.2f}")


def is_setpoint(data: bytes) -> bool:
    """Of a datagram of ours, which is one frame."""
    (frame,) = split(data)
    return isinstance(frame, Frame) and frame.msgid == MsgId.SET_POSITION_TARGET_LOCAL_NED


if __name__ == "__main__":
    main()
