"""Viewers that do everything wrong at a live view's port, many at once.

Run as a program: `python -m tests.system.hostile_viewers PORT COUNT SEED`.  It ends when all have
had their turn, and prints how many there were of each kind.
"""

from __future__ import annotations

import collections
import json
import random
import select
import socket
import struct
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, field

MODULE = "tests.system.hostile_viewers"
AT_ONCE = 100
LONGEST_S = 3.0
PIECE_BYTES = 65_536
HANDSHAKE = (
    b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    b"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
    b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Protocol: foxglove.sdk.v1\r\n\r\n"
)
MORE, TEXT, BINARY, PING = 0, 1, 2, 9
FINAL = 0x80
LARGEST = (16 << 20) - 100


def _frame(opcode: int, data: bytes) -> bytes:
    """A WebSocket frame of a client (RFC 6455, 5.2), masked with noughts."""
    size = len(data)
    if size < 126:
        header = bytes([0x80 | opcode, 0x80 | size])
    elif size < 65_536:
        header = bytes([0x80 | opcode, 0x80 | 126]) + struct.pack(">H", size)
    else:
        header = bytes([0x80 | opcode, 0x80 | 127]) + struct.pack(">Q", size)
    return header + bytes(4) + data


def _json(message: dict[str, object]) -> bytes:
    return _frame(TEXT, json.dumps(message).encode())


def _advertise() -> bytes:
    channel = {"id": 7, "topic": "/clicked_point", "encoding": "json"}
    channels = [{**channel, "schemaName": "geometry_msgs/PointStamped"}]
    return _json({"op": "advertise", "channels": channels})


def subscribe_to_all() -> bytes:
    wanted = [{"id": number, "channelId": number} for number in range(1, 80)]
    return _json({"op": "subscribe", "subscriptions": wanted})


def _call(service: int, payload: bytes = b"{}") -> bytes:
    return _frame(BINARY, struct.pack("<BIII", 2, service, 1, 4) + b"json" + payload)


def _garbage(rng: random.Random) -> bytes:
    return rng.randbytes(rng.randint(1, 200_000))


def _garbage_after_the_handshake(rng: random.Random) -> bytes:
    return HANDSHAKE + rng.randbytes(rng.randint(1, 100_000))


def _clicks(rng: random.Random) -> bytes:
    click = b'{"header":{"frame_id":"map"},"point":{"x":1,"y":2,"z":3}}'
    return HANDSHAKE + _advertise() + _frame(BINARY, struct.pack("<BI", 1, 7) + click) * 3_000


def _calls(rng: random.Random) -> bytes:
    calls = (_call(rng.randint(1, 12), b'{"code":"abcd1234"}') for _ in range(1_000))
    return HANDSHAKE + subscribe_to_all() + b"".join(calls)


def _largest_message(rng: random.Random) -> bytes:
    return HANDSHAKE + _advertise() + _frame(BINARY, struct.pack("<BI", 1, 7) + bytes(LARGEST))


def _half_a_message(rng: random.Random) -> bytes:
    return _largest_message(rng)[: -rng.randint(1, 10_000)]


def _never_reads(rng: random.Random) -> bytes:
    return HANDSHAKE + subscribe_to_all()


def _subscribes_again_and_again(rng: random.Random) -> bytes:
    ids = list(range(1, 80))
    again = (subscribe_to_all() + _json({"op": "unsubscribe", "subscriptionIds": ids})) * 100
    return HANDSHAKE + again


def _topics(rng: random.Random) -> bytes:
    schema = "geometry_msgs/PointStamped"
    channels = [
        {"id": number, "topic": f"/{number}", "encoding": "json", "schemaName": schema}
        for number in range(3_000)
    ]
    return HANDSHAKE + _json({"op": "advertise", "channels": channels})


def _foreign_page(rng: random.Random) -> bytes:
    page = HANDSHAKE.replace(b"\r\n\r\n", b"\r\nOrigin: https://evil.example\r\n\r\n")
    return page + rng.choice([_calls, _garbage])(rng)


def _smallest_frames(rng: random.Random) -> bytes:
    return HANDSHAKE + _frame(rng.choice([TEXT, PING]), b"") * 100_000


def _a_message_without_end(rng: random.Random) -> bytes:
    part = bytearray(_frame(MORE, b""))
    part[0] &= ~FINAL
    first = bytearray(_frame(TEXT, b"{"))
    first[0] &= ~FINAL
    return HANDSHAKE + bytes(first) + bytes(part) * 100_000


def _headers_without_end(rng: random.Random) -> bytes:
    return HANDSHAKE[:-2] + b"X-More: %d\r\n" % rng.randint(1, 9) * 100_000


def _silent(rng: random.Random) -> bytes:
    return b""


KINDS: tuple[Callable[[random.Random], bytes], ...] = (
    _garbage,
    _garbage_after_the_handshake,
    _clicks,
    _calls,
    _largest_message,
    _half_a_message,
    _never_reads,
    _subscribes_again_and_again,
    _topics,
    _foreign_page,
    _smallest_frames,
    _a_message_without_end,
    _headers_without_end,
    _silent,
)


@dataclass
class Hostile:
    """One of them; it never reads."""

    sock: socket.socket
    left: memoryview
    ends_s: float


@dataclass
class Crowd:
    port: int
    rng: random.Random
    there: list[Hostile] = field(default_factory=list)
    counts: collections.Counter[str] = field(default_factory=collections.Counter)

    def come(self) -> None:
        """One more."""
        sock = socket.create_connection(("127.0.0.1", self.port))
        sock.setblocking(False)
        kind = self.rng.choice(KINDS)
        self.counts[kind.__name__.strip("_")] += 1
        ends_s = time.monotonic() + self.rng.uniform(0.0, LONGEST_S)
        self.there.append(Hostile(sock, memoryview(kind(self.rng)), ends_s))

    def turn(self) -> None:
        """Everybody sends what goes; whose time is over goes without a word."""
        sending = {each.sock: each for each in self.there if each.left}
        _, writable, _ = select.select([], [*sending], [], 0.02)
        for sock in writable:
            each = sending[sock]
            try:
                each.left = each.left[sock.send(each.left[:PIECE_BYTES]) :]
            except OSError:
                each.left = memoryview(b"")
        now_s = time.monotonic()
        for each in self.there:
            if each.ends_s < now_s:
                each.sock.close()
        self.there = [each for each in self.there if each.ends_s >= now_s]


def main(port: int, count: int, seed: int) -> None:
    crowd = Crowd(port, random.Random(seed))
    while crowd.counts.total() < count or crowd.there:
        if len(crowd.there) < AT_ONCE and crowd.counts.total() < count:
            crowd.come()
        crowd.turn()
    print(json.dumps(crowd.counts))


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3]))
