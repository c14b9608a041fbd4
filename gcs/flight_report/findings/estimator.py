"""The estimator: how far the measurements are from what it expects."""

from __future__ import annotations

from dataclasses import dataclass, field

from gcs.flight_report.facts import Estimator, Fact
from gcs.flight_report.findings.finding import Check, Finding, Level, Limit, Result, Situation
from gcs.flight_report.findings.spells import Spells, Worst
from gcs.flight_report.number_format import clock

REJECTED = {
    "px4": Limit(1.0, "", "MAVLink, ESTIMATOR_STATUS: above 1 a measurement is rejected"),
    "ardupilot": Limit(0.8, "", "FS_EKF_THRESH of an ArduCopter 4.7; ArduPilot wiki, EKF Failsafe"),
}
FAILSAFE_AFTER_S = 1.0
"""ArduPilot wiki, EKF Failsafe: any two of compass, position, velocity above the limit for 1 s."""


@dataclass(slots=True)
class _Ratio:
    name: str
    spells: Spells = field(default_factory=Spells)
    worst: Worst = field(default_factory=Worst)


@dataclass(slots=True)
class EstimatorDetector:
    ratios: list[_Ratio] = field(
        default_factory=lambda: [_Ratio(n) for n in ("velocity", "position", "height", "compass")]
    )
    two: Spells = field(default_factory=Spells)
    failsafe_s: float | None = None

    def handle(self, fact: Fact, now: Situation) -> None:
        if not isinstance(fact, Estimator) or fact.autopilot != now.autopilot:
            return
        if not now.armed:
            for spells in (self.two, *(ratio.spells for ratio in self.ratios)):
                spells.update(now.t_s, False)
            return
        limit = REJECTED[fact.autopilot].value
        values = (fact.velocity, fact.position, fact.height, fact.compass)
        for ratio, value in zip(self.ratios, values, strict=True):
            ratio.worst.update(now.t_s, value)
            ratio.spells.update(now.t_s, value is not None and value > limit)
        velocity, position, _, compass = self.ratios
        self.two.update(now.t_s, sum(r.spells.open for r in (velocity, position, compass)) >= 2)
        if self.two.spell_s >= FAILSAFE_AFTER_S and self.failsafe_s is None:
            self.failsafe_s = now.t_s

    def result(self, now: Situation) -> Result:
        result = Result()
        limit = REJECTED.get(now.autopilot, REJECTED["px4"])
        for ratio in self.ratios:
            worst, level = ratio.worst.value, None
            if worst is not None:
                level = Level.WARNING if ratio.spells.count else Level.OK
            if ratio.spells.count and worst is not None:
                result.findings.append(
                    Finding(
                        "estimator",
                        Level.WARNING,
                        ratio.spells.first_s,
                        f"the estimator's {ratio.name} disagreed with the sensors",
                        f"ratio up to {worst:.2f} at {clock(ratio.worst.t_s)}, above "
                        f"{limit.value:g} {ratio.spells.words}",
                        source=limit.source,
                    )
                )
            measured = "" if worst is None else f"up to {worst:.2f}"
            told = f"below {limit.value:g}"
            name = f"Estimator, {ratio.name}"
            result.checks.append(Check("estimator", name, measured, told, limit.source, level))
        if self.failsafe_s is not None and now.autopilot == "ardupilot":
            result.findings.append(
                Finding(
                    "estimator",
                    Level.CRITICAL,
                    self.failsafe_s,
                    "two of the estimator's measures were above the limit for a second",
                    "which is when ArduCopter's EKF failsafe acts",
                    source=limit.source,
                )
            )
        return result
