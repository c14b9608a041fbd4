"""Every message of a log, of any kind that is read here, as tables in the order of the file."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from gcs.logfile import packed, tlog
from gcs.logfile.columns.layout import Records, records
from gcs.logfile.columns.read import frames_as_records, is_frames_of
from gcs.logfile.formats import Format, format_of
from gcs.mcap_file.chunk_reader import MESSAGE_BYTES, MESSAGE_HEAD, Chunk, ChunkFile, Index, rows_at
from gcs.mcap_file.format import Channel
from gcs.wire.dialect import MESSAGES, MESSAGES_BY_NAME

FRAMES = "mavlink"


class Table(NamedTuple):
    """Some messages of one kind, one a row; the first column is `time_ns`."""

    name: str
    rows: Records


def tables_of(
    path: Path, only: Collection[str] | None = None, progress: Callable[[int], None] | None = None
) -> Iterator[Table]:
    """All messages, or those of the names `only`; of a large file in many parts.

    Raises BadLogError and OSError.
    """
    match format_of(path):
        case Format.TLOG:
            yield from _of_tlog(path, only, progress)
        case Format.MCAP:
            yield from _of_mcap(path, only, progress)
        case Format.DATAFLASH | Format.DATAFLASH_TEXT | Format.ULOG:
            from gcs.logfile.onboard.opened import open_onboard

            for part in open_onboard(path).parts(only):
                for name, _, rows in part.tables:
                    yield Table(name, rows)
                if progress is not None:
                    progress(part.read_bytes)


def _of_tlog(
    path: Path, only: Collection[str] | None, progress: Callable[[int], None] | None
) -> Iterator[Table]:
    for window in tlog.read_windows(path):
        for msgid in np.unique(window.frames.msgid).tolist():
            definition = MESSAGES.get(msgid)
            if definition is None or not (only is None or definition.name in only):
                continue
            mine = window.frames.msgid == msgid
            frames, time_us = window.frames.pick(mine), window.time_us[mine]
            yield Table(definition.name, records(definition, window.data, frames, time_us))
        if progress is not None:
            progress(window.read_bytes)


def _of_mcap(
    path: Path, only: Collection[str] | None, progress: Callable[[int], None] | None
) -> Iterator[Table]:
    file = ChunkFile(path)

    def wanted(channel: Channel) -> bool:
        return channel.message_encoding == "ros1" and (only is None or name_of(channel) in only)

    for chunk in file.chunks(wanted):
        for number, offsets in chunk.offsets.items():
            channel = file.channels.get(number)
            if channel is None or not wanted(channel):
                continue
            name = name_of(channel)
            definition = MESSAGES_BY_NAME.get(name)
            if definition is not None and is_frames_of(channel, definition):
                rows = frames_as_records(definition, channel, chunk, offsets)
            else:
                schema = file.schemas.get(channel.schema_id)
                kind = None if schema is None else packed.record_type(schema.data)
                if kind is None:
                    continue
                rows = _packed(kind, chunk, offsets)
            if len(rows):
                yield Table(name, rows)
        if progress is not None:
            progress(file.read_bytes)


def name_of(channel: Channel) -> str:
    """As tables are named: the message, or what stands behind the kind of log in the topic."""
    parts = channel.topic.split("/")
    if parts[1:2] == [FRAMES]:
        return parts[-1]
    return "_".join(parts[2:])


def _packed(kind: np.dtype[np.void], chunk: Chunk, offsets: Index) -> Records:
    whole = np.dtype([*MESSAGE_HEAD.descr, *kind.descr])
    inside = offsets[(offsets >= 0) & (offsets <= len(chunk.data) - whole.itemsize)]
    rows = rows_at(chunk.data, inside, whole.itemsize).view(whole).ravel()
    rows = rows[rows["length"] == MESSAGE_BYTES + kind.itemsize]
    names = [name for name in kind.names or () if not name.startswith(packed.LENGTH)]
    made = np.zeros(len(rows), [(packed.TIME_FIELD, "<i8"), *((n, kind[n]) for n in names)])
    made[packed.TIME_FIELD] = rows["log_time"].astype(np.int64)
    for name in names:
        made[name] = rows[name]
    return made
