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

from gcs import ipc
from gcs.live.clicked_goals import BadMessageError, clicked_goal
from gcs.live.effects import Close, Effect, Join, Notice, Reply, Send
from gcs.live.inputs import Called, Ended, Gone, Input, Published, Tick, Told
from gcs.live.parameters import Parameters
from gcs.live.services import (
    SERVICES,
    Answer,
    BadCallError,
    TakeControl,
    ask_of,
    goal_height_m,
    request_of,
)
from gcs.operator import event_text
from gcs.operator.conversation import Conversation

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
MAX_BUCKETS = 256
"""Viewers whose rate of calls is remembered; of more, the one that came first is forgotten."""
NOTICE_NS = 2_000_000_000
"""A viewer's mistakes are told to all viewers, at most once in so long."""

TOO_MANY_CODES = "too many wrong control codes were tried: try again in 5 s"
NEEDS_CONTROL = "this viewer only looks: call take_control with the code that gcs has printed"


@dataclass(slots=True)
class _Waiting:
    """A request that the station has not answered; `call` 0: it was a clicked goal."""

    call: int
    until_ns: int


@dataclass(slots=True)
class _Bucket:
    """So many a second, and a few more at once."""

    per_second: float
    burst: float
    level: float
    at_ns: int

    def take(self, now_ns: int) -> bool:
        self.level = min(self.burst, self.level + (now_ns - self.at_ns) * self.per_second / 1e9)
        self.at_ns = now_ns
        if self.level < 1.0:
            return False
        self.level -= 1.0
        return True


@dataclass(slots=True)
class _Connection:
    """To the station: which requests wait for a verdict, and which clicked goals for an ending."""

    bucket: _Bucket
    talk: Conversation = field(default_factory=Conversation)
    waiting: dict[int, _Waiting] = field(default_factory=dict)
    clicked: set[int] = field(default_factory=set)


