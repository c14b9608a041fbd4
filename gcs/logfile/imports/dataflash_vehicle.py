"""What the messages of an ArduPilot dataflash log tell of the vehicle."""

from __future__ import annotations

from collections.abc import Iterator
from math import radians
from typing import Any

from gcs.gate.states import LandedState
from gcs.logfile.imports.told import Told
from gcs.logfile.imports.vehicle import ReportedVehicle
from gcs.protocol.autopilot import ARDUPILOT, ARDUPILOT_OTHER
from gcs.report import LogEvent
from gcs.wire.ids import ModeFlag

INFO = 2
"""LogEvent.level of a text, which has no severity in such a log."""
_EVENT_ARMED, _EVENT_DISARMED = 10, 11
_EVENT_AUTO_ARMED, _EVENT_LANDED, _EVENT_NOT_LANDED = 15, 18, 28
"""EV.Id (LogEvent of ArduPilot's AP_Logger.h).  A log that begins when the vehicle is armed
(LOG_DISARMED 0) has no event of that, and the next ones imply it."""


def told(system_id: int, *, is_copter: bool) -> list[Told]:
    """What the messages of ArduCopter's log tell of the vehicle (AP_Logger's LogStructure.h).

    One position of the estimator (the first core), else POS, else GPS.
    """
    vehicle = ReportedVehicle(system_id)
    autopilot = ARDUPILOT if is_copter else ARDUPILOT_OTHER
    state = {"mode": 0, "armed": 0}

    def heartbeat() -> None:
        flags = ModeFlag.CUSTOM_MODE_ENABLED | (ModeFlag.SAFETY_ARMED if state["armed"] else 0)
        vehicle.heartbeat(autopilot, flags, state["mode"])

    def mode(row: Any, now_ns: int) -> Iterator[Any]:
        state["mode"] = int(row[0])
        heartbeat()
        return iter(())

    def armed(row: Any, now_ns: int) -> Iterator[Any]:
        state["armed"] = int(row[0])
        heartbeat()
        return iter(())

    def event(row: Any, now_ns: int) -> Iterator[Any]:
        event_id = int(row[0])
        if event_id in (_EVENT_LANDED, _EVENT_NOT_LANDED):
            in_air = event_id == _EVENT_NOT_LANDED
            vehicle.landed = LandedState.IN_AIR if in_air else LandedState.ON_GROUND
        if event_id in (_EVENT_ARMED, _EVENT_AUTO_ARMED, _EVENT_NOT_LANDED, _EVENT_DISARMED):
            return armed((event_id != _EVENT_DISARMED,), now_ns)
        return iter(())

    def attitude(row: Any, now_ns: int) -> Iterator[Any]:
        vehicle.attitude(*map(radians, row))
        return iter(())

    def battery(row: Any, now_ns: int) -> Iterator[Any]:
        vehicle.battery(row[0], None if len(row) < 2 else float(row[1]))
        return iter(())

    def local(row: Any, now_ns: int) -> Iterator[Any]:
        return vehicle.local_position(tuple(row[:3]), tuple(row[3:]), now_ns)

    def fixed(row: Any, now_ns: int) -> Iterator[Any]:
        height_m = row[3] if len(row) > 3 else 0.0
        return vehicle.global_position((*row[:3], height_m), (0.0, 0.0, 0.0), now_ns)

    def parameter(row: Any, now_ns: int) -> Iterator[Any]:
        return vehicle.parameter(row[0].decode("latin1"), row[1], 0)

    def text(row: Any, now_ns: int) -> Iterator[Any]:
        said = row[0].decode("utf-8", "replace")
        return iter((LogEvent(now_ns, INFO, "vehicle", said),) if said else ())

    core = ("PN", "PE", "PD", "VN", "VE", "VD")
    above_home, above_sea = ("Lat", "Lng", "Alt", "RelHomeAlt"), ("Lat", "Lng", "Alt")
    return [
        Told(vehicle, "PARM", ("Name", "Value"), parameter),
        Told(vehicle, "MSG", ("Message",), text),
        Told(vehicle, "MODE", ("ModeNum",), mode),
        Told(vehicle, "ARM", ("ArmState",), armed),
        Told(vehicle, "EV", ("Id",), event),
        Told(vehicle, "ATT", ("Roll", "Pitch", "Yaw"), attitude, often=True),
        Told(vehicle, "BAT", ("Volt", "RemPct"), battery),
        Told(vehicle, "BAT", ("Volt",), battery),
        Told(vehicle, "CURR", ("Volt",), battery),
        Told(vehicle, "XKF1", core, local, often=True, only=("C", 0)),
        Told(vehicle, "NKF1", core, local, often=True, only=("C", 0), unless="XKF1"),
        Told(vehicle, "POS", above_home, fixed, often=True),
        Told(vehicle, "POS", above_sea, fixed, often=True),
        Told(vehicle, "GPS", above_sea, fixed, often=True, unless="POS"),
    ]
