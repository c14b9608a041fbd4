"""What a flight was: everything that the page shows, as the scan of the record leaves it."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, radians

from gcs.flight_report.facts import Build, Decision, Fix, PlanItem
from gcs.flight_report.findings.finding import WENT_WRONG, Check, Finding
from gcs.flight_report.lanes import Lane
from gcs.flight_report.sampled import COLUMNS, Sampled
from gcs.flight_report.series import Series
from gcs.flight_report.spectrum import Spectrum
from gcs.flight_report.track import Track
from gcs.frames import Vec3
from gcs.report import FenceShape

EARTH_M = 6_371_000.0
MAX_REQUESTS = 500
MAX_TEXTS = 300
MAX_VEHICLES = 6
"""On one page."""


@dataclass(slots=True)
class Request:
    """A request from its verdict to its ending; None where the record has no such message."""

    request_id: int
    t_s: float
    word: str
    source: str
    outcome: str = ""
    code: str = ""
    sentence: str = ""
    goal_enu: Vec3 | None = None
    numbers: dict[str, float | None] = field(default_factory=dict)
    ended_s: float | None = None
    ending: str = ""
    ending_sentence: str = ""

    def told(self, t_s: float, fact: Decision) -> None:
        if fact.phase == "verdict":
            self.outcome, self.code, self.sentence = fact.outcome, fact.code, fact.sentence
            self.goal_enu, self.numbers = fact.goal_enu, fact.numbers
        else:
            self.ended_s, self.ending, self.ending_sentence = t_s, fact.outcome, fact.sentence


@dataclass(frozen=True, slots=True)
class Said:
    """A text of the vehicle; `severity` as MAV_SEVERITY."""

    t_s: float
    severity: int
    text: str


@dataclass(slots=True)
class Fence:
    """The fence and the margins that goals keep from it, metres; an empty one: none recorded."""

    zones: list[FenceShape] = field(default_factory=list)
    margin_h_m: float = 0.0
    margin_v_m: float = 0.0


@dataclass(slots=True)
class Totals:
    """The flight in numbers; None is not known."""

    armed_s: float = 0.0
    flying_s: float = 0.0
    take_offs: int = 0
    first_armed_s: float | None = None
    took_off_s: float | None = None
    landed_s: float | None = None
    """The last time; None while it flies at the end of the record."""
    began_in_air: bool = False
    max_up_m: float | None = None
    """Above the take-off point; where the record begins in the air, above home, or above where it
    landed, or else above where the record begins (`up_from`)."""
    max_distance_m: float | None = None
    """From the take-off point, or where the record begins, horizontally."""
    up_from: str = "its take-off point"
    max_speed_mps: float | None = None
    voltage_v: tuple[float, float] | None = None
    """First and last."""
    remaining_pct: tuple[float, float] | None = None


@dataclass(slots=True)
class Lanes:
    state: Lane = field(default_factory=lambda: Lane("Gate"))
    control: Lane = field(default_factory=lambda: Lane("Control"))
    severity: Lane = field(default_factory=lambda: Lane("Severity"))
    mode: Lane = field(default_factory=lambda: Lane("Vehicle's mode"))
    landed: Lane = field(default_factory=lambda: Lane("Vehicle"))

    @property
    def all(self) -> tuple[Lane, ...]:
        return (self.state, self.control, self.severity, self.mode, self.landed)


@dataclass(slots=True)
class Plots:
    """One series a plot."""

    height: Series = field(default_factory=lambda: Series(("height", "goal")))
    speed: Series = field(default_factory=lambda: Series(("over ground", "climb")))
    battery: Series = field(default_factory=lambda: Series(("voltage", "left", "current")))
    link: Series = field(default_factory=lambda: Series(("messages", "lost")))
    vibration: Series = field(default_factory=lambda: Series(("x", "y", "z")))
    gps: Series = field(default_factory=lambda: Series(("satellites", "HDOP")))
    estimator: Series = field(
        default_factory=lambda: Series(("velocity", "position", "height", "compass"))
    )
    sampled: dict[str, Sampled] = field(
        default_factory=lambda: {plot: Sampled.of(plot) for plot in COLUMNS}
    )


@dataclass(frozen=True, slots=True)
class Anchor:
    """A place that is known both on the earth and in the record's local frame.

    Others are told on a plane about it: a few kilometres away they are some decimetres off.
    """

    fix: Fix
    enu: Vec3

    def east_north_of(self, lat_deg: float, lon_deg: float) -> tuple[float, float]:
        fix = self.fix
        east_m = radians(lon_deg - fix.lon_deg) * EARTH_M * cos(radians(fix.lat_deg))
        return self.enu[0] + east_m, self.enu[1] + radians(lat_deg - fix.lat_deg) * EARTH_M

    def enu_of(self, item: PlanItem) -> Vec3:
        up_m = item.alt_m - (self.fix.alt_rel_m if item.above_home else self.fix.alt_amsl_m)
        return (*self.east_north_of(item.lat_deg, item.lon_deg), self.enu[2] + up_m)


@dataclass(slots=True)
class ParameterSeen:
    """A parameter: None is not known."""

    value: float | None = None
    """At the end."""
    first: float | None = None
    default: float | None = None
    changed_s: float | None = None
    """The last time."""

    def told(self, t_s: float, value: float | None, default: float | None) -> None:
        self.default = self.default if default is None else default
        if value is None:
            return
        if self.first is None:
            self.first = value
        elif value != self.value:
            self.changed_s = t_s
        self.value = value


@dataclass(slots=True)
class VehicleFlight:
    """The flight of one vehicle."""

    sysid: int
    autopilot: str = ""
    kind: str = ""
    build: Build = field(default_factory=Build)
    messages: int = 0
    totals: Totals = field(default_factory=Totals)
    lanes: Lanes = field(default_factory=Lanes)
    plots: Plots = field(default_factory=Plots)
    track: Track = field(default_factory=Track)
    anchor: Anchor | None = None
    plan: list[Vec3] = field(default_factory=list)
    """The places of its mission, east, north, up."""
    parameters: dict[str, ParameterSeen] = field(default_factory=dict)
    spectrum: Spectrum = field(default_factory=Spectrum)
    requests: list[Request] = field(default_factory=list)
    requests_left_out: int = 0
    said: list[Said] = field(default_factory=list)
    said_left_out: int = 0
    findings: list[Finding] = field(default_factory=list)
    """In time order."""
    checks: list[Check] = field(default_factory=list)

    @property
    def went_wrong(self) -> list[Finding]:
        """The findings that are more than notes, in time order."""
        return [finding for finding in self.findings if finding.level in WENT_WRONG]


@dataclass(slots=True)
class Flight:
    """The whole record."""

    name: str
    """Of the file."""
    size: int
    closed: bool = True
    damaged: int = 0
    unread_bytes: int = 0
    """At the end of the file, behind a damage."""
    start_ns: int | None = None
    seconds: float = 0.0
    messages: int = 0
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    fence: Fence = field(default_factory=Fence)
    vehicles: dict[int, VehicleFlight] = field(default_factory=dict)
    chosen: int | None = None
    """The vehicle that the page is to be about; None: the main one."""

    def shown_vehicles(self) -> list[VehicleFlight]:
        """Whom the page is about: the chosen one, else all that flew, the main one first."""
        main = self.main_vehicle()
        if main is None:
            return []
        if self.chosen in self.vehicles:
            return [main]
        others = (v for _, v in sorted(self.vehicles.items()) if v is not main)
        return [main, *(v for v in others if v.totals.take_offs)][:MAX_VEHICLES]

    def main_vehicle(self) -> VehicleFlight | None:
        """The chosen one, else the one that flew longest, was armed longest, said most."""
        if self.chosen in self.vehicles:
            return self.vehicles[self.chosen]
        return max(
            self.vehicles.values(),
            key=lambda v: (v.totals.flying_s, v.totals.armed_s, v.messages),
            default=None,
        )
