"""The battery: what remains, how low its cells are, how far it sags under load."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from math import ceil

from gcs.flight_report.facts import Battery, Cells, Fact
from gcs.flight_report.findings.finding import Check, Finding, Level, Limit, Result, Situation
from gcs.flight_report.findings.spells import Spells, Worst

LOW = Limit(15.0, "%", "BAT_LOW_THR of a PX4 1.14")
CRITICAL = Limit(7.0, "%", "BAT_CRIT_THR of a PX4 1.14")
EMPTY_CELL = Limit(3.6, "V", "BAT1_V_EMPTY of a PX4 1.14, a cell under load")
SAG = Limit(0.3, "V", "lithium polymer practice, from memory")
"""A cell, within `SAG_WINDOW_S`; PX4 expects BAT1_V_LOAD_DROP = 0.1 V of a good one."""
SAG_WINDOW_S = 5.0
FULL_CELL_V = 4.25
"""A pack whose cells are not reported has at least so many as keep each below this."""


@dataclass(slots=True)
class BatteryDetector:
    low: Spells = field(default_factory=Spells)
    critical: Spells = field(default_factory=Spells)
    remaining: Worst = field(default_factory=lambda: Worst(-1))
    voltage: Worst = field(default_factory=lambda: Worst(-1))
    empty: Spells = field(default_factory=Spells)
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
            for spells in (self.low, self.critical, self.empty):
                spells.update(now.t_s, False)
            return
        if remaining_pct is not None:
            self.remaining.update(now.t_s, remaining_pct)
            self.low.update(now.t_s, remaining_pct < LOW.value)
            self.critical.update(now.t_s, remaining_pct < CRITICAL.value)
        if voltage_v is None or self.cells is None:
            return
        self.voltage.update(now.t_s, voltage_v)
        self.empty.update(now.t_s, voltage_v / self.cells < EMPTY_CELL.value)
        while self.recent and now.t_s - self.recent[0][0] > SAG_WINDOW_S:
            self.recent.popleft()
        self.recent.append((now.t_s, voltage_v))
        self.sag.update(now.t_s, max(v for _, v in self.recent) - voltage_v)

    def result(self, now: Situation) -> Result:
        result = Result()
        self._remaining(result)
        self._cells(result)
        self._sag(result)
        return result

    def _remaining(self, result: Result) -> None:
        least, level = self.remaining.value, None
        if least is not None:
            level = Level.OK
            for spells, limit, bad in (
                (self.critical, CRITICAL, Level.CRITICAL),
                (self.low, LOW, Level.WARNING),
            ):
                if spells.count and level is Level.OK:
                    level = bad
                    result.findings.append(
                        Finding(
                            "battery",
                            bad,
                            spells.first_s,
                            f"the battery fell below {limit.value:g} %",
                            f"down to {least:.0f} %",
                            source=limit.source,
                        )
                    )
        measured = "" if least is None else f"down to {least:.0f} %"
        told = f"low below {LOW.value:g} %, critical below {CRITICAL.value:g} %"
        sources = f"{LOW.source}, {CRITICAL.source}"
        result.checks.append(Check("battery", "Battery left", measured, told, sources, level))

    def _cells(self, result: Result) -> None:
        lowest, cells = self.voltage.value, self.cells
        measured, level = "", None
        if lowest is not None and cells:
            level = Level.OK
            guessed = "" if self.cells_told else " (cells guessed)"
            measured = f"down to {lowest:.2f} V, {lowest / cells:.2f} V a cell of {cells}{guessed}"
            if self.empty.count:
                level = Level.WARNING
                result.findings.append(
                    Finding(
                        "battery",
                        level,
                        self.empty.first_s,
                        f"the battery's cells fell below {EMPTY_CELL.value:g} V",
                        f"{measured}; {self.empty.words}",
                        source=EMPTY_CELL.source,
                    )
                )
        told = f"at least {EMPTY_CELL.value:g} V a cell"
        result.checks.append(Check("battery", "Voltage", measured, told, EMPTY_CELL.source, level))

    def _sag(self, result: Result) -> None:
        most, cells = self.sag.value, self.cells
        measured, level = "", None
        if most is not None and cells:
            a_cell = most / cells
            measured = f"{most:.2f} V within {SAG_WINDOW_S:g} s, {a_cell:.2f} V a cell"
            level = Level.OK
            if a_cell > SAG.value:
                level = Level.WARNING
                result.findings.append(
                    Finding(
                        "battery",
                        level,
                        self.sag.t_s,
                        "the battery's voltage sagged",
                        f"by {measured}",
                        source=SAG.source,
                    )
                )
        told = f"at most {SAG.value:g} V a cell"
        result.checks.append(Check("battery", "Sag", measured, told, SAG.source, level))
