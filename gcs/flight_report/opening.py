"""Opens a flight of any format as the records of an MCAP."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Protocol

from gcs.record.reading import BadRecordError, Condition, Reading, Record

IMPORTED_SUFFIXES = (".tlog", ".bin", ".log", ".ulg")
"""Logs of other programs and of the autopilots, which are imported into MCAP topics first."""


class FlightRecords(Protocol):
    """The records of a flight in file order; `condition` is whole once they have been read."""

    path: Path
    condition: Condition

    def __iter__(self) -> Iterator[Record]: ...


def open_flight(path: Path) -> FlightRecords:
    """The records of a recorded flight.

    Raises OSError, and BadRecordError for what cannot be read; iterating raises BadRecordError for
    what is no MCAP.
    """
    if path.suffix.lower() in IMPORTED_SUFFIXES:
        raise BadRecordError(path, f"a {path.suffix} log has to be imported into an MCAP first")
    return Reading(path)
