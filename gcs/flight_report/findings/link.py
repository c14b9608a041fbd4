"""The link: silences of the vehicle and lost messages."""

from __future__ import annotations

from dataclasses import dataclass, field

from gcs.flight_report.facts import Fact, Status
from gcs.flight_report.findings.finding import Check, Finding, Level, Limit, Result, Situation
from gcs.flight_report.findings.limits import LOST_MESSAGES, Held

GAP = Limit(2.0, "s", "two heartbeats missed; MAVLink's heartbeat comes once a second")
LOST = Limit(3.5, "s", "heartbeat_age_s of the default policy: there is no vehicle any more")
FAILSAFE = {
    "px4": Limit(10.0, "s", "COM_DL_LOSS_T of a PX4 1.14"),
    "ardupilot": Limit(5.0, "s", "FS_GCS_TIMEOUT of an ArduCopter 4.7"),
}
"""After this long without a ground station the vehicle's own failsafe acts, where it is on."""
MAX_GAPS = 200


@dataclass(slots=True)
class LinkDetector:
    """`heard` is called for every message of the vehicle, whatever it says."""

    gaps: list[tuple[float, float, bool]] = field(default_factory=list)
    """Start, length in seconds, whether the vehicle was armed."""
    heard_s: float | None = None
    longest_s: float = 0.0
    loss: Held = field(default_factory=lambda: Held(LOST_MESSAGES))

    def heard(self, now: Situation) -> None:
        before = self.heard_s
        self.heard_s = now.t_s
        if before is not None:
            self._silence(before, now.t_s - before, now.armed)

    def handle(self, fact: Fact, now: Situation) -> None:
        if isinstance(fact, Status) and now.armed and fact.lost_pct is not None:
            self.loss.update(now.t_s, fact.lost_pct)

    def result(self, now: Situation) -> Result:
        result = Result()
        if self.heard_s is not None and now.flying:
            self._silence(self.heard_s, now.t_s - self.heard_s, armed=True)
        worst = Level.OK
        failsafe = FAILSAFE.get(now.autopilot)
        for start_s, length_s, armed in self.gaps:
            level = Level.NOTE
            if armed and length_s > LOST.value:
                acts = failsafe is not None and length_s > failsafe.value
                level = Level.CRITICAL if acts else Level.WARNING
            worst = max(worst, level, key=list(Level).index)
            limit = GAP if level is Level.NOTE else LOST
            result.findings.append(
                Finding(
                    "link",
                    level,
                    start_s,
                    f"nothing was heard of the vehicle for {length_s:.1f} s",
                    "" if armed else "it was not armed",
                    start_s + length_s,
                    limit.source,
                )
            )
        known = self.heard_s is not None
        measured = f"longest silence {self.longest_s:.2f} s" if known else ""
        told = f"below {GAP.value:g} s, lost above {LOST.value:g} s"
        result.checks.append(
            Check("link", "Silence", measured, told, LOST.source, worst if known else None)
        )
        self.loss.result(result)
        return result

    def _silence(self, start_s: float, length_s: float, armed: bool) -> None:
        self.longest_s = max(self.longest_s, length_s)
        if length_s > GAP.value and len(self.gaps) < MAX_GAPS:
            self.gaps.append((start_s, length_s, armed))
