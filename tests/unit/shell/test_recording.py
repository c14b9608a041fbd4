"""The recorder as the loop sees it: its troubles are told at once, once, and in words."""

from __future__ import annotations

import errno
import random
from collections.abc import Iterator
from pathlib import Path

import pytest
from mcap.reader import make_reader

from gcs.mcap_file.writer import RawFile, open_exclusive
from gcs.record.writer import Recorder
from gcs.report import AttachmentItem, Direction, FramesItem, InputItem, PoseItem, RecordItem
from gcs.session.inputs import Datagram, RecorderChanged, RecorderGrew
from gcs.shell.recording import GREW_STEP_BYTES, MOST_WAITING, Recording
from gcs.wire import messages as m
from gcs.wire.codec import FrameWriter

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


# ------------------------------------------------------------------- what waits to be recorded

RAW = FrameWriter(1, 1).write(m.Attitude(1, 0.1, 0.2, 0.3, 0.0, 0.0, 0.0))
FRAMES = FramesItem(0, Direction.RECEIVED, (RAW, RAW, RAW))
POSE = PoseItem(1, (1.0, 2.0, -3.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))
CAME = Datagram(0, RAW)
MS = 1_000_000


def told(recording: Recording) -> list[tuple[str, int]]:
    """Topic and log_time of every message from now on, as a watcher is told them."""
    recording.write(
        InputItem.of("Wake", {}), START_NS
    )  # behind it comes what every record begins with
    heard: list[tuple[str, int]] = []
    assert recording.recorder is not None
    recording.recorder.watch(lambda channel, _, time_ns, __: heard.append((channel.topic, time_ns)))
    return heard


def test_frames_of_a_vehicle_wait_for_the_next_word_of_the_session(recording: Recording) -> None:
    heard = told(recording)
    recording.write_of(CAME, FRAMES, START_NS + 1 * MS)
    recording.write_of(CAME, FRAMES, START_NS + 9 * MS)
    assert heard == []
    recording.write(InputItem.of("Wake", {}), START_NS + 50 * MS)
    frames = [time_ns for topic, time_ns in heard if topic == "/mavlink/1/1/ATTITUDE"]
    assert frames == [START_NS + at * MS + n for at in (1, 9) for n in range(3)]
    assert ("/session/input", START_NS + 50 * MS) in heard
    assert [time_ns for _, time_ns in heard] == sorted(time_ns for _, time_ns in heard)


def test_no_input_is_handled_at_a_time_that_waiting_messages_will_have(
    recording: Recording,
) -> None:
    heard = told(recording)
    given_ns = []
    for items in ((FRAMES, POSE, FRAMES), (FRAMES,), (FRAMES, POSE)):
        given_ns.append(recording.time_ns(START_NS))
        for item in items:
            recording.write_of(CAME, item, given_ns[-1])
    given_ns.append(recording.time_ns(START_NS))
    recording.write(InputItem.of("Wake", {}), given_ns[-1])
    # Where a nanosecond is left free, an input begins.
    times_ns = [time_ns for _, time_ns in heard]
    begins = [at for at, before in zip(times_ns[1:], times_ns, strict=False) if at > before + 1]
    assert [times_ns[0], *begins] == given_ns
    assert times_ns == sorted({*times_ns})


@pytest.mark.parametrize("count", [MOST_WAITING // 3, MOST_WAITING // 3 + 1])
def test_only_so_many_frames_wait(recording: Recording, count: int) -> None:
    heard = told(recording)
    for _ in range(count):
        recording.write_of(CAME, FRAMES, recording.time_ns(START_NS))
    assert len(heard) == (3 * count if 3 * count >= MOST_WAITING else 0)


def test_nothing_that_waits_is_left_out_of_the_file(tmp_path: Path) -> None:
    recorder = Recorder.open(tmp_path, "f", "20260101-000000", START_NS)
    recording = Recording(recorder)
    recording.write_of(CAME, FRAMES, START_NS)
    assert recording.close(START_NS + MS)
    with recorder.path.open("rb") as file:
        topics = [channel.topic for _, channel, _ in make_reader(file).iter_messages()]
    assert topics.count("/mavlink/1/1/ATTITUDE") == 3


def test_a_full_disk_is_told_right_after_the_write_that_met_it(
    recording: Recording, disk: Disk
) -> None:
    recording.write_of(CAME, FRAMES, START_NS)
    disk.full = True
    (lost,) = recording.upkeep(recording.deadline_ns)
    assert isinstance(lost, RecorderChanged)
    assert not lost.recording


def test_what_raises_later_is_told_with_what_came_and_the_rest_is_recorded(
    recording: Recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert recording.recorder is not None
    write = Recorder.write

    def refuse_poses(self: Recorder, item: RecordItem, now_ns: int) -> None:
        if item == POSE:
            raise ZeroDivisionError("planted")
        write(self, item, now_ns)

    monkeypatch.setattr(Recorder, "write", refuse_poses)
    heard = told(recording)
    other = Datagram(1, RAW)
    recording.write_of(other, POSE, START_NS)
    recording.write_of(CAME, FRAMES, START_NS + MS)
    recording.write(InputItem.of("Wake", {}), START_NS + 50 * MS)
    assert [topic for topic, _ in heard].count("/mavlink/1/1/ATTITUDE") == 3
    ((given, report),) = recording.faults()
    assert given is other
    assert "planted" in report
    assert recording.faults() == []
