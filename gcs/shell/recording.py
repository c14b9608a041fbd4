"""The recorder as the loop uses it: its failures become inputs of the session.

Frames of vehicles wait for it, until the next tick at the latest: recorded one datagram at a time,
125 of them a second cost twice as much as they do a few together.  Their log_time is when they
came, and the order stays.
"""

from __future__ import annotations

import traceback
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Final, TypeAlias

import msgspec

from gcs.record.parts import RecordLost, RecordResumed, RecordRotated
from gcs.record.writer import Recorder
from gcs.report import FrameItem, FramesItem, GeodeticItem, PoseItem, RecordItem
from gcs.session.inputs import Datagram, DiskLow, RecorderChanged, RecorderGrew
from gcs.shell.disk_watch import DiskWatch

GREW_STEP_BYTES = 50_000
MOST_WAITING: Final = 512
"""Frames that wait; then all are recorded."""
MOST_DERIVED: Final = 64
"""More than the messages of a position: a vehicle's own are at most 10, and a phase each of 16."""

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
        self._waiting: list[tuple[RecordItem, int, Datagram]] = []
        self._frames_waiting = 0
        self._reserved_ns = 0
        """No message of what waits has a later log_time."""
        self.raised = False
        """There are `faults`."""
        self._faults: list[tuple[Datagram, str]] = []

    @property
    def recorder(self) -> Recorder | None:
        """What writes, to be watched; None where nothing is recorded."""
        self._record_waiting()
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
        if self._waiting:
            return max(now_ns, self._reserved_ns + 2)
        return self._recorder.input_ns(now_ns) if self._recorder else now_ns

    def write(self, item: RecordItem, now_ns: int) -> None:
        """At once, behind what waits."""
        if self._recorder:
            if self._waiting:
                self._record_waiting()
            self._recorder.write(item, now_ns)

    def write_of(self, given: Datagram, item: RecordItem, now_ns: int) -> None:
        """The same of what a vehicle sent: its frames and its position may wait."""
        if isinstance(item, FramesItem):
            count = frames = len(item.raws)
        elif isinstance(item, FrameItem):
            count = frames = 1
        elif isinstance(item, PoseItem | GeodeticItem):
            count, frames = MOST_DERIVED, 0
        else:
            self.write(item, now_ns)
            return
        if self._recorder is None:
            return
        last_ns = self._reserved_ns if self._waiting else self._recorder.last_ns
        self._reserved_ns = max(now_ns - 1, last_ns) + count
        self._waiting.append((item, now_ns, given))
        self._frames_waiting += frames
        if self._frames_waiting >= MOST_WAITING:
            self._record_waiting()

    def _record_waiting(self) -> None:
        """Raises nothing: whatever is recorded next has nothing to do with an exception here."""
        waiting, self._waiting, self._frames_waiting = self._waiting, [], 0
        if self._recorder is None:
            return
        for item, now_ns, given in waiting:
            try:
                self._recorder.write(item, now_ns)
            except Exception:  # noqa: BLE001 - the last resort: a bug of ours must not drop a vehicle
                self._faults.append((given, traceback.format_exc()))
                self.raised = True

    def faults(self) -> list[tuple[Datagram, str]]:
        """What raised where it was recorded later, and why; told once."""
        faults, self._faults, self.raised = self._faults, [], False
        return faults

    def changes(self) -> Iterable[RecorderChanged]:
        """That the recorder failed, once, right after the write that failed."""
        if self._told_failed or self._recorder is None or not self._recorder.failed:
            return ()
        self._told_failed = True
        return (RecorderChanged(False, self.path, "the recorder failed"),)

    def upkeep(self, now_ns: int) -> Iterable[RecorderNews]:
        """Let the recorder flush or retry when that is due; what the session must know of it."""
        if self._recorder is None or now_ns < self._recorder.deadline_ns:
            return ()
        self._record_waiting()
        return self._tick(self._recorder, now_ns)

    def _tick(self, recorder: Recorder, now_ns: int) -> Iterator[RecorderNews]:
        for news in recorder.tick(now_ns):
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
        disk, low = self._disk, None
        if disk is not None and not recorder.failed:
            low = disk.look(recorder.bytes_written, now_ns)
        if recorder.bytes_written - self._told_bytes >= GREW_STEP_BYTES:
            self._told_bytes = recorder.bytes_written
            free = None if disk is None else disk.free_bytes
            yield RecorderGrew(self._told_bytes, msgspec.UNSET if free is None else free)
        if low is not None:
            yield low

    def close(self, now_ns: int) -> bool:
        """Finish the file; whether every byte reached the disk.  Closing twice says the same."""
        if self._whole is None:
            self._record_waiting()
            self._whole = self._recorder is None or self._recorder.close(now_ns)
        return self._whole

    def discard(self, now_ns: int) -> None:
        """Close, and leave no file; `path` is empty from now on."""
        if self._recorder is not None and self._whole is None:
            self._recorder.discard(now_ns)
        self._recorder, self._whole = None, True
