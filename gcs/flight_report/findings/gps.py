"""The GPS: fix, satellites, dilution of precision, silence."""

from __future__ import annotations

from dataclasses import dataclass, field

from gcs.flight_report.facts import Fact, Gps
from gcs.flight_report.findings.finding import Check, Finding, Level, Limit, Result, Situation
from gcs.flight_report.findings.limits import DILUTION, SATELLITES, Held
from gcs.flight_report.findings.spells import Spells

SILENT = Limit(3.0, "s", "a receiver that is gone is no longer reported by PX4 (from memory)")
LONGEST_STEP_S = 1.0
FIX_2D, FIX_3D = 2, 3


@dataclass(slots=True)
class GpsDetector:
    no_fix: Spells = field(default_factory=Spells)
    hdop: Held = field(default_factory=lambda: Held(DILUTION))
    satellites: Held = field(default_factory=lambda: Held(SATELLITES))
    had_fix: bool = False
    seen_s: float | None = None
    silent: Spells = field(default_factory=Spells)
    quiet_s: float = 0.0
    """For so long other things were told, and nothing of the GPS."""
    counted_s: float = 0.0
    lost_fix_type: int = 0

    def handle(self, fact: Fact, now: Situation) -> None:
        if not isinstance(fact, Gps):
            self._other(now)
            return
        self.silent.update(now.t_s, False)
        self.quiet_s, self.counted_s = 0.0, now.t_s
        self.seen_s = now.t_s
        fixed = fact.fix_type >= FIX_3D
        self.had_fix |= fixed
        if not now.armed:
            self.no_fix.update(now.t_s, False)
            self.hdop.rest(now.t_s)
            self.satellites.rest(now.t_s)
            return
        lost = self.had_fix and not fixed
        if lost:
            self.lost_fix_type = fact.fix_type
        self.no_fix.update(now.t_s, lost)
        if fixed:
            self.hdop.update(now.t_s, fact.hdop, now.autopilot)
            self.satellites.update(now.t_s, fact.satellites, now.autopilot)

    def _other(self, now: Situation) -> None:
        # Where nothing at all was told, the link was silent, and not the receiver.
        self.quiet_s += min(now.t_s - self.counted_s, LONGEST_STEP_S)
        self.counted_s = now.t_s
        if now.flying and self.had_fix:
            self.silent.update(now.t_s, self.quiet_s > SILENT.value)

    def result(self, now: Situation) -> Result:
        result = Result()
        self._fix(result)
        self.hdop.result(result, now.autopilot)
        self.satellites.result(result, now.autopilot)
        return result

    def _fix(self, result: Result) -> None:
        limit, level = "a 3D fix throughout the flight", None
        measured = ""
        if self.seen_s is not None and (self.had_fix or self.hdop.worst.value is not None):
            level, measured = Level.OK, "3D fix or better"
        elif self.seen_s is not None:
            level, measured = Level.NOTE, "never had a fix"
        for spells, title in (
            (self.no_fix, "the GPS lost its fix"),
            (self.silent, "nothing more was told of the GPS"),
        ):
            if not spells.count:
                continue
            level, measured = Level.CRITICAL, f"lost {spells.words}"
            fix = ""
            if spells is self.no_fix:
                fix = "a 2D fix " if self.lost_fix_type == FIX_2D else "no fix at all "
            until_s = None if spells.open else spells.last_s
            detail = fix + spells.words + ("" if until_s else ", until the end of the record")
            result.findings.append(
                Finding("gps", Level.CRITICAL, spells.first_s, title, detail, until_s)
            )
        result.checks.append(Check("gps", "GPS fix", measured, limit, "", level))
