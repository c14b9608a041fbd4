"""Whether the vehicle may arm, and when it disarms by itself."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import cos

from vehicle_sim.autopilot.failsafes.failsafe import Charge, by_capacity, by_voltage, charge_of
from vehicle_sim.autopilot.failsafes.px4_failsafes import NO_STATION, violation
from vehicle_sim.autopilot.fence.geofence import BreachKind, Geofence, names
from vehicle_sim.autopilot.interface import Power
from vehicle_sim.autopilot.modes import COPTER_NAMES, Behaviour, Mode, Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters, Quantity
from vehicle_sim.estimation.estimator import Health

# ARMING_CHECK: which checks ArduCopter makes.  1 is all of them.
_ALL = 1
_BARO = 1 << 1
_COMPASS = 1 << 2
_GPS = 1 << 3
_INS = 1 << 4
_PARAMETERS = 1 << 5
_RC = 1 << 6
_VOLTAGE = 1 << 7
_BATTERY = 1 << 8
_LOGGING = 1 << 10
_MISSION = 1 << 14

_BIAS_SHARE = 0.75  # PX4 arms up to this part of the largest bias that its estimator may learn
_GYRO_BIAS_RAD_S = 0.075  # a gyroscope that ArduCopter would not call calibrated
_DEG_PER_RAD = 57.29577951308232
_CALIBRATIONS = {"CAL_ACC0_ID": "Accel", "CAL_GYRO0_ID": "Gyro", "CAL_MAG0_ID": "Compass"}
_ARMS_IN_AUTO = 1  # AUTO_OPTIONS
_QUAD_X = (1.0, 1.0)  # FRAME_CLASS, FRAME_TYPE
_NEEDS_PLACE = BreachKind.CIRCLE | BreachKind.POLYGON


@dataclass(frozen=True, slots=True)
class Readiness:
    """What the checks look at.

    `remaining` is the charge left, 0..1; `accel_off_m_s2` how far the accelerometer at rest is
    from gravity; `mission_ok`: there is one, and it lies within the fence.
    """

    mode: Mode
    health: Health
    power: Power
    remaining: float
    gyro_bias_rad_s: float
    accel_off_m_s2: float
    roll_rad: float
    pitch_rad: float
    geofence: Geofence
    mission_ok: bool
    has_mission: bool  # the same in any mode
    setpoints: bool  # they come at more than 2 Hz
    sticks: bool
    sticks_lost: bool
    station_lost: bool
    battery_failed: bool  # its failsafe has struck since the start
    calibration: tuple[str, ...]  # what ArduCopter's calibrations have against arming
    needs_terrain: bool  # the mission has heights above terrain, of which nothing is known
    log_download: bool  # somebody downloads a flight log


def reasons(parameters: Parameters, ready: Readiness) -> tuple[str, ...]:
    """All that speaks against arming, in the autopilot's own words; none when it may.

    PX4 1.14's health and arming checks; ArduCopter's AP_Arming_Copter, whose ARMING_CHECK was
    turned round into ARMING_SKIPCHK with 4.7.
    """
    return tuple(_REASONS[parameters.personality](parameters, ready))


def _px4(parameters: Parameters, ready: Readiness) -> list[str]:
    get = parameters.get
    health = ready.health
    found: list[str] = []
    if not health.attitude_ok:
        return ["Preflight Fail: ekf2 missing data", "Preflight Fail: no valid position estimate"]
    if not ready.mode.may_arm:
        found.append(f"Arming denied: not in mode {ready.mode.name}")
    for name, sensor in _CALIBRATIONS.items():
        if get(name) == 0:
            found.append(f"Preflight Fail: {sensor} 0 uncalibrated")
    if get("COM_ARM_MIS_REQ") == 1 and not ready.has_mission:
        found.append("Arming denied: no valid mission available")
    if ready.mode.needs_stream and not ready.setpoints:
        found.append("Arming denied: no offboard setpoints")
    if ready.mode.behaviour is Behaviour.MISSION and not ready.mission_ok:
        found.append("Arming denied: no valid mission available")
    if ready.mode.needs_position and not health.position_ok:
        found.append("Preflight Fail: no valid position estimate")
    elif get("COM_ARM_WO_GPS") == 0 and not health.gps_ok:
        found.append("Preflight Fail: GPS fix too low")
    if not health.baro_ok:
        found.append("Preflight Fail: No valid data from Baro 0")
    if not health.mag_ok:
        found.append("Preflight Fail: No valid data from Compass 0")
    if ready.gyro_bias_rad_s > _BIAS_SHARE * get("EKF2_GYR_B_LIM"):
        found.append("Preflight Fail: High Gyro Bias")
    if ready.accel_off_m_s2 > _BIAS_SHARE * get("EKF2_ABL_LIM"):
        found.append("Preflight Fail: High Accelerometer Bias")
    for axis, angle_rad, name in (
        ("roll", ready.roll_rad, "FD_FAIL_R"),
        ("pitch", ready.pitch_rad, "FD_FAIL_P"),
    ):
        if 0.0 < get(name) < abs(angle_rad) * _DEG_PER_RAD:
            found.append(f"Preflight Fail: Attitude failure ({axis})")
    if charge_of(parameters, ready.power, ready.remaining) >= Charge.CRITICAL:
        found.append("Preflight Fail: low battery")
    if ready.geofence.breached and get("GF_ACTION") != 0:
        found.append(violation())
    if ready.station_lost and get("NAV_DLL_ACT") > 0.0:
        found.append(NO_STATION)
    if ready.mode.law is not None and not ready.sticks:
        found.append("Preflight Fail: No manual control input")
    return found


def _copter(parameters: Parameters, ready: Readiness) -> list[str]:
    get = parameters.get
    health = ready.health
    if not health.attitude_ok:
        # Before it has levelled nothing else is worth telling.
        return ["PreArm: AHRS: not healthy", "PreArm: Need Position Estimate"]
    found: list[str] = []
    in_auto = ready.mode.behaviour is Behaviour.MISSION
    barred = in_auto and not int(get("AUTO_OPTIONS")) & _ARMS_IN_AUTO
    if barred or not ready.mode.may_arm:
        name = COPTER_NAMES.get(ready.mode.name, ready.mode.name)
        found.append(f"Arm: {name} mode not armable")
    if (get("FRAME_CLASS"), get("FRAME_TYPE")) != _QUAD_X:
        found.append("PreArm: Motors: Check frame class and type")
    fenced = ready.geofence.limits.kinds & _NEEDS_PLACE
    if (ready.mode.needs_position or fenced) and not health.position_ok:
        # One of the few that ARMING_CHECK cannot turn off.
        found.append("PreArm: Need Position Estimate")
    checks = int(get("ARMING_CHECK"))
    if checks == 0:
        return found

    def asked(check: int) -> bool:
        return bool(checks & (_ALL | check))

    if asked(_BARO) and not health.baro_ok:
        found.append("PreArm: Baro: not healthy")
    if asked(_COMPASS) and not health.mag_ok:
        found.append("PreArm: Compass not healthy")
    if asked(_GPS) and ready.mode.needs_position and not health.gps_ok:
        found.append("PreArm: GPS 1: Bad fix")
    if asked(_INS) and ready.gyro_bias_rad_s > _GYRO_BIAS_RAD_S:
        found.append("PreArm: Gyros not healthy")
    if asked(_INS) and ready.accel_off_m_s2 > get("ARMING_ACCTHRESH"):
        found.append("PreArm: Accels inconsistent")
    upright = cos(ready.roll_rad) * cos(ready.pitch_rad)
    if asked(_INS) and upright < cos(0.01 * get("ANGLE_MAX") / _DEG_PER_RAD):
        found.append("Arm: Leaning")
    if asked(_RC) and ready.sticks_lost and get("FS_THR_ENABLE") != 0:
        found.append("PreArm: Radio failsafe on")
    if ready.station_lost and get("FS_GCS_ENABLE") != 0:
        found.append("PreArm: GCS failsafe on")
    if (asked(_BATTERY) or asked(_VOLTAGE)) and get("BATT_MONITOR") != 0:
        found += [f"PreArm: Battery 1 {why}" for why in _copter_battery(parameters, ready.power)]
        if ready.battery_failed:
            found.append("PreArm: Battery failsafe")
    found += [f"PreArm: {why}" for why in ready.calibration]
    if asked(_PARAMETERS) and ready.needs_terrain:
        found.append("PreArm: waiting for terrain data")  # from memory
    if asked(_LOGGING) and ready.log_download:
        found.append("PreArm: Downloading logs")
    if asked(_MISSION) and not ready.mission_ok:
        found.append("PreArm: Mode requires mission")
    if get("FENCE_ENABLE") != 0:
        wrong = ready.geofence.settings_error()
        if wrong is not None:
            found.append(f"PreArm: {wrong}")
        if ready.geofence.breached:
            found.append(f"PreArm: Vehicle breaching {names(ready.geofence.breached)}")
    return found


def _copter_battery(parameters: Parameters, power: Power) -> list[str]:
    """AP_BattMonitor's arming checks."""
    get = parameters.get
    low = {Charge.LOW: "low", Charge.CRITICAL: "critical"}
    found = [
        f"{low[charge]} {what} failsafe"
        for what, charge in (
            ("voltage", by_voltage(parameters, power)),
            ("capacity", by_capacity(parameters, power)),
        )
        if charge in low
    ]
    if power.voltage_v < get("BATT_ARM_VOLT"):
        found.append("below minimum arming voltage")
    if get("BATT_CAPACITY") - power.consumed_mah < get("BATT_ARM_MAH"):
        found.append("below minimum arming capacity")
    return found


