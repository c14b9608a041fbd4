"""What the vehicle shows of itself: estimates for everybody, the truth for tests."""

from __future__ import annotations

from math import pi

from vehicle_sim.autopilot.control.flight_control import heading_of
from vehicle_sim.autopilot.decisions import Decisions
from vehicle_sim.autopilot.interface import (
    Estimate,
    Geodetic,
    GpsFix,
    Landed,
    PlanItem,
    Readings,
    Target,
    Truth,
)
from vehicle_sim.autopilot.modes import Flag
from vehicle_sim.engine.step import state_bytes
from vehicle_sim.engine.truth import motion_of
from vehicle_sim.estimation.estimator import booted
from vehicle_sim.numerics.vectors import Vec3

_FALLING_M_S = 1.0
_QUADROTOR = 2  # MAV_TYPE


class View(Decisions):
    """The read-only half of `Vehicle`."""

    _shown: Estimate | None = None
    _shown_home: Vec3 | None = None

    def _restart(self) -> None:
        super()._restart()
        self._shown = None

    @property
    def truth(self) -> Truth:
        real = motion_of(self.blocks)
        where = self._projection.to_geodetic(real.pos_ned)
        return Truth(
            time_s=self.time_ns / 1e9,
            pos_ned=real.pos_ned,
            v_ned=real.v_ned,
            q_ned_from_frd=real.q_ned_from_frd,
            rates_frd=real.rates_frd,
            lat_deg=where.lat_deg,
            lon_deg=where.lon_deg,
            alt_amsl_m=where.alt_amsl_m,
            armed=self._armed,
            mode=self._mode.name,
            landed=not self._pilot.flying and real.touching,
            battery=real.charge,
        )

    def state_bytes(self) -> bytes:
        """The whole numeric state; equal bytes are an equal flight."""
        return state_bytes(self.blocks)

    @property
    def estimate(self) -> Estimate:
        """Made once a step, for all who ask: nothing of it changes in between but home."""
        time_ns, home_ned = self.time_ns, self._home_ned
        located = self._origin is not None
        shown = self._shown
        if (
            shown is not None
            and shown.time_ns == time_ns
            and shown.gps_ok is located
            and self._shown_home is home_ned
        ):
            return shown
        est, sensed = self._est, self._sensed
        pos_ned = (est.pos_n, est.pos_e, est.pos_d)
        q = self._attitude
        where = self._projection.to_geodetic(pos_ned)
        home_d = home_ned[2] if home_ned is not None else 0.0
        heading = heading_of(q)
        self._shown_home = home_ned
        self._shown = shown = Estimate(
            time_ns=time_ns,
            pos_ned=pos_ned,
            v_ned=(est.vel_n, est.vel_e, est.vel_d),
            q_ned_from_frd=q,
            rates_frd=(est.rate_x, est.rate_y, est.rate_z),
            accel_frd=(sensed.accel_x, sensed.accel_y, sensed.accel_z),
            lat_deg=where.lat_deg,
            lon_deg=where.lon_deg,
            alt_amsl_m=where.alt_amsl_m,
            alt_rel_m=home_d - pos_ned[2],
            heading_rad=heading if heading >= 0.0 else heading + 2.0 * pi,
            gps_ok=located,
        )
        return shown

    @property
    def readings(self) -> Readings:
        s = self._sensed
        judged = self.health
        where = self._projection.to_geodetic((s.gps_n, s.gps_e, s.gps_d))
        return Readings(
            gyro_frd=(s.gyro_x, s.gyro_y, s.gyro_z),
            accel_frd=(s.accel_x, s.accel_y, s.accel_z),
            mag_frd=(s.mag_x, s.mag_y, s.mag_z),
            pressure_alt_amsl_m=self._field.alt_amsl_m + s.baro_up_m,
            gps=GpsFix(
                judged.gps_fix,
                self._satellites(judged.satellites),
                where.lat_deg,
                where.lon_deg,
                where.alt_amsl_m,
                (s.gps_vel_n, s.gps_vel_e, s.gps_vel_d),
                judged.eph_m,
                judged.epv_m,
            ),
        )

    def _satellites(self, heard: int) -> int:
        """PX4's simulated receiver says as many as its parameter."""
        by_parameter = self.personality == "px4" and heard > 0
        return int(self.parameters.get("SIM_GPS_USED")) if by_parameter else heard

    @property
    def target(self) -> Target:
        return self._task.target

    @property
    def armed(self) -> bool:
        return self._armed

    @property
    def landed(self) -> Landed:
        if self._pilot.flying or self._cut_off_in_air:
            return self._task.landed_word
        falling = abs(self._est.vel_d) > _FALLING_M_S
        return Landed.IN_AIR if falling else Landed.ON_GROUND

    @property
    def mode_name(self) -> str:
        return self._mode.name

    @property
    def custom_mode(self) -> int:
        return self._mode.custom_mode

    @property
    def base_mode(self) -> int:
        flags = self._mode.flags | (Flag.SAFETY_ARMED if self._armed else 0)
        # As recorded of ArduCopter: until it is initialised it says that it is guided, too.
        return flags if self.boot_stage.initialised else flags | Flag.GUIDED_ENABLED

    @property
    def system_status(self) -> int:
        if self._terminated:
            return 8  # MAV_STATE_FLIGHT_TERMINATION
        if self._failsafe_active:
            return 6 if self.emergency else 5  # EMERGENCY, CRITICAL
        if not self._initialised:
            return 1  # BOOT
        if self._calibration.busy:
            return 2  # CALIBRATING
        flying = self._armed if self.personality == "px4" else self._pilot.flying
        return 4 if flying else 3  # ACTIVE, STANDBY

    @property
    def _initialised(self) -> bool:
        real = self._boot_sequence.real
        return self.boot_stage.initialised if real else booted(self._est)

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
        if self._terminated or self._boot_sequence.holds(self._age_ns):
            return False
        return not self._against_arming()

    @property
    def mav_type(self) -> int:
        """That of a quadrotor, unless PX4's parameter says another."""
        return int(self.parameters.get("MAV_TYPE")) if self.personality == "px4" else _QUADROTOR

    @property
    def motor_outputs(self) -> tuple[float, float, float, float]:
        f = self.blocks.flight
        return (f.u1, f.u2, f.u3, f.u4)

    @property
    def wind_ned(self) -> Vec3 | None:
        return self._airflow.wind_ned

    @property
    def vibration_m_s2(self) -> Vec3:
        return self._airflow.vibration_m_s2

    @property
    def capturing(self) -> bool:
        return self._camera.exposing

    @property
    def images_captured(self) -> int:
        return self._camera.images

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
