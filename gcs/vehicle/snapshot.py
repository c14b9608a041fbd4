"""What operators' screens are told, ten times a second, from telemetry and the gate."""

from __future__ import annotations

import math

import msgspec

from gcs import ipc
from gcs.frames import enu_from_ned
from gcs.gate.machine.gate import Gate
from gcs.protocol.sequence import SequenceTracker
from gcs.vehicle.talk.telemetry import Telemetry


def snapshot(
    of_station: ipc.Snapshot,
    gate: Gate,
    telemetry: Telemetry | None,
    mission_total: int | None,
    losses: SequenceTracker,
) -> ipc.Snapshot:
    """Everything a panel shows; what is not known is None, never a zero.  `of_station`: what is no
    vehicle's."""
    now_ns, goal_ned = of_station.time_ns, gate.active_goal_ned
    without_vehicle = msgspec.structs.replace(
        of_station,
        state=gate.state.name,
        control=gate.control.name,
        severity=gate.severity.name,
        conditions=[condition.value for condition in gate.conditions],
        active_goal_enu=None if goal_ned is None else enu_from_ned(goal_ned),
        lost_pct=lost_pct(losses),
    )
    if telemetry is None:
        return without_vehicle
    placed = telemetry.pos_ned is not None
    position_age_ns = now_ns - telemetry.position_ns + telemetry.delay.late_ns
    return msgspec.structs.replace(
        without_vehicle,
        vehicle=telemetry.label,
        mode=telemetry.mode_name,
        armed=telemetry.armed,
        landed=telemetry.landed.name,
        pos_enu=enu_from_ned(telemetry.pos_ned) if telemetry.pos_ned else None,
        v_enu=enu_from_ned(telemetry.v_ned) if placed else None,
        yaw_deg=None if telemetry.yaw_rad is None else math.degrees(telemetry.yaw_rad) % 360.0,
        position_age_s=position_age_ns / 1e9 if placed else None,
        home_enu=enu_from_ned(telemetry.home_ned) if telemetry.home_ned else None,
        gps=telemetry.health.gps.words,
        estimator=telemetry.health.estimator.words,
        failsafes=list(telemetry.failsafes),
        mends=list(telemetry.mends),
        battery_pct=telemetry.battery_pct,
        battery_v=telemetry.battery_v,
        heartbeat_age_s=(now_ns - telemetry.heartbeat_ns) / 1e9,
        rx_hz=telemetry.rx_hz,
        setpoint_hz=telemetry.setpoint_hz(now_ns),
        mission_seq=telemetry.mission_seq,
        mission_total=mission_total,
    )


def bridge_row(
    gate: Gate, telemetry: Telemetry, losses: SequenceTracker, now_ns: int
) -> ipc.BridgeVehicle:
    """One vehicle of a bridge, as its page shows it."""
    return ipc.BridgeVehicle(
        vehicle=telemetry.sysid,
        name=telemetry.label,
        state=gate.state.name,
        control=gate.control.name,
        severity=gate.severity.name,
        conditions=[each.value for each in gate.conditions],
        mode=telemetry.mode_name,
        armed=telemetry.armed,
        link=telemetry.link,
        lost_pct=lost_pct(losses),
        silent_s=(now_ns - telemetry.heard_ns) / 1e9,
        pos_enu=None if telemetry.pos_ned is None else enu_from_ned(telemetry.pos_ned),
        v_enu=None if telemetry.v_ned is None else enu_from_ned(telemetry.v_ned),
        battery_pct=telemetry.battery_pct,
    )


def lost_pct(losses: SequenceTracker) -> float:
    """Frames of the vehicle that never came, of all that it sent."""
    total = losses.received + losses.lost
    return 100.0 * losses.lost / total if total else 0.0
