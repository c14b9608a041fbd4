"""What the vehicle's own failsafes did: their texts, and the mode that followed."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from gcs.flight_report.facts import Fact, Status, Text
from gcs.flight_report.findings.finding import Finding, Level, Result, Situation

FOLLOWS_WITHIN_S = 10.0
"""PX4 holds for COM_FAIL_ACT_T = 5 s before its failsafe acts, ArduCopter's acts at once."""
MAX_FINDINGS = 200


class FailsafeText(NamedTuple):
    pattern: re.Pattern[str]
    level: Level
    title: str
    source: str
    subject: str
    """What was wrong; "failsafe" where the text says only that something was done about it."""


def _row(
    pattern: str, level: Level, title: str, source: str, subject: str = "failsafe"
) -> FailsafeText:
    return FailsafeText(re.compile(pattern, re.IGNORECASE), level, title, source, subject)


_PX4 = "texts of a PX4 1.14, recorded"
_COPTER = "texts of an ArduCopter 4.7, recorded"
_MEMORY = "texts of the autopilots, from memory"

TEXTS = (
    _row(
        r"due to manual control loss|^radio failsafe(?! cleared)",
        Level.CRITICAL,
        "the radio control was lost",
        "texts of a PX4 1.14, from memory, and of an ArduCopter 4.7, recorded",
        "radio",
    ),
    _row(r"^failsafe activated", Level.CRITICAL, "the vehicle's failsafe acted", _PX4),
    _row(
        r"^connection to ground station lost",
        Level.WARNING,
        "the vehicle lost its station",
        _PX4,
        "link",
    ),
    _row(
        r"^(gcs|battery|ekf|terrain|dead ?reckon) failsafe(?! cleared)",
        Level.CRITICAL,
        "the vehicle's failsafe acted",
        _COPTER,
    ),
    _row(
        r"^battery \d+ is critical", Level.CRITICAL, "the battery was critical", _COPTER, "battery"
    ),
    _row(r"^battery \d+ is low", Level.WARNING, "the battery was low", _COPTER, "battery"),
    _row(
        r"fence breached", Level.CRITICAL, "the vehicle was outside its own fence", _COPTER, "fence"
    ),
    _row(
        r"geofence violation",
        Level.CRITICAL,
        "the vehicle was outside its own fence",
        _PX4,
        "fence",
    ),
    _row(r"flight termination", Level.CRITICAL, "the flight was terminated", _PX4),
    _row(r"^ekf variance", Level.CRITICAL, "the vehicle's estimator failed", _MEMORY),
    _row(r"^gps glitch(?!.*cleared)", Level.WARNING, "the GPS position jumped", _MEMORY, "gps"),
    _row(
        r"crash: disarming",
        Level.CRITICAL,
        "the vehicle found that it had crashed",
        _MEMORY,
        "attitude",
    ),
    _row(
        r"potential thrust loss",
        Level.CRITICAL,
        "a motor could give no more thrust",
        _MEMORY,
        "motors",
    ),
    _row(r"motor \d+ failure", Level.CRITICAL, "a motor failed", _MEMORY, "motors"),
    _row(r"attitude failure", Level.CRITICAL, "the vehicle lost its attitude", _MEMORY, "attitude"),
    _row(
        r"vibration compensation on",
        Level.WARNING,
        "vibration upset the height",
        _MEMORY,
        "vibration",
    ),
    _row(
        r"^critical battery|^emergency battery",
        Level.CRITICAL,
        "the battery was critical",
        _MEMORY,
        "battery",
    ),
    _row(r"^low battery", Level.WARNING, "the battery was low", _MEMORY, "battery"),
)
"""What a text that matches means; the first that matches counts."""


@dataclass(slots=True)
class FailsafeDetector:
    findings: list[Finding] = field(default_factory=list)
    mode_before: str = ""
    waits_for_mode: bool = False
    """The mode that follows the last finding is still to come."""

    def handle(self, fact: Fact, now: Situation) -> None:
        match fact:
            case Text(_, text):
                self._text(text, now)
            case Status(_, mode):
                self._mode(mode, now)
            case _:
                pass

    def _text(self, text: str, now: Situation) -> None:
        if not now.armed or len(self.findings) >= MAX_FINDINGS:
            return
        row = next((row for row in TEXTS if row.pattern.search(text)), None)
        if row is not None:
            words = f"it said: {text}"
            self.waits_for_mode = True
            self.findings.append(
                Finding(row.subject, row.level, now.t_s, row.title, words, source=row.source)
            )

    def _mode(self, mode: str, now: Situation) -> None:
        changed = bool(self.mode_before) and mode != self.mode_before
        self.mode_before = mode
        if not changed or not self.waits_for_mode:
            return
        self.waits_for_mode = False
        last = self.findings[-1]
        since_s = now.t_s - last.t_s
        if since_s <= FOLLOWS_WITHIN_S:
            then = f"; then mode {mode} after {since_s:.1f} s"
            self.findings[-1] = replace(last, detail=last.detail + then)

    def result(self, now: Situation) -> Result:
        return Result(findings=self.findings)
