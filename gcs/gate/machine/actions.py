"""The actions: what the branches of the table do.

Goals, control, the fence and what is noted are here; `commanding.py` and `holding.py` have the
actions that send commands.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from enum import StrEnum
from typing import Final, Self

from gcs.enu_text import place
from gcs.frames import Vec3
from gcs.gate.effects import CommandKind, Level, OutcomeKind, Ruling, SwitchedFence
from gcs.gate.machine import commanding, holding, streaming, verifying
from gcs.gate.machine.events import Event
from gcs.gate.machine.memory import Goal, Task
from gcs.gate.machine.progress import within_arrival
from gcs.gate.machine.step_context import End, StepContext
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


def _verify_goal(step: StepContext) -> None:
    """Ask the verifier for the pending goal; its answer is the next event.

    The setpoint that is being sent stays as it is until then.
    """
    requested = step.memory.pending
    assert requested is not None
    assert isinstance(requested.request, GoTo)
    refusal = verifying.goal(step, requested.request)
    step.raised.append(Event.GOAL_CLEARED if refusal is None else Event.GOAL_REFUSED)


def _fly_goal(step: StepContext) -> None:
    """Accept the pending go-to; the request that was under way is superseded."""
    memory, requested = step.memory, step.memory.pending
    assert requested is not None
    assert isinstance(requested.request, GoTo)
    memory.pending = None
    step.verdict(requested, Ruling.ACCEPTED, None)
    step.end(End(OutcomeKind.SUPERSEDED, Code.SUPERSEDED))
    memory.task = Task(requested, Event.GOTO)
    asked = requested.request
    speed_m_s = math.inf if asked.speed_m_s is None else asked.speed_m_s
    _fly_to(step, Goal(asked.goal_ned, asked.yaw_rad, step.evidence, speed_m_s=speed_m_s))


def _fly_to_top(step: StepContext) -> None:
    """The climb ended within the vehicle's own tolerance: the rest is flown as a goal."""
    _fly_to(step, Goal(step.memory.top_ned, None, step.evidence))


def _fly_to(step: StepContext, goal: Goal) -> None:
    memory = step.memory
    assert memory.pos_ned is not None
    memory.goal = goal
    memory.within_since_ns = step.now_ns if within_arrival(step) else None
    step.set_deadline(_flight_s(step, memory.pos_ned, goal))


def _flight_s(step: StepContext, pos_ned: Vec3, goal: Goal) -> float:
    """Seconds allowed for a goal: the slowest healthy flight there, and the slowest turn, as it may
    begin where the flight ends; times the policy's factor."""
    speeds, policy, most_m_s = step.policy.speeds, step.policy, goal.speed_m_s
    north_m, east_m, down_m = (to - here for to, here in zip(goal.pos_ned, pos_ned, strict=True))
    level_s = math.hypot(north_m, east_m) / min(speeds.cruise_m_s, most_m_s)
    climb_m_s = speeds.descend_m_s if down_m > 0.0 else speeds.climb_m_s
    climb_s = abs(down_m) / min(climb_m_s, most_m_s)
    turn_s = step.memory.turn_left_deg(policy.arrival.yaw_deg) / speeds.turn_deg_s
    return max(policy.deadline_min_s, policy.deadline_factor * (level_s + climb_s + turn_s))


def _refuse_goal(step: StepContext) -> None:
    assert step.why is not None
    step.refuse_pending(step.why)


def _hold_at_goal(step: StepContext) -> None:
    """The goal is reached: it is the hold goal from now on, whatever the speed of its leg was."""
    memory = step.memory
    assert memory.goal is not None
    memory.hold, memory.goal = replace(memory.goal, speed_m_s=math.inf), None


# ---------------------------------------------------------------------------------- control


def _take_control(step: StepContext) -> None:
    """Send the verified present position as setpoint from now on, and command guided mode."""
    assert step.memory.pos_ned is not None
    _take_control_at(step, step.memory.pos_ned)


