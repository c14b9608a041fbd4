"""`columns(path, name)`: the messages of one kind in a .tlog or .mcap file."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from mcap.records import Channel

from gcs.logfile import tlog
from gcs.logfile.checksums import Index, rows_at
from gcs.logfile.chunks import MESSAGE_BYTES, MESSAGE_HEAD, Chunk, ChunkFile
from gcs.logfile.columns.layout import Records, fill_payload, record_type, records
from gcs.record.reading import MAGIC
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
_NO_OFFSET = np.int64(2**62)


def columns(
    path: str | Path, name: str, *, sysid: int | None = None, compid: int | None = None
) -> Records:
    """Every message `name` of a .tlog or .mcap file, as a structured array in order of time.

    Fields: `time_ns` (ns since 1970, when it was recorded), `frame_seq`, `sysid`, `compid` of the
    frame, then the fields of the message as the dialect names them, in its units, unscaled.  Text
    is bytes without the NULs behind it.  What MAVLink 2 cut off is zero.  In a .tlog frames with a
    wrong checksum are left out, a frame's time is the 8 bytes before it, and the order is that of
    the file; in an .mcap frames that were sent and that were refused count as those received.

    Raises KeyError for a message that the dialect lacks, `BadLogError` (gcs.logfile.errors) for a
    file that is neither, and OSError.
    """
    definition = MESSAGES_BY_NAME[name]
    path = Path(path)
    with open(path, "rb") as file:
        is_mcap = file.read(len(MAGIC)) == MAGIC
    parts = list((from_mcap if is_mcap else from_tlog)(path, definition))
    found = np.concatenate(parts) if parts else np.zeros(0, record_type(definition))
    if sysid is not None:
        found = found[found["sysid"] == sysid]
    if compid is not None:
        found = found[found["compid"] == compid]
    return found


def from_tlog(path: Path, definition: MessageDef) -> Iterator[Records]:
    """An array for each window of the file that has such messages."""
    for data, frames, time_us in tlog.read_message(path, definition.msgid):
        if len(frames):
            yield records(definition, data, frames, time_us)


def from_mcap(path: Path, definition: MessageDef) -> Iterator[Records]:
    """An array for each chunk that has such messages, in order of log time within it."""
    file = ChunkFile(path)

    def has_it(channel: Channel) -> bool:
        return is_frames_of(channel, definition)

    for chunk in file.chunks(has_it):
        parts = [
            frames_as_records(definition, file.channels[number], chunk, offsets)
            for number, offsets in chunk.offsets.items()
            if number in file.channels and has_it(file.channels[number])
        ]
        if len(parts) == 1:
            yield parts[0]
        elif parts:
            both = np.concatenate(parts)
            yield both[np.argsort(both["time_ns"], kind="stable")]


def is_frames_of(channel: Channel, definition: MessageDef) -> bool:
    """Whether the recorder's frames of this message are on a channel."""
    parts = channel.topic.split("/")
    return len(parts) == 5 and parts[:2] == ["", "mavlink"] and parts[4] == definition.name


def frames_as_records(
    definition: MessageDef, channel: Channel, chunk: Chunk, offsets: Index
) -> Records:
    """The recorded frames of one channel in a chunk."""
    recorded = _payload_bytes(channel, definition)
    kind = np.dtype(
        [*MESSAGE_HEAD.descr, *_FRAME, *([("payload", f"V{recorded}")] if recorded else [])]
    )
    inside = (offsets >= 0) & (offsets <= len(chunk.data) - kind.itemsize)
    offsets = offsets[inside]
    rows = rows_at(chunk.data, offsets, kind.itemsize).view(kind).ravel()
    least = MESSAGE_BYTES + FRAME_BYTES + recorded + _TAIL_LENGTH_BYTES
    whole = (rows["opcode"] == 5) & (rows["length"] >= least)
    if not whole.all():
        rows = rows[whole]
    made = np.zeros(len(rows), record_type(definition))
    made["time_ns"] = np.minimum(rows["log_time"], 2**63 - 1).astype(np.int64)
    made["frame_seq"], made["sysid"], made["compid"] = rows["seq"], rows["sysid"], rows["compid"]
    if recorded:
        payload = np.ascontiguousarray(rows["payload"]).view(np.uint8).reshape(len(rows), recorded)
        fill_payload(definition, made, payload[:, : definition.max_len])
    return made


def _payload_bytes(channel: Channel, definition: MessageDef) -> int:
    """What payloads were extended to when they were recorded, perhaps with another dialect."""
    text = channel.metadata.get(PAYLOAD_LENGTH_KEY, "")
    return min(int(text), 255) if text.isdecimal() else definition.max_len
