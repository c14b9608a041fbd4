"""Channels of Foxglove's own schemas, and its time stamps."""

from __future__ import annotations

from foxglove import Schema
from foxglove.messages import Timestamp

from gcs.mcap_file.writer import Channel


def channel(topic: str, schema: Schema) -> Channel:
    """A protobuf channel."""
    return Channel(topic, "protobuf", schema.name, schema.encoding, schema.data)


def stamp(now_ns: int) -> Timestamp:
    """Of log_time: ns since 1970."""
    seconds, nanoseconds = divmod(now_ns, 1_000_000_000)
    return Timestamp(seconds, nanoseconds)
