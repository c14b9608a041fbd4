"""One step of a gate, seen from outside: before, input, effects, after."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from gcs.gate.condition import Severity
from gcs.gate.effects import CommandKind, Effect, Ruling, SendCommand, SendSetpoint, Verdict
from gcs.gate.inputs import Input, PositionSeen, Requested
from gcs.gate.machine.memory import SECOND_NS, Memory
from gcs.gate.policy.policy import Policy
from gcs.gate.requests import Request
from gcs.gate.states import LandedState, State
from tests.proof.questions import WatchedMemory


@dataclass(frozen=True, slots=True)
class Objection:
    """Which invariant is broken (0: the machine's own soundness), and how."""

    invariant: int
    sentence: str

    def __str__(self) -> str:
        return f"invariant {self.invariant}: {self.sentence}"


def same(before: Memory, after: Memory, name: str) -> bool:
    """Whether the field `name` was left as it was.  A watched memory is not asked for it."""
    if isinstance(before, WatchedMemory) and isinstance(after, WatchedMemory):
        read = before.questions.values.get(name)
        return before.__dict__.get(name, read) is after.__dict__.get(name, read)
    return getattr(before, name) is getattr(after, name)


@dataclass(frozen=True, slots=True)
class Edge:
    """One `handle` call."""

    policy: Policy
    before: Memory
    given: Input
    now_ns: int
    effects: Sequence[Effect]
    after: Memory

    @property
    def request(self) -> Request | None:
        return self.given.request if isinstance(self.given, Requested) else None

    @property
    def verdict(self) -> Verdict | None:
        """The verdict on the request that this step brought, if it is in yet."""
        if isinstance(self.given, Requested):
            for effect in self.effects:
                if isinstance(effect, Verdict) and effect.request_id == self.given.request_id:
                    return effect
        return None

    @property
    def accepted(self) -> bool:
        return self.verdict is not None and self.verdict.ruling is Ruling.ACCEPTED

    @property
    def commands(self) -> list[CommandKind]:
        return [effect.kind for effect in self.effects if isinstance(effect, SendCommand)]

    @property
    def setpoints(self) -> list[SendSetpoint]:
        return [effect for effect in self.effects if isinstance(effect, SendSetpoint)]

    @property
    def stale(self) -> bool:
        """The position was too old (or absent) when the step came."""
        age_ns = self.before.position_age_ns(self.now_ns)
        return age_ns is None or age_ns > self.policy.position_age_s * SECOND_NS

    @property
    def overtaken(self) -> bool:
        """It brings a position that is older, by the vehicle's own stamps, than one that was heard
        before: nothing follows from it."""
        given = self.given
        if not isinstance(given, PositionSeen) or given.reset:
            return False
        return given.time_boot_ms < self.before.boot_ms

    @property
    def mode_overdue(self) -> bool:
        """A commanded mode was overdue when the step came, and no tick had come since."""
        before = self.before
        awaited = before.asked_mode is not None and before.hold_again_ns is None
        return awaited and self.now_ns >= before.asked_until_ns

    @property
    def task_overdue(self) -> bool:
        """The request under way was overdue when the step came, and no tick had come since."""
        task = self.before.task
        deadline_ns = None if task is None else task.deadline_ns
        return deadline_ns is not None and self.now_ns >= deadline_ns

    @property
    def stands(self) -> bool:
        """Surely on the ground: disarmed and not reported to fly, or reported there of late and
        seen no higher since, with nothing under way that lifts it."""
        before = self.before
        age_s = self.policy.heartbeat_age_s
        fresh = before.landed_ns is not None and (
            self.now_ns - before.landed_ns < age_s * SECOND_NS
        )
        if not before.armed:
            return not (fresh and before.airborne)
        lifts = self.now_ns < before.takeoff_until_ns or before.flown_state is State.TAKING_OFF
        told = fresh and before.landed is LandedState.ON_GROUND
        return told and not before.climbed and not lifts

    @property
    def severity(self) -> Severity:
        """As it is after the step."""
        return severity_of(self.policy, self.after)


def severity_of(policy: Policy, memory: Memory) -> Severity:
    """Of all conditions the worst."""
    severities = policy.severities
    return max((severities[name] for name in memory.counted_conditions), default=Severity.NOMINAL)
