"""A campaign's folder: its plan, its rows in Parquet parts, and the records that are kept.

Rows are appended as parts, each written whole or not at all, so that a campaign goes on where it
was stopped.  At its end all rows stand in `rows.parquet`, in the order of their numbers.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

import msgspec

from gcs.campaign.case import Row, Value
from gcs.campaign.plan import SEED, Choice, Plan, Range, decode, encode

if TYPE_CHECKING:
    import pyarrow

PLAN, ROWS, PARTS, RECORDS = "plan.msgpack", "rows.parquet", "parts", "records"
BESIDE = "beside"
"""The folder of real autopilots, each with a store of the same plan."""
_OWN = tuple(name for name in Row.__struct_fields__ if name != "inputs")
Columns: TypeAlias = "dict[str, list[Value | None]]"


class OtherCampaignError(Exception):
    """The folder has the flights of another plan."""


class Store:
    """The folder of one plan."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._parts = 0

    def begin(self, plan: Plan) -> None:
        """Make the folder, or go on with it.  Raises OtherCampaignError and OSError."""
        for each in (self.folder, self.folder / PARTS, self.folder / RECORDS):
            each.mkdir(parents=True, exist_ok=True)
        file, data = self.folder / PLAN, encode(plan)
        if file.exists() and file.read_bytes() != data:
            raise OtherCampaignError(f"{self.folder}: the flights of another campaign are in it")
        _write(file, data)

    def plan(self) -> Plan:
        """Raises OSError and msgspec.DecodeError."""
        return decode((self.folder / PLAN).read_bytes())

    def rows(self) -> list[Row]:
        """Of all parts, by number; of a flight that was flown twice the later one."""
        from pyarrow import parquet

        found: dict[int, Row] = {}
        for part in sorted((self.folder / PARTS).glob("*.parquet")):
            self._parts = max(self._parts, int(part.stem))
            for row in _rows_of(parquet.read_table(part)):
                found[row.id] = row
        return [found[number] for number in sorted(found)]

    def append(self, plan: Plan, rows: Sequence[Row]) -> None:
        """As the next part."""
        self._parts += 1
        self._put(plan, rows, self.folder / PARTS / f"{self._parts:06d}.parquet")

    def finish(self, plan: Plan, rows: Sequence[Row]) -> Path:
        """All rows in one file, in order."""
        file = self.folder / ROWS
        self._put(plan, rows, file)
        return file

    def record(self, number: int) -> Path:
        return self.records / f"{number:06d}.mcap"

    @property
    def records(self) -> Path:
        return self.folder / RECORDS

    def _put(self, plan: Plan, rows: Sequence[Row], file: Path) -> None:
        from pyarrow import parquet

        beside = file.with_name(f".{file.name}.{os.getpid()}")
        parquet.write_table(_table(plan, rows), beside, compression="zstd")
        beside.replace(file)


def rows_digest(rows: Iterable[Row]) -> str:
    """SHA-256 of all rows in order: equal campaigns have equal ones, whoever flew them."""
    digest = hashlib.sha256()
    for row in rows:
        digest.update(msgspec.json.encode(row))
    return digest.hexdigest()


def _table(plan: Plan, rows: Sequence[Row]) -> pyarrow.Table:
    import pyarrow

    fields = [("id", pyarrow.int64()), *((axis.name, _type_of(axis)) for axis in plan.axes)]
    if all(axis.name != SEED for axis in plan.axes):
        fields.append((SEED, pyarrow.int64()))
    columns: Columns = {name: [row.inputs[name] for row in rows] for name, _ in fields[1:]}
    columns["id"] = [row.id for row in rows]
    kinds = {bool: pyarrow.bool_(), int: pyarrow.int64(), str: pyarrow.string()}
    hints = {each.name: each.type for each in msgspec.structs.fields(Row)}
    for name in _OWN[1:]:
        fields.append((name, kinds.get(hints[name], pyarrow.float64())))
        columns[name] = [getattr(row, name) for row in rows]
    return pyarrow.table(columns, schema=pyarrow.schema(fields))


def _type_of(axis: Choice | Range) -> pyarrow.DataType:
    import pyarrow

    if isinstance(axis, Range):
        return pyarrow.float64()
    kinds = {bool: pyarrow.bool_(), int: pyarrow.int64(), float: pyarrow.float64()}
    return kinds.get(type(axis.values[0]), pyarrow.string())


def _rows_of(table: pyarrow.Table) -> list[Row]:
    found = []
    for values in table.to_pylist():
        own = {name: values.pop(name) for name in _OWN}
        found.append(Row(inputs=values, **own))
    return found


def _write(file: Path, data: bytes) -> None:
    beside = file.with_name(f".{file.name}.{os.getpid()}")
    beside.write_bytes(data)
    beside.replace(file)
