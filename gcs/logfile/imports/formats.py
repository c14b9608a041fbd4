"""Which kind of log a file is, by its first bytes, and what reads it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TypeAlias

from gcs.logfile.batch_writer import BatchWriter
from gcs.logfile.errors import BadLogError
from gcs.logfile.imports.result import Imported
from gcs.logfile.imports.tlog import import_tlog
from gcs.record.reading import MAGIC as MCAP_MAGIC

Progress: TypeAlias = Callable[[int], None] | None
Import: TypeAlias = Callable[[Path, BatchWriter, Progress], Imported]


def importer_of(source: Path) -> Import:
    """Raises BadLogError where nothing here reads such a file, and OSError."""
    with open(source, "rb") as file:
        head = file.read(16)
    if not head:
        raise BadLogError(source, "the file is empty")
    if head.startswith(MCAP_MAGIC):
        raise BadLogError(source, "an MCAP file", "it can be opened as it is: gcs log info")
    return import_tlog
