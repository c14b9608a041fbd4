"""Messages as CSV (RFC 4180): a file for each kind, a header line, a line a message.

Times are `time_ns`; elements of an array have columns of their own, `name[0]`, `name[1]`.  Values
are as the log has them; a float32 has as many digits as it takes to read it back exactly.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from gcs.logfile.columns.layout import Records
from gcs.logfile.tables import tables_of
from gcs.mcap_file.batch_writer import Sink
from gcs.mcap_file.errors import BadLogError


def export_csv(
    source: Path,
    open_file: Callable[[str], Sink],
    only: str | None = None,
    progress: Callable[[int], None] | None = None,
) -> dict[str, int]:
    """Write all kinds, or the one named `only`; the number of messages of each.

    `open_file` gives the file for a kind.  Raises BadLogError where there is nothing to write.
    """
    files: dict[str, Sink] = {}
    counts: dict[str, int] = {}
    for name, rows in tables_of(source, None if only is None else (only,), progress):
        file = files.get(name)
        if file is None:
            file = files[name] = open_file(name)
            file.write(_lines([_header(rows)]))
        file.write(_lines(zip(*_columns(rows), strict=True)))
        counts[name] = counts.get(name, 0) + len(rows)
    if not counts:
        raise BadLogError(source, f"no {only} in it" if only else "no messages in it")
    return counts


def _header(rows: Records) -> list[str]:
    names: list[str] = []
    for name in rows.dtype.names or ():
        shape = rows.dtype[name].shape
        names += [f"{name}[{number}]" for number in range(shape[0])] if shape else [name]
    return names


def _columns(rows: Records) -> Iterator[list[Any]]:
    for name in rows.dtype.names or ():
        column = rows[name]
        if column.dtype.kind == "S":
            yield [each.decode("utf-8", "replace") for each in column.tolist()]
        elif column.ndim == 2:
            for number in range(column.shape[1]):
                yield _values(column[:, number])
        else:
            yield _values(column)


def _values(column: np.ndarray[Any, Any]) -> list[Any]:
    # The shortest text that is the same float32.
    values: list[Any] = (column.astype(str) if column.dtype == np.float32 else column).tolist()
    return values


def _lines(rows: Any) -> bytes:
    text = io.StringIO()
    csv.writer(text).writerows(rows)
    return text.getvalue().encode()
