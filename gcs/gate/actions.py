"""What an action of the table does."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Final

from gcs.frames import Vec3
from gcs.gate import holding, orders
from gcs.gate.core import Core
from gcs.gate.events import Event
from gcs.gate.guards import allow, within
from gcs.gate.memory import Goal, Task
from gcs.gate.rules import Do, End
from gcs.gate.types import (
    Code,
    CommandKind,
    Control,
    Ended,
    GoTo,
    LandedState,
    Level,
    Outcome,
    Refusal,
    SwitchedFence,
    SwitchFence,
)

TICK_S = 0.05
"""The session ticks at 20 Hz."""
DISARM_WAIT_S = 3.0
"""How long a landing that is on the ground waits to be reported disarmed."""

# ------------------------------------------------------------------------------------ goals


def _verify(core: Core) -> None:
    """Judge the pending goal; the streamed one is not touched until the verdict is in."""
    memory, request = core.memory, core.memory.pending
    assert request is not None
    assert isinstance(request.wish, GoTo)
    if memory.verifier is None or memory.pos_ned is None or memory.v_ned is None:
        judged = allow(core, Refusal(Code.NO_ORIGIN, "home and fence are not known yet"))
    else:
        judged = allow(
            core,
            memory.verifier.goal(
                request.wish.goal_ned, request.wish.yaw_rad, memory.pos_ned, memory.v_ned
            ),
        )
    core.raised.append(Event.GOAL_CLEARED if judged is None else Event.GOAL_REFUSED)


def _fly_goal(core: Core) -> None:
    memory, request = core.memory, core.memory.pending
    assert request is not None
    assert isinstance(request.wish, GoTo)
    memory.pending = None
    core.verdict(request, Outcome.ACCEPTED, None)
    core.end(End(Ended.SUPERSEDED, Code.SUPERSEDED))
    goal_ned = request.wish.goal_ned
    memory.task = Task(request, Event.GOTO)
    memory.goal = Goal(goal_ned, request.wish.yaw_rad, core.evidence)
    memory.within_since_ns = core.now_ns if within(core, goal_ned) else None
    assert memory.pos_ned is not None
    core.due(_flight_s(core, memory.pos_ned, goal_ned))


def _flight_s(core: Core, pos_ned: Vec3, goal_ned: Vec3) -> float:
    """The policy's deadline for the distance: the slowest healthy flight, times its factor."""
    speeds, policy = core.policy.speeds, core.policy
    down_m = goal_ned[2] - pos_ned[2]
    level_s = math.hypot(goal_ned[0] - pos_ned[0], goal_ned[1] - pos_ned[1]) / speeds.cruise_m_s
    climb_s = abs(down_m) / (speeds.descend_m_s if down_m > 0.0 else speeds.climb_m_s)
    return max(policy.deadline_min_s, policy.deadline_factor * (level_s + climb_s))


def _drop_goal(core: Core) -> None:
    assert core.why is not None
    core.refuse_pending(core.why)


def _keep_goal(core: Core) -> None:
    memory = core.memory
    memory.hold, memory.goal = memory.goal, None


# ---------------------------------------------------------------------------------- control


def _take_control(core: Core) -> None:
    """Stream the verified present position, then ask: at once, or after the policy's time."""
    memory, times = core.memory, core.policy.control
    assert memory.pos_ned is not None
    core.cancel_commands()
    memory.hold, memory.goal = Goal(memory.pos_ned, None, core.evidence), None
    memory.control = Control.TAKING
    # The stream begins with the next tick of its grid, not with the request.
    stream_s = 0.0 if memory.personality == "ardupilot" else times.stream_s + TICK_S
    memory.ask_control_ns = core.after_ns(stream_s)
    core.due(stream_s + times.timeout_s)


def _ask_guided(core: Core) -> None:
    core.memory.ask_control_ns = None
    core.command(CommandKind.GUIDED, "the present position is verified and streamed")


def _gain_control(core: Core) -> None:
    core.memory.control = Control.OURS
    core.memory.asked_mode = None


def _release(core: Core) -> None:
    memory = core.memory
    core.cancel_commands()
    memory.control = Control.NONE
    memory.hold = memory.goal = None
    memory.ask_control_ns = None


# ------------------------------------------------------------------------ fence and vehicle


def _switch_fence(core: Core) -> None:
    assert core.request is not None
    assert isinstance(core.request.wish, SwitchFence)
    core.memory.verifier = None
    core.out.append(SwitchedFence(core.request.wish.on))


def _forget_interrupted(core: Core) -> None:
    memory = core.memory
    _release(core)
    memory.back_to = None
    memory.grace_until_ns = None


def _forget_vehicle(core: Core) -> None:
    """What was reported is not known any more; that a vehicle was heard, is."""
    memory = core.memory
    memory.heard_ns = memory.pos_ns = None
    memory.pos_ned = memory.v_ned = None
    memory.armed = False
    memory.mode, memory.mode_name = None, ""
    memory.landed, memory.landed_ns = LandedState.UNDEFINED, None
    memory.stood_down_m = None
    memory.lifted = False
    memory.back_to = None
    memory.grace_until_ns = None


def _await_disarm(core: Core) -> None:
    core.due(DISARM_WAIT_S)


def _note_lifted(core: Core) -> None:
    core.memory.lifted = True


def _note_force(core: Core) -> None:
    core.memory.force_asked_ns = core.now_ns
    core.say(Level.WARNING, "ask for the forced disarm again within 5 s to have it")


ACTIONS: Final[Mapping[Do, Callable[[Core], None]]] = MappingProxyType(
    {
        Do.VERIFY: _verify,
        Do.FLY_GOAL: _fly_goal,
        Do.DROP_GOAL: _drop_goal,
        Do.KEEP_GOAL: _keep_goal,
        Do.TAKE_CONTROL: _take_control,
        Do.ASK_GUIDED: _ask_guided,
        Do.GAIN_CONTROL: _gain_control,
        Do.RELEASE: _release,
        Do.ARM: orders.arm,
        Do.DISARM: orders.disarm,
        Do.FORCE_DISARM: orders.force_disarm,
        Do.TAKE_OFF: orders.take_off,
        Do.CONTINUE: orders.send_waiting,
        Do.LAND: orders.land,
        Do.RETURN: orders.return_home,
        Do.HOLD: holding.hold,
        Do.HOLD_ONCE: holding.hold_once,
        Do.HOLD_BLIND: holding.hold_blind,
        Do.REPEAT_HOLD: holding.repeat_hold,
        Do.HOLD_SHOWN: holding.hold_shown,
        Do.MODE_SETTLED: holding.mode_settled,
        Do.HOLD_ANEW: holding.hold_anew,
        Do.BRAKE: holding.brake,
        Do.PHOTO: orders.photo,
        Do.START_MISSION: orders.start_mission,
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
