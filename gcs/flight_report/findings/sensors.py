"""Accelerometer, gyroscope and compass: whether one measures something else than before at once.

In a hover the accelerometer measures gravity as the attitude says, and the gyroscope what the
attitude turned; the length of the field is the Earth's whichever way the vehicle looks.  What a
sensor was always wrong by is left to the autopilot, which knows it by its calibration.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field
from math import cos, dist, radians, sin
from statistics import median

from gcs.flight_report.facts import Acceleration, Fact, Failed, Field, Pose, Rotation, Sample
from gcs.flight_report.findings.finding import Check, Finding, Level, Limit, Result, Situation
from gcs.flight_report.findings.motors import LEANT_DEG, LEVEL_M_S, SLOW_M_S
from gcs.frames import Vec3

_OWN = "this project's own choice"
ACCELEROMETER = Limit(1.2, "m/s²", _OWN)
GYROSCOPE = Limit(0.04, "rad/s", _OWN)
COMPASS = Limit(30.0, "%", "ArduPilot wiki, Magnetic Interference (the number is from memory)")
"""Of the field's length: motors may change it by less."""
WINDOW_S = 1.5
TURNING_RAD_S = 0.05
"""A vehicle that turns faster is not asked for its gyroscope: the attitude comes too seldom."""
STEADY_S = 0.5
"""A hover is steady so long after it began."""
MEMORY = 40
_LEAST_SAMPLES = 8
_GRAVITY_M_S2 = 9.80665
_NONE: Vec3 = (0.0, 0.0, 0.0)


@dataclass(slots=True)
class _Shift:
    """One measure, window by window: two in a row that are far from those before are a shift."""

    limit: float
    before: deque[Vec3] = field(default_factory=lambda: deque(maxlen=MEMORY))
    suspect_s: float | None = None
    found: tuple[float, float] | None = None
    """Since when, and by how much."""
    most: float | None = None

    def add(self, t_s: float, mean: Vec3) -> None:
        if len(self.before) < 2:
            self.before.append(mean)
            return
        usual = tuple(median(values) for values in zip(*self.before, strict=True))
        off = dist(mean, usual)
        self.most = max(self.most or 0.0, off)
        if off <= self.limit:
            self.before.append(mean)
            self.suspect_s = None
        elif self.suspect_s is None:
            self.suspect_s = t_s
        elif self.found is None:
            self.found = self.suspect_s, off


@dataclass(slots=True)
class _Window:
    """Sums over a stretch of a hover."""

    began_s: float
    angles: Vec3
    forces: list[Vec3] = field(default_factory=list)
    rates: list[Vec3] = field(default_factory=list)


