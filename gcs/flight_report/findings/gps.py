"""The GPS: fix, satellites, dilution of precision, silence."""

from __future__ import annotations

from dataclasses import dataclass, field

from gcs.flight_report.facts import Fact, Gps
from gcs.flight_report.findings.finding import Check, Finding, Level, Limit, Result, Situation
from gcs.flight_report.findings.spells import Spells, Worst
from gcs.flight_report.number_format import clock

_WIKI = "ArduPilot wiki, Diagnosing problems using Logs"

HDOP_GOOD = Limit(1.5, "", _WIKI)
HDOP_BAD = Limit(2.0, "", _WIKI)
SATELLITES_GOOD = Limit(12, "", _WIKI)
SATELLITES_NEEDED = Limit(6, "", "EKF2_REQ_NSATS of a PX4 1.14")
SILENT = Limit(3.0, "s", "a receiver that is gone is no longer reported by PX4 (from memory)")
LONGEST_STEP_S = 1.0
FIX_2D, FIX_3D = 2, 3


@dataclass(slots=True)
class GpsDetector:
    no_fix: Spells = field(default_factory=Spells)
    few: Spells = field(default_factory=Spells)
    diluted: Spells = field(default_factory=Spells)
    hdop: Worst = field(default_factory=Worst)
    satellites: Worst = field(default_factory=lambda: Worst(-1))
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
            for spells in (self.no_fix, self.few, self.diluted):
                spells.update(now.t_s, False)
            return
        lost = self.had_fix and not fixed
        if lost:
            self.lost_fix_type = fact.fix_type
        self.no_fix.update(now.t_s, lost)
        if not fixed:
            return
        self.hdop.update(now.t_s, fact.hdop)
        self.satellites.update(now.t_s, fact.satellites)
        self.diluted.update(now.t_s, fact.hdop is not None and fact.hdop > HDOP_BAD.value)
        count = fact.satellites
        self.few.update(now.t_s, count is not None and count < SATELLITES_NEEDED.value)

    def _other(self, now: Situation) -> None:
        # Where nothing at all was told, the link was silent, and not the receiver.
        self.quiet_s += min(now.t_s - self.counted_s, LONGEST_STEP_S)
        self.counted_s = now.t_s
        if now.flying and self.had_fix:
            self.silent.update(now.t_s, self.quiet_s > SILENT.value)

    def result(self, now: Situation) -> Result:
        result = Result()
        self._fix(result)
        self._dilution(result)
        self._satellites(result)
        return result

    def _fix(self, result: Result) -> None:
        limit, level = "a 3D fix throughout the flight", None
        measured = ""
        if self.seen_s is not None and (self.had_fix or self.hdop.value is not None):
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

    def _dilution(self, result: Result) -> None:
        worst, level = self.hdop.value, None
        if worst is not None:
            level = Level.OK if worst <= HDOP_GOOD.value else Level.NOTE
        if self.diluted.count and worst is not None:
            level = Level.WARNING
            result.findings.append(
                Finding(
                    "gps",
                    level,
                    self.diluted.first_s,
                    f"the GPS position was imprecise: HDOP above {HDOP_BAD.value:g}",
                    f"up to {worst:.2f} at {clock(self.hdop.t_s)}; {self.diluted.words}",
                    source=HDOP_BAD.source,
                )
            )
        measured = "" if worst is None else f"up to {worst:.2f}"
        limit = f"good below {HDOP_GOOD.value:g}, bad above {HDOP_BAD.value:g}"
        result.checks.append(Check("gps", "HDOP", measured, limit, HDOP_BAD.source, level))

    def _satellites(self, result: Result) -> None:
        fewest, level = self.satellites.value, None
        if fewest is not None:
            level = Level.OK if fewest >= SATELLITES_GOOD.value else Level.NOTE
        if self.few.count and fewest is not None:
            level = Level.WARNING
            result.findings.append(
                Finding(
                    "gps",
                    level,
                    self.few.first_s,
                    f"fewer than {SATELLITES_NEEDED.value:g} satellites",
                    f"down to {fewest:.0f} at {clock(self.satellites.t_s)}; {self.few.words}",
                    source=SATELLITES_NEEDED.source,
                )
            )
        measured = "" if fewest is None else f"at least {fewest:.0f}"
        limit = f"{SATELLITES_GOOD.value:g} and more are good, {SATELLITES_NEEDED.value:g} needed"
        sources = f"{SATELLITES_GOOD.source}; {SATELLITES_NEEDED.source}"
        result.checks.append(Check("gps", "Satellites", measured, limit, sources, level))
