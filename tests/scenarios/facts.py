"""What real autopilots did, step by step: recorded scenarios as typed values."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from typing import Final

import msgspec

from vehicle_sim.autopilot.modes import Personality

FOLDER: Final = Path(__file__).parent / "facts"
FILES: Final[dict[Personality, str]] = {"px4": "px4.json", "ardupilot": "arducopter.json"}

Item = tuple[
    int,
    str,
    float | None,
    float | None,
    float | None,
    float | None,
    float | None,
    float | None,
    float | None,
]
"""Frame, command's name, param 1 to 4, x, y, z of a plan."""


class Step(msgspec.Struct, frozen=True):
    """Something that was sent at `t` seconds.  `ack` is the answer's name; None: none came."""

    t: float
    sent: str
    frame: int | None = None
    params: tuple[float | None, ...] = ()
    items: tuple[Item, ...] = ()
    ack: str | None = None
    ok: bool | None = None

    @property
    def words(self) -> list[str]:
        return self.sent.split()

    @property
    def values(self) -> list[float]:
        """The parameters of a command; what JSON cannot say is NaN."""
        return [math.nan if value is None else value for value in self.params]


class Event(msgspec.Struct, frozen=True):
    """Something that was seen at `t` seconds; a field is None where it did not change.

    `n`, `e`, `up`: metres from where the simulation stood at first, of STATE_AT_START.
    """

    t: float
    kind: str
    mode: str | None = None
    armed: bool | None = None
    n: float | None = None
    e: float | None = None
    up: float | None = None
    state: str | None = None
    text: str | None = None


class Scenario(msgspec.Struct, frozen=True):
    """`flown_before`: not the first since the autopilot's start."""

    scenario: str
    what: str
    end_s: float
    flown_before: bool
    steps: tuple[Step, ...]
    events: tuple[Event, ...]

    @property
    def start(self) -> Event:
        """The state at the start; nothing is known of it where none was seen."""
        found = (event for event in self.events if event.kind == "STATE_AT_START")
        return next(found, Event(0.0, "STATE_AT_START"))


class Recording(msgspec.Struct, frozen=True):
    autopilot: str
    scenarios: tuple[Scenario, ...]


@cache
def recorded(personality: Personality) -> dict[str, Scenario]:
    """All scenarios of one autopilot, by name, in the order in which they were flown."""
    data = (FOLDER / FILES[personality]).read_bytes()
    recording = msgspec.json.decode(data, type=Recording)
    return {scenario.scenario: scenario for scenario in recording.scenarios}
