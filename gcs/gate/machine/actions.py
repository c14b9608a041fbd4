"""What each `Action` of the table does.

Goals, control, the fence and what is noted are here; `commanding.py` and `holding.py` have the
actions that send commands.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Final

from gcs.enu_text import place
from gcs.frames import Vec3
from gcs.gate.effects import CommandKind, Level, OutcomeKind, Ruling, SwitchedFence
from gcs.gate.machine import commanding, holding, streaming, verifying
from gcs.gate.machine.events import Event
from gcs.gate.machine.memory import Goal, Task
from gcs.gate.machine.progress import within_arrival
from gcs.gate.machine.rules import Action, End
from gcs.gate.machine.turn import Turn
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import GoTo, SwitchFence
from gcs.gate.states import Control, FlightMode, LandedState, State

TICK_S = 0.05
"""The time from one tick to the next: the session ticks at 20 Hz."""

FLOWN: Final = frozenset(
    {
        State.TAKING_OFF,
        State.HOVERING,
        State.MOVING,
        State.STREAMING,
        State.TAKING_PICTURE,
        State.FLYING_MISSION,
        State.HOLDING,
    }
)
"""Flown by us.  A return and a landing are the vehicle's own, and go on by themselves."""

# ------------------------------------------------------------------------------------ goals


def _verify_goal(turn: Turn) -> None:
    """Ask the verifier for the pending goal; its answer is the next event.

    The setpoint that is being sent stays as it is until then.
    """
    requested = turn.memory.pending
    assert requested is not None
    assert isinstance(requested.request, GoTo)
    refusal = verifying.goal(turn, requested.request)
    turn.raised.append(Event.GOAL_CLEARED if refusal is None else Event.GOAL_REFUSED)


def _fly_goal(turn: Turn) -> None:
    """Accept the pending go-to; the request that was under way is superseded."""
    memory, requested = turn.memory, turn.memory.pending
    assert requested is not None
    assert isinstance(requested.request, GoTo)
    memory.pending = None
    turn.verdict(requested, Ruling.ACCEPTED, None)
    turn.end(End(OutcomeKind.SUPERSEDED, Code.SUPERSEDED))
    memory.task = Task(requested, Event.GOTO)
    _fly_to(turn, Goal(requested.request.goal_ned, requested.request.yaw_rad, turn.evidence))


def _fly_to_top(turn: Turn) -> None:
    """The climb ended within the vehicle's own tolerance: the rest is flown as a goal."""
    _fly_to(turn, Goal(turn.memory.top_ned, None, turn.evidence))


def _fly_to(turn: Turn, goal: Goal) -> None:
    memory = turn.memory
    assert memory.pos_ned is not None
    memory.goal = goal
    memory.within_since_ns = turn.now_ns if within_arrival(turn, goal.pos_ned) else None
    turn.set_deadline(_flight_s(turn, memory.pos_ned, goal.pos_ned))


def _flight_s(turn: Turn, pos_ned: Vec3, goal_ned: Vec3) -> float:
    """Seconds allowed for a goal: the slowest healthy flight there, times the policy's factor."""
    speeds, policy = turn.policy.speeds, turn.policy
    down_m = goal_ned[2] - pos_ned[2]
    level_s = math.hypot(goal_ned[0] - pos_ned[0], goal_ned[1] - pos_ned[1]) / speeds.cruise_m_s
    climb_s = abs(down_m) / (speeds.descend_m_s if down_m > 0.0 else speeds.climb_m_s)
    return max(policy.deadline_min_s, policy.deadline_factor * (level_s + climb_s))


def _refuse_goal(turn: Turn) -> None:
    assert turn.why is not None
    turn.refuse_pending(turn.why)


def _hold_at_goal(turn: Turn) -> None:
    """The goal is reached: it is the hold goal from now on."""
    memory = turn.memory
    memory.hold, memory.goal = memory.goal, None


# ---------------------------------------------------------------------------------- control


def _take_control(turn: Turn) -> None:
    """Send the verified present position as setpoint from now on, and command guided mode."""
    assert turn.memory.pos_ned is not None
    _take_control_at(turn, turn.memory.pos_ned)


def _take_control_on_way_back(turn: Turn) -> None:
    """As `_take_control`, with a place inside as setpoint: the vehicle is outside, and flies there
    slowly."""
    way = verifying.way_back(turn)
    assert way is not None
    _take_control_at(turn, way.to_ned)
    turn.memory.hold = Goal(way.to_ned, None, way.evidence, way_back=True)
    turn.say(Level.WARNING, f"It is outside, and flies back inside: to {place(way.to_ned)}")


def _take_control_at_top(turn: Turn) -> None:
    """As `_take_control`, with the top of the climb as setpoint: the vehicle may end its climb
    below it.  An ArduPilot shows its hold mode there only where somebody else has put it into it:
    then a goal that has waited for the top is not flown."""
    memory = turn.memory
    if memory.autopilot == "ardupilot" and memory.mode is FlightMode.HOLD:
        turn.refuse_pending(Refusal(Code.MODE_CHANGED, "somebody else has stopped the climb"))
    _take_control_at(turn, memory.top_ned)


def _take_control_at(turn: Turn, hold_ned: Vec3) -> None:
    """ardupilot is asked for guided mode at once; px4 needs setpoints first, for the policy's
    time."""
    memory, times = turn.memory, turn.policy.control
    turn.cancel_commands()
    memory.hold, memory.goal = Goal(hold_ned, None, turn.evidence), None
    memory.control = Control.TAKING
    # The first setpoint leaves with the next tick, not with the request.
    stream_s = 0.0 if memory.autopilot == "ardupilot" else times.stream_s + TICK_S
    memory.ask_control_ns = turn.after_ns(stream_s)
    turn.set_deadline(stream_s + times.timeout_s)


