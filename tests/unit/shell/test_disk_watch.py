"""A disk that fills up is told before it is full."""

from __future__ import annotations

from pathlib import Path

from gcs.record.writer import Recorder
from gcs.report import AttachmentItem
from gcs.session.inputs import DiskLow
from gcs.shell.disk_watch import DiskWatch, free_in
from gcs.shell.recording import Recording

SECOND_NS = 1_000_000_000
MB = 1_000_000


class Disk:
    def __init__(self, free: int | None) -> None:
        self.free = free
        self.looks = 0

    def free_bytes(self) -> int | None:
        self.looks += 1
        return self.free


def test_little_room_and_next_to_none_are_told_once_each() -> None:
    disk = Disk(201 * MB)
    watch = DiskWatch(disk.free_bytes, 0)
    told: list[DiskLow | None] = []
    for second, disk.free in enumerate([201 * MB, 199 * MB, 150 * MB, 19 * MB, 10 * MB]):
        told.append(watch.look(0, second * 10 * SECOND_NS))
    low, critical = DiskLow(199 * MB, None, False), DiskLow(19 * MB, None, True)
    assert told == [None, low, None, critical, None]


def test_it_is_told_again_after_there_was_room() -> None:
    disk = Disk(100 * MB)
    watch = DiskWatch(disk.free_bytes, 0)
    assert watch.look(0, 0) == DiskLow(100 * MB, None, False)
    disk.free = 900 * MB
    assert watch.look(0, 10 * SECOND_NS) is None
    disk.free = 10 * MB
    assert watch.look(0, 20 * SECOND_NS) == DiskLow(10 * MB, None, True)


def test_a_fast_record_is_warned_of_by_the_time_that_is_left() -> None:
    disk = Disk(1_000 * MB)
    watch = DiskWatch(disk.free_bytes, 0)
    assert watch.look(0, 0) is None
    assert watch.look(10 * MB, 10 * SECOND_NS) == DiskLow(1_000 * MB, 1_000.0, False)
    disk.free = 210 * MB
    assert watch.look(80 * MB, 40 * SECOND_NS) == DiskLow(210 * MB, 105.0, True)


def test_the_disk_is_looked_at_every_10_s_and_what_is_unknown_is_not_told() -> None:
    disk = Disk(None)
    watch = DiskWatch(disk.free_bytes, 0)
    for tenth in range(201):
        assert watch.look(tenth, tenth * SECOND_NS // 10) is None
    assert disk.looks == 3


def test_the_recording_tells_it_with_a_flush(tmp_path: Path) -> None:
    recorder = Recorder.open(tmp_path, "f", "20260101-000000", 0)
    recording = Recording(recorder, DiskWatch(Disk(100 * MB).free_bytes, 0))
    recording.write(AttachmentItem("x", "text/plain", b"x"), 0)
    assert list(recording.upkeep(1)) == []
    assert list(recording.upkeep(recording.deadline_ns)) == [DiskLow(100 * MB, None, False)]
    recording.close(SECOND_NS)


def test_the_free_room_is_that_of_the_folders_disk(tmp_path: Path) -> None:
    free = free_in(tmp_path)()
    assert free is not None
    assert free > 0
    assert free_in(tmp_path / "missing")() is None
