"""SYS_STATUS: which sensors and checks there are, which are in use, and which are well."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from vehicle_sim.autopilot.boot import BootStage
from vehicle_sim.autopilot.interface import FenceState, Vehicle
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.services.profile import Profile
from vehicle_sim.services.units import clip_int16, clip_uint16
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Sensor

_COPTER_PRESENT: Final = (
    Sensor.GYRO_3D
    | Sensor.ACCEL_3D
    | Sensor.MAG_3D
    | Sensor.ABSOLUTE_PRESSURE
    | Sensor.GPS
    | Sensor.ANGULAR_RATE_CONTROL
    | Sensor.ATTITUDE_STABILIZATION
    | Sensor.YAW_POSITION
    | Sensor.Z_ALTITUDE_CONTROL
    | Sensor.XY_POSITION_CONTROL
    | Sensor.MOTOR_OUTPUTS
    | Sensor.AHRS
    | Sensor.BATTERY
    | Sensor.PREARM_CHECK
)


_PX4_PRESENT: Final = (
    Sensor.GYRO_3D
    | Sensor.MAG_3D
    | Sensor.ABSOLUTE_PRESSURE
    | Sensor.GPS
    | Sensor.AHRS
    | Sensor.BATTERY
    | Sensor.PREARM_CHECK
)
_PX4_ENABLED: Final = _PX4_PRESENT | Sensor.RC_RECEIVER
_PX4_HEALTHY: Final = (
    _PX4_PRESENT
    | Sensor.ACCEL_3D
    | Sensor.DIFFERENTIAL_PRESSURE
    | Sensor.MOTOR_OUTPUTS
    | Sensor.OBSTACLE_AVOIDANCE
)
"""As recorded, but for one bit: PX4 1.14 has PREARM_CHECK among what is healthy alone, which
clients that look whether it is present take for a vehicle that does not say if it can be armed.
"""


@dataclass(frozen=True, slots=True)
class _Sensors:
    """SYS_STATUS of a vehicle without a fence, with which nothing is wrong.

    `starting`: it says less before there is a position.
    """

    present: Sensor
    enabled: Sensor
    healthy: Sensor
    starting: bool


_SENSORS: Final[dict[Personality, _Sensors]] = {
    "px4": _Sensors(_PX4_PRESENT, _PX4_ENABLED, _PX4_HEALTHY, starting=True),
    # ArduPilot's fence is healthy where there is none: MAVProxy, which does not look whether it is
    # present, would say "fence breach".
    "ardupilot": _Sensors(
        _COPTER_PRESENT, _COPTER_PRESENT, _COPTER_PRESENT | Sensor.GEOFENCE, starting=False
    ),
}


def _with_fence(fence: FenceState, sensors: _Sensors) -> tuple[Sensor, Sensor, Sensor]:
    """Present, enabled and healthy while nothing is wrong but with the fence."""
    present, enabled, healthy = sensors.present, sensors.enabled, sensors.healthy
    if fence.present:
        present, healthy = present | Sensor.GEOFENCE, healthy | Sensor.GEOFENCE
    if fence.enabled:
        enabled |= Sensor.GEOFENCE
    return present, enabled, healthy & ~Sensor.GEOFENCE if fence.breached else healthy


def _px4_starting(stage: BootStage) -> tuple[Sensor, Sensor, Sensor]:
    """Present, enabled and healthy before there is a position, as recorded."""
    healthy = _PX4_HEALTHY & ~Sensor.PREARM_CHECK
    if not stage.sensors:
        return Sensor(0), Sensor(0), healthy | Sensor.RC_RECEIVER
    return _PX4_PRESENT & ~Sensor.GPS, _PX4_ENABLED & ~Sensor.GPS, healthy


def sys_status(vehicle: Vehicle, profile: Profile) -> m.SysStatus:
    power, health = vehicle.power, vehicle.health
    sensors = _SENSORS[profile.name]
    present, enabled, healthy = _with_fence(vehicle.fence_state, sensors)
    # Clients take the bit of the GPS for "the global position is good".
    if not (health.gps_ok and health.position_ok):
        healthy &= ~Sensor.GPS
    if not health.position_ok:
        healthy &= ~Sensor.XY_POSITION_CONTROL
    if not health.height_ok:
        healthy &= ~Sensor.Z_ALTITUDE_CONTROL
    if not health.attitude_ok:
        healthy &= ~(Sensor.AHRS | Sensor.ATTITUDE_STABILIZATION | Sensor.YAW_POSITION)
    if not health.mag_ok:
        healthy &= ~Sensor.MAG_3D
    if not health.baro_ok:
        healthy &= ~Sensor.ABSOLUTE_PRESSURE
    if not (vehicle.armed or vehicle.armable):  # the latter takes a look at everything
        healthy &= ~Sensor.PREARM_CHECK
    if sensors.starting and not vehicle.boot_stage.position:
        present, enabled, healthy = _px4_starting(vehicle.boot_stage)
    return m.SysStatus(
        onboard_control_sensors_present=present,
        onboard_control_sensors_enabled=enabled,
        onboard_control_sensors_health=healthy,
        load=200,
        voltage_battery=clip_uint16(power.voltage_v * 1000.0),
        current_battery=clip_int16(power.current_a * 100.0),
        drop_rate_comm=0,
        errors_comm=0,
        errors_count1=0,
        errors_count2=0,
        errors_count3=0,
        errors_count4=0,
        battery_remaining=power.remaining_pct,
    )
