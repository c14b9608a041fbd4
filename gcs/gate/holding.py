"""The actions that stop the vehicle: hold, brake, and what a position too old leads to."""

from __future__ import annotations

from gcs.gate.core import Core, SetpointDraft
from gcs.gate.guards import here
from gcs.gate.memory import Goal
from gcs.gate.types import Code, CommandKind, Control, Level, Refusal, State
from gcs.gate.words import where

HOLD_EVERY_S = 1.0


def hold(core: Core) -> None:
    """Hold mode, until the heartbeat shows it; stream the held point where one is verified."""
    memory = core.memory
    core.cancel_commands()
    memory.ask_control_ns = None
    memory.goal = None
    braking = core.breach is not None and core.breach.brake_pos_ned is not None
    if not braking:
        hold_anew(core)
    memory.control = Control.OURS
    core.due(core.policy.control.timeout_s)
    repeat_hold(core)


def hold_anew(core: Core) -> None:
    memory = core.memory
    known = here(core) is None and memory.control is not Control.NONE
    memory.hold = Goal(memory.pos_ned, None, core.evidence) if known and memory.pos_ned else None


def hold_once(core: Core) -> None:
    core.command(CommandKind.HOLD, "our own guided command may yet take effect", own=True)


def hold_blind(core: Core) -> None:
    core.due(core.policy.control.timeout_s)
    repeat_hold(core)


def repeat_hold(core: Core) -> None:
    core.command(CommandKind.HOLD, "hold is never refused")
    core.memory.hold_again_ns = core.after_ns(HOLD_EVERY_S)


def hold_shown(core: Core) -> None:
    memory = core.memory
    memory.hold_again_ns = memory.asked_mode = memory.silence_told = None


def mode_settled(core: Core) -> None:
    core.memory.asked_mode = None


def brake(core: Core) -> None:
    """The setpoint leaves in the instant of the sample; its point is the verifier's own."""
    memory, breach = core.memory, core.breach
    assert breach is not None
    core.say(Level.ERROR, f"Brake: {breach.sentence}")
    if breach.brake_pos_ned is None:
        memory.hold = None
        return
    memory.hold = Goal(breach.brake_pos_ned, None, breach.numbers)
    core.out.append(SetpointDraft(memory.hold, f"brake at {where(breach.brake_pos_ned)}"))


def start_grace(core: Core) -> None:
    memory = core.memory
    core.refuse_pending(Refusal(Code.STALE, "the vehicle's position is too old"))
    memory.back_to = memory.state
    memory.grace_until_ns = core.after_ns(core.policy.stale_grace_s)


def let_go(core: Core) -> None:
    memory = core.memory
    memory.goal = memory.hold = None
    memory.back_to = State.HOLDING
    memory.grace_until_ns = None
