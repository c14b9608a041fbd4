"""What the gate did in flight: the brake, severities that act, requests that did not end well."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field

from gcs.flight_report.facts import Decision, Fact, LogLine, Machine
from gcs.flight_report.findings.finding import Check, Finding, Level, Result, Situation
from gcs.report import ConditionItem

MAX_FINDINGS = 200
_SOURCE = "the gate's own record"
_NODE = "state_and_safety"

EVENTS = {
    "breach predicted": (Level.WARNING, "the gate braked: it would have come out of the fence"),
    "position aged": (Level.WARNING, "the vehicle's position was too old"),
    "position jumped": (Level.WARNING, "the vehicle's position jumped"),
    "lost": (Level.WARNING, "the vehicle was not heard any more"),
    "operator lost": (Level.WARNING, "the operator was lost"),
    "clears no more": (Level.WARNING, "where it flew was not clear any more"),
    "hold refused": (Level.CRITICAL, "the vehicle refused to hold"),
    "hold unanswered": (Level.CRITICAL, "the vehicle did not answer the hold"),
}
"""Events of the gate's machine that say that something is wrong."""

LEVELS = {
    "CAUTION": Level.NOTE,
    "HOLD": Level.WARNING,
    "RETURN": Level.CRITICAL,
    "LAND": Level.CRITICAL,
    "TERMINATE": Level.CRITICAL,
}
WRONG_AS_CAUTION = frozenset({"too_close"})
"""Conditions of which a caution in flight is a thing that went wrong, not a note."""
_CONDITION = re.compile(
    r"^(?:vehicle (\d+): )?(CAUTION|HOLD|RETURN|LAND|TERMINATE): ([a-z_]+)(?:: (.*))?$", re.DOTALL
)
"""A line of the log; of one vehicle among several it begins with its number."""
CONDITIONS = {
    "recorder_failed": "the record could not be written",
    "battery_low": "the battery was low",
    "battery_critical": "the battery was critical",
    "origin_mismatch": "the origin of positions was not the expected one",
    "origin_missing": "the origin of positions was not known",
    "other_station": "another station was on the link",
    "link_poor": "the link was poor",
    "gps_lost": "the GPS was lost",
    "gps_poor": "the GPS was inaccurate",
    "estimator_unreliable": "the estimator's position was in doubt",
    "fence_breached": "the vehicle was outside the fence",
    "vehicle_fence_breached": "the vehicle was outside its own fence",
    "too_close": "the vehicle came too close to another one",
    "vehicle_failsafe_weak": "some of the vehicle's own failsafes are off",
    "vehicle_failsafe_active": "the vehicle said that it was in an emergency",
    "tick_late": "the station was late",
    "preflight_failed": "something failed that was looked at before the take-off",
}
_ENDED_BADLY = ("timed out", "taken over", "aborted")


@dataclass(slots=True)
class GateDetector:
    findings: list[Finding] = field(default_factory=list)
    refused: Counter[str] = field(default_factory=Counter)
    accepted: int = 0
    seen: bool = False
    stood: Machine | None = None
    standing: dict[str, str] | None = None
    """Conditions and their severities, as the machine told them last; None: it tells none."""

    def handle(self, fact: Fact, now: Situation) -> None:
        match fact:
            case Machine(event=event):
                self.seen = True
                # The record repeats where the machine stands, once a second and at its end.
                again, self.stood = fact == self.stood, fact
                if now.armed and event in EVENTS and not again:
                    level, title = EVENTS[event]
                    self._found(level, now.t_s, title, f"the gate went to {fact.state}")
                if fact.conditions is not None:
                    self._conditions(fact.conditions, now)
            case Decision():
                self.seen = True
                self._decision(fact, now)
            case LogLine(_, node, text) if node == _NODE and self.standing is None:
                self._log_line(text, now)
            case _:
                pass

    def _decision(self, fact: Decision, now: Situation) -> None:
        if fact.phase == "verdict":
            self.accepted += fact.outcome == "accepted"
            if fact.outcome == "refused":
                self.refused[fact.code] += 1
            return
        asked_for = fact.code in ("OPERATOR", "")
        if fact.outcome in _ENDED_BADLY and not (fact.outcome == "aborted" and asked_for):
            title = f"{fact.word} #{fact.request_id} {_ending(fact.outcome)}"
            self._found(Level.WARNING, now.t_s, title, fact.sentence, "request")

    def _conditions(self, conditions: tuple[ConditionItem, ...], now: Situation) -> None:
        before = self.standing or {}
        self.standing = {each.name: each.severity for each in conditions}
        for each in conditions:
            if before.get(each.name) != each.severity:
                self._condition(each.severity, each.name, each.text, now)

    def _log_line(self, text: str, now: Situation) -> None:
        found = _CONDITION.match(text)
        if found is None:
            return
        vehicle, severity, condition, why = found.groups()
        if vehicle is None or int(vehicle) == now.sysid:
            self._condition(severity, condition, why, now)

    def _condition(self, severity: str, condition: str, why: str | None, now: Situation) -> None:
        if severity not in LEVELS:
            return
        level = LEVELS[severity] if now.armed else Level.NOTE
        if now.armed and level is Level.NOTE and condition in WRONG_AS_CAUTION:
            level = Level.WARNING
        title = CONDITIONS.get(condition, condition.replace("_", " "))
        self._found(level, now.t_s, f"the gate called {severity}: {title}", why or condition)

    def _found(
        self, level: Level, t_s: float, title: str, detail: str, subject: str = "gate"
    ) -> None:
        if len(self.findings) < MAX_FINDINGS:
            self.findings.append(Finding(subject, level, t_s, title, detail, source=_SOURCE))

    def result(self, now: Situation) -> Result:
        refused = sum(self.refused.values())
        if not self.seen:
            return Result(findings=self.findings)
        codes = ", ".join(f"{n} {code}" for code, n in self.refused.most_common())
        measured = f"{self.accepted} accepted, {refused} refused"
        check = Check("gate", "Requests", measured, codes, _SOURCE, Level.OK)
        return Result([check], self.findings)


def _ending(outcome: str) -> str:
    return {"taken over": "was taken over", "aborted": "was aborted"}.get(outcome, outcome)
