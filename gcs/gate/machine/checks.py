"""The checks: conditions for accepting a request, which give the refusal where they fail."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from typing import Self

from gcs.gate.condition import Condition, Severity
from gcs.gate.machine import verifying
from gcs.gate.machine.pacing import may_have
from gcs.gate.machine.step_context import StepContext
from gcs.gate.refusal import Code, Refusal


def _severity(step: StepContext, but: Condition | None = None) -> Refusal | None:
    """By all conditions: a vehicle that is on its way back inside begins nothing else."""
    names = [name for name, _ in step.memory.conditions if name is not but]
    worst = max((step.policy.severities[name] for name in names), default=Severity.NOMINAL)
    if worst < Severity.HOLD:
        return None
    sentence = f"severity is {worst.name}: {', '.join(name.value for name in names)}"
    return Refusal(Code.SEVERITY, sentence, (("severity", float(worst)),))


def _severity_but_fence(step: StepContext) -> Refusal | None:
    """That it is outside does not forbid to fly back inside."""
    return _severity(step, but=Condition.FENCE_BREACHED)


def _recorder(step: StepContext) -> Refusal | None:
    failed = any(name is Condition.RECORDER_FAILED for name, _ in step.memory.conditions)
    if step.policy.arm_requires_recording and failed:
        sentence = "nothing is recorded, and the policy wants it so: arm_requires_recording = true"
        return Refusal(Code.RECORDER_DOWN, sentence)
    return None


def _preflight(step: StepContext) -> Refusal | None:
    failing = [text for name, text in step.memory.conditions if name is Condition.PREFLIGHT_FAILED]
    if step.policy.arming.preflight == "no_fail" and failing:
        sentence = f'{failing[0]} (policy: preflight = "no_fail"; gcs preflight)'
        return Refusal(Code.PREFLIGHT, sentence)
    return None


def _armed(step: StepContext) -> Refusal | None:
    if step.memory.armed:
        return None
    return Refusal(Code.NOT_ARMED, "the vehicle is not armed: arm it first")


def _on_ground(step: StepContext) -> Refusal | None:
    if step.memory.on_ground:
        return None
    return Refusal(Code.IN_AIR, "the vehicle is not known to stand on the ground")


def _mission(step: StepContext) -> Refusal | None:
    if step.memory.mission_items > 0:
        return None
    return Refusal(Code.NO_MISSION, "no verified mission is on board: upload one first")


def _home_and_fence(step: StepContext) -> Refusal | None:
    return verifying.home_or_fence_unknown() if step.memory.verifier is None else None


def _position(step: StepContext) -> Refusal | None:
    """Taken off its leg, the vehicle stops from the speed that it has gained there; one that is
    held already does not stop worse."""
    flies = step.memory.goal is not None
    return verifying.position(step, may_have(step, None) if flies else ())


def _refused(
    text: str, refusal: Callable[[StepContext], Refusal | None]
) -> tuple[str, Callable[[StepContext], Refusal | None]]:
    """A member of `Check`; in a bare pair the types would not be checked."""
    return text, refusal


class Check(StrEnum):
    """A condition for accepting a request: its text in the printed table, and the function that
    gives the refusal, or None where it passes."""

    refusal: Callable[[StepContext], Refusal | None]

    def __new__(cls, text: str, refusal: Callable[[StepContext], Refusal | None]) -> Self:
        member = str.__new__(cls, text)
        member._value_ = text
        member.refusal = refusal
        return member

    SEVERITY = _refused("severity permits motion", _severity)
    RECORDER = _refused("the recorder runs where policy asks for it", _recorder)
    PREFLIGHT = _refused("nothing fails before a take-off where policy asks for it", _preflight)
    ARMED = _refused("it is armed", _armed)
    ON_GROUND = _refused("it stands on the ground", _on_ground)
    SEVERITY_BUT_FENCE = _refused("nothing but the fence forbids motion", _severity_but_fence)
    POSITION = _refused("the present position clears", _position)
    CLIMB = _refused("the climb clears", verifying.climb)
    MISSION = _refused("a verified mission is on board", _mission)
    HOME_AND_FENCE = _refused("home and fence are known", _home_and_fence)
