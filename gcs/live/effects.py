"""Everything that `viewers.py` answers with, as a closed union of frozen values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from gcs import ipc
from gcs.live.services import Answer


@dataclass(frozen=True, slots=True)
class Join:
    """Make a connection of this viewer's own."""

    viewer: int


@dataclass(frozen=True, slots=True)
class Send:
    """A line over a viewer's connection, or over `LOOKING`."""

    viewer: int
    command: ipc.Command


@dataclass(frozen=True, slots=True)
class Close:
    """End this viewer's connection without a word: the station holds for it."""

    viewer: int


@dataclass(frozen=True, slots=True)
class Reply:
    """The response of a call."""

    call: int
    answer: Answer


@dataclass(frozen=True, slots=True)
class Notice:
    """A sentence for all viewers to see."""

    text: str
    warning: bool


Effect: TypeAlias = Join | Send | Close | Reply | Notice
