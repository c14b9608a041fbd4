"""The actions that stop the vehicle: hold, brake, and what a position too old leads to."""

from __future__ import annotations

from gcs.gate.effects import CommandKind, Level
from gcs.gate.machine.guards import here
from gcs.gate.machine.memory import Goal
from gcs.gate.machine.sentences import where
from gcs.gate.machine.turn import SetpointDraft, Turn
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import Control, State

HOLD_EVERY_S = 1.0


def hold(turn: Turn) -> None:
    """Hold mode, until the heartbeat shows it; stream the held point where one is verified."""
    memory = turn.memory
    turn.cancel_commands()
    memory.ask_control_ns = None
    memory.goal = None
    braking = turn.breach is not None and turn.breach.brake_pos_ned is not None
    if not braking:
        hold_anew(turn)
    memory.control = Control.OURS
    turn.due(turn.policy.control.timeout_s)
    repeat_hold(turn)


def hold_anew(turn: Turn) -> None:
    memory = turn.memory
    known = here(turn) is None and memory.control is not Control.NONE
    memory.hold = Goal(memory.pos_ned, None, turn.evidence) if known and memory.pos_ned else None


def hold_once(turn: Turn) -> None:
    turn.command(CommandKind.HOLD, "our own guided command may yet take effect", own=True)


def hold_blind(turn: Turn) -> None:
    turn.due(turn.policy.control.timeout_s)
    repeat_hold(turn)


def repeat_hold(turn: Turn) -> None:
    turn.command(CommandKind.HOLD, "hold is never refused")
    turn.memory.hold_again_ns = turn.after_ns(HOLD_EVERY_S)


def hold_shown(turn: Turn) -> None:
    memory = turn.memory
    memory.hold_again_ns = memory.asked_mode = memory.silence_told = None


def mode_settled(turn: Turn) -> None:
    turn.memory.asked_mode = None


def brake(turn: Turn) -> None:
    """The setpoint leaves in the instant of the sample; its point is the verifier's own."""
    memory, breach = turn.memory, turn.breach
    assert breach is not None
    turn.say(Level.ERROR, f"Brake: {breach.sentence}")
    if breach.brake_pos_ned is None:
        memory.hold = None
        return
    memory.hold = Goal(breach.brake_pos_ned, None, breach.numbers)
    turn.out.append(SetpointDraft(memory.hold, f"brake at {where(breach.brake_pos_ned)}"))


def start_grace(turn: Turn) -> None:
    memory = turn.memory
    turn.refuse_pending(Refusal(Code.STALE, "the vehicle's position is too old"))
    memory.back_to = memory.state
    memory.grace_until_ns = turn.after_ns(turn.policy.stale_grace_s)


def let_go(turn: Turn) -> None:
    memory = turn.memory
    memory.goal = memory.hold = None
    memory.back_to = State.HOLDING
    memory.grace_until_ns = None
