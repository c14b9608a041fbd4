"""Vibration in the air, and accelerometers at their limits while the vehicle is armed."""

from __future__ import annotations

from dataclasses import dataclass, field

from gcs.flight_report.facts import Fact, Vibration
from gcs.flight_report.findings.finding import Check, Finding, Level, Limit, Result, Situation
from gcs.flight_report.findings.spells import Spells, Worst
from gcs.flight_report.number_format import clock

_WIKI = "ArduPilot wiki, Measuring Vibration"
_REVIEW = "PX4 Flight Review, configured_plots.py, Vibration Metrics"

FAIR = {
    "ardupilot": Limit(30.0, "m/s²", _WIKI),
    "px4": Limit(4.905, "m/s²", _REVIEW),
}
"""Above it there may be problems."""
BAD = {
    "ardupilot": Limit(60.0, "m/s²", _WIKI),
    "px4": Limit(9.81, "m/s²", _REVIEW),
}
"""Above it there nearly always are."""
LEVELS = {
    "ardupilot": (Level.WARNING, Level.CRITICAL),
    # Flight Review colours its bands and says no more of them.
    "px4": (Level.NOTE, Level.WARNING),
}
"""How bad it is above the first limit, and above the second."""
CLIPPED = Limit(100, "times", _WIKI)
"""Fewer are likely to be harmless, "especially if they occur during hard landings"."""


def level_of(fact: Vibration, autopilot: str) -> float:
    """m/s².  PX4 has the accelerometers' metric in z, and the gyroscopes' in x and y
    (its stream VIBRATION.hpp says that this is not MAVLink's meaning)."""
    return fact.z if autopilot == "px4" else max(fact.x, fact.y, fact.z)


@dataclass(slots=True)
class VibrationDetector:
    fair: Spells = field(default_factory=Spells)
    bad: Spells = field(default_factory=Spells)
    worst: Worst = field(default_factory=Worst)
    clipped_before: int | None = None
    clipped: int = 0
    clipped_s: float = 0.0

    def handle(self, fact: Fact, now: Situation) -> None:
        if not isinstance(fact, Vibration):
            return
        if not now.armed:
            self.fair.update(now.t_s, False)
            self.bad.update(now.t_s, False)
            return
        level = level_of(fact, now.autopilot) if now.in_air else 0.0
        kind = now.autopilot if now.autopilot in FAIR else "ardupilot"
        self.worst.update(now.t_s, level)
        self.fair.update(now.t_s, level > FAIR[kind].value)
        self.bad.update(now.t_s, level > BAD[kind].value)
        # A counter that falls was started anew.
        before = self.clipped_before if self.clipped_before is not None else fact.clipped
        if fact.clipped > before:
            self.clipped_s = self.clipped_s if self.clipped else now.t_s
            self.clipped += fact.clipped - before
        self.clipped_before = fact.clipped

    def result(self, now: Situation) -> Result:
        result = Result()
        kind = now.autopilot if now.autopilot in FAIR else "ardupilot"
        fair, bad = FAIR[kind], BAD[kind]
        worst = self.worst.value
        told = f"good below {fair.value:g}, bad above {bad.value:g} {fair.unit}"
        if worst is None:
            result.checks.append(Check("vibration", "Vibration", "", told, fair.source, None))
            return result
        spells = self.bad if self.bad.count else self.fair
        level = Level.OK
        if spells.count:
            level = LEVELS[kind][1 if self.bad.count else 0]
            beyond = bad if self.bad.count else fair
            result.findings.append(
                Finding(
                    "vibration",
                    level,
                    spells.first_s,
                    f"vibration above {beyond.value:g} {beyond.unit}",
                    f"up to {worst:.1f} {beyond.unit}, at {clock(self.worst.t_s)}; "
                    f"above the limit {spells.words}",
                    source=beyond.source,
                )
            )
        measured = f"up to {worst:.1f} {fair.unit}"
        result.checks.append(Check("vibration", "Vibration", measured, told, fair.source, level))
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
