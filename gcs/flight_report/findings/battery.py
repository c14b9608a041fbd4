"""The battery: what remains, how low its cells are, how far it sags under load."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from math import ceil

from gcs.flight_report.facts import Battery, Cells, Fact
from gcs.flight_report.findings.finding import Check, Finding, Level, Limit, Result, Situation
from gcs.flight_report.findings.limits import BATTERY_LEFT, VOLTAGE, Held
from gcs.flight_report.findings.spells import Worst

SAG = Limit(0.3, "V", "lithium polymer practice, from memory")
"""A cell, within `SAG_WINDOW_S`; PX4 expects BAT1_V_LOAD_DROP = 0.1 V of a good one."""
SAG_WINDOW_S = 5.0
FULL_CELL_V = 4.25
"""A pack whose cells are not reported has at least so many as keep each below this."""


@dataclass(slots=True)
class BatteryDetector:
    remaining: Held = field(default_factory=lambda: Held(BATTERY_LEFT))
    voltage: Held = field(default_factory=lambda: Held(VOLTAGE))
    sag: Worst = field(default_factory=Worst)
    cells: int | None = None
    cells_told: bool = False
    recent: deque[tuple[float, float]] = field(default_factory=deque)

    def handle(self, fact: Fact, now: Situation) -> None:
        match fact:
            case Cells(count):
                self.cells = max(count, self.cells or 0) if self.cells_told else count
                self.cells_told = True
            case Battery(voltage_v, _, remaining_pct):
                self._battery(voltage_v, remaining_pct, now)
            case _:
                pass

    def _battery(
        self, voltage_v: float | None, remaining_pct: float | None, now: Situation
    ) -> None:
        if voltage_v is not None and self.cells is None:
            self.cells = max(1, ceil(voltage_v / FULL_CELL_V))
        if not now.armed:
            self.recent.clear()
            self.remaining.rest(now.t_s)
            self.voltage.rest(now.t_s)
            return
        if remaining_pct is not None:
            self.remaining.update(now.t_s, remaining_pct, now.autopilot)
        if voltage_v is None or self.cells is None:
            return
        self.voltage.update(now.t_s, voltage_v, now.autopilot, voltage_v / self.cells)
        while self.recent and now.t_s - self.recent[0][0] > SAG_WINDOW_S:
            self.recent.popleft()
        self.recent.append((now.t_s, voltage_v))
        self.sag.update(now.t_s, max(v for _, v in self.recent) - voltage_v)

    def result(self, now: Situation) -> Result:
        result = Result()
        self.remaining.result(result, now.autopilot)
        lowest, cells = self.voltage.worst.value, self.cells
        a_cell = lowest / cells if lowest is not None and cells else 0.0
        guessed = "" if self.cells_told else " (cells guessed)"
        self.voltage.result(result, now.autopilot, a_cell=a_cell, cells=f"{cells}{guessed}")
        self._sag(result)
        return result

    def _sag(self, result: Result) -> None:
        most, cells = self.sag.value, self.cells
        measured, level = "", None
        if most is not None and cells:
            a_cell = most / cells
            measured = f"{most:.2f} V within {SAG_WINDOW_S:g} s, {a_cell:.2f} V a cell"
            level = Level.OK
            if a_cell > SAG.value:
                level = Level.WARNING
                title, detail = "the battery's voltage sagged", f"by {measured}"
                result.findings.append(
                    Finding("battery", level, self.sag.t_s, title, detail, source=SAG.source)
                )
        told = f"at most {SAG.value:g} V a cell"
        result.checks.append(Check("battery", "Sag", measured, told, SAG.source, level))
