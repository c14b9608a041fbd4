"""What operators ask: their words become requests of the gate, their numbers request ids."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gcs import ipc
from gcs.frames import Vec3, as_on_the_wire, ned_from_enu
from gcs.gate import requests
from gcs.gate.states import FlightMode
from gcs.protocol.autopilot import Autopilot, mode_named

FIRST = 1
"""The operator's program that started the station."""


@dataclass(frozen=True, slots=True)
class Asked:
    """One request in the words that it was made in, and which operator (`client`) made it."""

    ask: ipc.Ask
    client: int = 1

    @property
    def word(self) -> str:
        return self.ask.word

    @property
    def source(self) -> str:
        """Who asks, for the gate and the record."""
        return source_of(self.client)


def source_of(client: int) -> str:
    """What the gate and the record call an operator."""
    return "operator" if client == 1 else f"operator {client}"


def client_of(source: str) -> int:
    """The operator whom `source_of` calls so."""
    return int(source.removeprefix("operator") or 1)


class BadAskError(ValueError):
    """The line is no request at all (a word or an argument is missing or unknown)."""


def request_of(ask: ipc.Ask, autopilot: Autopilot | None) -> requests.Request:
    """What the gate is asked for.  Raises BadAskError; mission transfers are not for the gate."""
    match ask.word:
        case "control":
            return requests.TakeControl()
        case "arm":
            return requests.Arm()
        case "disarm":
            return requests.Disarm(ask.force)
        case "takeoff":
            return requests.TakeOff(math.nan if ask.up_m is None else ask.up_m)
        case "goto":
            if ask.goal_enu is None:
                raise BadAskError("goto needs a goal: east, north, up")
            goal_ned = ned_from_enu(finite_or_nan(ask.goal_enu))
            return requests.GoTo(
                goal_ned, None if ask.yaw_deg is None else heading_rad(ask.yaw_deg)
            )
        case "land":
            return requests.Land()
        case "rtl":
            return requests.ReturnHome()
        case "hold":
            return requests.Hold()
        case "abort":
            return requests.Abort()
        case "resume":
            return requests.Resume()
        case "photo":
            return requests.TakePhoto()
        case "fence":
            return requests.SwitchFence(ask.on)
        case "mission_start":
            return requests.StartMission()
        case "stream_begin":
            return requests.BeginStream()
        case "stream_end":
            return requests.EndStream()
        case "mode":
            mode = mode_named(autopilot, ask.mode) if autopilot else None
            if mode is None:
                names = ", ".join(known.name for known in autopilot.modes) if autopilot else ""
                raise BadAskError(f"no mode {ask.mode!r} here; there are: {names or 'none'}")
            sent = autopilot.mode_of_meaning.get(mode.meaning, mode.name) if autopilot else ""
            if sent != mode.name:
                return requests.SetMode(mode.name, FlightMode.OTHER, instead=sent)
            return requests.SetMode(mode.name, mode.meaning)
        case _:
            raise BadAskError(f"no such request: {ask.word!r}")


def finite_or_nan(triple: ipc.Maybe3) -> Vec3:
    """JSON has no NaN: null stands for it, and the gate refuses it by name."""
    a, b, c = (math.nan if value is None else as_on_the_wire(value) for value in triple)
    return (a, b, c)


def heading_rad(yaw_deg: float) -> float:
    """Degrees of any number of turns -> -pi .. pi, as the wire carries it."""
    return as_on_the_wire(math.radians(math.remainder(yaw_deg, 360.0)))


class Requests:
    """Numbers requests and remembers them until their ending is told."""

    def __init__(self) -> None:
        self._next_id = 1
        self._asked: dict[int, Asked] = {}

    def open(self, ask: ipc.Ask, client: int) -> int:
        request_id = self._next_id
        self._next_id += 1
        self._asked[request_id] = Asked(ask, client)
        return request_id

    def get(self, request_id: int) -> Asked:
        return self._asked[request_id]

    def number_of(self, client: int, ask_id: int) -> int | None:
        """The request that a client made as its own number `ask_id`, if it is not over."""
        for request_id, asked in self._asked.items():
            if asked.client == client and asked.ask.id == ask_id:
                return request_id
        return None

    def close(self, request_id: int) -> Asked:
        """The request is over: refused, superseded, or ended."""
        return self._asked.pop(request_id)

    @property
    def open_count(self) -> int:
        return len(self._asked)
