"""Circles: PX4's Orbit mode (DO_ORBIT) and ArduCopter's CIRCLE."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import IntEnum
from math import atan2, copysign, cos, hypot, pi, remainder, sin, sqrt
from typing import Protocol

from vehicle_sim.autopilot.control.demands import Demand, FlyCircle, FlyTo, Situation, Turner
from vehicle_sim.autopilot.interface import Landed, Orbiting, Target
from vehicle_sim.autopilot.manual.stick_feel import shaped
from vehicle_sim.autopilot.manual.sticks import Radio
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.numerics.vectors import Vec3

_DEG = 0.017453292519943295
_SPEED_MAX_M_S = 10.0
_ACCEL_MAX_M_S2 = 2.0
_RADIUS_MIN_M = 1.0
_ON_CIRCLE_M = 1.0
_NOSE_P = 1.0  # 1/s
_NOSE_ALONG, _ABOUT_HERE = 2, 4  # CIRCLE_OPTIONS


class Nose(IntEnum):
    """ORBIT_YAW_BEHAVIOUR."""

    TO_CENTRE = 0
    INITIAL = 1
    FREE = 2
    ALONG = 3
    BY_STICK = 4
    UNCHANGED = 5


@dataclass(frozen=True, slots=True)
class Round:
    """A circle to fly; its height is the centre's.  Positive speed is clockwise from above."""

    centre_ned: Vec3
    radius_m: float
    speed_m_s: float
    nose: Nose

    @property
    def turn_rad_s(self) -> float:
        return self.speed_m_s / self.radius_m


def px4_round(
    parameters: Parameters,
    centre_ned: Vec3,
    radius_m: float,
    speed_m_s: float,
    nose: Nose,
) -> Round | None:
    """DO_ORBIT as PX4 takes it: the radius' sign is the direction; None = radius out of range.

    The speed is at most 10 m/s, and what 2 m/s^2 can bend into the circle.
    """
    size_m = abs(radius_m)
    if not _RADIUS_MIN_M <= size_m <= parameters.get("MC_ORBIT_RAD_MAX"):
        return None
    way = 1.0 if radius_m > 0.0 else -1.0
    return Round(centre_ned, size_m, _bendable(size_m, way * speed_m_s), nose)


def _bendable(radius_m: float, speed_m_s: float) -> float:
    fastest = min(_SPEED_MAX_M_S, sqrt(_ACCEL_MAX_M_S2 * radius_m))
    return copysign(min(abs(speed_m_s), fastest), speed_m_s)


class Way(Protocol):
    """Where a circle comes from when its mode begins."""

    def __call__(self, s: Situation) -> Round: ...


def px4_default(s: Situation) -> Round:
    """Orbit mode without a command: the smallest circle, round where the vehicle stops."""
    return Round(s.stop_ned, _RADIUS_MIN_M, 1.0, Nose.TO_CENTRE)


def ardupilot_circle(parameters: Parameters) -> Way:
    """CIRCLE: CIRCLE_RADIUS ahead of where the vehicle stops, at CIRCLE_RATE.

    CIRCLE_OPTIONS puts its centre there, or the nose along the flight.
    """

    def way(s: Situation) -> Round:
        radius_m = max(0.01 * parameters.get("CIRCLE_RADIUS"), 0.01)
        options = int(parameters.get("CIRCLE_OPTIONS"))
        n, e, d = s.stop_ned
        ahead_m = 0.0 if options & _ABOUT_HERE else radius_m
        centre = (n + ahead_m * cos(s.heading_rad), e + ahead_m * sin(s.heading_rad), d)
        nose = Nose.ALONG if options & _NOSE_ALONG else Nose.TO_CENTRE
        rate_rad_s = parameters.get("CIRCLE_RATE") * _DEG
        fastest = min(s.limits.speed_m_s, sqrt(s.limits.accel_m_s2 * radius_m))
        speed_m_s = min(abs(rate_rad_s) * radius_m, fastest)
        return Round(centre, radius_m, copysign(speed_m_s, rate_rad_s), nose)

    return way


