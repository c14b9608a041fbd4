"""The vehicle's own clock: a restart of its autopilot, and a clock that jumps."""

from __future__ import annotations

from dataclasses import dataclass, field

from gcs.flight_report.facts import Clock, Fact
from gcs.flight_report.findings.finding import Finding, Level, Result, Situation

BACK_S = 1.0
"""Frames overtake each other on the way by less; a restart begins at nought."""
JUMP_S = 5.0
"""Nothing delays the positions of a link by so much that is still of use."""
MAX_FINDINGS = 20
_SOURCE = "this project's own choice"


@dataclass(slots=True)
class ClockDetector:
    findings: list[Finding] = field(default_factory=list)
    before: tuple[float, float] | None = None
    """The record's time and the vehicle's, of the last that was told."""
    armed_s: float | None = None
    """When it was armed last: who restarts is not, a moment later."""

    def handle(self, fact: Fact, now: Situation) -> None:
        if now.armed:
            self.armed_s = now.t_s
        if not isinstance(fact, Clock):
            return
        before, self.before = self.before, (now.t_s, fact.boot_s)
        if before is None or len(self.findings) >= MAX_FINDINGS:
            return
        ahead_s = (fact.boot_s - before[1]) - (now.t_s - before[0])
        # After a silence nobody knows what it was doing.
        flew = self.armed_s is not None and now.t_s - before[0] < JUMP_S > now.t_s - self.armed_s
        if fact.boot_s < before[1] - BACK_S:
            level = Level.CRITICAL if flew else Level.NOTE
            detail = f"its clock fell from {before[1]:.1f} s to {fact.boot_s:.1f} s"
            detail += ", while it was armed" if flew else ""
            self._found(level, now.t_s, "the autopilot restarted", detail)
        elif ahead_s > JUMP_S:
            level = Level.WARNING if flew else Level.NOTE
            detail = f"by {ahead_s:.1f} s forward"
            self._found(level, now.t_s, "the vehicle's clock jumped", detail)

    def _found(self, level: Level, t_s: float, title: str, detail: str) -> None:
        self.findings.append(Finding("clock", level, t_s, title, detail, source=_SOURCE))

    def result(self, now: Situation) -> Result:
        return Result(findings=self.findings)
