"""Telemetry and messages for the session's tests."""

from __future__ import annotations

from gcs.gate.airspace.projection import Origin
from gcs.protocol.autopilot import PX4, Autopilot
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.messages import Attitude, GlobalPositionInt, LocalPositionNed, SysStatus

SECOND_NS = 1_000_000_000
HOME = Origin(47.397742, 8.545594, 488.0)


def vehicle(autopilot: Autopilot = PX4) -> Telemetry:
    """A vehicle that has only just been heard."""
    return Telemetry(1, 1, autopilot, link=0, mav_autopilot=autopilot.mav_autopilot)


def position(time_boot_ms: int, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> LocalPositionNed:
    return LocalPositionNed(time_boot_ms=time_boot_ms, x=x, y=y, z=z, vx=0.0, vy=0.0, vz=0.0)


def global_position(lat_deg: float, lon_deg: float) -> GlobalPositionInt:
    return GlobalPositionInt(
        time_boot_ms=0,
        lat=round(lat_deg * 1e7),
        lon=round(lon_deg * 1e7),
        alt=488_000,
        relative_alt=0,
        vx=0,
        vy=0,
        vz=0,
        hdg=0,
    )


def attitude(yaw: float) -> Attitude:
    return Attitude(
        time_boot_ms=0, roll=0.0, pitch=0.0, yaw=yaw, rollspeed=0.0, pitchspeed=0.0, yawspeed=0.0
    )


def system_status(battery_pct: int) -> SysStatus:
    return SysStatus(
        onboard_control_sensors_present=0,
        onboard_control_sensors_enabled=0,
        onboard_control_sensors_health=0,
        load=0,
        voltage_battery=16_000,
        current_battery=-1,
        drop_rate_comm=0,
        errors_comm=0,
        errors_count1=0,
        errors_count2=0,
        errors_count3=0,
        errors_count4=0,
        battery_remaining=battery_pct,
    )
