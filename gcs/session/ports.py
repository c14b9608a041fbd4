"""What reaches a session and what comes out of it: two closed unions of frozen dataclasses."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from gcs import ipc
from gcs.record.items import RecordItem


@dataclass(frozen=True, slots=True)
class Datagram:
    """Bytes that came in on link number `link`, as one datagram or one read of a stream."""

    link: int
    data: bytes


@dataclass(frozen=True, slots=True)
class LinkEvent:
    """A link opened, lost its peer, or granted another buffer than asked for."""

    link: int
    text: str
    trouble: bool = False


@dataclass(frozen=True, slots=True)
class OperatorLine:
    """A command from the operator, already decoded."""

    command: ipc.Command


@dataclass(frozen=True, slots=True)
class OperatorNoise:
    """A line from the operator that is no command."""

    text: str


@dataclass(frozen=True, slots=True)
class OperatorGone:
    """The command stream ended, or a signal asked the link to go."""

    reason: str


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
class RecorderChanged:
    """The recorder failed or came back.  `path` is the file that is being written, if any."""

    recording: bool
    path: str
    text: str = ""


@dataclass(frozen=True, slots=True)
class RecorderGrew:
    """How much has been written, for the screen."""

    size_bytes: int


@dataclass(frozen=True, slots=True)
class SimLine:
    """A line that our own vehicle's process printed."""

    text: str


@dataclass(frozen=True, slots=True)
class SimGone:
    """Our own vehicle's process ended though nobody asked it to."""

    exit_code: int


@dataclass(frozen=True, slots=True)
class Wake:
    """`deadline_ns` has passed."""


Input: TypeAlias = (
    Datagram
    | LinkEvent
    | OperatorLine
    | OperatorNoise
    | OperatorGone
    | FileRead
    | FileWritten
    | RecorderChanged
    | RecorderGrew
    | SimLine
    | SimGone
    | Wake
)


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


Effect: TypeAlias = Transmit | Record | Emit | ReadFile | WriteFile | Finish
