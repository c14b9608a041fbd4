"""Vibration in the air, and accelerometers at their limits while the vehicle is armed."""

from __future__ import annotations

from dataclasses import dataclass, field

from gcs.flight_report.facts import Fact, Vibration
from gcs.flight_report.findings.finding import Check, Finding, Level, Limit, Result, Situation
from gcs.flight_report.findings.limits import VIBRATION, WIKI, Held

CLIPPED = Limit(100, "times", WIKI)
"""Fewer are likely to be harmless, "especially if they occur during hard landings"."""


def level_of(fact: Vibration, autopilot: str) -> float:
    """m/s².  PX4 has the accelerometers' metric in z, and the gyroscopes' in x and y
    (its stream VIBRATION.hpp says that this is not MAVLink's meaning)."""
    return fact.z if autopilot == "px4" else max(fact.x, fact.y, fact.z)


@dataclass(slots=True)
class VibrationDetector:
    vibration: Held = field(default_factory=lambda: Held(VIBRATION))
    clipped_before: int | None = None
    clipped: int = 0
    clipped_s: float = 0.0

    def handle(self, fact: Fact, now: Situation) -> None:
        if not isinstance(fact, Vibration):
            return
        if not now.armed:
            self.vibration.rest(now.t_s)
            return
        level = level_of(fact, now.autopilot) if now.in_air else 0.0
        self.vibration.update(now.t_s, level, now.autopilot)
        # A counter that falls was started anew.
        before = self.clipped_before if self.clipped_before is not None else fact.clipped
        if fact.clipped > before:
            self.clipped_s = self.clipped_s if self.clipped else now.t_s
            self.clipped += fact.clipped - before
        self.clipped_before = fact.clipped

    def result(self, now: Situation) -> Result:
        result = Result()
        self.vibration.result(result, now.autopilot)
        if self.vibration.worst.value is not None:
            result.checks.append(self._clipping(result.findings))
        return result

    def _clipping(self, findings: list[Finding]) -> Check:
        level = Level.OK
        if self.clipped:
            level = Level.WARNING if self.clipped >= CLIPPED.value else Level.NOTE
            findings.append(
                Finding(
                    "vibration",
                    level,
                    self.clipped_s,
                    "an accelerometer was at its limit",
                    f"{self.clipped} samples were clipped while armed",
                    source=CLIPPED.source,
                )
            )
        limit = f"ideally none, few below {CLIPPED.value:g}"
        return Check(
            "vibration", "Clipping", f"{self.clipped} samples", limit, CLIPPED.source, level
        )
