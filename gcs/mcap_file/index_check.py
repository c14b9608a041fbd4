"""Does a record's index lead to all of its messages?  Viewers read nothing else."""

from __future__ import annotations

import mmap
import struct
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path

from mcap.exceptions import McapError
from mcap.reader import make_reader
from mcap.records import ChunkIndex
from mcap.summary import Summary

from gcs.mcap_file.format import RECORD_HEAD, Opcode, inflate, whole_records
from gcs.mcap_file.reader import KEPT_BYTES, release

_MESSAGE_HEAD = struct.Struct("<HIQ")
_INDEX_HEAD = struct.Struct("<HI")
_ENTRY = struct.Struct("<QQ")


def wrong_with_index(path: Path, counted: Mapping[int, int]) -> Iterator[str]:
    """What is wrong, in sentences; `counted` is how many messages each channel has.

    Raises OSError.
    """
    with open(path, "rb") as file:
        try:
            summary = make_reader(file).get_summary()
        except (McapError, struct.error, ValueError, KeyError, AssertionError) as error:
            yield f"its summary cannot be read: {error or type(error).__name__}"
            return
        if summary is None or summary.statistics is None:
            yield "it has no summary: a viewer must read all of it"
            return
        said = {k: n for k, n in summary.statistics.channel_message_counts.items() if n}
        if said != dict(counted) or summary.statistics.message_count != sum(counted.values()):
            total = summary.statistics.message_count
            yield f"its summary counts {total} messages, there are {sum(counted.values())}"
        yield from _wrong_with_channels(summary, counted)
        with mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
            indexed: Counter[int] = Counter()
            kept_from = 0
            for index in sorted(summary.chunk_indexes, key=lambda each: each.chunk_start_offset):
                yield from _wrong_with_chunk(data, index, indexed)
                end = min(len(data), index.chunk_start_offset + index.chunk_length)
                if end - kept_from >= KEPT_BYTES:
                    kept_from = release(data, kept_from, end)
        if indexed != Counter(counted):
            yield f"its index leads to {indexed.total()} of {sum(counted.values())} messages"


def _wrong_with_channels(summary: Summary, counted: Mapping[int, int]) -> Iterator[str]:
    missing = sorted(set(counted) - set(summary.channels))
    if missing:
        yield f"its summary lacks the channels {missing}"


def _wrong_with_chunk(data: mmap.mmap, index: ChunkIndex, indexed: Counter[int]) -> Iterator[str]:
    start = index.chunk_start_offset
    body = _body(data, start, Opcode.CHUNK)
    records = inflate(body) if body is not None else None
    if records is None:
        yield f"there is no chunk at byte {start}, where its index has one"
        return
    heads = dict(_message_heads(records))
    found = 0
    for channel_id, at in index.message_index_offsets.items():
        entries = _body(data, at, Opcode.MESSAGE_INDEX)
        if entries is None or len(entries) < _INDEX_HEAD.size:
            yield f"there is no message index at byte {at}"
            continue
        number, length = _INDEX_HEAD.unpack_from(entries)
        packed = entries[_INDEX_HEAD.size : _INDEX_HEAD.size + length]
        if number != channel_id or len(packed) != length or length % _ENTRY.size:
            yield f"the message index at byte {at} is not one of channel {channel_id}"
            continue
        for log_time_ns, offset in _ENTRY.iter_unpack(packed):
            if heads.get(offset) == (channel_id, log_time_ns):
                found += 1
                indexed[channel_id] += 1
    if found != len(heads):
        yield f"the index of the chunk at byte {start} leads to {found} of {len(heads)} messages"


def _body(data: mmap.mmap, at: int, opcode: Opcode) -> bytes | None:
    """Of the record at `at`, if it is of this kind and whole."""
    if at + RECORD_HEAD.size > len(data):
        return None
    kind, length = RECORD_HEAD.unpack_from(data, at)
    end = at + RECORD_HEAD.size + length
    return data[at + RECORD_HEAD.size : end] if kind == opcode and end <= len(data) else None


def _message_heads(records: bytes) -> Iterator[tuple[int, tuple[int, int]]]:
    """Where each message begins, and its channel and log_time."""
    for opcode, start, _ in whole_records(records):
        if opcode == Opcode.MESSAGE:
            channel_id, _, log_time_ns = _MESSAGE_HEAD.unpack_from(records, start)
            yield start - RECORD_HEAD.size, (channel_id, log_time_ns)
