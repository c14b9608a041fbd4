"""A recorded flight as the tests look at it: with the `mcap` package's own reader."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

from mcap.reader import make_reader
from mcap_ros1.decoder import DecoderFactory
from pymavlink.dialects.v20 import all as dialect

from gcs.record import ros1
from gcs.record.info import FlightInfo, read_info
from gcs.report import Direction

Json: TypeAlias = "dict[str, Json] | list[Json] | str | float | bool | None"

AUTO_LOITER = 4 << 16 | 3 << 24
"""custom_mode of px4's hold mode."""


@dataclass(frozen=True, slots=True)
class Recorded:
    """A frame, rebuilt from its message; `at_ns` is its log_time."""

    at_ns: int
    name: str
    direction: Direction
    raw: bytes


def frames(path: Path) -> list[Recorded]:
    """Every MAVLink frame of the file in the order of log_time, rebuilt."""
    found = []
    with path.open("rb") as file:
        for _, channel, message in make_reader(file).iter_messages():
            if channel.topic.startswith("/mavlink/"):
                raw = ros1.rebuild(message.data)
                direction = Direction(message.data[1])
                name = channel.topic.rsplit("/", 1)[-1]
                found.append(Recorded(message.log_time, name, direction, raw))
    return found


def wire(found: list[Recorded], direction: Direction) -> bytes:
    """What crossed the link in one direction, end to end."""
    return b"".join(frame.raw for frame in found if frame.direction is direction)


def times_ns(path: Path, name: str, direction: Direction = Direction.SENT) -> list[int]:
    """log_time of every frame of that name and direction."""
    kept = (f for f in frames(path) if f.name == name and f.direction is direction)
    return [frame.at_ns for frame in kept]


def decoded(path: Path) -> Iterator[tuple[str, Any]]:
    """Topic and message of every frame, through an independent ros1 decoder."""
    factory = DecoderFactory()
    with path.open("rb") as file:
        for schema, channel, message in make_reader(file).iter_messages():
            if channel.topic.startswith("/mavlink/"):
                decode = factory.decoder_for(channel.message_encoding, schema)
                assert decode is not None, f"{channel.topic} is not for a ros1 decoder"
                yield channel.topic, decode(message.data)


def readings(path: Path, topic: str) -> list[tuple[int, dict[str, Json]]]:
    """log_time and value of every message of a JSON topic."""
    with path.open("rb") as file:
        reader = make_reader(file)
        return [
            (message.log_time, json.loads(message.data))
            for _, _, message in reader.iter_messages(topics=[topic])
        ]


def modes(path: Path) -> list[int]:
    """custom_mode of the vehicle's heartbeats, as an independent decoder reads them."""
    parser = dialect.MAVLink(None)
    return [
        parser.parse_char(frame.raw).custom_mode
        for frame in frames(path)
        if frame.name == "HEARTBEAT" and frame.direction is Direction.RECEIVED
    ]


def whole(path: Path) -> FlightInfo:
    """What `gcs log info` finds; the file was finished by its writer and nothing in it is bad."""
    info = read_info(path)
    assert info.closed, f"{path} was not closed"
    assert info.damaged == 0
    return info


def only_log(folder: Path) -> Path:
    """The one record in a folder."""
    (path,) = folder.glob("*.mcap")
    return path


def assert_held(path: Path) -> None:
    """The record is whole, and it ends with a vehicle that was seen holding."""
    info = whole(path)
    assert info.states[-1].state == "HOLDING", info.states
    assert modes(path)[-1] == AUTO_LOITER
