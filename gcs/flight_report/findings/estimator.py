"""The attitude and the estimator: how far the vehicle leant, and how far the measurements are
from what it expects."""

from __future__ import annotations

from dataclasses import dataclass, field

from gcs.flight_report.facts import Estimator, Fact, Pose
from gcs.flight_report.findings.finding import Finding, Level, Result, Situation
from gcs.flight_report.findings.limits import RATIOS, REJECTED, TILT, Held
from gcs.flight_report.findings.spells import Spells

FAILSAFE_AFTER_S = 1.0
"""ArduPilot wiki, EKF Failsafe: any two of compass, position, velocity above the limit for 1 s."""


@dataclass(slots=True)
class AttitudeDetector:
    tilt: Held = field(default_factory=lambda: Held(TILT))

    def handle(self, fact: Fact, now: Situation) -> None:
        if isinstance(fact, Pose) and now.flying:
            # PX4 judges each by itself.
            self.tilt.update(now.t_s, max(abs(fact.roll_deg), abs(fact.pitch_deg)), now.autopilot)

    def result(self, now: Situation) -> Result:
        result = Result()
        self.tilt.result(result, now.autopilot)
        return result


@dataclass(slots=True)
class EstimatorDetector:
    ratios: list[Held] = field(default_factory=lambda: list(map(Held, RATIOS)))
    two: Spells = field(default_factory=Spells)
    failsafe_s: float | None = None

    def handle(self, fact: Fact, now: Situation) -> None:
        if not isinstance(fact, Estimator) or fact.autopilot != now.autopilot:
            return
        if not now.armed:
            self.two.update(now.t_s, False)
            for ratio in self.ratios:
                ratio.rest(now.t_s)
            return
        values = (fact.velocity, fact.position, fact.height, fact.compass)
        for ratio, value in zip(self.ratios, values, strict=True):
            ratio.update(now.t_s, value, fact.autopilot)
        velocity, position, _, compass = (ratio.spells[0].open for ratio in self.ratios)
        self.two.update(now.t_s, velocity + position + compass >= 2)
        if self.two.spell_s >= FAILSAFE_AFTER_S and self.failsafe_s is None:
            self.failsafe_s = now.t_s

    def result(self, now: Situation) -> Result:
        result = Result()
        for ratio in self.ratios:
            ratio.result(result, now.autopilot)
        if self.failsafe_s is not None and now.autopilot == "ardupilot":
            result.findings.append(
                Finding(
                    "estimator",
                    Level.CRITICAL,
                    self.failsafe_s,
                    "two of the estimator's measures were above the limit for a second",
                    "which is when ArduCopter's EKF failsafe acts",
                    source=REJECTED["ardupilot"].source,
                )
            )
        return result
