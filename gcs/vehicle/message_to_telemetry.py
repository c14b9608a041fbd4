"""What a decoded message of the vehicle changes in its telemetry, and what the gate hears of it.

`updates` is one total match over the messages that mean something here; the others are recorded
and counted, and that is all.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Final, TypeAlias

from gcs.frames import quat_from_euler
from gcs.gate import inputs
from gcs.gate.airspace.projection import Origin, Projection
from gcs.gate.condition import Condition
from gcs.gate.states import LandedState
from gcs.protocol.autopilot import autopilot_of, mode_of
from gcs.report import GeodeticItem, PoseItem
from gcs.session.effects import Record
from gcs.session.work import GateInput, PlaceFence, condition
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire import messages as m
from gcs.wire.ids import MavState, ModeFlag, Sensor

ORIGIN_DISAGREEMENT_M = 2.0
MAX_PAIR_AGE_NS = 100_000_000

UPDATE_MESSAGES: Final = frozenset(
    {
        m.Heartbeat,
        m.ExtendedSysState,
        m.LocalPositionNed,
        m.Attitude,
        m.GlobalPositionInt,
        m.GpsGlobalOrigin,
        m.HomePosition,
        m.SysStatus,
        m.BatteryStatus,
        m.GpsRawInt,
        m.EstimatorStatus,
        m.EkfStatusReport,
        m.Timesync,
        m.CameraImageCaptured,
        m.CameraFeedback,
        m.MissionCurrent,
        m.MissionItemReached,
    }
)
"""What `updates` has a case for."""

Update: TypeAlias = GateInput | Record | PlaceFence


def updates(message: m.Message, telemetry: Telemetry, now_ns: int) -> Iterator[Update]:
    """Update `telemetry`; yield what the gate must hear and what the record wants of it."""
    match message:
        case m.Heartbeat() if is_its_kind(message, telemetry):
            telemetry.heartbeat_ns = now_ns
            telemetry.armed = bool(message.base_mode & ModeFlag.SAFETY_ARMED)
            mode = mode_of(telemetry.autopilot, message.base_mode, message.custom_mode)
            telemetry.mode_name, telemetry.custom_mode = mode.name, message.custom_mode
            failing = message.system_status in (MavState.CRITICAL, MavState.EMERGENCY)
            yield GateInput(inputs.HeartbeatSeen(telemetry.armed, mode.meaning, mode.name, failing))
            text = f"the vehicle says {MavState(message.system_status).name}" if failing else ""
            yield condition(Condition.VEHICLE_FAILSAFE_ACTIVE, failing, text)
        case m.ExtendedSysState():
            telemetry.landed_ns = now_ns
            try:
                telemetry.landed = LandedState(message.landed_state)
            except ValueError:
                telemetry.landed = LandedState.UNDEFINED
            yield GateInput(inputs.LandedSeen(telemetry.landed))
        case m.LocalPositionNed():
            yield from _local_position(message, telemetry, now_ns)
        case m.Attitude() if _finite(message.roll, message.pitch, message.yaw):
            telemetry.yaw_rad, telemetry.yaw_ns = message.yaw, now_ns
            telemetry.q_ned_from_frd = quat_from_euler(message.roll, message.pitch, message.yaw)
        case m.GlobalPositionInt():
            yield from _global_position(message, telemetry, now_ns)
        case m.GpsGlobalOrigin():
            origin = Origin(message.latitude / 1e7, message.longitude / 1e7, message.altitude / 1e3)
            if origin != telemetry.origin:
                telemetry.origin = origin
                # Home in the local frame moves the fence too; without a home the origin alone does.
                yield from _home_in_local_frame(telemetry) if telemetry.home else (PlaceFence(),)
        case m.HomePosition():
            home = (message.latitude / 1e7, message.longitude / 1e7, message.altitude / 1e3)
            if home != telemetry.home:
                telemetry.home = home
                yield from _home_in_local_frame(telemetry)
        case m.SysStatus():
            telemetry.charge.system_status(message, now_ns)
            yield from _system_status(message, telemetry)
        case m.BatteryStatus():
            telemetry.charge.battery_status(message, now_ns)
        case m.GpsRawInt():
            yield from telemetry.health.gps_raw(message, bool(telemetry.armed), now_ns)
        case m.EstimatorStatus():
            yield from telemetry.health.estimator_status(message, bool(telemetry.armed), now_ns)
        case m.EkfStatusReport():
            yield from telemetry.health.ekf_status(message, bool(telemetry.armed), now_ns)
        case m.Timesync() if message.tc1:
            telemetry.delay.answered(message.ts1, now_ns)
        case m.CameraImageCaptured():
            yield GateInput(inputs.PhotoSeen(message.image_index, message.capture_result == 1))
        case m.CameraFeedback():
            yield GateInput(inputs.PhotoSeen(message.img_idx, True))
        case m.MissionCurrent():
            telemetry.mission_seq = message.seq
        case m.MissionItemReached():
            telemetry.mission_reached = message.seq
        case _:
            pass


def _local_position(
    message: m.LocalPositionNed, telemetry: Telemetry, now_ns: int
) -> Sequence[Update]:
    telemetry.position_came_ns = now_ns
    pos_ned = (message.x, message.y, message.z)
    v_ned = (message.vx, message.vy, message.vz)
    if not _finite(*pos_ned, *v_ned):
        # An estimator that reports NaN reports no position; age will tell (invariant 7).
        return ()
    restarted = False
    if telemetry.position_ns and message.time_boot_ms <= telemetry.time_boot_ms:
        if not telemetry.stamps.ran_back(message.time_boot_ms):
            # A duplicate or an overtaken datagram: older than what we have is not fresh.
            return ()
        restarted = True
        if not telemetry.restart_known:
            telemetry.forget_place()
    late_ns = telemetry.delay.of(message.time_boot_ms, now_ns)
    if late_ns > telemetry.position_age_ns:
        # It comes so late that it was too old when it arrived; the age will tell.
        return ()
    telemetry.time_boot_ms = message.time_boot_ms
    telemetry.stamps.take(message.time_boot_ms)
    telemetry.pos_ned, telemetry.v_ned, telemetry.position_ns = pos_ned, v_ned, now_ns
    told_of_late = now_ns - telemetry.yaw_ns <= telemetry.position_age_ns
    seen = inputs.PositionSeen(
        pos_ned,
        v_ned,
        message.time_boot_ms,
        restarted,
        late_ns / 1e9,
        telemetry.yaw_rad if told_of_late else None,
    )
    return (
        GateInput(seen),
        Record(PoseItem(telemetry.sysid, pos_ned, v_ned, telemetry.q_ned_from_frd)),
    )


def _system_status(message: m.SysStatus, telemetry: Telemetry) -> Iterator[Update]:
    """SYS_STATUS: battery, and whether the vehicle would arm."""
    telemetry.prearm_healthy = bool(message.onboard_control_sensors_health & Sensor.PREARM_CHECK)
    if message.onboard_control_sensors_present & Sensor.PREARM_CHECK:
        telemetry.prearm_ok = telemetry.prearm_healthy
    yield from telemetry.health.system_status(message, bool(telemetry.armed))
    if message.voltage_battery not in (0, 0xFFFF):
        telemetry.battery_v = message.voltage_battery / 1e3
    if message.battery_remaining >= 0:
        telemetry.battery_pct = float(message.battery_remaining)


def is_its_kind(beat: m.Heartbeat, telemetry: Telemetry) -> bool:
    """Whether a heartbeat tells the autopilot and the kind of vehicle that were met."""
    if beat.autopilot != telemetry.mav_autopilot:
        return False
    told, met = autopilot_of(beat.autopilot, beat.type), telemetry.autopilot
    return (told.name, told.commanded) == (met.name, met.commanded)


def _finite(*values: float) -> bool:
    return all(map(math.isfinite, values))


def _global_position(
    message: m.GlobalPositionInt, telemetry: Telemetry, now_ns: int
) -> Iterator[Update]:
    telemetry.global_ns = now_ns
    telemetry.lat_deg, telemetry.lon_deg = message.lat / 1e7, message.lon / 1e7
    telemetry.alt_amsl_m, telemetry.alt_rel_m = message.alt / 1e3, message.relative_alt / 1e3
    yield Record(
        GeodeticItem(
            telemetry.sysid,
            telemetry.lat_deg,
            telemetry.lon_deg,
            telemetry.alt_amsl_m,
            telemetry.alt_rel_m,
        )
    )
    if telemetry.origin is None or telemetry.pos_ned is None:
        return
    if now_ns - telemetry.position_ns > MAX_PAIR_AGE_NS:
        return
    away_m = _pair_disagreement_m(telemetry, telemetry.origin, telemetry.lat_deg, telemetry.lon_deg)
    text = f"local and global position disagree by {away_m:.1f} m"
    yield condition(Condition.ORIGIN_MISMATCH, away_m > ORIGIN_DISAGREEMENT_M, text)


def _pair_disagreement_m(
    telemetry: Telemetry, origin: Origin, lat_deg: float, lon_deg: float
) -> float:
    """Horizontal distance between LOCAL_POSITION_NED and GLOBAL_POSITION_INT by the origin."""
    assert telemetry.pos_ned is not None
    north_m, east_m = Projection(origin, telemetry.autopilot.name).north_east(lat_deg, lon_deg)
    return math.hypot(north_m - telemetry.pos_ned[0], east_m - telemetry.pos_ned[1])


def _home_in_local_frame(telemetry: Telemetry) -> Iterator[GateInput]:
    """Local and global meet at the origin; HOME_POSITION's own x, y, z are not to be trusted."""
    if telemetry.origin is None or telemetry.home is None:
        return
    telemetry.home_ned = Projection(telemetry.origin, telemetry.autopilot.name).ned_from_geodetic(
        *telemetry.home
    )
    yield GateInput(inputs.HomeSeen(telemetry.home_ned))
