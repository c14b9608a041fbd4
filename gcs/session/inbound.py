"""From a decoded message of the vehicle to the telemetry it changes and what the gate hears of it.

`absorb` is one total match over the messages that mean something here; the others are recorded
and counted, and that is all.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

from gcs.gate import types as gate
from gcs.gate.projection import Origin, Projection
from gcs.protocol import autopilot
from gcs.record.items import GeodeticItem, PoseItem, RecordItem
from gcs.session.telemetry import Telemetry, quat_from_euler
from gcs.wire import messages as m
from gcs.wire.ids import ModeFlag

ORIGIN_DISAGREEMENT_M = 2.0
MAX_PAIR_AGE_NS = 100_000_000
CLOCK_STEP_BACK_MS = 1_000

Heard = gate.Input | RecordItem


def absorb(message: m.Message, seen: Telemetry, now_ns: int) -> Iterator[Heard]:
    """Update `seen`; yield what the gate must hear and what the derived record wants."""
    match message:
        case m.Heartbeat():
            seen.heartbeat_ns = now_ns
            seen.armed = bool(message.base_mode & ModeFlag.SAFETY_ARMED)
            mode = autopilot.mode_of(seen.personality, message.base_mode, message.custom_mode)
            seen.mode_name = mode.name
            yield gate.HeartbeatSeen(seen.armed, mode.meaning, mode.name)
        case m.ExtendedSysState():
            try:
                seen.landed = gate.LandedState(message.landed_state)
            except ValueError:
                seen.landed = gate.LandedState.UNDEFINED
            yield gate.LandedSeen(seen.landed)
        case m.LocalPositionNed():
            yield from _local_position(message, seen, now_ns)
        case m.Attitude():
            seen.yaw_rad = message.yaw
            seen.q_ned_from_frd = quat_from_euler(message.roll, message.pitch, message.yaw)
        case m.GlobalPositionInt():
            yield from _global_position(message, seen, now_ns)
        case m.GpsGlobalOrigin():
            origin = Origin(message.latitude / 1e7, message.longitude / 1e7, message.altitude / 1e3)
            if origin != seen.origin:
                seen.origin = origin
                yield gate.GeodeticSeen(origin.lat_deg, origin.lon_deg, origin.alt_amsl_m)
                yield from _home_in_local_frame(seen)
        case m.HomePosition():
            home = (message.latitude / 1e7, message.longitude / 1e7, message.altitude / 1e3)
            if home != seen.home:
                seen.home = home
                yield from _home_in_local_frame(seen)
        case m.SysStatus():
            if message.battery_remaining >= 0:
                seen.battery_pct = float(message.battery_remaining)
            if message.voltage_battery not in (0, 0xFFFF):
                seen.battery_v = message.voltage_battery / 1e3
        case m.CameraImageCaptured():
            yield gate.PhotoSeen(message.image_index, message.capture_result == 1)
        case m.CameraFeedback():
            yield gate.PhotoSeen(message.img_idx, True)
        case m.MissionCurrent():
            seen.mission_seq = message.seq
        case m.MissionItemReached():
            seen.mission_reached = message.seq
        case _:
            pass


def _local_position(message: m.LocalPositionNed, seen: Telemetry, now_ns: int) -> Iterator[Heard]:
    pos_ned = (message.x, message.y, message.z)
    v_ned = (message.vx, message.vy, message.vz)
    if not all(map(math.isfinite, (*pos_ned, *v_ned))):
        # An estimator that reports NaN reports no position; age will tell (invariant 7).
        return
    if 0 <= seen.time_boot_ms - message.time_boot_ms < CLOCK_STEP_BACK_MS and seen.position_ns:
        # A duplicate or an overtaken datagram: older than what we have is not fresh.
        return
    restarted = message.time_boot_ms < seen.time_boot_ms
    if restarted:
        seen.origin = None
    seen.time_boot_ms = message.time_boot_ms
    seen.pos_ned, seen.v_ned, seen.position_ns = pos_ned, v_ned, now_ns
    yield gate.PositionSeen(pos_ned, v_ned, message.time_boot_ms, reset=restarted)
    yield PoseItem(seen.sysid, pos_ned, v_ned, seen.q_ned_from_frd)


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
    yield gate.ConditionChanged(
        gate.Condition.ORIGIN_MISMATCH,
        away_m > ORIGIN_DISAGREEMENT_M,
        f"local and global position disagree by {away_m:.1f} m",
    )


def _pair_disagreement_m(seen: Telemetry, origin: Origin, lat_deg: float, lon_deg: float) -> float:
    """Horizontal distance between LOCAL_POSITION_NED and GLOBAL_POSITION_INT by the origin."""
    assert seen.pos_ned is not None
    north_m, east_m = Projection(origin, seen.personality.name).north_east(lat_deg, lon_deg)
    return math.hypot(north_m - seen.pos_ned[0], east_m - seen.pos_ned[1])


def _home_in_local_frame(seen: Telemetry) -> Iterator[Heard]:
    """Local and global meet at the origin; HOME_POSITION's own x, y, z are not to be trusted."""
    if seen.origin is None or seen.home is None:
        return
    seen.home_ned = Projection(seen.origin, seen.personality.name).ned_from_geodetic(*seen.home)
    yield gate.HomeSeen(seen.home_ned)
