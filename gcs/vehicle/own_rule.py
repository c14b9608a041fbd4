"""The operator's own rule (`gcs fly --verifier FILE`): asked for every go-to before the gate is.

It can only refuse.  A go-to that the gate does not refuse at once waits here.  At the tick, one
that the gate would refuse goes to the gate, which says why; for any other one the rule is asked.
What it permits goes to the gate at the tick after, and is judged there as if there were no rule.
What it refuses, or has not answered in time, never reaches the gate.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import PurePath
from typing import Final

from gcs.enu_text import labelled_enu
from gcs.frames import enu_from_ned
from gcs.gate.effects import Level, Ruling, Verdict
from gcs.gate.inputs import Input, Requested
from gcs.gate.machine.gate import GOALS_WAIT_IN, Gate
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import GoTo
from gcs.session.effects import AskRule
from gcs.session.inputs import RuleSaid
from gcs.session.speedup_waits import Times
from gcs.session.work import GiveVerdict, Log, Work

NODE: Final = "own rule"
PATIENCE_NS: Final = 500_000_000
"""How long its answer is waited for; a rule that only computes takes less than a millisecond."""


@dataclass(slots=True)
class _Waiting:
    """A go-to that came.  `until_ns` is None as long as the rule was not asked."""

    requested: Requested
    goal: GoTo
    until_ns: int | None = None
    permitted: bool = False


class OwnRule:
    """Of one vehicle; at most one go-to waits, as in the gate."""

    def __init__(self, path: str, times: Times) -> None:
        self._name = PurePath(path).name
        self._patience_ns = times.real_ns(PATIENCE_NS)
        self._waiting: _Waiting | None = None
        self._reach_told = False

    def keeps(self, given: Input, gate: Gate, now_ns: int) -> list[Work] | None:
        """What follows from a go-to that waits from now on; None where `given` is for the gate."""
        if not isinstance(given, Requested) or not isinstance(given.request, GoTo):
            return None
        if _refuses(gate.would(given.request, given.source, now_ns, at_once=True)):
            return None
        newer = Refusal(Code.SUPERSEDED, "a newer request came before the tick")
        work = self._ended(Ruling.SUPERSEDED, newer)
        self._waiting = _Waiting(given, given.request)
        if not self._reach_told:
            self._reach_told = True
            reach = "is asked for every go-to; not for a take-off, a return, a mission or a stream"
            work.append(Log(Level.INFO, NODE, f"{self._name} {reach}"))
        return work

    def tick(self, gate: Gate, now_ns: int) -> tuple[Requested | None, list[Work]]:
        """Just before the gate's: the go-to that is for the gate now, and what else follows."""
        waiting, pos_ned = self._waiting, gate.memory.pos_ned
        if waiting is None:
            return None, []
        if waiting.until_ns is None:
            refused = _refuses(gate.would(waiting.goal, waiting.requested.source, now_ns))
            if not refused and pos_ned is None:
                return None, self._refused(Refusal(Code.NO_POSITION, "there is no position yet"))
            if not refused and pos_ned is not None:
                waiting.until_ns = now_ns + self._patience_ns
                goal_enu = enu_from_ned(waiting.goal.goal_ned)
                asked = f"asks {self._name} about {labelled_enu(goal_enu)}"
                return None, [
                    Log(Level.INFO, NODE, asked),
                    AskRule(waiting.requested.request_id, enu_from_ned(pos_ned), goal_enu),
                ]
        elif not waiting.permitted:
            if now_ns < waiting.until_ns:
                return None, []
            late = f"{self._name} did not answer within {PATIENCE_NS / 1e9:g} s"
            return None, self._refused(Refusal(Code.OWN_RULE_FAILED, late))
        self._waiting = None
        return waiting.requested, []

    def said(self, given: RuleSaid) -> list[Work]:
        """The rule's answer; one that comes too late is for nobody."""
        printed = [Log(Level.INFO, NODE, line) for line in given.printed.splitlines()]
        waiting = self._waiting
        if waiting is None or waiting.requested.request_id != given.request_id:
            return [*printed]
        if given.refusal is not None:
            code = Code.OWN_RULE_FAILED if given.failed else Code.OWN_RULE
            return [*printed, *self._refused(Refusal(code, given.refusal))]
        waiting.permitted = True
        return [*printed, Log(Level.INFO, NODE, f"{self._name} permits")]

    def after(self, gate: Gate) -> list[Work]:
        """As in the gate: where the vehicle does not hover any more, no go-to waits for it."""
        if self._waiting is None or gate.state in GOALS_WAIT_IN:
            return []
        return self._refused(Refusal(Code.NOT_FLYING, "the vehicle does not hover any more"))

    def _refused(self, refusal: Refusal) -> list[Work]:
        told = Log(Level.WARNING, NODE, f"Refused ({refusal.code}): {refusal.sentence}")
        return [*self._ended(Ruling.REFUSED, refusal), told]

    def _ended(self, ruling: Ruling, refusal: Refusal) -> list[Work]:
        waiting, self._waiting = self._waiting, None
        if waiting is None:
            return []
        request_id, goal_ned = waiting.requested.request_id, waiting.goal.goal_ned
        return [GiveVerdict(request_id, ruling, refusal, refusal.numbers, goal_ned)]


def _refuses(verdict: Verdict | None) -> bool:
    return verdict is not None and verdict.ruling is Ruling.REFUSED
