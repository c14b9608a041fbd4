"""Campaigns for tests: a file's text and its plan, and flights that cost nothing."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

from gcs.campaign.case import LANDED, Row
from gcs.campaign.engine import Flight, Flown
from gcs.campaign.plan import Plan
from gcs.campaign.spec import read_plan

TEXT = """\
name = "a test"
sample = "latin"
flights = 40
seed = 3
timeout_s = 90

[[task]]
name = "up"
lines = ["arm", "takeoff 2", "land"]

[[task]]
name = "square"
mission = "square.toml"

[vary]
wind_m_s = { from = 0, to = 8 }
gust_m_s = { from = 0, to = 1.5 }
autopilot = ["px4", "ardupilot"]
"""


def written(folder: Path, text: str = TEXT) -> Path:
    file = folder / "campaign.toml"
    file.write_text(text, encoding="utf-8")
    return file


def planned(folder: Path, text: str = TEXT) -> Plan:
    return read_plan(written(folder, text))


def sampled(folder: Path, sample: str, flights: int) -> Plan:
    text = TEXT.replace('"latin"', f'"{sample}"').replace("flights = 40", f"flights = {flights}")
    return planned(folder, text)


class Pretended:
    """Flies nothing: how near a flight came follows from its inputs; `flown` notes each."""

    def __init__(self, nearness: Callable[[Flight], float], *, fails_after: int = 10**9) -> None:
        self._nearness = nearness
        self._left = fails_after
        self.flown: list[int] = []

    def row(self, flight: Flight) -> Row:
        number, inputs = flight
        near = self._nearness(flight)
        return Row(id=number, inputs=inputs, outcome=LANDED, breach=near < 0.0, closest_m=near)

    def __call__(self, flights: Iterable[Flight], *, recorded: bool = False) -> Iterator[Flown]:
        """In another order than asked for, as workers answer."""
        for flight in sorted(flights, key=lambda each: each[0] % 3):
            if self._left == 0:
                raise KeyboardInterrupt
            self._left -= 1
            self.flown.append(flight[0])
            yield self.row(flight), b"a record" if recorded else b""
