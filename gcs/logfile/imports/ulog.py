"""A PX4 flight log (.ulg) into a record; pyulog, PX4's own reader, reads it.

Every topic and instance is a topic `/ulog/<name>_<instance>`, with the log's own fields (`q[0]` is
`q_0`, as ROS 1 has no such names).  Texts, parameters and drop-outs are topics too, what the log
says about itself is metadata.  Times are UTC where the log has a GPS time, else since the autopilot
started.
"""

from __future__ import annotations

import io
import re
from collections.abc import Callable
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from gcs.logfile.columns.layout import Records
from gcs.logfile.imports.flight import import_flight
from gcs.logfile.imports.result import Imported
from gcs.logfile.imports.ulog_vehicle import PARAMETERS, TEXTS, told
from gcs.logfile.packed import TIME_FIELD
from gcs.mcap_file.batch_writer import BatchWriter
from gcs.mcap_file.errors import BadLogError

DROPOUTS = "dropouts"
DEFAULTS = "parameter_defaults"
"""Of the airframe where it has its own, else of the firmware; where the log tells them."""
_HEADER_BYTES = 16
_DEFINITIONS = "BFIMPQ"
"""Types of messages that stand before the data (PX4 User Guide, ULog File Format)."""
_FIELD_TYPE = re.compile(r"(\w+)(?:\[(\d{1,18})\])? \w+;")
_TOO_LARGE = 1 << 16
"""A message has 16 bits for its length."""
_ROUNDS = 40
_LAST_US = 2**63 // 1000 - 1
"""Nanoseconds since 1970 in 63 bits end here."""


@dataclass(slots=True)
class Ulog:
    """A log as tables, one for each topic and instance."""

    tables: dict[str, Records]
    info: dict[str, str]


def import_ulog(
    source: Path, writer: BatchWriter, progress: Callable[[int], None] | None = None
) -> Imported:
    """Raises BadLogError and OSError."""
    log = read_ulog(source)
    writer.metadata("ulog", log.info)
    result = import_flight(".ulg", "/ulog", source, writer, log.tables, told(log.tables), [])
    if progress is not None:
        progress(source.stat().st_size)
    return result


def read_ulog(source: Path) -> Ulog:
    """The whole log in memory.  Raises BadLogError and OSError."""
    log = _load(source)
    base_us = _utc_of_start_us(log)
    tables = {f"{each.name}_{each.multi_id}": _table(each.data, base_us) for each in log.data_list}
    tables |= _rest(log, base_us)
    tables = {name: table for name, table in tables.items() if len(table)}
    if not tables:
        raise BadLogError(source, "there are no messages in it")
    info = {str(name): str(value) for name, value in log.msg_info_dict.items()}
    if log.file_corruption:
        info["file_corruption"] = "parts of the log are damaged and could not be read"
    return Ulog(tables, info)


def _load(source: Path) -> Any:
    """What pyulog, which is untyped, makes of it: `Any` ends in this module."""
    try:
        import pyulog
    except ModuleNotFoundError as error:
        hint = "pip install 'mavgate[logs]'"
        raise BadLogError(source, "reading a .ulg needs the package pyulog", hint) from error
    _refuse_too_large(source)
    try:
        with (
            open(source, "rb") as file,
            redirect_stdout(io.StringIO()),
            redirect_stderr(io.StringIO()),
        ):
            return pyulog.ULog(file)
    except OSError:
        raise
    except Exception as error:
        raise BadLogError(source, f"pyulog cannot read it: {error!r}") from error


def _refuse_too_large(source: Path) -> None:
    """Raises BadLogError where a format says that its message is longer than one can be.

    pyulog makes an entry of each element of each array of it, however many there are said to be.
    """
    fields: dict[str, list[tuple[str, int]]] = {}
    with open(source, "rb") as file:
        file.seek(_HEADER_BYTES)
        while len(head := file.read(3)) == 3 and chr(head[2]) in _DEFINITIONS:
            body = file.read(int.from_bytes(head[:2], "little"))
            if chr(head[2]) == "F":
                name, _, text = body.decode("utf-8", "replace").partition(":")
                fields[name] = [
                    (kind, int(count or 1)) for kind, count in _FIELD_TYPE.findall(text)
                ]
    sizes: dict[str, int] = {}
    # A round for each level of nesting; what is nested in itself doubles until it is too large.
    for _ in range(len(fields) + _ROUNDS):
        sizes = {
            name: min(_TOO_LARGE, sum(sizes.get(kind, 1) * count for kind, count in each))
            for name, each in fields.items()
        }
        if max(sizes.values(), default=0) >= _TOO_LARGE:
            name = max(sizes, key=sizes.__getitem__)
            raise BadLogError(source, f"the format of {name} is longer than a message can be")


