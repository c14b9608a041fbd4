"""A PX4 along one axis: its velocity and position loops, its drag, and how its hold mode stops it.

The gains are PX4 1.14.3's parameters as recorded (MPC_XY_P, MPC_XY_VEL_P_ACC, MPC_XY_VEL_I_ACC,
MPC_ACC_HOR, MPC_JERK_AUTO), the drag is that of its own simulation.  `test_px4_loops.py` holds it
against the recorded stops.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

STEP_S = 0.01
POSITION_P, VELOCITY_P, VELOCITY_I = 0.95, 1.8, 0.4
DRAG_PER_S = 1.0
MOST_M_S, MOST_M_S2 = 12.0, 10.0
HOLD_M_S2, HOLD_M_S3 = 3.0, 4.0
ATTITUDE_S = 0.3
"""What tilting takes."""


@dataclass(slots=True)
class Craft:
    """Metres and metres per second along the axis; `held` is what its integrator has."""

    x: float = 0.0
    v: float = 0.0
    a: float = 0.0
    held: float = 0.0
    flown: list[tuple[float, float]] = field(default_factory=list)

    def fly_at(self, asked_m_s: float) -> None:
        """One step with a velocity setpoint."""
        asked_m_s = max(-MOST_M_S, min(MOST_M_S, asked_m_s))
        error_m_s = asked_m_s - self.v
        wanted = max(-MOST_M_S2, min(MOST_M_S2, VELOCITY_P * error_m_s + self.held))
        self.held += VELOCITY_I * error_m_s * STEP_S
        self.a += (wanted - self.a) / ATTITUDE_S * STEP_S
        self.v += (self.a - DRAG_PER_S * self.v) * STEP_S
        self.x += self.v * STEP_S
        self.flown.append((self.x, self.v))

    def fly_to(self, place_m: float) -> None:
        """One step with a position setpoint."""
        self.fly_at(POSITION_P * (place_m - self.x))

    def told_s_ago(self, seconds: float) -> tuple[float, float]:
        """Position and velocity as they were then."""
        steps = round(seconds / STEP_S)
        return self.flown[-steps] if len(self.flown) >= steps else (self.x, self.v)

    def farthest_of_a_hold(self) -> float:
        """How far it comes when it is told to hold now: its setpoint slows down with a jerk of
        HOLD_M_S3 to HOLD_M_S2, and it follows by its loops."""
        craft = replace(self, flown=[])
        x, v, a, farthest_m = self.x, self.v, 0.0, self.x
        for _ in range(round(10.0 / STEP_S)):
            most = min(HOLD_M_S2, math.sqrt(2.0 * HOLD_M_S3 * abs(v)))
            wanted = -math.copysign(most, v) if v != 0.0 else 0.0
            a += max(-HOLD_M_S3 * STEP_S, min(HOLD_M_S3 * STEP_S, wanted - a))
            v = 0.0 if v * (v + a * STEP_S) <= 0.0 else v + a * STEP_S
            a = a if v != 0.0 else 0.0
            x += v * STEP_S
            craft.fly_at(v + POSITION_P * (x - craft.x))
            farthest_m = max(farthest_m, craft.x)
            if v == 0.0 and craft.v < 0.0:
                break
        return farthest_m
