"""`gcs log cut`: a stretch of a record, with what a viewer needs to know at its beginning."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import msgspec

from gcs.mcap_file.copier import Source, Target, new_record
from gcs.mcap_file.format import Message, Record
from gcs.mcap_file.reader import Progress, Reading
from gcs.record.info import read_info

_EVENTS = re.compile(r"/mavlink/|/link/|/session/input$|/gate/(decision|goals)$|/log$|/events?$")
"""Topics whose messages are events: what happened before the cut is not repeated in it."""


class NotInRecordError(Exception):
    """There is nothing of what was asked for: why, and what there is as a `hint`."""

    def __init__(self, why: str, hint: str) -> None:
        super().__init__(why)
        self.hint = hint


@dataclass(frozen=True, slots=True)
class Cut:
    """What the new file holds."""

    messages: int
    repeated: int
    """So many of them are from before the cut: each state as it was then."""
    seconds: float
    attachments: int


class _Named(msgspec.Struct):
    """A JSON message that is about one of several things."""

    name: str = ""


_named = msgspec.json.Decoder(_Named)


def cut(
    source: Path, target: Path, from_s: float, to_s: float, progress: Progress | None = None
) -> Cut:
    """Copy what has a log_time from `from_s` to `to_s`, seconds after the record's first message.

    Attachments and metadata are kept, all of them.  The latest message before `from_s` of every
    topic that tells a state comes first, a nanosecond each before the cut, so that a viewer shows
    them at its first instant; its `publish_time` stays as it was.

    Raises NotInRecordError, BadRecordError, and OSError (FileExistsError where `target` exists).
    """
    cutter = _Cutter(from_s, to_s)
    reading = Reading(source, progress)
    with new_record(target) as made:
        for record in reading:
            cutter.take(record, made)
        if cutter.first_ns is None:
            raise NotInRecordError("there is no message in it", "gcs log info tells what it holds")
        if not cutter.copied:
            length_s = (cutter.last_ns - cutter.first_ns) / 1e9
            raise NotInRecordError(
                f"there is no message from {from_s:g} to {to_s:g} s", f"it has {length_s:.1f} s"
            )
    repeated = made.messages - cutter.copied
    return Cut(made.messages, repeated, made.seconds, made.attachments)


class _Cutter:
    def __init__(self, from_s: float, to_s: float) -> None:
        self._from_s = from_s
        self._to_s = to_s
        self._source = Source()
        self._states: dict[tuple[int, str], Message] = {}
        self.first_ns: int | None = None
        self.last_ns = 0
        self.copied = 0

    def take(self, record: Record, made: Target) -> None:
        if not isinstance(record, Message):
            self._source.copy(record, made)
            return
        if self.first_ns is None:
            self.first_ns = record.log_time_ns
        self.last_ns = max(self.last_ns, record.log_time_ns)
        t_s = (record.log_time_ns - self.first_ns) / 1e9
        if t_s < self._from_s:
            self._remember(record)
        elif t_s <= self._to_s:
            self._repeat(made)
            number = self._source.channel_in(made, record)
            if number is not None:
                made.message(number, record)
                self.copied += 1

    def _remember(self, message: Message) -> None:
        channel = self._source.channels.get(message.channel_id)
        if channel is None or _EVENTS.match(channel.topic):
            return
        name = _name_in(message.data) if channel.message_encoding == "json" else ""
        self._states[channel.id, name] = message

    def _repeat(self, made: Target) -> None:
        """Each state once, in the order in which they were told."""
        states = sorted(self._states.values(), key=lambda message: message.log_time_ns)
        self._states.clear()
        assert self.first_ns is not None
        begin_ns = self.first_ns + round(self._from_s * 1e9)
        for number, message in enumerate(states):
            channel = self._source.channel_in(made, message)
            assert channel is not None, "its channel was known"
            made.message(channel, message._replace(log_time_ns=begin_ns - len(states) + number))


def _name_in(data: bytes) -> str:
    """A topic of many things, such as parameters, tells them by name."""
    try:
        return _named.decode(data).name
    except msgspec.MsgspecError:
        return ""


def around(
    source: Path, request_id: int, margin_s: float, progress: Progress | None = None
) -> tuple[float, float]:
    """From `margin_s` before what was first said of a request to `margin_s` after the last.

    Raises NotInRecordError, BadRecordError and OSError.
    """
    decisions = read_info(source, progress).decisions
    times_s = [each.t_s for each in decisions if each.request_id == request_id]
    if not times_s:
        known = sorted({each.request_id for each in decisions})
        hint = "no request is in it"
        if known:
            hint = f"its requests are {known[0]} to {known[-1]}; gcs log info lists them"
        raise NotInRecordError(f"there is no decision on request {request_id}", hint)
    return max(0.0, times_s[0] - margin_s), times_s[-1] + margin_s
