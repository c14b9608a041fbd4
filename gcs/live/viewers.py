"""What viewers ask for becomes lines for the station, what it says becomes answers.  Pure.

A viewer looks, and may stop the vehicle (`services.SERVICES`, `anyone`): what all of those ask goes
over the one connection of the live view (`LOOKING`).  Whoever brings the code is *trusted* and gets
a connection of its own: to the station it is an operator like any other one, takes control over,
can lose it to another, and is held for when its connection ends.  The station does not know of the
code, and nothing else but stops goes over `LOOKING`, so that nobody is given control unasked.
"""

from __future__ import annotations

import hmac
from dataclasses import dataclass, field

import msgspec

from gcs import ipc
from gcs.live.clicked_goals import BadMessageError, clicked_goal
from gcs.live.effects import Close, Effect, Join, Notice, Reply, Send, Values
from gcs.live.inputs import (
    Call,
    Called,
    Ended,
    Gone,
    Input,
    ParametersAsked,
    Published,
    Tick,
    Told,
)
from gcs.live.parameters import Parameters
from gcs.live.rate_limit import RateLimit
from gcs.live.services import (
    SERVICES,
    Answer,
    BadCallError,
    TakeControl,
    ask_of,
    goal_height_m,
    request_of,
)
from gcs.operator.conversation import Conversation
from gcs.operator.text import event_text

LOOKING = 0
"""In place of a viewer's number: the live view's own connection."""
MAX_TRUSTED = 4
MAX_WAITING = 8
"""Calls of one connection that wait for the station."""
CALL_WAIT_NS = 5_000_000_000
CALLS_A_SECOND = 5.0
BURST_CALLS = 10.0
WRONG_CODES_A_SECOND = 0.2
BURST_WRONG_CODES = 5.0
"""Of all viewers together: whoever comes anew for each try has no more of them."""
LOOKING_A_SECOND = 20.0
BURST_LOOKING = 30.0
NOTICE_NS = 2_000_000_000
"""What is told to all viewers is told at most once in so long."""

TOO_MANY_CODES = "too many wrong control codes were tried: try again in 5 s"
NEEDS_CONTROL = "this viewer only looks: call take_control with the code that gcs has printed"


@dataclass(slots=True)
class _Waiting:
    """A request that the station has not answered; without a call it was a clicked goal."""

    call: Call | None
    until_ns: int


@dataclass(slots=True)
class _Connection:
    """To the station: which requests wait for a verdict, and which clicked goals for an ending."""

    talk: Conversation = field(default_factory=Conversation)
    waiting: dict[int, _Waiting] = field(default_factory=dict)
    clicked: set[int] = field(default_factory=set)