_REASONS: dict[Personality, Callable[[Parameters, Readiness], list[str]]] = {
    "px4": _px4,
    "ardupilot": _copter,
}


class AutoDisarm:
    """Disarms an armed vehicle that has landed, or has never taken off.

    Both clocks run on simulated time; negative and 0 mean never (COM_DISARM_LAND,
    COM_DISARM_PRFLT, DISARM_DELAY).
    `own_landing`: in a mode that lands by itself ArduCopter disarms at once, elsewhere it waits
    DISARM_DELAY; PX4 waits COM_DISARM_LAND after any landing.
    """

    __slots__ = ("_flown", "_since_ns")

    def __init__(self) -> None:
        self._since_ns = 0
        self._flown = False

    def on_ground(self, flown: bool, now_ns: int) -> None:
        """The clock starts: armed just now, or landed just now."""
        self._flown = flown
        self._since_ns = now_ns

    def due(self, parameters: Parameters, own_landing: bool, now_ns: int) -> bool:
        landed = self._flown and (own_landing or parameters.rules.any_landing_disarms)
        limit_s = parameters.si(Quantity.DISARM_LANDED_S if landed else Quantity.DISARM_IDLE_S)
        if limit_s <= 0.0:
            return False
        return now_ns - self._since_ns >= int(limit_s * 1e9)

    def words(self, parameters: Parameters) -> str:
        """The autopilot's STATUSTEXT for it."""
        rules = parameters.rules
        return rules.disarmed_after_landing if self._flown else rules.disarmed_unflown
