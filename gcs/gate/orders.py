"""The actions that ask the vehicle for something, but for the hold."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import Final

from gcs.gate.core import Core
from gcs.gate.types import (
    CommandKind,
    Control,
    FlightMode,
    Level,
    TakeOff,
)

ARM_FROM: Final[Mapping[str, tuple[frozenset[FlightMode], CommandKind]]] = MappingProxyType(
    {
        "px4": (
            frozenset(FlightMode) - {FlightMode.LAND, FlightMode.RETURN, FlightMode.MISSION},
            CommandKind.HOLD,
        ),
        "ardupilot": (frozenset({FlightMode.GUIDED}), CommandKind.GUIDED),
    }
)
"""The modes a personality arms in, and what to ask for in any other."""


def arm(core: Core) -> None:
    memory = core.memory
    core.due(core.policy.control.timeout_s)
    modes, first = ARM_FROM.get(memory.personality, (frozenset(FlightMode), CommandKind.HOLD))
    if memory.mode in modes:
        core.command(CommandKind.ARM, "asked for on the ground")
    else:
        _ask_first(core, first, CommandKind.ARM)


def _ask_first(core: Core, first: CommandKind, then: CommandKind) -> None:
    task = core.memory.task
    assert task is not None
    core.memory.task = replace(task, waiting=then)
    core.command(first, f"the vehicle does not {then.value.replace('_', ' ')} in its mode")


def send_waiting(core: Core) -> None:
    task = core.memory.task
    assert task is not None
    assert task.waiting is not None
    core.memory.task = replace(task, waiting=None)
    if task.waiting is CommandKind.TAKE_OFF:
        _climb(core)
    else:
        core.command(task.waiting, "the vehicle shows the mode for it")


def disarm(core: Core) -> None:
    core.due(core.policy.control.timeout_s)
    core.command(CommandKind.DISARM, "on the ground")


def force_disarm(core: Core) -> None:
    core.due(core.policy.control.timeout_s)
    core.command(CommandKind.FORCE_DISARM, "allowed by the policy and asked for twice")


def take_off(core: Core) -> None:
    memory, task = core.memory, core.memory.task
    assert task is not None
    assert isinstance(task.request.wish, TakeOff)
    assert memory.pos_ned is not None
    memory.control = Control.OURS
    memory.lifted = False
    memory.stood_down_m = memory.pos_ned[2]
    memory.top_down_m = memory.pos_ned[2] - task.request.wish.up_m
    core.due(core.policy.takeoff.timeout_s)
    if memory.personality == "ardupilot" and memory.mode is not FlightMode.GUIDED:
        _ask_first(core, CommandKind.GUIDED, CommandKind.TAKE_OFF)
    else:
        _climb(core)


def _climb(core: Core) -> None:
    memory, task = core.memory, core.memory.task
    assert task is not None
    assert isinstance(task.request.wish, TakeOff)
    core.command(CommandKind.TAKE_OFF, "the climb is verified", up_m=task.request.wish.up_m)
    memory.takeoff_until_ns = core.after_ns(2 * core.policy.control.timeout_s)
    if memory.personality != "ardupilot":
        core.await_mode(FlightMode.TAKEOFF)


def _fly_by_itself(core: Core, kind: CommandKind, reason: str, seconds: float | None) -> None:
    """A mode in which the vehicle flies by itself, at our command: nothing is streamed."""
    memory = core.memory
    core.cancel_commands()
    memory.control = Control.OURS
    memory.hold = memory.goal = None
    memory.ask_control_ns = None
    core.due(seconds)
    core.command(kind, reason)


def land(core: Core) -> None:
    _fly_by_itself(
        core, CommandKind.LAND, "landing in place is never refused", core.policy.land_timeout_s
    )


def return_home(core: Core) -> None:
    if core.why is not None:
        core.say(Level.WARNING, f"{core.why.sentence}; the policy forwards it")
    _fly_by_itself(core, CommandKind.RETURN, "the return path is judged", None)


def start_mission(core: Core) -> None:
    memory = core.memory
    memory.lifted = memory.airborne
    memory.mission_over = False
    _fly_by_itself(core, CommandKind.START_MISSION, "the mission on board is verified", None)


def photo(core: Core) -> None:
    core.due(core.policy.photo_timeout_s)
    core.command(CommandKind.PHOTO, "asked for while hovering")
