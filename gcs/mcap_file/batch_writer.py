"""Writes an MCAP from many messages at a time: rows of numpy arrays, put in place without a loop.

The recorder of a flight (`gcs/record/writer.py`) writes each message as it comes and may be killed
at any time; this one is for files that are made of finished logs.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence
from io import BytesIO
from typing import NamedTuple, Protocol

import lz4.frame  # type: ignore[import-untyped]  # the package has no types
import numpy as np
from mcap import records
from mcap.data_stream import RecordBuilder
from numpy.typing import NDArray

from gcs.mcap_file.chunk_reader import ENTRY, MESSAGE_BYTES, MESSAGE_HEAD, Bytes, Index
from gcs.mcap_file.format import MAGIC, RECORD_HEAD, Opcode
from gcs.mcap_file.writer import Channel

CHUNK_BYTES = 1 << 20
_HEAD_BYTES = MESSAGE_HEAD.itemsize
_INDEX = struct.Struct("<BQHI")

Times = NDArray[np.int64]


class Rows(NamedTuple):
    """Messages of one channel that are equally long."""

    channel: int
    log_ns: Times
    publish_ns: NDArray[np.uint64] | Times
    data: Bytes
    """One message a row."""


class Loose(NamedTuple):
    """One message."""

    channel: int
    log_ns: int
    data: bytes


class Sink(Protocol):
    """What is written to, from its beginning to its end."""

    def write(self, data: bytes, /) -> int: ...


class BatchWriter:
    """One MCAP file, from its first byte to `finish`.  Raises what the sink raises."""

    def __init__(self, file: Sink, library: str = "mavgate") -> None:
        self._file = file
        self._position = 0
        self._last_ns = -1
        self._channels: dict[str, int] = {}
        self._schemas: dict[tuple[str, bytes], int] = {}
        self._new = BytesIO()
        """Schemas and channels that are in no chunk yet."""
        self._known = BytesIO()
        """All of them, for the summary."""
        self._first_ns: int | None = None
        self._counts: dict[int, int] = {}
        self._chunks: list[bytes] = []
        """Their indexes as they are written: a large file has thousands."""
        self._attachments: list[records.AttachmentIndex] = []
        self._metadata: list[records.MetadataIndex] = []
        self._put(MAGIC)
        self._put_record(records.Header("", library))

    @property
    def messages(self) -> int:
        return sum(self._counts.values())

    @property
    def last_ns(self) -> int:
        """Log time of the last message, -1 before the first."""
        return self._last_ns

    def channel(self, channel: Channel) -> int:
        """The number of a topic; the first channel of a topic counts."""
        number = self._channels.get(channel.topic)
        if number is not None:
            return number
        key = channel.schema_name, channel.schema
        schema_id = self._schemas.get(key)
        if schema_id is None:
            schema_id = self._schemas[key] = len(self._schemas) + 1
            self._declare(
                records.Schema(
                    id=schema_id,
                    name=channel.schema_name,
                    encoding=channel.schema_encoding,
                    data=channel.schema,
                )
            )
        number = self._channels[channel.topic] = len(self._channels) + 1
        self._declare(
            records.Channel(
                id=number,
                topic=channel.topic,
                message_encoding=channel.message_encoding,
                metadata=dict(channel.metadata),
                schema_id=schema_id,
            )
        )
        return number

    def write(self, rows: Sequence[Rows], loose: Sequence[Loose] = ()) -> None:
        """Messages in order of their log time, of equal ones in the order given.

        Log times are made strictly increasing over the whole file: one that is not later than
        the one before becomes 1 ns later than that.
        """
        rows = [each for each in rows if len(each.log_ns)]
        total = sum(len(each.log_ns) for each in rows) + len(loose)
        if not total:
            return
        log_ns = np.concatenate(
            [*(each.log_ns for each in rows), np.array([each.log_ns for each in loose], np.int64)]
        )
        sizes = np.concatenate(
            [
                *(np.full(len(each.log_ns), each.data.shape[1], np.int64) for each in rows),
                np.array([len(each.data) for each in loose], np.int64),
            ]
        )
        channels = np.concatenate(
            [
                *(np.full(len(each.log_ns), each.channel, np.int64) for each in rows),
                np.array([each.channel for each in loose], np.int64),
            ]
        )
        order = np.argsort(log_ns, kind="stable")
        ends = np.cumsum((sizes + _HEAD_BYTES)[order])
        starts = np.empty(total, np.int64)
        starts[order] = np.concatenate(([0], ends[:-1]))
        log_ns[order] = strictly_increasing(log_ns[order], self._last_ns)
        self._last_ns = int(log_ns[order[-1]])
        data = _put_together(rows, loose, starts, log_ns, int(ends[-1]))
        self._cut(data, starts[order], ends, log_ns[order], channels[order])

    def attach(self, name: str, media_type: str, data: bytes, log_ns: int) -> None:
        attachment = records.Attachment(log_ns, log_ns, name, media_type, data)
        offset = self._position
        self._put_record(attachment)
        length = self._position - offset
        self._attachments.append(
            records.AttachmentIndex(offset, length, log_ns, log_ns, len(data), name, media_type)
        )

    def metadata(self, name: str, values: dict[str, str]) -> None:
        offset = self._position
        self._put_record(records.Metadata(name=name, metadata=values))
        self._metadata.append(records.MetadataIndex(offset, self._position - offset, name))

    def finish(self) -> None:
        """Write the summary; the file is left open."""
        if self._new.tell():
            # A channel without messages is still part of the file.
            self._put(self._new.getvalue())
        self._put_record(records.DataEnd(0))
        summary_start = self._position
        statistics = records.Statistics(
            attachment_count=len(self._attachments),
            channel_count=len(self._channels),
            channel_message_counts=self._counts,
            chunk_count=len(self._chunks),
            message_count=self.messages,
            metadata_count=len(self._metadata),
            message_start_time=self._first_ns or 0,
            message_end_time=max(self._last_ns, 0),
            schema_count=len(self._schemas),
        )
        parts = [_bytes_of(statistics), *self._chunks]
        parts += map(_bytes_of, (*self._attachments, *self._metadata))
        written = self._known.getvalue() + b"".join(parts)
        footer = RECORD_HEAD.pack(Opcode.FOOTER, 20) + struct.pack("<QQ", summary_start, 0)
        crc = zlib.crc32(footer, zlib.crc32(written))
        self._put(written + footer + struct.pack("<I", crc) + MAGIC)

    # --------------------------------------------------------------------------------- chunks

    def _cut(self, data: Bytes, starts: Index, ends: Index, log_ns: Times, channels: Index) -> None:
        """Write sorted messages, whose bytes are `data`, as chunks."""
        borders = np.flatnonzero(np.diff(starts // CHUNK_BYTES)) + 1
        for first, stop in zip(
            [0, *borders.tolist()], [*borders.tolist(), len(starts)], strict=True
        ):
            part = slice(first, stop)
            head = self._new.getvalue()
            self._new = BytesIO()
            begin = int(starts[first])
            body = head + data[begin : int(ends[stop - 1])].tobytes()
            self._chunk(body, log_ns[part], channels[part], starts[part] - begin + len(head))

    def _chunk(self, body: bytes, log_ns: Times, channels: Index, offsets: Index) -> None:
        packed = lz4.frame.compress(body)
        begin = self._position
        first_ns, last_ns = int(log_ns[0]), int(log_ns[-1])
        if self._first_ns is None:
            self._first_ns = first_ns
        self._put_record(
            records.Chunk("lz4", packed, last_ns, first_ns, zlib.crc32(body), len(body))
        )
        chunk_bytes = self._position - begin
        places: dict[int, int] = {}
        order = np.argsort(channels, kind="stable")
        for group in np.split(order, np.flatnonzero(np.diff(channels[order])) + 1):
            channel = int(channels[group[0]])
            places[channel] = self._position
            self._counts[channel] = self._counts.get(channel, 0) + len(group)
            entries = np.empty(len(group), ENTRY)
            entries["time"], entries["offset"] = log_ns[group], offsets[group]
            size = entries.nbytes
            self._put(
                _INDEX.pack(Opcode.MESSAGE_INDEX, size + 6, channel, size) + entries.tobytes()
            )
        index = records.ChunkIndex(
            chunk_length=chunk_bytes,
            chunk_start_offset=begin,
            compression="lz4",
            compressed_size=len(packed),
            message_end_time=last_ns,
            message_index_length=self._position - begin - chunk_bytes,
            message_index_offsets=places,
            message_start_time=first_ns,
            uncompressed_size=len(body),
        )
        self._chunks.append(_bytes_of(index))

    # ---------------------------------------------------------------------------------- bytes

    def _declare(self, record: records.Schema | records.Channel) -> None:
        written = _bytes_of(record)
        self._new.write(written)
        self._known.write(written)

    def _put_record(self, record: records.McapRecord) -> None:
        self._put(_bytes_of(record))

    def _put(self, data: bytes) -> None:
        self._file.write(data)
        self._position += len(data)


def _bytes_of(record: records.McapRecord) -> bytes:
    builder = RecordBuilder()
    record.write(builder)
    written: bytes = builder.end()  # type: ignore[no-untyped-call]  # mcap leaves it bare
    return written


def strictly_increasing(times_ns: Times, last_ns: int) -> Times:
    """Each later than the one before and than `last_ns`, by 1 ns where it was not."""
    count = np.arange(len(times_ns))
    rising = np.maximum.accumulate(np.maximum(times_ns - count, last_ns + 1))
    return rising + count


def _put_together(
    rows: Sequence[Rows], loose: Sequence[Loose], starts: Index, log_ns: Times, size: int
) -> Bytes:
    """Message records, each at its place; `starts` and `log_ns` are of all rows, then of loose."""
    data = np.empty(size, np.uint8)
    at = 0
    for each in rows:
        count, width = each.data.shape
        part = slice(at, at + count)
        at += count
        made = np.empty((count, _HEAD_BYTES + width), np.uint8)
        made[:, :_HEAD_BYTES] = _heads(each, width, log_ns[part])
        made[:, _HEAD_BYTES:] = each.data
        item = f"V{_HEAD_BYTES + width}"
        # A view of overlapping items, of which each message is one: numpy copies it whole.
        items = np.ndarray((size - made.shape[1] + 1,), item, data, 0, (1,))
        items[starts[part]] = made.view(item).ravel()
    view = data.data
    head = np.zeros(1, MESSAGE_HEAD)
    head["opcode"] = Opcode.MESSAGE
    for one, start, time_ns in zip(loose, starts[at:].tolist(), log_ns[at:].tolist(), strict=True):
        head["length"], head["channel"] = MESSAGE_BYTES + len(one.data), one.channel
        head["log_time"] = head["publish_time"] = time_ns
        view[start : start + _HEAD_BYTES + len(one.data)] = head.tobytes() + one.data
    return data


def _heads(rows: Rows, width: int, log_ns: Times) -> Bytes:
    heads = np.zeros(len(log_ns), MESSAGE_HEAD)
    heads["opcode"] = Opcode.MESSAGE
    heads["length"] = MESSAGE_BYTES + width
    heads["channel"] = rows.channel
    heads["log_time"] = log_ns
    heads["publish_time"] = rows.publish_ns
    return heads.view(np.uint8).reshape(len(heads), _HEAD_BYTES)
