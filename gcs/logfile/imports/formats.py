"""What makes a record of which kind of log."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TypeAlias

from gcs.logfile.formats import Format, format_of
from gcs.logfile.imports.result import Imported
from gcs.logfile.imports.tlog import import_tlog
from gcs.mcap_file.batch_writer import BatchWriter
from gcs.mcap_file.errors import BadLogError

Progress: TypeAlias = Callable[[int], None] | None
Import: TypeAlias = Callable[[Path, BatchWriter, Progress], Imported]


def importer_of(source: Path) -> Import:
    """Raises BadLogError where nothing here reads such a file, and OSError."""
    match format_of(source):
        case Format.TLOG:
            return import_tlog
        case Format.MCAP:
            raise BadLogError(source, "an MCAP file", "it can be opened as it is: gcs log info")
        case Format.DATAFLASH:
            from gcs.logfile.imports.dataflash import import_dataflash

            return import_dataflash
        case Format.ULOG:
            from gcs.logfile.imports.ulog import import_ulog

            return import_ulog
