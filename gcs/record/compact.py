"""Rewrites a finished record in larger chunks: a quarter smaller, opened in a moment.

The recorder ends a chunk at every flush, so that a kill loses little; a viewer has then thousands
of them to look through.  The new file takes the old one's place once it is on the disk and
has been read back; until then, and after any error, the old one stays as it is.

The station starts `python -m gcs.record.compact FILE...` when it ends, and does not wait for it.
"""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from collections import Counter
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from tempfile import TemporaryFile
from zlib import crc32

from gcs.mcap_file.copier import Source, new_record
from gcs.mcap_file.errors import BadRecordError
from gcs.mcap_file.format import Attachment, Channel, Message, Metadata, Record, Schema
from gcs.mcap_file.index_check import wrong_with_index
from gcs.mcap_file.reader import Progress, Reading

SMALL_BYTES = 1_000_000
"""Smaller files open at once as they are."""
STALE_S = 60.0
"""A copy that nobody has written to for so long was left by a process that was killed."""
_NICENESS = 10


class NotCompactedError(Exception):
    """The file stays as it is: why."""


@dataclass(frozen=True, slots=True)
class Compaction:
    """What was done.  Bytes."""

    messages: int
    bytes_before: int
    bytes_after: int


def compact(path: Path, progress: Progress | None = None) -> Compaction:
    """Rewrite `path`; its messages, their order, and its time of change stay the same.

    Raises NotCompactedError, BadRecordError and OSError; the file is then as it was.
    """
    copy = path.with_name(f".{path.name}.compacting")
    _remove_stale(copy)
    before = path.stat()
    try:
        old = _rewrite(path, copy, progress)
        new = _digest_of(copy)
        if new != old or any(wrong_with_index(copy, new.counts)):
            raise NotCompactedError("the copy does not read back as the original")
        _to_disk(copy)
        shutil.copystat(path, copy)
        now = path.stat()
        if (now.st_size, now.st_mtime_ns) != (before.st_size, before.st_mtime_ns):
            raise NotCompactedError("it was changed meanwhile")
        after_bytes = copy.stat().st_size
        os.replace(copy, path)
    except FileExistsError as error:
        raise NotCompactedError("it is being compacted already") from error
    except BaseException:
        copy.unlink(missing_ok=True)
        raise
    return Compaction(old.messages, before.st_size, after_bytes)


@dataclass(slots=True)
class _Digest:
    """What two files must have in common: all that a reader is given, in order."""

    messages: int = 0
    messages_crc: int = 0
    others_crc: int = 0
    counts: Counter[int] = field(default_factory=Counter, compare=False)
    """Messages by channel, which has another number in each file."""

    def add(self, record: Record, topics: dict[int, bytes]) -> None:
        match record:
            case Message():
                self.messages += 1
                self.counts[record.channel_id] += 1
                head = b"%d %d %d " % record[1:4] + topics.get(record.channel_id, b"?")
                self.messages_crc = crc32(record.data, crc32(head, self.messages_crc))
            case Channel(id=number, topic=topic):
                topics.setdefault(number, topic.encode(errors="surrogateescape"))
            case Attachment():
                head = repr((record.name, record.media_type, record.log_time)).encode()
                self.others_crc = crc32(record.data, crc32(head, self.others_crc))
            case Metadata():
                head = repr((record.name, sorted(record.metadata.items()))).encode()
                self.others_crc = crc32(head, self.others_crc)
            case Schema():
                pass


def _rewrite(path: Path, copy: Path, progress: Progress | None) -> _Digest:
    reading, source = Reading(path, progress), Source()
    digest, topics = _Digest(), dict[int, bytes]()
    with new_record(copy) as target:
        for record in reading:
            digest.add(record, topics)
            source.copy(record, target)
        condition = reading.condition
        if not condition.closed or condition.damaged or source.orphans:
            raise NotCompactedError("it is not whole: gcs log recover")
    return digest


def _digest_of(path: Path) -> _Digest:
    digest, topics = _Digest(), dict[int, bytes]()
    for record in Reading(path):
        digest.add(record, topics)
    return digest


def _to_disk(path: Path) -> None:
    with open(path, "rb+") as file:
        os.fsync(file.fileno())


def _remove_stale(copy: Path) -> None:
    """What a compaction left that was killed; one that is at work writes to it all the time."""
    with suppress(OSError), TemporaryFile(dir=copy.parent) as new:
        # The disk's own clock, which may be another machine's.
        if os.fstat(new.fileno()).st_mtime - copy.stat().st_mtime > STALE_S:
            copy.unlink()


# --------------------------------------------------------------------------- at a station's end


def compact_in_background(paths: Sequence[Path]) -> None:
    """Start a process that compacts the larger ones of these, and forget it.

    It outlives this process and its terminal: a Ctrl-C there does not reach it.
    """
    large = [str(path) for path in paths if _size(path) >= SMALL_BYTES]
    if not large:
        return
    with suppress(OSError):  # the record is good as it is
        subprocess.Popen(
            [sys.executable, "-m", "gcs.record.compact", *large],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )


def _size(path: Path) -> int:
    try:
        return path.stat().st_size
    except OSError:
        return 0


def main(paths: Sequence[str]) -> None:
    """Compact each one, at low priority; what cannot be stays as it is."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    if hasattr(os, "nice"):
        os.nice(_NICENESS)
    for path in map(Path, paths):
        for left in path.parent.glob(".*.compacting"):
            _remove_stale(left)
        with suppress(NotCompactedError, BadRecordError, OSError):
            compact(path)


if __name__ == "__main__":
    with suppress(KeyboardInterrupt):
        main(sys.argv[1:])
