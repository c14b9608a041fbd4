"""Vehicles of one station as another one of them sees them: places in its frame."""

from __future__ import annotations

from collections.abc import Callable

from gcs import ipc
from gcs.frames import Vec3, enu_from_ned
from gcs.gate.airspace.projection import Projection
from gcs.gate.states import State
from gcs.station.vehicles import Vehicles
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.vehicle.vehicle import Vehicle


def into_frame_of(here: Telemetry, there: Telemetry) -> Callable[[Vec3], Vec3] | None:
    """Of a place in the local frame of `there` makes the one in that of `here`; None where one of
    the frames is not known."""
    if here.origin is None or there.origin is None:
        return None
    if (here.origin, here.autopilot.name) == (there.origin, there.autopilot.name):
        return lambda pos_ned: pos_ned
    theirs = Projection(there.origin, there.autopilot.name)
    ours = Projection(here.origin, here.autopilot.name)
    return lambda pos_ned: ours.ned_from_geodetic(*theirs.geodetic_from_ned(pos_ned))


def others_of(vehicles: Vehicles, vehicle: Vehicle | None) -> list[ipc.OtherVehicle]:
    """All vehicles that were met beside this one, or all where it was not met."""
    here = None if vehicle is None else vehicle.telemetry
    return [
        _row(here, other, other.telemetry)
        for other in vehicles
        if other is not vehicle and other.telemetry is not None
    ]


def _row(here: Telemetry | None, other: Vehicle, there: Telemetry) -> ipc.OtherVehicle:
    gate = other.gate
    held = gate.state in (State.HOLDING, State.NO_VEHICLE)
    return ipc.OtherVehicle(
        vehicle=there.sysid,
        state=gate.state.name,
        severity=gate.severity.name,
        conditions=[condition.value for condition in gate.conditions],
        mode=there.mode_name,
        armed=there.armed,
        on_ground=gate.memory.on_ground,
        pos_enu=_place_enu(here, there, there.pos_ned),
        goal_enu=None if held else _place_enu(here, there, gate.active_goal_ned),
        battery_pct=there.battery_pct,
    )


def _place_enu(here: Telemetry | None, there: Telemetry, pos_ned: Vec3 | None) -> Vec3 | None:
    if here is None or pos_ned is None:
        return None
    moved = into_frame_of(here, there)
    return None if moved is None else enu_from_ned(moved(pos_ned))
