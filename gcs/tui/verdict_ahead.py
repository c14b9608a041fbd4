"""What the gate would say before Enter, to the pending goal or to a typed line: asked by
`ipc.Check`, never guessed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import Final

from gcs import ipc
from gcs.enu_text import labelled_enu
from gcs.operator.line_parser import LineError, parse_line
from gcs.operator.text import event_text
from gcs.request_words import Doer, SendRequests, doer_of

LEAST_S: Final = 0.5
"""What changes is asked about at most twice a second."""
RENEW_S: Final = 2.0
"""The answer depends on where the vehicle is and on what it does, so it is asked for again."""


class Ahead(Enum):
    """What Enter would do now, as the mark on the map is coloured."""

    UNKNOWN = "not answered yet"
    FREE = "accepted"
    LATER = "not now, but the goal itself clears"
    REFUSED = "the goal, or what is no goal, is refused"


@dataclass(frozen=True, slots=True)
class TypedLine:
    """A line that is not finished.  `ask`: what Enter would send, where the gate can be asked
    about it; `hint`: what is missing."""

    text: str
    ask: ipc.Ask | None = None
    hint: str = ""

    @property
    def goal_enu(self) -> ipc.Vec3 | None:
        """Where it would lead, as far as that is typed."""
        return None if self.ask is None else _finite(self.ask.goal_enu)


def typed_line(text: str) -> TypedLine:
    """While the first word is typed, Tab says more than an error."""
    try:
        line = parse_line(text)
    except LineError as error:
        begun = " " in text.lstrip()
        return TypedLine(text, hint=f"{error.sentence}; {error.hint}" if begun else "")
    match None if line is None else line.action:
        case SendRequests((ask,)) if doer_of(ask.word) is Doer.GATE:
            return TypedLine(text, ask)
    return TypedLine(text)


@dataclass(slots=True)
class VerdictAhead:
    """The latest answer, and what it is about."""

    _told: ipc.Checked | None = None
    _asked: bytes = b""
    _asked_id: int = 0
    _asked_s: float = -math.inf
    _outdated: bool = False

    def due(self, ask: ipc.Ask, now_s: float) -> bool:
        """Whether to ask now.  `ask`: without a number."""
        news = self._outdated or ipc.encode(ask) != self._asked
        return now_s - self._asked_s >= (LEAST_S if news else RENEW_S)

    def outdate(self) -> None:
        """The gate's state has changed, and with it what it would say."""
        self._outdated = True

    def asked(self, ask: ipc.Ask, check_id: int, now_s: float) -> None:
        as_sent = ipc.encode(ask)  # in which NaN is equal to itself
        if as_sent != self._asked:
            self._told = None
        self._asked, self._asked_id, self._asked_s = as_sent, check_id, now_s
        self._outdated = False

    def told(self, answer: ipc.Checked) -> None:
        """An answer about an earlier goal says nothing of this one."""
        if answer.id == self._asked_id:
            self._told = answer

    def answer(self, ask: ipc.Ask) -> ipc.Checked | None:
        return self._told if ipc.encode(ask) == self._asked else None

    def of(self, ask: ipc.Ask) -> Ahead:
        told = self.answer(ask)
        if told is None:
            return Ahead.UNKNOWN
        if told.goal_code or (ask.word != "goto" and told.outcome == "refused"):
            return Ahead.REFUSED
        return Ahead.FREE if told.outcome == "accepted" else Ahead.LATER

    def words(self, ask: ipc.Ask) -> str:
        """One sentence: what Enter would be answered, with the reason."""
        told = self.answer(ask)
        if told is None:
            return "Enter: asking the gate …"
        if told.goal_code:
            goal_enu, why = _finite(ask.goal_enu), told.goal_sentence
            if goal_enu is not None:
                why = why.replace(f"goal {labelled_enu(goal_enu)} is ", "")  # it is shown beside
            return f"Enter: refused {told.goal_code}: {why}"
        goes = ask.word == "goto"
        if told.outcome == "accepted":
            return "Enter: accepted, the goal clears" if goes else "Enter: accepted"
        if told.outcome == "waits":
            return "Enter: waits for its turn" + ("; the goal itself clears" if goes else "")
        why = event_text.reason(told.outcome, told.code, told.sentence)
        how = "not now (the goal clears):" if goes else "refused"
        return f"Enter: {how} {told.code}: {why}"


def _finite(goal_enu: ipc.Maybe3 | None) -> ipc.Vec3 | None:
    """None for a goal that is none."""
    east_m, north_m, up_m = goal_enu or (None, None, None)
    if east_m is None or north_m is None or up_m is None:
        return None
    goal = (east_m, north_m, up_m)
    return goal if all(map(math.isfinite, goal)) else None
