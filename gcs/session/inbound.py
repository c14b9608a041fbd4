"""From a decoded message of the vehicle to the telemetry it changes and what the gate hears of it.

`absorb` is one total match over the messages that mean something here; the others are recorded
and counted, and that is all.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from gcs.gate import inputs
from gcs.gate.airspace.projection import Origin, Projection
from gcs.gate.condition import Condition
from gcs.gate.states import LandedState
from gcs.protocol.autopilot import mode_of
from gcs.record.items import GeodeticItem, PoseItem, RecordItem
from gcs.session.telemetry import Telemetry, quat_from_euler
from gcs.wire import messages as m
from gcs.wire.ids import MavState, ModeFlag

ORIGIN_DISAGREEMENT_M = 2.0
MAX_PAIR_AGE_NS = 100_000_000
CLOCK_STEP_BACK_MS = 1_000

PREARM_CHECK = 0x1000_0000
"""MAV_SYS_STATUS_PREARM_CHECK."""

BATTERY_PCT = (
    (Condition.BATTERY_LOW, 15.0),
    (Condition.BATTERY_CRITICAL, 7.0),
)
"""PX4's BAT_LOW_THR and BAT_CRIT_THR, for a vehicle that tells only a percentage."""

Heard = inputs.Input | RecordItem


def absorb(message: m.Message, seen: Telemetry, now_ns: int) -> Iterator[Heard]:
    """Update `seen`; yield what the gate must hear and what the derived record wants."""
    match message:
        case m.Heartbeat() if message.autopilot == seen.autopilot.mav_autopilot:
            seen.heartbeat_ns = now_ns
            seen.armed = bool(message.base_mode & ModeFlag.SAFETY_ARMED)
            mode = mode_of(seen.autopilot, message.base_mode, message.custom_mode)
            seen.mode_name = mode.name
            yield inputs.HeartbeatSeen(seen.armed, mode.meaning, mode.name)
            failing = message.system_status in (MavState.CRITICAL, MavState.EMERGENCY)
            text = f"the vehicle says {MavState(message.system_status).name}" if failing else ""
            yield inputs.ConditionChanged(Condition.VEHICLE_FAILSAFE_ACTIVE, failing, text)
        case m.ExtendedSysState():
            seen.landed_ns = now_ns
            try:
                seen.landed = LandedState(message.landed_state)
            except ValueError:
                seen.landed = LandedState.UNDEFINED
            yield inputs.LandedSeen(seen.landed)
        case m.LocalPositionNed():
            yield from _local_position(message, seen, now_ns)
        case m.Attitude() if _finite(message.roll, message.pitch, message.yaw):
            seen.yaw_rad = message.yaw
            seen.q_ned_from_frd = quat_from_euler(message.roll, message.pitch, message.yaw)
        case m.GlobalPositionInt():
            yield from _global_position(message, seen, now_ns)
        case m.GpsGlobalOrigin():
            origin = Origin(message.latitude / 1e7, message.longitude / 1e7, message.altitude / 1e3)
            if origin != seen.origin:
                seen.origin = origin
                yield inputs.GeodeticSeen(origin.lat_deg, origin.lon_deg, origin.alt_amsl_m)
                yield from _home_in_local_frame(seen)
        case m.HomePosition():
            home = (message.latitude / 1e7, message.longitude / 1e7, message.altitude / 1e3)
            if home != seen.home:
                seen.home = home
                yield from _home_in_local_frame(seen)
        case m.SysStatus():
            yield from _system_status(message, seen)
        case m.CameraImageCaptured():
            yield inputs.PhotoSeen(message.image_index, message.capture_result == 1)
        case m.CameraFeedback():
            yield inputs.PhotoSeen(message.img_idx, True)
        case m.MissionCurrent():
            seen.mission_seq = message.seq
        case m.MissionItemReached():
            seen.mission_reached = message.seq
        case _:
            pass


def _local_position(message: m.LocalPositionNed, seen: Telemetry, now_ns: int) -> Iterator[Heard]:
    pos_ned = (message.x, message.y, message.z)
    v_ned = (message.vx, message.vy, message.vz)
    if not _finite(*pos_ned, *v_ned):
        # An estimator that reports NaN reports no position; age will tell (invariant 7).
        return
    restarted = False
    if seen.position_ns and message.time_boot_ms <= seen.time_boot_ms:
        if not _restarted(message.time_boot_ms, seen):
            # A duplicate or an overtaken datagram: older than what we have is not fresh.
            return
        restarted = True
        seen.forget_place()
    if _delay_ns(message.time_boot_ms, seen, now_ns) > seen.position_age_ns:
        # It comes so late that it was too old when it arrived; the age will tell.
        return
    seen.restart_ms = None
    seen.time_boot_ms = message.time_boot_ms
    seen.pos_ned, seen.v_ned, seen.position_ns = pos_ned, v_ned, now_ns
    yield inputs.PositionSeen(pos_ned, v_ned, message.time_boot_ms, reset=restarted)
    yield PoseItem(seen.sysid, pos_ned, v_ned, seen.q_ned_from_frd)


