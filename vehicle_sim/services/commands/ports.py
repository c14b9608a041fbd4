"""What the handlers of commands are given, and how they say no."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from vehicle_sim.autopilot.interface import Result, Vehicle
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.services.commands.orders import Answer, Order
from vehicle_sim.services.profile import Profile
from vehicle_sim.services.streams import Streams
from vehicle_sim.services.telemetry.info import Info


class RefusedError(Exception):
    """A command cannot be carried out; the reason goes to the log, the result to the ack."""

    def __init__(self, result: Result, reason: str) -> None:
        super().__init__(reason)
        self.result = result


@dataclass(frozen=True, slots=True)
class CommandContext:
    """One vehicle, as its command handlers see it."""

    vehicle: Vehicle
    profile: Profile
    info: Info
    streams: dict[int, Streams]  # by channel
    ask_for_control: Callable[[Order], Answer] | None = None  # None = anybody commands


Handler: TypeAlias = Callable[[CommandContext, Order], Answer]


@dataclass(frozen=True, slots=True)
class CommandEntry:
    handler: Handler
    place: bool = False  # p5..p7 are a place: COMMAND_INT's frame must be a global one
    only: Personality | None = None  # the other one does not know the command
