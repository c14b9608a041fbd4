"""What the vehicle makes of its own state: for the failsafes in flight, and before arming."""

from __future__ import annotations

from dataclasses import dataclass
from math import acos, asin, atan2, sqrt

from vehicle_sim.autopilot.control.demands import Situation
from vehicle_sim.autopilot.failsafes.arming import Readiness, reasons
from vehicle_sim.autopilot.failsafes.failsafe_checks import FailsafeChecks, Seen
from vehicle_sim.autopilot.failsafes.failure_detector import FailureDetector, Posture
from vehicle_sim.autopilot.fence.geofence import NOTHING, Crossing, Geofence
from vehicle_sim.autopilot.flight_state import FlightState
from vehicle_sim.autopilot.health.battery_monitor import BatteryMonitor
from vehicle_sim.autopilot.health.mission_checks import MissionChecks
from vehicle_sim.autopilot.interface import AttitudeSetpoint, Power, Result
from vehicle_sim.autopilot.manual.sticks import Radio
from vehicle_sim.autopilot.modes import Behaviour
from vehicle_sim.autopilot.tasks.descend import Descend
from vehicle_sim.autopilot.tasks.guided import SetpointStream
from vehicle_sim.numerics.gravity import GRAVITY_M_S2

_CHECKED_EVERY_NS = 1_000_000_000
_AGAIN_NS = 4_000_000_000
_DISPLAYED_EVERY_NS = 30_000_000_000

_ONLY_TO_ARM = ("Arm: ", "Arming denied: not in mode ")
"""How the words begin that only a request to arm is answered with.

Some of ArduCopter's checks are made only then.  PX4 was recorded to say nothing in
POSCTL.ORBIT to RUN_PREARM_CHECKS (`px4_1_14_flight.tlog`, 64.75 s); what it says there to a request
to arm was not recorded.
"""


