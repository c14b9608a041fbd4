"""Writes an MCAP message by message: foxglove-sdk where its wheel exists, `mcap.Writer` elsewhere.

A backend lives as long as the session, a file as long as the disk lets it: channels are made
once and log into whatever file is open, or into none.  The libraries give up for good, and
silently, at the first error of their output.  So their output is a `GuardedFile`, which never
raises: an OSError is kept in `failure`, what follows is swallowed, and the recorder looks at
`failure` after every write.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from os import SEEK_CUR
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, TypeAlias

if TYPE_CHECKING:
    import foxglove
    from foxglove.mcap import MCAPWriter
    from mcap.writer import Writer

CHUNK_BYTES = 256 * 1024

Log: TypeAlias = Callable[[bytes, int], None]
"""(message, log_time in ns): put one message on the channel that this belongs to."""


@dataclass(frozen=True, slots=True)
class Channel:
    """A topic and how its messages are to be read."""

    topic: str
    message_encoding: str
    schema_name: str
    schema_encoding: str
    schema: bytes
    metadata: tuple[tuple[str, str], ...] = ()


class RawFile(Protocol):
    """What a guarded file needs of an unbuffered file."""

    def write(self, data: memoryview, /) -> int | None: ...
    def close(self) -> None: ...


Opener: TypeAlias = Callable[[Path], RawFile]
"""Opens a new file for writing; raises OSError (FileExistsError where it exists)."""


def open_exclusive(path: Path) -> RawFile:
    """The default opener: `xb`, unbuffered, so that nothing waits in this process for a crash."""
    return open(path, "xb", buffering=0)


class NoFile:
    """Takes everything and keeps nothing."""

    def write(self, data: memoryview, /) -> int:
        return len(data)

    def close(self) -> None:
        """Nothing is open."""


class GuardedFile:
    """Append-only bytes on disk.  After the first OSError nothing more is written, silently.

    `seek` goes nowhere but to the present position: an MCAP writer that was told not to seek
    asks only where it is.
    """

    __slots__ = ("_position", "_raw", "failure", "written")

    def __init__(self, raw: RawFile) -> None:
        self._raw = raw
        self._position = 0
        self.written = 0
        """Bytes that the system took for the file."""
        self.failure: OSError | None = None

    def write(self, data: bytes | bytearray) -> int:
        """Write all of `data`.  Returns len(data) even after a failure: look at `failure`."""
        self._position += len(data)
        if self.failure is None:
            rest = memoryview(data)
            try:
                while rest:
                    count = self._raw.write(rest) or 0
                    self.written += count
                    rest = rest[count:]
            except OSError as error:
                self.failure = error
        return len(data)

    def seek(self, offset: int, whence: int = 0) -> int:
        """Only `seek(0, SEEK_CUR)` and `seek(position)`.  Raises ValueError for anything else."""
        if (offset, whence) not in ((0, SEEK_CUR), (self._position, 0)):
            raise ValueError("a guarded file is written from its beginning to its end")
        return self._position

    def tell(self) -> int:
        return self._position

    def flush(self) -> None:
        """Nothing is buffered here."""

    def close(self) -> None:
        try:
            self._raw.close()
        except OSError as error:
            self.failure = self.failure or error


class Backend(Protocol):
    """One session's writer.  A topic may be asked for once only; no method raises OSError."""

    def channel(self, channel: Channel) -> Log: ...
    def open(self, file: GuardedFile) -> None: ...
    def flush(self) -> None:
        """End the chunk: what was logged so far is in the file."""
        ...

    def attach(self, name: str, media_type: str, data: bytes, log_time_ns: int) -> None: ...
    def metadata(self, name: str, values: dict[str, str]) -> None: ...
    def close(self) -> None:
        """Finish the file; without an open one nothing happens."""
        ...


class FoxgloveBackend:
    """The SDK's writer."""

    def __init__(self) -> None:
        import foxglove
        from foxglove.mcap import MCAPCompression, MCAPWriteOptions

        # A root handler that writes to this MCAP would recurse on the SDK's own complaints.
        logging.getLogger("foxglove").propagate = False
        self._foxglove = foxglove
        self.context: foxglove.Context = foxglove.Context()
        self._options = MCAPWriteOptions(
            compression=MCAPCompression.Lz4,
            chunk_size=CHUNK_BYTES,
            disable_seeking=True,
            compression_threads=0,
        )
        self._writer: MCAPWriter | None = None

    def channel(self, channel: Channel) -> Log:
        made = self._foxglove.Channel(
            channel.topic,
            message_encoding=channel.message_encoding,
            schema=self._foxglove.Schema(
                name=channel.schema_name, encoding=channel.schema_encoding, data=channel.schema
            ),
            metadata=dict(channel.metadata),
            context=self.context,
        )
        return made.base.log

    def open(self, file: GuardedFile) -> None:
        self._writer = self._foxglove.open_mcap(
            file, context=self.context, writer_options=self._options
        )

    def flush(self) -> None:
        if self._writer is not None:
            self._writer.flush()

    def attach(self, name: str, media_type: str, data: bytes, log_time_ns: int) -> None:
        if self._writer is not None:
            self._writer.attach(
                log_time=log_time_ns,
                create_time=log_time_ns,
                name=name,
                media_type=media_type,
                data=data,
            )

    def metadata(self, name: str, values: dict[str, str]) -> None:
        if self._writer is not None:
            self._writer.write_metadata(name, values)

    def close(self) -> None:
        if self._writer is not None:
            writer, self._writer = self._writer, None
            writer.close()


class McapBackend:
    """The pure-Python writer: the same file, three times slower."""

    def __init__(self) -> None:
        self._writer: Writer | None = None
        self._ids: dict[str, int] = {}

    def channel(self, channel: Channel) -> Log:
        def log(message: bytes, log_time_ns: int) -> None:
            writer = self._writer
            if writer is None:
                return
            number = self._ids.get(channel.topic)
            if number is None:
                number = self._ids[channel.topic] = _register(writer, channel)
            writer.add_message(
                channel_id=number, log_time=log_time_ns, publish_time=log_time_ns, data=message
            )

        return log

    def open(self, file: GuardedFile) -> None:
        from mcap.writer import CompressionType, Writer

        self._ids.clear()
        # The writer asks only for write, tell and flush of what it calls an IO.
        self._writer = Writer(
            file,  # type: ignore[arg-type]
            chunk_size=CHUNK_BYTES,
            compression=CompressionType.LZ4,
        )
        self._writer.start()

    def flush(self) -> None:
        if self._writer is not None:
            self._writer.flush()  # type: ignore[no-untyped-call]  # mcap leaves it bare

    def attach(self, name: str, media_type: str, data: bytes, log_time_ns: int) -> None:
        if self._writer is not None:
            self._writer.add_attachment(log_time_ns, log_time_ns, name, media_type, data)

    def metadata(self, name: str, values: dict[str, str]) -> None:
        if self._writer is not None:
            self._writer.add_metadata(name, values)

    def close(self) -> None:
        if self._writer is not None:
            writer, self._writer = self._writer, None
            writer.finish()  # type: ignore[no-untyped-call]  # mcap leaves it bare


def _register(writer: Writer, channel: Channel) -> int:
    schema_id = writer.register_schema(channel.schema_name, channel.schema_encoding, channel.schema)
    return writer.register_channel(
        channel.topic, channel.message_encoding, schema_id, dict(channel.metadata)
    )


def best_backend() -> Backend:
    """foxglove-sdk where it is installed."""
    return FoxgloveBackend() if find_spec("foxglove") else McapBackend()
