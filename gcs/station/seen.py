"""A vehicle as it is seen from outside: what an operator's or a client's words are judged by."""

from __future__ import annotations

from collections.abc import Mapping

from gcs.bridge.translate.meaning import Seen
from gcs.gate.machine.gate import Gate
from gcs.protocol.parameter_names import names_of
from gcs.vehicle.parameters.settings import SPEED, TAKEOFF_HEIGHT
from gcs.vehicle.talk.telemetry import Telemetry

TAKEOFF_UP_M = 2.5
"""PX4's MIS_TAKEOFF_ALT where it is not known."""


def seen_of(
    telemetry: Telemetry, gate: Gate, parameters: Mapping[str, float], max_takeoff_up_m: float
) -> Seen:
    """What a client's words are judged by."""
    memory = gate.memory
    goal = memory.goal or memory.hold
    return Seen(
        autopilot=telemetry.autopilot,
        origin=telemetry.origin,
        home_ned=telemetry.home_ned,
        home_amsl_m=telemetry.home[2] if telemetry.home else None,
        pos_ned=telemetry.pos_ned,
        v_ned=telemetry.v_ned,
        yaw_rad=telemetry.yaw_rad,
        on_ground=memory.on_ground,
        armed=bool(telemetry.armed),
        mode_name=telemetry.mode_name,
        goal_ned=gate.active_goal_ned,
        takeoff_up_m=parameters.get(TAKEOFF_HEIGHT["px4"], TAKEOFF_UP_M),
        state=gate.state,
        awaited=memory.task is not None or bool(memory.outstanding),
        goal_yaw_rad=goal.yaw_rad if goal else None,
        max_takeoff_up_m=max_takeoff_up_m,
        max_speed_m_s=_own_speed_m_s(telemetry, parameters),
    )


def _own_speed_m_s(telemetry: Telemetry, parameters: Mapping[str, float]) -> float:
    """What it flies at by itself, and what missions are verified with; 0 before it is known."""
    newest = SPEED.get(telemetry.autopilot.name)
    for name in names_of(newest) if newest else ():
        if name.name in parameters:
            return parameters[name.name] * name.scale
    return 0.0
