"""A finished record in larger chunks: the same messages, and the old file after any error."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from mcap.reader import make_reader
from mcap.records import Attachment, Metadata

from gcs.mcap_file.copier import CHUNK_BYTES
from gcs.mcap_file.errors import BadRecordError
from gcs.mcap_file.reader import Reading
from gcs.record import compact as module
from gcs.record.compact import NotCompactedError, compact, compact_in_background
from tests.unit.cli.command_line import gcs
from tests.unit.record.flights import MS, SECOND, START_NS, a_flight, messages_of, opened, record

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """40 s at 400 messages a second: 50 flushes.  Written once; nobody changes it."""
    folder = tmp_path_factory.mktemp("recorded")
    return record(folder / "logs", a_flight() * 1000, step_ns=5 * MS // 2)


@pytest.fixture
def flight(recorded: Path, tmp_path: Path) -> Path:
    """A copy, for one test."""
    path = tmp_path / "logs" / recorded.name
    path.parent.mkdir()
    path.write_bytes(recorded.read_bytes())
    return path


def others(path: Path) -> list[Attachment | Metadata]:
    return [found for found in Reading(path) if isinstance(found, Attachment | Metadata)]


def chunks(path: Path) -> list[int]:
    """The size of each, in bytes before compression."""
    with open(path, "rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    return [index.uncompressed_size for index in summary.chunk_indexes]


def test_messages_attachments_and_time_of_change_stay_and_chunks_are_few(flight: Path) -> None:
    os.utime(flight, (1000, 2000))
    messages, attached, many = messages_of(flight), others(flight), chunks(flight)
    done = compact(flight)
    assert messages_of(flight) == messages
    assert others(flight) == attached
    assert flight.stat().st_mtime == 2000
    assert len(many) >= 50
    assert min(chunks(flight)[:-1]) >= CHUNK_BYTES > max(many)
    assert done.messages == len(messages)
    assert done.bytes_after == flight.stat().st_size < 0.8 * done.bytes_before
    assert list(flight.parent.iterdir()) == [flight]


def test_the_librarys_indexed_reader_finds_every_message(flight: Path) -> None:
    times = [message.log_time_ns for message in messages_of(flight)]
    compact(flight)
    with open(flight, "rb") as file:
        assert [message.log_time for *_, message in make_reader(file).iter_messages()] == times


def test_a_file_that_is_not_closed_stays_as_it_is(flight: Path) -> None:
    flight.write_bytes(flight.read_bytes()[:-20])
    unchanged(flight, NotCompactedError, "not whole")


def test_a_file_with_a_damaged_chunk_stays_as_it_is(flight: Path) -> None:
    data = bytearray(flight.read_bytes())
    data[len(data) // 4] ^= 0xFF  # inside the first chunk
    flight.write_bytes(data)
    unchanged(flight, NotCompactedError, "not whole")


def test_what_is_no_record_stays_as_it_is(tmp_path: Path) -> None:
    text = tmp_path / "x.mcap"
    text.write_text("a text of some length")
    unchanged(text, BadRecordError, "not an MCAP")


def test_a_full_disk_leaves_the_file_and_nothing_else(
    flight: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_: Path) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(module, "_to_disk", full)
    unchanged(flight, OSError, "No space")


def test_a_ctrl_c_leaves_the_file_and_nothing_else(flight: Path) -> None:
    def pressed(_: object) -> None:
        raise KeyboardInterrupt

    before = flight.read_bytes()
    with pytest.raises(KeyboardInterrupt):
        compact(flight, pressed)
    assert flight.read_bytes() == before
    assert list(flight.parent.iterdir()) == [flight]


@pytest.mark.parametrize("at", [1000, -3000])
def test_a_copy_that_reads_otherwise_does_not_take_the_place(
    flight: Path, monkeypatch: pytest.MonkeyPatch, at: int
) -> None:
    """A byte of a chunk, and one of the index."""
    to_disk = module._digest_of

    def damaged(copy: Path) -> module._Digest:
        data = bytearray(copy.read_bytes())
        data[at] ^= 0xFF
        copy.write_bytes(data)
        return to_disk(copy)

    monkeypatch.setattr(module, "_digest_of", damaged)
    unchanged(flight, NotCompactedError, "does not read back")


def test_one_compaction_at_a_time_and_a_killed_ones_copy_is_removed(flight: Path) -> None:
    copy = flight.with_name(f".{flight.name}.compacting")
    copy.write_text("being written")
    before = flight.read_bytes()
    with pytest.raises(NotCompactedError, match="already"):
        compact(flight)
    assert (flight.read_bytes(), copy.read_text()) == (before, "being written")
    os.utime(copy, (1000, 1000))
    compact(flight)
    assert list(flight.parent.iterdir()) == [flight]


def unchanged(path: Path, error: type[Exception], reason: str) -> None:
    before = path.read_bytes()
    with pytest.raises(error, match=reason):
        compact(path)
    assert path.read_bytes() == before
    assert list(path.parent.iterdir()) == [path]


# ---------------------------------------------------------------------------------- programs


def test_the_command_tells_what_it_did(flight: Path) -> None:
    messages = messages_of(flight)
    ended = gcs("log", "compact", flight)
    assert ended.exit_code == 0, ended.output
    assert f"{len(messages)} messages, " in ended.output
    assert messages_of(flight) == messages


def test_the_command_on_a_killed_file_says_what_to_do(tmp_path: Path) -> None:
    recorder = opened(tmp_path)
    recorder.write(a_flight()[5], START_NS)
    recorder.tick(START_NS + SECOND)
    killed = tmp_path / "killed.mcap"
    killed.write_bytes(recorder.path.read_bytes())
    recorder.close(START_NS + SECOND)
    ended = gcs("log", "compact", killed)
    assert ended.exit_code == 4
    assert "not whole: gcs log recover" in ended.output


def test_only_large_files_are_compacted_in_the_background(
    flight: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    started: list[list[str]] = []
    monkeypatch.setattr(subprocess, "Popen", lambda args, **_: started.append(args))
    size = flight.stat().st_size
    monkeypatch.setattr(module, "SMALL_BYTES", size + 1)
    compact_in_background([tmp_path / "missing.mcap", flight])
    assert started == []
    monkeypatch.setattr(module, "SMALL_BYTES", size)
    compact_in_background([flight])
    assert started == [[sys.executable, "-m", "gcs.record.compact", str(flight)]]
