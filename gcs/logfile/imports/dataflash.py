"""An ArduPilot dataflash log (.BIN) into a record; pymavlink's DFReader finds its messages.

Every kind of message is a topic `/dataflash/<NAME>`, with the log's own columns; the multipliers of
the format letters (c, C, e, E, L) are applied, as DFReader does it.  Times are UTC where the log
has a GPS time, else since the autopilot started.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gcs.logfile.columns.layout import Records
from gcs.logfile.imports.dataflash_vehicle import told
from gcs.logfile.imports.flight import import_flight
from gcs.logfile.imports.result import Imported
from gcs.logfile.packed import TIME_FIELD
from gcs.mcap_file.batch_writer import BatchWriter
from gcs.mcap_file.chunk_reader import Index, rows_at
from gcs.mcap_file.errors import BadLogError

_HEAD = b"\xa3\x95"
_HEAD_BYTES = 3
_FMT, _FMT_BYTES = 0x80, 89
_CODES: dict[str, Any] = {
    "a": ("<i2", 32),
    "b": "i1",
    "B": "u1",
    "g": "<f2",
    "h": "<i2",
    "H": "<u2",
    "i": "<i4",
    "I": "<u4",
    "f": "<f4",
    "d": "<f8",
    "n": "S4",
    "N": "S16",
    "Z": "S64",
    "c": "<i2",
    "C": "<u2",
    "e": "<i4",
    "E": "<u4",
    "L": "<i4",
    "M": "u1",
    "q": "<i8",
    "Q": "<u8",
}
"""Format letter -> numpy (AP_Logger/README.md of ArduPilot)."""
_MULTIPLIERS = {"c": 0.01, "C": 0.01, "e": 0.01, "E": 0.01, "L": 1e-7}


@dataclass(slots=True)
class Dataflash:
    """A log as tables, one a kind of message; `garbage` is what is in none of them."""

    tables: dict[str, Records]
    garbage: list[tuple[int, bytes]]
    """Time in ns of the message before it, and the bytes."""


def import_dataflash(
    source: Path, writer: BatchWriter, progress: Callable[[int], None] | None = None
) -> Imported:
    """Raises BadLogError and OSError."""
    log = read_dataflash(source)
    result = import_flight(
        ".BIN", "/dataflash", source, writer, log.tables, told(log.tables), log.garbage
    )
    if progress is not None:
        progress(source.stat().st_size)
    return result


def read_dataflash(source: Path) -> Dataflash:
    """The whole log in memory.  Raises BadLogError and OSError."""
    _refuse_endless(source)
    reader = _opened(source)
    reader.close()  # what it found stays in it
    data = np.fromfile(source, np.uint8)
    places, kinds = _places(reader, len(data))
    times_ns = _times(reader, data, places, kinds)
    tables = {}
    for kind in np.unique(kinds).tolist():
        format_ = reader.formats[kind]
        mine = kinds == kind
        table = _table(format_, data, places[mine], times_ns[mine])
        if table is not None:
            tables[format_.name] = table
    if not tables:
        raise BadLogError(source, "there are no messages in it")
    lengths = np.array([reader.formats[kind].len for kind in kinds.tolist()], np.int64)
    return Dataflash(tables, _garbage(data, places, places + lengths, times_ns))


def _refuse_endless(source: Path) -> None:
    """Raises BadLogError where a message says that it is shorter than its own header.

    DFReader goes on by that length, and so would stay where it is for ever.
    """
    data = source.read_bytes()
    lengths = {_FMT: _FMT_BYTES}
    at = 0
    while (at := data.find(_HEAD, at)) >= 0 and at + _HEAD_BYTES <= len(data):
        kind = data[at + 2]
        if kind == _FMT and at + _HEAD_BYTES + 2 <= len(data):
            about, length = data[at + 3], data[at + 4]
            if length < _HEAD_BYTES:
                raise BadLogError(source, f"byte {at}: messages of type {about} have no length")
            lengths[about] = length
        at += lengths.get(kind, 1)


def _opened(source: Path) -> Any:
    """pymavlink's reader, which is untyped: `Any` ends in this module."""
    from pymavlink.DFReader import DFReader_binary

    reader = DFReader_binary.__new__(DFReader_binary)
    try:
        # It prints what it finds damaged, a line a byte.
        with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
            reader.__init__(str(source))
        return reader
    except OSError:
        raise
    except Exception as error:
        reader.filehandle.close()
        raise BadLogError(source, f"pymavlink cannot read this .BIN: {error}") from error


