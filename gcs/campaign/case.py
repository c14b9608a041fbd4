"""One flight of a campaign, before it is flown and after."""

from __future__ import annotations

from typing import TypeAlias

import msgspec

from gcs.gate.policy.policy import Policy

Value: TypeAlias = bool | int | float | str
"""Of an axis, or of a key of the simulator's table."""

LANDED, AIRBORNE, GROUNDED, LATE, ERROR = "landed", "in the air", "never flew", "late", "error"
STARVED = "starved"
"""Of a flight in real time that the machine was too slow for: what it did says nothing."""


class Task(msgspec.Struct, frozen=True):
    """What is flown: the words of `gcs fly --plain`, and the files that they name."""

    name: str
    lines: tuple[str, ...]
    files: dict[str, bytes]


class Rules(msgspec.Struct, frozen=True):
    """A policy by the name that the campaign calls it, and the text of its file."""

    name: str
    policy: Policy
    text: str


class Case(msgspec.Struct, frozen=True):
    """Everything that one flight depends on; equal cases become equal rows.

    `table` is what the simulator is made of, but for its `start_ns`; `inputs` are the values of the
    axes by name, as the row tells them.
    """

    id: int
    task: Task
    rules: Rules
    simulator: str
    table: dict[str, Value]
    timeout_s: float
    inputs: dict[str, Value]


class Row(msgspec.Struct, frozen=True, kw_only=True):
    """What became of one flight: one row of the table of results.

    Metres are of the truth.  `closest_m` is the least clearance from the fence, negative outside,
    None where it never flew; `touchdown_m_s` how fast it sank close to the ground;
    `answers` are the lines that the console printed.
    """

    id: int
    inputs: dict[str, Value]
    outcome: str
    breach: bool = False
    closest_m: float | None = None
    closest_of: str = ""
    closest_at_s: float | None = None
    max_up_m: float = 0.0
    max_distance_m: float = 0.0
    max_speed_m_s: float = 0.0
    touchdown_m_s: float = 0.0
    flight_s: float = 0.0
    energy_wh: float | None = 0.0
    landed_east_m: float | None = None
    landed_north_m: float | None = None
    accepted: int = 0
    refused: int = 0
    undone: int = 0
    warnings: int = 0
    critical: int = 0
    findings: str = ""
    answers: str = ""
    exit_code: int = 0
    digest: str = ""
    error: str = ""

    @property
    def failed(self) -> bool:
        return self.outcome in (LATE, ERROR)

    @property
    def cell(self) -> str:
        """What is chosen and no number: of each such combination the worst flight is kept."""
        chosen = ((k, v) for k, v in self.inputs.items() if isinstance(v, str) and v)
        return ", ".join(f"{name} {value}" for name, value in chosen)


MEASURES: dict[str, str] = {
    "closest_m": "m",
    "max_up_m": "m",
    "max_distance_m": "m",
    "max_speed_m_s": "m/s",
    "touchdown_m_s": "m/s",
    "flight_s": "s",
    "energy_wh": "Wh",
}
"""The fields of a row that are measured, with their units."""
