"""What operators ask: their words become requests of the gate, their numbers request ids."""

from __future__ import annotations

from dataclasses import dataclass

from gcs import ipc
from gcs.gate.requests import Request, SetMode
from gcs.gate.states import FlightMode
from gcs.protocol.autopilot import Autopilot, mode_named
from gcs.request_words import REQUESTS, BadAskError
from gcs.session.stop_of_several import StopOfSeveral

FIRST = 1
"""The operator's program that started the station."""


@dataclass(frozen=True, slots=True)
class Asked:
    """One request in the words that it was made in, and the number of the operator who made it."""

    ask: ipc.Ask
    operator: int = 1
    several: StopOfSeveral | None = None
    """What it is a part of, where it stops one of several vehicles."""

    def verdict(self, sysid: int, event: ipc.VerdictEvent) -> list[ipc.Event]:
        """What its operator is told."""
        return [event] if self.several is None else self.several.verdict(sysid, event)

    def ending(self, sysid: int, event: ipc.EndingEvent) -> list[ipc.Event]:
        return [event] if self.several is None else self.several.ending(sysid, event)

    @property
    def word(self) -> str:
        return self.ask.word

    @property
    def source(self) -> str:
        """Who asks, for the gate and the record."""
        return source_of(self.operator)


def source_of(operator: int) -> str:
    """What the gate and the record call an operator."""
    return "operator" if operator == 1 else f"operator {operator}"


def operator_of(source: str) -> int:
    """The operator whom `source_of` calls so."""
    return int(source.removeprefix("operator") or 1)


def request_of(ask: ipc.Ask, autopilot: Autopilot | None) -> Request:
    """What the gate is asked for.  Raises BadAskError; mission transfers are not for the gate."""
    word = REQUESTS.get(ask.word)
    if ask.word == "mode":
        return _mode(ask.mode, autopilot)
    if word is None or word.gate is None:
        raise BadAskError(f"no such request: {ask.word!r}")
    return word.gate(ask) if callable(word.gate) else word.gate


def _mode(name: str, autopilot: Autopilot | None) -> SetMode:
    mode = mode_named(autopilot, name) if autopilot else None
    if mode is None:
        names = ", ".join(known.name for known in autopilot.modes) if autopilot else ""
        raise BadAskError(f"no mode {name!r} here; there are: {names or 'none'}")
    sent = autopilot.mode_of_meaning.get(mode.meaning, mode.name) if autopilot else ""
    if sent != mode.name:
        return SetMode(mode.name, FlightMode.OTHER, instead=sent)
    return SetMode(mode.name, mode.meaning)


class Requests:
    """Numbers requests and remembers them until their ending is told."""

    def __init__(self) -> None:
        self._next_id = 1
        self._asked: dict[int, Asked] = {}

    def open(self, ask: ipc.Ask, operator: int, several: StopOfSeveral | None = None) -> int:
        request_id = self._next_id
        self._next_id += 1
        self._asked[request_id] = Asked(ask, operator, several)
        return request_id

    def get(self, request_id: int) -> Asked:
        return self._asked[request_id]

    def number_of(self, operator: int, ask_id: int) -> int | None:
        """The request that an operator made as its own number `ask_id`, if it is not over."""
        for request_id, asked in self._asked.items():
            if asked.operator == operator and asked.ask.id == ask_id:
                return request_id
        return None

    def of(self, operator: int) -> list[tuple[int, Asked]]:
        """Those of one operator that are not over."""
        return [(each, asked) for each, asked in self._asked.items() if asked.operator == operator]

    def close(self, request_id: int) -> Asked:
        """The request is over: refused, superseded, or ended."""
        return self._asked.pop(request_id)

    @property
    def open_count(self) -> int:
        return len(self._asked)
