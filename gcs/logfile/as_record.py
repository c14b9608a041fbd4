"""Reads a log of another format as if it were a record, for what reads records.

The record is made in a temporary folder, by the same import as `gcs log import`, and is removed
when it has been read.  It takes about as much room there as the log itself.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from gcs.logfile.imports.formats import importer_of
from gcs.mcap_file.batch_writer import BatchWriter
from gcs.mcap_file.errors import BadLogError, BadRecordError
from gcs.mcap_file.format import Record
from gcs.mcap_file.reader import Condition, Progress, Reading

SUFFIXES = (".tlog", ".bin", ".log", ".ulg")


class LogReading:
    """`for record in LogReading(path)`: as `Reading`, of a .tlog, .BIN, .log or .ulg.

    Raises BadRecordError for what none of them is, and OSError.
    """

    def __init__(self, path: Path, progress: Progress | None = None) -> None:
        self.path = path
        self._progress = progress
        self.condition = Condition(path.stat().st_size)

    def __iter__(self) -> Iterator[Record]:
        with TemporaryDirectory(prefix="gcs-import-") as folder:
            made = Path(folder) / "imported.mcap"
            try:
                run = importer_of(self.path)
                with open(made, "xb") as file:
                    writer = BatchWriter(file)
                    run(self.path, writer, None)
                    writer.finish()
            except BadLogError as error:
                hint = f" ({error.hint})" if error.hint else ""
                raise BadRecordError(self.path, f"{error.reason}{hint}") from error
            reading = Reading(made, self._progress)
            self.condition = reading.condition
            yield from reading


def open_log(path: Path, progress: Progress | None = None) -> Reading | LogReading:
    """A record, or by its name a log that can be read as one.  Raises OSError."""
    other = path.suffix.lower() in SUFFIXES
    return LogReading(path, progress) if other else Reading(path, progress)
