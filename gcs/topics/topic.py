"""What a topic is, and how the bytes of its messages become fields.

A MAVLink message of one component is a topic: `/mavlink/<system>/<component>/<NAME>`.  A record has
these and its own ones, such as `/vehicle/1/state`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, TypeAlias

import msgspec

from gcs.record import ros1
from gcs.record.log_line import read_log_line
from gcs.wire.fields import fields_of
from gcs.wire.frame import Frame, split

Value: TypeAlias = "int | float | str | bool | list[Value] | dict[str, Value] | None"
Fields: TypeAlias = "dict[str, Value]"
Decode: TypeAlias = Callable[[bytes], Fields]


MAX_DEPTH = 20
"""Of nested JSON."""


class DecodeError(Exception):
    """The bytes are no message of their topic."""


@dataclass(frozen=True, slots=True, eq=False)
class Topic:
    """One topic of one source."""

    name: str
    schema: str
    """The name of its type: "mavlink/ATTITUDE", "gate.Decision"."""
    decode: Decode
    """A message's bytes -> its fields.  Raises DecodeError."""
    schema_text: str = ""
    """The definition of its type, as the record has it."""

    @property
    def message(self) -> str:
        """The last part of its name: "ATTITUDE"."""
        return self.name.rpartition("/")[2]

    @property
    def is_mavlink(self) -> bool:
        return self.schema.startswith("mavlink/")


class Heard(NamedTuple):
    """One message, not decoded yet.  `time_ns`: nanoseconds since the Unix epoch."""

    topic: Topic
    time_ns: int
    data: bytes

    def fields(self) -> Fields:
        """Raises DecodeError."""
        return self.topic.decode(self.data)

    @property
    def direction(self) -> int | None:
        """The `Direction` of a frame in a record; None of what was just heard, or is no frame."""
        is_frame = self.topic.is_mavlink and self.topic.decode is not frame_fields
        return self.data[1] if is_frame and len(self.data) >= ros1.FRAME_BYTES else None


def live_topic(frame: Frame) -> Topic:
    """The topic of a frame that was just received; its messages are whole frames."""
    name = f"/mavlink/{frame.sysid}/{frame.compid}/{frame.name}"
    return Topic(name, f"mavlink/{frame.name}", frame_fields)


def recorded_topic(
    name: str, schema: str, encoding: str, metadata: dict[str, str], schema_text: bytes
) -> Topic:
    """The topic of a channel of an MCAP."""
    text = schema_text.decode("utf-8", "replace")
    return Topic(name, schema, _decoder(name, schema, encoding, metadata), text)


def frame_fields(raw: bytes) -> Fields:
    """The fields of one whole frame.  Raises DecodeError."""
    items = split(raw)
    if len(items) != 1 or not isinstance(items[0], Frame):
        raise DecodeError("the bytes are no frame")
    frame = items[0]
    if not frame.known:
        return {"payload": frame.payload.hex(" ")}
    return {name: _plain(value) for name, value in fields_of(frame).items()}


def _plain(value: int | float | str | list[int | float | str] | None) -> Value:
    return [*value] if isinstance(value, list) else value


def _decoder(name: str, schema: str, encoding: str, metadata: dict[str, str]) -> Decode:
    if encoding == "json":
        return _json_fields
    if encoding == "ros1" and schema == "mavlink/Garbage":
        return _garbage_fields
    if schema == "foxglove.Log":
        return _log_fields
    length = metadata.get(ros1.PAYLOAD_LENGTH_KEY, "")
    is_frame = encoding == "ros1" and schema.startswith("mavlink/")
    if is_frame and length.isdecimal() and len(length) <= 3:
        codec = ros1.codec(min(int(length), 255))

        def decode(data: bytes) -> Fields:
            if len(data) < ros1.FRAME_BYTES:
                raise DecodeError("the message is too short")
            return frame_fields(codec.rebuild(data))

        return decode

    def undecoded(_data: bytes) -> Fields:
        raise DecodeError(f"{name}: messages of the encoding {encoding!r} are not decoded here")

    return undecoded


def _log_fields(data: bytes) -> Fields:
    line = read_log_line(data)
    if line is None:
        raise DecodeError("no foxglove.Log")
    return dict(zip(("level", "node", "text"), line, strict=True))


def _json_fields(data: bytes) -> Fields:
    try:
        fields = _json.decode(data)
    except (msgspec.DecodeError, RecursionError) as error:
        raise DecodeError(f"no JSON object: {error}") from error
    if _is_deeper(fields, MAX_DEPTH):
        raise DecodeError(f"JSON nested more than {MAX_DEPTH} deep")
    return fields


def _is_deeper(value: Value, most: int) -> bool:
    """Whether it is nested deeper than so; no recorder of ours writes such a thing."""
    if isinstance(value, dict):
        return most == 0 or any(_is_deeper(each, most - 1) for each in value.values())
    if isinstance(value, list):
        return most == 0 or any(_is_deeper(each, most - 1) for each in value)
    return False


_json: msgspec.json.Decoder[Fields] = msgspec.json.Decoder(dict)


def _garbage_fields(data: bytes) -> Fields:
    length = int.from_bytes(data[:4], "little")
    reason = data[4 : 4 + length].decode("utf-8", "replace")
    return {"reason": reason, "data": data[8 + length :].hex(" ")}
