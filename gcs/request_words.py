"""The words of requests: one table for whoever types, sends, allows or does them.

A row says how a word is typed and what is sent for it, who does it, who may ask for it, and what
the gate is asked for.  Some words are two (`mission fly`); a few are for the console itself, and a
few are never typed.  `gcs/operator/line_parser.py` reads them from text.  A request travels as
`ipc.Ask`, with the arguments as they were typed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from enum import Enum
from functools import partial
from typing import Final, TypeAlias

from gcs.frames import finite_or_nan, heading_rad, ned_from_enu
from gcs.gate import requests as gate
from gcs.ipc import EVERY, Ask, Circle, Maybe3


class ArgumentKind(Enum):
    """What an argument must look like."""

    NUMBER = "number"
    DEGREES = "number of degrees from -360 to 360"
    SECONDS = "number of seconds, not negative"
    COUNT = "whole number, not negative"
    NAME = "name"
    FILE = "file"
    SWITCH = "on or off"
    FLAG = "option"


@dataclass(frozen=True, slots=True)
class Argument:
    """`name` is what the help shows; for a FLAG it is what must be typed, anywhere.  `field` is the
    one of `Ask` that it goes into, where a word has no `build`."""

    name: str
    kind: ArgumentKind
    field: str = ""
    optional: bool = False


class ActsAtOnce(Enum):
    """When a word does not wait for the line before it.  Otherwise its turn comes."""

    NEVER = "never"
    MARKED = "with a ! before it"
    TYPED = "typed on a terminal, or with a ! before it"
    ALWAYS = "always"


class Doer(Enum):
    """Who does what a word asks for."""

    GATE = "the vehicle's gate"
    JOB = "a job about missions"
    TRANSFER = "a job about missions that moves nothing: an abort of it stops the job alone"
    READER = "a job about what the vehicle keeps: parameters, files, logs; it moves nothing"
    ORBIT = "the circle that the station flies"
    LEGS = "how the station flies the next legs"
    STATION = "the station, at once"
    CONSOLE = "the operator's program itself"


@dataclass(frozen=True, slots=True)
class SendRequests:
    """Send these one after the other, each when the one before is complete.

    Their ids are given when they are sent.
    """

    requests: tuple[Ask, ...]


@dataclass(frozen=True, slots=True)
class FlyVelocity:
    """Stream this velocity, metres per second east, north and up, for so many seconds."""

    v_enu: tuple[float, float, float]
    seconds: float


@dataclass(frozen=True, slots=True)
class ChooseVehicle:
    """From now on the vehicle with this system id is meant."""

    sysid: int


@dataclass(frozen=True, slots=True)
class Wait:
    """Do nothing for so many seconds of flight."""

    seconds: float


@dataclass(frozen=True, slots=True)
class ShowState:
    """Print the latest snapshot."""


@dataclass(frozen=True, slots=True)
class ShowPreflight:
    """Print what matters before a take-off."""


@dataclass(frozen=True, slots=True)
class ShowHelp:
    """Print the words."""


@dataclass(frozen=True, slots=True)
class Quit:
    """Leave in good order."""


Action: TypeAlias = (
    SendRequests | FlyVelocity | ChooseVehicle | Wait | ShowState | ShowPreflight | ShowHelp | Quit
)


class BadAskError(ValueError):
    """The line is no request at all (a word or an argument is missing or unknown)."""


@dataclass(frozen=True, slots=True)
class Word:
    """`help`: empty for a word that is never typed.  `given`: arguments, for an example.  `build`
    makes of the arguments what the word does; None: it sends the request of its name.

    `gate`: what the gate is asked for, or how that is made.  `stops`: it makes the vehicle safer;
    nothing is to delay it, and where no vehicle is named it is for every one that flies.  `anyone`:
    every operator may ask for it, in control or not, as for stops.  `needs_control`: the gate
    refuses it while somebody else flies the vehicle.
    """

    name: str
    help: str = ""
    arguments: tuple[Argument, ...] = ()
    given: str = ""
    build: Callable[..., Action] | None = None
    at_once: ActsAtOnce = ActsAtOnce.NEVER
    doer: Doer = Doer.GATE
    gate: gate.Request | Callable[[Ask], gate.Request] | None = None
    stops: bool = False
    anyone: bool = False
    needs_control: bool = False

    @property
    def request(self) -> str:
        """As `Ask.word` has it."""
        return self.name.replace(" ", "_").replace("-", "_")

    @property
    def usage(self) -> str:
        """The arguments as the help shows them, `EAST NORTH UP [YAW_DEG]`."""
        return " ".join(f"[{a.name}]" if a.optional else a.name for a in self.arguments)

    @property
    def example(self) -> str:
        return f"{self.name} {self.given}".rstrip()

    def action(self, *typed: float | str | bool) -> Action:
        """What it does with these arguments, in the order of the table."""
        if self.build is not None:
            return self.build(*typed)
        fields = {a.field: value for a, value in zip(self.arguments, typed, strict=False)}
        return SendRequests((Ask(0, self.request, **fields),))  # type: ignore[arg-type]


def _goto(east: float, north: float, up: float, yaw_deg: float | None = None) -> Action:
    return SendRequests((Ask(0, "goto", goal_enu=(east, north, up), yaw_deg=yaw_deg),))


def _goto_global(
    lat: float, lon: float, up: float, amsl: bool, yaw_deg: float | None = None
) -> Action:
    goal = (lat, lon, up)
    return SendRequests((Ask(0, "goto", goal_global=goal, amsl=amsl, yaw_deg=yaw_deg),))


def _move(east: float, north: float, up: float, yaw_deg: float | None = None) -> Action:
    return SendRequests((Ask(0, "goto", move_enu=(east, north, up), yaw_deg=yaw_deg),))


def _forward(forward: float, right: float = 0.0, up: float = 0.0) -> Action:
    return SendRequests((Ask(0, "goto", move_body=(forward, right, up)),))


def _orbit(radius: float, speed: float, turns: float = 1.0, *centre: float) -> Action:
    if centre and len(centre) != 3:
        raise BadAskError("the centre is EAST NORTH UP, or nothing: where the vehicle is")
    circle = Circle((centre[0], centre[1], centre[2]) if centre else None, radius, speed, turns)
    return SendRequests((Ask(0, "orbit", orbit=circle),))


def _velocity(east: float, north: float, up: float, seconds: float = 1.0) -> Action:
    return FlyVelocity((east, north, up), seconds)


def _stop(word: str, every: bool) -> Action:
    return SendRequests((Ask(0, word, vehicle=EVERY if every else 0),))


def _vehicle(sysid: int) -> Action:
    if not 1 <= sysid <= 255:
        raise BadAskError(f"a system id is from 1 to 255, got {sysid}")
    return ChooseVehicle(sysid)


def _mission_fly(path: str) -> Action:
    return SendRequests((Ask(0, "mission_upload", path=path), Ask(0, "mission_start")))


def goals_of(ask: Ask) -> dict[str, Maybe3]:
    """Where it is to lead, by the name of the field that says so; of a go-to exactly one."""
    fields = ("goal_enu", "move_enu", "move_body", "goal_global")
    given = {name: getattr(ask, name) for name in fields}
    return {name: goal for name, goal in given.items() if goal is not None}


def _to_a_goal(ask: Ask) -> gate.GoTo:
    if ask.word == "heading" and ask.yaw_deg is None:
        raise BadAskError("heading needs a number of degrees")
    if ask.goal_enu is None or len(goals_of(ask)) > 1:
        raise BadAskError("goto needs one goal: goal_enu, move_enu, move_body or goal_global")
    goal_ned = ned_from_enu(finite_or_nan(ask.goal_enu))
    yaw_rad = None if ask.yaw_deg is None else heading_rad(ask.yaw_deg)
    return gate.GoTo(goal_ned, yaw_rad, ask.speed_m_s)


def _up(ask: Ask) -> gate.TakeOff:
    return gate.TakeOff(math.nan if ask.up_m is None else ask.up_m)


_ENU = tuple(Argument(name, ArgumentKind.NUMBER) for name in ("EAST", "NORTH", "UP"))
_YAW = Argument("YAW_DEG", ArgumentKind.DEGREES, optional=True)
_AMSL = Argument("--amsl", ArgumentKind.FLAG, optional=True)
_SECONDS = Argument("SECONDS", ArgumentKind.SECONDS)
_FOR_SECONDS = Argument("SECONDS", ArgumentKind.SECONDS, optional=True)
_ALL = (Argument("all", ArgumentKind.FLAG, optional=True),)
_FILE = (Argument("FILE", ArgumentKind.FILE, "path"),)
_TYPED = ActsAtOnce.TYPED


def _of_plan(name: str, what: str) -> tuple[Word, ...]:
    """Words for a fence or rally points, beside those for missions."""
    send = f"send the {name} of a file to the vehicle and read it back"
    read = f"read {what} into a file"
    transfer = Doer.TRANSFER
    return (
        Word(f"{name} upload", send, _FILE, f"missions/{name}.plan", doer=transfer),
        Word(f"{name} download", read, _FILE, "on_board.plan", doer=transfer),
        Word(f"{name} clear", f"remove {what}", doer=transfer),
    )


TABLE: Final[tuple[Word, ...]] = (
    Word("control", "take control of a flying vehicle", gate=gate.TakeControl()),
    Word("arm", "arm the motors", gate=gate.Arm()),
    Word(
        "takeoff",
        "climb to UP metres above the take-off point, take control and hover",
        (Argument("UP", ArgumentKind.NUMBER, "up_m"),),
        "2",
        gate=_up,
    ),
    Word(
        "goto",
        "fly straight to a point, metres from the local origin, and hover; "
        "YAW_DEG is clockwise from north",
        (*_ENU, _YAW),
        "3 0 2",
        _goto,
        gate=_to_a_goal,
        needs_control=True,
    ),
    Word(
        "goto-global",
        "fly straight to latitude, longitude (degrees) and metres above home; --amsl: above mean "
        "sea level",
        (*(Argument(name, ArgumentKind.NUMBER) for name in ("LAT", "LON", "UP")), _AMSL, _YAW),
        "47.397760 8.545650 3",
        _goto_global,
        doer=Doer.CONSOLE,
        needs_control=True,
    ),
    Word(
        "move",
        "fly straight to a point so many metres east, north and up of where it is",
        (*_ENU, _YAW),
        "2 0 0",
        _move,
        doer=Doer.CONSOLE,
        needs_control=True,
    ),
    Word(
        "forward",
        "fly straight so many metres where its nose points, to the right of that, and up",
        (
            Argument("METRES", ArgumentKind.NUMBER),
            Argument("RIGHT", ArgumentKind.NUMBER, optional=True),
            Argument("UP", ArgumentKind.NUMBER, optional=True),
        ),
        "2",
        _forward,
        doer=Doer.CONSOLE,
        needs_control=True,
    ),
    Word(
        "heading",
        "turn the nose, and nothing else; YAW_DEG is clockwise from north",
        (Argument("YAW_DEG", ArgumentKind.DEGREES, "yaw_deg"),),
        "90",
        gate=_to_a_goal,
        needs_control=True,
    ),
    Word(
        "speed",
        "the most that the next legs of goto, move and others are flown at, within the policy",
        (Argument("M_S", ArgumentKind.NUMBER, "speed_m_s"),),
        "2",
        doer=Doer.LEGS,
    ),
    Word(
        "orbit",
        "fly round a circle, nose to its centre (where it is); a negative RADIUS is "
        "counter-clockwise; TURNS (1), 0: until something else is asked for",
        (
            Argument("RADIUS", ArgumentKind.NUMBER),
            Argument("SPEED", ArgumentKind.NUMBER),
            Argument("TURNS", ArgumentKind.NUMBER, optional=True),
            *(replace(each, optional=True) for each in _ENU),
        ),
        "5 1",
        _orbit,
        doer=Doer.ORBIT,
        needs_control=True,
    ),
    Word(
        "velocity",
        "fly so many m/s east, north and up for SECONDS (1), then hover",
        (*_ENU, _FOR_SECONDS),
        "1 0 0 3",
        _velocity,
        doer=Doer.CONSOLE,
    ),
    Word(
        "land",
        "land where it is; all: every vehicle that flies",
        _ALL,
        build=partial(_stop, "land"),
        at_once=_TYPED,
        gate=gate.Land(),
        stops=True,
    ),
    Word(
        "rtl",
        "return to home and land; all: every vehicle that flies",
        _ALL,
        build=partial(_stop, "rtl"),
        at_once=_TYPED,
        gate=gate.ReturnHome(),
        stops=True,
    ),
    Word(
        "hold",
        "stop and hold, in the vehicle's own hold mode; all: every vehicle that flies",
        _ALL,
        build=partial(_stop, "hold"),
        at_once=_TYPED,
        gate=gate.Hold(),
        stops=True,
    ),
    Word(
        "abort",
        "stop now and forget the goal; never refused, waits for nothing; all: every vehicle that "
        "flies",
        _ALL,
        build=partial(_stop, "abort"),
        at_once=ActsAtOnce.ALWAYS,
        gate=gate.Abort(),
        stops=True,
    ),
    Word("resume", "after a hold: hover under our control", gate=gate.Resume()),
    Word(
        "photo",
        "take a picture; moves are refused meanwhile",
        gate=gate.TakePhoto(),
        needs_control=True,
    ),
    Word(
        "disarm",
        "stop the motors on the ground; --force asks for it in the air",
        (Argument("--force", ArgumentKind.FLAG, "force", optional=True),),
        at_once=ActsAtOnce.MARKED,
        gate=lambda ask: gate.Disarm(ask.force),
        anyone=True,
    ),
    Word(
        "mode",
        "ask for a flight mode by the autopilot's own name",
        (Argument("NAME", ArgumentKind.NAME, "mode"),),
        "LOITER",
    ),
    Word(
        "fence",
        "switch the fence, where the policy allows it (the lab's does)",
        (Argument("on|off", ArgumentKind.SWITCH, "on"),),
        "off",
        gate=lambda ask: gate.SwitchFence(ask.on),
    ),
    Word(
        "mission upload",
        "verify a mission file, send it to the vehicle and read it back",
        _FILE,
        "missions/demo.toml",
        doer=Doer.TRANSFER,
    ),
    Word(
        "mission start",
        "fly the mission on board",
        doer=Doer.JOB,
        gate=gate.StartMission(),
        needs_control=True,
    ),
    Word(
        "mission set-current",
        "in the air: where the next start of the mission begins, as MAVLink counts its items",
        (Argument("ITEM", ArgumentKind.COUNT, "item"),),
        "3",
        doer=Doer.TRANSFER,
    ),
    Word(
        "mission fly",
        "upload a mission file, then start it",
        _FILE,
        "missions/demo.toml",
        _mission_fly,
        doer=Doer.CONSOLE,
    ),
    Word(
        "mission download",
        "read the mission on board into a file",
        _FILE,
        "on_board.plan",
        doer=Doer.TRANSFER,
    ),
    Word("mission clear", "remove the mission on board; fence and rally stay", doer=Doer.TRANSFER),
    Word(
        "fence put",
        "put the policy's own fence and its actions on board: the vehicle then keeps it itself",
        doer=Doer.TRANSFER,
    ),
    *_of_plan("fence", "the fence on board"),
    *_of_plan("rally", "the rally points on board"),
    Word(
        "param get",
        "read a parameter of the vehicle",
        (Argument("NAME", ArgumentKind.NAME, "name"),),
        "RTL_RETURN_ALT",
        doer=Doer.READER,
        anyone=True,
    ),
    Word(
        "param set",
        "set a parameter of the vehicle and read it back; what safety stands on only while the "
        "vehicle is disarmed on the ground",
        (
            Argument("NAME", ArgumentKind.NAME, "name"),
            Argument("VALUE", ArgumentKind.NUMBER, "value"),
        ),
        "NAV_DLL_ACT 2",
        doer=Doer.READER,
    ),
    Word(
        "station take",
        "take control over from the operator who has it; it is told",
        doer=Doer.STATION,
        anyone=True,
    ),
    Word(
        "station end",
        "end the station, also one that is kept; a vehicle we fly is told to hold",
        doer=Doer.STATION,
    ),
    Word(
        "vehicle",
        "of several: what follows is for the one with this MAVLink system id",
        (Argument("SYSID", ArgumentKind.COUNT),),
        "2",
        _vehicle,
        doer=Doer.CONSOLE,
    ),
    Word(
        "wait",
        "do nothing for so many seconds of flight",
        (_SECONDS,),
        "2.5",
        Wait,
        doer=Doer.CONSOLE,
    ),
    Word(
        "state",
        "print what the vehicle reports; so does status",
        build=ShowState,
        at_once=_TYPED,
        doer=Doer.CONSOLE,
    ),
    Word(
        "preflight",
        "print what passes and what fails before a take-off, and what mends it",
        build=ShowPreflight,
        doer=Doer.CONSOLE,
    ),
    Word("help", "print these words; so does ?", build=ShowHelp, at_once=_TYPED, doer=Doer.CONSOLE),
    Word(
        "quit",
        "leave; a vehicle we fly is told to hold",
        build=Quit,
        at_once=_TYPED,
        doer=Doer.CONSOLE,
    ),
    Word("mission check", doer=Doer.JOB),
    Word("param list", doer=Doer.READER, anyone=True),
    Word("file read", doer=Doer.READER, anyone=True),
    Word("file list", doer=Doer.READER, anyone=True),
    Word("file crc", doer=Doer.READER, anyone=True),
    Word("log list", doer=Doer.READER, anyone=True),
    Word("log read", doer=Doer.READER, anyone=True),
    Word("stream begin", gate=gate.BeginStream()),
    Word("stream end", gate=gate.EndStream()),
    Word("station release", doer=Doer.STATION, anyone=True),
)

WORDS: Final = tuple(word for word in TABLE if word.help)
"""Those that are typed, in the order of the help."""
REQUESTS: Final[Mapping[str, Word]] = {
    word.request: word for word in TABLE if word.doer is not Doer.CONSOLE
}
"""Those that a station is asked for, as `Ask.word`."""
STOPS: Final = frozenset(name for name, word in REQUESTS.items() if word.stops)
ALWAYS_HEARD: Final = STOPS | {name for name, word in REQUESTS.items() if word.anyone}
"""Requests of any operator, in control or not."""


def doer_of(word: str) -> Doer:
    """Who is to do a request; of an unknown word the gate, as whose request it is refused."""
    return REQUESTS[word].doer if word in REQUESTS else Doer.GATE


OTHER_NAMES: dict[str, str] = {"status": "state", "?": "help"}
"""What is typed for some words as well."""

WORD_BY_NAME: dict[str, Word] = {word.name: word for word in WORDS}


def label(request: Ask) -> str:
    """A request as an operator would type it: the table read backwards."""
    name = request.word
    if name == "goto":
        typed_as = {"move_enu": "move", "move_body": "forward", "goal_global": "goto-global"}
        name = next((typed_as[each] for each in goals_of(request) if each in typed_as), name)
    for first in ("mission", "fence", "rally", "param", "file", "log", "station", "stream"):
        name = name.replace(f"{first}_", f"{first} ")
    parts: list[str] = [name, *(["all"] if request.vehicle == EVERY else [])]
    if request.word == "takeoff":
        parts.append(_shown(request.up_m))
    if request.word == "speed":
        parts.append(_shown(request.speed_m_s))
    for field, goal in goals_of(request).items():
        digits = 10 if field == "goal_global" else 6
        parts += [_shown(number, digits) for number in goal]
    if request.amsl:
        parts.append("--amsl")
    if request.orbit is not None:
        circle = request.orbit
        numbers = (circle.radius_m, circle.speed_m_s, circle.turns, *(circle.centre_enu or ()))
        parts += [f"{number:g}" for number in numbers if number is not None]
    if request.yaw_deg is not None:
        parts.append(_shown(request.yaw_deg))
    if request.word == "fence":
        parts.append("on" if request.on else "off")
    parts += [request.name] if request.name else []
    if request.word == "param_set":
        parts.append("nan" if request.value is None else f"{request.value:.9g}")
    parts += [
        part for part in (request.mode, request.path, "--force" if request.force else "") if part
    ]
    return " ".join(parts)


def _shown(number: float | None, digits: int = 6) -> str:
    return "nan" if number is None else f"{number:.{digits}g}"


def help_lines() -> list[str]:
    """One line a word, for a console's help."""
    width = max(len(f"{word.name} {word.usage}") for word in WORDS)
    lines = [f"{f'{word.name} {word.usage}':{width}}  {word.help}" for word in WORDS]
    lines.append(f"{'LINE &':{width}}  the next line does not wait for the ending of this one")
    at_once = ", ".join(word.name for word in WORDS if word.at_once is not ActsAtOnce.NEVER)
    lines.append(f"{'!LINE':{width}}  does not wait for the line before it: {at_once}")
    return lines
