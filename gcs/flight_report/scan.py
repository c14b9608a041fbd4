"""One pass over a recorded flight of any format: its messages become what the flight was.

Nothing is kept a message: series are reduced while they come in, lists have a limit, so the memory
does not grow with the length of the record.
"""

from __future__ import annotations

import tomllib
from pathlib import Path

import msgspec

from gcs.flight_report.facts import Build, Decision, Fact, Identity, LogLine, PlanItem, Text
from gcs.flight_report.flight import Fence, Flight, VehicleFlight
from gcs.flight_report.readers.mavlink_samples import version_text
from gcs.flight_report.readers.topics import UNREADABLE, Source, source_of
from gcs.flight_report.vehicle_scan import VehicleScan
from gcs.gate.policy.parse import DEFAULT
from gcs.mcap_file.format import Attachment, Channel, Message, Metadata, Schema
from gcs.mcap_file.reader import Condition, Progress
from gcs.record import fence_topic, ros1
from gcs.report import Direction

_POLICY = "policy.toml"
_MAX_VEHICLES = 250
VEHICLE_NODE = "vehicle"
_SEVERITIES = {5: 2, 4: 3, 3: 4, 2: 6, 1: 7}
"""Level of a log line -> MAV_SEVERITY."""


def scan(path: Path, progress: Progress | None = None) -> Flight:
    """Read the whole record.  Raises BadRecordError and OSError."""
    from gcs.logfile.as_record import open_log

    records = open_log(path, progress)
    scanning = Scan(Flight(path.name, records.condition.size))
    for record in records:
        match record:
            case Message():
                scanning.message(record)
            case Schema():
                scanning.schema(record)
            case Channel():
                scanning.channel(record)
            case Metadata(name=name, metadata=values):
                scanning.flight.metadata[name] = values
            case Attachment(name=name, data=data) if Path(name).name == _POLICY:
                scanning.policy(data)
            case _:
                pass
    return scanning.finish(records.condition)


class Scan:
    """The records of one file, in file order."""

    def __init__(self, flight: Flight) -> None:
        self.flight = flight
        self._schemas: dict[int, bytes] = {}
        self._sources: dict[int, Source] = {}
        self._says_texts = False
        self._fence_channel: int | None = None
        self._vehicles: dict[int, VehicleScan] = {}
        self._last_ns = 0
        self._margins = (0.0, 0.0)

    def schema(self, schema: Schema) -> None:
        self._schemas[schema.id] = schema.data

    def channel(self, channel: Channel) -> None:
        if channel.topic == fence_topic.FENCE_TOPIC:
            self._fence_channel = channel.id
        self._says_texts |= channel.topic.endswith("/STATUSTEXT")
        source = source_of(channel.topic, self._schemas.get(channel.schema_id, b""))
        if source is not None:
            self._sources.setdefault(channel.id, source)

    def policy(self, data: bytes) -> None:
        """The margins of a policy file, and the default policy's where it has none."""
        try:
            found = tomllib.loads(data.decode())
        except (UnicodeDecodeError, tomllib.TOMLDecodeError):
            return
        self._margins = (
            _number(found.get("margin_h_m"), DEFAULT.margin_h_m),
            _number(found.get("margin_v_m"), DEFAULT.margin_v_m),
        )

    def message(self, message: Message) -> None:
        flight, at_ns = self.flight, message.log_time_ns
        if flight.start_ns is None:
            flight.start_ns = self._last_ns = at_ns
        # A record whose times go back is read as it stands; plots need times that rise.
        self._last_ns = max(self._last_ns, at_ns)
        flight.messages += 1
        if message.channel_id == self._fence_channel:
            self._fence(message.data)
            return
        source = self._sources.get(message.channel_id)
        if source is None or (source.heard and not _was_received(message.data)):
            return
        t_s = (self._last_ns - flight.start_ns) / 1e9
        if source.heard:
            self._vehicle(source.vehicle).heard(t_s)
        if source.read is None:
            return
        try:
            facts = source.read(message.data)
        except UNREADABLE:
            flight.damaged += 1
            return
        for fact in facts:
            self._fact(fact, source, t_s)

    def _fact(self, fact: Fact, source: Source, t_s: float) -> None:
        match fact:
            case Decision(vehicle=sysid):
                self._vehicle(sysid).handle(fact, t_s)
            case PlanItem(vehicle=sysid) if source.vehicle == 0 and sysid:
                self._vehicle(sysid).handle(fact, t_s)
            case LogLine(level, node, text):
                # Where there is no STATUSTEXT, the log has what the vehicle said.
                said = node == VEHICLE_NODE and not self._says_texts
                for vehicle in self._vehicles.values():
                    vehicle.handle(Text(_SEVERITIES.get(level, 6), text) if said else fact, t_s)
            case _:
                vehicle = self._vehicle(source.vehicle or min(self._vehicles, default=1))
                if source.autopilot and not vehicle.flight.autopilot:
                    vehicle.handle(Identity(source.autopilot, "vehicle"), t_s)
                vehicle.handle(fact, t_s)

    def finish(self, condition: Condition) -> Flight:
        flight = self.flight
        flight.closed = condition.closed
        flight.damaged += condition.damaged
        flight.unread_bytes = condition.unread_bytes
        if flight.start_ns is not None:
            flight.seconds = (self._last_ns - flight.start_ns) / 1e9
        for sysid, vehicle in self._vehicles.items():
            found = vehicle.finish(flight.seconds)
            if _is_vehicle(found):
                self._name_build(found)
                flight.vehicles[sysid] = found
        if not flight.fence.margin_h_m:
            flight.fence.margin_h_m, flight.fence.margin_v_m = self._margins
        return flight

    def _name_build(self, vehicle: VehicleFlight) -> None:
        """Of a .ulg, which says it about itself."""
        said = self.flight.metadata.get("ulog")
        if said is not None:
            release = said.get("ver_sw_release", "")
            version = version_text(int(release)) if release.isdecimal() else ""
            firmware = f"{version} ({said.get('ver_sw', '')[:8]})".strip()
            vehicle.build = Build(firmware, said.get("ver_hw", ""))

    def _vehicle(self, sysid: int) -> VehicleScan:
        known = self._vehicles.get(sysid)
        if known is None:
            known = VehicleScan(VehicleFlight(sysid))
            if len(self._vehicles) < _MAX_VEHICLES:
                self._vehicles[sysid] = known
        return known

    def _fence(self, data: bytes) -> None:
        try:
            found = fence_topic.read(data)
        except msgspec.MsgspecError:
            self.flight.damaged += 1
            return
        self.flight.fence = Fence(found.zones, found.margin_h_m, found.margin_v_m)


def _is_vehicle(flight: VehicleFlight) -> bool:
    """A ground station has frames of its own in the record, and nothing of these."""
    return bool(flight.kind or flight.track.points or flight.lanes.mode.changes or flight.requests)


def _was_received(data: bytes) -> bool:
    """Not so are a client's frames that call themselves the vehicle's, which are refused, and what
    a bridge answers its clients in the vehicle's name, which is sent."""
    return len(data) < ros1.FRAME_BYTES or data[1] == Direction.RECEIVED


def _number(value: object, default: float) -> float:
    return float(value) if isinstance(value, int | float) else default