def _restarted(time_boot_ms: int, seen: Telemetry) -> bool:
    """Two positions in a row of a clock that went back: one alone may have lost its way."""
    first_ms, seen.restart_ms = seen.restart_ms, time_boot_ms
    far_back = seen.time_boot_ms - time_boot_ms >= CLOCK_STEP_BACK_MS
    if not far_back:
        seen.restart_ms = first_ms
        return False
    return first_ms is not None and 0 < time_boot_ms - first_ms < CLOCK_STEP_BACK_MS


def _delay_ns(time_boot_ms: int, seen: Telemetry, now_ns: int) -> int:
    """How much later than the quickest sample this one came: the link's own queue.

    The quickest is forgotten at 1 ms a second, more than any two clocks drift apart.
    """
    offset_ns = now_ns - time_boot_ms * 1_000_000
    if seen.quickest_ns is None:
        seen.quickest_ns, seen.quickest_at_ns = offset_ns, now_ns
    allowed_ns = seen.quickest_ns + (now_ns - seen.quickest_at_ns) // 1000
    seen.quickest_ns, seen.quickest_at_ns = min(offset_ns, allowed_ns), now_ns
    return offset_ns - seen.quickest_ns


def _system_status(message: m.SysStatus, seen: Telemetry) -> Iterator[Heard]:
    """SYS_STATUS: battery, and whether the vehicle would arm."""
    if message.onboard_control_sensors_present & PREARM_CHECK:
        seen.prearm_ok = bool(message.onboard_control_sensors_health & PREARM_CHECK)
    if message.voltage_battery not in (0, 0xFFFF):
        seen.battery_v = message.voltage_battery / 1e3
    if message.battery_remaining < 0:
        return
    left_pct = seen.battery_pct = float(message.battery_remaining)
    text = f"{left_pct:.0f} % are left"
    for condition, limit_pct in BATTERY_PCT:
        yield inputs.ConditionChanged(condition, left_pct <= limit_pct, text)


def _finite(*values: float) -> bool:
    return all(map(math.isfinite, values))


def _global_position(message: m.GlobalPositionInt, seen: Telemetry, now_ns: int) -> Iterator[Heard]:
    seen.global_ns = now_ns
    seen.lat_deg, seen.lon_deg = message.lat / 1e7, message.lon / 1e7
    seen.alt_amsl_m, seen.alt_rel_m = message.alt / 1e3, message.relative_alt / 1e3
    yield GeodeticItem(seen.sysid, seen.lat_deg, seen.lon_deg, seen.alt_amsl_m, seen.alt_rel_m)
    if seen.origin is None or seen.pos_ned is None:
        return
    if now_ns - seen.position_ns > MAX_PAIR_AGE_NS:
        return
    away_m = _pair_disagreement_m(seen, seen.origin, seen.lat_deg, seen.lon_deg)
    yield inputs.ConditionChanged(
        Condition.ORIGIN_MISMATCH,
        away_m > ORIGIN_DISAGREEMENT_M,
        f"local and global position disagree by {away_m:.1f} m",
    )


def _pair_disagreement_m(seen: Telemetry, origin: Origin, lat_deg: float, lon_deg: float) -> float:
    """Horizontal distance between LOCAL_POSITION_NED and GLOBAL_POSITION_INT by the origin."""
    assert seen.pos_ned is not None
    north_m, east_m = Projection(origin, seen.autopilot.name).north_east(lat_deg, lon_deg)
    return math.hypot(north_m - seen.pos_ned[0], east_m - seen.pos_ned[1])


def _home_in_local_frame(seen: Telemetry) -> Iterator[Heard]:
    """Local and global meet at the origin; HOME_POSITION's own x, y, z are not to be trusted."""
    if seen.origin is None or seen.home is None:
        return
    seen.home_ned = Projection(seen.origin, seen.autopilot.name).ned_from_geodetic(*seen.home)
    yield inputs.HomeSeen(seen.home_ned)
