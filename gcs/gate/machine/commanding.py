"""The actions that send a command to the vehicle; those for hold mode are in `holding.py`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Final

from gcs.frames import as_on_the_wire
from gcs.gate.effects import CommandKind, Level
from gcs.gate.machine.holding import repeat_hold, verify_held_point
from gcs.gate.machine.step_context import StepContext
from gcs.gate.requests import StartMission, TakeOff
from gcs.gate.states import Control, FlightMode

ARM_FROM: Final[Mapping[str, tuple[frozenset[FlightMode], CommandKind]]] = MappingProxyType(
    {
        "px4": (
            frozenset({FlightMode.HOLD, FlightMode.OTHER}),
            CommandKind.HOLD,
        ),
        "ardupilot": (frozenset({FlightMode.GUIDED}), CommandKind.GUIDED),
    }
)
"""For each autopilot the modes that it arms in, and the command that leads there from another.

px4 is in OFFBOARD again once it disarms after a flight in it, and does not arm there without
setpoints.  It takes NAV_TAKEOFF and the mode of a mission disarmed, and flies as soon as it is
armed (all recorded from PX4 1.14.3): such an arming would be a take-off that nobody has judged.

An ArduCopter keeps a take-off that it was told in GUIDED until it leaves that mode, over a
disarming too, and may begin it when it is armed again (from memory of its source; where its
throttle stick is above zero).  So it leaves a GUIDED in which it was armed before.
"""


def arm(step: StepContext) -> None:
    """Command arming, after a mode that the autopilot arms in."""
    step.set_deadline(step.policy.control.timeout_s)
    _arm_or_its_mode(step, "asked for on the ground")


def _arm_or_its_mode(step: StepContext, reason: str) -> None:
    memory = step.memory
    modes, first = ARM_FROM.get(memory.autopilot, (frozenset(FlightMode), CommandKind.HOLD))
    if memory.mode not in modes:
        _command_after(step, first, CommandKind.ARM)
    elif memory.guided_used and memory.autopilot == "ardupilot":
        _command_after(step, CommandKind.HOLD, CommandKind.ARM)
    else:
        step.command(CommandKind.ARM, reason)


def _command_after(step: StepContext, first: CommandKind, then: CommandKind) -> None:
    """Command the mode `first`; `then` follows once the heartbeat shows it."""
    task = step.memory.task
    assert task is not None
    step.memory.task = replace(task, waiting=then)
    if first is CommandKind.HOLD:
        repeat_hold(step)
    else:
        step.command(first, f"the vehicle does not {then.value.replace('_', ' ')} in its mode")


def send_waiting(step: StepContext) -> None:
    """Send the command that waited for its mode; arming may wait for one more."""
    task = step.memory.task
    assert task is not None
    assert task.waiting is not None
    step.memory.task = replace(task, waiting=None)
    if task.waiting is CommandKind.TAKE_OFF:
        _climb(step)
        return
    _arm_or_its_mode(step, "the vehicle shows the mode for it")
    if step.memory.task is not None and step.memory.task.waiting is None:
        step.set_deadline(step.policy.control.timeout_s)  # its answer has as long as any


def set_guided(step: StepContext) -> None:
    """Command guided mode to a vehicle that stands and moves nothing in it."""
    step.set_deadline(step.policy.control.timeout_s)
    step.command(CommandKind.GUIDED, "asked for on the ground, where it stands still in it")


def disarm(step: StepContext) -> None:
    step.set_deadline(step.policy.control.timeout_s)
    step.command(CommandKind.DISARM, "on the ground")


def force_disarm(step: StepContext) -> None:
    step.set_deadline(step.policy.control.timeout_s)
    step.command(CommandKind.FORCE_DISARM, "allowed by the policy and asked for twice")


def take_off(step: StepContext) -> None:
    """Note from where and to what height it climbs, and command the take-off."""
    memory, task = step.memory, step.memory.task
    assert task is not None
    assert isinstance(task.requested.request, TakeOff)
    assert memory.pos_ned is not None
    memory.control = Control.OURS
    memory.lifted = False
    memory.ground_down_m = memory.pos_ned[2]
    north_m, east_m, down_m = memory.pos_ned
    top_down_m = as_on_the_wire(down_m - task.requested.request.up_m)
    memory.top_ned = (north_m, east_m, top_down_m)
    step.set_deadline(step.policy.takeoff.timeout_s)
    if memory.autopilot == "ardupilot" and memory.mode is not FlightMode.GUIDED:
        _command_after(step, CommandKind.GUIDED, CommandKind.TAKE_OFF)
    else:
        _climb(step)


def _climb(step: StepContext) -> None:
    memory, task = step.memory, step.memory.task
    assert task is not None
    assert isinstance(task.requested.request, TakeOff)
    step.command(CommandKind.TAKE_OFF, "the climb is verified", up_m=task.requested.request.up_m)
    memory.takeoff_until_ns = step.after_ns(2 * step.policy.control.timeout_s)
    if memory.autopilot != "ardupilot":
        step.await_mode(FlightMode.TAKEOFF)


def _fly_by_itself(
    step: StepContext, kind: CommandKind, reason: str, seconds: float | None, seq: int | None = None
) -> None:
    """Command a mode in which the vehicle flies by itself.  One that follows our setpoints is held
    where it is until it shows that mode.

    `seconds` is the deadline of the request; None: it has none.  `seq` is where a mission begins.
    """
    memory = step.memory
    step.cancel_commands()
    memory.goal = memory.hold = None
    if memory.control is Control.OURS and memory.mode is FlightMode.GUIDED and memory.airborne:
        verify_held_point(step)
    memory.control = Control.OURS
    memory.ask_control_ns = None
    step.set_deadline(seconds)
    step.command(kind, reason, seq=seq)


def land(step: StepContext) -> None:
    _fly_by_itself(
        step, CommandKind.LAND, "landing in place is never refused", step.policy.land_timeout_s
    )


def land_mode_only(step: StepContext) -> None:
    """Command landing to a vehicle that is not heard; control stays as it is."""
    step.set_deadline(step.policy.land_timeout_s)
    step.command(CommandKind.LAND, "landing in place is never refused")


def return_home(step: StepContext) -> None:
    """Command the return; a blocked one that the policy forwards is announced."""
    if step.why is not None:
        step.say(Level.WARNING, f"{step.why.sentence}; the policy forwards it")
    _fly_by_itself(step, CommandKind.RETURN, "the return path is judged", None)


def start_mission(step: StepContext) -> None:
    memory = step.memory
    memory.lifted = memory.airborne
    memory.mission_over = False
    request = step.requested.request if step.requested is not None else None
    seq = request.seq if isinstance(request, StartMission) else None
    reason = "the mission on board is verified"
    _fly_by_itself(step, CommandKind.START_MISSION, reason, None, seq)


def photo(step: StepContext) -> None:
    step.set_deadline(step.policy.photo_timeout_s)
    step.command(CommandKind.PHOTO, "asked for while hovering")