def _ask_guided(turn: Turn) -> None:
    turn.memory.ask_control_ns = None
    turn.command(CommandKind.GUIDED, "the present position is verified and streamed")


def _gain_control(turn: Turn) -> None:
    turn.memory.control = Control.OURS
    turn.memory.asked_mode = None


def _release_control(turn: Turn) -> None:
    """Send no more setpoints, and forget every command that has no answer yet."""
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
    """In STALE: release control, and go back to no state when a fresh position arrives."""
    memory = turn.memory
    _release_control(turn)
    memory.back_to = None
    memory.grace_until_ns = None


def _forget_vehicle(turn: Turn) -> None:
    """The vehicle is not heard any more: forget its reports, but not that it was heard."""
    memory = turn.memory
    memory.lost_in_flight = memory.flown_state in FLOWN
    memory.failsafe = False
    memory.heard_ns = memory.pos_ns = None
    memory.pos_ned = memory.v_ned = None
    memory.armed = False
    memory.mode, memory.mode_name = None, ""
    memory.landed, memory.landed_ns = LandedState.UNDEFINED, None
    memory.ground_down_m = None
    memory.lifted = False
    memory.back_to = None
    memory.grace_until_ns = None


def _await_disarm(turn: Turn) -> None:
    turn.set_deadline(turn.policy.control.disarm_wait_s)


def _await_landing(turn: Turn) -> None:
    """It bounced: it has the time of a landing again."""
    turn.set_deadline(turn.policy.land_timeout_s)


def _await_position(turn: Turn) -> None:
    """Arming waits for an estimator that starts."""
    task = turn.memory.task
    assert task is not None
    turn.memory.task = replace(task, waiting=CommandKind.ARM)
    turn.set_deadline(turn.policy.arm_timeout_s)
    turn.say(Level.INFO, "no position yet (the estimator is starting): arming waits for one")


def _drop_deadline(turn: Turn) -> None:
    turn.set_deadline(None)


def _note_lift_off(turn: Turn) -> None:
    turn.memory.lifted = True


def _note_force_request(turn: Turn) -> None:
    """Remember when a forced disarm was asked for first; only a second request has it."""
    turn.memory.force_asked_ns = turn.now_ns
    turn.say(Level.WARNING, "ask for the forced disarm again within 5 s to have it")


ACTIONS: Final[Mapping[Action, Callable[[Turn], None]]] = MappingProxyType(
    {
        Action.VERIFY_GOAL: _verify_goal,
        Action.FLY_GOAL: _fly_goal,
        Action.REFUSE_GOAL: _refuse_goal,
        Action.HOLD_AT_GOAL: _hold_at_goal,
        Action.TAKE_CONTROL: _take_control,
        Action.TAKE_CONTROL_ON_WAY_BACK: _take_control_on_way_back,
        Action.TAKE_CONTROL_AT_TOP: _take_control_at_top,
        Action.FLY_TO_TOP: _fly_to_top,
        Action.ASK_GUIDED: _ask_guided,
        Action.SET_GUIDED: commanding.set_guided,
        Action.GAIN_CONTROL: _gain_control,
        Action.RELEASE_CONTROL: _release_control,
        Action.ARM: commanding.arm,
        Action.DISARM: commanding.disarm,
        Action.FORCE_DISARM: commanding.force_disarm,
        Action.TAKE_OFF: commanding.take_off,
        Action.SEND_WAITING: commanding.send_waiting,
        Action.LAND: commanding.land,
        Action.LAND_MODE_ONLY: commanding.land_mode_only,
        Action.RETURN: commanding.return_home,
        Action.HOLD: holding.hold,
        Action.HOLD_UNASKED: holding.hold_unasked,
        Action.HOLD_MODE_ONLY: holding.hold_mode_only,
        Action.REPEAT_HOLD: holding.repeat_hold,
        Action.CONFIRM_HOLD: holding.confirm_hold,
        Action.STOP_AWAITING_MODE: holding.stop_awaiting_mode,
        Action.VERIFY_HELD_POINT: holding.verify_held_point,
        Action.BRAKE: holding.brake,
        Action.TAKE_PHOTO: commanding.photo,
        Action.START_MISSION: commanding.start_mission,
        Action.SWITCH_FENCE: _switch_fence,
        Action.START_GRACE: holding.start_grace,
        Action.STOP_STREAM: holding.stop_stream,
        Action.FORGET_VEHICLE: _forget_vehicle,
        Action.FORGET_INTERRUPTED: _forget_interrupted,
        Action.AWAIT_DISARM: _await_disarm,
        Action.AWAIT_LANDING: _await_landing,
        Action.AWAIT_POSITION: _await_position,
        Action.DROP_DEADLINE: _drop_deadline,
        Action.NOTE_LIFT_OFF: _note_lift_off,
        Action.NOTE_FORCE_REQUEST: _note_force_request,
        Action.BEGIN_STREAM: streaming.begin,
        Action.FLY_SAMPLE: streaming.fly,
        Action.NOTE_SAMPLE: streaming.note,
        Action.NOTE_GOOD_SAMPLE: streaming.note_good,
        Action.HOLD_IN_PLACE: streaming.hold_in_place,
        Action.END_STREAM: streaming.end,
    }
)
"""A test asserts that every `Action` is here."""
