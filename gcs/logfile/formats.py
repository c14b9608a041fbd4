"""Which kind of log a file is, by its first bytes."""

from __future__ import annotations

import re
from enum import Enum
from pathlib import Path

from gcs.mcap_file.errors import BadLogError
from gcs.mcap_file.format import MAGIC as MCAP_MAGIC

_DATAFLASH_MAGIC = b"\xa3\x95"
_ULOG_MAGIC = b"ULog\x01\x12\x35"
_TEXT = re.compile(rb"^FMT,", re.MULTILINE)
_SEARCHED_BYTES = 8_000
"""A text log begins with lines FMT; before them may be a few of the program that made it."""


class Format(Enum):
    """Logs that are read here."""

    MCAP = "MCAP"
    TLOG = ".tlog"
    DATAFLASH = "ArduPilot .BIN"
    DATAFLASH_TEXT = "ArduPilot .log"
    ULOG = "PX4 .ulg"


def format_of(path: Path) -> Format:
    """What has none of the others' first bytes can only be a .tlog: that begins with a time.

    Raises BadLogError where the file is empty, and OSError.
    """
    with open(path, "rb") as file:
        head = file.read(_SEARCHED_BYTES)
    if not head:
        raise BadLogError(path, "the file is empty")
    if head.startswith(MCAP_MAGIC):
        return Format.MCAP
    if head.startswith(_ULOG_MAGIC):
        return Format.ULOG
    if head.startswith(_DATAFLASH_MAGIC):
        return Format.DATAFLASH
    text = _TEXT.search(head)
    is_text = text is not None and b"\0" not in head[: text.start()]
    return Format.DATAFLASH_TEXT if is_text else Format.TLOG
