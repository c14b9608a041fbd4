"""What the screen shows: the latest of everything, and the little that is kept from before."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, field

from gcs import ipc
from gcs.gate.states import State
from gcs.operator import control_text, event_text, request_words
from gcs.tui.keyboard import PendingGoal, VelocityKeys

TRAIL_POINTS = 800
TRAIL_STEP_M = 0.1
COMPLETE = "complete"
REFUSED = "refused"
ACCEPTED = "accepted"
TAKEN_OVER = "taken over"
ANSWER_NS = 10_000_000_000
"""How long it is shown that something has ended: after that it may not be so any more."""


@dataclass(slots=True)
class Answer:
    """The last thing the gate said about a request, for the lines above the log."""

    text: str = ""
    kind: str = ""  # accepted | refused | superseded, or how it ended
    given_ns: int = 0  # on the clock of the snapshots


@dataclass(slots=True)
class Scene:
    """Updated with the station's events; read by the panels ten times a second."""

    pending: PendingGoal = field(default_factory=PendingGoal)
    velocity: VelocityKeys | None = None  # in velocity mode
    snapshot: ipc.Snapshot | None = None
    hello: ipc.Hello | None = None
    zones: list[ipc.FenceShape] = field(default_factory=list)
    trail: deque[ipc.Vec3] = field(default_factory=lambda: deque(maxlen=TRAIL_POINTS))
    last_move: ipc.StateEvent | None = None
    answer: Answer = field(default_factory=Answer)
    progress: ipc.ProgressEvent | None = None
    zoom: int = 0
    fence_on: bool = True
    _requests: dict[int, ipc.Ask] = field(default_factory=dict)
    _before_take_off: PendingGoal | None = None
    _up: bool = False
    _key_since_refusal: bool = True
    heard_vehicle: bool = False

    @property
    def now_ns(self) -> int:
        return 0 if self.snapshot is None else self.snapshot.time_ns

    @property
    def client(self) -> int:
        """The number that the station knows this operator by."""
        return self.hello.client if self.hello else 0

    @property
    def in_control(self) -> bool:
        """Whether this operator may ask for everything, or would get control by asking."""
        operator = self.snapshot.in_control if self.snapshot else None
        return operator is None or operator.client == self.client

    @property
    def lost(self) -> bool:
        """A vehicle was heard and is not heard any more: what is shown of it is old."""
        seen = self.snapshot
        return seen is not None and bool(seen.vehicle) and seen.state == State.NO_VEHICLE.name

    @property
    def active_enu(self) -> ipc.Vec3 | None:
        """The goal that is flown, or hovered at; a vehicle that holds by itself has none."""
        seen = self.snapshot
        held = seen is None or seen.state in (State.HOLDING.name, State.NO_VEHICLE.name)
        return None if seen is None or held else seen.active_goal_enu

    def note_request(self, request: ipc.Ask) -> None:
        """Keep it for its answers."""
        self._requests[request.id] = request
        if request.word == "takeoff":
            self._before_take_off, self._up = self.pending, False

    def label(self, event: ipc.VerdictEvent | ipc.EndingEvent) -> str:
        request = self._requests.get(event.id)
        return event.word.replace("_", " ") if request is None else request_words.label(request)

    def take_hover_point(self) -> ipc.Vec3 | None:
        """Once after a take-off: where it hovers, if the pending goal is as it was before.

        What was pending on the ground would be a descent now.
        """
        seen = self.snapshot
        if not self._up or seen is None or seen.state != State.HOVERING.name:
            return None
        self._up = False
        touched = self.pending.goal_enu != (self._before_take_off or self.pending).goal_enu
        return None if touched else seen.active_goal_enu or seen.pos_enu

    def update(self, event: ipc.Event) -> None:
        match event:
            case ipc.Hello():
                self.hello = event
                self.zones = event.fence
            case ipc.Fences(zones):
                self.zones = zones
            case ipc.Snapshot():
                self._note_control(self.snapshot, event)
                self.snapshot = event
                self.heard_vehicle = self.heard_vehicle or bool(event.vehicle)
                self._forget_old_answer()
                self._leave_trail(event.pos_enu)
            case ipc.StateEvent():
                self.last_move = event
            case ipc.VerdictEvent():
                sentence = event_text.refused_by_rule(event) or event.sentence
                self._show_answer(self.label(event), event.outcome, event.code, sentence)
            case ipc.EndingEvent():
                self.progress = None
                self._note_outcome(event)
                if not self._says_it_is_taken(event):
                    self._show_answer(self.label(event), event.ended, event.code, event.sentence)
            case ipc.ProgressEvent():
                # The last step of a transfer needs no ending of the request to be over.
                self.progress = None if event.done >= event.total > 0.0 else event
            case ipc.Operators() | ipc.Operation() | ipc.OperationList() | ipc.MessageEvent():
                pass
            case ipc.Topic() | ipc.TopicMessage():
                pass
            case ipc.LogEvent() | ipc.Trouble() | ipc.Bye():
                pass

    def note_key(self) -> None:
        """The operator has pressed a key: what was refused before has been read."""
        self._key_since_refusal = True

    def _show_answer(self, label: str, kind: str, code: str, sentence: str) -> None:
        """A refusal stays until the next key, whatever else ends meanwhile."""
        if kind == REFUSED:
            self._key_since_refusal = False
            why = event_text.reason(kind, code, sentence)
            text = f"refused {code} {label}: {why}" if why else f"refused {code} {label}"
        elif self._key_since_refusal or self.answer.kind != REFUSED:
            text = event_text.answer_line(label, kind, code, sentence)
        else:
            return
        self.answer = Answer(text, kind, self.now_ns)

    def _forget_old_answer(self) -> None:
        """What is under way, or refused and perhaps not read yet, is not forgotten."""
        old = self.now_ns - self.answer.given_ns > ANSWER_NS
        if old and self.answer.kind not in (ACCEPTED, REFUSED):
            self.answer = Answer()

    def _says_it_is_taken(self, event: ipc.EndingEvent) -> bool:
        """The taking of control is complete, and a snapshot that came before has said it better."""
        taken = event.word == "station_take" and event.ended == COMPLETE
        return taken and self.answer.kind == TAKEN_OVER

    def _note_outcome(self, event: ipc.EndingEvent) -> None:
        request = self._requests.get(event.id)
        if request is None or event.ended != COMPLETE:
            return
        if request.word == "fence":
            self.fence_on = request.on
        elif request.word == "takeoff":
            self._up = True

    def _note_control(self, before: ipc.Snapshot | None, now: ipc.Snapshot) -> None:
        """Say it where control of the station has passed to another operator, whatever was said
        before."""
        if before is None:
            return
        words = control_text.change_words(before.in_control, now.in_control, self.client)
        if words:
            self.answer = Answer(words, TAKEN_OVER, now.time_ns)

    def _leave_trail(self, pos_enu: ipc.Vec3 | None) -> None:
        if pos_enu is None:
            return
        if not self.trail or math.dist(self.trail[-1], pos_enu) >= TRAIL_STEP_M:
            self.trail.append(pos_enu)
