"""Which reader an autopilot's own log has."""

from __future__ import annotations

from pathlib import Path

from gcs.logfile.formats import Format, format_of
from gcs.logfile.onboard.dataflash import OnceOverBinary
from gcs.logfile.onboard.dataflash_log import DataflashLog
from gcs.logfile.onboard.dataflash_text import OnceOverText
from gcs.logfile.onboard.part import WINDOW_BYTES
from gcs.logfile.onboard.ulog import Ulog
from gcs.mcap_file.errors import BadLogError


def open_onboard(path: Path, window_bytes: int = WINDOW_BYTES) -> DataflashLog | Ulog:
    """Raises BadLogError and OSError."""
    match format_of(path):
        case Format.DATAFLASH:
            return DataflashLog(path, OnceOverBinary, window_bytes)
        case Format.DATAFLASH_TEXT:
            # Lines take more room in memory than in the file.
            return DataflashLog(path, OnceOverText, max(1, window_bytes // 4))
        case Format.ULOG:
            return Ulog(path, window_bytes)
        case other:
            raise BadLogError(path, f"no log of an autopilot's own, but {other.value}")
