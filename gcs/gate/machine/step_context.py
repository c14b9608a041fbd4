"""The working state of one `Gate.handle` call, which guards and actions share.

It holds the memory, the policy, the time, and the effects so far.  What moves the vehicle is
added as a draft: only `gate.py` makes an effect of it, because only there a permit is issued.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from enum import Enum
from types import MappingProxyType
from typing import Final, TypeAlias

from gcs.gate.airspace.questions.braking import Breach
from gcs.gate.airspace.stream_samples import StreamSample
from gcs.gate.condition import Severity
from gcs.gate.effects import (
    CancelCommand,
    CommandKind,
    Effect,
    Level,
    Outcome,
    OutcomeKind,
    Ruling,
    Say,
    StreamVerdict,
    Verdict,
)
from gcs.gate.inputs import Requested, StreamSeen
from gcs.gate.machine.events import Event
from gcs.gate.machine.memory import GATE, SECOND_NS, Goal, Memory, Task
from gcs.gate.machine.sentences import ENDED, done_at_once, not_shown, refusal_of, turn_left
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import BeginStream, Request
from gcs.gate.states import Control, FlightMode, State

NOT_HEARD: Final = frozenset({State.STALE, State.NO_VEHICLE})
"""States in which the vehicle may not hear us either."""


@dataclass(frozen=True, slots=True)
class SetpointDraft:
    """A setpoint to a verified goal, still without its permit."""

    goal: Goal
    reason: str


@dataclass(frozen=True, slots=True)
class SampleDraft:
    """A client's verified sample as a setpoint, still without its permit."""

    sample: StreamSample
    reason: str


@dataclass(frozen=True, slots=True)
class CommandDraft:
    """A command, still without its permit."""

    request_id: int
    kind: CommandKind
    deadline_ns: int
    reason: str
    up_m: float
    mode_name: str = ""
    seq: int | None = None


Draft: TypeAlias = Effect | SetpointDraft | SampleDraft | CommandDraft

MODE_OF: Final[Mapping[CommandKind, FlightMode]] = MappingProxyType(
    {
        CommandKind.HOLD: FlightMode.HOLD,
        CommandKind.GUIDED: FlightMode.GUIDED,
        CommandKind.LAND: FlightMode.LAND,
        CommandKind.RETURN: FlightMode.RETURN,
        CommandKind.START_MISSION: FlightMode.MISSION,
    }
)
"""The mode in which the heartbeat shows that a command took effect."""


REFUSED_LINE: Final = "Refused "
REFUSED_STREAM_LINE: Final = "Stream refused "
"""How the line of a refusal begins."""

SAID: Final = frozenset({Code.SUPERSEDED, Code.OPERATOR, Code.OPERATOR_LOST, Code.FENCE_BREACH})
"""Reasons for an end that are said where they come up."""


class Reply(Enum):
    """What a branch replies to a request that it does not refuse.

    NONE is for events that are not requests.  PENDING gives no verdict yet: the request waits
    for the next tick.
    """

    NONE = "none"
    ACCEPTED = "accepted"
    DONE = "accepted, complete at once"
    PENDING = "pending until the tick"


@dataclass(frozen=True, slots=True)
class End:
    """The outcome of the request under way; a goal that is still pending is refused with the code.

    `judged` True: the code and the sentence are those of the refusal that caused the event.
    `goes_on` True: nobody waits for it any more, and what it commanded goes on all the same.
    """

    kind: OutcomeKind
    code: Code | None = None
    judged: bool = False
    goes_on: bool = False


