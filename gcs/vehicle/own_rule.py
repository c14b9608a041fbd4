"""The operator's own rule (`gcs fly --verifier FILE`): asked for every way before the gate is.

It can only refuse.  A go-to, take-off, return, orbit or mission start that the gate does not refuse
at once waits here.  At the tick, one that the gate would refuse goes to the gate, which says why;
for any other one the rule is asked about its legs.  What it permits goes to the gate at the tick
after, and is judged there as if there were no rule.  What it refuses, or has not answered in time,
never reaches the gate; nor does a stream, whose legs nobody knows before it is flown.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import PurePath
from typing import Final, TypeAlias

from gcs.enu_text import labelled_enu
from gcs.frames import Vec3, enu_from_ned
from gcs.gate.airspace.separation import Leg
from gcs.gate.effects import Level, Ruling, Verdict
from gcs.gate.inputs import Input, OperatorLost, Requested
from gcs.gate.machine.events import Event, event_of
from gcs.gate.machine.gate import GOALS_WAIT_IN, Gate
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import GoTo, Request
from gcs.session.effects import AskRule
from gcs.session.inputs import RuleSaid
from gcs.session.speedup_waits import Times
from gcs.session.work import GiveVerdict, Log, Work

NODE: Final = "own rule"
PATIENCE_NS: Final = 500_000_000
"""How long its answer is waited for; a rule that only computes takes less than a millisecond."""
MOST_LEGS: Final = 400
"""So many are half of what a pipe holds that is not read."""
_MM: Final = 3

_ASKED_FOR: Final = frozenset(
    {Event.GOTO, Event.TAKE_OFF, Event.RETURN, Event.MISSION, Event.STREAM_BEGIN}
)
_STOPS: Final = frozenset({Event.ABORT, Event.HOLD, Event.LAND, Event.DISARM, Event.FORCE_DISARM})
_LANDS: Final = frozenset({Event.RETURN, Event.MISSION})
"""What comes down at its end, as by a landing, which the rule is not asked for."""
STRAIGHT_DOWN_M: Final = 0.1
LegsOf: TypeAlias = Callable[[Requested, Vec3], Sequence[Leg]]
"""What a request leads along, from where the vehicle is (local NED)."""


def is_asked_for(request: Request) -> bool:
    """Whether an own rule is asked before the gate is."""
    return event_of(request) in _ASKED_FOR


@dataclass(slots=True)
class _Waiting:
    """A request that came.  `until_ns` is None as long as the rule was not asked."""

    requested: Requested
    until_ns: int | None = None
    permitted: bool = False
    stopped: bool = False


class OwnRule:
    """Of one vehicle; at most one request waits, as of goals in the gate."""

    def __init__(self, path: str, times: Times) -> None:
        self._name = PurePath(path).name
        self._patience_ns = times.real_ns(PATIENCE_NS)
        self._waiting: _Waiting | None = None
        self._reach_told = False

    @property
    def no_legs(self) -> Refusal:
        """Of a stream: its samples are not known before they are to be flown."""
        sentence = f"{self._name} is asked about legs, and of this none is known beforehand"
        return Refusal(Code.OWN_RULE, sentence)

    def keeps(self, given: Input, gate: Gate, now_ns: int) -> list[Work] | None:
        """What follows from a request that waits from now on; None where `given` is for the
        gate."""
        event = event_of(given.request) if isinstance(given, Requested) else None
        if self._waiting is not None and (event in _STOPS or isinstance(given, OperatorLost)):
            self._waiting.stopped = True
        if not isinstance(given, Requested) or event not in _ASKED_FOR:
            return None
        if _refuses(gate.would(given.request, given.source, now_ns, at_once=True)):
            return None
        newer = Refusal(Code.SUPERSEDED, "a newer request came before the tick")
        work = self._ended(Ruling.SUPERSEDED, newer)
        self._waiting = _Waiting(given)
        if not self._reach_told:
            self._reach_told = True
            reach = "is asked for every leg of a go-to, take-off, return, orbit or mission"
            work.append(Log(Level.INFO, NODE, f"{self._name} {reach}; a stream is refused"))
        return work

    def tick(self, gate: Gate, legs_of: LegsOf, now_ns: int) -> tuple[Requested | None, list[Work]]:
        """Just before the gate's: the request that is for the gate now, and what else follows."""
        waiting = self._waiting
        if waiting is None:
            return None, []
        requested = waiting.requested
        if waiting.until_ns is None:
            if not _refuses(gate.would(requested.request, requested.source, now_ns)):
                waiting.until_ns = now_ns + self._patience_ns
                return None, self._ask(requested, gate.memory.pos_ned, legs_of)
        elif not waiting.permitted:
            if now_ns < waiting.until_ns:
                return None, []
            late = f"{self._name} did not answer within {PATIENCE_NS / 1e9:g} s"
            return None, self._refused(Refusal(Code.OWN_RULE_FAILED, late))
        self._waiting = None
        return requested, []

    def _ask(self, requested: Requested, pos_ned: Vec3 | None, legs_of: LegsOf) -> list[Work]:
        if pos_ned is None:
            return self._refused(Refusal(Code.NO_POSITION, "there is no position yet"))
        legs = legs_of(requested, pos_ned)
        if event_of(requested.request) in _LANDS:
            legs = [leg for leg in legs if not _comes_down(leg)]
        if not legs:
            return self._refused(self.no_legs)
        if len(legs) > MOST_LEGS:
            long = f"{len(legs)} legs: {self._name} is asked about {MOST_LEGS} at the most"
            return self._refused(Refusal(Code.OWN_RULE, long))
        legs_enu = tuple((_enu(start_ned), _enu(end_ned)) for start_ned, end_ned in legs)
        about = f"{len(legs)} legs" if len(legs) > 1 else labelled_enu(legs_enu[0][1])
        asked = Log(Level.INFO, NODE, f"asks {self._name} about {about}")
        return [asked, AskRule(requested.request_id, legs_enu)]

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
        """As in the gate: after a stop nothing is flown that was asked for before it, and where the
        vehicle does not hover any more, no go-to waits for it."""
        waiting = self._waiting
        if waiting is None:
            return []
        if isinstance(waiting.requested.request, GoTo) and gate.state not in GOALS_WAIT_IN:
            return self._refused(Refusal(Code.NOT_FLYING, "the vehicle does not hover any more"))
        if waiting.stopped:
            stopped = Refusal(Code.SUPERSEDED, "the vehicle was stopped meanwhile")
            return self._ended(Ruling.SUPERSEDED, stopped)
        return []

    def _refused(self, refusal: Refusal) -> list[Work]:
        told = Log(Level.WARNING, NODE, f"Refused ({refusal.code}): {refusal.sentence}")
        return [*self._ended(Ruling.REFUSED, refusal), told]

    def _ended(self, ruling: Ruling, refusal: Refusal) -> list[Work]:
        waiting, self._waiting = self._waiting, None
        if waiting is None:
            return []
        request_id, request = waiting.requested.request_id, waiting.requested.request
        goal_ned = request.goal_ned if isinstance(request, GoTo) else None
        return [GiveVerdict(request_id, ruling, refusal, refusal.numbers, goal_ned)]


def _refuses(verdict: Verdict | None) -> bool:
    return verdict is not None and verdict.ruling is Ruling.REFUSED


def _comes_down(leg: Leg) -> bool:
    (north, east, down), (to_north, to_east, to_down) = leg
    return to_down > down and math.hypot(to_north - north, to_east - east) <= STRAIGHT_DOWN_M


def _enu(place_ned: Vec3) -> Vec3:
    east, north, up = enu_from_ned(place_ned)
    return (round(east, _MM), round(north, _MM), round(up, _MM))