def _places(reader: Any, size: int) -> tuple[Index, Index]:
    """Where each whole message begins, and its kind, in the order of the file."""
    places: list[Index] = []
    kinds: list[Index] = []
    for kind, offsets in enumerate(reader.offsets):
        if not len(offsets) or kind not in reader.formats:
            continue
        at = np.asarray(offsets, np.int64)
        at = at[at + reader.formats[kind].len <= size]
        places.append(at)
        kinds.append(np.full(len(at), kind, np.int64))
    if not places:
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    every, kind_of = np.concatenate(places), np.concatenate(kinds)
    order = np.argsort(every, kind="stable")
    return every[order], kind_of[order]


def _times(reader: Any, data: NDArray[np.uint8], places: Index, kinds: Index) -> Index:
    """Of each message: its TimeUS, else the time of the one before; ns."""
    base_ns = round(float(getattr(reader.clock, "timebase", 0.0) or 0.0) * 1e9)
    time_ns = np.full(len(places), -1, np.int64)
    for kind in np.unique(kinds).tolist():
        format_ = reader.formats[kind]
        raw = _raw_type(format_)
        for name, ns in (("TimeUS", 1_000), ("TimeMS", 1_000_000)):
            if raw is not None and name in (raw.names or ()) and raw[name].kind in "iu":
                mine = kinds == kind
                rows = rows_at(data, places[mine] + _HEAD_BYTES, raw.itemsize).view(raw).ravel()
                since = np.minimum(rows[name].astype(np.float64), 2.0**62 / ns)
                time_ns[mine] = base_ns + since.astype(np.int64) * ns
                break
    known = np.flatnonzero(time_ns >= 0)
    if not len(known):
        return np.zeros(len(places), np.int64)
    before = np.maximum.accumulate(np.where(time_ns >= 0, np.arange(len(places)), known[0]))
    filled: Index = time_ns[before]
    return filled


def _raw_type(format_: Any) -> np.dtype[np.void] | None:
    """The struct of a message; None where its format is not one."""
    letters, columns = list(format_.format), list(format_.columns)
    if not letters or len(letters) != len(columns) or len(set(columns)) != len(columns):
        return None
    if not all(name.isidentifier() for name in columns) or TIME_FIELD in columns:
        return None
    raw = np.dtype(
        [_column(name, _CODES[code]) for name, code in zip(columns, letters, strict=True)]
    )
    return raw if raw.itemsize == format_.len - _HEAD_BYTES else None


def _column(name: str, code: Any) -> Any:
    return (name, *code) if isinstance(code, tuple) else (name, code)


def _table(format_: Any, data: NDArray[np.uint8], places: Index, time_ns: Index) -> Records | None:
    raw = _raw_type(format_)
    if raw is None:
        # What cannot be understood is kept as bytes.
        raw = np.dtype([("data", "u1", max(1, format_.len - _HEAD_BYTES))])
    rows = rows_at(data, places + _HEAD_BYTES, raw.itemsize).view(raw).ravel()
    scaled = {
        name: _MULTIPLIERS[code]
        for name, code in zip(format_.columns, format_.format, strict=False)
        if code in _MULTIPLIERS and name in (raw.names or ())
    }
    fields: list[Any] = [(TIME_FIELD, "<i8")]
    for name in raw.names or ():
        kind: Any = "<f8" if name in scaled else raw[name]
        fields.append((name, "<f4") if raw[name] == np.float16 else (name, kind))
    table = np.zeros(len(rows), fields)
    table[TIME_FIELD] = time_ns
    for name in raw.names or ():
        table[name] = rows[name] * scaled[name] if name in scaled else rows[name]
    return table


def _garbage(
    data: NDArray[np.uint8], starts: Index, ends: Index, time_ns: Index
) -> list[tuple[int, bytes]]:
    """The bytes between the messages, before and after them."""
    before = np.concatenate(([0], np.maximum.accumulate(ends)))
    after = np.concatenate((starts, [len(data)]))
    when = np.concatenate((time_ns[:1], time_ns))
    return [
        (int(when[n]), data[before[n] : after[n]].tobytes())
        for n in np.flatnonzero(after > before).tolist()
    ]
