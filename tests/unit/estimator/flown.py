"""One vehicle that is flown by its estimate, and how far that is from the truth."""

from __future__ import annotations

from dataclasses import dataclass
from math import degrees, hypot

from vehicle_sim.control_loops.flight import AT_VELOCITY, TO
from vehicle_sim.engine.scalar_engine import ScalarEngine
from vehicle_sim.engine.step import Blocks, VehicleSpec
from vehicle_sim.plant.airframe import load
from vehicle_sim.plant.sensors import MEMS, SensorGrade

STEPS_A_SECOND = 250


@dataclass
class Worst:
    """The largest errors of a stretch of flight: degrees, metres, metres a second."""

    tilt_deg: float = 0.0
    yaw_deg: float = 0.0
    pos_m: float = 0.0
    vel_m_s: float = 0.0
    height_m: float = 0.0
    climb_m_s: float = 0.0
    true_tilt_deg: float = 0.0  # how far it really leaned

    def see(self, blocks: Blocks) -> None:
        body, est = blocks.body, blocks.est
        tilt_deg, yaw_deg = attitude_error_deg(blocks)
        lean = 2.0 * hypot(body.qx, body.qy)
        for name, value in (
            ("tilt_deg", tilt_deg),
            ("yaw_deg", abs(yaw_deg)),
            ("pos_m", hypot(est.pos_n - body.pos_n, est.pos_e - body.pos_e)),
            ("vel_m_s", hypot(est.vel_n - body.vel_n, est.vel_e - body.vel_e)),
            ("height_m", abs(est.pos_d - body.pos_d)),
            ("climb_m_s", abs(est.vel_d - body.vel_d)),
            ("true_tilt_deg", degrees(lean)),
        ):
            setattr(self, name, max(getattr(self, name), value))


def attitude_error_deg(blocks: Blocks) -> tuple[float, float]:
    """The small turn from the true to the estimated attitude, in NED: horizontal, and down."""
    b, e = blocks.body, blocks.est
    w = e.qw * b.qw + e.qx * b.qx + e.qy * b.qy + e.qz * b.qz
    n = -e.qw * b.qx + e.qx * b.qw - e.qy * b.qz + e.qz * b.qy
    east = -e.qw * b.qy + e.qy * b.qw - e.qz * b.qx + e.qx * b.qz
    d = -e.qw * b.qz + e.qz * b.qw - e.qx * b.qy + e.qy * b.qx
    twice = 2.0 if w > 0.0 else -2.0
    return abs(degrees(twice * hypot(n, east))), degrees(twice * d)


class Flown:
    """A vehicle of airframe `airframe`, on the ground until `lift_off`."""

    def __init__(self, seed: int = 1, airframe: str = "s500", grade: SensorGrade = MEMS) -> None:
        self.engine = ScalarEngine([VehicleSpec(seed, 0, 47.4)], load(airframe), grade)
        self.blocks = self.engine.blocks(0)
        self.body = self.blocks.body
        self.sensed = self.blocks.sensed
        self.est = self.blocks.est
        self.flight = self.blocks.flight

    def fly(self, seconds: float) -> Worst:
        """Let time pass; the largest errors meanwhile."""
        worst = Worst()
        for _ in range(round(seconds * STEPS_A_SECOND)):
            self.engine.step()
            worst.see(self.blocks)
        return worst

    def lift_off(self, up_m: float = 20.0) -> None:
        """Boots, takes off and hovers; ends at `up_m`, at rest."""
        self.fly(1.5)
        est, flight = self.est, self.flight
        flight.flying = True
        flight.ref_n, flight.ref_e, flight.ref_d = est.pos_n, est.pos_e, est.pos_d
        self.go(0.0, 0.0, up_m)
        self.fly(6.0 + up_m / flight.climb_m_s)

    def go(self, north_m: float, east_m: float, up_m: float, speed_m_s: float = 5.0) -> None:
        """Demand a position."""
        flight = self.flight
        flight.horizontal = flight.vertical = TO
        flight.goal_n, flight.goal_e, flight.goal_d = north_m, east_m, -up_m
        flight.goal_vel_n = flight.goal_vel_e = flight.goal_vel_d = 0.0
        flight.speed_m_s = speed_m_s

    def go_at(self, north_m_s: float, east_m_s: float, down_m_s: float = 0.0) -> None:
        """Demand a velocity."""
        flight = self.flight
        flight.horizontal = flight.vertical = AT_VELOCITY
        flight.goal_vel_n, flight.goal_vel_e, flight.goal_vel_d = north_m_s, east_m_s, down_m_s
        flight.speed_m_s = 15.0
        flight.accel_m_s2 = 6.0

    def turn(self, left_rad: float) -> None:
        """Demand a turn of the nose, positive to the right."""
        self.flight.yaw_left_rad = left_rad
