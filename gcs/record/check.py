"""`gcs log check`: is the record whole, indexed, in order, and can all of it be decoded?"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from mcap.records import Channel, Schema

from gcs.record.decodable import Wrong, checker, wrong_with_channel
from gcs.record.index_check import wrong_with_index
from gcs.record.reading import Condition, Message, Reading

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


def check(path: Path, progress: Callable[[Condition], None] | None = None) -> CheckResult:
    """Read the whole file, then what its index leads to.  Raises BadRecordError and OSError."""
    reading = Reading(path)
    checking = _Checking(CheckResult(str(path), reading.condition.size))
    for number, record in enumerate(reading):
        match record:
            case Message():
                checking.message(record)
            case Channel():
                checking.channel(record)
            case Schema():
                checking.schema(record)
            case _:
                pass
        if progress is not None and number % 4096 == 0:
            progress(reading.condition)
    return checking.finish(reading.condition, path)


class _Checking:
    def __init__(self, result: CheckResult) -> None:
        self._result = result
        self._schemas: dict[int, Schema] = {0: Schema(id=0, name="", encoding="", data=b"")}
        self._channels: dict[int, Channel] = {}
        self._checkers: dict[int, Wrong | None] = {}
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
        self._checkers[channel.id] = checker(channel)
        wrong = wrong_with_channel(channel, self._schemas.get(channel.schema_id))
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

    def finish(self, condition: Condition, path: Path) -> CheckResult:
        result = self._result
        result.channels = len(self._channels)
        if self._first_ns is not None:
            result.seconds = (self._last_ns - self._first_ns) / 1e9
        if not condition.closed:
            what = "its last chunk breaks off" if condition.broken_chunk else "its end is missing"
            result.add("file", f"it was not closed: {what}")
        if condition.damaged:
            result.add("file", f"{condition.damaged} records are damaged")
        if condition.closed:
            for wrong in wrong_with_index(path, self._counts):
                result.add("index", wrong)
        return result
