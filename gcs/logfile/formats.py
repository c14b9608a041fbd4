"""Which kind of log a file is, by its first bytes."""

from __future__ import annotations

from enum import Enum
from pathlib import Path

from gcs.mcap_file.errors import BadLogError
from gcs.mcap_file.format import MAGIC as MCAP_MAGIC

_DATAFLASH_MAGIC = b"\xa3\x95"
_ULOG_MAGIC = b"ULog\x01\x12\x35"


class Format(Enum):
    """Logs that are read here."""

    MCAP = "MCAP"
    TLOG = ".tlog"
    DATAFLASH = "ArduPilot .BIN"
    ULOG = "PX4 .ulg"


def format_of(path: Path) -> Format:
    """What has none of the others' first bytes can only be a .tlog: that begins with a time.

    Raises BadLogError where the file is empty, and OSError.
    """
    with open(path, "rb") as file:
        head = file.read(16)
    if not head:
        raise BadLogError(path, "the file is empty")
    if head.startswith(MCAP_MAGIC):
        return Format.MCAP
    if head.startswith(_ULOG_MAGIC):
        return Format.ULOG
    return Format.DATAFLASH if head.startswith(_DATAFLASH_MAGIC) else Format.TLOG
