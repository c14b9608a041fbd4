"""Flown by hand: what the sticks make the vehicle do, in every manual mode.

Until the first stick is heard a manual mode flies as if it were held gently: level at its
height, or staying where it is.  (A real vehicle would be on its transmitter; one without would
fall in STABILIZE.)  Sticks that fall silent leave angle and rate modes as they were, as the
firmwares do, and count as centred in all others; what more happens is the failsafe's matter.
A mode that begins while they are silent does not fly by what they last said: PX4 would refuse it,
and ArduCopter takes them for centred in a radio failsafe.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import cos, sin, tan
from typing import assert_never

from vehicle_sim.autopilot.control.demands import (
    Demand,
    FlyAtHeight,
    FlyAttitude,
    FlyLean,
    FlyTo,
    FlyVelocity,
    Situation,
    Task,
    Turner,
)
from vehicle_sim.autopilot.interface import AttitudeSetpoint, Landed, Target
from vehicle_sim.autopilot.manual.stick_feel import Feel, feel_of, hover_of, thrust_of
from vehicle_sim.autopilot.manual.sticks import CENTRED, Radio, Sticks
from vehicle_sim.autopilot.modes import StickLaw
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.control_loops.trajectory import QUICK_M_S3, Law, MotionLimits
from vehicle_sim.numerics.gravity import GRAVITY_M_S2
from vehicle_sim.numerics.vectors import Vec3

_RAW = (StickLaw.RATES, StickLaw.ANGLE)
_CENTRED_RAD = 0.005
_LIFT_SHARE = 0.6  # of the hover thrust, from which a throttle flies
_LIFT_M_S = 0.1
_LOW_THROTTLE = 0.1
_RESTS_M_S = 0.3
_RESTS_NS = 500_000_000


class StickFlight:
    """One manual mode.  `idle` makes what it flies while there are no sticks at all."""

    done = True

    __slots__ = (
        "_at_rest_ns",
        "_climbing",
        "_feel",
        "_hold",
        "_idle",
        "_law",
        "_leaning",
        "_listened",
        "_make_idle",
        "_moving",
        "_parameters",
        "_radio",
        "_v_ned",
        "_version",
    )

    def __init__(
        self, law: StickLaw, parameters: Parameters, radio: Radio, idle: Callable[[], Task]
    ) -> None:
        self._law = law
        self._parameters = parameters
        self._radio = radio
        self._make_idle = idle
        self._idle: Task | None = idle()
        self._feel = feel_of(parameters)
        self._version = parameters.version
        self._hold: Vec3 = (0.0, 0.0, 0.0)
        self._v_ned: Vec3 | None = None
        self._moving = self._climbing = self._leaning = False
        self._at_rest_ns: int | None = None
        self._listened = False  # sticks were heard in this mode

    @property
    def landed_word(self) -> Landed:
        return Landed.IN_AIR

    @property
    def target(self) -> Target:
        if self._idle is not None:
            return self._idle.target
        if self._law in _RAW or self._leaning:
            return Target(None, None, None)
        if self._moving or self._climbing:
            return Target(None, self._v_ned, None)
        return Target(None if self._law is StickLaw.ALTITUDE else self._hold, None, None)

    def lifts_off(self, s: Situation) -> bool:
        hand = self._hand(s)
        if hand is None:
            return False
        if self._law in _RAW:
            floor = _LIFT_SHARE * hover_of(self._parameters)
            return thrust_of(self._parameters, hand) > floor
        return self._now().climb(hand) > _LIFT_M_S

    def begin(self, s: Situation, turner: Turner) -> None:
        if self._idle is not None:
            self._idle.begin(s, turner)
        self._hold = s.stop_ned
        self._moving = self._climbing = self._leaning = False
        self._at_rest_ns = None

    def update(self, s: Situation, turner: Turner) -> Demand:
        hand = self._hand(s)
        if hand is None:
            if self._idle is None:
                # Given back in flight: as if they had never been there, from here on.
                self._idle = self._make_idle()
                self._idle.begin(s, turner)
            return self._idle.update(s, turner)
        if self._idle is not None:
            self._idle = None
            self.begin(s, turner)
        feel = self._now()
        limits = replace(
            s.limits,
            jerk_m_s3=QUICK_M_S3,
            law=Law.STEADY,
            speed_m_s=feel.speed_m_s,
            climb_m_s=feel.climb_m_s,
            descend_m_s=feel.descend_m_s,
            accel_m_s2=feel.accel_m_s2,
            accel_vertical_m_s2=feel.accel_down_m_s2,
            accel_up_m_s2=feel.accel_up_m_s2,
        )
        match self._law:
            case StickLaw.RATES | StickLaw.ANGLE:
                return self._by_thrust(hand, feel, s, turner, limits)
            case StickLaw.ALTITUDE:
                return self._at_altitude(hand, feel, s, turner, limits)
            case StickLaw.POSITION:
                return self._over_ground(hand, feel, s, turner, limits)
            case StickLaw.LEAN_AND_STAY:
                if _leans(feel.lean(hand)):
                    return self._at_altitude(hand, feel, s, turner, limits)
                return self._over_ground(
                    replace(hand, roll=0.0, pitch=0.0), feel, s, turner, limits
                )
            case _:
                assert_never(self._law)

    # --------------------------------------------------------------------------- the laws

    def _by_thrust(
        self, hand: Sticks, feel: Feel, s: Situation, turner: Turner, limits: MotionLimits
    ) -> Demand:
        """Rates or angles, and the throttle as it is."""
        if self._rests(hand.throttle < _LOW_THROTTLE, s):
            return FlyVelocity((0.0, 0.0, limits.descend_m_s), limits)
        thrust = thrust_of(self._parameters, hand)
        if self._law is StickLaw.RATES:
            return FlyAttitude(AttitudeSetpoint(None, feel.rates(hand), thrust), False, limits)
        turner.turn_by_rate(feel.turn(hand))
        a_n, a_e = self._pull(hand, feel, s)
        return FlyLean(a_n, a_e, limits, thrust=thrust)

    def _at_altitude(
        self, hand: Sticks, feel: Feel, s: Situation, turner: Turner, limits: MotionLimits
    ) -> Demand:
        """Lean angles; the height is held, or changed at a rate."""
        climb_m_s = feel.climb(hand)
        if self._rests(climb_m_s < 0.0, s):
            return FlyVelocity((0.0, 0.0, limits.descend_m_s), limits)
        turner.turn_by_rate(feel.turn(hand))
        if self._climbing and climb_m_s == 0.0:
            self._hold = s.stop_ned
        self._climbing = climb_m_s != 0.0
        self._leaning = True
        self._v_ned = None
        a_n, a_e = self._pull(hand, feel, s)
        if self._climbing:
            return FlyLean(a_n, a_e, limits, v_d=-climb_m_s)
        return FlyLean(a_n, a_e, limits, down_m=self._hold[2])

    def _over_ground(
        self, hand: Sticks, feel: Feel, s: Situation, turner: Turner, limits: MotionLimits
    ) -> Demand:
        """Velocity in the heading's frame; centred sticks brake, and stay."""
        turner.turn_by_rate(feel.turn(hand))
        climb_m_s = feel.climb(hand)
        forward, right = feel.velocity(hand)
        moving = forward != 0.0 or right != 0.0
        climbing = climb_m_s != 0.0
        stop = s.stop_ned
        north, east = self._hold[0], self._hold[1]
        if not moving and (self._moving or self._leaning):
            north, east = stop[0], stop[1]
        down = stop[2] if self._climbing and not climbing else self._hold[2]
        self._hold = (north, east, down)
        self._moving, self._climbing, self._leaning = moving, climbing, False
        if not moving and not climbing:
            return FlyTo(self._hold, limits)
        v_n, v_e = _turned(forward, right, s.heading_rad)
        self._v_ned = (v_n, v_e, -climb_m_s)
        if climbing:
            return FlyVelocity(self._v_ned, limits)
        return FlyAtHeight(v_n, v_e, down, limits)

    # ---------------------------------------------------------------------------- helpers

    def _hand(self, s: Situation) -> Sticks | None:
        """The sticks to fly by; None while there are none, or no more."""
        if not self._radio.heard:
            return None
        now = self._radio.sticks(s.wall_ns)
        if now is not None:
            self._listened = True
            return now
        if self._law not in _RAW:
            return CENTRED
        return self._radio.last if self._listened else None

    def _now(self) -> Feel:
        if self._version != self._parameters.version:
            self._version = self._parameters.version
            self._feel = feel_of(self._parameters)
        return self._feel

    def _pull(self, hand: Sticks, feel: Feel, s: Situation) -> tuple[float, float]:
        """North and east acceleration [m/s^2] that leans as the sticks say."""
        forward_rad, right_rad = feel.lean(hand)
        forward = GRAVITY_M_S2 * tan(forward_rad)
        right = GRAVITY_M_S2 * tan(right_rad)
        return _turned(forward, right, s.heading_rad)

    def _rests(self, wants_down: bool, s: Situation) -> bool:
        """It is to sink and does not: it stands on the ground, and may settle there."""
        if not wants_down or abs(s.v_ned[2]) > _RESTS_M_S:
            self._at_rest_ns = None
            return False
        if self._at_rest_ns is None:
            self._at_rest_ns = s.time_ns
        return s.time_ns - self._at_rest_ns >= _RESTS_NS


def _leans(lean_rad: tuple[float, float]) -> bool:
    return abs(lean_rad[0]) > _CENTRED_RAD or abs(lean_rad[1]) > _CENTRED_RAD


def _turned(forward: float, right: float, heading_rad: float) -> tuple[float, float]:
    """North and east."""
    c, sn = cos(heading_rad), sin(heading_rad)
    return (c * forward - sn * right, sn * forward + c * right)
