"""Messages as Parquet: a file for each kind, a row a message, with the types of the log."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pyarrow
import pyarrow.parquet

from gcs.logfile.columns.layout import Records
from gcs.logfile.tables import tables_of
from gcs.mcap_file.batch_writer import Sink
from gcs.mcap_file.errors import BadLogError

_GROUP_BYTES = 1 << 20


def export_parquet(
    source: Path,
    open_file: Callable[[str], Sink],
    only: str | None = None,
    progress: Callable[[int], None] | None = None,
) -> dict[str, int]:
    """Write all kinds, or the one named `only`; the number of messages of each.

    `open_file` gives the file for a kind.  Raises BadLogError where there is nothing to write.
    """
    writers: dict[str, _Writer] = {}
    counts: dict[str, int] = {}
    for name, rows in tables_of(source, None if only is None else (only,), progress):
        if name not in writers:
            writers[name] = _Writer(open_file(name), _table(rows[:0]).schema)
        writers[name].add(rows)
        counts[name] = counts.get(name, 0) + len(rows)
    for writer in writers.values():
        writer.close()
    if not counts:
        raise BadLogError(source, f"no {only} in it" if only else "no messages in it")
    return counts


class _Writer:
    """One file.  Messages are collected: each group of rows takes memory up to the file's end."""

    def __init__(self, sink: Sink, schema: Any) -> None:
        output = pyarrow.PythonFile(_Output(sink), mode="w")
        self._writer = pyarrow.parquet.ParquetWriter(output, schema)
        self._parts: list[Records] = []

    def add(self, rows: Records) -> None:
        self._parts.append(rows)
        if sum(part.nbytes for part in self._parts) >= _GROUP_BYTES:
            self._write()

    def close(self) -> None:
        self._write()
        self._writer.close()

    def _write(self) -> None:
        if self._parts:
            tables = [_table(part) for part in self._parts]
            self._parts = []
            self._writer.write_table(pyarrow.concat_tables(tables))


class _Output:
    """What pyarrow asks of a file beside `write`."""

    closed = False

    def __init__(self, sink: Sink) -> None:
        self._sink = sink
        self._position = 0

    def write(self, data: bytes) -> int:
        self._sink.write(bytes(data))
        self._position += len(data)
        return len(data)

    def tell(self) -> int:
        return self._position

    def flush(self) -> None:
        """The sink is closed by whoever opened it."""

    def close(self) -> None:
        self.closed = True


def _table(rows: Records) -> Any:
    columns = {}
    for name in rows.dtype.names or ():
        column = rows[name]
        if column.dtype.kind == "S":
            texts = [each.decode("utf-8", "replace") for each in column.tolist()]
            columns[name] = pyarrow.array(texts, pyarrow.string())
        elif column.ndim == 2:
            flat = pyarrow.array(column.ravel())
            columns[name] = pyarrow.FixedSizeListArray.from_arrays(flat, column.shape[1])
        else:
            columns[name] = pyarrow.array(column)
    return pyarrow.table(columns)
