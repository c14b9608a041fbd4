"""Positions are sent no farther ahead of the vehicle than its speed is to be; see
`airspace/pace.py`."""

from __future__ import annotations

import math

from gcs.frames import Vec3
from gcs.gate.airspace.bounds import STANDING
from gcs.gate.machine.memory import SECOND_NS
from gcs.gate.machine.step_context import StepContext


def way_is_known(step: StepContext, goal_ned: Vec3) -> bool:
    """The position is fresh, or something was sent on the way to `goal_ned` while it was."""
    paced = step.memory.paced
    return not step.stale or (paced is not None and paced.goal_ned == goal_ned)


def towards(
    step: StepContext,
    goal_ned: Vec3,
    beside_ned: Vec3 | None = None,
    most_m_s: float = math.inf,
) -> Vec3:
    """The position to send now on the way to `goal_ned`; `beside_ned` is a velocity that is sent
    with it, `most_m_s` the speed that was asked for.

    It goes on from the last report: without another one it stays where it is, and the vehicle slows
    down for it.  Where the report is too old, it is what was sent last on this way: see
    `way_is_known`.
    """
    memory = step.memory
    if memory.verifier is None or memory.pos_ned is None or memory.v_ned is None:
        return goal_ned
    if step.stale:
        return goal_ned if memory.paced is None else memory.paced.target_ned
    memory.paced = memory.verifier.paced(
        goal_ned, memory.pos_ned, memory.v_ned, memory.late_s, beside_ned or STANDING, most_m_s
    )
    memory.paced_ns = step.now_ns
    return memory.paced.target_ned


def may_have(step: StepContext, to_ned: Vec3 | None) -> tuple[Vec3, ...]:
    """Velocities that the vehicle may have beside the reported one, if it is to do something else
    than to fly to where it flies already; `to_ned` is where that leads, if to a place.

    It is asked for a speed before its reports show that.
    """
    memory = step.memory
    if memory.paced is None or memory.v_ned is None:
        return ()
    react_s = step.policy.braking_of(memory.autopilot).react_s
    if step.now_ns >= memory.paced_ns + round(react_s * SECOND_NS):
        return ()
    if memory.goal is not None and memory.goal.pos_ned == to_ned:
        return ()
    asked_ned = memory.paced.v_ned
    return (asked_ned,) if math.hypot(*asked_ned) > math.hypot(*memory.v_ned) else ()
