"""Builders: the vehicle's state as messages, one function a message.

A builder answers None while there is nothing true to say (no origin yet, no target).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, TypeAlias

from vehicle_sim.autopilot.geo import projection
from vehicle_sim.autopilot.interface import Geodetic, Landed, Vehicle
from vehicle_sim.autopilot.modes import by_number
from vehicle_sim.numerics.vectors import euler_rad
from vehicle_sim.services.profile import Profile
from vehicle_sim.services.telemetry import sensors
from vehicle_sim.services.telemetry.sys_status import sys_status
from vehicle_sim.services.units import boot_ms, clip_int16, degrees_e7, millimetres, usec
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import MavFrame, PositionIgnore

Builder: TypeAlias = Callable[[Vehicle, Profile], m.Message | None]

INTO_THE_GROUND_M_S2: Final = 100.0
IDLE_THRUST: Final = 0.001
MITIGATE_NONE: Final = 1  # FENCE_MITIGATE
RSSI_UNKNOWN: Final = 255


def heartbeat(vehicle: Vehicle, profile: Profile) -> m.Heartbeat:
    return m.Heartbeat(
        custom_mode=vehicle.custom_mode,
        type=vehicle.mav_type,
        autopilot=profile.autopilot,
        base_mode=vehicle.base_mode,
        system_status=vehicle.system_status,
        mavlink_version=3,
    )


def extended_sys_state(vehicle: Vehicle, profile: Profile) -> m.ExtendedSysState:
    """ArduPilot calls a copter a VTOL that flies as a multicopter."""
    return m.ExtendedSysState(vtol_state=profile.vtol_state, landed_state=vehicle.landed)


def attitude(vehicle: Vehicle, profile: Profile) -> m.Attitude:
    estimate = vehicle.estimate
    return m.Attitude(boot_ms(vehicle), *euler_rad(estimate.q_ned_from_frd), *estimate.rates_frd)


def attitude_quaternion(vehicle: Vehicle, profile: Profile) -> m.AttitudeQuaternion:
    estimate = vehicle.estimate
    return m.AttitudeQuaternion(boot_ms(vehicle), *estimate.q_ned_from_frd, *estimate.rates_frd)


def local_position_ned(vehicle: Vehicle, profile: Profile) -> m.LocalPositionNed | None:
    if vehicle.origin is None:
        return None
    estimate = vehicle.estimate
    return m.LocalPositionNed(boot_ms(vehicle), *estimate.pos_ned, *estimate.v_ned)


def global_position_int(vehicle: Vehicle, profile: Profile) -> m.GlobalPositionInt | None:
    if vehicle.origin is None:
        return None
    estimate = vehicle.estimate
    north, east, down = estimate.v_ned
    return m.GlobalPositionInt(
        time_boot_ms=boot_ms(vehicle),
        lat=degrees_e7(estimate.lat_deg),
        lon=degrees_e7(estimate.lon_deg),
        alt=millimetres(estimate.alt_amsl_m),
        relative_alt=millimetres(estimate.alt_rel_m),
        vx=clip_int16(north * 100.0),
        vy=clip_int16(east * 100.0),
        vz=clip_int16(down * 100.0),
        hdg=round(math.degrees(estimate.heading_rad) * 100.0) % 36000,
    )


def gps_global_origin(vehicle: Vehicle, profile: Profile) -> m.GpsGlobalOrigin | None:
    origin = vehicle.origin
    if origin is None:
        return None
    return m.GpsGlobalOrigin(*_geodetic(origin), time_usec=usec(vehicle))


def _geodetic(where: Geodetic) -> tuple[int, int, int]:
    return (
        degrees_e7(where.lat_deg),
        degrees_e7(where.lon_deg),
        millimetres(where.alt_amsl_m),
    )


def home_position(vehicle: Vehicle, profile: Profile) -> m.HomePosition | None:
    home = vehicle.home
    pos_ned = vehicle.home_pos_ned
    if home is None or pos_ned is None:
        return None
    return m.HomePosition(
        *_geodetic(home),
        *pos_ned,
        q=profile.home_attitude,
        approach_x=0.0,
        approach_y=0.0,
        approach_z=0.0,
        time_usec=usec(vehicle),
    )


def vfr_hud(vehicle: Vehicle, profile: Profile) -> m.VfrHud:
    estimate = vehicle.estimate
    north, east, down = estimate.v_ned
    speed = math.sqrt(north * north + east * east)
    outputs = vehicle.motor_outputs
    return m.VfrHud(
        airspeed=speed,
        groundspeed=speed,
        alt=estimate.alt_amsl_m,
        climb=-down,
        heading=round(math.degrees(estimate.heading_rad)) % 360,
        throttle=round((outputs[0] + outputs[1] + outputs[2] + outputs[3]) * 25.0),
    )


def position_target_local_ned(
    vehicle: Vehicle, profile: Profile
) -> m.PositionTargetLocalNed | None:
    target = vehicle.target
    if profile.targets_while_disarmed and not vehicle.armed:
        return _standing(vehicle)
    ignored = PositionIgnore.ACCELERATION | PositionIgnore.YAW_RATE
    if target.pos_ned is None:
        ignored |= PositionIgnore.POSITION
    if target.v_ned is None:
        ignored |= PositionIgnore.VELOCITY
    if target.yaw_rad is None:
        ignored |= PositionIgnore.YAW
    if target.pos_ned is None and target.v_ned is None:
        return None
    return m.PositionTargetLocalNed(
        boot_ms(vehicle),
        *(target.pos_ned or (0.0, 0.0, 0.0)),
        *(target.v_ned or (0.0, 0.0, 0.0)),
        *(0.0, 0.0, 0.0),
        yaw=target.yaw_rad or 0.0,
        yaw_rate=0.0,
        type_mask=ignored,
        coordinate_frame=1,
    )


def _standing(vehicle: Vehicle) -> m.PositionTargetLocalNed:
    """PX4's controllers run on the ground too, and ask for a push into it, as recorded."""
    return m.PositionTargetLocalNed(
        boot_ms(vehicle),
        *(math.nan,) * 6,
        *(0.0, 0.0, INTO_THE_GROUND_M_S2),
        yaw=math.remainder(vehicle.estimate.heading_rad, 2.0 * math.pi),
        yaw_rate=0.0,
        type_mask=PositionIgnore.POSITION | PositionIgnore.VELOCITY,
        coordinate_frame=MavFrame.LOCAL_NED,
    )


