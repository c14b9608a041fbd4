"""A new MCAP made of the records of others: what recover, compact, cut and merge share."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from mcap.writer import CompressionType, Writer

from gcs.mcap_file.format import Attachment, Channel, Message, Metadata, Record, Schema

CHUNK_BYTES = 1024 * 1024
"""Of a file that is written at leisure: a small index, quickly searched.  The recorder's own are
as small as its flushes make them."""

_NO_SCHEMA = Schema(id=0, name="", encoding="", data=b"")


class Target:
    """The file that is being written.  Channels that are word for word the same are one."""

    def __init__(self, writer: Writer) -> None:
        self._writer = writer
        self._schemas: dict[tuple[str, str, bytes], int] = {}
        self._channels: dict[tuple[str, str, int, tuple[tuple[str, str], ...]], int] = {}
        self.messages = 0
        self.attachments = 0
        self.metadata = 0
        self.start_ns: int | None = None
        self.end_ns: int | None = None

    @property
    def seconds(self) -> float:
        """From the earliest message to the latest."""
        if self.start_ns is None or self.end_ns is None:
            return 0.0
        return (self.end_ns - self.start_ns) / 1e9

    def channel(self, channel: Channel, schema: Schema) -> int:
        """The number that such a channel has in this file."""
        values = tuple(sorted(channel.metadata.items()))
        key = channel.topic, channel.message_encoding, self._schema(schema), values
        number = self._channels.get(key)
        if number is None:
            number = self._channels[key] = self._writer.register_channel(*key[:3], dict(values))
        return number

    def _schema(self, schema: Schema) -> int:
        if schema.id == 0:
            return 0
        key = schema.name, schema.encoding, schema.data
        number = self._schemas.get(key)
        if number is None:
            number = self._schemas[key] = self._writer.register_schema(*key)
        return number

    def message(self, channel_id: int, message: Message) -> None:
        """Add a message to the channel that has this number here."""
        at_ns = message.log_time_ns
        self._writer.add_message(
            channel_id, at_ns, message.data, message.publish_time_ns, message.sequence
        )
        self.messages += 1
        if self.start_ns is None or self.end_ns is None:
            self.start_ns = self.end_ns = at_ns
        elif at_ns > self.end_ns:
            self.end_ns = at_ns
        elif at_ns < self.start_ns:
            self.start_ns = at_ns

    def attach(self, record: Attachment | Metadata) -> None:
        match record:
            case Attachment():
                self.attachments += 1
                self._writer.add_attachment(
                    record.create_time,
                    record.log_time,
                    record.name,
                    record.media_type,
                    record.data,
                )
            case Metadata():
                self.metadata += 1
                self._writer.add_metadata(record.name, record.metadata)


class Source:
    """One file that is read: its schemas and channels, by the numbers that they have in it."""

    def __init__(self) -> None:
        self.schemas: dict[int, Schema] = {0: _NO_SCHEMA}
        self.channels: dict[int, Channel] = {}
        self.orphans = 0
        """Messages whose channel is in no readable record."""
        self._targets: dict[int, int] = {}

    def learn(self, record: Schema | Channel) -> None:
        """A summary repeats them: the first of each number counts."""
        match record:
            case Schema(id=number):
                self.schemas.setdefault(number, record)
            case Channel(id=number):
                self.channels.setdefault(number, record)

    def schema_of(self, channel: Channel) -> Schema:
        return self.schemas.get(channel.schema_id, _NO_SCHEMA)

    def channel_in(self, target: Target, message: Message) -> int | None:
        """The number of the message's channel in `target`; None for an orphan."""
        number = self._targets.get(message.channel_id)
        if number is None:
            channel = self.channels.get(message.channel_id)
            if channel is None:
                self.orphans += 1
                return None
            number = self._targets[channel.id] = target.channel(channel, self.schema_of(channel))
        return number

    def copy(self, record: Record, target: Target) -> None:
        """Whatever the record is, it goes to `target`."""
        match record:
            case Message():
                number = self.channel_in(target, record)
                if number is not None:
                    target.message(number, record)
            case Schema() | Channel():
                self.learn(record)
            case Attachment() | Metadata():
                target.attach(record)


@contextmanager
def new_record(path: Path) -> Iterator[Target]:
    """A new file with chunks of `CHUNK_BYTES`; none is left where the block raises.

    Raises OSError (FileExistsError where it exists).
    """
    with open(path, "xb") as file:
        try:
            writer = Writer(file, CHUNK_BYTES, CompressionType.ZSTD)
            writer.start()
            yield Target(writer)
            writer.finish()  # type: ignore[no-untyped-call]  # mcap leaves it bare
        except BaseException:
            file.close()
            path.unlink(missing_ok=True)
            raise
