"""Everything that the session answers with, as a closed union of frozen structs.

The shell performs them in order.
"""

from __future__ import annotations

from typing import TypeAlias

import msgspec

from gcs import ipc
from gcs.report import RecordItem

EVERYONE = 0
"""In place of a client's number: all operators are told."""


class Transmit(msgspec.Struct, frozen=True, gc=False):
    """Put these bytes on link number `link`."""

    link: int
    data: bytes


class Record(msgspec.Struct, frozen=True, gc=False):
    item: RecordItem


class Emit(msgspec.Struct, frozen=True, gc=False):
    """Tell one operator's program, or all of them.  Its `Bye` is the last that a client is told."""

    event: ipc.Event
    client: int = EVERYONE


class ShowTopics(msgspec.Struct, frozen=True, gc=False):
    """Tell this operator's program, from now on, of every message that goes into the record."""

    client: int


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


Effect: TypeAlias = Transmit | Record | Emit | ShowTopics | ReadFile | WriteFile | Finish
