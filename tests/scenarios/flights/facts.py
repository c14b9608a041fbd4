"""A recorded flight as figures: what a vehicle told, and when, in seconds since its power-up.

`reduced` makes them of any sequence of messages: a real autopilot's log and what ours sent in
virtual time go through the same code.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final, TypeAlias

import msgspec
from pymavlink.dialects.v20 import all as mavlink

from tests.scenarios.flights.script import PHASES, Phase
from tests.scenarios.names import mode_name
from vehicle_sim.autopilot.modes import Personality

FOLDER: Final = Path(__file__).parent / "facts"
TRACK_S: Final = 0.25
NAMES: Final = {
    "UNKNOWN_8": "LINK_NODE_STATUS",
    "UNKNOWN_300": "PROTOCOL_VERSION",
    "UNKNOWN_380": "TIME_ESTIMATE_TO_TARGET",
    "UNKNOWN_395": "COMPONENT_INFORMATION",
    "UNKNOWN_397": "COMPONENT_METADATA",
    "UNKNOWN_410": "EVENT",
    "UNKNOWN_411": "CURRENT_EVENT_SEQUENCE",
    "UNKNOWN_435": "AVAILABLE_MODES",
    "UNKNOWN_437": "AVAILABLE_MODES_MONITOR",
}
"""Of messages that pymavlink's dialect does not have."""

ON_EVENT: Final = frozenset(
    {"COMMAND_ACK", "STATUSTEXT", "EVENT", "PARAM_VALUE", "PARAM_ERROR", "FENCE_STATUS"}
)
"""Sent for an occasion: they have no rate."""


class Ack(msgspec.Struct, frozen=True, array_like=True):
    t: float
    command: int
    result: str


class State(msgspec.Struct, frozen=True, array_like=True):
    """What a HEARTBEAT says, where it differs from the one before."""

    t: float
    mode: str
    base_mode: int
    status: int


class Word(msgspec.Struct, frozen=True, array_like=True):
    """A landed state, or a text."""

    t: float
    text: str


class Kind(msgspec.Struct, frozen=True, array_like=True):
    """A kind of message: when the first came, and how many."""

    name: str
    first_s: float
    count: int


class Point(msgspec.Struct, frozen=True, array_like=True):
    """LOCAL_POSITION_NED: metres north, east, up, and metres a second."""

    t: float
    north: float
    east: float
    up: float
    v_north: float
    v_east: float
    v_up: float


class Flight(msgspec.Struct, frozen=True):
    """All times are seconds since power-up; `rates_hz` is by phase, then by kind."""

    source: str
    starts_s: float
    acks: list[Ack]
    states: list[State]
    landed: list[Word]
    texts: list[Word]
    kinds: list[Kind]
    rates_hz: dict[str, dict[str, float]]
    track: list[Point]


@dataclass(frozen=True, slots=True)
class Timed:
    """A message and the vehicle's time at which it was sent [s]."""

    t: float
    message: Any


Told: TypeAlias = Sequence[Timed]


@cache
def recorded(personality: Personality) -> Flight:
    """The real autopilot's flight."""
    data = (FOLDER / f"{personality}.json").read_bytes()
    return msgspec.json.decode(data, type=Flight)


def reduced(personality: Personality, source: str, told: Told) -> Flight:
    """`told` is in the order of its coming."""
    named = [(_name(each.message), each) for each in told]
    counts = Counter(name for name, _ in named)
    firsts = {name: each.t for name, each in reversed(named)}
    return Flight(
        source,
        round(told[0].t, 2),
        [_ack(each) for name, each in named if name == "COMMAND_ACK"],
        _changes(_state(personality, each) for name, each in named if name == "HEARTBEAT"),
        _landed(each for name, each in named if name == "EXTENDED_SYS_STATE"),
        [_text(each) for name, each in named if name == "STATUSTEXT"],
        [Kind(n, round(firsts[n], 2), counts[n]) for n in sorted(firsts, key=lambda n: firsts[n])],
        {phase.name: _rates_hz(phase, named) for phase in PHASES[personality]},
        _track([each for name, each in named if name == "LOCAL_POSITION_NED"]),
    )


def _name(message: Any) -> str:
    name: str = message.get_type()
    return NAMES.get(name, name)


def _ack(each: Timed) -> Ack:
    name: str = mavlink.enums["MAV_RESULT"][each.message.result].name
    return Ack(round(each.t, 2), each.message.command, name.removeprefix("MAV_RESULT_"))


def _state(personality: Personality, each: Timed) -> State:
    beat = each.message
    return State(
        round(each.t, 2), mode_name(personality, beat.custom_mode), beat.base_mode,
        beat.system_status,
    )  # fmt: skip


def _changes(states: Iterable[State]) -> list[State]:
    kept: list[State] = []
    for state in states:
        if not kept or msgspec.structs.replace(state, t=kept[-1].t) != kept[-1]:
            kept.append(state)
    return kept


def _landed(told: Iterable[Timed]) -> list[Word]:
    kept: list[Word] = []
    for each in told:
        name: str = mavlink.enums["MAV_LANDED_STATE"][each.message.landed_state].name
        word = Word(round(each.t, 2), name.removeprefix("MAV_LANDED_STATE_"))
        if not kept or word.text != kept[-1].text:
            kept.append(word)
    return kept


def _text(each: Timed) -> Word:
    return Word(round(each.t, 2), each.message.text.strip())


def _rates_hz(phase: Phase, named: Sequence[tuple[str, Timed]]) -> dict[str, float]:
    counts = Counter(
        name for name, each in named if phase.from_s <= each.t < phase.to_s and name not in ON_EVENT
    )
    long_s = phase.to_s - phase.from_s
    return {name: round(count / long_s, 2) for name, count in sorted(counts.items())}


def _track(told: Told) -> list[Point]:
    kept: list[Point] = []
    for each in told:
        if kept and each.t < kept[-1].t + TRACK_S:
            continue
        p = each.message
        numbers = (each.t, p.x, p.y, -p.z, p.vx, p.vy, -p.vz)
        kept.append(Point(*(round(number, 2) + 0.0 for number in numbers)))
    return kept