class Viewers:
    """All viewers of one live view."""

    def __init__(self, code: str, now_ns: int) -> None:
        """`code`: what `take_control` must bring."""
        self._code = code
        self._looking = RateLimit.full(LOOKING_A_SECOND, BURST_LOOKING, now_ns)
        self._connections = {LOOKING: _Connection()}
        self._buckets: dict[int, RateLimit] = {}
        self._wrong_codes = RateLimit.full(WRONG_CODES_A_SECOND, BURST_WRONG_CODES, now_ns)
        self._parameters = Parameters()
        self._snapshot: ipc.Snapshot | None = None
        self._noticed_ns = now_ns - NOTICE_NS

    @property
    def trusted(self) -> frozenset[int]:
        """Viewers that have brought the code."""
        return frozenset(self._connections) - {LOOKING}

    def handle(self, given: Input, now_ns: int) -> list[Effect]:
        """What follows from `given`."""
        match given:
            case Called():
                return self._called(given, now_ns)
            case Published():
                return self._published(given, now_ns)
            case ParametersAsked():
                return self._asked(given)
            case Gone(viewer):
                return self._gone(viewer)
            case Told(viewer, event):
                return self._told(viewer, event)
            case Ended(viewer):
                return self._ended(viewer)
            case Tick():
                return self._overdue(now_ns)

    # ----------------------------------------------------------------------------- asking

    def _called(self, call: Called, now_ns: int) -> list[Effect]:
        service, viewer = SERVICES[call.service], call.call.viewer
        trusted = viewer in self._connections
        if not self._bucket(viewer, now_ns).take(now_ns):
            return [_refused(call, "BUSY", f"more than {CALLS_A_SECOND:g} calls a second")]
        if not (trusted or service.anyone):
            return [_refused(call, "OTHER_OPERATOR", NEEDS_CONTROL)]
        try:
            request = request_of(call.service, call.payload)
            ask = ask_of(call.service, request, self._parameters, self._snapshot)
        except BadCallError as error:
            return [_refused(call, "BAD_REQUEST", str(error))]
        effects: list[Effect] = []
        if isinstance(request, TakeControl) and not trusted:
            why = self._why_not_trusted(request, now_ns)
            if why:
                told = self._notice(TOO_MANY_CODES, now_ns) if why == TOO_MANY_CODES else []
                return [_refused(call, "OTHER_OPERATOR", why), *told]
            self._connections[viewer] = _Connection()
            effects.append(Join(viewer))
            trusted = True
        sender = viewer if trusted else LOOKING
        connection = self._connections[sender]
        if sender == LOOKING and not self._looking.take(now_ns):
            return [_refused(call, "BUSY", "the viewers that look ask for too much together")]
        if len(connection.waiting) >= MAX_WAITING:
            return [_refused(call, "BUSY", "too many calls wait for the station")]
        return [*effects, self._send(sender, ask, call.call, now_ns)]

    def _why_not_trusted(self, request: TakeControl, now_ns: int) -> str:
        right = hmac.compare_digest(request.code.strip().encode(), self._code.encode())
        if not self._wrong_codes.take(now_ns):
            # Of the right one neither, so that a guess tells nothing.
            return TOO_MANY_CODES
        if not right:
            return "that is not the code that gcs has printed"
        self._wrong_codes.level += 1.0
        if len(self._connections) > MAX_TRUSTED:
            return f"{MAX_TRUSTED} viewers can have control in turn, and that many are there"
        return ""

    def _published(self, message: Published, now_ns: int) -> list[Effect]:
        viewer = message.viewer
        connection = self._connections.get(viewer)
        if not self._bucket(viewer, now_ns).take(now_ns):
            return []
        if connection is None:
            return [Notice(viewer, NEEDS_CONTROL, warning=True)]
        if len(connection.waiting) >= MAX_WAITING:
            return [Notice(viewer, "too many goals wait for the station", warning=True)]
        try:
            goal = clicked_goal(message.encoding, message.schema_name, message.data)
        except BadMessageError as error:
            return [Notice(viewer, str(error), warning=True)]
        up_m = goal_height_m(self._parameters, self._snapshot)
        goal_enu = (goal.at_enu[0], goal.at_enu[1], up_m)
        ask = ipc.Ask(0, "goto", goal_enu=goal_enu, yaw_deg=goal.yaw_deg)
        return [self._send(viewer, ask, None, now_ns)]

    def _asked(self, asked: ParametersAsked) -> list[Effect]:
        """Whoever asks is told the values as they are, also where it has set nothing."""
        told: list[Effect] = []
        if asked.set_to is not None and asked.viewer not in self._connections:
            told.append(Notice(asked.viewer, NEEDS_CONTROL, warning=True))
        elif asked.set_to is not None:
            before = self._parameters
            self._parameters, mistakes = before.changed(asked.set_to)
            told += [Notice(asked.viewer, text, warning=True) for text in mistakes[:1]]
            if self._parameters != before:
                told.append(Values(None, msgspec.structs.asdict(self._parameters)))
        values = msgspec.structs.asdict(self._parameters)
        wanted = {name: values[name] for name in asked.names if name in values} or values
        return [Values(asked.viewer, wanted, asked.request), *told]

    def _send(self, sender: int, ask: ipc.Ask, call: Call | None, now_ns: int) -> Send:
        connection = self._connections[sender]
        sent = connection.talk.ask(ask).sent
        connection.waiting[sent.id] = _Waiting(call, now_ns + CALL_WAIT_NS)
        return Send(sender, sent)

    def _bucket(self, viewer: int, now_ns: int) -> RateLimit:
        known = self._buckets.get(viewer)
        if known is None:
            known = self._buckets[viewer] = RateLimit.full(CALLS_A_SECOND, BURST_CALLS, now_ns)
        return known

    def _notice(self, text: str, now_ns: int) -> list[Effect]:
        if now_ns - self._noticed_ns < NOTICE_NS:
            return []
        self._noticed_ns = now_ns
        return [Notice(None, text, warning=True)]

    # ---------------------------------------------------------------------------- answers

    def _told(self, viewer: int, event: ipc.Event) -> list[Effect]:
        if isinstance(event, ipc.Snapshot):
            self._snapshot = event
        connection = self._connections.get(viewer)
        tracked = connection.talk.told(event) if connection else None
        if connection is None or tracked is None:
            return []
        if isinstance(event, ipc.VerdictEvent):
            return self._verdict(viewer, connection, event, tracked.label)
        if isinstance(event, ipc.EndingEvent) and event.id in connection.clicked:
            connection.clicked.remove(event.id)
            text = event_text.outcome_line(tracked.label, event)
            return [Notice(viewer, text, warning=not tracked.completed)]
        return []

    @staticmethod
    def _verdict(
        viewer: int, connection: _Connection, event: ipc.VerdictEvent, label: str
    ) -> list[Effect]:
        waiting = connection.waiting.pop(event.id, None)
        if waiting is None:
            return []
        sentence = event_text.refused_by_rule(event) or event.sentence or event.outcome
        accepted = event.outcome == "accepted"
        if waiting.call is not None:
            answer = Answer(accepted, sentence, event.code, event.operation, event.numbers)
            return [Reply(waiting.call, answer)]
        if accepted:
            connection.clicked.add(event.id)
        return [Notice(viewer, event_text.verdict_line(label, event), warning=not accepted)]

    # ---------------------------------------------------------------------- going, waiting

    def _gone(self, viewer: int) -> list[Effect]:
        self._buckets.pop(viewer, None)
        return [*self._ended(viewer), Close(viewer)] if viewer in self._connections else []

    def _ended(self, viewer: int) -> list[Effect]:
        """It is not trusted any more, and has to bring the code again."""
        connection = self._connections.pop(viewer, None)
        waiting = connection.waiting.values() if connection else ()
        ended = Answer(False, "the station has ended this viewer's connection", "OPERATOR_LOST")
        return [Reply(each.call, ended) for each in waiting if each.call is not None]

    def _overdue(self, now_ns: int) -> list[Effect]:
        replies: list[Effect] = []
        late = Answer(False, f"no answer within {CALL_WAIT_NS / 1e9:g} s", "NO_ANSWER")
        for connection in self._connections.values():
            for number, each in [*connection.waiting.items()]:
                if now_ns >= each.until_ns:
                    del connection.waiting[number]
                    replies += [Reply(each.call, late)] if each.call is not None else []
        return replies


def _refused(call: Called, code: str, sentence: str) -> Reply:
    return Reply(call.call, Answer(False, sentence, code))
