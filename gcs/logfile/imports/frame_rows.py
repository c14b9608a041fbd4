"""Frames as the messages that the recorder makes of them (`gcs/record/ros1.py`), many at a time."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from gcs.logfile.frames import Frames
from gcs.mcap_file.batch_writer import BatchWriter, Rows, Times
from gcs.mcap_file.chunk_reader import Bytes, Index, rows_at
from gcs.record import ros1
from gcs.record.writer import MAX_FRAME_CHANNELS
from gcs.wire.frame import HEADER_V2

_TAIL_LENGTH_BYTES = 4


class FrameRows:
    """The channels of frames of one file, as the recorder names them."""

    def __init__(self, writer: BatchWriter) -> None:
        self._writer = writer
        self._channels: dict[int, tuple[int, int]] = {}
        """Of each message of each component the channel, and the payload length in it."""

    def of(self, data: Bytes, frames: Frames, log_ns: Times, publish_ns: Times) -> Iterator[Rows]:
        """Rows of equal length and channel; all of them came over link 0."""
        seq, sysid, compid = frames.source(data)
        heads = _heads(data, frames, seq, sysid, compid)
        source = frames.msgid.astype(np.int64) << 16 | sysid.astype(np.int64) << 8 | compid
        full = np.zeros(len(frames), np.int64)
        channel = np.zeros(len(frames), np.int64)
        kinds, kind = np.unique(source, return_inverse=True)
        for number, key in enumerate(kinds.tolist()):
            mine = kind == number
            channel[mine], full[mine] = self._channel(key)
        known = np.minimum(frames.length, full)
        tail_start = frames.start + frames.header + known
        tail = frames.end - tail_start
        group = channel << 9 | tail
        order = np.argsort(group, kind="stable")
        for part in np.split(order, np.flatnonzero(np.diff(group[order])) + 1):
            if len(part):
                width = int(full[part[0]])
                payload = _payload(data, frames, part, width)
                tails = rows_at(data, tail_start[part], int(tail[part[0]]))
                message = _message(heads[part], payload, tails)
                yield Rows(int(channel[part[0]]), log_ns[part], publish_ns[part], message)

    def _channel(self, key: int) -> tuple[int, int]:
        known = self._channels.get(key)
        if known is None:
            if len(self._channels) >= MAX_FRAME_CHANNELS:
                return self._writer.channel(ros1.crowd_channel()), 0
            msgid, sysid, compid = key >> 16, key >> 8 & 0xFF, key & 0xFF
            number = self._writer.channel(ros1.frame_channel(sysid, compid, msgid))
            known = self._channels[key] = number, ros1.full_length(msgid)
        return known


def _heads(data: Bytes, frames: Frames, seq: Bytes, sysid: Bytes, compid: Bytes) -> Bytes:
    """`mavlink/Frame` of each: link, direction, magic, len, flags, seq, ids, message id."""
    heads = np.zeros((len(frames), ros1.FRAME_BYTES), np.uint8)
    heads[:, 2] = data[frames.start]
    heads[:, 3] = data[frames.start + 1]
    two = frames.header == HEADER_V2
    heads[two, 4] = data[frames.start[two] + 2]
    heads[two, 5] = data[frames.start[two] + 3]
    heads[:, 6], heads[:, 7], heads[:, 8] = seq, sysid, compid
    heads[:, 9:13] = frames.msgid.astype("<u4").view(np.uint8).reshape(-1, 4)
    return heads


def _payload(data: Bytes, frames: Frames, part: Index, width: int) -> Bytes:
    """Payloads of the full length, zero-extended or cut."""
    payload = rows_at(data, frames.start[part] + frames.header[part], width)
    lengths = frames.length[part]
    for length in np.unique(lengths).tolist():
        if length < width:
            payload[lengths == length, length:] = 0
    return payload


def _message(heads: Bytes, payload: Bytes, tails: Bytes) -> Bytes:
    count, tail = tails.shape
    lengths = np.broadcast_to(
        np.frombuffer(tail.to_bytes(_TAIL_LENGTH_BYTES, "little"), np.uint8),
        (count, _TAIL_LENGTH_BYTES),
    )
    return np.concatenate((heads, payload, lengths, tails), axis=1)
