"""Everything that reaches the session, as a closed union of frozen values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, TypeAlias

import msgspec

from gcs import ipc
from gcs.session.as_recorded import AsRecorded
from gcs.wire.frame import Frame

RECORDED: Final = {"operator": "client"}
"""A record calls an operator's number so, which older ones do too."""


class Datagram(msgspec.Struct, frozen=True):
    """Bytes that came in on link number `link`, as one datagram or one read of a stream."""

    link: int
    data: bytes
    frames: tuple[Frame, ...] = ()
    """`data`, split already: one or several datagrams of nothing but plain frames, put together
    (see `gcs.wire.frame.plain_frames`); empty where it is still to be split."""
    as_recorded: AsRecorded | None = None
    """Only an audit says so, where the record has other bytes than came, for a key's sake: what
    these would be split into says nothing."""


@dataclass(frozen=True, slots=True)
class LinkEvent:
    """A link opened, lost its peer, or granted another buffer than asked for."""

    link: int
    text: str
    trouble: bool = False


class OperatorJoined(msgspec.Struct, frozen=True, rename=RECORDED):
    """Another operator's program connected to the station's socket, under a number of its own.

    `hold_on_leave`: see `ipc.Join`.
    """

    operator: int
    name: str
    hold_on_leave: bool = True


class OperatorLine(msgspec.Struct, frozen=True, rename=RECORDED):
    """A command from one operator's program, already decoded."""

    operator: int
    command: ipc.Command


class OperatorNoise(msgspec.Struct, frozen=True, rename=RECORDED):
    """A line from an operator's program that is no command."""

    operator: int
    text: str


class OperatorGone(msgspec.Struct, frozen=True, rename=RECORDED):
    """An operator's command stream ended, or nobody reads what it is told."""

    operator: int
    reason: str


@dataclass(frozen=True, slots=True)
class ClientCame:
    """A MAVLink client is there, on a link of its own until it has gone.

    The number of the link is free, and from the number of the vehicles' links up.  `name` is where
    it is ("udp 127.0.0.1:14551"); `stream`: its `Datagram`s are pieces of one byte stream.  Not
    `verified`: a port with a key took it in, and whether it has the key is not known yet.  `named`:
    the user named its place, so that it is sent to whether anybody is there or not.
    """

    link: int
    name: str
    stream: bool
    verified: bool = True
    named: bool | msgspec.UnsetType = msgspec.UNSET  # unset, it is not in the record


@dataclass(frozen=True, slots=True)
class ClientGone:
    """The client of that link has gone: it was silent, closed its connection, or made room."""

    link: int
    reason: str


@dataclass(frozen=True, slots=True)
class ClientFlooded:
    """The client of that link sends more than it may: so many datagrams of it were dropped unread
    since it was last told, at most once a second."""

    link: int
    dropped: int


@dataclass(frozen=True, slots=True)
class SignalCame:
    """The station's process was signalled to go (SIGTERM), or its terminal closed (SIGHUP)."""

    name: str


@dataclass(frozen=True, slots=True)
class FileRead:
    """The answer to `ReadFile`: the bytes, or why there are none."""

    token: int
    path: str
    data: bytes | None
    error: str = ""


@dataclass(frozen=True, slots=True)
class FileWritten:
    """The answer to `WriteFile`."""

    token: int
    path: str
    error: str = ""


@dataclass(frozen=True, slots=True)
class RuleSaid:
    """The answer to `AskRule`: None permits, a sentence refuses.  `failed`: the rule itself went
    wrong, and `refusal` says how.  `printed` is what it printed meanwhile."""

    request_id: int
    refusal: str | None
    failed: bool = False
    printed: str = ""


@dataclass(frozen=True, slots=True)
class RecorderChanged:
    """The recorder failed or came back.  `path` is the file that is being written, if any."""

    recording: bool
    path: str
    text: str = ""


@dataclass(frozen=True, slots=True)
class RecorderGrew:
    """How much has been written, for the screen, and how much room the disk has for more."""

    size_bytes: int
    free_bytes: int | msgspec.UnsetType = msgspec.UNSET  # unset, it is not in the record


@dataclass(frozen=True, slots=True)
class DiskLow:
    """The disk of the record has little room left, or (`critical`) next to none."""

    free_bytes: int
    left_s: float | None
    """Until it is full, at the present rate; None where that is unknown."""
    critical: bool


@dataclass(frozen=True, slots=True)
class SimLine:
    """A line that our own vehicle's process printed."""

    text: str


@dataclass(frozen=True, slots=True)
class SimGone:
    """The process of the station's own vehicle ended by itself."""

    exit_code: int


@dataclass(frozen=True, slots=True)
class Wake:
    """`deadline_ns` has passed."""


OtherInput: TypeAlias = (
    LinkEvent
    | OperatorJoined
    | OperatorLine
    | OperatorNoise
    | OperatorGone
    | ClientCame
    | ClientGone
    | ClientFlooded
    | SignalCame
    | FileRead
    | FileWritten
    | RuleSaid
    | RecorderChanged
    | RecorderGrew
    | DiskLow
    | SimLine
    | SimGone
    | Wake
)
"""What is recorded as an input of its own; a datagram is recorded frame by frame."""

Input: TypeAlias = Datagram | OtherInput

TAGS: Final[Mapping[type[Input], str]] = MappingProxyType(
    {
        Datagram: "Datagram",
        LinkEvent: "LinkEvent",
        OperatorJoined: "OperatorJoined",
        OperatorLine: "OperatorLine",
        OperatorNoise: "OperatorNoise",
        OperatorGone: "OperatorGone",
        ClientCame: "ClientCame",
        ClientGone: "ClientGone",
        ClientFlooded: "ClientFlooded",
        SignalCame: "SignalCame",
        FileRead: "FileRead",
        FileWritten: "FileWritten",
        RuleSaid: "RuleSaid",
        RecorderChanged: "RecorderChanged",
        RecorderGrew: "RecorderGrew",
        DiskLow: "DiskLow",
        SimLine: "SimLine",
        SimGone: "SimGone",
        Wake: "Wake",
    }
)
"""What a record calls each of them, whatever the class is called: old records are read by it."""
