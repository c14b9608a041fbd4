"""What a finding is, and the limit that it was judged by."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Protocol

from gcs.flight_report.facts import Fact


class Level(StrEnum):
    """How bad a finding is.  A NOTE is worth knowing; it is not what went wrong."""

    OK = "ok"
    NOTE = "note"
    WARNING = "warning"
    CRITICAL = "critical"


WENT_WRONG = (Level.WARNING, Level.CRITICAL)


@dataclass(frozen=True, slots=True)
class Limit:
    """Where a value begins to be bad, and who says so.

    `source` is a document, a recorded parameter list or this project; what is only remembered says
    "from memory".
    """

    value: float
    unit: str
    source: str


@dataclass(frozen=True, slots=True)
class Finding:
    """One thing that was found.  `until_s` None: it has no end, or was not seen to end."""

    subject: str
    level: Level
    t_s: float
    title: str
    """One sentence without its time."""
    detail: str = ""
    until_s: float | None = None
    source: str = ""
    mild: bool = False
    """A warning that endangers nothing by itself: any other one is told before it."""


CAUSE_WITHIN_S = 1.0
"""A cause may be told so much later than what follows from it: batteries, GPS and estimator speak
once or twice a second, texts and the gate at once."""
_FOLLOWS = {"thrust": 1, "attitude": 1, "failsafe": 1, "gate": 2, "request": 3}
"""Of findings at the same time, what follows from what: sensors, vehicle, gate, requests."""


def in_order(finding: Finding) -> tuple[float, int, float]:
    """By time; within a tenth of a second, what comes first as a cause."""
    return round(finding.t_s, 1), _FOLLOWS.get(finding.subject, 0), finding.t_s


def cause_of(episode: list[Finding]) -> Finding:
    """Of findings in time order that are not empty: of those at its beginning the one that the
    others follow from, and of several such the worst."""
    at_once = [f for f in episode if f.t_s - episode[0].t_s <= CAUSE_WITHIN_S]
    return min(
        at_once,
        key=lambda f: (_FOLLOWS.get(f.subject, 0), f.level is not Level.CRITICAL, f.t_s),
    )


@dataclass(frozen=True, slots=True)
class Check:
    """One value that was looked at, whether it was good or not; `level` None: no data."""

    subject: str
    name: str
    measured: str
    limit: str
    source: str
    level: Level | None


@dataclass(frozen=True, slots=True)
class Result:
    checks: list[Check] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)


@dataclass(slots=True)
class Situation:
    """What else is true when a fact comes in; kept by the scan, read by the detectors."""

    t_s: float = 0.0
    autopilot: str = ""
    armed: bool = False
    flying: bool = False
    """Off the ground, as the vehicle says it; where it says nothing, armed."""
    in_air: bool = False
    """Flying, and neither at take-off nor landing, where contact with the ground shakes it."""
    mode: str = ""
    sysid: int = 0
    kind: str = ""
    """Of vehicle: "quadrotor"."""


class Detector(Protocol):
    """Looks at the facts of one vehicle, one by one, in time order."""

    def handle(self, fact: Fact, now: Situation) -> None: ...

    def result(self, now: Situation) -> Result:
        """Everything found, at the end of the record."""
        ...
