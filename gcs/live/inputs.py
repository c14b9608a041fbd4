"""Everything that reaches `viewers.py`, as a closed union of frozen values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from gcs import ipc


@dataclass(frozen=True, slots=True)
class Called:
    """A viewer has called a service; `call` numbers the call for its answer.

    `watching`: it has a subscription or a topic of its own, so that its end will be noticed.
    """

    viewer: int
    call: int
    service: str
    payload: bytes
    watching: bool = True


@dataclass(frozen=True, slots=True)
class Published:
    """A viewer has published a message on a topic of its own."""

    viewer: int
    encoding: str
    schema_name: str
    data: bytes


@dataclass(frozen=True, slots=True)
class Gone:
    """A viewer has neither a subscription nor a topic of its own left: its connection ended."""

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


Input: TypeAlias = Called | Published | Gone | Told | Ended | Tick
