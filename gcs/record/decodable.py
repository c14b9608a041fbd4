"""Can a reader decode this message?  Per channel, by its encoding; without a schema's fields."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import msgspec
from mcap.records import Channel, Schema

from gcs.record import ros1

Wrong: TypeAlias = Callable[[bytes], str]
"""What is wrong with a message; empty = nothing."""

_SCHEMA_OF = {"json": "jsonschema", "ros1": "ros1msg", "protobuf": "protobuf"}
_decode_json = msgspec.json.Decoder().decode


def wrong_with_channel(channel: Channel, schema: Schema | None) -> str:
    """What keeps a viewer from reading the channel; empty = nothing."""
    if schema is None:
        return f"its schema {channel.schema_id} is not in the file"
    wanted = _SCHEMA_OF.get(channel.message_encoding)
    if wanted is not None and schema.id and schema.encoding != wanted:
        return f"its messages are {channel.message_encoding}, its schema is {schema.encoding!r}"
    if wanted in ("ros1msg", "protobuf") and not schema.data:
        return f"its messages are {channel.message_encoding}, and it has no schema"
    return ""


def checker(channel: Channel) -> Wrong | None:
    """For the messages of the channel; None for what is not known here."""
    match channel.message_encoding:
        case "json":
            return _wrong_json
        case "protobuf":
            return _wrong_protobuf
        case "ros1" if ros1.PAYLOAD_LENGTH_KEY in channel.metadata:
            text = channel.metadata[ros1.PAYLOAD_LENGTH_KEY]
            if not text.isdecimal():
                return lambda _: f"the channel's payload length is {text!r}"
            tail_at = ros1.FRAME_BYTES + int(text)
            return lambda data: _wrong_frame(data, tail_at)
        case "ros1" if channel.topic.endswith("/garbage"):
            return _wrong_garbage
        case _:
            return None


def _wrong_json(data: bytes) -> str:
    try:
        _decode_json(data)
    except (msgspec.MsgspecError, RecursionError) as error:
        return f"no JSON: {error}"
    return ""


def _wrong_frame(data: bytes, tail_at: int) -> str:
    rest = int.from_bytes(data[tail_at : tail_at + 4], "little")
    if len(data) != tail_at + 4 + rest:
        return f"{len(data)} bytes, where its fields have {tail_at + 4 + rest}"
    return ""


def _wrong_garbage(data: bytes) -> str:
    at = 4 + int.from_bytes(data[:4], "little")
    if len(data) != at + 4 + int.from_bytes(data[at : at + 4], "little"):
        return "its length is not that of its fields"
    return ""


def _wrong_protobuf(data: bytes) -> str:
    """Whether its fields end where it ends."""
    at = 0
    while at < len(data):
        tag, at = _varint(data, at)
        match tag & 7:
            case _ if tag < 8:
                return "no protobuf: field 0"
            case 0:
                _, at = _varint(data, at)
            case 1:
                at += 8
            case 2:
                length, at = _varint(data, at)
                at += length
            case 5:
                at += 4
            case other:
                return f"no protobuf: wire type {other}"
    return "" if at == len(data) else "no protobuf: it breaks off"


def _varint(data: bytes, at: int) -> tuple[int, int]:
    """The number and where it ends; past the end of `data` where it breaks off."""
    value = shift = 0
    while at < len(data) and shift < 70:
        byte = data[at]
        value |= (byte & 0x7F) << shift
        at, shift = at + 1, shift + 7
        if byte < 0x80:
            return value, at
    return 8, len(data) + 1
