"""`columns(path, name)`: the messages of one kind in a .tlog or .mcap file."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from pathlib import Path

import numpy as np

from gcs.logfile import tlog
from gcs.logfile.columns.layout import Records, fill_payload, record_type, records
from gcs.mcap_file.chunk_reader import (
    MESSAGE_BYTES,
    MESSAGE_HEAD,
    Bytes,
    Chunk,
    ChunkFile,
    Index,
    rows_at,
)
from gcs.mcap_file.format import MAGIC, Channel, Opcode
from gcs.record.ros1 import FRAME_BYTES, PAYLOAD_LENGTH_KEY
from gcs.wire.dialect import MESSAGES_BY_NAME, MessageDef

_FRAME = [
    ("link", "u1"),
    ("direction", "u1"),
    ("magic", "u1"),
    ("len", "u1"),
    ("flags", "<u2"),
    ("seq", "u1"),
    ("sysid", "u1"),
    ("compid", "u1"),
    ("msgid", "<u4"),
]
"""`mavlink/Frame`, with which every recorded frame begins (`gcs/record/ros1.py`)."""
_TAIL_LENGTH_BYTES = 4


def columns(
    path: str | Path, name: str, *, sysid: int | None = None, compid: int | None = None
) -> Records:
    """Every message `name` of a .tlog or .mcap file, as a structured array in order of time.

    Fields: `time_ns` (ns since 1970, when it was recorded), `frame_seq`, `sysid`, `compid` of the
    frame, then the fields of the message as the dialect names them, in its units, unscaled.  Text
    is bytes without the NULs behind it.  What MAVLink 2 cut off is zero.  In a .tlog frames with a
    wrong checksum are left out, a frame's time is the 8 bytes before it, and the order is that of
    the file; in an .mcap frames that were sent and that were refused count as those received.

    Raises KeyError for a message that the dialect lacks, `BadLogError` (gcs.mcap_file.errors) for a
    file that is neither, and OSError.
    """
    definition = MESSAGES_BY_NAME[name]
    path = Path(path)
    with open(path, "rb") as file:
        is_mcap = file.read(len(MAGIC)) == MAGIC
    parts = [*(_from_mcap if is_mcap else _from_tlog)(path, definition)]
    # Of bytes: numpy compares the fields of records before it puts them together.
    every = np.concatenate([np.zeros(0, np.uint8), *(part.view(np.uint8) for part in parts)])
    found = every.view(record_type(definition))
    if is_mcap and len(parts) > 1:
        found = found[np.argsort(found["time_ns"], kind="stable")]
    if sysid is not None:
        found = found[found["sysid"] == sysid]
    if compid is not None:
        found = found[found["compid"] == compid]
    return found


def _from_tlog(path: Path, definition: MessageDef) -> Iterator[Records]:
    """An array for each window of the file that has such messages."""
    for data, frames, time_us in tlog.read_message(path, definition.msgid):
        if len(frames):
            yield records(definition, data, frames, time_us)


def _from_mcap(path: Path, definition: MessageDef) -> Iterator[Records]:
    """An array for each channel that has such messages."""
    file = ChunkFile(path)
    found: dict[int, list[Bytes]] = {}
    for chunk in file.chunks(lambda channel: is_frames_of(channel, definition)):
        for number, offsets in chunk.offsets.items():
            channel = file.channels.get(number)
            if channel is not None and is_frames_of(channel, definition):
                rows = _rows(chunk, offsets, _recorded_type(channel, definition))
                found.setdefault(number, []).append(rows)
    for number, parts in found.items():
        yield _records_of(definition, file.channels[number], np.concatenate(parts))


def is_frames_of(channel: Channel, definition: MessageDef) -> bool:
    """Whether the recorder's frames of this message are on a channel."""
    parts = channel.topic.split("/")
    return len(parts) == 5 and parts[:2] == ["", "mavlink"] and parts[4] == definition.name


def frames_as_records(
    definition: MessageDef, channel: Channel, chunk: Chunk, offsets: Index
) -> Records:
    """The recorded frames of one channel in a chunk."""
    rows = _rows(chunk, offsets, _recorded_type(channel, definition))
    return _records_of(definition, channel, rows)


def _recorded_type(channel: Channel, definition: MessageDef) -> np.dtype[np.void]:
    return _type_with_payload(_payload_bytes(channel, definition))


@cache
def _type_with_payload(recorded: int) -> np.dtype[np.void]:
    """A Message record up to the end of the payload, which is `recorded` bytes long."""
    payload = [("payload", f"V{recorded}")] if recorded else []
    return np.dtype([*MESSAGE_HEAD.descr, *_FRAME, *payload])


def _rows(chunk: Chunk, offsets: Index, kind: np.dtype[np.void]) -> Bytes:
    inside = (offsets >= 0) & (offsets <= len(chunk.data) - kind.itemsize)
    return rows_at(chunk.data, offsets if inside.all() else offsets[inside], kind.itemsize)


def _records_of(definition: MessageDef, channel: Channel, raw: Bytes) -> Records:
    kind = _recorded_type(channel, definition)
    recorded = kind["payload"].itemsize if "payload" in (kind.names or ()) else 0
    rows = raw.view(kind).ravel()
    least = MESSAGE_BYTES + FRAME_BYTES + recorded + _TAIL_LENGTH_BYTES
    whole = (rows["opcode"] == Opcode.MESSAGE) & (rows["length"] >= least)
    if not whole.all():
        rows, raw = rows[whole], raw[whole]
    made = np.zeros(len(rows), record_type(definition))
    made["time_ns"] = np.minimum(rows["log_time"], 2**63 - 1).astype(np.int64)
    made["frame_seq"], made["sysid"], made["compid"] = rows["seq"], rows["sysid"], rows["compid"]
    fill_payload(definition, made, raw[:, kind.itemsize - recorded :][:, : definition.max_len])
    return made


def _payload_bytes(channel: Channel, definition: MessageDef) -> int:
    """What payloads were extended to when they were recorded, perhaps with another dialect."""
    text = channel.metadata.get(PAYLOAD_LENGTH_KEY, "")
    return min(int(text), 255) if text.isdecimal() else definition.max_len
