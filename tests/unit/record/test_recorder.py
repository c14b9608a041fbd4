"""The recorder under a working disk, a full one, and one that comes back."""

from __future__ import annotations

import errno
import json
import logging
import random
from itertools import pairwise
from pathlib import Path
from zlib import crc32

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.reader import make_reader

from gcs.mcap_file.reader import Reading
from gcs.mcap_file.writer import (
    Channel,
    FoxgloveBackend,
    GuardedFile,
    McapBackend,
)
from gcs.record import ros1, writer
from gcs.record.derived import Derived
from gcs.record.parts import RecordLost, RecordResumed, RecordRotated, Rotation
from gcs.record.topics import INPUT_TOPIC, Out
from gcs.record.writer import Recorder, RecorderError
from gcs.report import (
    AttachmentItem,
    Direction,
    FrameItem,
    FramesItem,
    GarbageItem,
    InputItem,
    LogEvent,
    MetadataItem,
    ParamItem,
    PoseItem,
    RecordItem,
)
from tests.shares import examples
from tests.unit.record.disks import Disk
from tests.unit.record.flights import (
    MS,
    SECOND,
    START_NS,
    Logged,
    a_flight,
    frame_v1,
    frame_v2,
    messages_of,
    opened,
    position_frame,
    record,
    summary_of,
)

BACKENDS = [FoxgloveBackend, McapBackend]


# ------------------------------------------------------------------------------ a good disk


@pytest.mark.parametrize("backend", BACKENDS)
def test_what_was_written_is_read_back_in_order(
    tmp_path: Path, backend: type[FoxgloveBackend | McapBackend]
) -> None:
    recorder = opened(tmp_path, "test", backend=backend())
    items = [position_frame(number) for number in range(100)]
    for number, item in enumerate(items):
        recorder.write(item, START_NS + number * MS)
    assert recorder.close(START_NS + SECOND)
    found = messages_of(recorder.path)
    assert [ros1.rebuild(message.data) for message in found] == [item.raw for item in items]
    assert [message.log_time_ns for message in found] == [START_NS + n * MS for n in range(100)]
    statistics = summary_of(recorder.path).statistics
    assert statistics is not None
    assert statistics.message_count == 100


def test_the_file_is_named_after_start_and_session(tmp_path: Path) -> None:
    logs = tmp_path / "made" / "on demand"
    recorder = Recorder.open(logs, "lab 3/../x", "20260101-123456", START_NS)
    recorder.close(START_NS)
    assert recorder.path == logs / "20260101-123456_lab-3-..-x.mcap"


def test_two_sessions_of_one_second_do_not_share_a_file(tmp_path: Path) -> None:
    first = opened(tmp_path, "flight")
    second = opened(tmp_path, "flight")
    assert first.path.name == "20260101-000000_flight.mcap"
    assert second.path.name == "20260101-000000_flight-2.mcap"
    assert first.close(START_NS)
    assert second.close(START_NS)


def test_an_unwritable_folder_is_an_error_at_start(tmp_path: Path) -> None:
    blocked = tmp_path / "logs"
    blocked.write_text("a file where the folder should be")
    with pytest.raises(RecorderError, match="logs: cannot record"):
        opened(blocked, "flight")


@settings(max_examples=examples(30), deadline=None)
@given(steps=st.lists(st.sampled_from([0, 0, 1, -5, 1_000_000]), min_size=1, max_size=40))
def test_log_time_is_strictly_increasing_whatever_the_clock_does(
    tmp_path_factory: pytest.TempPathFactory, steps: list[int]
) -> None:
    folder = tmp_path_factory.mktemp("ties")
    recorder = opened(folder, "ties")
    now_ns = START_NS
    for number, step_ns in enumerate(steps):
        now_ns += step_ns
        recorder.write(position_frame(number), now_ns)
        recorder.write(PoseItem(1, (1.0, 0.0, 0.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)), now_ns)
    recorder.close(now_ns)
    times = [message.log_time_ns for message in messages_of(recorder.path)]
    assert len(times) > len(steps)
    assert all(later > earlier for earlier, later in pairwise(times))


