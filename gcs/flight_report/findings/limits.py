"""The limits that measured values are held against: what is measured, the limits and who says so,
and the words.  One row is one line of the report's checks, and a finding where a limit was passed.

Words are templates: {limit} and {unit} of the limit that was passed, {worst} value, when it was
{at}, how often and how long {spells}.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from gcs.flight_report.findings.finding import Check, Finding, Level, Limit, Result
from gcs.flight_report.findings.spells import Spells, Worst
from gcs.flight_report.number_format import clock

LEANT = {
    "px4": Limit(60.0, "deg", "FD_FAIL_R and FD_FAIL_P of a PX4 1.14: its failure detector acts"),
    "ardupilot": Limit(
        60.0, "deg", "this project's own choice: twice ATC_ANGLE_MAX of an ArduCopter 4.7"
    ),
}

_POLICY = "of this project's default policy, as an ArduCopter has no limit in percent"
BATTERY_LOW = {
    "px4": Limit(15.0, "%", "BAT_LOW_THR of a PX4 1.14"),
    "ardupilot": Limit(15.0, "%", f"low_pct {_POLICY}"),
}
BATTERY_CRITICAL = {
    "px4": Limit(7.0, "%", "BAT_CRIT_THR of a PX4 1.14"),
    "ardupilot": Limit(7.0, "%", f"critical_pct {_POLICY}"),
}
EMPTY_CELL = {
    "px4": Limit(3.6, "V", "BAT1_V_EMPTY of a PX4 1.14, a cell under load"),
    "ardupilot": Limit(3.5, "V", "BATT_LOW_VOLT of an ArduCopter 4.7, 10.5 V of three cells"),
}

REJECTED = {
    "px4": Limit(1.0, "", "MAVLink, ESTIMATOR_STATUS: above 1 a measurement is rejected"),
    "ardupilot": Limit(0.8, "", "FS_EKF_THRESH of an ArduCopter 4.7; ArduPilot wiki, EKF Failsafe"),
}

_LOGS = "ArduPilot wiki, Diagnosing problems using Logs"
HDOP_GOOD = Limit(1.5, "", _LOGS)
HDOP_BAD = {
    "px4": Limit(2.5, "", "EKF2_REQ_PDOP of a PX4 1.14; HDOP is a part of it"),
    "ardupilot": Limit(2.0, "", _LOGS),
}
SATELLITES_GOOD = Limit(12, "", _LOGS)
SATELLITES_NEEDED = {
    "px4": Limit(6, "", "EKF2_REQ_NSATS of a PX4 1.14"),
    "ardupilot": Limit(6, "", "EK3_GPS_CHECK of an ArduCopter 4.7 (the number is from memory)"),
}

STRONG_WIND = Limit(8.0, "m/s", "mission_wind_m_s of this project's default policy")

LOSS = Limit(5.0, "%", "this project's own choice")

WIKI = "ArduPilot wiki, Measuring Vibration"
_REVIEW = "PX4 Flight Review, configured_plots.py, Vibration Metrics"
FAIR = {"ardupilot": Limit(30.0, "m/s²", WIKI), "px4": Limit(4.905, "m/s²", _REVIEW)}
"""Above it there may be problems."""
BAD = {"ardupilot": Limit(60.0, "m/s²", WIKI), "px4": Limit(9.81, "m/s²", _REVIEW)}
"""Above it there nearly always are."""


class Limits(NamedTuple):
    """`bands` is how bad it is beyond which limit, the worst first; beyond `good` it is a note."""

    bands: tuple[tuple[Level, Limit], ...]
    told: str
    source: str
    good: Limit | None = None


@dataclass(frozen=True, slots=True)
class Row:
    """`limits` are everybody's, or those of an autopilot; of one without its own, the first."""

    subject: str
    name: str
    limits: Limits | dict[str, Limits]
    title: str
    detail: str
    measured: str
    low_is_bad: bool = False
    mild: bool = False

    def of(self, autopilot: str) -> Limits:
        if isinstance(self.limits, Limits):
            return self.limits
        return self.limits.get(autopilot) or next(iter(self.limits.values()))