@dataclass(slots=True, eq=False, repr=False)
class Orbit:
    """To the nearest point of the circle, then round it for ever.

    With a `radio` the sticks change the circle as in PX4: pitch its radius, roll its speed.
    """

    landed_word = Landed.IN_AIR
    done = False

    _way: Way
    _parameters: Parameters
    _radio: Radio | None = None
    _time_ns: int = field(default=0, init=False)
    _round: Round | None = field(default=None, init=False)
    _heading_rad: float = field(default=0.0, init=False)
    _approaching: bool = field(default=True, init=False)

    @property
    def target(self) -> Target:
        return Target(None if self._round is None else self._round.centre_ned, None, None)

    @property
    def status(self) -> Orbiting | None:
        """For ORBIT_EXECUTION_STATUS."""
        r = self._round
        if r is None:
            return None
        return Orbiting(r.centre_ned, copysign(r.radius_m, r.speed_m_s))

    def lifts_off(self, s: Situation) -> bool:
        return False

    def begin(self, s: Situation, turner: Turner) -> None:
        self._round = self._way(s)
        self._heading_rad = s.heading_rad
        self._approaching = True
        self._time_ns = s.time_ns

    def change(self, to: Round, s: Situation) -> None:
        """Another circle, from the flight."""
        self._round = to
        self._heading_rad = s.heading_rad
        self._approaching = True

    @property
    def round(self) -> Round | None:
        return self._round

    def update(self, s: Situation, turner: Turner) -> Demand:
        r = self._round
        if r is None:
            return FlyTo(s.stop_ned, s.limits)
        r = self._round = self._steered(r, s)
        c = r.centre_ned
        north, east = s.pos_ned[0] - c[0], s.pos_ned[1] - c[1]
        away_m = hypot(north, east)
        bearing = atan2(east, north) if away_m > 0.0 else s.heading_rad + pi
        if self._approaching:
            entry = (c[0] + r.radius_m * cos(bearing), c[1] + r.radius_m * sin(bearing), c[2])
            near = abs(away_m - r.radius_m) < _ON_CIRCLE_M
            if not near or abs(s.pos_ned[2] - c[2]) >= _ON_CIRCLE_M:
                turner.turn_to(remainder(bearing + pi, 2.0 * pi))
                return FlyTo(entry, s.limits)
            self._approaching = False
        self._point(r, bearing, s, turner)
        limits = replace(s.limits, speed_m_s=max(s.limits.speed_m_s, abs(r.speed_m_s)))
        return FlyCircle(c, r.radius_m, r.turn_rad_s, limits)

    def _steered(self, r: Round, s: Situation) -> Round:
        """Full stick changes the radius at MPC_XY_CRUISE and the speed at MPC_ACC_HOR."""
        dt_s = (s.time_ns - self._time_ns) * 1e-9
        self._time_ns = s.time_ns
        hand = None if self._radio is None else self._radio.sticks(s.wall_ns)
        if hand is None:
            return r
        get = self._parameters.get
        dead, curve = get("MPC_HOLD_DZ"), get("MPC_XY_MAN_EXPO")
        inward = shaped(hand.pitch, dead, curve) * get("MPC_XY_CRUISE") * dt_s
        slower = shaped(hand.roll, dead, curve) * get("MPC_ACC_HOR") * dt_s
        if inward == 0.0 and slower == 0.0:
            return r
        widest = get("MC_ORBIT_RAD_MAX")
        radius_m = min(widest, max(_RADIUS_MIN_M, r.radius_m - inward))
        return replace(r, radius_m=radius_m, speed_m_s=_bendable(radius_m, r.speed_m_s - slower))

    def _point(self, r: Round, bearing: float, s: Situation, turner: Turner) -> None:
        """The nose: turned along with the circle, and towards where it belongs."""
        match r.nose:
            case Nose.TO_CENTRE | Nose.UNCHANGED:
                wanted, along = bearing + pi, r.turn_rad_s
            case Nose.ALONG:
                wanted, along = bearing + copysign(0.5 * pi, r.turn_rad_s), r.turn_rad_s
            case Nose.INITIAL:
                wanted, along = self._heading_rad, 0.0
            case Nose.FREE | Nose.BY_STICK:
                turner.turn_by_rate(0.0)
                return
        off = remainder(wanted - s.heading_rad, 2.0 * pi)
        turner.turn_by_rate(along + _NOSE_P * off)
