"""Decoding and encoding against pymavlink on the same messages, paired in one run.

    python -m tools.bench_wire [rounds]

Each round times both sides one after the other; the figure is the median of the rounds' ratios.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable
from typing import NamedTuple

from pymavlink.dialects.v20 import all as pymavlink_dialect

from gcs.wire.codec import FrameWriter, decode
from gcs.wire.frame import Frame, split
from gcs.wire.messages import Attitude, GlobalPositionInt, Heartbeat, LocalPositionNed, Message

CALLS = 4_000

TRAFFIC: tuple[Message, ...] = (
    LocalPositionNed(time_boot_ms=123_456, x=1.5, y=-2.5, z=-10.0, vx=0.1, vy=0.2, vz=0.3),
    Attitude(
        time_boot_ms=123_456,
        roll=0.01,
        pitch=-0.02,
        yaw=1.5,
        rollspeed=0.1,
        pitchspeed=0.2,
        yawspeed=0.3,
    ),
    GlobalPositionInt(
        time_boot_ms=123_456,
        lat=473_977_420,
        lon=85_455_940,
        alt=498_000,
        relative_alt=10_000,
        vx=10,
        vy=20,
        vz=30,
        hdg=9_000,
    ),
    Heartbeat(custom_mode=393_216, type=2, autopilot=12, base_mode=209, system_status=4),
)


class Pair(NamedTuple):
    name: str
    ours: Callable[[], object]
    theirs: Callable[[], object]


def pairs() -> list[Pair]:
    writer = FrameWriter(1, 1)
    raws = [writer.write(message) for message in TRAFFIC]
    parser = pymavlink_dialect.MAVLink(None)
    parser.robust_parsing = True
    sender = pymavlink_dialect.MAVLink(None, srcSystem=1, srcComponent=1)
    twins = [parser.decode(bytearray(raw)) for raw in raws]

    def receive_ours() -> None:
        for raw in raws:
            (item,) = split(raw)
            assert isinstance(item, Frame)
            decode(item)

    def receive_theirs() -> None:
        for raw in raws:
            parser.parse_buffer(raw)

    def send_ours() -> None:
        for message in TRAFFIC:
            writer.write(message)

    def send_theirs() -> None:
        for twin in twins:
            twin.pack(sender)

    def split_ours() -> None:
        for raw in raws:
            split(raw)

    return [
        Pair("bytes to message", receive_ours, receive_theirs),
        Pair("bytes to frame (CRC checked)", split_ours, receive_theirs),
        Pair("message to bytes", send_ours, send_theirs),
    ]


def microseconds(work: Callable[[], object]) -> float:
    """Of one message."""
    start_ns = time.perf_counter_ns()
    for _ in range(CALLS):
        work()
    return (time.perf_counter_ns() - start_ns) / 1e3 / CALLS / len(TRAFFIC)


def main(rounds: int) -> None:
    for pair in pairs():
        timed = [(microseconds(pair.ours), microseconds(pair.theirs)) for _ in range(rounds)]
        ours = statistics.median(ours for ours, _ in timed)
        theirs = statistics.median(theirs for _, theirs in timed)
        ratio = statistics.median(theirs / ours for ours, theirs in timed)
        print(f"{pair.name:30} {ours:6.2f} us, pymavlink {theirs:6.2f} us: {ratio:5.1f}x")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 9)
