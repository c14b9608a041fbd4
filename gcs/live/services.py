"""The services that a viewer can call: their requests, and what they ask the station for.

A request is a JSON object, an empty text counts as an empty one.  The answer is an `Answer`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal, get_args

import msgspec

from gcs import ipc
from gcs.enu_text import DECIMALS
from gcs.frames import Vec3
from gcs.live.parameters import Parameters

MAX_REQUEST_BYTES = 4_096
Direction = Literal["north", "south", "east", "west", "up", "down"]
_OFFSET_ENU: Mapping[str, Vec3] = {
    "north": (0.0, 1.0, 0.0),
    "south": (0.0, -1.0, 0.0),
    "east": (1.0, 0.0, 0.0),
    "west": (-1.0, 0.0, 0.0),
    "up": (0.0, 0.0, 1.0),
    "down": (0.0, 0.0, -1.0),
}


class Answer(msgspec.Struct, frozen=True):
    """The response of every service: what became of the request, and why in one sentence."""

    accepted: bool
    sentence: str
    code: str = ""
    operation: int = 0  # the station's number of an accepted request
    numbers: dict[str, float | None] = {}  # what a refusal was decided on


class Plain(msgspec.Struct, frozen=True):
    """A request without arguments."""


class TakeOff(msgspec.Struct, frozen=True):
    up_m: float  # above the take-off point


class GoTo(msgspec.Struct, frozen=True):
    """Metres east, north, up of the local origin; without `up_m` the parameter's height."""

    east_m: float
    north_m: float
    up_m: float | None = None
    yaw_deg: float | None = None  # clockwise from north


class Step(msgspec.Struct, frozen=True):
    """One step of the parameter `step_m` from the goal that is flown to, else from where it is."""

    direction: Direction


class TakeControl(msgspec.Struct, frozen=True):
    code: str  # printed by the program that has opened the live view


@dataclass(frozen=True, slots=True)
class Service:
    """`word` is of `ipc.Ask`; `anyone`: a viewer that only looks may call it."""

    word: str
    request: type[msgspec.Struct]
    anyone: bool = False


SERVICES: Mapping[str, Service] = {
    "abort": Service("abort", Plain, anyone=True),
    "hold": Service("hold", Plain, anyone=True),
    "take_control": Service("station_take", TakeControl, anyone=True),
    "land": Service("land", Plain),
    "rtl": Service("rtl", Plain),
    "arm": Service("arm", Plain),
    "takeoff": Service("takeoff", TakeOff),
    "goto": Service("goto", GoTo),
    "step": Service("goto", Step),
    "resume": Service("resume", Plain),
}


class BadCallError(ValueError):
    """The request of a service cannot be read, or not be meant: one sentence why."""


Request = Plain | TakeOff | GoTo | Step | TakeControl


def request_of(service: str, payload: bytes) -> Request:
    """The request of a known service.  Raises BadCallError."""
    kind = SERVICES[service].request
    if len(payload) > MAX_REQUEST_BYTES:
        raise BadCallError(f"a request of {len(payload)} bytes is none")
    try:
        made = msgspec.json.decode(payload.strip() or b"{}", type=kind)
    except (msgspec.DecodeError, RecursionError) as error:
        raise BadCallError(f"the request of {service} cannot be read: {error}") from error
    assert isinstance(made, Request)
    return made


def ask_of(
    service: str, request: Request, parameters: Parameters, snapshot: ipc.Snapshot | None
) -> ipc.Ask:
    """What the station is asked for, numbered by whoever sends it.  Raises BadCallError."""
    word = SERVICES[service].word
    match request:
        case TakeOff(up_m):
            return ipc.Ask(0, word, up_m=up_m)
        case GoTo(east_m, north_m, up_m, yaw_deg):
            up_m = goal_height_m(parameters, snapshot) if up_m is None else up_m
            return ipc.Ask(0, word, goal_enu=(east_m, north_m, up_m), yaw_deg=yaw_deg)
        case Step(direction):
            return ipc.Ask(0, word, goal_enu=_stepped(direction, parameters.step_m, snapshot))
        case Plain() | TakeControl():
            return ipc.Ask(0, word)


def goal_height_m(parameters: Parameters, snapshot: ipc.Snapshot | None) -> float | None:
    """Of a goal whose height is not given; None where no height is known, which is refused."""
    if parameters.goal_height_m > 0.0:
        return parameters.goal_height_m
    if snapshot is None or snapshot.pos_enu is None:
        return None
    return _as_shown(snapshot.pos_enu[2])


def _stepped(direction: str, step_m: float, snapshot: ipc.Snapshot | None) -> Vec3:
    start_enu = None if snapshot is None else snapshot.active_goal_enu or snapshot.pos_enu
    if start_enu is None or not all(map(math.isfinite, start_enu)):
        raise BadCallError("a step needs a position to step from, and none is known")
    east, north, up = (
        _as_shown(at_m + step_m * share)
        for at_m, share in zip(start_enu, _OFFSET_ENU[direction], strict=True)
    )
    return (east, north, up)


def _as_shown(metres: float) -> float:
    """To the centimetre: what is asked for and what is read of it are the same."""
    return round(metres, DECIMALS)


def schema_of(kind: type[msgspec.Struct]) -> bytes:
    """A JSON schema with plain types, from which a viewer makes its form."""
    properties: dict[str, dict[str, object]] = {}
    required = []
    for field in msgspec.structs.fields(kind):
        choices = get_args(Direction) if field.type is Direction else ()
        plain = {bool: "boolean", str: "string", int: "integer"}.get(field.type, "number")
        if choices:
            properties[field.name] = {"type": "string", "enum": list(choices)}
        elif field.name == "numbers":
            properties[field.name] = {"type": "object"}
        else:
            properties[field.name] = {"type": plain}
        if field.required:
            required.append(field.name)
    schema = {"title": kind.__name__, "type": "object", "properties": properties}
    return msgspec.json.encode({**schema, "required": required} if required else schema)
