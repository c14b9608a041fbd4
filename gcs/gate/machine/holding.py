"""The actions that stop the vehicle: hold, brake, and what follows from a position too old.

"Hold" is the vehicle's own hold mode, commanded once a second (the policy's `hold_every_s`) until
the heartbeat shows it.
Beside it the held position is sent as a setpoint, where it was verified.
"""

from __future__ import annotations

import math

from gcs.enu_text import place
from gcs.gate.airspace.bounds import STANDING
from gcs.gate.airspace.stopping import StopBy
from gcs.gate.effects import CommandKind, Level
from gcs.gate.machine import verifying
from gcs.gate.machine.events import Event
from gcs.gate.machine.memory import Goal
from gcs.gate.machine.sentences import no_fresh_position
from gcs.gate.machine.step_context import SetpointDraft, StepContext
from gcs.gate.states import Control, State


def hold(step: StepContext) -> None:
    """Take control, forget the goal, and command hold mode until the heartbeat shows it.

    The held position is where the vehicle is, or the brake's where one was just sent.
    """
    memory = step.memory
    step.cancel_commands()
    memory.ask_control_ns = None
    memory.goal = None
    braking = step.breach is not None and step.breach.brake_pos_ned is not None
    if not braking:
        verify_held_point(step)
    memory.control = Control.OURS
    if step.breach is None or step.breach.by is not StopBy.SETPOINT or not braking:
        step.set_deadline(step.policy.control.timeout_s)
        repeat_hold(step)
        return
    # Setpoints stop it sooner than its hold mode does: that comes when it is slow.
    slow_s = _slow_after_s(step)
    step.set_deadline(slow_s + step.policy.control.timeout_s)
    memory.hold_again_ns = step.after_ns(slow_s)


def _slow_after_s(step: StepContext) -> float:
    """How long a vehicle takes that is stopped by setpoints."""
    memory, approach = step.memory, step.policy.approach_of(step.memory.autopilot)
    north, east, down = memory.v_ned or STANDING
    level_s = math.hypot(north, east) / approach.a_brake_h_m_s2
    return approach.react_s + max(level_s, abs(down) / approach.a_brake_v_m_s2)


def verify_held_point(step: StepContext) -> None:
    """Hold where the vehicle is now, where that clears and we have or take control; otherwise no
    setpoint is sent."""
    memory = step.memory
    clears = verifying.position(step) is None and memory.control is not Control.NONE
    memory.hold = Goal(memory.pos_ned, None, step.evidence) if clears and memory.pos_ned else None


def hold_unasked(step: StepContext) -> None:
    """Command hold mode until the heartbeat shows it, in the gate's own name; control stays.

    Where a request to hold or abort is under way, it is that request's hold that is not shown.
    """
    memory = step.memory
    asked = memory.task is not None and memory.task.kind in (Event.HOLD, Event.ABORT)
    memory.hold_requested = memory.hold_requested or asked
    step.command(CommandKind.HOLD, "our own guided command may yet take effect", own=True)
    _repeat_later(step)


def hold_mode_only(step: StepContext) -> None:
    """Command hold mode until the heartbeat shows it; control and setpoints stay as they are."""
    step.set_deadline(step.policy.control.timeout_s)
    repeat_hold(step)


def repeat_hold(step: StepContext) -> None:
    """Command hold mode, and again after the policy's `hold_every_s`."""
    step.command(CommandKind.HOLD, "hold is never refused")
    _repeat_later(step)


def _repeat_later(step: StepContext) -> None:
    step.memory.hold_again_ns = step.after_ns(step.policy.control.hold_every_s)


def confirm_hold(step: StepContext) -> None:
    """The heartbeat shows hold mode, or the hold is not needed any more: repeat it no more."""
    memory = step.memory
    memory.hold_again_ns = memory.asked_mode = memory.silence_reported = None
    memory.hold_requested = False


def stop_awaiting_mode(step: StepContext) -> None:
    """The mode is shown, or is waited for no more."""
    memory = step.memory
    memory.asked_mode = None
    if memory.state in (State.FLYING_MISSION, State.RETURNING, State.LANDING):
        memory.hold = None


def brake(step: StepContext) -> None:
    """Send the setpoint of the brake at once, with the position sample that predicted the breach.

    The verifier gives its position; where it finds none, only hold mode is left.
    """
    memory, breach = step.memory, step.breach
    assert breach is not None
    step.say(Level.ERROR, f"Brake: {breach.sentence}")
    if breach.brake_pos_ned is None:
        memory.hold = None
        return
    memory.hold = Goal(breach.brake_pos_ned, None, breach.numbers)
    step.out.append(SetpointDraft(memory.hold, f"brake at {place(breach.brake_pos_ned)}"))


def start_grace(step: StepContext) -> None:
    """The position is too old: remember the state, and let the setpoints go on for the grace."""
    memory = step.memory
    step.refuse_pending(no_fresh_position(memory, step.policy, step.now_ns))
    memory.back_to = memory.state
    memory.grace_until_ns = step.after_ns(step.policy.stale_grace_s)


def stop_stream(step: StepContext) -> None:
    """Send no more setpoints; a fresh position then leads from STALE to HOLDING."""
    memory = step.memory
    memory.goal = memory.hold = None
    memory.back_to = State.HOLDING
    memory.grace_until_ns = None
