"""The flight recorder: all that a session reports, in one MCAP, whatever the disk does.

    recording --OSError--> lost --5 s--> recording, in <name>_part2.mcap, _part3 ...

Once it is open, no method raises.  When the disk fails, `failed` is set in the same call; `tick`
then tells since when nothing is recorded, and tries to begin a new part every 5 s.  A process that
is killed loses what was written since the last flush, at most `FLUSH_NS` and one tick.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import TypeAlias
from zlib import crc32

from gcs.mcap_file.writer import (
    Backend,
    Channel,
    GuardedFile,
    Log,
    NoFile,
    Opener,
    best_backend,
    open_exclusive,
)
from gcs.record import ros1
from gcs.record.derived import Derived
from gcs.record.parts import (
    NEVER,
    PartBegan,
    RecordLost,
    RecordNews,
    RecordResumed,
    RecordRotated,
    Rotation,
    Seal,
)
from gcs.record.topics import INPUT_TOPIC, Out
from gcs.report import (
    AttachmentItem,
    FrameItem,
    FramesItem,
    GarbageItem,
    InputItem,
    MetadataItem,
    RecordItem,
)
from gcs.wire.blanking import SETUP_SIGNING, without_key, without_keys
from gcs.wire.frame import msgid_in
from gcs.wire.signing import Reason

FLUSH_NS = 800_000_000
"""With a turn of the loop, a kill loses less than a second."""
RETRY_NS = 5_000_000_000
MAX_FRAME_CHANNELS = 4096
"""An MCAP numbers channels with 16 bits; forged system ids must not use them up."""

REFUSED = frozenset(reason.value for reason in Reason)
"""Why a frame came to be garbage: it is a good one, and must stay one, or no audit finds it."""

_SAME_SECOND_NAMES = 100
"""Names that are tried for a session."""
_PART_NAMES = 10_000
"""Names that are tried for its next part."""


class RecorderError(Exception):
    """The record could not be opened at start: `path` and what the system said."""

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(f"{path}: cannot record: {reason}")
        self.path = path
        self.reason = reason


_FrameLog: TypeAlias = tuple[Log, ros1.Encode, Callable[..., bytes], int]
"""Of one kind of message: its channel, how a frame becomes a message of it, and the same without a
call for unsigned MAVLink 2 frames whose payload ends by that byte (0: for none)."""

Watch: TypeAlias = Callable[[Channel, bytes, int, str], None]
"""(channel, message, log_time in ns, latch): is told of every message; see `Out` for `latch`."""


class Recorder:
    """Items in, MCAP out.  Times are log_time: ns of the one clock, made strictly increasing."""

    def __init__(
        self,
        directory: Path,
        stem: str,
        backend: Backend,
        opener: Opener,
        now_ns: int,
        *,
        sealed: bool = False,
        rotation: Rotation = NEVER,
    ) -> None:
        """Call `Recorder.open` instead."""
        self._seals = sealed
        self._rotation = rotation
        self._directory = directory
        self._stem = stem
        self._backend = backend
        self._opener = opener
        self._derived = Derived()
        self._logs: dict[str, Log] = {}
        self._frame_logs: dict[bytes, _FrameLog] = {}
        self._channels: dict[str, Channel] = {}
        self._watch: Watch | None = None
        self._latched: dict[tuple[str, str], Out] = {}
        self._kept: dict[str, AttachmentItem | MetadataItem] = {}
        self._unsealed: list[bytes] = []
        """Messages since the last seal."""
        self._sealed = 0
        """Messages before those."""
        self._last_ns = now_ns - 1
        self._safe_ns = now_ns
        self._flush_at_ns = now_ns + FLUSH_NS
        self._retry_at_ns = 0
        self._loss_told = False
        self._file: GuardedFile | None = None
        self._bytes_before = 0
        self._began_ns = now_ns
        self._lossless = True
        self.path = directory / f"{stem}.mcap"
        self.parts: list[Path] = []
        self._leftovers: list[Path] = []

    @classmethod
    def open(
        cls,
        directory: Path,
        name: str,
        started_text: str,
        now_ns: int,
        *,
        backend: Backend | None = None,
        opener: Opener = open_exclusive,
        sealed: bool = False,
        rotation: Rotation = NEVER,
    ) -> Recorder:
        """Start `<directory>/<started_text>_<name>.mcap`; `started_text` is YYYYMMDD-HHMMSS.

        The folder is made where it is missing; a second session of the same second gets -2, -3.
        `sealed`: the record of a session, which is audited, has a `Seal` at every flush.
        Raises RecorderError.
        """
        base = f"{started_text}_{re.sub(r'[^A-Za-z0-9._-]+', '-', name) or 'flight'}"
        backend = backend or best_backend()
        try:
            directory.mkdir(parents=True, exist_ok=True)
            for number in range(1, _SAME_SECOND_NAMES):
                stem = base if number == 1 else f"{base}-{number}"
                recorder = cls(
                    directory, stem, backend, opener, now_ns, sealed=sealed, rotation=rotation
                )
                try:
                    recorder._start(recorder.path, now_ns)
                except FileExistsError:
                    continue
                return recorder
        except OSError as error:
            raise RecorderError(directory, error.strerror or str(error)) from error
        raise RecorderError(directory / f"{base}.mcap", "the name is taken")

    @classmethod
    def without_file(cls, backend: Backend, now_ns: int) -> Recorder:
        """A recorder of a session whose messages go to `backend` alone."""
        recorder = cls(Path(), "", backend, lambda _: NoFile(), now_ns, sealed=True)
        recorder._start(Path(), now_ns)
        return recorder

    # ------------------------------------------------------------------------------ state

    @property
    def failed(self) -> bool:
        """Nothing is being recorded."""
        return self._file is None or self._file.failure is not None

    @property
    def deadline_ns(self) -> int:
        """When `tick` has something to do."""
        if not self.failed:
            return self._flush_at_ns
        return self._retry_at_ns if self._loss_told else self._last_ns

    @property
    def bytes_written(self) -> int:
        """Of all parts."""
        return self._bytes_before + self._file_bytes

    @property
    def _file_bytes(self) -> int:
        return self._file.written if self._file is not None else 0

    # ---------------------------------------------------------------------------- watching

    @property
    def channels(self) -> list[Channel]:
        """All that messages were written to so far."""
        return list(self._channels.values())

    @property
    def last_ns(self) -> int:
        """log_time of the latest message."""
        return self._last_ns

    @property
    def latched(self) -> list[Out]:
        """The last word on everything that is said only once, as the next part begins with."""
        return list(self._latched.values())

    def watch(self, watch: Watch | None) -> None:
        """Tell `watch` of every message from now on, whether or not it reaches the disk.

        Without a watch a frame costs what it did before: its channel is looked up anew when that
        changes.
        """
        self._watch = watch
        self._frame_logs.clear()

    # ------------------------------------------------------------------------------ input

    def write(self, item: RecordItem, now_ns: int) -> None:
        """Record one item.  Look at `failed` afterwards."""
        if type(item) is FramesItem:
            self._write_frames(item.link, item.direction, item.raws, now_ns)
        elif type(item) is FrameItem:
            self._write_frames(item.link, item.direction, (item.raw,), now_ns)
        else:
            self._write_other(item, now_ns)

    def _write_frames(self, link: int, direction: int, raws: Sequence[bytes], now_ns: int) -> None:
        """All that is received passes through this loop, so it stays in one piece."""
        logs, keep = self._frame_logs.get, self._unsealed.append
        seals, last_ns = self._seals, self._last_ns
        if now_ns <= last_ns:
            now_ns = last_ns + 1
        for raw in raws:
            try:
                v2 = raw[0] == ros1.MAGIC_V2
                key = raw[5:10] if v2 else raw[3:6]
                log, encode, pack, most = logs(key) or self._new_frame_log(key, raw)
                end = raw[1] + 10
                if v2 and end <= most and len(raw) == end + 2:  # as `Codec.encode` does it
                    message = pack(link, direction, raw, raw[10:end], 2, raw[end:])
                else:
                    message = encode(raw, link, direction)
            except (struct.error, IndexError):
                # Not a whole frame, whatever the sender of the item believes: kept all the same.
                self._write_other(GarbageItem(link, raw, "malformed"), now_ns)
                now_ns = self._last_ns + 1
                continue
            self._last_ns = now_ns
            log(message, now_ns)
            if seals:
                keep(message)
            now_ns += 1

    def tick(self, now_ns: int) -> list[RecordNews]:
        """Flush when it is time, write what is due by the clock, begin a new part after a failure
        or where the file has become too large or too old."""
        if not self.failed and now_ns >= self._flush_at_ns:
            self.repeat(now_ns)
            self._flush(now_ns)
        news: list[RecordNews] = []
        if self._rotation.due(self._file_bytes, now_ns - self._began_ns) and not self.failed:
            news += self._rotate(now_ns)
        return news + (self._recover(now_ns) if self.failed else [])

    def close(self, now_ns: int) -> bool:
        """Finish the file; whether all that was recorded reached the disk."""
        if self._file is None:
            return False
        self.end(now_ns)
        self._finish()
        return self._file.failure is None and self._lossless

    def discard(self, now_ns: int) -> None:
        """Close, and leave no file: there was nothing to record."""
        self.close(now_ns)
        self._leftovers += self.parts
        self._remove_leftovers()

    # --------------------------------------------------------------------------- recording

    def repeat(self, now_ns: int) -> None:
        """Write what is due by the clock alone, behind a `RecordTick`: what the audit repeats.

        Before anything is recorded there is nothing to repeat, and a session's record begins with
        its set-up.
        """
        if not self._channels:
            return
        now_ns = self.next_ns(now_ns)
        self._seal("RecordTick", now_ns)
        self._emit(self._derived.tick(now_ns), now_ns)

    def end(self, now_ns: int) -> None:
        """Write what belongs at the end, behind a `RecordEnd`."""
        now_ns = self.next_ns(now_ns)
        self._seal("RecordEnd", now_ns)
        self._emit(self._derived.close(now_ns), now_ns)

    def input_ns(self, now_ns: int) -> int:
        """When the next input is to be handled: `now_ns`, or so much later that a nanosecond
        remains free before the log_time of its first message.

        What is recorded of one input has no such gap, so it shows where each input begins.
        """
        return max(now_ns, self._last_ns + 2)

    def next_ns(self, now_ns: int) -> int:
        """`now_ns`, or the first log_time that is free after what is recorded."""
        return max(now_ns, self._last_ns + 1)

    def _seal(self, kind: str, now_ns: int) -> None:
        """Write how many messages there were and the checksum of those since the last seal."""
        if not self._seals:
            return
        checksum = crc32(b"".join(self._unsealed))
        self._drop_unsealed()
        self._write_other(InputItem.of(kind, Seal(self._sealed, checksum)), now_ns)

    def _drop_unsealed(self) -> None:
        self._sealed += len(self._unsealed)
        self._unsealed.clear()

    def _log_message(self, log: Log, message: bytes, now_ns: int) -> None:
        self._last_ns = self.next_ns(now_ns)
        log(message, self._last_ns)
        if self._seals:
            self._unsealed.append(message)

    def _write_other(self, item: RecordItem, now_ns: int) -> None:
        match item:
            case GarbageItem(link, raw, reason):
                log = self._watched_log(ros1.garbage_channel(link))
                kept = without_key(raw) if reason in REFUSED else without_keys(raw)
                message = ros1.encode_garbage(reason, kept)
                self._log_message(log, message, now_ns)
            case AttachmentItem(name):
                self._keep_once(f"attachment {name}", item, now_ns)
            case MetadataItem(name):
                self._keep_once(f"metadata {name}", item, now_ns)
            case InputItem():
                # An audit takes the input for the first of what is recorded of it.
                outs = self._derived.handle(item, now_ns)
                self._emit(sorted(outs, key=lambda out: out.channel.topic != INPUT_TOPIC), now_ns)
            case _:
                self._emit(self._derived.handle(item, now_ns), now_ns)

    def _new_frame_log(self, key: bytes, raw: bytes) -> _FrameLog:
        if len(self._frame_logs) >= MAX_FRAME_CHANNELS:
            crowd = ros1.codec(0)
            return self._watched_log(ros1.crowd_channel()), crowd.encode, crowd.pack_plain, 0
        msgid = msgid_in(raw)
        log = self._watched_log(ros1.frame_channel(*ros1.source_of(raw), msgid))
        codec = ros1.codec(ros1.full_length(msgid))
        if msgid == SETUP_SIGNING:
            known = log, _without_key(codec.encode), codec.pack_plain, 0
        else:
            known = log, codec.encode, codec.pack_plain, codec.plain_end
        self._frame_logs[key] = known
        return known

    def _log(self, channel: Channel) -> Log:
        log = self._logs.get(channel.topic)
        if log is None:
            log = self._logs[channel.topic] = self._backend.channel(channel)
            self._channels[channel.topic] = channel
        return log

    def _watched_log(self, channel: Channel) -> Log:
        """The channel's log; with a watch, one that tells it too."""
        log, watch = self._log(channel), self._watch
        if watch is None:
            return log

        def log_and_tell(message: bytes, log_time_ns: int) -> None:
            log(message, log_time_ns)
            watch(channel, message, log_time_ns, "")

        return log_and_tell

    def _emit(self, outs: list[Out], now_ns: int) -> None:
        for out in outs:
            if out.latch:
                self._latched[out.channel.topic, out.latch] = out
            self._log_message(self._log(out.channel), out.message, now_ns)
            if self._watch is not None:
                self._watch(out.channel, out.message, self._last_ns, out.latch)

    def _keep_once(self, key: str, item: AttachmentItem | MetadataItem, now_ns: int) -> None:
        """What is there already, word for word, is not written a second time."""
        if self._kept.get(key) != item:
            self._kept[key] = item
            self._keep(item, now_ns)

    def _keep(self, item: AttachmentItem | MetadataItem, now_ns: int) -> None:
        match item:
            case AttachmentItem(name, media_type, data):
                self._backend.attach(name, media_type, data, now_ns)
            case MetadataItem(name, values):
                self._backend.metadata(name, dict(values))

    # --------------------------------------------------------------------------- the file

    def _start(self, path: Path, now_ns: int) -> None:
        """Begin a part; what is said only once in a record is repeated in it.  Raises OSError."""
        self._began_ns = now_ns
        self._file = GuardedFile(self._opener(path))
        self.path = path
        self.parts.append(path)
        self._backend.open(self._file)
        for item in self._kept.values():
            self._keep(item, now_ns)
        if self._seals and len(self.parts) > 1:
            self._begin_part(now_ns)
        self._emit(list(self._latched.values()), now_ns)

    def _begin_part(self, now_ns: int) -> None:
        """Say that there are files before this one, and how many messages are but repeated."""
        self._drop_unsealed()
        part = PartBegan(len(self.parts), self._stem, len(self._latched), self._sealed)
        self._write_other(InputItem.of("RecordPart", part), now_ns)
        self._sealed -= len(self._latched)  # they are written next, and do not count

    def _flush(self, now_ns: int) -> None:
        # The grid is kept, a missed flush is not made up for.
        late_ns = now_ns - self._flush_at_ns
        self._flush_at_ns += FLUSH_NS * (late_ns // FLUSH_NS + 1)
        self._backend.flush()
        if not self.failed:
            self._safe_ns = now_ns

    def _finish(self) -> None:
        assert self._file is not None
        self._backend.close()
        self._file.close()

    def _rotate(self, now_ns: int) -> list[RecordNews]:
        """Close the file in order and begin the next; where that fails, the disk has failed."""
        closed = self._file
        self._drop_file()
        if closed is None or closed.failure is not None:
            return []
        try:
            self._start_next_part(now_ns)
        except OSError:
            return []
        self._backend.flush()
        return [] if self.failed else [RecordRotated(self.path)]

    def _recover(self, now_ns: int) -> list[RecordNews]:
        self._lossless = False
        self._drop_unsealed()
        if not self._loss_told:
            self._loss_told = True
            self._retry_at_ns = now_ns + RETRY_NS
            reason = self._drop_file()
            return [RecordLost(self.path, self._safe_ns, reason)]
        if now_ns < self._retry_at_ns:
            return []
        self._retry_at_ns = now_ns + RETRY_NS
        return self._retry(now_ns)

    def _drop_file(self) -> str:
        if self._file is None:
            return "the next file could not be begun"
        failure = self._file.failure
        self._finish()
        self._bytes_before += self._file.written
        self._file = None
        return (failure.strerror or str(failure)) if failure is not None else "closed"

    def _retry(self, now_ns: int) -> list[RecordNews]:
        """Begin the next part.  It counts once its first flush is on the disk."""
        self._remove_leftovers()
        since_ns = self._safe_ns
        try:
            self._start_next_part(now_ns)
        except OSError:
            return []
        self._backend.flush()
        if self.failed:
            self._give_up_part()
            return []
        self._loss_told = False
        self._safe_ns = now_ns
        self._flush_at_ns = now_ns + FLUSH_NS
        return [RecordResumed(self.path, since_ns, now_ns)]

    def _start_next_part(self, now_ns: int) -> None:
        """In the first file whose name is free.  Raises OSError."""
        first = len(self.parts) + 1
        for number in range(first, first + _PART_NAMES):
            with suppress(FileExistsError):
                self._start(self._directory / f"{self._stem}_part{number}.mcap", now_ns)
                return
        raise FileExistsError(f"{self._stem}_part{first}.mcap and the names after it are taken")

    def _give_up_part(self) -> None:
        """The part that was just begun does not reach the disk: it never was."""
        bytes_before = self._bytes_before
        self._drop_file()
        self._bytes_before = bytes_before
        self._leftovers.append(self.parts.pop())
        self.path = self.parts[-1]
        self._remove_leftovers()

    def _remove_leftovers(self) -> None:
        """Files of parts that were given up; one that cannot be removed yet stays in the list."""
        self._leftovers = [path for path in self._leftovers if not _removed(path)]


def _removed(path: Path) -> bool:
    try:
        path.unlink(missing_ok=True)
    except OSError:
        return False
    return True


def _without_key(encode: ros1.Encode) -> ros1.Encode:
    """For SETUP_SIGNING: the record has all of the frame but the key."""
    return lambda raw, link, direction: encode(without_key(raw), link, direction)
