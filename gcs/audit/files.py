"""Records on disk, as an audit wants them: a session's files together, in order."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import msgspec

from gcs.audit.inputs import CannotReadError, kept_of
from gcs.audit.messages import (
    INPUT_TOPIC,
    Attachments,
    InputMessage,
    Stored,
    metadata_bytes,
    metadata_name,
    payload_length,
)
from gcs.mcap_file.format import Attachment, Channel, Message, Metadata
from gcs.mcap_file.reader import Reading
from gcs.record.parts import PartBegan
from gcs.vehicle.record_items import Start

Progress = Callable[[Path, int], None]


@dataclass(slots=True)
class SessionFiles:
    """The files of one session, the first one first; `damaged` counts what could not be read,
    `misnumbered` messages whose number or publish time the recorder does not write so."""

    paths: list[Path]
    damaged: int = 0
    misnumbered: int = 0
    behind_bytes: int = 0
    """What stands behind the end of a file."""

    def attachments(self) -> Attachments:
        """Raises BadRecordError and OSError."""
        found: Attachments = {}
        for path in self.paths:
            for record in Reading(path, chunks=False):
                if isinstance(record, Attachment):
                    found.setdefault(record.name, []).append(record.data)
                elif isinstance(record, Metadata):
                    kept = found.setdefault(metadata_name(record.name), [])
                    kept.append(metadata_bytes(record.metadata))
        return found

    def messages(self, progress: Progress | None = None) -> Iterator[Stored]:
        """Every message, file by file, in file order.  Raises BadRecordError and OSError."""
        for path in self.paths:
            reading = Reading(path, progress and partial(progress, path))
            numbers = Numbers()
            yield from _messages(reading, numbers)
            self.damaged += reading.condition.damaged
            self.misnumbered += numbers.wrong
            self.behind_bytes += reading.condition.behind_bytes


class Numbers:
    """Of the messages of one file, a later part as well: in each channel they count from 1 on (or,
    as another library writes them, all of the file are 0), and are published when they are
    logged."""

    def __init__(self) -> None:
        self._last: dict[int, int] = {}
        self._step: int | None = None
        self.wrong = 0

    def message(self, message: Message) -> None:
        if self._step is None:
            self._step = 0 if message.sequence == 0 else 1
        counted = message.sequence == self._last.get(message.channel_id, 0) + self._step
        self._last[message.channel_id] = message.sequence
        self.wrong += not counted or message.publish_time_ns != message.log_time_ns


def sessions(paths: Iterable[Path]) -> list[SessionFiles]:
    """Which files belong together: each session's, in the order of its parts.

    A file that does not tell stands for itself.  Raises BadRecordError and OSError.
    """
    found: dict[str, list[tuple[int, Path]]] = {}
    for path in dict.fromkeys(paths):
        name, part = _place(path)
        if any(part == other for other, _ in found.get(name, ())):
            name = str(path)  # a copy of a file that is there
        found.setdefault(name, []).append((part, path))
    return [SessionFiles([path for _, path in sorted(parts)]) for parts in found.values()]


def _place(path: Path) -> tuple[str, int]:
    """Which session a file is of, and which part of it: its first input tells."""
    for message in _messages(Reading(path)):
        if message.topic != INPUT_TOPIC:
            continue
        try:
            said = msgspec.json.decode(message.data, type=InputMessage)
            match kept_of(said.kind, said.data, {}):
                case PartBegan(part, of):
                    return of, part
                case Start(setup):
                    return Path(setup.log_path).stem or str(path), 1
        except (msgspec.MsgspecError, UnicodeDecodeError, CannotReadError):
            pass
        break
    return str(path), 1


def _messages(reading: Reading, numbers: Numbers | None = None) -> Iterator[Stored]:
    channels: dict[int, tuple[str, int | None]] = {}
    for record in reading:
        if isinstance(record, Message):
            channel = channels.get(record.channel_id)
            if numbers is not None:
                numbers.message(record)
            if channel is not None:
                topic, length = channel
                yield Stored(topic, record.log_time_ns, record.data, length)
        elif isinstance(record, Channel):
            channels[record.id] = record.topic, payload_length(record.metadata)