def _take_control_on_way_back(step: StepContext) -> None:
    """As `_take_control`, with a place inside as setpoint: the vehicle is outside, and flies there
    slowly."""
    way = verifying.way_back(step)
    assert way is not None
    _take_control_at(step, way.to_ned)
    step.memory.hold = Goal(way.to_ned, None, way.evidence, way_back=True)
    step.say(Level.WARNING, f"It is outside, and flies back inside: to {place(way.to_ned)}")


def _take_control_at_top(step: StepContext) -> None:
    """As `_take_control`, with the top of the climb as setpoint: the vehicle may end its climb
    below it.  An ArduPilot shows its hold mode there only where somebody else has put it into it:
    then a goal that has waited for the top is not flown."""
    memory = step.memory
    if memory.autopilot == "ardupilot" and memory.mode is FlightMode.HOLD:
        step.refuse_pending(Refusal(Code.MODE_CHANGED, "somebody else has stopped the climb"))
    _take_control_at(step, memory.top_ned)


def _take_control_at(step: StepContext, hold_ned: Vec3) -> None:
    """ardupilot is asked for guided mode at once; px4 needs setpoints first, for the policy's
    time."""
    memory, times = step.memory, step.policy.control
    step.cancel_commands()
    memory.hold, memory.goal = Goal(hold_ned, None, step.evidence), None
    memory.control = Control.TAKING
    # The first setpoint leaves with the next tick, not with the request.
    stream_s = 0.0 if memory.autopilot == "ardupilot" else times.stream_s + TICK_S
    memory.ask_control_ns = step.after_ns(stream_s)
    step.set_deadline(stream_s + times.timeout_s)


def _ask_guided(step: StepContext) -> None:
    step.memory.ask_control_ns = None
    step.command(CommandKind.GUIDED, "the present position is verified and streamed")


def _gain_control(step: StepContext) -> None:
    step.memory.control = Control.OURS
    step.memory.asked_mode = None


def _release_control(step: StepContext) -> None:
    """Send no more setpoints, and forget every command that has no answer yet."""
    memory = step.memory
    step.cancel_commands()
    memory.control = Control.NONE
    memory.hold = memory.goal = None
    memory.ask_control_ns = None


# ------------------------------------------------------------------------ fence and vehicle


def _switch_fence(step: StepContext) -> None:
    assert step.requested is not None
    assert isinstance(step.requested.request, SwitchFence)
    step.memory.verifier = None
    step.out.append(SwitchedFence(step.requested.request.on))


def _forget_interrupted(step: StepContext) -> None:
    """In STALE: release control, and go back to no state when a fresh position arrives."""
    memory = step.memory
    _release_control(step)
    memory.back_to = None
    memory.grace_until_ns = None


def _forget_vehicle(step: StepContext) -> None:
    """The vehicle is not heard any more: forget its reports, but not that it was heard."""
    memory = step.memory
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


def _await_disarm(step: StepContext) -> None:
    step.set_deadline(step.policy.control.disarm_wait_s)


def _await_landing(step: StepContext) -> None:
    """It bounced: it has the time of a landing again."""
    step.set_deadline(step.policy.land_timeout_s)


def _await_position(step: StepContext) -> None:
    """Arming waits for an estimator that starts."""
    task = step.memory.task
    assert task is not None
    step.memory.task = replace(task, waiting=CommandKind.ARM)
    step.set_deadline(step.policy.arm_timeout_s)
    step.say(Level.INFO, "no position yet (the estimator is starting): arming waits for one")


def _drop_deadline(step: StepContext) -> None:
    step.set_deadline(None)


def _note_lift_off(step: StepContext) -> None:
    step.memory.lifted = True


def _note_force_request(step: StepContext) -> None:
    """Remember when a forced disarm was asked for first; only a second request has it."""
    step.memory.force_asked_ns = step.now_ns
    step.say(Level.WARNING, "ask for the forced disarm again within 5 s to have it")


# ------------------------------------------------------------------------------ their names


def _do(
    text: str, perform: Callable[[StepContext], None]
) -> tuple[str, Callable[[StepContext], None]]:
    """A member of `Action`; in a bare pair the types would not be checked."""
    return text, perform