@dataclass(slots=True)
class SensorsDetector:
    force: _Shift = field(default_factory=lambda: _Shift(ACCELEROMETER.value))
    rate: _Shift = field(default_factory=lambda: _Shift(GYROSCOPE.value))
    length: _Shift = field(default_factory=lambda: _Shift(COMPASS.value))
    angles: Vec3 | None = None
    """Roll, pitch and yaw, radians."""
    steady_since_s: float | None = None
    window: _Window | None = None
    fields: list[float] = field(default_factory=list)
    fields_s: float = 0.0
    usual_gauss: float | None = None
    healthy: frozenset[str] | None = None
    failed: list[Finding] = field(default_factory=list)

    def handle(self, fact: Fact, now: Situation) -> None:
        match fact:
            case Pose():
                self._pose(fact, now)
            case Sample("attitude", (float() as roll, float() as pitch, float() as yaw, *_), 0):
                self.angles = radians(roll), radians(pitch), radians(yaw)
            case Acceleration(xyz) if self.window is not None:
                self.window.forces.append(_without_gravity(xyz, self.angles or _NONE))
                if now.t_s - self.window.began_s >= WINDOW_S:
                    self._window_ends(self.window, now.t_s)
            case Rotation(xyz) if self.window is not None:
                self.window.rates.append(xyz)
            case Field(gauss) if now.in_air:
                self._field(gauss, now.t_s)
            case Failed(sensors, present):
                self._health(sensors, present, now)
            case _:
                pass

    def _pose(self, pose: Pose, now: Situation) -> None:
        slow = pose.groundspeed_mps < SLOW_M_S and abs(pose.climb_mps) < LEVEL_M_S
        level = max(abs(pose.roll_deg), abs(pose.pitch_deg)) < LEANT_DEG
        if not (now.in_air and slow and level):
            self.steady_since_s = self.window = None
            return
        if self.steady_since_s is None:
            self.steady_since_s = now.t_s
        if self.window is None and now.t_s - self.steady_since_s >= STEADY_S and self.angles:
            self.window = _Window(now.t_s, self.angles)

    def _window_ends(self, window: _Window, t_s: float) -> None:
        angles = self.angles or _NONE
        self.window = _Window(t_s, angles)
        if t_s - window.began_s > 2.0 * WINDOW_S:
            return
        if len(window.forces) >= _LEAST_SAMPLES:
            self.force.add(window.began_s, _mean(window.forces))
        if len(window.rates) >= _LEAST_SAMPLES:
            turned = tuple(
                _turned(a, b) / (t_s - window.began_s)
                for a, b in zip(window.angles, angles, strict=True)
            )
            if max(map(abs, turned)) <= TURNING_RAD_S:
                x, y, z = _mean(window.rates)
                self.rate.add(window.began_s, (x - turned[0], y - turned[1], z - turned[2]))

    def _field(self, gauss: float, t_s: float) -> None:
        if self.fields and t_s - self.fields_s >= WINDOW_S:
            mean = sum(self.fields) / len(self.fields)
            if self.usual_gauss is None and mean > 0.0:
                self.usual_gauss = mean
            if self.usual_gauss:
                self.length.add(self.fields_s, (100.0 * mean / self.usual_gauss, 0.0, 0.0))
            self.fields = []
        if not self.fields:
            self.fields_s = t_s
        self.fields.append(gauss)

    def _health(self, sensors: frozenset[str], present: frozenset[str], now: Situation) -> None:
        """One that was healthy before."""
        lost = sensors & (self.healthy or frozenset())
        self.healthy = (self.healthy or frozenset()) - lost | (present - sensors)
        if not now.flying:
            return
        for sensor in sorted(lost):
            title = f"the autopilot said that its {sensor} failed"
            known = {finding.title for finding in self.failed}
            if title not in known:
                source = "MAVLink, SYS_STATUS"
                self.failed.append(Finding("sensor", Level.WARNING, now.t_s, title, source=source))

    def result(self, now: Situation) -> Result:
        result = Result(findings=list(self.failed))
        for name, limit, shift in (
            ("accelerometer", ACCELEROMETER, self.force),
            ("gyroscope", GYROSCOPE, self.rate),
            ("compass", COMPASS, self.length),
        ):
            level = None if shift.most is None else Level.OK
            if shift.found is not None:
                level = Level.WARNING
                t_s, off = shift.found
                title = f"the {name} measured something else at once"
                detail = f"by {off:.2g} {limit.unit}"
                result.findings.append(
                    Finding("sensor", level, t_s, title, detail, source=limit.source)
                )
            measured = "" if shift.most is None else f"shifted by at most {shift.most:.2g}"
            said = f"at most {limit.value:g} {limit.unit}"
            check = Check("sensor", name.capitalize(), measured, said, limit.source, level)
            result.checks.append(check)
        return result


def _without_gravity(force: Vec3, angles: Vec3) -> Vec3:
    """What is measured beside that which holds the vehicle up."""
    roll, pitch, _ = angles
    x, y, z = force
    return (
        x - _GRAVITY_M_S2 * sin(pitch),
        y + _GRAVITY_M_S2 * sin(roll) * cos(pitch),
        z + _GRAVITY_M_S2 * cos(roll) * cos(pitch),
    )


def _turned(before: float, after: float) -> float:
    """The shorter way round."""
    turn = after - before
    return turn if abs(turn) < radians(180.0) else turn - radians(360.0) * (1 if turn > 0 else -1)


def _mean(values: list[Vec3]) -> Vec3:
    x, y, z = (sum(column) / len(values) for column in zip(*values, strict=True))
    return x, y, z
