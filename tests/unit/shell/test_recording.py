"""The recorder as the loop sees it: its troubles are told at once, once, and in words."""

from __future__ import annotations

import errno
import random
from collections.abc import Iterator
from pathlib import Path

import pytest

from gcs.record.guarded_file import RawFile, open_exclusive
from gcs.record.writer import Recorder
from gcs.report import AttachmentItem, InputItem
from gcs.session.inputs import RecorderChanged, RecorderGrew
from gcs.shell.recording import GREW_STEP_BYTES, Recording

SECOND_NS = 1_000_000_000
START_NS = 1_000 * SECOND_NS
PIECE = 40_000


class Disk:
    """A disk that can be full."""

    def __init__(self) -> None:
        self.full = False

    def open(self, path: Path) -> RawFile:
        return DiskFile(self, open_exclusive(path))


class DiskFile:
    def __init__(self, disk: Disk, raw: RawFile) -> None:
        self._disk, self._raw = disk, raw

    def write(self, data: memoryview, /) -> int | None:
        if self._disk.full:
            raise OSError(errno.ENOSPC, "No space left on device")
        return self._raw.write(data)

    def close(self) -> None:
        self._raw.close()


@pytest.fixture
def disk() -> Disk:
    return Disk()


@pytest.fixture
def recording(tmp_path: Path, disk: Disk) -> Iterator[Recording]:
    made = Recording(Recorder.open(tmp_path, "f", "20260101-000000", START_NS, opener=disk.open))
    yield made
    made.close(START_NS + 3600 * SECOND_NS)


def piece(number: int) -> AttachmentItem:
    """Something to record, large enough to be noticed."""
    data = random.Random(number).randbytes(PIECE)
    return AttachmentItem(f"{number}", "text/plain", data)


def fail(recording: Recording, disk: Disk) -> int:
    """The disk is full, and the next flush meets it; the time of that."""
    disk.full = True
    now_ns = recording.deadline_ns
    list(recording.upkeep(now_ns))
    return now_ns


def test_a_good_recorder_has_nothing_to_tell(recording: Recording) -> None:
    assert list(recording.changes()) == []
    assert list(recording.upkeep(recording.deadline_ns)) == []
    assert recording.path.endswith("20260101-000000_f.mcap")


def test_before_its_deadline_nothing_is_done(recording: Recording, disk: Disk) -> None:
    disk.full = True
    assert list(recording.upkeep(recording.deadline_ns - 1)) == []


def test_a_full_disk_is_told_with_the_file_the_time_and_the_reason(
    recording: Recording, disk: Disk
) -> None:
    path = recording.path
    disk.full = True
    (lost,) = recording.upkeep(recording.deadline_ns)
    assert isinstance(lost, RecorderChanged)
    assert (lost.recording, lost.path) == (False, path)
    assert lost.text == f"not recorded since 0.8 s ago: {path}: No space left on device"
    assert list(recording.changes()) == []


def test_a_failure_between_two_flushes_is_told_in_the_turn_it_happened_and_once(
    recording: Recording, disk: Disk
) -> None:
    disk.full = True
    changes: list[RecorderChanged] = []
    for n in range(200):
        recording.write(piece(n), START_NS)
        changes += recording.changes()
    (failed,) = changes
    assert not failed.recording


def test_a_disk_that_has_room_again_is_told_with_the_gap(recording: Recording, disk: Disk) -> None:
    failed_ns = fail(recording, disk)
    disk.full = False
    (back,) = recording.upkeep(failed_ns + 5 * SECOND_NS)
    assert isinstance(back, RecorderChanged)
    assert back.recording
    assert back.path.endswith("_part2.mcap")
    assert "5.8 s are in no file" in back.text
    assert recording.path == back.path


def test_a_second_failure_is_told_like_the_first(recording: Recording, disk: Disk) -> None:
    failed_ns = fail(recording, disk)
    disk.full = False
    list(recording.upkeep(failed_ns + 5 * SECOND_NS))
    disk.full = True
    recording.write(piece(0), failed_ns + 6 * SECOND_NS)
    (lost,) = recording.upkeep(recording.deadline_ns)
    assert isinstance(lost, RecorderChanged)
    assert not lost.recording


def test_how_much_is_written_is_told_in_steps(recording: Recording) -> None:
    told: list[RecorderGrew] = []
    for n in range(10):
        recording.write(piece(n), START_NS)
        told += [x for x in recording.upkeep(recording.deadline_ns) if isinstance(x, RecorderGrew)]
    sizes = [grew.size_bytes for grew in told]
    assert sizes
    steps = [b - a for a, b in zip([0, *sizes], sizes, strict=False)]
    assert all(step >= GREW_STEP_BYTES for step in steps)


def test_the_file_is_whole_and_says_so_as_often_as_it_is_asked(recording: Recording) -> None:
    assert recording.close(START_NS + SECOND_NS)
    assert recording.close(START_NS + SECOND_NS)


def test_a_file_with_a_gap_is_not_whole(recording: Recording, disk: Disk) -> None:
    failed_ns = fail(recording, disk)
    disk.full = False
    list(recording.upkeep(failed_ns + 5 * SECOND_NS))
    assert not recording.close(failed_ns + 6 * SECOND_NS)


def test_an_input_has_a_time_of_its_own(recording: Recording) -> None:
    recording.write(piece(1), START_NS)
    recording.write(InputItem.of("Wake", {}), START_NS)
    begun_ns = recording.time_ns(
        START_NS
    )  # the first input is followed by what a picture begins with
    recording.write(InputItem.of("Wake", {}), START_NS)
    assert begun_ns > START_NS + 1
    assert recording.time_ns(START_NS) == begun_ns + 1, "a nanosecond after the last remains free"
    assert recording.time_ns(START_NS + 99) == START_NS + 99
    assert Recording(None).time_ns(START_NS) == START_NS


def test_without_a_recorder_there_is_nothing_to_wait_for_and_nothing_to_lose() -> None:
    nothing = Recording(None)
    assert nothing.path == ""
    assert nothing.deadline_ns > START_NS * 1000
    assert list(nothing.changes()) == []
    assert list(nothing.upkeep(START_NS)) == []
    assert nothing.close(START_NS)


def test_a_record_of_nothing_leaves_no_file(recording: Recording, tmp_path: Path) -> None:
    """newcomer.md, 25: each one-shot without a vehicle left one."""
    recording.write(piece(1), START_NS)
    assert list(tmp_path.glob("*.mcap"))
    recording.discard(START_NS + 1)
    assert list(tmp_path.glob("*.mcap")) == []
    assert recording.path == ""
    assert recording.close(START_NS + 2)