class Action(StrEnum):
    """What a branch does: its text in the printed table, and the function that emits effects and
    changes the gate's memory."""

    perform: Callable[[StepContext], None]

    def __new__(cls, text: str, perform: Callable[[StepContext], None]) -> Self:
        member = str.__new__(cls, text)
        member._value_ = text
        member.perform = perform
        return member

    VERIFY_GOAL = _do("verify the pending goal", _verify_goal)
    FLY_GOAL = _do("accept the goal and fly it", _fly_goal)
    REFUSE_GOAL = _do("refuse the goal", _refuse_goal)
    HOLD_AT_GOAL = _do("hold at the goal", _hold_at_goal)
    TAKE_CONTROL = _do("stream the present position", _take_control)
    TAKE_CONTROL_ON_WAY_BACK = _do("stream the way back inside", _take_control_on_way_back)
    TAKE_CONTROL_AT_TOP = _do("stream the top of the climb", _take_control_at_top)
    FLY_TO_TOP = _do("fly to the top of the climb", _fly_to_top)
    ASK_GUIDED = _do("command guided", _ask_guided)
    SET_GUIDED = _do("command guided on the ground", commanding.set_guided)
    GAIN_CONTROL = _do("control is ours", _gain_control)
    RELEASE_CONTROL = _do("let control go", _release_control)
    ARM = _do("command arm", commanding.arm)
    DISARM = _do("command disarm", commanding.disarm)
    FORCE_DISARM = _do("command forced disarm", commanding.force_disarm)
    TAKE_OFF = _do("command take-off", commanding.take_off)
    SEND_WAITING = _do("send the command that waited", commanding.send_waiting)
    LAND = _do("command land", commanding.land)
    LAND_MODE_ONLY = _do("command land unseen", commanding.land_mode_only)
    RETURN = _do("command return", commanding.return_home)
    HOLD = _do("command hold", holding.hold)
    HOLD_UNASKED = _do("command hold unasked", holding.hold_unasked)
    HOLD_MODE_ONLY = _do("command hold unseen", holding.hold_mode_only)
    REPEAT_HOLD = _do("command hold again", holding.repeat_hold)
    CONFIRM_HOLD = _do("hold is confirmed", holding.confirm_hold)
    STOP_AWAITING_MODE = _do("no mode is awaited any more", holding.stop_awaiting_mode)
    VERIFY_HELD_POINT = _do("verify the held point anew", holding.verify_held_point)
    BRAKE = _do("send the brake setpoint", holding.brake)
    TAKE_PHOTO = _do("command photo", commanding.photo)
    START_MISSION = _do("command mission start", commanding.start_mission)
    SWITCH_FENCE = _do("switch the fence", _switch_fence)
    START_GRACE = _do("keep the verified stream for its grace", holding.start_grace)
    STOP_STREAM = _do("stop the stream", holding.stop_stream)
    FORGET_VEHICLE = _do("forget the vehicle", _forget_vehicle)
    FORGET_INTERRUPTED = _do("forget what was interrupted", _forget_interrupted)
    AWAIT_DISARM = _do("wait shortly for disarm", _await_disarm)
    AWAIT_LANDING = _do("wait for the landing again", _await_landing)
    AWAIT_POSITION = _do("wait for a position", _await_position)
    DROP_DEADLINE = _do("let it take as long as it takes", _drop_deadline)
    NOTE_LIFT_OFF = _do("note the lift-off", _note_lift_off)
    NOTE_FORCE_REQUEST = _do("note the first asking", _note_force_request)
    BEGIN_STREAM = _do("the stream begins", streaming.begin)
    FLY_SAMPLE = _do("fly the sample", streaming.fly)
    NOTE_SAMPLE = _do("note that it came", streaming.note)
    NOTE_GOOD_SAMPLE = _do("note that it is good again", streaming.note_good)
    HOLD_IN_PLACE = _do("hold in place of the stream", streaming.hold_in_place)
    END_STREAM = _do("end the stream and hold in place", streaming.end)
