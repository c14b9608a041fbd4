"""THE operator words: one table that feeds `--plain` lines and the one-shot commands alike.

A word may be two (`mission fly`).  What it asks of the link is an `Ask`, or two in order; a few
words are for the console itself.  `gcs/cli/typed.py` reads them from text.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import TypeAlias

from gcs.ipc import Ask


class Kind(Enum):
    """What an argument must look like."""

    NUMBER = "number"  # nan and inf pass: the gate refuses them, with a verdict
    FINITE = "finite number"
    SECONDS = "number of seconds, not negative"
    NAME = "name"
    FILE = "file"
    SWITCH = "on or off"
    FLAG = "option"


@dataclass(frozen=True, slots=True)
class Param:
    name: str
    kind: Kind
    optional: bool = False


@dataclass(frozen=True, slots=True)
class Request:
    """Ask the link, one after the other; the ids are given when they are sent."""

    asks: tuple[Ask, ...]


@dataclass(frozen=True, slots=True)
class Wait:
    """Do nothing for so many seconds of flight."""

    seconds: float


@dataclass(frozen=True, slots=True)
class ShowState:
    """Print the latest snapshot."""


@dataclass(frozen=True, slots=True)
class Quit:
    """Leave in good order."""


Action: TypeAlias = Request | Wait | ShowState | Quit


@dataclass(frozen=True, slots=True)
class Values:
    """What was typed, sorted by kind, in the order of the parameters."""

    numbers: tuple[float, ...] = ()
    text: str = ""
    switch: bool = True
    flagged: bool = False


@dataclass(frozen=True, slots=True)
class Word:
    name: str
    params: tuple[Param, ...]
    help: str
    example: str
    build: Callable[[Values], Action]

    @property
    def usage(self) -> str:
        """The arguments as the help shows them, `EAST NORTH UP [YAW_DEG]`."""
        return " ".join(f"[{p.name}]" if p.optional else p.name for p in self.params)


def _plain(word: str) -> Callable[[Values], Action]:
    return lambda _: Request((Ask(0, word),))


def _goto(values: Values) -> Action:
    east, north, up, *yaw = values.numbers
    return Request((Ask(0, "goto", goal_enu=(east, north, up), yaw_deg=yaw[0] if yaw else None),))


def _mission_fly(values: Values) -> Action:
    return Request((Ask(0, "mission_upload", path=values.text), Ask(0, "mission_start")))


_UP = Param("UP", Kind.NUMBER)
_FILE = Param("FILE", Kind.FILE)

WORDS: tuple[Word, ...] = (
    Word("control", (), "take control of a flying vehicle", "control", _plain("control")),
    Word("arm", (), "arm the motors", "arm", _plain("arm")),
    Word(
        "takeoff",
        (_UP,),
        "climb to UP metres above the take-off point, take control and hover",
        "takeoff 2",
        lambda values: Request((Ask(0, "takeoff", up_m=values.numbers[0]),)),
    ),
    Word(
        "goto",
        (
            Param("EAST", Kind.NUMBER),
            Param("NORTH", Kind.NUMBER),
            _UP,
            Param("YAW_DEG", Kind.FINITE, optional=True),
        ),
        "fly straight to a point, metres from the local origin, and hover; "
        "YAW_DEG is clockwise from north",
        "goto 3 0 2",
        _goto,
    ),
    Word("land", (), "land where it is", "land", _plain("land")),
    Word("rtl", (), "return to home and land", "rtl", _plain("rtl")),
    Word("hold", (), "stop and hold, in the vehicle's own hold mode", "hold", _plain("hold")),
    Word("abort", (), "stop now and forget the goal; never refused", "abort", _plain("abort")),
    Word("resume", (), "after a hold: hover under our control", "resume", _plain("resume")),
    Word("photo", (), "take a picture; moves are refused meanwhile", "photo", _plain("photo")),
    Word(
        "disarm",
        (Param("--force", Kind.FLAG, optional=True),),
        "stop the motors on the ground; --force asks for it in the air",
        "disarm",
        lambda values: Request((Ask(0, "disarm", force=values.flagged),)),
    ),
    Word(
        "mode",
        (Param("NAME", Kind.NAME),),
        "ask for a flight mode by the autopilot's own name",
        "mode LOITER",
        lambda values: Request((Ask(0, "mode", mode=values.text),)),
    ),
    Word(
        "fence",
        (Param("on|off", Kind.SWITCH),),
        "switch the fence, where the policy allows it (the lab's does)",
        "fence off",
        lambda values: Request((Ask(0, "fence", on=values.switch),)),
    ),
    Word(
        "mission upload",
        (_FILE,),
        "verify a mission file, send it to the vehicle and read it back",
        "mission upload missions/demo.toml",
        lambda values: Request((Ask(0, "mission_upload", path=values.text),)),
    ),
    Word("mission start", (), "fly the mission on board", "mission start", _plain("mission_start")),
    Word(
        "mission fly",
        (_FILE,),
        "upload a mission file, then start it",
        "mission fly missions/demo.toml",
        _mission_fly,
    ),
    Word(
        "mission download",
        (_FILE,),
        "read the mission on board into a file",
        "mission download on_board.plan",
        lambda values: Request((Ask(0, "mission_download", path=values.text),)),
    ),
    Word(
        "mission clear",
        (),
        "remove the mission on board",
        "mission clear",
        _plain("mission_clear"),
    ),
    Word(
        "wait",
        (Param("SECONDS", Kind.SECONDS),),
        "do nothing for so many seconds of flight",
        "wait 2.5",
        lambda values: Wait(values.numbers[0]),
    ),
    Word("state", (), "print what the vehicle reports", "state", lambda _: ShowState()),
    Word("quit", (), "leave; a vehicle we fly is told to hold", "quit", lambda _: Quit()),
)

BY_NAME: dict[str, Word] = {word.name: word for word in WORDS}


def label(ask: Ask) -> str:
    """An `Ask` as an operator would type it: the table read backwards."""
    name = ask.word.replace("mission_", "mission ")
    parts: list[str] = [name]
    if ask.word == "takeoff":
        parts.append(_shown(ask.up_m))
    if ask.goal_enu is not None:
        parts += [_shown(metres) for metres in ask.goal_enu]
    if ask.yaw_deg is not None:
        parts.append(_shown(ask.yaw_deg))
    if ask.word == "fence":
        parts.append("on" if ask.on else "off")
    parts += [part for part in (ask.mode, ask.path, "--force" if ask.force else "") if part]
    return " ".join(parts)


def _shown(number: float | None) -> str:
    return "nan" if number is None else f"{number:g}"