class Viewers:
    """All viewers of one live view."""

    def __init__(self, code: str, now_ns: int) -> None:
        """`code`: what `take_control` must bring."""
        self._code = code
        looking = _Bucket(LOOKING_A_SECOND, BURST_LOOKING, BURST_LOOKING, now_ns)
        self._connections = {LOOKING: _Connection(looking)}
        self._buckets: dict[int, _Bucket] = {}
        self._wrong_codes = _Bucket(
            WRONG_CODES_A_SECOND, BURST_WRONG_CODES, BURST_WRONG_CODES, now_ns
        )
        self._snapshot: ipc.Snapshot | None = None
        self._noticed_ns = now_ns - NOTICE_NS

    @property
    def trusted(self) -> frozenset[int]:
        """Viewers that have brought the code."""
        return frozenset(self._connections) - {LOOKING}

    def handle(self, given: Input, parameters: Parameters, now_ns: int) -> list[Effect]:
        """What follows from `given`; `parameters` are those of this moment."""
        match given:
            case Called():
                return self._called(given, parameters, now_ns)
            case Published():
                return self._published(given, parameters, now_ns)
            case Gone(viewer):
                return self._gone(viewer)
            case Told(viewer, event):
                return self._told(viewer, event)
            case Ended(viewer):
                return self._ended(viewer)
            case Tick():
                return self._overdue(now_ns)

    # ----------------------------------------------------------------------------- asking

    def _called(self, call: Called, parameters: Parameters, now_ns: int) -> list[Effect]:
        service = SERVICES.get(call.service)
        if service is None:
            return [_refused(call, "BAD_REQUEST", f"there is no service {call.service!r}")]
        trusted = call.viewer in self._connections
        if not self._bucket(call.viewer, now_ns).take(now_ns):
            return [_refused(call, "BUSY", f"more than {CALLS_A_SECOND:g} calls a second")]
        if not (trusted or service.anyone):
            return [_refused(call, "OTHER_OPERATOR", NEEDS_CONTROL)]
        try:
            request = request_of(call.service, call.payload)
            ask = ask_of(call.service, request, parameters, self._snapshot)
        except BadCallError as error:
            return [_refused(call, "BAD_REQUEST", str(error))]
        effects: list[Effect] = []
        if isinstance(request, TakeControl) and not trusted:
            why = self._why_not_trusted(call, request, now_ns)
            if why:
                told = self._notice(TOO_MANY_CODES, now_ns) if why == TOO_MANY_CODES else []
                return [_refused(call, "OTHER_OPERATOR", why), *told]
            bucket = self._bucket(call.viewer, now_ns)
            self._connections[call.viewer] = _Connection(bucket)
            effects.append(Join(call.viewer))
            trusted = True
        sender = call.viewer if trusted else LOOKING
        connection = self._connections[sender]
        if sender == LOOKING and not connection.bucket.take(now_ns):
            return [_refused(call, "BUSY", "the viewers that look ask for too much together")]
        if len(connection.waiting) >= MAX_WAITING:
            return [_refused(call, "BUSY", "too many calls wait for the station")]
        return [*effects, self._send(sender, ask, call.call, now_ns)]

    def _why_not_trusted(self, call: Called, request: TakeControl, now_ns: int) -> str:
        right = hmac.compare_digest(request.code.strip().encode(), self._code.encode())
        if not self._wrong_codes.take(now_ns):
            # Of the right one neither, so that a guess tells nothing.
            return TOO_MANY_CODES
        if not right:
            return "that is not the code that gcs has printed"
        self._wrong_codes.level += 1.0
        if not call.watching:
            return "subscribe to a topic first: else nobody would notice that this viewer has gone"
        if len(self._connections) > MAX_TRUSTED:
            return f"{MAX_TRUSTED} viewers can have control in turn, and that many are there"
        return ""

    def _published(self, message: Published, parameters: Parameters, now_ns: int) -> list[Effect]:
        connection = self._connections.get(message.viewer)
        if connection is None:
            return self._notice(NEEDS_CONTROL, now_ns)
        if not connection.bucket.take(now_ns) or len(connection.waiting) >= MAX_WAITING:
            return self._notice(f"more than {CALLS_A_SECOND:g} goals a second", now_ns)
        try:
            goal = clicked_goal(message.encoding, message.schema_name, message.data)
        except BadMessageError as error:
            return self._notice(str(error), now_ns)
        up_m = goal_height_m(parameters, self._snapshot)
        goal_enu = (goal.at_enu[0], goal.at_enu[1], up_m)
        ask = ipc.Ask(0, "goto", goal_enu=goal_enu, yaw_deg=goal.yaw_deg)
        return [self._send(message.viewer, ask, 0, now_ns)]

    def _send(self, sender: int, ask: ipc.Ask, call: int, now_ns: int) -> Send:
        connection = self._connections[sender]
        sent = connection.talk.ask(ask).sent
        connection.waiting[sent.id] = _Waiting(call, now_ns + CALL_WAIT_NS)
        return Send(sender, sent)

    def _bucket(self, viewer: int, now_ns: int) -> _Bucket:
        known = self._buckets.get(viewer)
        if known is None:
            if len(self._buckets) >= MAX_BUCKETS:
                del self._buckets[next(iter(self._buckets))]
            known = self._buckets[viewer] = _Bucket(
                CALLS_A_SECOND, BURST_CALLS, BURST_CALLS, now_ns
            )
        return known

    def _notice(self, text: str, now_ns: int) -> list[Effect]:
        if now_ns - self._noticed_ns < NOTICE_NS:
            return []
        self._noticed_ns = now_ns
        return [Notice(text, warning=True)]

    # ---------------------------------------------------------------------------- answers

    def _told(self, viewer: int, event: ipc.Event) -> list[Effect]:
        if isinstance(event, ipc.Snapshot):
            self._snapshot = event
        connection = self._connections.get(viewer)
        tracked = connection.talk.told(event) if connection else None
        if connection is None or tracked is None:
            return []
        if isinstance(event, ipc.VerdictEvent):
            return self._verdict(connection, event, tracked.label)
        if isinstance(event, ipc.EndingEvent) and event.id in connection.clicked:
            connection.clicked.remove(event.id)
            text = event_text.outcome_line(tracked.label, event)
            return [Notice(text, warning=not tracked.completed)]
        return []

    @staticmethod
    def _verdict(connection: _Connection, event: ipc.VerdictEvent, label: str) -> list[Effect]:
        waiting = connection.waiting.pop(event.id, None)
        if waiting is None:
            return []
        sentence = event_text.refused_by_rule(event) or event.sentence or event.outcome
        accepted = event.outcome == "accepted"
        if waiting.call:
            answer = Answer(accepted, sentence, event.code, event.operation, event.numbers)
            return [Reply(waiting.call, answer)]
        if accepted:
            connection.clicked.add(event.id)
        return [Notice(event_text.verdict_line(label, event), warning=not accepted)]

    # ---------------------------------------------------------------------- going, waiting

    def _gone(self, viewer: int) -> list[Effect]:
        self._buckets.pop(viewer, None)
        return [*self._ended(viewer), Close(viewer)] if viewer in self._connections else []

    def _ended(self, viewer: int) -> list[Effect]:
        """It is not trusted any more, and has to bring the code again."""
        connection = self._connections.pop(viewer, None)
        waiting = connection.waiting.values() if connection else ()
        ended = Answer(False, "the station has ended this viewer's connection", "OPERATOR_LOST")
        return [Reply(each.call, ended) for each in waiting if each.call]

    def _overdue(self, now_ns: int) -> list[Effect]:
        replies: list[Effect] = []
        late = Answer(False, f"no answer within {CALL_WAIT_NS / 1e9:g} s", "NO_ANSWER")
        for connection in self._connections.values():
            due = [n for n, each in connection.waiting.items() if now_ns >= each.until_ns]
            replies += [
                Reply(each.call, late) for n in due if (each := connection.waiting.pop(n)).call
            ]
        return replies


def _refused(call: Called, code: str, sentence: str) -> Reply:
    return Reply(call.call, Answer(False, sentence, code))