def test_flushes_are_due_on_a_grid(tmp_path: Path) -> None:
    recorder = opened(tmp_path, "test")
    assert recorder.deadline_ns == START_NS + 800 * MS
    recorder.tick(START_NS + 930 * MS)  # late: the next is not put off, and none is made up for
    assert recorder.deadline_ns == START_NS + 1600 * MS
    recorder.tick(START_NS + 3300 * MS)
    assert recorder.deadline_ns == START_NS + 4000 * MS
    recorder.close(START_NS + 3 * SECOND)


def test_what_was_flushed_is_in_the_file_without_closing_it(tmp_path: Path) -> None:
    recorder = opened(tmp_path, "test")
    for number in range(10):
        recorder.write(position_frame(number), START_NS + number * 40 * MS)
    recorder.tick(START_NS + 800 * MS)
    recorder.write(position_frame(10), START_NS + 900 * MS)
    assert len(messages_of(recorder.path)) == 10
    recorder.close(START_NS + SECOND)
    assert len(messages_of(recorder.path)) == 11


def test_garbage_and_malformed_frames_are_kept_with_their_reason(tmp_path: Path) -> None:
    cut = FrameItem(2, Direction.RECEIVED, b"\xfd\x30abc")
    path = record(tmp_path, [GarbageItem(2, b"NMEA?", "text"), cut])
    found = messages_of(path)
    assert [message.topic for message in found] == ["/link/2/garbage"] * 2
    assert b"NMEA?" in found[0].data
    assert b"malformed" in found[1].data
    assert found[1].data.endswith(cut.raw)


def test_frames_in_a_row_are_recorded_as_one_after_the_other(tmp_path: Path) -> None:
    raws = (
        position_frame(1).raw,
        frame_v1(32, b"\1" * 28),
        frame_v2(110, b"x" * 100),
        b"\xfd\x30abc",
        frame_v2(32, b"\1" * 40),
        position_frame(2).raw,
    )
    single = [FrameItem(2, Direction.RECEIVED, raw) for raw in raws]
    expected = messages_of(record(tmp_path / "a", single, step_ns=0))
    together = [FramesItem(2, Direction.RECEIVED, raws)]
    assert messages_of(record(tmp_path / "b", together, step_ns=0)) == expected
    assert [message.log_time_ns - START_NS for message in expected] == [0, 1, 2, 3, 4, 5]


