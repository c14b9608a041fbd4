"""One vehicle of several behind a bridge, for a program that knows a single one.

What is asked is asked of the chosen vehicle, and a snapshot is of that one: the station's own
snapshots show the first, and `BridgeStatus` once a second all of them, in less detail.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import msgspec

from gcs import ipc
from gcs.operator.client import Polled, Readable, StationEnded, StationEvent, Way


class ChosenVehicle:
    """A `Way` around another one."""

    def __init__(self, connection: Way, sysid: int) -> None:
        self._connection = connection
        self._sysid = sysid
        self._row: ipc.BridgeVehicle | None = None

    def send(self, command: ipc.Command) -> bool:
        """An abort of an operation names its vehicle by that."""
        if isinstance(command, ipc.Ask | ipc.Stream | ipc.Preflight):
            command = msgspec.structs.replace(command, vehicle=self._sysid)
        elif isinstance(command, ipc.Check):
            command = ipc.Check(msgspec.structs.replace(command.asked, vehicle=self._sysid))
        return self._connection.send(command)

    def poll(self, timeout_s: float, also: Sequence[Readable] = ()) -> Polled:
        polled = self._connection.poll(timeout_s, also)
        return Polled([self._seen(event) for event in polled.events], polled.ready)

    def listen(self, on_event: Callable[[StationEvent], None]) -> None:
        """A change of state does not say of which vehicle it is, so snapshots alone tell that."""

        def heard(event: StationEvent) -> None:
            if not isinstance(event, ipc.StateEvent):
                on_event(self._seen(event))

        self._connection.listen(heard)

    def now_s(self) -> float:
        return self._connection.now_s()

    def close(self) -> StationEnded:
        return self._connection.close()

    def _seen(self, event: StationEvent) -> StationEvent:
        if isinstance(event, ipc.BridgeStatus):
            rows = (each for each in event.vehicles if each.vehicle == self._sysid)
            self._row = next(rows, None)
        if isinstance(event, ipc.Snapshot) and not event.vehicle.startswith(f"{self._sysid}/"):
            return snapshot_of(self._row, event)
        return event


def snapshot_of(row: ipc.BridgeVehicle | None, first: ipc.Snapshot) -> ipc.Snapshot:
    """What is known of a vehicle, with what `first` tells of the station; None: not met yet."""
    station = ipc.Snapshot(
        first.time_ns,
        state="NO_VEHICLE",
        control="NONE",
        severity=first.severity,
        conditions=[],
        lost_pct=0.0,
        log_path=first.log_path,
        recording=first.recording,
        recorded_mb=first.recorded_mb,
        vehicles=first.vehicles,
        listening=first.listening,
        in_control=first.in_control,
    )
    if row is None:
        return station
    return msgspec.structs.replace(
        station,
        state=row.state,
        control=row.control,
        severity=row.severity,
        conditions=row.conditions,
        lost_pct=row.lost_pct,
        vehicle=row.name,
        mode=row.mode,
        armed=row.armed,
        pos_enu=row.pos_enu,
        v_enu=row.v_enu,
        battery_pct=row.battery_pct,
        heartbeat_age_s=row.silent_s,
    )
