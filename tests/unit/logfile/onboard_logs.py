"""Logs of autopilots, whole and in small: by vehicle-sim, and message by message."""

from __future__ import annotations

import struct
from functools import cache
from pathlib import Path
from typing import Any

from pymavlink.DFReader import DFReader_binary

from tests.unit.vehicle_logbook.flights import Flight, S
from vehicle_sim.autopilot.interface import StatusText
from vehicle_sim.autopilot.modes import Personality

GPS_UTC_US = 1_700_000_000_000_000


@cache
def vehicle_log(personality: Personality) -> bytes:
    """A flight log that `vehicle-sim` writes."""
    flight = Flight(personality)
    flight.fly(2 * S, StatusText(4, "Wind is high"))
    (log,) = flight.logs
    return log


def by_dfreader(path: Path, reader_of: Any = DFReader_binary) -> dict[str, list[Any]]:
    found: dict[str, list[Any]] = {}
    with reader_of(str(path)) as reader:
        while (message := reader.recv_msg()) is not None:
            found.setdefault(message.get_type(), []).append(message)
    return found


def as_text(path: Path) -> str:
    """A .BIN in the text form that ground stations convert it to: values with their multipliers,
    modes by name."""
    lines = []
    with DFReader_binary(str(path)) as reader:
        while (message := reader.recv_msg()) is not None:
            values = [getattr(message, name) for name in message.get_fieldnames()]
            letters = message.fmt.format
            shown = [
                f"MODE{value}" if letter == "M" else repr(value) if letter in "fdcCeEL" else value
                for letter, value in zip(letters, values, strict=True)
            ]
            lines.append(", ".join([message.get_type(), *map(str, shown)]))
    return "\n".join(lines) + "\n"


# ------------------------------------------------------------------------------- DataFlash


def fmt(kind: int, name: str, letters: str, columns: str, size: int | None = None) -> bytes:
    """A FMT message; its size is that of its letters."""
    sizes = {"Q": 8, "f": 4, "B": 1, "h": 2, "c": 2, "Z": 64}
    length = 3 + sum(sizes[each] for each in letters) if size is None else size
    texts = name.encode().ljust(4, b"\0"), letters.encode().ljust(16, b"\0")
    return b"\xa3\x95\x80" + struct.pack("<BB4s16s64s", kind, length, *texts, columns.encode())


def df(kind: int, layout: str, *values: object) -> bytes:
    return b"\xa3\x95" + bytes([kind]) + struct.pack("<" + layout, *values)


# ------------------------------------------------------------------------------------ ULog


def ulog(*messages: bytes, flags: bytes = bytes(16), appended: tuple[int, ...] = ()) -> bytes:
    """A ULog that began at 1 s."""
    offsets = struct.pack("<3Q", *(*appended, 0, 0, 0)[:3])
    head = b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 1_000_000)
    return head + m("B", flags + offsets) + b"".join(messages)


def m(kind: str, content: bytes | str) -> bytes:
    raw = content.encode() if isinstance(content, str) else content
    return struct.pack("<H", len(raw)) + kind.encode() + raw


def subscribe(number: int, topic: str, instance: int = 0) -> bytes:
    return m("A", struct.pack("<BH", instance, number) + topic.encode())


def data(number: int, layout: str, *values: object) -> bytes:
    return m("D", struct.pack("<H" + layout, number, *values))


def parameter(name: str, value: int) -> bytes:
    key = f"int32_t {name}".encode()
    return m("P", bytes([len(key)]) + key + struct.pack("<i", value))


SYNC = m("S", b"\x2f\x73\x13\x20\x25\x0c\xbb\x12")
