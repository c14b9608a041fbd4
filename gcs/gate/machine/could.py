"""Whether the gate would do what may be asked for: arm the vehicle now; give control of it back
once it is held, and fly it to a goal from there.  Asked before anything is stopped, or a hold is
lifted.
"""

from __future__ import annotations

from typing import Final

from gcs.frames import Vec3
from gcs.gate.airspace.questions.back_inside import WayBack
from gcs.gate.machine.checks import Check
from gcs.gate.machine.memory import Memory
from gcs.gate.machine.rows.requests_to_fly import arm
from gcs.gate.machine.sentences import REFUSED, no_fresh_position, position_too_old
from gcs.gate.machine.step_context import StepContext
from gcs.gate.machine.verifying import home_or_fence_unknown
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import State

AT_REST: Final[Vec3] = (0.0, 0.0, 0.0)


def why_not_arm(policy: Policy, memory: Memory, now_ns: int) -> Refusal | None:
    """The refusal that a request to arm would get; None where it would be carried out.

    Asks the checks of the table's own row, and changes nothing.
    """
    step = StepContext(policy, memory, now_ns)
    if memory.state is State.STALE or step.stale:
        return position_too_old(memory.position_age_ns(now_ns), policy)
    if memory.state is not State.GROUNDED:
        return Refusal(
            Code.ALREADY_FLYING, f"the vehicle is not on the ground: {memory.state.name}"
        )
    for check in arm.needs:
        refusal = check.refusal(step)
        if refusal is not None:
            return refusal
    return None


def why_not_resume(policy: Policy, memory: Memory, now_ns: int) -> Refusal | None:
    """The refusal that `resume` would get if the vehicle were held where it is; None: none.

    Changes nothing.  The position is judged as of a vehicle at rest: a hold comes first.
    """
    if not memory.airborne:
        return Refusal(Code.NOT_FLYING, REFUSED[Code.NOT_FLYING])
    step = StepContext(policy, memory, now_ns)
    if memory.verifier is None:
        return home_or_fence_unknown()
    if step.stale or memory.pos_ned is None:
        return no_fresh_position(memory, policy, now_ns)
    judged = memory.verifier.hold_point(memory.pos_ned, AT_REST, (), floor_applies=True)
    if not isinstance(judged, Refusal):
        return Check.SEVERITY.refusal(step)
    if isinstance(memory.verifier.way_back(memory.pos_ned, AT_REST), WayBack):
        return Check.SEVERITY_BUT_FENCE.refusal(step)
    return judged


def why_not_go_to(memory: Memory, goal_ned: Vec3, yaw_rad: float | None) -> Refusal | None:
    """The refusal that a go-to would get after `resume`, from where the vehicle is; None: none, or
    it is not known.

    Changes nothing.  The vehicle is taken to be at rest: one that moves is refused no less.
    """
    return None if memory.pos_ned is None else _why_not(memory, goal_ned, yaw_rad, memory.pos_ned)


def why_not_once_hovering(memory: Memory, goal_ned: Vec3, yaw_rad: float | None) -> Refusal | None:
    """As `why_not_go_to`; a vehicle on the ground is taken to have climbed to the goal's height."""
    if memory.pos_ned is None:
        return None
    north_m, east_m, down_m = memory.pos_ned
    if memory.on_ground:
        down_m = min(down_m, goal_ned[2])
    return _why_not(memory, goal_ned, yaw_rad, (north_m, east_m, down_m))


def _why_not(
    memory: Memory, goal_ned: Vec3, yaw_rad: float | None, from_ned: Vec3
) -> Refusal | None:
    if memory.verifier is None:
        return None
    judged = memory.verifier.goal(goal_ned, yaw_rad, from_ned, AT_REST)
    return judged if isinstance(judged, Refusal) else None
