"""What the tests of the findings share: facts fed to a detector in time order."""

from __future__ import annotations

from collections.abc import Iterable

from gcs.flight_report.facts import Fact
from gcs.flight_report.findings.finding import Check, Detector, Level, Result, Situation


def flying(autopilot: str = "px4") -> Situation:
    return Situation(autopilot=autopilot, armed=True, flying=True, in_air=True)


def found(
    detector: Detector,
    facts: Iterable[tuple[float, Fact]],
    now: Situation | None = None,
    end_s: float | None = None,
) -> Result:
    """What the detector finds of facts that came at these times, in flight if nothing else."""
    now = now or flying()
    for t_s, fact in facts:
        now.t_s = t_s
        detector.handle(fact, now)
    if end_s is not None:
        now.t_s = end_s
    return detector.result(now)


def check(result: Result, name: str) -> Check:
    return next(check for check in result.checks if check.name == name)


def levels(result: Result) -> list[tuple[float, Level]]:
    return [(finding.t_s, finding.level) for finding in result.findings]
