"""What the topics of a PX4 flight log tell of the vehicle."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from typing import Any

from gcs.gate.states import LandedState
from gcs.logfile.imports.told import Told
from gcs.logfile.imports.vehicle import ReportedVehicle
from gcs.logfile.onboard.ulog_messages import PARAMETERS, TEXTS
from gcs.protocol.autopilot import PX4
from gcs.report import LogEvent, ParamItem
from gcs.wire.ids import ModeFlag

_ARMED = 2
"""vehicle_status.arming_state (PX4's vehicle_status.msg)."""
_CUSTOM_MODES = {
    0: (1, 0),
    1: (2, 0),
    2: (3, 0),
    3: (4, 4),
    4: (4, 3),
    5: (4, 5),
    10: (5, 0),
    13: (10, 0),
    14: (6, 0),
    15: (7, 0),
    17: (4, 2),
    18: (4, 6),
    19: (4, 8),
    20: (4, 9),
    21: (3, 1),
}
"""vehicle_status.nav_state -> main and sub mode of px4_custom_mode.h (from memory of PX4 1.14)."""
_LEVELS = {7: 1, 6: 2, 5: 2, 4: 3, 3: 4, 2: 4, 1: 4, 0: 5}
"""syslog level -> LogEvent.level."""


def told(system_id: int) -> list[Told]:
    """What PX4's topics tell of the vehicle (fields: PX4's msg folder, 1.14 and before)."""
    vehicle = ReportedVehicle(system_id)

    def local(row: Any, now_ns: int) -> Iterator[Any]:
        return vehicle.local_position(tuple(row[:3]), tuple(row[3:]), now_ns)

    def fixed(row: Any, now_ns: int) -> Iterator[Any]:
        # This topic has no height above home.
        return vehicle.global_position((*row, 0.0), (0.0, 0.0, 0.0), now_ns)

    def attitude(row: Any, now_ns: int) -> Iterator[Any]:
        if all(map(isfinite, row)):
            vehicle.q_ned_from_frd = row
        return iter(())

    def status(row: Any, now_ns: int) -> Iterator[Any]:
        main, sub = _CUSTOM_MODES.get(row[1], (0, 0))
        armed = ModeFlag.SAFETY_ARMED if row[0] == _ARMED else 0
        vehicle.heartbeat(PX4, ModeFlag.CUSTOM_MODE_ENABLED | armed, main << 16 | sub << 24)
        return iter(())

    def landed(row: Any, now_ns: int) -> Iterator[Any]:
        vehicle.landed = LandedState.ON_GROUND if row[0] else LandedState.IN_AIR
        return iter(())

    def battery(row: Any, now_ns: int) -> Iterator[Any]:
        vehicle.battery(row[0], 100.0 * row[1])
        return iter(())

    def text(row: Any, now_ns: int) -> Iterator[Any]:
        said = row[1].decode("utf-8", "replace")
        yield LogEvent(now_ns, _LEVELS.get(row[0], 2), "vehicle", said)

    def parameter(row: Any, now_ns: int) -> Iterator[Any]:
        yield ParamItem(vehicle.sysid, row[0].decode("utf-8", "replace"), row[1])

    q = ("q_0", "q_1", "q_2", "q_3")
    return [
        Told(vehicle, PARAMETERS, ("name", "value"), parameter),
        Told(vehicle, TEXTS, ("level", "text"), text),
        Told(vehicle, "vehicle_status_0", ("arming_state", "nav_state"), status),
        Told(vehicle, "vehicle_land_detected_0", ("landed",), landed),
        Told(vehicle, "battery_status_0", ("voltage_v", "remaining"), battery),
        Told(vehicle, "vehicle_attitude_0", q, attitude, often=True),
        Told(
            vehicle,
            "vehicle_local_position_0",
            ("x", "y", "z", "vx", "vy", "vz"),
            local,
            often=True,
        ),
        Told(vehicle, "vehicle_global_position_0", ("lat", "lon", "alt"), fixed, often=True),
    ]
