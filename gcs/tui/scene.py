"""What the screen shows: the latest of everything, and the little that is kept from before."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from msgspec import structs

from gcs import ipc, request_words
from gcs.gate.refusal import Code
from gcs.gate.states import State
from gcs.operator.conversation import Conversation, TrackedRequest
from gcs.operator.standstill import Standstill
from gcs.operator.text import control_text, event_text
from gcs.tui import fleet
from gcs.tui.alarms import Alarms
from gcs.tui.fleet import Mind, Minds
from gcs.tui.flight_numbers import FlightNumbers
from gcs.tui.keyboard import PendingGoal, VelocityKeys
from gcs.tui.verdict_ahead import TypedLine, VerdictAhead
from gcs.tui.view import others
from gcs.tui.wind import Wind, wind_of

TRAIL_POINTS = 800
TRAIL_STEP_M = 0.1
DECISIONS = 50
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


class Decision(NamedTuple):
    """One verdict or ending, for the list of them on a wide screen."""

    time_ns: int
    text: str
    kind: str


@dataclass(slots=True)
class Scene:
    """Updated with the station's events; read by the panels ten times a second."""

    pending: PendingGoal = field(default_factory=PendingGoal)
    pending_set: bool = False  # by the operator; else it follows a take-off
    ahead: VerdictAhead = field(default_factory=VerdictAhead)
    typed: TypedLine | None = None  # while one is typed
    typed_ahead: VerdictAhead = field(default_factory=VerdictAhead)
    alarms: Alarms = field(default_factory=Alarms)
    velocity: VelocityKeys | None = None  # in velocity mode
    talk: Conversation = field(default_factory=Conversation)
    zones: list[ipc.FenceShape] = field(default_factory=list)
    trail: deque[ipc.Vec3] = field(default_factory=lambda: deque(maxlen=TRAIL_POINTS))
    last_move: ipc.StateEvent | None = None
    answer: Answer = field(default_factory=Answer)
    progress: ipc.ProgressEvent | None = None
    mission: ipc.MissionPath = field(default_factory=lambda: ipc.MissionPath([]))  # on board
    mission_begun: bool = False  # it was flown, in part at least
    mission_said: Answer = field(default_factory=Answer)  # to the last request about a mission
    own_zones: list[ipc.FenceShape] = field(default_factory=list)  # its own, that are not `zones`
    other_goal: ipc.OperatorGoal | None = None  # of the operator who is in control, if not this one
    decisions: deque[Decision] = field(default_factory=lambda: deque(maxlen=DECISIONS))
    zoom: int = 0
    pan_en: tuple[float, float] = (0.0, 0.0)  # metres, of the map's middle
    numbers: FlightNumbers = field(default_factory=FlightNumbers)
    wind: Wind | None = None
    fence_on: bool = True
    minds: Minds = field(default_factory=Minds)
    _standstill: Standstill = field(default_factory=Standstill)
    _on_board: list[ipc.FenceShape] = field(default_factory=list)
    _up: bool = False
    _key_since_refusal: bool = True
    heard_vehicle: bool = False

    @property
    def snapshot(self) -> ipc.Snapshot | None:
        return self.talk.snapshot

    @property
    def now_ns(self) -> int:
        return 0 if self.snapshot is None else self.snapshot.time_ns

    @property
    def battery_low_pct(self) -> float:
        """From where on the policy calls a battery low."""
        return self.talk.hello.battery_low_pct if self.talk.hello else 0.0

    @property
    def in_control(self) -> bool:
        """Whether this operator may ask for everything, or would get control by asking."""
        operator = self.snapshot.in_control if self.snapshot else None
        return operator is None or operator.client == self.talk.number

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

    @property
    def left_armed(self) -> bool:
        """Leaving leaves it armed, held where it flies: this operator commands it, or has started
        the station, which ends with it."""
        seen = self.snapshot
        if seen is None or not fleet.armed(seen):
            return False
        commands = seen.in_control is not None and seen.in_control.client == self.talk.number
        return commands or self.talk.number == 1  # `Hello.client`: who has started the station

    def ask(self, request: ipc.Ask, label: str = "") -> ipc.Ask:
        """What is to be sent: the request with its number, kept for its answers."""
        return self.talk.ask(request, label).sent

    def choose(self, sysid: int) -> None:
        """Show another vehicle: what is drawn of it comes, and what was asked of the one before
        goes on without being followed here."""
        before = 0 if self.snapshot is None else self.snapshot.sysid
        mind = Mind(self.pending, self.pending_set, self.fence_on, self._up)
        mind = self.minds.swap(before, mind, sysid)
        self.pending, self.pending_set, self.fence_on, self._up = mind
        self.talk.snapshot = self.last_move = self.progress = self.wind = self.velocity = None
        self.ahead, self.typed_ahead = VerdictAhead(), VerdictAhead()
        self.zones, self.own_zones, self.pan_en = [], [], (0.0, 0.0)
        self.mission, self.mission_begun = ipc.MissionPath([]), False
        self.mission_said, self.numbers = Answer(), FlightNumbers()
        self._standstill = Standstill()
        self.trail.clear()

    def take_hover_point(self) -> ipc.Vec3 | None:
        """Once after a take-off: where it hovers, if the operator has not set a goal yet."""
        seen = self.snapshot
        if not self._up or seen is None or seen.state != State.HOVERING.name:
            return None
        self._up = False
        return None if self.pending_set else seen.active_goal_enu or seen.pos_enu

    def update(self, event: ipc.Event) -> None:
        before = self.snapshot
        tracked = self.talk.told(event)
        self.alarms.told(event, lost=self.lost)
        match event:
            case ipc.Checked():
                self.ahead.told(event)
                self.typed_ahead.told(event)
            case ipc.Hello():
                self.zones = event.fence
            case ipc.Fences(zones):
                self.zones = zones
                self.own_zones = others(self._on_board, zones)
            case ipc.Snapshot():
                self._note_control(before, event)
                self.heard_vehicle = self.heard_vehicle or bool(event.vehicle)
                self._forget_old_answer()
                self._leave_trail(event.pos_enu)
                self.numbers.seen(event)
                self.mission_begun |= event.state == State.FLYING_MISSION.name
                if stands := self._standstill.news(event):
                    self._show_answer(stands, COMPLETE)
            case ipc.StateEvent():
                self.last_move = event
                self.ahead.outdate()
                self.typed_ahead.outdate()
            case ipc.History():
                self._note_history(event)
            case ipc.MissionPath():
                self.mission_begun = self.mission_begun and event.items == self.mission.items
                self.mission = event
            case ipc.VehicleFence(zones):
                self._on_board, self.own_zones = zones, others(zones, self.zones)
            case ipc.OperatorGoal():
                self.other_goal = None if event.client == self.talk.number else event
            case ipc.MessageEvent():
                self.wind = wind_of(event, self.wind)
            case ipc.VerdictEvent():
                label = _label(event, tracked)
                line = event_text.verdict_line(label, event)
                self._show_answer(line, event.outcome, _refused_words(label, event))
                self._note_mission(event.word)
            case ipc.EndingEvent():
                self.progress = None
                if tracked is not None and tracked.completed:
                    self._note_completed(tracked.sent)
                line = self._standstill.outcome(_label(event, tracked), event, self.snapshot)
                if not self._says_it_is_taken(event):
                    self._show_answer(line, event.ended)
                    self._note_mission(event.word)
            case ipc.OperationList(_, operations):
                self._note_operations(operations)
            case ipc.Operation() if event.client != self.talk.number:
                self.decisions.append(_decision(event))
            case ipc.ProgressEvent():
                # The last step of a transfer needs no ending of the request to be over.
                self.progress = None if event.done >= event.total > 0.0 else event
            case _:
                pass

    def note_key(self) -> None:
        """The operator has pressed a key: what was refused before has been read."""
        self._key_since_refusal = True

    def _show_answer(self, line: str, kind: str, refused: str = "") -> None:
        """A refusal, which is worded for its own lines, stays until the next key, whatever else
        ends meanwhile."""
        self.decisions.append(Decision(self.now_ns, line, kind))
        if kind == REFUSED:
            self._key_since_refusal = False
        elif self.answer.kind == REFUSED and not self._key_since_refusal:
            return
        self.answer = Answer(refused or line, kind, self.now_ns)

    def _note_mission(self, word: str) -> None:
        if word.startswith("mission_"):
            last = self.decisions[-1]
            self.mission_said = Answer(last.text, last.kind, last.time_ns)

    def _forget_old_answer(self) -> None:
        """What is under way, or refused and perhaps not read yet, is not forgotten."""
        old = self.now_ns - self.answer.given_ns > ANSWER_NS
        if old and self.answer.kind not in (ACCEPTED, REFUSED):
            self.answer = Answer()

    def _says_it_is_taken(self, event: ipc.EndingEvent) -> bool:
        """The taking of control is complete, and a snapshot that came before has said it better."""
        taken = event.word == "station_take" and event.ended == COMPLETE
        return taken and self.answer.kind == TAKEN_OVER

    @property
    def of_several(self) -> str:
        """What is asked, and answered, begins so where there are others: whose it is."""
        seen = self.snapshot
        return f"vehicle {seen.sysid}: " if seen is not None and seen.others else ""

    def _note_completed(self, request: ipc.Ask) -> None:
        seen = self.snapshot
        if seen is not None and request.vehicle not in (0, seen.sysid):
            return  # it was asked while another vehicle was shown
        if request.word == "fence":
            self.fence_on = request.on
        elif request.word == "takeoff":
            self._up = True

    def _note_control(self, before: ipc.Snapshot | None, now: ipc.Snapshot) -> None:
        """Say it where control of the station has passed to another operator, whatever was said
        before."""
        if before is None:
            return
        words = control_text.change_words(before.in_control, now.in_control, self.talk.number)
        if words:
            self.answer = Answer(words, TAKEN_OVER, now.time_ns)

    def _note_history(self, before: ipc.History) -> None:
        """What was before this operator has joined."""
        for point in before.trail:
            self._leave_trail(point.pos_enu)
        self.numbers.before(before)

    def _note_operations(self, operations: Sequence[ipc.Operation]) -> None:
        """What was accepted before this operator has joined, and how it ended."""
        begun = [structs.replace(each, state="running", ended_ns=None) for each in operations]
        told = [*begun, *(each for each in operations if each.ended_ns is not None)]
        before = sorted(map(_decision, told))
        self.decisions = deque([*before, *self.decisions], maxlen=DECISIONS)

    def _leave_trail(self, pos_enu: ipc.Vec3 | None) -> None:
        if pos_enu is None:
            return
        if not self.trail or math.dist(self.trail[-1], pos_enu) >= TRAIL_STEP_M:
            self.trail.append(pos_enu)


def _decision(operation: ipc.Operation) -> Decision:
    """Of an operation of somebody else: that it was accepted, or how it ended."""
    label = f"{request_words.label(operation.asked)} of operator {operation.client}"
    if operation.ended_ns is None:
        return Decision(operation.since_ns, f"{label}: {ACCEPTED}", ACCEPTED)
    line = event_text.answer_line(label, operation.state, operation.code, operation.sentence)
    return Decision(operation.ended_ns, line, operation.state)


def _refused_words(label: str, event: ipc.VerdictEvent) -> str:
    """Code first, so that it is seen where the line is cut; empty if it was not refused."""
    if event.outcome != REFUSED:
        return ""
    sentence = event_text.refused_by_rule(event) or event.sentence
    if event.code == Code.BUSY:
        sentence = f"{sentence}; wait until it is complete, or hold first"
    why = event_text.reason(REFUSED, event.code, sentence)
    told = f"refused {event.code} {label}"
    return f"{told}: {why}" if why else told


def _label(event: ipc.VerdictEvent | ipc.EndingEvent, tracked: TrackedRequest | None) -> str:
    """As it would be typed; of a request that this screen has not made, its word."""
    return event.word.replace("_", " ") if tracked is None else tracked.label
