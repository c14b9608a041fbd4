"""The two ends of `bench_bridge`: a vehicle that sends at a steady rate, a client that counts.

    python -m tools.bridge_ends send PORT RATE SECONDS [FRAMES]
    python -m tools.bridge_ends receive listen PORT
    python -m tools.bridge_ends receive connect PORT

The vehicle prints one line of JSON at its end; the client one for each line that it reads, with
what came since the last, until its input ends.  The vehicle sends what a flying PX4 sends of the
messages that a ground station interprets (117 a second); the rest of the rate are messages that
only pass through.  SYSTEM_TIME, 20 times a second, carries the clock, so that the client sees the
latency.
"""

from __future__ import annotations

import json
import random
import select
import socket
import statistics
import struct
import sys
import time
from contextlib import suppress

from gcs.wire import messages as m
from gcs.wire.codec import FrameWriter, encode
from gcs.wire.dialect import MESSAGES, MESSAGES_BY_NAME
from gcs.wire.frame import Frame, split

OTHERS = (
    "HIGHRES_IMU",
    "SERVO_OUTPUT_RAW",
    "VFR_HUD",
    "ATTITUDE_QUATERNION",
    "RAW_IMU",
    "SCALED_PRESSURE",
    "RC_CHANNELS",
    "NAV_CONTROLLER_OUTPUT",
)
SYSTEM_TIME = MESSAGES_BY_NAME["SYSTEM_TIME"].msgid
CLOCK_HZ = 20
RING = 256
"""Sequence numbers: a pool of datagrams that is repeated holds a multiple of so many frames."""


def interpreted(hertz_now: int, boot_ms: int) -> list[m.Message]:
    """What is due in this 1/100 s of a second, of what a ground station interprets."""
    due: list[m.Message] = []
    if hertz_now == 0:
        due.append(m.Heartbeat(50593792, 2, 12, 81, 4, 3))
        due.append(m.ExtendedSysState(0, 1))
    if hertz_now % 2 == 0:
        due.append(m.Attitude(boot_ms, 0.01, 0.02, 0.5, 0.0, 0.0, 0.0))
    if hertz_now % 2 == 1:
        due.append(m.LocalPositionNed(boot_ms, 0.0, 0.0, -0.1, 0.0, 0.0, 0.0))
    if hertz_now % 10 == 3:
        due.append(m.GlobalPositionInt(boot_ms, 473977420, 85455940, 488000, 100, 0, 0, 0, 0))
    if hertz_now % 20 == 5:
        due.append(m.MissionCurrent(0))
    return due


def send(port: int, rate_hz: int, seconds: float, frames: int) -> None:
    """Datagrams of so many frames; late ones are made up for at once."""
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, 4 << 20)
    sock.connect(("127.0.0.1", port))
    sock.setblocking(False)
    dice = random.Random(1)
    payloads = [
        (MESSAGES_BY_NAME[name].msgid, dice.randbytes(MESSAGES_BY_NAME[name].max_len - 1) + b"\1")
        for name in OTHERS
    ]
    writer = FrameWriter(1, 1)
    pool = [
        b"".join(writer.write_payload(*payloads[n % len(payloads)]) for n in range(frames))
        for _ in range(RING)
    ]
    waiting: list[tuple[int, bytes]] = []
    every_s = frames / rate_hz
    begin = time.monotonic()
    sent = number = hundredth = clock_due = 0
    while (now := time.monotonic() - begin) < seconds:
        while hundredth <= now * 100:
            boot_ms = 1000 + hundredth * 10
            due = interpreted(hundredth % 100, boot_ms)
            waiting += [(message.MSG_ID, encode(message)) for message in due]
            hundredth += 1
        while number * every_s <= now:
            if clock_due <= now * CLOCK_HZ:
                waiting.append((SYSTEM_TIME, struct.pack("<QI", time.monotonic_ns(), 1)))
                clock_due += 1
            data = pool[number % RING]
            if waiting:
                writer.seq = number * frames % RING
                taken, waiting = waiting[:frames], waiting[frames:]
                rest = [payloads[n % len(payloads)] for n in range(len(taken), frames)]
                data = b"".join(writer.write_payload(*each) for each in [*taken, *rest])
            try:
                sock.send(data)
            except OSError:
                time.sleep(0.0002)
                continue
            sent += frames
            number += 1
        wait_s = number * every_s - (time.monotonic() - begin)
        if wait_s > 0.0002:
            time.sleep(min(wait_s, 0.01))
    print(json.dumps({"sent": sent, "seconds": time.monotonic() - begin}))


def receive(how: str, port: int) -> None:
    """Counts frames of 1/1; says HEARTBEAT once a second where it connects."""
    sock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 8 << 20)
    if how == "listen":
        sock.bind(("127.0.0.1", port))
    else:
        sock.connect(("127.0.0.1", port))
    sock.setblocking(False)
    writer = FrameWriter(255, 190)
    received = 0
    late_us: list[float] = []
    beat_s = time.monotonic()
    while True:
        if how == "connect" and (now := time.monotonic()) >= beat_s:
            beat_s = now + 1.0
            with suppress(ConnectionRefusedError):  # nobody listens there yet
                sock.send(writer.write(m.Heartbeat(0, 6, 8, 0, 4, 3)))
        readable = select.select([sock, sys.stdin], [], [], 0.05)[0]
        with suppress(BlockingIOError, ConnectionRefusedError):
            while sock in readable:
                received += _frames(sock.recv(65_536), late_us)
        if sys.stdin in readable:
            if not sys.stdin.readline():
                return
            print(json.dumps({"received": received, **_latency(late_us)}), flush=True)
            received = 0
            late_us.clear()


def _latency(late_us: list[float]) -> dict[str, float]:
    if not late_us:
        return {"p50_us": float("nan"), "p99_us": float("nan")}
    p99 = sorted(late_us)[int(len(late_us) * 0.99)]
    return {"p50_us": statistics.median(late_us), "p99_us": p99}


_CLOCK = bytes((SYSTEM_TIME & 0xFF, SYSTEM_TIME >> 8, 0))


def _frames(data: bytes, late_us: list[float]) -> int:
    """How many frames of the vehicle; walks from length to length, since it must be quick."""
    at = count = 0
    now_ns = time.monotonic_ns()
    while at + 12 <= len(data) and data[at] == 0xFD:
        count += data[at + 5] == 1
        if data[at + 7 : at + 10] == _CLOCK and data[at + 5] == 1:
            late_us.append((now_ns - int.from_bytes(data[at + 10 : at + 18], "little")) / 1e3)
        at += 12 + data[at + 1] + (13 if data[at + 2] & 1 else 0)
    return count


def check() -> None:
    """The pool is what it is meant to be: good frames, in turn."""
    writer = FrameWriter(1, 1)
    raw = writer.write_payload(SYSTEM_TIME, struct.pack("<QI", 1, 1))
    (item,) = split(raw)
    assert isinstance(item, Frame)
    assert set(OTHERS) <= {each.name for each in MESSAGES.values()}


if __name__ == "__main__":
    check()
    if sys.argv[1] == "send":
        _, _, port, rate_hz, seconds, *frames = sys.argv
        send(int(port), int(rate_hz), float(seconds), int(frames[0]) if frames else 8)
    else:
        receive(sys.argv[2], int(sys.argv[3]))
