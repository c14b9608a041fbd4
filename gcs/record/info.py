"""`gcs log info`: what a recorded flight holds, from the file alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias

import msgspec

from gcs.mcap_file.format import Attachment, Channel, Message, Metadata, Schema
from gcs.mcap_file.reader import Condition, Progress, Reading

GAP_NS = 1_000_000_000
"""Silence on every topic for longer than this is reported."""

RATE_SPAN_NS = 2_000_000_000
"""A burst that is over sooner has no rate."""


@dataclass(slots=True)
class TopicInfo:
    topic: str
    schema: str
    encoding: str
    messages: int = 0
    hz: float = 0.0
    """Mean rate from its first message to its last; 0 where they are not `RATE_SPAN_NS` apart."""


class StateInfo(msgspec.Struct, kw_only=True):
    """The gate's machine came to `state`; times count from the first message of the file."""

    t_s: float = 0.0
    vehicle: int = 0
    state: str
    event: str = ""


class DecisionInfo(msgspec.Struct, kw_only=True):
    """A verdict or an ending of one request; `t_s` as in StateInfo."""

    t_s: float = 0.0
    request_id: int
    word: str
    phase: str
    outcome: str
    code: str = ""
    sentence: str = ""


@dataclass(slots=True)
class GapInfo:
    t_s: float
    seconds: float


@dataclass(slots=True)
class FlightInfo:
    """The whole answer; `msgspec.json.encode` makes `--json` of it."""

    path: str
    size: int
    closed: bool
    damaged: int
    start_ns: int | None = None
    seconds: float = 0.0
    messages: int = 0
    topics: list[TopicInfo] = field(default_factory=list)
    states: list[StateInfo] = field(default_factory=list)
    decisions: list[DecisionInfo] = field(default_factory=list)
    gaps: list[GapInfo] = field(default_factory=list)
    attachments: list[str] = field(default_factory=list)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)


_fsa_decoder = msgspec.json.Decoder(StateInfo)
_decision_decoder = msgspec.json.Decoder(DecisionInfo)

_Handler: TypeAlias = Callable[[Message, float], None]


@dataclass(slots=True)
class _Tally:
    """One channel while the file is read."""

    info: TopicInfo
    handler: _Handler | None
    first_ns: int = 0
    last_ns: int = 0


def read_info(path: Path, progress: Progress | None = None) -> FlightInfo:
    """Read the whole file.  Raises BadRecordError and OSError."""
    reading = Reading(path, progress)
    survey = _Survey(str(path), reading.condition.size)
    for record in reading:
        match record:
            case Message():
                survey.message(record)
            case Schema(id=schema_id, name=name):
                survey.schemas[schema_id] = name
            case Channel():
                survey.channel(record)
            case Attachment(name=name):
                survey.info.attachments.append(name)
            case Metadata(name=name, metadata=values):
                survey.info.metadata[name] = values
    return survey.finish(reading.condition)


class _Survey:
    def __init__(self, path: str, size: int) -> None:
        self.info = FlightInfo(path, size, closed=False, damaged=0)
        self.schemas: dict[int, str] = {0: ""}
        self._tallies: dict[int, _Tally] = {}
        self._states: dict[int, str] = {}
        self._last_ns = 0

    def channel(self, channel: Channel) -> None:
        if channel.id not in self._tallies:
            schema = self.schemas.get(channel.schema_id, "")
            topic = TopicInfo(channel.topic, schema, channel.message_encoding)
            self._tallies[channel.id] = _Tally(topic, self._handler(channel.topic))

    def message(self, message: Message) -> None:
        tally = self._tallies.get(message.channel_id)
        if tally is None:
            return
        info, at_ns = self.info, message.log_time_ns
        if info.start_ns is None:
            info.start_ns = self._last_ns = at_ns
        t_s = (at_ns - info.start_ns) / 1e9
        if at_ns - self._last_ns > GAP_NS:
            info.gaps.append(
                GapInfo((self._last_ns - info.start_ns) / 1e9, (at_ns - self._last_ns) / 1e9)
            )
        self._last_ns = max(self._last_ns, at_ns)
        if tally.info.messages == 0:
            tally.first_ns = at_ns
        tally.info.messages += 1
        tally.last_ns = at_ns
        if tally.handler is not None:
            tally.handler(message, t_s)

    def finish(self, condition: Condition) -> FlightInfo:
        info = self.info
        info.closed, info.damaged = condition.closed, condition.damaged
        if info.start_ns is not None:
            info.seconds = (self._last_ns - info.start_ns) / 1e9
        for tally in self._tallies.values():
            if tally.last_ns - tally.first_ns >= RATE_SPAN_NS:
                tally.info.hz = (tally.info.messages - 1) * 1e9 / (tally.last_ns - tally.first_ns)
        info.topics = sorted((t.info for t in self._tallies.values()), key=lambda t: t.topic)
        info.messages = sum(topic.messages for topic in info.topics)
        return info

    def _handler(self, topic: str) -> _Handler | None:
        match topic.split("/"):
            case ["", "gate", "decision"]:
                return self._decision
            case ["", "vehicle", number, "fsa"] if number.isdecimal():
                return lambda message, t_s: self._fsa(int(number), message, t_s)
            case _:
                return None

    def _decision(self, message: Message, t_s: float) -> None:
        try:
            found = _decision_decoder.decode(message.data)
        except msgspec.DecodeError:
            self.info.damaged += 1
            return
        found.t_s = t_s
        self.info.decisions.append(found)

    def _fsa(self, vehicle: int, message: Message, t_s: float) -> None:
        try:
            found = _fsa_decoder.decode(message.data)
        except msgspec.DecodeError:
            self.info.damaged += 1
            return
        if self._states.get(vehicle) != found.state:
            self._states[vehicle] = found.state
            found.t_s, found.vehicle = t_s, vehicle
            self.info.states.append(found)
