"""What guards and actions work with: the memory, the policy, the time, and a way to speak.

Motion leaves here as drafts.  Only `gate.py` can turn a draft into an effect, because only
there a permit is issued.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final, TypeAlias

from gcs.gate.airspace.verifier import Breach
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
    Verdict,
)
from gcs.gate.inputs import Requested
from gcs.gate.machine.events import Event
from gcs.gate.machine.memory import GATE, SECOND_NS, Goal, Memory, Task
from gcs.gate.machine.rules import Answer, End
from gcs.gate.machine.sentences import REFUSED, ended_because, where
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import FlightMode


@dataclass(frozen=True, slots=True)
class SetpointDraft:
    """A setpoint to a verified goal, not yet permitted."""

    goal: Goal
    reason: str


@dataclass(frozen=True, slots=True)
class CommandDraft:
    """A command, not yet permitted."""

    request_id: int
    kind: CommandKind
    deadline_ns: int
    reason: str
    up_m: float = 0.0
    mode_name: str = ""


Draft: TypeAlias = Effect | SetpointDraft | CommandDraft

MODE_OF: Final[Mapping[CommandKind, FlightMode]] = MappingProxyType(
    {
        CommandKind.HOLD: FlightMode.HOLD,
        CommandKind.GUIDED: FlightMode.GUIDED,
        CommandKind.LAND: FlightMode.LAND,
        CommandKind.RETURN: FlightMode.RETURN,
        CommandKind.START_MISSION: FlightMode.MISSION,
    }
)
"""The mode by which the heartbeat shows that the command took effect."""


class Turn:
    """One gate's inside, for the length of one `handle` call."""

    def __init__(self, policy: Policy, memory: Memory, now_ns: int) -> None:
        self.policy = policy
        self.memory = memory
        self.now_ns = now_ns
        self.out: list[Draft] = []
        self.raised: list[Event] = []
        self.requested: Requested | None = None
        self.breach: Breach | None = None
        self.why: Refusal | None = None
        self.evidence: tuple[tuple[str, float], ...] = ()

    # --------------------------------------------------------------------------- judging

    @property
    def severity(self) -> Severity:
        """Of all active conditions the worst wins."""
        severities = self.policy.severities
        return max(
            (severities[condition] for condition, _ in self.memory.conditions),
            default=Severity.NOMINAL,
        )

    def after_ns(self, seconds: float) -> int:
        return self.now_ns + round(seconds * SECOND_NS)

    @property
    def stale(self) -> bool:
        """The position is older than the policy allows, or there is none."""
        age_ns = self.memory.position_age_ns(self.now_ns)
        return age_ns is None or age_ns > round(self.policy.position_age_s * SECOND_NS)

    # -------------------------------------------------------------------------- speaking

    def say(self, level: Level, text: str) -> None:
        self.out.append(Say(level, text))

    def verdict(self, requested: Requested, ruling: Ruling, refusal: Refusal | None) -> None:
        """The one and only verdict on `request`."""
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
            self.say(Level.WARNING, f"Refused ({refusal.code}): {refusal.sentence}")

    def refuse(self, code: Code) -> None:
        """Refuse the present request; a check that objected has said why already."""
        assert self.requested is not None
        flown = self.memory.goal or self.memory.hold
        sentence = REFUSED.get(code, "it is not possible now")
        if code is Code.BUSY and flown is not None:
            sentence = f"{sentence}: {self.memory.state.name}, goal {where(flown.pos_ned)}"
        self.verdict(self.requested, Ruling.REFUSED, self.why or Refusal(code, sentence))

    # ------------------------------------------------------------------ tasks and outcomes

    def answer(self, answer: Answer, kind: Event, ends: End | None) -> None:
        """Accept the present request, as the table says."""
        memory = self.memory
        if answer is Answer.NONE or self.requested is None:
            return
        if answer is Answer.PENDING:
            self.supersede_pending()
            memory.pending = self.requested
            return
        self.verdict(self.requested, Ruling.ACCEPTED, None)
        if answer is Answer.DONE:
            self.out.append(
                Outcome(
                    self.requested.request_id, OutcomeKind.COMPLETE, None, "nothing is left to do"
                )
            )
            return
        self.supersede_pending()
        self.end(ends or End(OutcomeKind.SUPERSEDED, Code.SUPERSEDED))
        memory.task = Task(self.requested, kind)

    def supersede_pending(self) -> None:
        """The go-to that waits for its tick is overtaken before it got a verdict."""
        overtaken, self.memory.pending = self.memory.pending, None
        if overtaken is not None:
            refusal = Refusal(Code.SUPERSEDED, "a newer request came before the tick")
            self.verdict(overtaken, Ruling.SUPERSEDED, refusal)

    def refuse_pending(self, refusal: Refusal) -> None:
        """What is refused is gone: never queued, never replayed (invariant 4)."""
        refused, self.memory.pending = self.memory.pending, None
        if refused is not None:
            self.verdict(refused, Ruling.REFUSED, refusal)

    def end(self, end: End) -> None:
        """End the request under way, and stop every command that was sent for it."""
        memory = self.memory
        task, memory.task = memory.task, None
        why = self._why(end)
        if why is not None:
            self.refuse_pending(why)
        self.cancel_commands()
        if task is None:
            return
        code, sentence = (None, "Complete") if why is None else (why.code, why.sentence)
        self.out.append(Outcome(task.requested.request_id, end.kind, code, sentence))
        level = Level.INFO if end.kind is OutcomeKind.COMPLETE else Level.WARNING
        self.say(level, sentence if code is None else f"{task.kind}: {end.kind}: {sentence}")

    def _why(self, end: End) -> Refusal | None:
        """Why a request ends otherwise than complete, in the words of whoever said so."""
        if end.judged:
            assert self.why is not None
            return self.why
        if end.code is None:
            return None
        if end.code in (Code.VEHICLE_REFUSED, Code.FENCE_BREACH) and self.why is not None:
            return Refusal(end.code, self.why.sentence)
        if end.code is Code.SEVERITY:
            return Refusal(end.code, self.severity_sentence())
        return Refusal(end.code, ended_because(end.code))

    def severity_sentence(self) -> str:
        names = ", ".join(condition.value for condition, _ in self.memory.conditions)
        return f"severity is {self.severity.name}: {names}"

    def due(self, seconds: float | None) -> None:
        """Give the request under way so long from now; None: as long as it takes."""
        task = self.memory.task
        if task is not None:
            deadline_ns = None if seconds is None else self.after_ns(seconds)
            self.memory.task = replace(task, deadline_ns=deadline_ns)

    # -------------------------------------------------------------------------- commands

    def command(
        self, kind: CommandKind, reason: str, *, up_m: float = 0.0, own: bool = False
    ) -> None:
        """Ask the vehicle; where a mode will show the effect, wait for that mode."""
        memory, timeout_s = self.memory, self.policy.control.timeout_s
        task = None if own else memory.task
        request_id = GATE if task is None else task.requested.request_id
        seconds = 1.0 if kind is CommandKind.HOLD else timeout_s
        self.out.append(CommandDraft(request_id, kind, self.after_ns(seconds), reason, up_m=up_m))
        if (request_id, kind) not in memory.outstanding:
            memory.outstanding = (*memory.outstanding, (request_id, kind))
        mode = MODE_OF.get(kind)
        if mode is not None:
            self.await_mode(mode)
        if kind is CommandKind.GUIDED:
            memory.guided_until_ns = self.after_ns(2 * timeout_s)

    def await_mode(self, mode: FlightMode) -> None:
        self.memory.asked_mode = mode
        self.memory.asked_until_ns = self.after_ns(self.policy.control.timeout_s)

    def cancel_commands(self) -> None:
        """No retry of an abandoned command may leave; what comes of it late is reported."""
        for request_id, kind in self.memory.outstanding:
            self.out.append(CancelCommand(request_id, kind))
        self.memory.outstanding = ()
        self.memory.asked_mode = None
        self.memory.hold_again_ns = None
        self.memory.silence_told = None