def test_forged_sources_cannot_use_up_the_channels(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(writer, "MAX_FRAME_CHANNELS", 3)
    raws = [frame_v2(0, b"\1\2\3\4\5\6\7\10\11", source=(sysid, 1)) for sysid in range(1, 7)]
    path = record(tmp_path, [FrameItem(0, Direction.RECEIVED, raw) for raw in raws])
    found = messages_of(path)
    assert [message.topic for message in found[3:]] == ["/mavlink/more"] * 3
    assert [ros1.rebuild(message.data, payload_length=0) for message in found[3:]] == raws[3:]


def test_the_sdk_logger_does_not_reach_root_handlers() -> None:
    FoxgloveBackend()
    assert logging.getLogger("foxglove").propagate is False


def test_without_an_sdk_the_readings_and_frames_are_still_recorded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("gcs.record.derived.find_spec", lambda _: None)
    monkeypatch.setattr("gcs.mcap_file.writer.find_spec", lambda _: None)
    path = record(tmp_path, a_flight())
    topics = {message.topic for message in messages_of(path)}
    assert {"/mavlink/1/1/LOCAL_POSITION_NED", "/vehicle/1/state", "/gate/decision"} <= topics
    assert "/vehicle/1/tf" not in topics


# ------------------------------------------------------------------------------ a full disk


def test_a_guarded_file_keeps_the_error_and_swallows_what_follows(tmp_path: Path) -> None:
    disk = Disk(free=10)
    file = GuardedFile(disk.open(tmp_path / "x"))
    assert file.write(b"12345678") == 8
    assert file.written == 8
    assert file.write(b"12345678") == 8  # two fit, then the disk is full
    assert file.failure is not None
    assert file.failure.errno == errno.ENOSPC
    disk.free = 100
    assert file.write(b"more") == 4
    file.close()
    assert (tmp_path / "x").read_bytes() == b"1234567812"
    assert (file.written, file.tell()) == (10, 20)


def test_a_guarded_file_refuses_to_move() -> None:
    file = GuardedFile(_Nowhere())
    file.write(b"abc")
    assert file.seek(0, 1) == 3
    assert file.seek(3) == 3
    with pytest.raises(ValueError, match="from its beginning to its end"):
        file.seek(0)


class _Nowhere:
    def write(self, data: memoryview, /) -> int:
        return len(data)

    def close(self) -> None:
        raise OSError(errno.EIO, "gone")


def test_an_error_while_closing_is_kept_too() -> None:
    file = GuardedFile(_Nowhere())
    file.close()
    assert file.failure is not None


@pytest.mark.parametrize("backend", BACKENDS)
def test_a_full_disk_is_told_at_once_and_a_second_part_begins_when_there_is_room(
    tmp_path: Path, backend: type[FoxgloveBackend | McapBackend]
) -> None:
    disk = Disk(free=6_000)
    recorder = opened(tmp_path, "flight", backend=backend(), opener=disk.open)
    now_ns, number, failed_ns = START_NS, 0, 0
    while not failed_ns and number < 2000:
        recorder.write(position_frame(number), now_ns)
        number += 1
        now_ns += 10 * MS
        if now_ns < recorder.deadline_ns:
            continue
        news = recorder.tick(now_ns)
        if recorder.failed:
            failed_ns = now_ns
            assert news == [
                RecordLost(recorder.path, failed_ns - 800 * MS, "No space left on device")
            ]
    assert failed_ns
    saved = len(messages_of(recorder.path))
    assert saved >= (failed_ns - 800 * MS - START_NS) // (10 * MS)

    recorder.write(position_frame(9000), now_ns)  # the link goes on and does not notice
    assert recorder.tick(now_ns + SECOND) == []
    assert recorder.deadline_ns == failed_ns + 5 * SECOND
    assert recorder.tick(failed_ns + 5 * SECOND) == []  # still full
    assert recorder.deadline_ns == failed_ns + 10 * SECOND
    assert list(tmp_path.glob("*_part2*")) == []
    assert recorder.path.name == "20260101-000000_flight.mcap"

    disk.free = 1_000_000
    now_ns = failed_ns + 10 * SECOND
    part2 = tmp_path / "20260101-000000_flight_part2.mcap"
    assert recorder.tick(now_ns) == [RecordResumed(part2, failed_ns - 800 * MS, now_ns)]
    assert not recorder.failed
    recorder.write(position_frame(10_000), now_ns + MS)
    assert not recorder.close(now_ns + SECOND)  # something is missing, and close says so
    assert [ros1.rebuild(m.data) for m in messages_of(part2)] == [position_frame(10_000).raw]
    assert recorder.parts == [tmp_path / "20260101-000000_flight.mcap", part2]


def test_a_disk_that_fails_again_leads_to_a_third_part(tmp_path: Path) -> None:
    disk = Disk(free=0)
    recorder = opened(tmp_path, opener=disk.open)
    now_ns = START_NS
    names = []
    for _ in range(2):
        disk.free = 0
        recorder.write(position_frame(0), now_ns)
        recorder.tick(now_ns + SECOND)
        assert recorder.failed
        disk.free = 100_000
        now_ns += 7 * SECOND
        (resumed,) = recorder.tick(now_ns)
        names.append(resumed.path.name)
    assert names == ["20260101-000000_f_part2.mcap", "20260101-000000_f_part3.mcap"]
    recorder.close(now_ns)


def test_a_new_part_begins_with_what_was_said_once(tmp_path: Path) -> None:
    disk = Disk(free=1_000_000)
    recorder = opened(tmp_path, opener=disk.open)
    for item in a_flight():
        recorder.write(item, START_NS)
    disk.free = 0
    recorder.tick(START_NS + SECOND)
    recorder.write(ParamItem(1, "MPC_XY_VEL_MAX", 5.0), START_NS + 2 * SECOND)  # while lost
    disk.free = 1_000_000
    recorder.tick(START_NS + 6 * SECOND)
    recorder.close(START_NS + 7 * SECOND)
    part2 = recorder.path
    found = messages_of(part2)
    topics = {message.topic for message in found}
    assert {"/tf_static", "/vehicle/1/model", "/geofence", "/mission"} <= topics
    params = [message.data for message in found if message.topic == "/vehicle/1/param"]
    assert params == [b'{"name":"MPC_XY_VEL_MAX","value":5.0}']
    others = [type(entry).__name__ for entry in Reading(part2)]
    assert "Attachment" in others
    assert "Metadata" in others
    times = [message.log_time_ns for message in found]
    assert times == sorted(set(times))


def test_a_disk_that_is_full_when_the_file_is_closed_is_reported(tmp_path: Path) -> None:
    disk = Disk(free=1_000_000)
    recorder = opened(tmp_path, opener=disk.open)
    recorder.write(position_frame(0), START_NS)
    disk.free = 0
    assert recorder.close(START_NS) is False


def test_a_part_that_cannot_be_removed_does_not_stand_in_the_next_ones_way(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    disk = Disk(free=0)
    recorder = opened(tmp_path, opener=disk.open)
    recorder.write(position_frame(0), START_NS)
    recorder.tick(START_NS + SECOND)
    with monkeypatch.context() as locked:
        locked.setattr(Path, "unlink", _in_use)
        assert recorder.tick(START_NS + 6 * SECOND) == []  # part 2 is made, and stays empty
        disk.free = 1_000_000
        (resumed,) = recorder.tick(START_NS + 11 * SECOND)
    part3 = tmp_path / "20260101-000000_f_part3.mcap"
    assert resumed.path == part3
    assert (tmp_path / "20260101-000000_f_part2.mcap").stat().st_size == 0
    recorder.write(position_frame(1), START_NS + 12 * SECOND)
    recorder.close(START_NS + 13 * SECOND)
    assert [ros1.rebuild(m.data) for m in messages_of(part3)] == [position_frame(1).raw]


def test_a_part_that_could_not_be_removed_is_removed_once_it_can_be(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    disk = Disk(free=0)
    recorder = opened(tmp_path, opener=disk.open)
    recorder.write(position_frame(0), START_NS)
    recorder.tick(START_NS + SECOND)
    with monkeypatch.context() as locked:
        locked.setattr(Path, "unlink", _in_use)
        recorder.tick(START_NS + 6 * SECOND)
        recorder.tick(START_NS + 11 * SECOND)
    assert len(list(tmp_path.glob("*_part*"))) == 2
    disk.free = 1_000_000
    (resumed,) = recorder.tick(START_NS + 16 * SECOND)
    assert list(tmp_path.glob("*_part*")) == [resumed.path]
    assert resumed.path.name == "20260101-000000_f_part2.mcap"
    recorder.close(START_NS + 17 * SECOND)


def test_a_part_whose_name_is_taken_by_another_file_takes_the_next(tmp_path: Path) -> None:
    disk = Disk(free=0)
    recorder = opened(tmp_path, opener=disk.open)
    foreign = tmp_path / "20260101-000000_f_part2.mcap"
    foreign.write_bytes(b"somebody else's")
    recorder.write(position_frame(0), START_NS)
    recorder.tick(START_NS + SECOND)
    disk.free = 1_000_000
    (resumed,) = recorder.tick(START_NS + 6 * SECOND)
    assert resumed.path.name == "20260101-000000_f_part3.mcap"
    assert foreign.read_bytes() == b"somebody else's"
    recorder.close(START_NS + 7 * SECOND)


def _in_use(path: Path, missing_ok: bool = False) -> None:
    raise PermissionError(errno.EACCES, "the file is in use", str(path))


def test_closing_while_nothing_is_recorded_is_harmless(tmp_path: Path) -> None:
    disk = Disk(free=0)
    recorder = opened(tmp_path, opener=disk.open)
    recorder.write(LogEvent(START_NS, 2, "gate", "hello"), START_NS)
    recorder.tick(START_NS + SECOND)
    disk.free = 20  # room for a beginning, not for a part
    assert recorder.tick(START_NS + 6 * SECOND) == []
    assert disk.files[-1].name == "20260101-000000_f_part2.mcap"
    assert not disk.files[-1].exists()
    assert recorder.close(START_NS + 7 * SECOND) is False
    assert recorder.bytes_written == 0


def test_every_part_keeps_attachments_and_metadata_once(tmp_path: Path) -> None:
    path = record(
        tmp_path,
        [
            AttachmentItem("fence.plan", "application/json", b"{}"),
            MetadataItem("endpoints", (("vehicle", "udpin://127.0.0.1:14540"),)),
            InputItem.of("tick", {"lateness_ns": 3}),
        ],
    )
    with open(path, "rb") as file:
        reader = make_reader(file)
        assert [(a.name, a.data) for a in reader.iter_attachments()] == [("fence.plan", b"{}")]
        assert [m.metadata for m in reader.iter_metadata()] == [
            {"vehicle": "udpin://127.0.0.1:14540"}
        ]


# ------------------------------------------------------------- what a file can be checked by


def sealed(found: list[Logged]) -> list[tuple[str, dict[str, int]]]:
    """What the recorder itself says on /session/input."""
    said = [json.loads(m.data) for m in found if m.topic == "/session/input"]
    return [(each["kind"], each["data"]) for each in said if each["kind"].startswith("Record")]


def checksum_of(messages: list[Logged]) -> int:
    return crc32(b"".join(message.data for message in messages))


def test_a_session_s_record_is_sealed_at_every_flush_and_at_its_end(tmp_path: Path) -> None:
    recorder = opened(tmp_path, "test", sealed=True)
    for number in range(3):
        recorder.write(position_frame(number), START_NS + number)
    recorder.tick(recorder.deadline_ns)
    recorder.write(GarbageItem(0, b"\xfd", "truncated"), recorder.deadline_ns)
    assert recorder.close(recorder.deadline_ns)
    found = messages_of(recorder.path)
    first, last = sealed(found)
    # The first seal itself, what every picture begins with, and the garbage.
    topics = [message.topic for message in found]
    end = topics.index("/link/0/garbage") + 1
    frames, between = found[:3], found[3:end]
    assert (topics[3], topics[end]) == (INPUT_TOPIC, INPUT_TOPIC)
    assert first == ("RecordTick", {"messages": 3, "crc32": checksum_of(frames)})
    told = {"messages": 3 + len(between), "crc32": checksum_of(between)}
    assert last == ("RecordEnd", told)


def test_a_later_part_says_what_it_repeats_and_what_was_before_it(tmp_path: Path) -> None:
    disk = Disk(1 << 30)
    recorder = opened(tmp_path, "test", opener=disk.open, sealed=True)
    recorder.write(ParamItem(1, "A", 1.0), START_NS)
    recorder.write(ParamItem(1, "B", 2.0), START_NS)
    disk.free = 0
    lost_ns = recorder.deadline_ns
    (lost,) = recorder.tick(lost_ns)
    assert isinstance(lost, RecordLost)
    recorder.write(position_frame(1), lost_ns)  # in no file
    disk.free = 1 << 30
    (resumed,) = recorder.tick(lost_ns + 5 * SECOND)
    assert isinstance(resumed, RecordResumed)
    recorder.close(lost_ns + 6 * SECOND)
    found = messages_of(recorder.path)
    began, *_, end = sealed(found)
    begun = Derived().handle(LogEvent(START_NS, 2, "gate", "Complete"), START_NS)[:-1]
    picture = [out.channel.topic for out in begun if out.latch]
    repeated = len(picture) + 2
    # What every picture begins with, two parameters, a seal, a frame.
    before = len(begun) + 4
    part = {"part": 2, "of": "20260101-000000_test", "repeated": repeated, "messages": before}
    assert found[0].topic == INPUT_TOPIC
    assert began == ("RecordPart", part)
    topics = [m.topic for m in found[1 : 1 + repeated]]
    assert sorted(topics) == sorted([*picture, *["/vehicle/1/param"] * 2])
    assert end[1]["messages"] == before + 1, "what is repeated does not count"
    assert end[1]["crc32"] == crc32(b"".join(message.data for message in found[:-1]))


def test_what_was_attached_word_for_word_is_not_attached_again(tmp_path: Path) -> None:
    first, other = (AttachmentItem("a.plan", "text/plain", data) for data in (b"one", b"two"))
    path = record(tmp_path, [first, first, other])
    with open(path, "rb") as file:
        assert [each.data for each in make_reader(file).iter_attachments()] == [b"one", b"two"]


# --------------------------------------------------------------------------------- rotation


def test_a_file_that_has_its_size_is_closed_and_the_next_begins_without_a_gap(
    tmp_path: Path,
) -> None:
    recorder = opened(tmp_path, rotation=Rotation(size_bytes=20_000))
    rng = random.Random(1)
    items = [
        FrameItem(0, Direction.RECEIVED, frame_v2(110, rng.randbytes(253) + b"\1", n & 0xFF))
        for n in range(500)
    ]
    news = []
    for number, item in enumerate(items):
        now_ns = START_NS + number * 20 * MS
        recorder.write(item, now_ns)
        if now_ns >= recorder.deadline_ns:
            news += recorder.tick(now_ns)
    assert recorder.close(START_NS + 10 * SECOND)
    names = [path.name for path in recorder.parts]
    assert names[:3] == [f"20260101-000000_f{part}.mcap" for part in ("", "_part2", "_part3")]
    assert news == [RecordRotated(path) for path in recorder.parts[1:]]
    found = [message for path in recorder.parts for message in messages_of(path)]
    assert [ros1.rebuild(message.data) for message in found] == [item.raw for item in items]
    for path in recorder.parts[:-1]:
        assert 20_000 <= path.stat().st_size < 50_000
        assert summary_of(path).chunk_indexes


def test_a_file_that_has_its_age_is_followed_by_one_with_all_that_was_said_once(
    tmp_path: Path,
) -> None:
    recorder = opened(tmp_path, rotation=Rotation(age_ns=10 * SECOND))
    for item in a_flight():
        recorder.write(item, START_NS)
    for number in range(25):
        recorder.tick(START_NS + number * SECOND)
    assert recorder.close(START_NS + 25 * SECOND)
    assert len(recorder.parts) == 3
    for path in recorder.parts[1:]:
        topics = {message.topic for message in messages_of(path)}
        assert {"/tf_static", "/vehicle/1/model", "/geofence", "/vehicle/1/param"} <= topics
        kinds = {type(entry).__name__ for entry in Reading(path)}
        assert {"Attachment", "Metadata"} <= kinds


def test_a_disk_that_is_full_at_the_rotation_is_told_as_a_loss(tmp_path: Path) -> None:
    disk = Disk(free=1_000_000)
    recorder = opened(tmp_path, opener=disk.open, rotation=Rotation(age_ns=SECOND))
    recorder.write(position_frame(0), START_NS)
    recorder.tick(START_NS + 800 * MS)
    disk.free = 50
    (lost,) = recorder.tick(START_NS + 1600 * MS)
    assert isinstance(lost, RecordLost)
    assert recorder.failed
    disk.free = 1_000_000
    (resumed,) = recorder.tick(START_NS + 7 * SECOND)
    assert isinstance(resumed, RecordResumed)
    assert recorder.close(START_NS + 8 * SECOND) is False


class DrawsFirst(Derived):
    """Says something of each item before what the item itself becomes."""

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        drawn = Channel("/drawn", "json", "", "", b"")
        return [Out(drawn, b"{}"), *super().handle(item, now_ns)]


def test_an_input_is_the_first_of_what_is_recorded_of_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """So its log_time is the time at which it was handled."""
    monkeypatch.setattr(writer, "Derived", DrawsFirst)
    path = record(tmp_path, [InputItem.of("Wake", {}), LogEvent(START_NS, 2, "gate", "Complete")])
    first, *others = messages_of(path)
    assert (first.topic, first.log_time_ns) == (INPUT_TOPIC, START_NS)
    assert [other.topic for other in others].count("/drawn") == 2


def test_a_record_begins_with_its_first_input_however_late_that_comes(tmp_path: Path) -> None:
    """A flush that was due before it had put a seal in front of the set-up: no audit then."""
    recorder = opened(tmp_path, sealed=True)
    recorder.tick(START_NS + SECOND)
    recorder.write(InputItem.of("Setup", {}), START_NS + 2 * SECOND)
    recorder.tick(START_NS + 3 * SECOND)
    recorder.close(START_NS + 4 * SECOND)
    found = messages_of(recorder.path)
    said = [json.loads(m.data)["kind"] for m in found if m.topic == INPUT_TOPIC]
    assert found[0].topic == INPUT_TOPIC
    assert said == ["Setup", "RecordTick", "RecordEnd"]