def _vibration(kind: str, worst: Level, bad: Level) -> Limits:
    told = f"good below {FAIR[kind].value:g}, bad above {BAD[kind].value:g} {FAIR[kind].unit}"
    return Limits(((worst, BAD[kind]), (bad, FAIR[kind])), told, FAIR[kind].source)


def _estimator(ratio: str) -> Row:
    return Row(
        "estimator",
        f"Estimator, {ratio}",
        {
            kind: Limits(((Level.WARNING, limit),), f"below {limit.value:g}", limit.source)
            for kind, limit in REJECTED.items()
        },
        f"the estimator's {ratio} disagreed with the sensors",
        "ratio up to {worst:.2f} at {at}, above {limit:g} {spells}",
        "up to {worst:.2f}",
    )


TILT = Row(
    "attitude",
    "Roll and pitch",
    {
        kind: Limits(((Level.CRITICAL, limit),), f"below {limit.value:g} degrees", limit.source)
        for kind, limit in LEANT.items()
    },
    "the vehicle leant by more than {limit:g} degrees",
    "up to {worst:.0f} degrees at {at}; {spells}",
    "up to {worst:.0f} degrees",
)
BATTERY_LEFT = Row(
    "battery",
    "Battery left",
    {
        kind: Limits(
            ((Level.CRITICAL, BATTERY_CRITICAL[kind]), (Level.WARNING, low)),
            f"low below {low.value:g} %, critical below {BATTERY_CRITICAL[kind].value:g} %",
            f"{low.source}; {BATTERY_CRITICAL[kind].source}",
        )
        for kind, low in BATTERY_LOW.items()
    },
    "the battery fell below {limit:g} %",
    "down to {worst:.0f} %",
    "down to {worst:.0f} %",
    low_is_bad=True,
)
_CELLS = "down to {worst:.2f} V, {a_cell:.2f} V a cell of {cells}"
VOLTAGE = Row(
    "battery",
    "Voltage",
    {
        kind: Limits(((Level.WARNING, low),), f"at least {low.value:g} V a cell", low.source)
        for kind, low in EMPTY_CELL.items()
    },
    "the battery's cells fell below {limit:g} V",
    _CELLS + "; {spells}",
    _CELLS,
    low_is_bad=True,
)
RATIOS = tuple(map(_estimator, ("velocity", "position", "height", "compass")))
DILUTION = Row(
    "gps",
    "HDOP",
    {
        "px4": Limits(
            ((Level.WARNING, HDOP_BAD["px4"]),),
            f"bad above {HDOP_BAD['px4'].value:g}",
            HDOP_BAD["px4"].source,
        ),
        "ardupilot": Limits(
            ((Level.WARNING, HDOP_BAD["ardupilot"]),),
            f"good below {HDOP_GOOD.value:g}, bad above {HDOP_BAD['ardupilot'].value:g}",
            HDOP_BAD["ardupilot"].source,
            HDOP_GOOD,
        ),
    },
    "the GPS position was imprecise: HDOP above {limit:g}",
    "up to {worst:.2f} at {at}; {spells}",
    "up to {worst:.2f}",
    mild=True,
)
SATELLITES = Row(
    "gps",
    "Satellites",
    {
        "px4": Limits(
            ((Level.WARNING, SATELLITES_NEEDED["px4"]),),
            f"at least {SATELLITES_NEEDED['px4'].value:g}",
            SATELLITES_NEEDED["px4"].source,
        ),
        "ardupilot": Limits(
            ((Level.WARNING, SATELLITES_NEEDED["ardupilot"]),),
            f"{SATELLITES_GOOD.value:g} and more are good, "
            f"{SATELLITES_NEEDED['ardupilot'].value:g} needed",
            f"{SATELLITES_GOOD.source}; {SATELLITES_NEEDED['ardupilot'].source}",
            SATELLITES_GOOD,
        ),
    },
    "fewer than {limit:g} satellites",
    "down to {worst:.0f} at {at}; {spells}",
    "at least {worst:.0f}",
    low_is_bad=True,
    mild=True,
)
LOST_MESSAGES = Row(
    "link",
    "Loss",
    Limits(((Level.WARNING, LOSS),), f"at most {LOSS.value:g} %", LOSS.source),
    "more than {limit:g} % of the vehicle's messages were lost",
    "up to {worst:.0f} % at {at}; {spells}",
    "up to {worst:.1f} % lost",
    mild=True,
)
VIBRATION = Row(
    "vibration",
    "Vibration",
    {
        "ardupilot": _vibration("ardupilot", Level.CRITICAL, Level.WARNING),
        # Flight Review colours its bands and says no more of them.
        "px4": _vibration("px4", Level.WARNING, Level.NOTE),
    },
    "vibration above {limit:g} {unit}",
    "up to {worst:.1f} {unit}, at {at}; above the limit {spells}",
    "up to {worst:.1f} {unit}",
)