def _utc_of_start_us(log: Any) -> int:
    """What is to be added to its time stamps; 0 where no GPS told the time."""
    for each in log.data_list:
        if each.name in ("vehicle_gps_position", "sensor_gps") and "time_utc_usec" in each.data:
            known = np.flatnonzero(each.data["time_utc_usec"])
            if len(known):
                first = known[0]
                utc_us, since_us = each.data["time_utc_usec"][first], each.data["timestamp"][first]
                return min(max(0, int(utc_us) - int(since_us)), _LAST_US // 2)
    return 0


def _table(data: dict[str, Any], base_us: int) -> Records:
    names = _names(list(data))
    fields = [(names[name], column.dtype) for name, column in data.items()]
    table = np.zeros(len(data["timestamp"]), [(TIME_FIELD, "<i8"), *fields])
    table[TIME_FIELD] = _ns(data["timestamp"], base_us)
    for name, column in data.items():
        table[names[name]] = column
    return table


def _names(given: list[str]) -> dict[str, str]:
    """Names of fields as ROS 1 allows them, all different."""
    taken: dict[str, str] = {}
    for name in given:
        plain = re.sub(r"\W+", "_", name).strip("_") or "field"
        while plain in taken.values() or plain == TIME_FIELD:
            plain += "_"
        taken[name] = plain
    return taken


def _ns(since_us: Any, base_us: int) -> Any:
    limit = np.uint64(_LAST_US - base_us)
    return (np.minimum(np.asarray(since_us, np.uint64), limit).astype(np.int64) + base_us) * 1000


def _rest(log: Any, base_us: int) -> dict[str, Records]:
    """Texts, parameters and drop-outs as tables."""
    texts = [(m.timestamp, m.log_level - ord("0"), m.message.encode()) for m in log.logged_messages]
    for tagged in log.logged_messages_tagged.values():
        texts += [(m.timestamp, m.log_level - ord("0"), m.message.encode()) for m in tagged]
    start = log.start_timestamp
    values = [(start, name.encode(), value) for name, value in log.initial_parameters.items()]
    values += [(at, name.encode(), value) for at, name, value in log.changed_parameters]
    # In a damaged log one may be bytes.
    values = [row for row in values if isinstance(row[2], int | float)]
    defaults = _defaults(log, start)
    gaps = [(each.timestamp, each.duration) for each in log.dropouts]
    return {
        TEXTS: _made(texts, [("level", "u1"), ("text", _text_type(texts, 2))], base_us),
        PARAMETERS: _made(values, [("name", _text_type(values, 1)), ("value", "<f8")], base_us),
        DEFAULTS: _made(defaults, [("name", _text_type(defaults, 1)), ("value", "<f8")], base_us),
        DROPOUTS: _made(gaps, [("duration_ms", "<u4")], base_us),
    }


def _defaults(log: Any, start_us: int) -> list[Any]:
    if not log.has_default_parameters:
        return []
    known = {**log.get_default_parameters(0), **log.get_default_parameters(1)}
    # One that is not told is as it is.
    known = {**log.initial_parameters, **known}
    values = [(start_us, name.encode(), value) for name, value in known.items()]
    return [row for row in values if isinstance(row[2], int | float)]


def _text_type(rows: list[Any], column: int) -> str:
    return f"S{max((len(row[column]) for row in rows), default=1) or 1}"


def _made(rows: list[Any], fields: list[tuple[str, str]], base_us: int) -> Records:
    table = np.zeros(len(rows), [(TIME_FIELD, "<i8"), *fields])
    table[TIME_FIELD] = _ns([row[0] for row in rows], base_us)
    for number, (name, _) in enumerate(fields, 1):
        table[name] = [row[number] for row in rows]
    return table
