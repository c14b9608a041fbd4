"""Programs that do everything wrong at a station's socket, many at once.

Run as a program: `python -m tests.system.hostile_clients SOCKET COUNT SEED`.  It ends when all have
had their turn, and prints how many there were of each kind.
"""

from __future__ import annotations

import collections
import itertools
import json
import random
import select
import socket
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from gcs import ipc
from gcs.wire.frame import Frame, split
from gcs.wire.ids import MsgId
from tests.system.wire_tap import WireTap

MODULE = "tests.system.hostile_clients"
AT_ONCE = 24
LONGEST_S = 1.5
PIECE_BYTES = 65_536
JOIN = ipc.encode(ipc.Join("hostile"))
ALL = ["HEARTBEAT", "ATTITUDE", "LOCAL_POSITION_NED", "SYS_STATUS", "BATTERY_STATUS"]


def _garbage(rng: random.Random) -> bytes:
    return rng.randbytes(rng.randint(1, 200_000))


def _joined_garbage(rng: random.Random) -> bytes:
    return JOIN + b"\n".join(rng.randbytes(rng.randint(1, 300)) for _ in range(500))


def _flood(rng: random.Random) -> bytes:
    words = ("goto", "land!", "arm", "mission_upload", "photo", "resume", "mode", "station_end")
    asks = (ipc.Ask(n, rng.choice(words), path="/etc/passwd", mode="ACRO") for n in range(3_000))
    return JOIN + b"".join(map(ipc.encode, asks))


def _half_line(rng: random.Random) -> bytes:
    return JOIN + ipc.encode(ipc.Ask(1, "land"))[: rng.randint(1, 20)]


def _endless_line(rng: random.Random) -> bytes:
    return JOIN + b"x" * 400_000


def _deep(rng: random.Random) -> bytes:
    return JOIN + (b"[" * 16_000 + b"\n") * 20


def _never_reads(rng: random.Random) -> bytes:
    return JOIN + ipc.encode(ipc.Subscribe(ALL)) + ipc.encode(ipc.ListOperations(1)) * 40


def _silent(rng: random.Random) -> bytes:
    return b""


def _newlines(rng: random.Random) -> bytes:
    return JOIN + b"\n" * 100_000


def _wrong_types(rng: random.Random) -> bytes:
    return JOIN + b'{"type":"ask","id":"x","word":7}\n{"type":"leave","reason":[]}\n' * 50


KINDS: tuple[Callable[[random.Random], bytes], ...] = (
    _garbage,
    _joined_garbage,
    _flood,
    _half_line,
    _endless_line,
    _deep,
    _never_reads,
    _silent,
    _newlines,
    _wrong_types,
)


@dataclass
class Hostile:
    """One of them; it never reads."""

    sock: socket.socket
    left: bytes
    ends_s: float


@dataclass
class Crowd:
    path: str
    rng: random.Random
    there: list[Hostile] = field(default_factory=list)
    counts: collections.Counter[str] = field(default_factory=collections.Counter)

    def come(self) -> None:
        """One more, if the station takes connections at this moment."""
        sock = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        sock.setblocking(False)
        try:
            sock.connect(self.path)
        except BlockingIOError:  # the backlog is full
            sock.close()
            return
        kind = self.rng.choice(KINDS)
        self.counts[kind.__name__.strip("_")] += 1
        ends_s = time.monotonic() + self.rng.uniform(0.0, LONGEST_S)
        self.there.append(Hostile(sock, kind(self.rng), ends_s))

    def turn(self) -> None:
        """Everybody sends what goes; whose time is over goes without a word."""
        sending = [each for each in self.there if each.left]
        socks = {each.sock: each for each in sending}
        _, writable, _ = select.select([], [*socks], [], 0.02)
        for sock in writable:
            each = socks[sock]
            try:
                each.left = each.left[sock.send(each.left[:PIECE_BYTES]) :]
            except OSError:
                each.left = b""
        now_s = time.monotonic()
        for each in self.there:
            if each.ends_s < now_s:
                each.sock.close()
        self.there = [each for each in self.there if each.ends_s >= now_s]


def intervals_ms(tap: WireTap, begin_ns: int, end_ns: int) -> list[float]:
    """Between the setpoints that passed in that time, sorted."""
    passed = [c for c in list(tap.to_vehicle) if begin_ns <= c.at_ns <= end_ns]
    at_ns = [crossing.at_ns for crossing in passed if _is_setpoint(crossing.data)]
    return sorted((after - before) / 1e6 for before, after in itertools.pairwise(at_ns))


def setpoints_between(tap: WireTap, begin_ns: int, end_ns: int) -> int:
    """How many went out in that time: the ticks of the station, as quick as the machine is."""
    passed = [c for c in list(tap.to_vehicle) if begin_ns <= c.at_ns <= end_ns]
    return sum(_is_setpoint(crossing.data) for crossing in passed)


def _is_setpoint(data: bytes) -> bool:
    """Of a datagram of ours, which is one frame."""
    (frame,) = split(data)
    return isinstance(frame, Frame) and frame.msgid == MsgId.SET_POSITION_TARGET_LOCAL_NED


def resident_kb(pid: int) -> int:
    """Memory of a process; Linux only."""
    status = Path(f"/proc/{pid}/status").read_text()
    return int(status.partition("VmRSS:")[2].split()[0])


def main(path: str, count: int, seed: int) -> None:
    crowd = Crowd(path, random.Random(seed))
    while crowd.counts.total() < count or crowd.there:
        if len(crowd.there) < AT_ONCE and crowd.counts.total() < count:
            crowd.come()
        crowd.turn()
    print(json.dumps(crowd.counts))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]))
