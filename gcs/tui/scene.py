"""What the screen shows: the latest of everything, and the little that is remembered."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, field

from gcs import ipc
from gcs.cli import words
from gcs.tui.keyboard import PendingGoal

TRAIL_POINTS = 800
TRAIL_STEP_M = 0.1


@dataclass(slots=True)
class Answer:
    """The last thing the gate said about a request, for the line above the log."""

    text: str = ""
    kind: str = ""  # accepted | refused | superseded, or how it ended


@dataclass(slots=True)
class Scene:
    """Fed with the link's events; read by the panels ten times a second."""

    pending: PendingGoal = field(default_factory=PendingGoal)
    snapshot: ipc.Snapshot | None = None
    hello: ipc.Hello | None = None
    zones: list[ipc.FenceShape] = field(default_factory=list)
    trail: deque[ipc.Vec3] = field(default_factory=lambda: deque(maxlen=TRAIL_POINTS))
    last_move: ipc.StateEvent | None = None
    answer: Answer = field(default_factory=Answer)
    progress: ipc.ProgressEvent | None = None
    zoom: int = 0
    _labels: dict[int, str] = field(default_factory=dict)

    def asked(self, ask: ipc.Ask) -> None:
        """Remember how a request reads, for its answers."""
        self._labels[ask.id] = words.label(ask)

    def label(self, event: ipc.VerdictEvent | ipc.EndingEvent) -> str:
        return self._labels.get(event.id, event.word.replace("_", " "))

    def hear(self, event: ipc.Event) -> None:
        match event:
            case ipc.Hello():
                self.hello = event
                self.zones = event.fence
            case ipc.Fences(zones):
                self.zones = zones
            case ipc.Snapshot():
                self.snapshot = event
                self._leave_trail(event.pos_enu)
            case ipc.StateEvent():
                self.last_move = event
            case ipc.VerdictEvent():
                self._answered(self.label(event), event.outcome, event.code, event.sentence)
            case ipc.EndingEvent():
                self.progress = None
                self._answered(self.label(event), event.ended, event.code, event.sentence)
            case ipc.ProgressEvent():
                self.progress = event
            case ipc.LogEvent() | ipc.Trouble() | ipc.Bye():
                pass

    def _answered(self, label: str, kind: str, code: str, sentence: str) -> None:
        told = f"{label}: {kind} {code}".rstrip()
        self.answer = Answer(f"{told}: {sentence}" if sentence else told, kind)

    def _leave_trail(self, pos_enu: ipc.Vec3 | None) -> None:
        if pos_enu is None:
            return
        if not self.trail or math.dist(self.trail[-1], pos_enu) >= TRAIL_STEP_M:
            self.trail.append(pos_enu)
