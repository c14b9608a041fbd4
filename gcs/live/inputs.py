"""What reaches `server.py` and, through it, `viewers.py`, as frozen values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

from gcs import ipc


@dataclass(frozen=True, slots=True)
class Came:
    """A viewer has connected."""

    viewer: int


@dataclass(frozen=True, slots=True)
class Said:
    """A whole WebSocket message of a viewer's."""

    viewer: int
    data: bytes
    text: bool


@dataclass(frozen=True, slots=True)
class Graph:
    """Who publishes and who subscribes to what, in names of nodes."""

    published: Mapping[str, list[str]]
    subscribed: Mapping[str, list[str]]


@dataclass(frozen=True, slots=True)
class Call:
    """Which call of which viewer, as its answer names it."""

    viewer: int
    service_id: int
    call_id: int


@dataclass(frozen=True, slots=True)
class Called:
    """A viewer has called a service."""

    call: Call
    service: str
    payload: bytes


@dataclass(frozen=True, slots=True)
class Published:
    """A viewer has published a message on a topic of its own."""

    viewer: int
    encoding: str
    schema_name: str
    data: bytes


@dataclass(frozen=True, slots=True)
class ParametersAsked:
    """A viewer wants to know these parameters (none: all), or to set them.

    `request` is what the viewer calls its request.
    """

    viewer: int
    names: tuple[str, ...]
    request: str | None
    set_to: Mapping[str, object] | None = None


@dataclass(frozen=True, slots=True)
class Gone:
    """A viewer's connection has ended."""

    viewer: int


@dataclass(frozen=True, slots=True)
class Told:
    """The station has said something over a viewer's connection, or over `LOOKING`."""

    viewer: int
    event: ipc.Event


@dataclass(frozen=True, slots=True)
class Ended:
    """The station has ended a trusted viewer's connection, or none could be made."""

    viewer: int


@dataclass(frozen=True, slots=True)
class Tick:
    """Time has passed."""


Asked: TypeAlias = Called | Published | ParametersAsked | Gone
"""By a viewer."""
Input: TypeAlias = Asked | Told | Ended | Tick
"""Of `viewers.py`."""