WIND = Row(
    "wind",
    "Wind",
    Limits(((Level.WARNING, STRONG_WIND),), f"below {STRONG_WIND.value:g} m/s", STRONG_WIND.source),
    "the wind was stronger than {limit:g} m/s",
    "up to {worst:.1f} m/s at {at}; {spells}",
    "up to {worst:.1f} m/s",
    mild=True,
)


@dataclass(slots=True)
class Held:
    """The values of one row while they come in."""

    row: Row
    worst: Worst = field(init=False)
    spells: list[Spells] = field(init=False)
    """Beyond each of the row's bands."""

    def __post_init__(self) -> None:
        self.worst = Worst(-1 if self.row.low_is_bad else 1)
        self.spells = [Spells() for _ in self.row.of("").bands]

    def update(
        self, t_s: float, value: float | None, autopilot: str = "", judged: float | None = None
    ) -> None:
        """`judged` is what the limits are of, where that is not the value."""
        judged = value if judged is None else judged
        self.worst.update(t_s, value)
        for spells, (_, limit) in zip(self.spells, self.row.of(autopilot).bands, strict=True):
            spells.update(t_s, judged is not None and self._beyond(judged, limit))

    def rest(self, t_s: float) -> None:
        """It is not judged now: a spell ends."""
        for spells in self.spells:
            spells.update(t_s, False)

    def result(self, result: Result, autopilot: str = "", **words: object) -> None:
        """Its check, and its finding if there is one; `words` are more that the row names."""
        row, limits, worst = self.row, self.row.of(autopilot), self.worst.value
        measured, level = "", None
        if worst is not None:
            words |= {"worst": worst, "at": clock(self.worst.t_s)}
            passed = [
                (s, *band) for s, band in zip(self.spells, limits.bands, strict=True) if s.count
            ]
            level = Level.OK
            if limits.good is not None and self._beyond(worst, limits.good):
                level = Level.NOTE
            measured = row.measured.format(unit=limits.bands[0][1].unit, **words)
            if passed:
                spells, level, limit = passed[0]
                words |= {"limit": limit.value, "unit": limit.unit, "spells": spells.words}
                title, detail = row.title.format(**words), row.detail.format(**words)
                result.findings.append(
                    Finding(
                        row.subject,
                        level,
                        spells.first_s,
                        title,
                        detail,
                        source=limit.source,
                        mild=row.mild and level is Level.WARNING,
                    )
                )
        check = Check(row.subject, row.name, measured, limits.told, limits.source, level)
        result.checks.append(check)

    def _beyond(self, value: float, limit: Limit) -> bool:
        return value < limit.value if self.row.low_is_bad else value > limit.value