class StepContext:
    """The working state of one `Gate.handle` call.

    `out` is what leaves the gate, in order; `raised` are events that an action causes and that
    are handled next; `requested` and `streamed` are the request or the sample of a stream that came
    in, if one did.  `why` is the reason
    for the present event, or of the verifier's last refusal; `evidence` the numbers of its last
    clearance; `breach` the predicted breach that is the present event.
    """

    def __init__(self, policy: Policy, memory: Memory, now_ns: int) -> None:
        self.policy = policy
        self.memory = memory
        self.now_ns = now_ns
        self.out: list[Draft] = []
        self.raised: list[Event] = []
        self.requested: Requested | None = None
        self.streamed: StreamSeen | None = None
        self.breach: Breach | None = None
        self.why: Refusal | None = None
        self.evidence: tuple[tuple[str, float], ...] = ()

    # -------------------------------------------------------------------- severity and time

    @property
    def severity(self) -> Severity:
        """The worst of all active conditions."""
        severities = self.policy.severities
        return max(
            (severities[condition] for condition in self.memory.counted_conditions),
            default=Severity.NOMINAL,
        )

    def after_ns(self, seconds: float) -> int:
        """The time so many seconds from now."""
        return self.now_ns + round(seconds * SECOND_NS)

    @property
    def stale(self) -> bool:
        """The position is older than the policy allows, or there is none."""
        age_ns = self.memory.position_age_ns(self.now_ns)
        return age_ns is None or age_ns > round(self.policy.position_age_s * SECOND_NS)

    # ----------------------------------------------------------------------------- verdicts

    def say(self, level: Level, text: str) -> None:
        """Add a line for the operator and the log."""
        self.out.append(Say(level, text))

    def verdict(self, requested: Requested, ruling: Ruling, refusal: Refusal | None) -> None:
        """Give the one verdict on `requested`."""
        memory = self.memory
        flown = memory.goal or memory.hold
        self.out.append(
            Verdict(
                requested.request_id,
                requested.source,
                requested.request,
                ruling,
                refusal,
                None if flown is None else flown.pos_ned,
                self.evidence if refusal is None else refusal.numbers,
            )
        )
        if ruling is Ruling.REFUSED and refusal is not None:
            self.say(Level.WARNING, f"{REFUSED_LINE}({refusal.code}): {refusal.sentence}")

    def refuse(self, code: Code) -> None:
        """Refuse the present request or sample: for the reason `why` where there is one, else with
        the sentence for `code`."""
        if self.streamed is not None:
            judged = self.why or self._refusal(code, BeginStream())
            self._refuse_sample(judged)
            return
        assert self.requested is not None
        refusal = self.why or self._refusal(code, self.requested.request)
        self.verdict(self.requested, Ruling.REFUSED, refusal)

    def _refusal(self, code: Code, request: Request) -> Refusal:
        return refusal_of(code, request, self.memory, self.policy, self.now_ns)

    # ------------------------------------------------------------------------------ streams

    @property
    def source(self) -> str:
        """Who asks, or whose sample it is."""
        given = self.requested or self.streamed
        return "" if given is None else given.source

    def _refuse_sample(self, refusal: Refusal) -> None:
        """Tell the client once: when samples of its stream begin to be refused; where it flies no
        stream, for each reason once as long as samples come."""
        assert self.streamed is not None
        memory, source = self.memory, self.streamed.source
        if memory.state is State.STREAMING and source == memory.streamer:
            self.refuse_stream(refusal)
            return
        silent_ns = self.now_ns - memory.refused_elsewhere_ns
        if silent_ns > round(self.policy.stream.ends_after_s * SECOND_NS):
            memory.refused_elsewhere = ()
        memory.refused_elsewhere_ns = self.now_ns
        if (source, refusal.code) not in memory.refused_elsewhere:
            memory.refused_elsewhere = (*memory.refused_elsewhere, (source, refusal.code))
            self._tell_refused(source, refusal)

    def refuse_stream(self, refusal: Refusal) -> None:
        """The stream that is flown is refused from now on; told where that is news."""
        memory = self.memory
        memory.good_since_ns = None
        if not memory.stream_refused:
            memory.stream_refused = True
            self._tell_refused(memory.streamer, refusal)

    def _tell_refused(self, source: str, refusal: Refusal) -> None:
        self.out.append(StreamVerdict(source, refusal, refusal.numbers))
        self.say(Level.WARNING, f"{REFUSED_STREAM_LINE}({refusal.code}): {refusal.sentence}")

    # ------------------------------------------------------------------ tasks and outcomes

    def reply(self, reply: Reply, kind: Event, ends: End | None) -> None:
        """Accept the present request, or keep it until the tick, as the table says.

        `kind` is the request's event, `ends` the outcome of the request that it displaces.
        """
        memory = self.memory
        assert self.requested is not None
        if reply is Reply.DONE and not_shown(self.requested.request, memory):
            self.refuse(Code.NOT_FLYING)
            return
        if reply is Reply.PENDING:
            self.supersede_pending()
            memory.pending = self.requested
            return
        self.verdict(self.requested, Ruling.ACCEPTED, None)
        if reply is Reply.DONE:
            done = done_at_once(self.requested.request)
            request_id = self.requested.request_id
            self.out.append(Outcome(request_id, OutcomeKind.COMPLETE, None, done))
            return
        self.supersede_pending()
        memory.hold_again_ns = None  # the new request takes the place of a hold, too
        memory.hold_requested = kind in (Event.HOLD, Event.ABORT)
        self.end(ends or End(OutcomeKind.SUPERSEDED, Code.SUPERSEDED))
        memory.task = Task(self.requested, kind)

    def supersede_pending(self) -> None:
        """A newer request replaces the go-to that waits for its tick, before its verdict."""
        pending, self.memory.pending = self.memory.pending, None
        if pending is not None:
            refusal = Refusal(Code.SUPERSEDED, "a newer request came before the tick")
            self.verdict(pending, Ruling.SUPERSEDED, refusal)

    def refuse_pending(self, refusal: Refusal) -> None:
        """Refuse the go-to that waits for its tick.  It is forgotten: never queued, never sent
        later (invariant 4)."""
        pending, self.memory.pending = self.memory.pending, None
        if pending is not None:
            self.verdict(pending, Ruling.REFUSED, refusal)

    def end(self, end: End) -> None:
        """Give the request under way its outcome, and cancel every command that was sent for it.

        A HOLD that is not shown yet outlives its request: it is commanded again when it is due.
        What `goes_on` outlives it whole.  Where we fly without a request, the reason is said.  Also
        refuses a pending go-to, unless the outcome is COMPLETE.
        """
        memory = self.memory
        task, memory.task = memory.task, None
        why = self._why(end)
        if why is not None:
            self.refuse_pending(why)
        if not end.goes_on:
            hold_again_ns = memory.hold_again_ns
            self.cancel_commands()
            memory.hold_again_ns = hold_again_ns
        if task is None:
            if why is not None and memory.control is not Control.NONE and why.code not in SAID:
                self.say(Level.WARNING, why.sentence)
            return
        code, sentence = (None, "Complete") if why is None else (why.code, why.sentence)
        taken = task.kind is Event.PHOTO and code is None and memory.photo_index is not None
        numbers = (("picture", float(memory.photo_index or 0)),) if taken else ()
        self.out.append(Outcome(task.requested.request_id, end.kind, code, sentence, numbers))
        level = Level.INFO if end.kind is OutcomeKind.COMPLETE else Level.WARNING
        # The lab's word, and of what.
        done = f"Complete: {task.kind}"
        self.say(level, done if code is None else f"{task.kind}: {end.kind}: {sentence}")

    def _why(self, end: End) -> Refusal | None:
        """Code and sentence of an outcome; None where it is COMPLETE."""
        if end.judged:
            assert self.why is not None
            return self.why
        if end.code is None:
            return None
        if end.code in (Code.VEHICLE_REFUSED, Code.FENCE_BREACH) and self.why is not None:
            return Refusal(end.code, self.why.sentence)
        if end.code is Code.SEVERITY:
            return Refusal(end.code, self.severity_sentence())
        if end.code is Code.MODE_CHANGED and self.memory.failsafe:
            sentence = f"a failsafe of the vehicle's own took over: {self.memory.mode_name}"
            return Refusal(Code.VEHICLE_FAILSAFE, sentence)
        left_deg = self.memory.turn_left_deg(self.policy.arrival.yaw_deg)
        if end.code is Code.DEADLINE and left_deg:
            return Refusal(end.code, f"{ENDED[end.code]}: {turn_left(left_deg)}")
        if end.goes_on:
            return Refusal(end.code, f"{ENDED[end.code]}; the vehicle goes on by itself")
        return Refusal(end.code, ENDED[end.code])

    def severity_sentence(self) -> str:
        """The severity, and the conditions that are active."""
        names = ", ".join(condition.value for condition, _ in self.memory.conditions)
        return f"severity is {self.severity.name}: {names}"

    def set_deadline(self, seconds: float | None) -> None:
        """Give the request under way so many seconds from now; None: as long as it takes."""
        task = self.memory.task
        if task is not None:
            deadline_ns = None if seconds is None else self.after_ns(seconds)
            self.memory.task = replace(task, deadline_ns=deadline_ns)

    # -------------------------------------------------------------------------- commands

    def command(
        self,
        kind: CommandKind,
        reason: str,
        *,
        up_m: float = 0.0,
        seq: int | None = None,
        own: bool = False,
    ) -> None:
        """Send a command in the name of the request under way, or of the gate itself (`own`).

        Where a mode shows the effect of the command, that mode is awaited from now on.
        """
        memory, timeout_s = self.memory, self.policy.control.timeout_s
        task = None if own else memory.task
        request_id = GATE if task is None else task.requested.request_id
        seconds = self.policy.control.hold_every_s if kind is CommandKind.HOLD else timeout_s
        deadline_ns = self.after_ns(seconds)
        self.out.append(CommandDraft(request_id, kind, deadline_ns, reason, up_m=up_m, seq=seq))
        if (request_id, kind) not in memory.outstanding:
            memory.outstanding = (*memory.outstanding, (request_id, kind))
        mode = MODE_OF.get(kind)
        if mode is not None:
            self.await_mode(mode)
        if kind is CommandKind.GUIDED:
            memory.guided_until_ns = self.after_ns(2 * timeout_s)

    def await_mode(self, mode: FlightMode) -> None:
        """Expect the heartbeat to show `mode` within the policy's time."""
        self.memory.asked_mode = mode
        self.memory.asked_until_ns = self.after_ns(self.policy.control.timeout_s)

    def cancel_commands(self) -> None:
        """Forget every command that has no answer yet: it is not sent again, and an answer or an
        effect that comes later is only reported."""
        for request_id, kind in self.memory.outstanding:
            self.out.append(CancelCommand(request_id, kind))
        self.memory.outstanding = ()
        self.memory.asked_mode = None
        self.memory.hold_again_ns = None
        if self.memory.state not in NOT_HEARD:
            # Of one that is not heard, once is enough until it answers again.
            self.memory.silence_reported = None
