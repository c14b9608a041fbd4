"""Everything that the session answers with, as a closed union of frozen structs.

The shell performs them in order.
"""

from __future__ import annotations

from typing import TypeAlias

import msgspec

from gcs import ipc
from gcs.frames import Vec3
from gcs.report import RecordItem

EVERYONE = 0
"""In place of an operator's number: all operators are told."""


class Transmit(msgspec.Struct, frozen=True, gc=False):
    """Put these bytes on link number `link`."""

    link: int
    data: bytes


class Record(msgspec.Struct, frozen=True, gc=False):
    item: RecordItem


class Emit(msgspec.Struct, frozen=True, gc=False):
    """Tell one operator's program, or all of them.  Its `Bye` is the last that it is told."""

    event: ipc.Event
    operator: int = EVERYONE


class ShowTopics(msgspec.Struct, frozen=True, gc=False):
    """Tell this operator's program, from now on, of every message that goes into the record."""

    operator: int


class ReadFile(msgspec.Struct, frozen=True, gc=False):
    token: int
    path: str


class WriteFile(msgspec.Struct, frozen=True, gc=False):
    token: int
    path: str
    data: bytes


class AskRule(msgspec.Struct, frozen=True):
    """Ask the operator's own rule whether the vehicle may fly these legs, each a start and an end
    (ENU, metres).  The answer is a `RuleSaid`; none may come."""

    request_id: int
    legs_enu: tuple[tuple[Vec3, Vec3], ...]


class ClientVerified(msgspec.Struct, frozen=True, gc=False):
    """The first frame with a good signature was taken of the MAVLink client on that link: from now
    on it has one of the places of those who have the key."""

    link: int


class LeaveOutPeer(msgspec.Struct, frozen=True, gc=False):
    """The peer that has just sent these bytes on a vehicle's link sends back what clients are sent:
    hear it no more, and send it nothing, until it was silent for `silent_ns`.  Not where it is the
    only one that is heard there."""

    link: int
    data: bytes
    silent_ns: int


class Finish(msgspec.Struct, frozen=True, gc=False):
    """Nothing is left to do: close the log, stop our own vehicle, go."""

    exit_code: int
    sentence: str


Effect: TypeAlias = (
    Transmit
    | Record
    | Emit
    | ShowTopics
    | ReadFile
    | WriteFile
    | AskRule
    | ClientVerified
    | LeaveOutPeer
    | Finish
)
