"""Makes .tlog files for tests with pymavlink, and reads them with pymavlink."""

from __future__ import annotations

import random
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pymavlink.dialects.v20 import all as dialect

START_US = 1_767_225_600_000_000
UNKNOWN_ID = 59_999


def stamped(frame: bytes, time_us: int = START_US) -> bytes:
    """A frame as it stands in a .tlog."""
    return struct.pack(">Q", time_us) + frame


def flight(count: int, *, mavlink1: bool = False, sysid: int = 1, seed: int = 1) -> list[bytes]:
    """Frames of one component: positions, attitudes, texts, parameters, and fields that are 0."""
    rng = random.Random(seed)
    sender = dialect.MAVLink(None, srcSystem=sysid, srcComponent=1)
    frames = []
    for number in range(count):
        values = [rng.uniform(-50, 50) for _ in range(6)]
        match number % 6:
            case 0:
                message: Any = sender.local_position_ned_encode(number, *values)
            case 1:
                message = sender.attitude_encode(number, *values[:3], 0.0, 0.0, 0.0)
            case 2:
                message = sender.statustext_encode(6, f"text {number}".encode())
            case 3:
                message = sender.param_value_encode(b"NAME", values[0], 9, 100, number)
            case 4:
                message = sender.heartbeat_encode(2, 12, 209, rng.randrange(1 << 32), 4)
            case _:
                message = sender.mission_current_encode(rng.choice((0, 5, 256)))
        frames.append(bytes(message.pack(sender, force_mavlink1=mavlink1)))
        sender.seq = (sender.seq + 1) & 0xFF
    return frames


def unknown(payload: bytes = b"hello", seq: int = 5) -> bytes:
    """A frame of a message that the dialect lacks: nobody here can tell its checksum."""
    header = bytes((0xFD, len(payload), 0, 0, seq, 1, 1)) + UNKNOWN_ID.to_bytes(3, "little")
    return header + payload + b"\x12\x34"


def write(path: Path, frames: list[bytes], step_us: int = 20_000) -> Path:
    """The frames, `step_us` apart."""
    path.write_bytes(b"".join(stamped(f, START_US + i * step_us) for i, f in enumerate(frames)))
    return path


def read_by_pymavlink(path: Path) -> Iterator[Any]:
    """Every message that pymavlink reads, in order; damaged bytes as BAD_DATA."""
    from pymavlink import mavutil

    log = mavutil.mavlogfile(str(path))
    while (message := log.recv_msg()) is not None:
        yield message
    log.close()
