"""One vehicle while the record is read: its facts become series, lanes, totals and findings."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import dist
from typing import assert_never

from gcs.flight_report.facts import (
    Acceleration,
    Battery,
    Build,
    Cells,
    Clock,
    Decision,
    Estimator,
    Fact,
    Failed,
    Field,
    Fix,
    Gps,
    Identity,
    LogLine,
    Machine,
    Parameter,
    PlanItem,
    Pose,
    Rotation,
    Sample,
    Status,
    Text,
    Vibration,
)
from gcs.flight_report.findings.battery import BatteryDetector
from gcs.flight_report.findings.clock import ClockDetector
from gcs.flight_report.findings.estimator import AttitudeDetector, EstimatorDetector
from gcs.flight_report.findings.failsafes import FailsafeDetector
from gcs.flight_report.findings.finding import Detector, Situation, in_order
from gcs.flight_report.findings.gate import GateDetector
from gcs.flight_report.findings.gps import FIX_3D, GpsDetector
from gcs.flight_report.findings.link import LinkDetector
from gcs.flight_report.findings.motors import MotorsDetector
from gcs.flight_report.findings.sensors import SensorsDetector
from gcs.flight_report.findings.vibration import VibrationDetector
from gcs.flight_report.findings.wind import WindDetector
from gcs.flight_report.flight import (
    MAX_REQUESTS,
    MAX_TEXTS,
    Request,
    Said,
    VehicleFlight,
)
from gcs.flight_report.shown import Shown
from gcs.frames import Vec3

_IN_AIR = frozenset({"IN_AIR", "TAKEOFF", "LANDING"})
_ON_GROUND = "ON_GROUND"
RISEN_M, DOWN_M = 0.5, 0.25
"""Of a vehicle that does not say whether it is in the air: so far it rises from where it was armed
when it takes off, and so near it comes to that height when it lands."""
_BEGINNING = "where the record begins"
NOT_ON_EARTH_M = 1e7
"""A position farther from its origin, or not a number, is no position."""
_STEP_S = 2.0
"""Between two reports of the state that are farther apart nothing is counted as flown."""


@dataclass(slots=True)
class VehicleScan:
    flight: VehicleFlight
    now: Situation = field(default_factory=Situation)
    link: LinkDetector = field(default_factory=LinkDetector)
    _detectors: tuple[Detector, ...] = ()
    _status_s: float | None = None
    _goal_up_m: float | None = None
    _take_off: Vec3 | None = None
    _here: Vec3 | None = None
    _alt_rel_m: float | None = None
    _flew_since_armed: bool = False
    _armed_up_m: float | None = None
    """Where it was armed; None: the record begins with an armed vehicle, or knows no place."""
    _has_sys_status: bool = False
    _open_requests: dict[int, Request] = field(default_factory=dict)
    _shown: Shown = field(init=False)

    def __post_init__(self) -> None:
        self._shown = Shown(self.flight)
        self.now.sysid = self.flight.sysid
        self._detectors = (
            GateDetector(),
            FailsafeDetector(),
            GpsDetector(),
            EstimatorDetector(),
            BatteryDetector(),
            VibrationDetector(),
            SensorsDetector(),
            MotorsDetector(),
            WindDetector(),
            ClockDetector(),
            AttitudeDetector(),
            self.link,
        )

    def heard(self, t_s: float) -> None:
        """Any message of the vehicle."""
        self.now.t_s = t_s
        self.flight.messages += 1
        self.link.heard(self.now)

    def handle(self, fact: Fact, t_s: float) -> None:
        self.now.t_s = t_s
        self._take(fact, t_s)
        for detector in self._detectors:
            detector.handle(fact, self.now)

    def finish(self, end_s: float) -> VehicleFlight:
        flight = self.flight
        self._shown.finish()
        self.now.t_s = end_s
        for detector in self._detectors:
            result = detector.result(self.now)
            flight.checks += result.checks
            flight.findings += result.findings
        flight.findings.sort(key=in_order)
        if self.now.flying:
            flight.totals.landed_s = None
        return flight

    # ------------------------------------------------------------------------------ facts

    def _take(self, fact: Fact, t_s: float) -> None:
        plots = self.flight.plots
        match fact:
            case Identity(autopilot, kind):
                self.flight.autopilot, self.flight.kind = autopilot, kind
                self.now.autopilot, self.now.kind = autopilot, kind
            case Status():
                self._status(fact, t_s)
            case Pose():
                self._pose(fact, t_s)
            case Battery():
                self._battery(fact, t_s)
            case Vibration(x, y, z):
                plots.vibration.add(t_s, (x, y, z))
            case Gps(fix_type, satellites, hdop):
                # Without a fix it is a number that means unknown.
                plots.gps.add(t_s, (satellites, hdop if fix_type >= FIX_3D else None))
            case Estimator(autopilot, velocity, position, height, compass):
                if autopilot == self.now.autopilot:
                    plots.estimator.add(t_s, (velocity, position, height, compass))
            case Text(severity, text):
                self._said(Said(t_s, severity, text))
            case Machine(state, _, control, severity, goal_enu):
                self._goal_up_m = None if goal_enu is None else goal_enu[2]
                self.flight.lanes.state.add(t_s, state)
                self.flight.lanes.control.add(t_s, control)
                self.flight.lanes.severity.add(t_s, severity)
            case Decision():
                self._decision(fact, t_s)
            case Sample() | Acceleration() | Build() | Parameter() | Fix() | PlanItem():
                self._shown.take(fact, t_s, self._here, in_air=self.now.in_air)
            case Cells() | LogLine() | Clock() | Rotation() | Field() | Failed():
                pass
            case _:
                assert_never(fact)

    def _status(self, fact: Status, t_s: float) -> None:
        totals, now = self.flight.totals, self.now
        first = self._status_s is None
        step_s = 0.0 if self._status_s is None else min(t_s - self._status_s, _STEP_S)
        self._status_s = t_s
        totals.armed_s += step_s * now.armed
        totals.flying_s += step_s * now.flying
        if fact.armed and not now.armed:
            self._flew_since_armed = False
            self._armed_up_m = self._here[2] if self._here and not first else None
        known = fact.landed in _IN_AIR or fact.landed == _ON_GROUND
        flying = fact.landed in _IN_AIR if known else fact.armed and self._has_risen()
        if flying and not now.flying:
            totals.began_in_air |= first
            # By height alone a hop is no other flight.
            totals.take_offs += known or not self._flew_since_armed
            self._flew_since_armed = True
            totals.took_off_s = t_s if totals.took_off_s is None else totals.took_off_s
            self._take_off = self._take_off or (None if first else self._here)
        elif now.flying and not flying:
            self._landed(t_s)
        if fact.armed and totals.first_armed_s is None:
            totals.first_armed_s = t_s
            self._take_off = None if totals.began_in_air else self._here
        now.armed, now.flying, now.mode = fact.armed, flying, fact.mode
        now.in_air = fact.landed == "IN_AIR" if known else flying
        lanes = self.flight.lanes
        lanes.mode.add(t_s, fact.mode)
        lanes.landed.add(t_s, fact.landed if known else ("armed" if fact.armed else "disarmed"))
        self.flight.plots.link.add(t_s, (fact.rx_hz, fact.lost_pct))

    def _has_risen(self) -> bool:
        if self._here is None or self._armed_up_m is None:
            return True
        return self._here[2] - self._armed_up_m > (DOWN_M if self.now.flying else RISEN_M)

    def _landed(self, t_s: float) -> None:
        totals = self.flight.totals
        totals.landed_s = t_s
        if totals.up_from == _BEGINNING and self._here and self._take_off and totals.max_up_m:
            # The height that it came down to is a better zero than that it was met at.
            totals.max_up_m += self._take_off[2] - self._here[2]
            totals.up_from = "where it landed"

    def _started(self, here: Vec3) -> Vec3:
        """The place that heights and distances count from."""
        if not self.flight.totals.began_in_air:
            return here
        self.flight.totals.up_from = _BEGINNING
        if self._alt_rel_m is None:
            return here
        self.flight.totals.up_from = "home"
        return (here[0], here[1], here[2] - self._alt_rel_m)

    def _pose(self, fact: Pose, t_s: float) -> None:
        if not all(abs(metres) < NOT_ON_EARTH_M for metres in fact.pos_enu):
            return
        flight, totals = self.flight, self.flight.totals
        self._here, self._alt_rel_m = fact.pos_enu, fact.alt_rel_m
        flight.track.add(t_s, fact.pos_enu, flying=self.now.flying)
        up_m = fact.pos_enu[2]
        flight.plots.height.add(t_s, (up_m, self._goal_up_m if self.now.flying else None))
        flight.plots.speed.add(t_s, (fact.groundspeed_mps, fact.climb_mps))
        self._shown.pose(fact, t_s)
        if not self.now.flying:
            return
        totals.max_speed_mps = max(totals.max_speed_mps or 0.0, fact.groundspeed_mps)
        if self._take_off is None:
            self._take_off = self._started(fact.pos_enu)
        start = self._take_off
        totals.max_up_m = max(totals.max_up_m or 0.0, up_m - start[2])
        away_m = dist(start[:2], fact.pos_enu[:2])
        totals.max_distance_m = max(totals.max_distance_m or 0.0, away_m)

    def _battery(self, fact: Battery, t_s: float) -> None:
        # SYS_STATUS tells the current as well; the state, which is made of it, repeats the rest.
        if fact.current_a is not None:
            self._has_sys_status = True
        elif self._has_sys_status:
            return
        self.flight.plots.battery.add(t_s, (fact.voltage_v, fact.remaining_pct, fact.current_a))
        totals = self.flight.totals
        if fact.voltage_v is not None:
            first_v = totals.voltage_v[0] if totals.voltage_v else fact.voltage_v
            totals.voltage_v = (first_v, fact.voltage_v)
        if fact.remaining_pct is not None:
            first = totals.remaining_pct[0] if totals.remaining_pct else fact.remaining_pct
            totals.remaining_pct = (first, fact.remaining_pct)

    def _said(self, said: Said) -> None:
        if len(self.flight.said) < MAX_TEXTS:
            self.flight.said.append(said)
        else:
            self.flight.said_left_out += 1

    def _decision(self, fact: Decision, t_s: float) -> None:
        if fact.phase == "stream":
            return
        request = self._open_requests.get(fact.request_id)
        if request is None or fact.phase == "verdict":
            request = Request(fact.request_id, t_s, fact.word, fact.source)
            self._open_requests[fact.request_id] = request
            if len(self.flight.requests) < MAX_REQUESTS:
                self.flight.requests.append(request)
            else:
                self.flight.requests_left_out += 1
        request.told(t_s, fact)
        if fact.phase != "verdict" or fact.outcome != "accepted":
            self._open_requests.pop(fact.request_id, None)
