"""What an audit reads and makes: the messages of a record, as its file has them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

import msgspec

from gcs.mcap_file.writer import Channel, GuardedFile, Log
from gcs.record import ros1
from gcs.record.topics import INPUT_TOPIC as INPUT_TOPIC
from gcs.report import Direction

FRAME_TOPIC = "/mavlink/"
GARBAGE_TOPIC = "/link/"


class Stored(NamedTuple):
    """One message.  `payload_length` is that of its channel's metadata, None without one."""

    topic: str
    log_time_ns: int
    data: bytes
    payload_length: int | None = None

    @property
    def is_frame(self) -> bool:
        return self.topic.startswith(FRAME_TOPIC)

    @property
    def is_garbage(self) -> bool:
        return self.topic.startswith(GARBAGE_TOPIC)

    @property
    def came_in(self) -> bool:
        """Bytes that a link received, refused or not: an input, or a part of one."""
        return self.is_garbage or (self.is_frame and self.data[1] != Direction.SENT)

    @property
    def link(self) -> int:
        """Of what came in.  Raises ValueError where the topic names none."""
        return int(self.topic.split("/")[2]) if self.is_garbage else self.data[0]

    @property
    def why(self) -> str:
        """Why garbage is no frame, or a frame was refused as it came in."""
        return ros1.decode_garbage(self.data)[0]

    @property
    def raw(self) -> bytes:
        """The frame or garbage as it was on the wire."""
        if self.is_garbage:
            return ros1.decode_garbage(self.data)[1]
        return ros1.rebuild(self.data, payload_length=self.payload_length)


Attachments: TypeAlias = "dict[str, list[bytes]]"
"""By name, the contents that are attached under it, in order."""


class Tape:
    """A backend for a recorder that writes no file: its messages and attachments, kept."""

    def __init__(self) -> None:
        self.messages: list[Stored] = []
        self.attachments: Attachments = {}

    def take(self) -> Sequence[Stored]:
        """The messages since the last time."""
        taken, self.messages = self.messages, []
        return taken

    def channel(self, channel: Channel) -> Log:
        length = payload_length(dict(channel.metadata))

        def log(message: bytes, log_time_ns: int) -> None:
            self.messages.append(Stored(channel.topic, log_time_ns, message, length))

        return log

    def attach(self, name: str, media_type: str, data: bytes, log_time_ns: int) -> None:
        self.attachments.setdefault(name, []).append(data)

    def open(self, file: GuardedFile) -> None:
        """There is no file."""

    def flush(self) -> None:
        """There is no file."""

    def metadata(self, name: str, values: dict[str, str]) -> None:
        self.attachments.setdefault(metadata_name(name), []).append(metadata_bytes(values))

    def close(self) -> None:
        """There is no file."""


def metadata_name(name: str) -> str:
    """Under which it stands among the attachments."""
    return f"metadata {name}"


def metadata_bytes(values: dict[str, str]) -> bytes:
    return msgspec.json.encode(values, order="deterministic")


def payload_length(channel_metadata: dict[str, str]) -> int | None:
    """What frames of a channel were extended to."""
    text = channel_metadata.get(ros1.PAYLOAD_LENGTH_KEY, "")
    return int(text) if text.isdecimal() else None


class InputMessage(msgspec.Struct, frozen=True):
    """A message of `INPUT_TOPIC`; `data` depends on `kind`."""

    kind: str
    data: msgspec.Raw
