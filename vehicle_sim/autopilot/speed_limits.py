"""How fast the vehicle flies by itself: by its parameters, and by what was asked for in flight."""

from __future__ import annotations

from dataclasses import replace

from vehicle_sim.autopilot.control.flight_control import FlightControl
from vehicle_sim.autopilot.control.gains import write_gains
from vehicle_sim.autopilot.interface import SpeedType
from vehicle_sim.autopilot.parameters.parameters import Parameters, Quantity
from vehicle_sim.autopilot.rules import RULES
from vehicle_sim.control_loops.trajectory import MotionLimits
from vehicle_sim.engine.step import Onboard


class SpeedLimits:
    """Made anew, with the gains of the loops, when a parameter or a wish has changed."""

    def __init__(self, parameters: Parameters, control: FlightControl, onboard: Onboard) -> None:
        self._parameters = parameters
        self._control = control
        self._onboard = onboard
        self.reset()

    def reset(self) -> None:
        """Only the parameters count."""
        self._cruise_m_s: float | None = None
        self._climb_m_s: float | None = None
        self._descend_m_s: float | None = None
        self.made_from = -1

    def change(self, speed_m_s: float | None, kind: SpeedType) -> None:
        """None = the default again.  A multicopter has no airspeed: that is over ground, too."""
        match kind:
            case SpeedType.CLIMB:
                self._climb_m_s = speed_m_s
            case SpeedType.DESCENT:
                self._descend_m_s = speed_m_s
            case _:
                self._cruise_m_s = speed_m_s
        self.made_from = -1

    def current(self) -> MotionLimits:
        """Made anew; `made_from` is the version of the parameters that it was made from."""
        self.made_from = self._parameters.version
        si = self._parameters.si
        self._control.heading.max_rad_s = si(Quantity.TURN_RAD_S)
        limits = MotionLimits(
            si(Quantity.CRUISE_M_S),
            self._climb_m_s if self._climb_m_s is not None else si(Quantity.CLIMB_M_S),
            self._descend_m_s if self._descend_m_s is not None else si(Quantity.DESCEND_M_S),
            si(Quantity.ACCEL_M_S2),
            si(Quantity.ACCEL_VERTICAL_M_S2),
            si(Quantity.ACCEL_UP_M_S2),
            self._parameters.get(self._parameters.rules.jerk),
            self._parameters.rules.law,
        )
        onboard = self._onboard
        write_gains(self._parameters, onboard.flight, onboard.est, onboard.believed)
        idle_thrust = RULES[self._parameters.personality].idle_thrust
        if idle_thrust is not None:
            self._control.idle = self._parameters.get(idle_thrust)
        cruise = self._cruise_m_s
        if cruise is None:
            return limits
        return replace(limits, speed_m_s=min(cruise, si(Quantity.FASTEST_M_S)))
