"""The wind, as the vehicle reckons it."""

from __future__ import annotations

from dataclasses import dataclass, field

from gcs.flight_report.facts import Fact, Sample
from gcs.flight_report.findings.finding import Result, Situation
from gcs.flight_report.findings.limits import WIND, Held


@dataclass(slots=True)
class WindDetector:
    wind: Held = field(default_factory=lambda: Held(WIND))

    def handle(self, fact: Fact, now: Situation) -> None:
        if isinstance(fact, Sample) and fact.plot == "wind" and now.in_air:
            self.wind.update(now.t_s, fact.values[0], now.autopilot)

    def result(self, now: Situation) -> Result:
        result = Result()
        self.wind.result(result, now.autopilot)
        return result
