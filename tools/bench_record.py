"""MCAP record of a frame: the recorder beside `mcap.Writer` on the same frames.

Run: python -m tools.bench_record

Six stretches of work over the same frames (a real mix of sizes), taken in turn so that a change
of load hits all alike; figures are medians over the rounds, both sides with lz4 and 256 KiB chunks:

  recorder          the whole path, as a link does it: datagrams of 8 frames -> messages -> MCAP
  without seals     the same without what a session's record can be checked by
  one by one        the whole path where each datagram has one frame
  encode + mcap     the same work by the peer: frame -> ros1 message -> mcap.Writer
  bare foxglove     foxglove-sdk alone, on messages that are already encoded
  bare mcap         mcap.Writer alone, on the same
"""

from __future__ import annotations

import random
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from pymavlink.dialects.v20 import all as dialect

from gcs.mcap_file.writer import (
    Backend,
    FoxgloveBackend,
    GuardedFile,
    Log,
    McapBackend,
    open_exclusive,
)
from gcs.record import ros1
from gcs.record.writer import Recorder
from gcs.report import Direction, FramesItem
from gcs.wire.frame import msgid_in

FRAMES = 60_000
DATAGRAM = 8
"""Frames in one, as vehicle-sim sends them at its usual rates."""
ROUNDS = 7
START_NS = 1_767_225_600_000_000_000


def frames() -> list[bytes]:
    """What a vehicle sends at its usual rates: position, attitude, heartbeat, status."""
    sender = dialect.MAVLink(None, srcSystem=1, srcComponent=1)
    rng = random.Random(1)
    raws = []
    for number in range(FRAMES):
        values = [rng.uniform(-50, 50) for _ in range(6)]
        match number % 8:
            case 0 | 1 | 2:
                message = sender.local_position_ned_encode(number, *values)
            case 3 | 4 | 5:
                message = sender.attitude_encode(number, *values)
            case 6:
                message = sender.global_position_int_encode(
                    number, 473977420, 85455940, 490_000, 2_000, 10, -20, 30, 9_000
                )
            case _:
                message = sender.heartbeat_encode(2, 12, 209, 0x60000, 4)
        raws.append(bytes(message.pack(sender)))
    return raws


def recorder_ns(raws: list[bytes], folder: Path, together: int, sealed: bool) -> int:
    """So many frames in a datagram; with the seals of a session's record, or without."""
    items = [
        FramesItem(0, Direction.RECEIVED, tuple(raws[start : start + together]))
        for start in range(0, len(raws), together)
    ]
    recorder = Recorder.open(folder, "bench", "20260101-000000", START_NS, sealed=sealed)
    now_ns = START_NS
    began = time.perf_counter_ns()
    for item in items:
        now_ns += 10_000 * together
        recorder.write(item, now_ns)
        if now_ns >= recorder.deadline_ns:
            recorder.tick(now_ns)
    assert recorder.close(now_ns)
    return time.perf_counter_ns() - began


def writer_ns(raws: list[bytes], folder: Path, backend: Backend, encoded: bool) -> int:
    """The same frames into a bare backend; `encoded` = encoding them is not part of the work."""
    backend.open(GuardedFile(open_exclusive(folder / "bare.mcap")))
    known: dict[int, tuple[Log, ros1.Encode]] = {}
    work: list[tuple[Log, ros1.Encode, bytes]] = []
    for raw in raws:
        msgid = msgid_in(raw)
        if msgid not in known:
            log = backend.channel(ros1.frame_channel(1, 1, msgid))
            known[msgid] = log, ros1.codec(ros1.full_length(msgid)).encode
        log, encode = known[msgid]
        work.append((log, encode, encode(raw, 0, 0) if encoded else raw))
    now_ns = START_NS
    began = time.perf_counter_ns()
    for log, encode, data in work:
        now_ns += 10_000
        log(data if encoded else encode(data, 0, 0), now_ns)
    backend.close()
    return time.perf_counter_ns() - began


def main() -> None:
    raws = frames()
    stretches: dict[str, Callable[[Path], int]] = {
        "recorder": lambda folder: recorder_ns(raws, folder, DATAGRAM, sealed=True),
        "without seals": lambda folder: recorder_ns(raws, folder, DATAGRAM, sealed=False),
        "one by one": lambda folder: recorder_ns(raws, folder, 1, sealed=True),
        "encode + mcap": lambda folder: writer_ns(raws, folder, McapBackend(), encoded=False),
        "bare foxglove": lambda folder: writer_ns(raws, folder, FoxgloveBackend(), encoded=True),
        "bare mcap": lambda folder: writer_ns(raws, folder, McapBackend(), encoded=True),
    }
    spent: dict[str, list[float]] = {name: [] for name in stretches}
    for _ in range(ROUNDS):
        for name, stretch in stretches.items():
            with tempfile.TemporaryDirectory() as folder:
                spent[name].append(stretch(Path(folder)) / 1000 / FRAMES)
    for name, each in spent.items():
        print(f"{name:14} {statistics.median(each):6.2f} us a frame")
    for ours, peer in (
        ("recorder", "without seals"),
        ("recorder", "encode + mcap"),
        ("one by one", "encode + mcap"),
        ("recorder", "bare mcap"),
        ("bare foxglove", "bare mcap"),
    ):
        pairs = zip(spent[peer], spent[ours], strict=True)
        ratio = statistics.median(theirs / mine for theirs, mine in pairs)
        print(f"{ours} is {ratio:.2f} x as fast as {peer}")


if __name__ == "__main__":
    main()
