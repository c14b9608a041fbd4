"""What `server.py` sends to viewers, and all that `viewers.py` answers with, as frozen values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

from gcs import ipc
from gcs.live.inputs import Call
from gcs.live.services import Answer


@dataclass(frozen=True, slots=True)
class Frame:
    """A whole WebSocket message for a viewer; one of a topic may be left out if it is slow."""

    viewer: int
    data: bytes
    text: bool
    of_a_topic: bool = False


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
    """End this viewer's connection to the station without a word: the station holds for it."""

    viewer: int


@dataclass(frozen=True, slots=True)
class Reply:
    """The response of a call."""

    call: Call
    answer: Answer


@dataclass(frozen=True, slots=True)
class Notice:
    """A sentence for a viewer to see, or for all (None)."""

    viewer: int | None
    text: str
    warning: bool


@dataclass(frozen=True, slots=True)
class Values:
    """Parameters as they are now, for the viewer that has asked, or for all that want to know of
    changes (None)."""

    viewer: int | None
    values: Mapping[str, float]
    request: str | None = None


Answering: TypeAlias = Reply | Notice | Values
"""What viewers are told."""
Effect: TypeAlias = Join | Send | Close | Answering
"""Of `viewers.py`."""
