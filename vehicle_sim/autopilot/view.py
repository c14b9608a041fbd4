"""What the vehicle shows of itself: estimates for everybody, the truth for tests."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import pi

from vehicle_sim.autopilot.acting_failsafe import ActingFailsafe
from vehicle_sim.autopilot.control.flight_control import heading_of
from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.health.health_checks import HealthChecks
from vehicle_sim.autopilot.interface import (
    AttitudeGoal,
    Estimate,
    Geodetic,
    GpsFix,
    Landed,
    Orbiting,
    Readings,
    Truth,
)
from vehicle_sim.autopilot.mission.mission import Mission
from vehicle_sim.autopilot.modes import Behaviour, Flag
from vehicle_sim.autopilot.tasks.orbit import Orbit
from vehicle_sim.engine.step import Blocks, state_bytes
from vehicle_sim.engine.truth import motion_of
from vehicle_sim.estimation.estimator import booted
from vehicle_sim.numerics.vectors import Vec3

_FALLING_M_S = 1.0
_QUADROTOR = 2  # MAV_TYPE


@dataclass(slots=True, eq=False, repr=False)
class View:
    """Reads, and changes nothing."""

    _state: FlightState
    _blocks: Blocks
    _health_checks: HealthChecks
    _acting: ActingFailsafe
    _mission: Mission
    _shown: Estimate | None = field(default=None, init=False)
    _shown_home: Vec3 | None = field(default=None, init=False)
    _fix: tuple[Vec3, Geodetic] | None = field(default=None, init=False)

    def restart(self) -> None:
        """As after power-up."""
        self._shown = None

    @property
    def truth(self) -> Truth:
        state = self._state
        real = motion_of(self._blocks)
        where = state.projection.to_geodetic(real.pos_ned)
        return Truth(
            time_s=state.time_ns / 1e9,
            pos_ned=real.pos_ned,
            v_ned=real.v_ned,
            q_ned_from_frd=real.q_ned_from_frd,
            rates_frd=real.rates_frd,
            lat_deg=where.lat_deg,
            lon_deg=where.lon_deg,
            alt_amsl_m=where.alt_amsl_m,
            armed=state.armed,
            mode=state.mode.name,
            landed=not state.control.flying and real.touching,
            battery=real.charge,
        )

    def state_bytes(self) -> bytes:
        """The whole numeric state; equal bytes are an equal flight."""
        return state_bytes(self._blocks)

    @property
    def estimate(self) -> Estimate:
        """Made once a step, for all who ask: nothing of it changes in between but home."""
        state = self._state
        time_ns, home_ned = state.time_ns, state.home_ned
        located = state.origin is not None
        shown = self._shown
        if (
            shown is not None
            and shown.time_ns == time_ns
            and shown.gps_ok is located
            and self._shown_home is home_ned
        ):
            return shown
        est, sensed = state.est, state.sensed
        pos_ned = (est.pos_n, est.pos_e, est.pos_d)
        q = state.attitude
        where = state.projection.to_geodetic(pos_ned)
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
        state = self._state
        s = state.sensed
        judged = state.health
        fix_ned = (s.gps_n, s.gps_e, s.gps_d)
        if self._fix is None or self._fix[0] != fix_ned:
            self._fix = fix_ned, state.projection.to_geodetic(fix_ned)
        where = self._fix[1]
        return Readings(
            gyro_frd=(s.gyro_x, s.gyro_y, s.gyro_z),
            accel_frd=(s.accel_x, s.accel_y, s.accel_z),
            mag_frd=(s.mag_x, s.mag_y, s.mag_z),
            pressure_alt_amsl_m=state.ground.alt_amsl_m + s.baro_up_m,
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
        used = self._state.rules.satellites
        return heard if used is None or heard <= 0 else int(self._state.parameters.get(used))

    @property
    def landed(self) -> Landed:
        state = self._state
        if state.control.flying or state.cut_off_in_air:
            return state.task.landed_word
        falling = abs(state.est.vel_d) > _FALLING_M_S
        return Landed.IN_AIR if falling else Landed.ON_GROUND

    @property
    def base_mode(self) -> int:
        state = self._state
        flags = state.mode.flags | (Flag.SAFETY_ARMED if state.armed else 0)
        # As recorded of ArduCopter: until it is initialised it says that it is guided, too.
        return flags if state.boot_stage.initialised else flags | Flag.GUIDED_ENABLED

    @property
    def system_status(self) -> int:
        state = self._state
        if state.terminated:
            return 8  # MAV_STATE_FLIGHT_TERMINATION
        if state.failsafe_active:
            return 6 if self._acting.emergency else 5  # EMERGENCY, CRITICAL
        if not self._initialised:
            return 1  # BOOT
        if state.calibration.busy:
            return 2  # CALIBRATING
        flying = state.armed if state.rules.armed_is_active else state.control.flying
        return 4 if flying else 3  # ACTIVE, STANDBY

    @property
    def _initialised(self) -> bool:
        state = self._state
        real = state.boot_sequence.real
        return state.boot_stage.initialised if real else booted(state.est)

    @property
    def home(self) -> Geodetic | None:
        state = self._state
        if state.home_ned is None:
            return None
        return state.projection.to_geodetic(state.home_ned)

    @property
    def armable(self) -> bool:
        state = self._state
        if state.terminated or state.boot_sequence.holds(state.age_ns):
            return False
        return not self._health_checks.against_arming()

    @property
    def mav_type(self) -> int:
        """That of a quadrotor, unless a parameter says another."""
        name = self._state.rules.mav_type
        return _QUADROTOR if name is None else int(self._state.parameters.get(name))

    @property
    def motor_outputs(self) -> tuple[float, float, float, float]:
        f = self._state.loops
        return (f.u1, f.u2, f.u3, f.u4)

    @property
    def mission_state(self) -> int:
        mission = self._mission
        if mission.empty:
            return 1  # MISSION_STATE_NO_MISSION
        if mission.finished:
            return 5  # COMPLETE
        if not mission.started:
            return 2  # NOT_STARTED
        return 3 if self._state.task is mission and self._state.armed else 4  # ACTIVE, PAUSED

    @property
    def orbiting(self) -> Orbiting | None:
        """What ORBIT_EXECUTION_STATUS tells; PX4's Orbit mode alone does."""
        task = self._state.task
        if isinstance(task, Orbit) and self._state.mode.behaviour is Behaviour.ORBIT:
            return task.status
        return None

    @property
    def attitude_goal(self) -> AttitudeGoal | None:
        f = self._state.loops
        if not f.flying:
            return None
        full_n = 4.0 * self._state.believed.thrust_max_n
        return AttitudeGoal(
            (f.sp_w, f.sp_x, f.sp_y, f.sp_z),
            (f.rate_sp_x, f.rate_sp_y, f.rate_sp_z),
            min(1.0, f.collective_n / full_n),
        )
