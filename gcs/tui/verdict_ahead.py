"""What the gate would say to the pending goal before Enter: asked by `ipc.Check`, never guessed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import Final

from gcs import ipc
from gcs.enu_text import labelled_enu
from gcs.operator import event_text

LEAST_S: Final = 0.5
"""A goal that changes is asked about at most twice a second."""
RENEW_S: Final = 2.0
"""The answer depends on where the vehicle is and on what it does, so it is asked for again."""

Goal = tuple[ipc.Vec3, float | None]
"""Metres E N U, and the yaw."""


class Ahead(Enum):
    """What Enter would do now, as the mark on the map is coloured."""

    UNKNOWN = "not answered yet"
    FREE = "accepted"
    LATER = "not now, but the goal itself clears"
    REFUSED = "the goal is refused"


@dataclass(slots=True)
class VerdictAhead:
    """The latest answer, and the goal that it is about."""

    _told: ipc.Checked | None = None
    _asked: Goal | None = None
    _asked_id: int = 0
    _asked_s: float = -math.inf
    _outdated: bool = False

    def due(self, goal: Goal, now_s: float) -> bool:
        """Whether to ask now."""
        news = self._outdated or goal != self._asked
        return now_s - self._asked_s >= (LEAST_S if news else RENEW_S)

    def outdate(self) -> None:
        """The gate's state has changed, and with it what it would say."""
        self._outdated = True

    def asked(self, goal: Goal, check_id: int, now_s: float) -> None:
        if goal != self._asked:
            self._told = None
        self._asked, self._asked_id, self._asked_s = goal, check_id, now_s
        self._outdated = False

    def told(self, answer: ipc.Checked) -> None:
        """An answer about an earlier goal says nothing of this one."""
        if answer.id == self._asked_id:
            self._told = answer

    def answer(self, goal: Goal) -> ipc.Checked | None:
        return self._told if goal == self._asked else None

    def of(self, goal: Goal) -> Ahead:
        told = self.answer(goal)
        if told is None:
            return Ahead.UNKNOWN
        if told.goal_code:
            return Ahead.REFUSED
        return Ahead.FREE if told.outcome == "accepted" else Ahead.LATER

    def words(self, goal: Goal) -> str:
        """One sentence: what Enter would be answered, with the reason."""
        told = self.answer(goal)
        if told is None:
            return "Enter: asking the gate …"
        if told.goal_code:
            why = told.goal_sentence.replace(f"goal {labelled_enu(goal[0])} is ", "")  # shown above
            return f"Enter: refused {told.goal_code}: {why}"
        if told.outcome == "accepted":
            return "Enter: accepted, the goal clears"
        if told.outcome == "waits":
            return "Enter: waits for its turn; the goal itself clears"
        why = event_text.reason(told.outcome, told.code, told.sentence)
        return f"Enter: not now (the goal clears): {told.code}: {why}"
