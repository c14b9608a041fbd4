"""The attitude: how far the vehicle leant."""

from __future__ import annotations

from dataclasses import dataclass, field

from gcs.flight_report.facts import Fact, Pose
from gcs.flight_report.findings.finding import Check, Finding, Level, Limit, Result, Situation
from gcs.flight_report.findings.spells import Spells, Worst
from gcs.flight_report.number_format import clock

FAILURE = Limit(60.0, "deg", "FD_FAIL_R and FD_FAIL_P of a PX4 1.14: its failure detector acts")


@dataclass(slots=True)
class AttitudeDetector:
    tilt: Worst = field(default_factory=Worst)
    beyond: Spells = field(default_factory=Spells)

    def handle(self, fact: Fact, now: Situation) -> None:
        if not isinstance(fact, Pose) or not now.flying:
            return
        # PX4 judges each by itself.
        tilt_deg = max(abs(fact.roll_deg), abs(fact.pitch_deg))
        self.tilt.update(now.t_s, tilt_deg)
        self.beyond.update(now.t_s, tilt_deg > FAILURE.value)

    def result(self, now: Situation) -> Result:
        result = Result()
        most, level = self.tilt.value, None
        if most is not None:
            level = Level.CRITICAL if self.beyond.count else Level.OK
        if self.beyond.count and most is not None:
            result.findings.append(
                Finding(
                    "attitude",
                    Level.CRITICAL,
                    self.beyond.first_s,
                    f"the vehicle leant by more than {FAILURE.value:g} degrees",
                    f"up to {most:.0f} degrees at {clock(self.tilt.t_s)}; {self.beyond.words}",
                    source=FAILURE.source,
                )
            )
        measured = "" if most is None else f"up to {most:.0f} degrees"
        told = f"below {FAILURE.value:g} degrees"
        result.checks.append(
            Check("attitude", "Roll and pitch", measured, told, FAILURE.source, level)
        )
        return result
