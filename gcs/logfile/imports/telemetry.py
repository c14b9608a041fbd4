"""The frames of a log as the items that a session would report of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import numpy as np

from gcs.logfile.columns.layout import Records, records
from gcs.logfile.frames import Frames
from gcs.logfile.imports.vehicle import ReportedVehicle
from gcs.mcap_file.batch_writer import Times
from gcs.mcap_file.chunk_reader import Bytes, Index
from gcs.protocol.autopilot import autopilot_of
from gcs.report import RecordItem
from gcs.wire.dialect import MESSAGES, MESSAGES_BY_NAME
from gcs.wire.ids import MavAutopilot

_READ: Mapping[str, tuple[str, ...]] = {
    "HEARTBEAT": ("autopilot", "type", "base_mode", "custom_mode"),
    "SYS_STATUS": ("voltage_battery", "battery_remaining"),
    "EXTENDED_SYS_STATE": ("landed_state",),
    "ATTITUDE": ("roll", "pitch", "yaw"),
    "LOCAL_POSITION_NED": ("x", "y", "z", "vx", "vy", "vz"),
    "GLOBAL_POSITION_INT": ("lat", "lon", "alt", "relative_alt", "vx", "vy", "vz"),
    "GPS_GLOBAL_ORIGIN": ("latitude", "longitude", "altitude"),
    "PARAM_VALUE": ("param_id", "param_value", "param_type"),
    "STATUSTEXT": ("severity", "text", "id", "chunk_seq"),
}
"""Messages that tell something of a vehicle, and their fields that do."""
_IDS = {MESSAGES_BY_NAME[name].msgid: name for name in _READ}
_PERIOD_NS: Mapping[str, int] = {
    "ATTITUDE": 80_000_000,
    "LOCAL_POSITION_NED": 80_000_000,
    "GLOBAL_POSITION_INT": 160_000_000,
}
"""Of what comes more often, one a period is looked at for the derived topics: viewers interpolate
between transforms, and every message is on its own topic anyway."""


class Reported(NamedTuple):
    """Something to record at a time."""

    item: RecordItem
    log_ns: int


class Telemetry:
    """All vehicles of one log, window by window."""

    def __init__(self) -> None:
        self._vehicles: dict[int, ReportedVehicle] = {}
        self._autopilots: dict[int, int] = {}
        """Of each vehicle the component that is its autopilot."""
        self._links: dict[int, _Link] = {}

    def of(self, data: Bytes, frames: Frames, log_ns: Times) -> Iterator[Reported]:
        """What these frames report, in order of time."""
        self._count(data, frames, log_ns)
        for name, (now_ns, sysid, compid, *values) in _in_order(data, frames, log_ns):
            if name == "HEARTBEAT" and not self._is_autopilot(sysid, compid, values[0]):
                continue
            if self._autopilots.get(sysid, compid) != compid:
                continue
            vehicle = self._vehicles.get(sysid)
            if vehicle is None:
                vehicle = self._vehicles[sysid] = ReportedVehicle(sysid)
            for item in _items(vehicle, name, values, now_ns):
                yield Reported(item, now_ns)
            if vehicle.status_is_due(now_ns):
                link = self._links[sysid]
                vehicle.rx_hz, vehicle.lost_pct = link.rate(now_ns), link.lost_pct
                yield Reported(vehicle.status(now_ns), now_ns)

    def _is_autopilot(self, sysid: int, compid: int, mav_autopilot: int) -> bool:
        """Ground stations, cameras and radios have heartbeats too, with no autopilot."""
        if mav_autopilot == MavAutopilot.INVALID:
            return False
        return self._autopilots.setdefault(sysid, compid) == compid

    def _count(self, data: Bytes, frames: Frames, log_ns: Times) -> None:
        seq, sysid, compid = frames.source(data)
        for number in np.unique(sysid).tolist():
            mine = sysid == number
            link = self._links.setdefault(number, _Link())
            link.frames(log_ns[mine], seq[mine], compid[mine])


class _Link:
    """How many frames of a vehicle came, and how many are missing by their numbers."""

    def __init__(self) -> None:
        self._times: Times = np.zeros(0, np.int64)
        self._before = 0
        """Frames before those of `_times`."""
        self._last_seq: dict[int, int] = {}
        self._lost = 0
        self._told = (0, 0)
        """Time and number of frames when the rate was last asked for."""

    def frames(self, log_ns: Times, seq: Bytes, compid: Bytes) -> None:
        self._before += len(self._times)
        self._times = log_ns
        for component in np.unique(compid).tolist():
            mine = seq[compid == component].astype(np.int64)
            first = self._last_seq.get(component, int(mine[0]) - 1)
            missing = (np.diff(mine, prepend=first) - 1) & 0xFF
            # More than half of all numbers missing: it came twice, late, or from a new start.
            self._lost += int(missing[missing < 128].sum())
            self._last_seq[component] = int(mine[-1])

    def rate(self, now_ns: int) -> float:
        """Frames a second since it was asked for the last time."""
        count = self._before + int(np.searchsorted(self._times, now_ns, side="right"))
        then_ns, then = self._told
        self._told = (now_ns, count)
        return (count - then) * 1e9 / (now_ns - then_ns) if then_ns else 0.0

    @property
    def lost_pct(self) -> float:
        received = self._before + len(self._times)
        total = received + self._lost
        return 100.0 * self._lost / total if total else 0.0


def _in_order(data: Bytes, frames: Frames, log_ns: Times) -> Iterator[tuple[str, Any]]:
    """Of the frames that are read here the message's name, and a tuple of time, sysid, compid and
    the fields of `_READ`; `Any` is what numpy makes of a record.
    """
    read = np.flatnonzero(np.isin(frames.msgid, list(_IDS)))
    found: dict[int, tuple[str, Any]] = {}
    for msgid in np.unique(frames.msgid[read]).tolist():
        name = _IDS[msgid]
        places = read[frames.msgid[read] == msgid]
        rows = records(MESSAGES[msgid], data, frames.pick(places), np.zeros(len(places), np.uint64))
        rows["time_ns"] = log_ns[places]
        if name in _PERIOD_NS:
            kept = _not_too_often(rows, _PERIOD_NS[name])
            rows, places = rows[kept], places[kept]
        values = rows[["time_ns", "sysid", "compid", *_READ[name]]].tolist()
        found.update(zip(places.tolist(), ((name, each) for each in values), strict=True))
    return (found[place] for place in sorted(found))


def _not_too_often(rows: Records, period_ns: int) -> Index:
    """The first in each period, of each component."""
    source = rows["sysid"].astype(np.int64) << 8 | rows["compid"]
    order = np.argsort(source, kind="stable")
    period = rows["time_ns"][order] // period_ns
    changes = np.diff(period, prepend=-1) != 0
    changes |= np.diff(source[order], prepend=-1) != 0
    return np.sort(order[changes])


def _items(vehicle: ReportedVehicle, name: str, m: list[Any], now_ns: int) -> Iterator[RecordItem]:
    """`m`: the fields of `_READ`."""
    match name:
        case "ATTITUDE":
            vehicle.attitude(*m)
        case "LOCAL_POSITION_NED":
            yield from vehicle.local_position(tuple(m[:3]), tuple(m[3:]), now_ns)
        case "GLOBAL_POSITION_INT":
            fix = (m[0] / 1e7, m[1] / 1e7, m[2] / 1e3, m[3] / 1e3)
            yield from vehicle.global_position(fix, (m[4] / 1e2, m[5] / 1e2, m[6] / 1e2), now_ns)
        case "HEARTBEAT":
            vehicle.heartbeat(autopilot_of(m[0], m[1]), m[2], m[3])
        case "EXTENDED_SYS_STATE":
            vehicle.landed_state(m[0])
        case "SYS_STATUS":
            volts = None if m[0] in (0, 0xFFFF) else m[0] / 1e3
            vehicle.battery(volts, None if m[1] < 0 else float(m[1]))
        case "GPS_GLOBAL_ORIGIN":
            vehicle.origin(m[0] / 1e7, m[1] / 1e7, m[2] / 1e3)
        case "PARAM_VALUE":
            yield from vehicle.parameter(m[0].decode("utf-8", "replace"), m[1], m[2])
        case "STATUSTEXT":
            text = m[1].decode("utf-8", "replace")
            yield from vehicle.text(m[0], text, m[2], m[3], now_ns)
        case _:
            raise AssertionError(name)