@dataclass(eq=False, repr=False)
class HealthChecks:
    """Looks, and decides nothing."""

    _state: FlightState
    _battery: BatteryMonitor
    _geofence: Geofence
    _mission_checks: MissionChecks
    _radio: Radio
    _stream: SetpointStream
    _failsafe_checks: FailsafeChecks
    _failure_detector: FailureDetector

    def __post_init__(self) -> None:
        self.restart()

    def restart(self) -> None:
        """As after power-up."""
        self._checked_ns = self._displayed_ns = self._state.time_ns
        self._was_ready = self._newly_unready = False
        self._log_download = False

    # --------------------------------------------------------------------------- arming

    def against_arming(self) -> tuple[str, ...]:
        """All that speaks against arming now, in the autopilot's words."""
        state = self._state
        s = state.sense()
        est, sensed = state.est, state.sensed
        posture = self.posture()
        has_mission = self._mission_checks.passed
        return reasons(
            state.parameters,
            Readiness(
                mode=state.mode,
                health=state.health,
                power=self._battery.power,
                remaining=self._battery.charge_seen,
                gyro_bias_rad_s=max(
                    abs(est.gyro_bias_x), abs(est.gyro_bias_y), abs(est.gyro_bias_z)
                ),
                accel_off_m_s2=abs(
                    _size(sensed.accel_x, sensed.accel_y, sensed.accel_z) - GRAVITY_M_S2
                ),
                roll_rad=posture.roll_rad,
                pitch_rad=posture.pitch_rad,
                geofence=self._geofence,
                has_mission=has_mission,
                mission_ok=state.mode.behaviour is not Behaviour.MISSION or has_mission,
                setpoints=self._stream.alive(s.wall_ns),
                sticks=self._radio.sticks(s.wall_ns) is not None,
                sticks_lost=self._radio.lost(s.wall_ns),
                station_lost=self._failsafe_checks.station_lost,
                battery_failed=self._failsafe_checks.battery_failed,
                calibration=state.calibration.against_arming,
                needs_terrain=self._mission_checks.needs_terrain,
                log_download=self._log_download,
            ),
        )

    def log_download(self, running: bool) -> None:
        self._log_download = running

    def say_against_arming(self, asked_to_arm: bool) -> bool:
        """Whether there is something, after telling it."""
        against = self.against_arming() if asked_to_arm else self._unready()
        for reason in against:
            # ArduCopter's words begin with what it was asked for.
            head, colon, rest = reason.partition(": ")
            if asked_to_arm and head == "PreArm":
                reason = f"Arm{colon}{rest}"
            self._state.say(2, reason)
        return bool(against)

    def _unready(self) -> tuple[str, ...]:
        """What is against arming at any time, not only when it is asked for."""
        return tuple(why for why in self.against_arming() if not why.startswith(_ONLY_TO_ARM))

    def check_arming(self) -> Result:
        state = self._state
        if state.armed:
            return state.rules.arming_check_armed
        if state.boot_sequence.holds(state.age_ns):
            self._say_boot_reasons("PreArm", forced=False)
        else:
            self.say_against_arming(False)
        return Result.ACCEPTED

    def held_by_boot(self, forced: bool) -> bool:
        """Whether it has not started up far enough to arm, after telling why."""
        boot, age_ns = self._state.boot_sequence, self._state.age_ns
        if not (boot.holds_forced(age_ns) if forced else boot.holds(age_ns)):
            return False
        self._say_boot_reasons("Arm", forced)
        return True

    def _say_boot_reasons(self, checked_for: str, forced: bool) -> None:
        state = self._state
        for reason in state.boot_sequence.reasons(state.age_ns, state.mode, forced):
            state.say(2, f"{checked_for}: {reason}")

    def display_failures(self) -> None:
        """AP_Arming::update, once a second: what is against arming is told when it comes, and every
        30 s."""
        state = self._state
        last_ns, since_shown_ns = self._checked_ns, state.time_ns - self._displayed_ns
        if not state.rules.tells_unready or state.time_ns - last_ns < _CHECKED_EVERY_NS:
            return
        self._checked_ns = state.time_ns
        if since_shown_ns > (_AGAIN_NS if self._newly_unready else _DISPLAYED_EVERY_NS):
            self._newly_unready = False
            self._displayed_ns = state.time_ns
            self.say_against_arming(False)
        ready = not self._unready()
        self._newly_unready = self._newly_unready or (self._was_ready and not ready)
        self._was_ready = ready

    # -------------------------------------------------------------------------- in flight

    def failsafes_nominal(self, s: Situation, crossing: Crossing) -> bool:
        """Whether no failsafe's trigger can have come or gone."""
        lost = self._radio.lost(s.wall_ns)
        return crossing is NOTHING and self._failsafe_checks.nominal(
            s.wall_ns, self._state.sensed, self._state.est, lost
        )

    def see(self, s: Situation, crossing: Crossing) -> Seen:
        state = self._state
        sensed = state.sensed
        power = Power(self._battery.volts, sensed.battery_a, sensed.battery_used_mah, 0)
        return Seen(
            time_ns=s.time_ns,
            wall_ns=s.wall_ns,
            mode=state.mode,
            flying=s.flying,
            needs_position=self._needs_position,
            power=power,
            remaining=self._battery.charge_seen,
            health=state.health,
            sticks=self._radio.sticks(s.wall_ns) is not None,
            sticks_lost=self._radio.lost(s.wall_ns),
            crossing=crossing,
        )

    @property
    def _needs_position(self) -> bool:
        state = self._state
        if isinstance(state.task, Descend):
            return False
        if isinstance(self._stream.setpoint, AttitudeSetpoint):
            return state.mode.behaviour is not Behaviour.GUIDED
        return state.mode.needs_position or state.mode.behaviour is Behaviour.LAND

    @property
    def flight_nominal(self) -> bool:
        state = self._state
        est, f, sensed = state.est, state.loops, state.sensed
        return self._failure_detector.nominal(
            1.0 - 2.0 * (est.qx * est.qx + est.qy * est.qy),
            1.0 - 2.0 * (f.sp_x * f.sp_x + f.sp_y * f.sp_y),
            max(f.u1, f.u2, f.u3, f.u4),
            min(sensed.esc_1, sensed.esc_2, sensed.esc_3, sensed.esc_4),
        )

    def posture(self) -> Posture:
        state = self._state
        est, f, sensed = state.est, state.loops, state.sensed
        w, x, y, z = est.qw, est.qx, est.qy, est.qz
        a, b, c, d = f.sp_w, f.sp_x, f.sp_y, f.sp_z
        up_is = (2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y))
        up_wanted = (2.0 * (b * d + a * c), 2.0 * (c * d - a * b), 1.0 - 2.0 * (b * b + c * c))
        aligned = sum(i * j for i, j in zip(up_is, up_wanted, strict=True))
        return Posture(
            roll_rad=atan2(2.0 * (w * x + y * z), up_is[2]),
            pitch_rad=asin(_cosine(2.0 * (w * y - z * x))),
            off_rad=acos(_cosine(aligned)),
            lean_rad=acos(_cosine(up_wanted[2])),
            accel_m_s2=_size(est.acc_n, est.acc_e, est.acc_d),
            climb_m_s=-est.vel_d,
            asked=(f.u1, f.u2, f.u3, f.u4),
            thrust=(sensed.esc_1, sensed.esc_2, sensed.esc_3, sensed.esc_4),
        )


def _size(x: float, y: float, z: float) -> float:
    return sqrt(x * x + y * y + z * z)


def _cosine(value: float) -> float:
    return min(1.0, max(-1.0, value))
