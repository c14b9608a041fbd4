"""Everything that the session answers with, as a closed union of frozen structs.

The shell performs them in order.
"""

from __future__ import annotations

from typing import TypeAlias

import msgspec

from gcs import ipc
from gcs.report import RecordItem


class Transmit(msgspec.Struct, frozen=True, gc=False):
    """Put these bytes on link number `link`."""

    link: int
    data: bytes


class Record(msgspec.Struct, frozen=True, gc=False):
    item: RecordItem


class Emit(msgspec.Struct, frozen=True, gc=False):
    """Tell the operator."""

    event: ipc.Event


class ReadFile(msgspec.Struct, frozen=True, gc=False):
    token: int
    path: str


class WriteFile(msgspec.Struct, frozen=True, gc=False):
    token: int
    path: str
    data: bytes


class Finish(msgspec.Struct, frozen=True, gc=False):
    """Nothing is left to do: close the log, stop our own vehicle, go."""

    exit_code: int
    sentence: str


Effect: TypeAlias = Transmit | Record | Emit | ReadFile | WriteFile | Finish