def position_target_global_int(
    vehicle: Vehicle, profile: Profile
) -> m.PositionTargetGlobalInt | None:
    """The same target as a place on earth, heights AMSL; only in modes that fly to a place."""
    origin = vehicle.origin
    local = position_target_local_ned(vehicle, profile)
    if origin is None or local is None or math.isnan(local.x):
        return None
    if not _flies_to_a_place(vehicle, profile):
        return None
    where = projection(profile.name, origin).to_geodetic((local.x, local.y, local.z))
    known = not local.type_mask & PositionIgnore.POSITION
    return m.PositionTargetGlobalInt(
        local.time_boot_ms,
        degrees_e7(where.lat_deg) if known else 0,
        degrees_e7(where.lon_deg) if known else 0,
        where.alt_amsl_m if known else 0.0,
        *local[4:10],
        yaw=local.yaw,
        yaw_rate=local.yaw_rate,
        type_mask=local.type_mask,
        coordinate_frame=MavFrame.GLOBAL_INT,
    )


def _flies_to_a_place(vehicle: Vehicle, profile: Profile) -> bool:
    """As recorded (px4_1_14_flight.tlog, arducopter_4_7_flight.tlog): PX4 in its AUTO modes, not in
    OFFBOARD, POSCTL and ORBIT; ArduCopter in AUTO and RTL, and in GUIDED after the take-off."""
    mode = by_number(profile.name, vehicle.custom_mode)
    if mode is None:
        return False
    if mode.name in profile.flies_to_places:
        return True
    return mode.name in profile.flies_to_places_in_air and vehicle.landed is Landed.IN_AIR


def attitude_target(vehicle: Vehicle, profile: Profile) -> m.AttitudeTarget | None:
    goal = vehicle.attitude_goal
    if goal is None and profile.targets_while_disarmed:
        half_rad = 0.5 * vehicle.estimate.heading_rad
        level = (math.cos(half_rad), 0.0, 0.0, math.sin(half_rad))
        return m.AttitudeTarget(
            boot_ms(vehicle), level, 0.0, 0.0, 0.0, thrust=IDLE_THRUST, type_mask=0
        )
    if goal is None:
        return None
    return m.AttitudeTarget(
        boot_ms(vehicle), goal.q_ned_from_frd, *goal.rates_frd, thrust=goal.thrust, type_mask=0
    )


