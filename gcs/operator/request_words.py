"""The words that an operator can type: one table for typed lines and for one-shot commands.

Some words are two (`mission fly`).  Most of them send a request to the station, or two in order;
a few are for the console itself.  `gcs/operator/line_parser.py` reads them from text.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import TypeAlias

from gcs.ipc import Ask

STOPS = frozenset({"abort", "hold", "land", "rtl"})
"""Requests (`Ask.word`) that make the vehicle safer: nothing is to delay them."""
NEEDS_CONTROL = frozenset({"goto", "photo", "mission_start"})
"""Requests (`Ask.word`) that the gate refuses while somebody else flies the vehicle."""


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
    """`name` is what the help shows; for a FLAG it is what must be typed."""

    name: str
    kind: ArgumentKind
    optional: bool = False


class ActsAtOnce(Enum):
    """When a word does not wait for the line before it.  Otherwise its turn comes."""

    NEVER = "never"
    MARKED = "with a ! before it"
    TYPED = "typed on a terminal, or with a ! before it"
    ALWAYS = "always"


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
class Wait:
    """Do nothing for so many seconds of flight."""

    seconds: float


@dataclass(frozen=True, slots=True)
class ShowState:
    """Print the latest snapshot."""


@dataclass(frozen=True, slots=True)
class ShowHelp:
    """Print the words."""


@dataclass(frozen=True, slots=True)
class Quit:
    """Leave in good order."""


Action: TypeAlias = SendRequests | FlyVelocity | Wait | ShowState | ShowHelp | Quit


@dataclass(frozen=True, slots=True)
class Values:
    """The arguments as typed, sorted by kind, in the order of the table."""

    numbers: tuple[float, ...] = ()
    text: str = ""
    switch: bool = True
    flagged: bool = False


@dataclass(frozen=True, slots=True)
class Word:
    """`build` makes of the arguments what the word does.

    `moves`: the vehicle moves, starts or stops its motors, or may fly where it may not now.  Such
    a word is never offered for one that was mistyped.
    """

    name: str
    arguments: tuple[Argument, ...]
    help: str
    example: str
    build: Callable[[Values], Action]
    at_once: ActsAtOnce = ActsAtOnce.NEVER
    moves: bool = False

    @property
    def usage(self) -> str:
        """The arguments as the help shows them, `EAST NORTH UP [YAW_DEG]`."""
        return " ".join(f"[{a.name}]" if a.optional else a.name for a in self.arguments)


def _send(word: str) -> Callable[[Values], Action]:
    return lambda _: SendRequests((Ask(0, word),))


def _goto(values: Values) -> Action:
    east, north, up, *yaw = values.numbers
    return SendRequests(
        (Ask(0, "goto", goal_enu=(east, north, up), yaw_deg=yaw[0] if yaw else None),)
    )


def _velocity(values: Values) -> Action:
    east, north, up, *seconds = values.numbers
    return FlyVelocity((east, north, up), seconds[0] if seconds else VELOCITY_S)


def _mission_set_current(values: Values) -> Action:
    return SendRequests((Ask(0, "mission_set_current", item=int(values.numbers[0])),))


def _mission_fly(values: Values) -> Action:
    return SendRequests((Ask(0, "mission_upload", path=values.text), Ask(0, "mission_start")))


VELOCITY_S = 1.0
"""How long a velocity is flown where nothing is said."""

_UP = Argument("UP", ArgumentKind.NUMBER)
_FILE = Argument("FILE", ArgumentKind.FILE)

WORDS: tuple[Word, ...] = (
    Word(
        "control", (), "take control of a flying vehicle", "control", _send("control"), moves=True
    ),
    Word("arm", (), "arm the motors", "arm", _send("arm"), moves=True),
    Word(
        "takeoff",
        (_UP,),
        "climb to UP metres above the take-off point, take control and hover",
        "takeoff 2",
        lambda values: SendRequests((Ask(0, "takeoff", up_m=values.numbers[0]),)),
        moves=True,
    ),
    Word(
        "goto",
        (
            Argument("EAST", ArgumentKind.NUMBER),
            Argument("NORTH", ArgumentKind.NUMBER),
            _UP,
            Argument("YAW_DEG", ArgumentKind.DEGREES, optional=True),
        ),
        "fly straight to a point, metres from the local origin, and hover; "
        "YAW_DEG is clockwise from north",
        "goto 3 0 2",
        _goto,
        moves=True,
    ),
    Word(
        "velocity",
        (
            Argument("EAST", ArgumentKind.NUMBER),
            Argument("NORTH", ArgumentKind.NUMBER),
            _UP,
            Argument("SECONDS", ArgumentKind.SECONDS, optional=True),
        ),
        "fly so many m/s east, north and up for SECONDS (1), then hover",
        "velocity 1 0 0 3",
        _velocity,
        moves=True,
    ),
    Word(
        "land",
        (),
        "land where it is",
        "land",
        _send("land"),
        at_once=ActsAtOnce.TYPED,
        moves=True,
    ),
    Word(
        "rtl",
        (),
        "return to home and land",
        "rtl",
        _send("rtl"),
        at_once=ActsAtOnce.TYPED,
        moves=True,
    ),
    Word(
        "hold",
        (),
        "stop and hold, in the vehicle's own hold mode",
        "hold",
        _send("hold"),
        at_once=ActsAtOnce.TYPED,
    ),
    Word(
        "abort",
        (),
        "stop now and forget the goal; never refused, waits for nothing",
        "abort",
        _send("abort"),
        at_once=ActsAtOnce.ALWAYS,
    ),
    Word(
        "resume",
        (),
        "after a hold: hover under our control",
        "resume",
        _send("resume"),
        moves=True,
    ),
    Word("photo", (), "take a picture; moves are refused meanwhile", "photo", _send("photo")),
    Word(
        "disarm",
        (Argument("--force", ArgumentKind.FLAG, optional=True),),
        "stop the motors on the ground; --force asks for it in the air",
        "disarm",
        lambda values: SendRequests((Ask(0, "disarm", force=values.flagged),)),
        at_once=ActsAtOnce.MARKED,
        moves=True,
    ),
    Word(
        "mode",
        (Argument("NAME", ArgumentKind.NAME),),
        "ask for a flight mode by the autopilot's own name",
        "mode LOITER",
        lambda values: SendRequests((Ask(0, "mode", mode=values.text),)),
        moves=True,
    ),
    Word(
        "fence",
        (Argument("on|off", ArgumentKind.SWITCH),),
        "switch the fence, where the policy allows it (the lab's does)",
        "fence off",
        lambda values: SendRequests((Ask(0, "fence", on=values.switch),)),
        moves=True,
    ),
    Word(
        "mission upload",
        (_FILE,),
        "verify a mission file, send it to the vehicle and read it back",
        "mission upload missions/demo.toml",
        lambda values: SendRequests((Ask(0, "mission_upload", path=values.text),)),
    ),
    Word(
        "mission start",
        (),
        "fly the mission on board",
        "mission start",
        _send("mission_start"),
        moves=True,
    ),
    Word(
        "mission set-current",
        (Argument("ITEM", ArgumentKind.COUNT),),
        "in the air: where the next start of the mission begins, as MAVLink counts its items",
        "mission set-current 3",
        _mission_set_current,
    ),
    Word(
        "mission fly",
        (_FILE,),
        "upload a mission file, then start it",
        "mission fly missions/demo.toml",
        _mission_fly,
        moves=True,
    ),
    Word(
        "mission download",
        (_FILE,),
        "read the mission on board into a file",
        "mission download on_board.plan",
        lambda values: SendRequests((Ask(0, "mission_download", path=values.text),)),
    ),
    Word(
        "mission clear",
        (),
        "remove the mission on board",
        "mission clear",
        _send("mission_clear"),
    ),
    Word(
        "station take",
        (),
        "take control over from the operator who has it; it is told",
        "station take",
        _send("station_take"),
    ),
    Word(
        "station end",
        (),
        "end the station, also one that is kept; a vehicle we fly is told to hold",
        "station end",
        _send("station_end"),
    ),
    Word(
        "wait",
        (Argument("SECONDS", ArgumentKind.SECONDS),),
        "do nothing for so many seconds of flight",
        "wait 2.5",
        lambda values: Wait(values.numbers[0]),
    ),
    Word(
        "state",
        (),
        "print what the vehicle reports; so does status",
        "state",
        lambda _: ShowState(),
        at_once=ActsAtOnce.TYPED,
    ),
    Word(
        "help",
        (),
        "print these words; so does ?",
        "help",
        lambda _: ShowHelp(),
        at_once=ActsAtOnce.TYPED,
    ),
    Word(
        "quit",
        (),
        "leave; a vehicle we fly is told to hold",
        "quit",
        lambda _: Quit(),
        at_once=ActsAtOnce.TYPED,
    ),
)

OTHER_NAMES: dict[str, str] = {"status": "state", "?": "help"}
"""What is typed for some words as well."""

WORD_BY_NAME: dict[str, Word] = {word.name: word for word in WORDS}


def label(request: Ask) -> str:
    """A request as an operator would type it: the table read backwards."""
    name = request.word
    for first in ("mission", "station", "stream"):
        name = name.replace(f"{first}_", f"{first} ")
    parts: list[str] = [name]
    if request.word == "takeoff":
        parts.append(_shown(request.up_m))
    if request.goal_enu is not None:
        parts += [_shown(metres) for metres in request.goal_enu]
    if request.yaw_deg is not None:
        parts.append(_shown(request.yaw_deg))
    if request.word == "fence":
        parts.append("on" if request.on else "off")
    parts += [
        part for part in (request.mode, request.path, "--force" if request.force else "") if part
    ]
    return " ".join(parts)


def _shown(number: float | None) -> str:
    return "nan" if number is None else f"{number:g}"


def help_lines() -> list[str]:
    """One line a word, for a console's help."""
    width = max(len(f"{word.name} {word.usage}") for word in WORDS)
    lines = [f"{f'{word.name} {word.usage}':{width}}  {word.help}" for word in WORDS]
    lines.append(f"{'LINE &':{width}}  the next line does not wait for the ending of this one")
    at_once = ", ".join(word.name for word in WORDS if word.at_once is not ActsAtOnce.NEVER)
    lines.append(f"{'!LINE':{width}}  does not wait for the line before it: {at_once}")
    return lines
