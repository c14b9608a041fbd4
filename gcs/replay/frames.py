"""The frames that a vehicle sent, out of a record, ready to be sent again."""

from __future__ import annotations

from array import array
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import IO

from gcs.mcap_file.format import Channel, Message, Record
from gcs.record import ros1
from gcs.report import Direction
from gcs.wire.frame import msgid_in

HEARTBEAT = 0
MAV_TYPE_GCS = 6
_TYPE_BYTE = 4
"""Where `type` is in the payload of a HEARTBEAT."""


@dataclass(slots=True)
class Frames:
    """Times in memory, bytes in a file: a record may be larger than memory is.

    `file` is one that was opened for this and can be read and written.
    """

    file: IO[bytes]
    times_ns: array[int] = field(default_factory=lambda: array("q"))
    left_out: int = 0
    """Frames that the station sent, or another ground station."""
    _starts: array[int] = field(default_factory=lambda: array("q"))
    _size: int = 0

    def add(self, time_ns: int, raw: bytes) -> None:
        self.times_ns.append(time_ns)
        self._starts.append(self._size)
        self._size += len(raw)
        self.file.write(raw)

    def __len__(self) -> int:
        return len(self.times_ns)

    def read(self, number: int) -> bytes:
        """One frame, as it was on the wire."""
        start = self._starts[number]
        end = self._starts[number + 1] if number + 1 < len(self._starts) else self._size
        self.file.seek(start)
        return self.file.read(end - start)


def vehicle_frames(
    records: Iterable[Record],
    file: IO[bytes],
    *,
    sysid: int | None = None,
    from_s: float | None = None,
    to_s: float | None = None,
) -> Frames:
    """Every frame that was received of vehicles, in order; of `sysid` alone if it is given.

    `from_s` and `to_s` count from the first message of the record.  Frames of other ground stations
    on the link are left out: what is played shall look like vehicles.
    """
    frames = Frames(file)
    codecs: dict[int, ros1.Codec] = {}
    stations: set[tuple[int, int]] = set()
    start_ns: int | None = None
    for record in records:
        match record:
            case Channel(id=number, metadata=metadata) if ros1.PAYLOAD_LENGTH_KEY in metadata:
                length = metadata[ros1.PAYLOAD_LENGTH_KEY]
                if length.isdecimal() and len(length) <= 3:
                    codecs[number] = ros1.codec(min(int(length), 255))
            case Message(channel_id=number, log_time_ns=time_ns, data=data):
                if start_ns is None:
                    start_ns = time_ns
                t_s = (time_ns - start_ns) / 1e9
                codec = codecs.get(number)
                if (
                    codec is None
                    or len(data) < ros1.FRAME_BYTES
                    or (to_s is not None and t_s > to_s)
                ):
                    continue
                raw = codec.rebuild(data)
                source = ros1.source_of(raw)
                if _is_station(raw):
                    stations.add(source)
                if data[1] != Direction.RECEIVED or source in stations:
                    frames.left_out += 1
                elif t_s >= (from_s or 0.0) and sysid in (None, source[0]):
                    frames.add(time_ns, raw)
            case _:
                pass
    return frames


def _is_station(raw: bytes) -> bool:
    """A ground station's HEARTBEAT."""
    header = 10 if raw[0] == ros1.MAGIC_V2 else 6
    at = header + _TYPE_BYTE
    return msgid_in(raw) == HEARTBEAT and at < len(raw) and raw[at] == MAV_TYPE_GCS
