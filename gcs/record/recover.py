"""`gcs log recover`: makes a killed file whole."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from mcap.records import Attachment, Channel, Metadata, Schema
from mcap.writer import CompressionType, Writer

from gcs.record.backend import CHUNK_BYTES
from gcs.record.reading import Condition, Message, Reading


@dataclass(slots=True)
class Recovery:
    """What was saved.  `condition` tells what was wrong with the source."""

    condition: Condition
    messages: int = 0
    attachments: int = 0
    metadata: int = 0
    orphans: int = 0
    """Messages whose channel is in no readable record."""
    start_ns: int | None = None
    end_ns: int | None = None

    @property
    def seconds(self) -> float:
        """From the first recovered message to the last."""
        if self.start_ns is None or self.end_ns is None:
            return 0.0
        return (self.end_ns - self.start_ns) / 1e9


def recover(
    source: Path, target: Path, progress: Callable[[Condition], None] | None = None
) -> Recovery:
    """Copy all that can be read of `source` into the new file `target`, indexes and all.

    `progress` is called now and then.  Raises BadRecordError, and OSError (FileExistsError where
    `target` exists).
    """
    reading = Reading(source)
    with closing(iter(reading)) as records:
        first = next(records, None)  # no target is made for a source that is no MCAP
        with open(target, "xb") as file:
            copy = _Copy(Writer(file, CHUNK_BYTES, CompressionType.LZ4), reading.condition)
            if first is not None:
                copy.add(first)
            for number, record in enumerate(records):
                copy.add(record)
                if progress is not None and number % 4096 == 0:
                    progress(reading.condition)
            return copy.finish()


class _Copy:
    """One file being written, with ids of its own for schemas and channels."""

    def __init__(self, writer: Writer, condition: Condition) -> None:
        self._writer = writer
        self._writer.start()
        self._result = Recovery(condition)
        self._schemas: dict[int, int] = {0: 0}
        self._channels: dict[int, int] = {}

    def add(self, record: Schema | Channel | Message | Attachment | Metadata) -> None:
        match record:
            case Message():
                self._message(record)
            case Schema(id=number) if number not in self._schemas:
                self._schemas[number] = self._writer.register_schema(
                    record.name, record.encoding, record.data
                )
            case Channel(id=number) if number not in self._channels:
                self._channels[number] = self._writer.register_channel(
                    record.topic,
                    record.message_encoding,
                    self._schemas.get(record.schema_id, 0),
                    record.metadata,
                )
            case Attachment():
                self._result.attachments += 1
                self._writer.add_attachment(
                    record.create_time,
                    record.log_time,
                    record.name,
                    record.media_type,
                    record.data,
                )
            case Metadata():
                self._result.metadata += 1
                self._writer.add_metadata(record.name, record.metadata)
            case Schema() | Channel():
                pass  # repeated, as every part of a summary is

    def finish(self) -> Recovery:
        self._writer.finish()  # type: ignore[no-untyped-call]  # mcap leaves it bare
        return self._result

    def _message(self, message: Message) -> None:
        result = self._result
        channel_id = self._channels.get(message.channel_id)
        if channel_id is None:
            result.orphans += 1
            return
        self._writer.add_message(
            channel_id,
            message.log_time_ns,
            message.data,
            message.publish_time_ns,
            message.sequence,
        )
        result.messages += 1
        at_ns = message.log_time_ns
        result.start_ns = at_ns if result.start_ns is None else min(result.start_ns, at_ns)
        result.end_ns = at_ns if result.end_ns is None else max(result.end_ns, at_ns)
