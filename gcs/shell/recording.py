"""The recorder as the loop uses it: its failures become inputs of the session."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TypeAlias

from gcs.record.news import RecordLost, RecordResumed, RecordRotated
from gcs.record.writer import Recorder
from gcs.report import RecordItem
from gcs.session.inputs import DiskLow, RecorderChanged, RecorderGrew
from gcs.shell.disk_watch import DiskWatch

GREW_STEP_BYTES = 50_000

RecorderNews: TypeAlias = RecorderChanged | RecorderGrew | DiskLow
"""What the session is told of its record."""


class Recording:
    """A recorder, or none: a command that only looks, such as `gcs status`, may go without."""

    def __init__(self, recorder: Recorder | None, disk: DiskWatch | None = None) -> None:
        self._recorder = recorder
        self._disk = disk
        self._told_bytes = 0
        self._told_failed = False
        self._whole: bool | None = None

    @property
    def recorder(self) -> Recorder | None:
        """What writes, to be watched; None where nothing is recorded."""
        return self._recorder

    @property
    def path(self) -> str:
        """The file that is being written; empty where nothing is recorded."""
        return str(self._recorder.path) if self._recorder else ""

    @property
    def parts(self) -> list[Path]:
        """All files that were written, in order."""
        return list(self._recorder.parts) if self._recorder else []

    @property
    def deadline_ns(self) -> int:
        """When `upkeep` has something to do."""
        return self._recorder.deadline_ns if self._recorder else 1 << 62

    def time_ns(self, now_ns: int) -> int:
        """When an input that came by `now_ns` is to be handled; see `Recorder.input_ns`."""
        return self._recorder.input_ns(now_ns) if self._recorder else now_ns

    def write(self, item: RecordItem, now_ns: int) -> None:
        if self._recorder:
            self._recorder.write(item, now_ns)

    def changes(self) -> Iterator[RecorderChanged]:
        """That the recorder failed, once, right after the write that failed."""
        if self._recorder and self._recorder.failed and not self._told_failed:
            self._told_failed = True
            yield RecorderChanged(False, self.path, "the recorder failed")

    def upkeep(self, now_ns: int) -> Iterator[RecorderNews]:
        """Let the recorder flush or retry when that is due; what the session must know of it."""
        if self._recorder is None or now_ns < self._recorder.deadline_ns:
            return
        for news in self._recorder.tick(now_ns):
            match news:
                case RecordLost(path, since_ns, reason):
                    self._told_failed = True
                    ago_s = (now_ns - since_ns) / 1e9
                    text = f"not recorded since {ago_s:.1f} s ago: {path}: {reason}"
                    yield RecorderChanged(False, str(path), text)
                case RecordResumed(path, since_ns, resumed_ns):
                    self._told_failed = False
                    gap_s = (resumed_ns - since_ns) / 1e9
                    text = f"recording again in {path}; {gap_s:.1f} s are in no file"
                    yield RecorderChanged(True, str(path), text)
                case RecordRotated(path):
                    yield RecorderChanged(True, str(path), f"recording goes on in {path}")
        if self._recorder.bytes_written - self._told_bytes >= GREW_STEP_BYTES:
            self._told_bytes = self._recorder.bytes_written
            yield RecorderGrew(self._told_bytes)
        if self._disk is not None and not self._recorder.failed:
            low = self._disk.look(self._recorder.bytes_written, now_ns)
            if low is not None:
                yield low

    def close(self, now_ns: int) -> bool:
        """Finish the file; whether every byte reached the disk.  Closing twice says the same."""
        if self._whole is None:
            self._whole = self._recorder is None or self._recorder.close(now_ns)
        return self._whole

    def discard(self, now_ns: int) -> None:
        """Close, and leave no file; `path` is empty from now on."""
        if self._recorder is not None and self._whole is None:
            self._recorder.discard(now_ns)
        self._recorder, self._whole = None, True
