"""`gcs log check`: is the record whole, indexed, in order, and can all of it be decoded?"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

import msgspec

from gcs.mcap_file.format import Channel, Message, Schema
from gcs.mcap_file.index_check import wrong_with_index
from gcs.mcap_file.reader import Condition, Progress, Reading
from gcs.record import ros1

_Wrong: TypeAlias = Callable[[bytes], str]
"""What is wrong with a message; empty = nothing."""

_SCHEMA_OF = {"json": "jsonschema", "ros1": "ros1msg", "protobuf": "protobuf"}
_decode_json = msgspec.json.Decoder().decode

TOLD_A_KIND = 5
"""So many findings of a kind are told one by one; all are counted."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that is wrong.  `kind`: file, channel, message, order or index."""

    kind: str
    text: str


@dataclass(slots=True)
class CheckResult:
    """The whole answer; `msgspec.json.encode` makes `--json` of it."""

    path: str
    size: int
    messages: int = 0
    channels: int = 0
    seconds: float = 0.0
    not_decoded: int = 0
    """Messages of encodings that are not known here."""
    counts: dict[str, int] = field(default_factory=dict)
    """Findings by kind."""
    findings: list[Finding] = field(default_factory=list)

    @property
    def good(self) -> bool:
        return not self.counts

    def add(self, kind: str, text: str) -> None:
        """One more finding."""
        count = self.counts[kind] = self.counts.get(kind, 0) + 1
        if count <= TOLD_A_KIND:
            self.findings.append(Finding(kind, text))


def check(
    path: Path, progress: Progress | None = None, *, still_written: bool = False
) -> CheckResult:
    """Read the whole file, then what its index leads to.  One that is still written need not be
    closed.  Raises BadRecordError and OSError."""
    reading = Reading(path, progress)
    checking = _Checking(CheckResult(str(path), reading.condition.size))
    for record in reading:
        match record:
            case Message():
                checking.message(record)
            case Channel():
                checking.channel(record)
            case Schema():
                checking.schema(record)
            case _:
                pass
    return checking.finish(reading.condition, path, still_written)


class _Checking:
    def __init__(self, result: CheckResult) -> None:
        self._result = result
        self._schemas: dict[int, Schema] = {0: Schema(id=0, name="", encoding="", data=b"")}
        self._channels: dict[int, Channel] = {}
        self._checkers: dict[int, _Wrong | None] = {}
        self._counts: Counter[int] = Counter()
        self._first_ns: int | None = None
        self._last_ns = 0

    def schema(self, schema: Schema) -> None:
        known = self._schemas.setdefault(schema.id, schema)
        if known != schema:
            self._result.add("channel", f"schema {schema.id} is {known.name} and {schema.name}")

    def channel(self, channel: Channel) -> None:
        known = self._channels.get(channel.id)
        if known is not None:
            if known != channel:
                text = f"channel {channel.id} is {known.topic} and {channel.topic}"
                self._result.add("channel", text)
            return
        self._channels[channel.id] = channel
        self._checkers[channel.id] = _checker(channel)
        wrong = _wrong_with_channel(channel, self._schemas.get(channel.schema_id))
        if wrong:
            self._result.add("channel", f"{channel.topic}: {wrong}")

    def message(self, message: Message) -> None:
        result, at_ns = self._result, message.log_time_ns
        result.messages += 1
        if self._first_ns is None:
            self._first_ns = self._last_ns = at_ns
        if at_ns < self._last_ns:
            back_s = (self._last_ns - at_ns) / 1e9
            text = f"message {result.messages} is {back_s:.6f} s older than one before it"
            result.add("order", text)
        self._last_ns = max(self._last_ns, at_ns)
        self._counts[message.channel_id] += 1
        if message.channel_id not in self._channels:
            text = f"message {result.messages} has channel {message.channel_id}, which is unknown"
            result.add("message", text)
            return
        wrong = self._checkers[message.channel_id]
        if wrong is None:
            result.not_decoded += 1
            return
        said = wrong(message.data)
        if said:
            topic = self._channels[message.channel_id].topic
            result.add("message", f"message {result.messages}, {topic}: {said}")

    def finish(self, condition: Condition, path: Path, still_written: bool) -> CheckResult:
        result = self._result
        result.channels = len(self._channels)
        if self._first_ns is not None:
            result.seconds = (self._last_ns - self._first_ns) / 1e9
        if not condition.closed and not still_written:
            what = "its last chunk breaks off" if condition.broken_chunk else "its end is missing"
            result.add("file", f"it was not closed: {what}")
        if condition.damaged:
            result.add("file", f"{condition.damaged} records are damaged")
        if condition.closed:
            for wrong in wrong_with_index(path, self._counts):
                result.add("index", wrong)
        return result


# --------------------------------------------------- can a reader decode this message?


def _wrong_with_channel(channel: Channel, schema: Schema | None) -> str:
    """What keeps a viewer from reading the channel; empty = nothing."""
    if schema is None:
        return f"its schema {channel.schema_id} is not in the file"
    wanted = _SCHEMA_OF.get(channel.message_encoding)
    if wanted is not None and schema.id and schema.encoding != wanted:
        return f"its messages are {channel.message_encoding}, its schema is {schema.encoding!r}"
    if wanted in ("ros1msg", "protobuf") and not schema.data:
        return f"its messages are {channel.message_encoding}, and it has no schema"
    return ""


def _checker(channel: Channel) -> _Wrong | None:
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
