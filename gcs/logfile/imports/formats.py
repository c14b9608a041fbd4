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
        case Format.DATAFLASH | Format.DATAFLASH_TEXT | Format.ULOG:
            return _import_onboard


def _import_onboard(source: Path, writer: BatchWriter, progress: Progress = None) -> Imported:
    """Raises BadLogError and OSError."""
    from gcs.logfile.imports import dataflash_vehicle, ulog_vehicle
    from gcs.logfile.imports.onboard import import_onboard
    from gcs.logfile.onboard.opened import open_onboard
    from gcs.logfile.onboard.ulog import Ulog

    log = open_onboard(source)
    if isinstance(log, Ulog):
        told = ulog_vehicle.told(log.system_id)
        result = import_onboard(".ulg", "/ulog", log, told, writer, progress)
        if result.garbage_stretches:
            log.info["file_corruption"] = result.damage
        writer.metadata("ulog", log.info)
    else:
        told = dataflash_vehicle.told(log.head.system_id, is_copter=log.head.is_copter)
        name = ".log" if format_of(source) is Format.DATAFLASH_TEXT else ".BIN"
        result = import_onboard(name, "/dataflash", log, told, writer, progress)
    if not result.read:
        raise BadLogError(source, "there are no messages in it")
    return result
