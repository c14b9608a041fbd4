"""A record is read while it is written."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from gcs.mcap_file.errors import BadRecordError
from gcs.mcap_file.format import Message, Record
from gcs.mcap_file.reader import Following
from gcs.record.writer import FLUSH_NS
from tests.unit.record.flights import MS, START_NS, a_flight, messages_of, opened, position_frame


def messages(records: list[Record]) -> list[bytes]:
    return [each.data for each in records if isinstance(each, Message)]


def test_each_look_gives_what_was_flushed_since_the_last_and_nothing_twice(tmp_path: Path) -> None:
    recorder = opened(tmp_path, "growing")
    recorder.tick(START_NS)
    following = Following(recorder.path)
    looks = []
    now_ns = START_NS
    for number in range(300):
        recorder.write(position_frame(number), now_ns)
        now_ns += 20 * MS
        if now_ns >= recorder.deadline_ns:
            recorder.tick(now_ns)
            looks.append(messages([*following.new_records()]))
            assert messages([*following.new_records()]) == []
    closed_before = following.condition.closed
    assert len(looks) == pytest.approx(300 * 20 * MS / FLUSH_NS, abs=1)
    assert all(looks)
    recorder.close(now_ns)
    looks.append(messages([*following.new_records()]))
    assert (closed_before, following.condition.closed) == (False, True)
    seen = [data for look in looks for data in look]
    assert seen == [each.data for each in messages_of(recorder.path)]


def test_a_record_is_over_when_a_copy_takes_its_place(tmp_path: Path) -> None:
    recorder = opened(tmp_path, "replaced")
    for number, item in enumerate(a_flight()):
        recorder.write(item, START_NS + number * MS)
    recorder.tick(START_NS + FLUSH_NS)
    following = Following(recorder.path)
    assert messages([*following.new_records()])
    recorder.close(START_NS + FLUSH_NS)
    copy = tmp_path / "copy"
    copy.write_bytes(recorder.path.read_bytes()[:40])
    os.replace(copy, recorder.path)
    assert [*following.new_records()] == []
    assert following.condition.closed


def test_what_is_no_record_is_told(tmp_path: Path) -> None:
    file = tmp_path / "text.mcap"
    file.write_bytes(b"text and more of it")
    with pytest.raises(BadRecordError):
        Following(file)
    file.write_bytes(b"\x89MCAP0\r\n" + b"\x06" + b"\xff" * 8)
    with pytest.raises(BadRecordError, match="damaged"):
        list(Following(file).new_records())


def test_a_file_that_has_only_begun_is_waited_for(tmp_path: Path) -> None:
    file = tmp_path / "new.mcap"
    file.write_bytes(b"")
    following = Following(file)
    assert [*following.new_records()] == []
    file.write_bytes(b"\x89MCAP0\r\n\x06\x10")
    assert [*following.new_records()] == []
    assert not following.condition.closed
