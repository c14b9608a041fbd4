"""Opens a flight of any format as the records of an MCAP."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Protocol

from gcs.record.reading import Condition, Reading, Record


class FlightRecords(Protocol):
    """The records of a flight in file order; `condition` is whole once they have been read."""

    path: Path
    condition: Condition

    def __iter__(self) -> Iterator[Record]: ...


def open_flight(path: Path) -> FlightRecords:
    """The records of a recorded flight.

    Iterating raises BadRecordError for what cannot be read.  Raises OSError.
    """
    from gcs.logfile.as_record import LogReading, is_other_log

    return LogReading(path) if is_other_log(path) else Reading(path)
