"""Everything that the session answers with, as a closed union of frozen structs.

The shell performs them in order.
"""

from __future__ import annotations

from typing import TypeAlias

import msgspec

from gcs import ipc
from gcs.report import RecordItem


class ShellEffect(msgspec.Struct, frozen=True, gc=False):
    """Base of all effects: what the queue passes on without looking at it."""


class Transmit(ShellEffect, frozen=True, gc=False):
    """Put these bytes on link number `link`."""

    link: int
    data: bytes


class Record(ShellEffect, frozen=True, gc=False):
    item: RecordItem


class Emit(ShellEffect, frozen=True, gc=False):
    """Tell the operator."""

    event: ipc.Event


class ReadFile(ShellEffect, frozen=True, gc=False):
    token: int
    path: str


class WriteFile(ShellEffect, frozen=True, gc=False):
    token: int
    path: str
    data: bytes


class Finish(ShellEffect, frozen=True, gc=False):
    """Nothing is left to do: close the log, stop our own vehicle, go."""

    exit_code: int
    sentence: str


Effect: TypeAlias = Transmit | Record | Emit | ReadFile | WriteFile | Finish
