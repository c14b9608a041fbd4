"""Everything that the session answers with, as a closed union of frozen dataclasses.

The shell performs them in order.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, TypeAlias

from gcs import ipc
from gcs.record.items import RecordItem


@dataclass(frozen=True, slots=True)
class Transmit:
    """Put these bytes on link number `link`."""

    link: int
    data: bytes


@dataclass(frozen=True, slots=True)
class Record:
    item: RecordItem


@dataclass(frozen=True, slots=True)
class Emit:
    """Tell the operator."""

    event: ipc.Event


@dataclass(frozen=True, slots=True)
class ReadFile:
    token: int
    path: str


@dataclass(frozen=True, slots=True)
class WriteFile:
    token: int
    path: str
    data: bytes


@dataclass(frozen=True, slots=True)
class Finish:
    """Nothing is left to do: close the log, stop our own vehicle, go."""

    exit_code: int
    sentence: str


EFFECTS: Final = (Transmit, Record, Emit, ReadFile, WriteFile, Finish)
Effect: TypeAlias = Transmit | Record | Emit | ReadFile | WriteFile | Finish
