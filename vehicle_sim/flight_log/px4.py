"""PX4's flight log: a ULog file with the topics of `px4_topics`."""

from __future__ import annotations

from collections.abc import Callable

from vehicle_sim.flight_log import ulog
from vehicle_sim.flight_log.px4_topics import ROWS, Row
from vehicle_sim.flight_log.snapshot import Head, Parameter, Snapshot, VehicleStatus


class Px4Format:
    """A `Format`: ULog."""

    def __init__(self) -> None:
        self._system = 0

    def head(self, head: Head, now: Snapshot) -> bytes:
        self._system = head.system
        return b"".join(
            (
                ulog.file_header(now.time_us),
                *(row.topic.format() for row in ROWS),
                ulog.information("sys_name", "PX4"),
                ulog.information("ver_hw", "PX4_SITL"),
                ulog.information("ver_sw_release", head.flight_sw_version),
                *(ulog.parameter(p.name, p.value, p.integer) for p in head.parameters),
                *(
                    ulog.default_parameter(p.name, p.default, p.integer)
                    for p in head.parameters
                    if p.default != p.value
                ),
                *(row.topic.subscription() for row in ROWS),
            )
        )

    def sample(self, now: Snapshot, turn: int) -> bytes:
        return self._write(now, lambda row: turn % row.every == 0)

    def change(self, now: Snapshot, before: VehicleStatus) -> bytes:
        return self._write(now, lambda row: row.every > 1)

    def text(self, time_us: int, severity: int, text: str) -> bytes:
        return ulog.logged_text(time_us, severity, text)

    def parameter(self, time_us: int, parameter: Parameter) -> bytes:
        return ulog.parameter(parameter.name, parameter.value, parameter.integer)

    def _write(self, now: Snapshot, wanted: Callable[[Row], bool]) -> bytes:
        rows = ((row, row.values(now, self._system)) for row in ROWS if wanted(row))
        return b"".join(row.topic.data(values) for row, values in rows if values)
