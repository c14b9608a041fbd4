"""What each `Check` of the table does: it returns the refusal, or None where it passes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

from gcs.gate.condition import Condition, Severity
from gcs.gate.machine import verifying
from gcs.gate.machine.pacing import may_have
from gcs.gate.machine.rules import Check
from gcs.gate.machine.turn import Turn
from gcs.gate.refusal import Code, Refusal


def _severity(turn: Turn, but: Condition | None = None) -> Refusal | None:
    """By all conditions: a vehicle that is on its way back inside begins nothing else."""
    names = [name for name, _ in turn.memory.conditions if name is not but]
    worst = max((turn.policy.severities[name] for name in names), default=Severity.NOMINAL)
    if worst < Severity.HOLD:
        return None
    sentence = f"severity is {worst.name}: {', '.join(name.value for name in names)}"
    return Refusal(Code.SEVERITY, sentence, (("severity", float(worst)),))


def _severity_but_fence(turn: Turn) -> Refusal | None:
    """That it is outside does not forbid to fly back inside."""
    return _severity(turn, but=Condition.FENCE_BREACHED)


def _recorder(turn: Turn) -> Refusal | None:
    failed = any(name is Condition.RECORDER_FAILED for name, _ in turn.memory.conditions)
    if turn.policy.arm_requires_recording and failed:
        sentence = "nothing is recorded, and the policy wants it so: arm_requires_recording = true"
        return Refusal(Code.RECORDER_DOWN, sentence)
    return None


def _armed(turn: Turn) -> Refusal | None:
    if turn.memory.armed:
        return None
    return Refusal(Code.NOT_ARMED, "the vehicle is not armed: arm it first")


def _on_ground(turn: Turn) -> Refusal | None:
    if turn.memory.on_ground:
        return None
    return Refusal(Code.IN_AIR, "the vehicle is not known to stand on the ground")


def _mission(turn: Turn) -> Refusal | None:
    if turn.memory.mission_items > 0:
        return None
    return Refusal(Code.NO_MISSION, "no verified mission is on board: upload one first")


def _home_and_fence(turn: Turn) -> Refusal | None:
    return verifying.home_or_fence_unknown() if turn.memory.verifier is None else None


def _position(turn: Turn) -> Refusal | None:
    """Taken off its leg, the vehicle stops from the speed that it has gained there; one that is
    held already does not stop worse."""
    flies = turn.memory.goal is not None
    return verifying.position(turn, may_have(turn, None) if flies else ())


CHECKS: Final[Mapping[Check, Callable[[Turn], Refusal | None]]] = MappingProxyType(
    {
        Check.SEVERITY: _severity,
        Check.SEVERITY_BUT_FENCE: _severity_but_fence,
        Check.RECORDER: _recorder,
        Check.ARMED: _armed,
        Check.ON_GROUND: _on_ground,
        Check.POSITION: _position,
        Check.CLIMB: verifying.climb,
        Check.MISSION: _mission,
        Check.HOME_AND_FENCE: _home_and_fence,
    }
)
"""A test asserts that every `Check` is here."""
