"""What a recorder writes into a session's record by which a reader can check the files."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Seal:
    """On `/session/input`, as `RecordTick` and `RecordEnd`: what a reader can check the file by."""

    messages: int
    """Before this one, in all files of the session, without what later parts repeat."""
    crc32: int
    """Of all messages since the last seal, or since this file's beginning, end to end."""


@dataclass(frozen=True, slots=True)
class PartBegan:
    """On `/session/input`, as `RecordPart`, first of all in every file but a session's first."""

    part: int
    of: str
    """Name of the session's first file, without its suffix."""
    repeated: int
    """So many messages follow that are in an earlier file already."""
    messages: int
    """As in `Seal`: what earlier files should hold.  Fewer: the others are in no file."""
