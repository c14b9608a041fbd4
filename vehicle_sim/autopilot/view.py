"""What the vehicle shows of itself: estimates for everybody, the truth for tests."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from vehicle_sim.autopilot.arming import why_not
from vehicle_sim.autopilot.interface import (
    Estimate,
    Geodetic,
    Landed,
    PlanItem,
    Quat,
    Target,
    Vec3,
)
from vehicle_sim.autopilot.life import Life
from vehicle_sim.autopilot.modes import Flag
from vehicle_sim.autopilot.pilot import heading_of

_FALLING_M_S = 1.0


@dataclass(frozen=True, slots=True)
class Truth:
    """What really is, for tests: NED metres and m/s, body to NED, rad/s."""

    pos_ned: Vec3
    v_ned: Vec3
    q_ned_from_frd: Quat
    rates_frd: Vec3


class View(Life):
    """The read-only half of `Vehicle`."""

    @property
    def truth(self) -> Truth:
        b = self._quad.body
        return Truth(
            (b.pos_n, b.pos_e, b.pos_d),
            (b.vel_n, b.vel_e, b.vel_d),
            (b.qw, b.qx, b.qy, b.qz),
            (b.rate_x, b.rate_y, b.rate_z),
        )

    def state_bytes(self) -> bytes:
        """The body's whole state; equal bytes are an equal flight."""
        return self._quad.state_bytes()

    @property
    def estimate(self) -> Estimate:
        s = self._sense()
        body = self._quad.body
        q = self._sensors.attitude(body)
        where = self._projection.to_geodetic(s.pos_ned)
        home_d = self._home_ned[2] if self._home_ned is not None else 0.0
        heading = heading_of(q)
        return Estimate(
            time_ns=self.time_ns,
            pos_ned=s.pos_ned,
            v_ned=s.v_ned,
            q_ned_from_frd=q,
            rates_frd=self._sensors.gyro(body, self._step),
            accel_frd=self._sensors.accel(body, self._step),
            lat_deg=where.lat_deg,
            lon_deg=where.lon_deg,
            alt_amsl_m=where.alt_amsl_m,
            alt_rel_m=home_d - s.pos_ned[2],
            heading_rad=heading if heading >= 0.0 else heading + 2.0 * pi,
            gps_ok=self._origin is not None,
        )

    @property
    def target(self) -> Target:
        return self._task.target

    @property
    def armed(self) -> bool:
        return self._armed

    @property
    def landed(self) -> Landed:
        if self._pilot.flying:
            return self._task.landed_word
        falling = abs(self._quad.body.vel_d) > _FALLING_M_S
        return Landed.IN_AIR if falling else Landed.ON_GROUND

    @property
    def mode_name(self) -> str:
        return self._mode.name

    @property
    def custom_mode(self) -> int:
        return self._mode.custom_mode

    @property
    def base_mode(self) -> int:
        return self._mode.flags | (Flag.SAFETY_ARMED if self._armed else 0)

    @property
    def system_status(self) -> int:
        if self._terminated:
            return 8  # MAV_STATE_FLIGHT_TERMINATION
        if self._failsafe_active:
            return 5  # CRITICAL
        if not self._position_ok:
            return 1  # BOOT
        flying = self._armed if self.personality == "px4" else self._pilot.flying
        return 4 if flying else 3  # ACTIVE, STANDBY

    @property
    def origin(self) -> Geodetic | None:
        return self._origin

    @property
    def home(self) -> Geodetic | None:
        if self._home_ned is None:
            return None
        return self._projection.to_geodetic(self._home_ned)

    @property
    def home_pos_ned(self) -> Vec3 | None:
        return self._home_ned

    @property
    def armable(self) -> bool:
        return not self._terminated and self._why_not_arm() is None

    @property
    def motor_outputs(self) -> tuple[float, float, float, float]:
        c = self._pilot.control
        return (c.u1, c.u2, c.u3, c.u4)

    @property
    def capturing(self) -> bool:
        return self._camera.exposing

    @property
    def images_captured(self) -> int:
        return self._camera.images

    def _why_not_arm(self) -> str | None:
        if self._mode.name == "OFFBOARD" and not self._stream.alive(self._sense().wall_ns):
            return "Arming denied: no offboard setpoints"
        battery = self._quad.battery.remaining
        return why_not(self.parameters, self._mode, self._position_ok, battery)

    @property
    def plan(self) -> tuple[PlanItem, ...]:
        return self._mission.items

    @property
    def mission_current(self) -> int:
        return self._mission.current

    @property
    def mission_state(self) -> int:
        mission = self._mission
        if mission.empty:
            return 1  # MISSION_STATE_NO_MISSION
        if mission.finished:
            return 5  # COMPLETE
        if not mission.started:
            return 2  # NOT_STARTED
        return 3 if self._task is mission and self._armed else 4  # ACTIVE, PAUSED