def orbit_execution_status(vehicle: Vehicle, profile: Profile) -> m.OrbitExecutionStatus | None:
    orbiting, origin = vehicle.orbiting, vehicle.origin
    if orbiting is None or origin is None:
        return None
    where = projection(profile.name, origin).to_geodetic(orbiting.centre_ned)
    return m.OrbitExecutionStatus(
        time_usec=usec(vehicle),
        radius=orbiting.radius_m,
        x=degrees_e7(where.lat_deg),
        y=degrees_e7(where.lon_deg),
        z=where.alt_amsl_m,
        frame=MavFrame.GLOBAL,
    )


def rc_channels(vehicle: Vehicle, profile: Profile) -> m.RcChannels | None:
    """PX4 sends it only while a radio is heard; ArduPilot always.  The signal is unknown: 255."""
    channels = vehicle.channels_us
    count = max((number for number, us in enumerate(channels, start=1) if us), default=0)
    if count == 0 and not profile.channels_without_radio:
        return None
    filled = (us or profile.unused_channel_us for us in channels)
    return m.RcChannels._make((boot_ms(vehicle), *filled, count, RSSI_UNKNOWN))


def rc_channels_raw(vehicle: Vehicle, profile: Profile) -> m.RcChannelsRaw | None:
    """The first eight, from ArduPilot: only peers of MAVLink 1 are sent it (`channels.py`)."""
    if m.RcChannelsRaw in profile.unsent_messages:
        return None
    return m.RcChannelsRaw._make((boot_ms(vehicle), *vehicle.channels_us[:8], 0, RSSI_UNKNOWN))


def manual_control(vehicle: Vehicle, profile: Profile) -> m.ManualControl | None:
    """PX4 tells the sticks that it flies by."""
    sticks = vehicle.sticks
    if sticks is None or m.ManualControl in profile.unsent_messages:
        return None
    roll, pitch, yaw, throttle = (round(1000.0 * part) for part in sticks)
    return m.ManualControl(x=pitch, y=roll, z=throttle, r=yaw, buttons=0, target=0)


def fence_status(vehicle: Vehicle, profile: Profile) -> m.FenceStatus | None:
    """ArduPilot's alone, and only while its fence is on."""
    fence = vehicle.fence_state
    if m.FenceStatus in profile.unsent_messages or not fence.present:
        return None
    return m.FenceStatus(
        breach_time=fence.breach_ns // 1_000_000 & 0xFFFFFFFF,
        breach_count=fence.count,
        breach_status=int(fence.breached),
        breach_type=fence.breach_type,
        breach_mitigation=MITIGATE_NONE,
    )


STATE: Final[dict[int, Builder]] = {
    m.IDS[kind]: builder
    for kind, builder in (
        (m.Heartbeat, heartbeat),
        (m.SysStatus, sys_status),
        (m.ExtendedSysState, extended_sys_state),
        (m.Attitude, attitude),
        (m.AttitudeQuaternion, attitude_quaternion),
        (m.LocalPositionNed, local_position_ned),
        (m.GlobalPositionInt, global_position_int),
        (m.GpsGlobalOrigin, gps_global_origin),
        (m.HomePosition, home_position),
        (m.GpsRawInt, sensors.gps_raw_int),
        (m.FenceStatus, fence_status),
        (m.BatteryStatus, sensors.battery_status),
        (m.VfrHud, vfr_hud),
        (m.EstimatorStatus, sensors.estimator_status),
        (m.EkfStatusReport, sensors.ekf_status_report),
        (m.ServoOutputRaw, sensors.servo_output_raw),
        (m.HighresImu, sensors.highres_imu),
        (m.ScaledImu, sensors.scaled_imu),
        (m.RawImu, sensors.raw_imu),
        (m.ScaledPressure, sensors.scaled_pressure),
        (m.PositionTargetLocalNed, position_target_local_ned),
        (m.PositionTargetGlobalInt, position_target_global_int),
        (m.AttitudeTarget, attitude_target),
        (m.OrbitExecutionStatus, orbit_execution_status),
        (m.RcChannels, rc_channels),
        (m.RcChannelsRaw, rc_channels_raw),
        (m.ManualControl, manual_control),
    )
}
