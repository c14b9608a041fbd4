"""What an action of the table does."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

from gcs.frames import Vec3
from gcs.gate.effects import CommandKind, Level, OutcomeKind, Ruling, SwitchedFence
from gcs.gate.machine import commanding, holding
from gcs.gate.machine.events import Event
from gcs.gate.machine.guards import allow, within
from gcs.gate.machine.memory import Goal, Task
from gcs.gate.machine.rules import Do, End
from gcs.gate.machine.turn import Turn
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import GoTo, SwitchFence
from gcs.gate.states import Control, LandedState

TICK_S = 0.05
"""The session ticks at 20 Hz."""
DISARM_WAIT_S = 3.0
"""How long a landing that is on the ground waits to be reported disarmed."""

# ------------------------------------------------------------------------------------ goals


def _verify(turn: Turn) -> None:
    """Judge the pending goal; the streamed one is not touched until the verdict is in."""
    memory, requested = turn.memory, turn.memory.pending
    assert requested is not None
    assert isinstance(requested.request, GoTo)
    if memory.verifier is None or memory.pos_ned is None or memory.v_ned is None:
        judged = allow(turn, Refusal(Code.NO_ORIGIN, "home and fence are not known yet"))
    else:
        judged = allow(
            turn,
            memory.verifier.goal(
                requested.request.goal_ned, requested.request.yaw_rad, memory.pos_ned, memory.v_ned
            ),
        )
    turn.raised.append(Event.GOAL_CLEARED if judged is None else Event.GOAL_REFUSED)


def _fly_goal(turn: Turn) -> None:
    memory, requested = turn.memory, turn.memory.pending
    assert requested is not None
    assert isinstance(requested.request, GoTo)
    memory.pending = None
    turn.verdict(requested, Ruling.ACCEPTED, None)
    turn.end(End(OutcomeKind.SUPERSEDED, Code.SUPERSEDED))
    goal_ned = requested.request.goal_ned
    memory.task = Task(requested, Event.GOTO)
    memory.goal = Goal(goal_ned, requested.request.yaw_rad, turn.evidence)
    memory.within_since_ns = turn.now_ns if within(turn, goal_ned) else None
    assert memory.pos_ned is not None
    turn.due(_flight_s(turn, memory.pos_ned, goal_ned))


def _flight_s(turn: Turn, pos_ned: Vec3, goal_ned: Vec3) -> float:
    """The policy's deadline for the distance: the slowest healthy flight, times its factor."""
    speeds, policy = turn.policy.speeds, turn.policy
    down_m = goal_ned[2] - pos_ned[2]
    level_s = math.hypot(goal_ned[0] - pos_ned[0], goal_ned[1] - pos_ned[1]) / speeds.cruise_m_s
    climb_s = abs(down_m) / (speeds.descend_m_s if down_m > 0.0 else speeds.climb_m_s)
    return max(policy.deadline_min_s, policy.deadline_factor * (level_s + climb_s))


def _drop_goal(turn: Turn) -> None:
    assert turn.why is not None
    turn.refuse_pending(turn.why)


def _keep_goal(turn: Turn) -> None:
    memory = turn.memory
    memory.hold, memory.goal = memory.goal, None


# ---------------------------------------------------------------------------------- control


def _take_control(turn: Turn) -> None:
    """Stream the verified present position, then ask: at once, or after the policy's time."""
    memory, times = turn.memory, turn.policy.control
    assert memory.pos_ned is not None
    turn.cancel_commands()
    memory.hold, memory.goal = Goal(memory.pos_ned, None, turn.evidence), None
    memory.control = Control.TAKING
    # The stream begins with the next tick of its grid, not with the request.
    stream_s = 0.0 if memory.autopilot == "ardupilot" else times.stream_s + TICK_S
    memory.ask_control_ns = turn.after_ns(stream_s)
    turn.due(stream_s + times.timeout_s)


def _ask_guided(turn: Turn) -> None:
    turn.memory.ask_control_ns = None
    turn.command(CommandKind.GUIDED, "the present position is verified and streamed")


def _gain_control(turn: Turn) -> None:
    turn.memory.control = Control.OURS
    turn.memory.asked_mode = None


def _release(turn: Turn) -> None:
    memory = turn.memory
    turn.cancel_commands()
    memory.control = Control.NONE
    memory.hold = memory.goal = None
    memory.ask_control_ns = None


# ------------------------------------------------------------------------ fence and vehicle


def _switch_fence(turn: Turn) -> None:
    assert turn.requested is not None
    assert isinstance(turn.requested.request, SwitchFence)
    turn.memory.verifier = None
    turn.out.append(SwitchedFence(turn.requested.request.on))


def _forget_interrupted(turn: Turn) -> None:
    memory = turn.memory
    _release(turn)
    memory.back_to = None
    memory.grace_until_ns = None


def _forget_vehicle(turn: Turn) -> None:
    """What was reported is not known any more; that a vehicle was heard, is."""
    memory = turn.memory
    memory.heard_ns = memory.pos_ns = None
    memory.pos_ned = memory.v_ned = None
    memory.armed = False
    memory.mode, memory.mode_name = None, ""
    memory.landed, memory.landed_ns = LandedState.UNDEFINED, None
    memory.stood_down_m = None
    memory.lifted = False
    memory.back_to = None
    memory.grace_until_ns = None


def _await_disarm(turn: Turn) -> None:
    turn.due(DISARM_WAIT_S)


def _note_lifted(turn: Turn) -> None:
    turn.memory.lifted = True


def _note_force(turn: Turn) -> None:
    turn.memory.force_asked_ns = turn.now_ns
    turn.say(Level.WARNING, "ask for the forced disarm again within 5 s to have it")


ACTIONS: Final[Mapping[Do, Callable[[Turn], None]]] = MappingProxyType(
    {
        Do.VERIFY: _verify,
        Do.FLY_GOAL: _fly_goal,
        Do.DROP_GOAL: _drop_goal,
        Do.KEEP_GOAL: _keep_goal,
        Do.TAKE_CONTROL: _take_control,
        Do.ASK_GUIDED: _ask_guided,
        Do.GAIN_CONTROL: _gain_control,
        Do.RELEASE: _release,
        Do.ARM: commanding.arm,
        Do.DISARM: commanding.disarm,
        Do.FORCE_DISARM: commanding.force_disarm,
        Do.TAKE_OFF: commanding.take_off,
        Do.CONTINUE: commanding.send_waiting,
        Do.LAND: commanding.land,
        Do.RETURN: commanding.return_home,
        Do.HOLD: holding.hold,
        Do.HOLD_ONCE: holding.hold_once,
        Do.HOLD_BLIND: holding.hold_blind,
        Do.REPEAT_HOLD: holding.repeat_hold,
        Do.HOLD_SHOWN: holding.hold_shown,
        Do.MODE_SETTLED: holding.mode_settled,
        Do.HOLD_ANEW: holding.hold_anew,
        Do.BRAKE: holding.brake,
        Do.PHOTO: commanding.photo,
        Do.START_MISSION: commanding.start_mission,
        Do.SWITCH_FENCE: _switch_fence,
        Do.START_GRACE: holding.start_grace,
        Do.LET_GO: holding.let_go,
        Do.FORGET_VEHICLE: _forget_vehicle,
        Do.FORGET_INTERRUPTED: _forget_interrupted,
        Do.AWAIT_DISARM: _await_disarm,
        Do.NOTE_LIFTED: _note_lifted,
        Do.NOTE_FORCE: _note_force,
    }
)
"""Total over `Do`, which a test asserts."""
