"""A recorder that is killed: what was flushed is never lost, and the file can be made whole."""

from __future__ import annotations

import random
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import foxglove
import lz4.frame  # type: ignore[import-untyped]  # the package has no types
import pytest
from foxglove.mcap import MCAPCompression, MCAPWriteOptions
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.opcode import Opcode
from mcap.reader import make_reader
from mcap.records import Attachment

from gcs.mcap_file.errors import BadRecordError
from gcs.mcap_file.reader import Reading
from gcs.record import ros1
from gcs.record.check import check
from gcs.record.recover import recover
from gcs.report import Direction, FrameItem
from tests.shares import examples, one_in
from tests.unit.record.flights import MS, START_NS, a_flight, frame_v2, messages_of, opened, record


@dataclass(frozen=True)
class Killed:
    """A recording as the kill left it, and what had been flushed when: (bytes, messages)."""

    data: bytes
    flushed: tuple[tuple[int, int], ...]
    frames: tuple[bytes, ...]


@cache
def killed() -> Killed:
    """Four seconds of a fast link with payloads that do not compress, never closed."""
    rng = random.Random(1)
    frames, flushed = [], []
    with TemporaryDirectory() as folder:
        recorder = opened(Path(folder), "killed")
        for number in range(2000):
            now_ns = START_NS + number * 2 * MS
            if now_ns >= recorder.deadline_ns:
                recorder.tick(now_ns)
                flushed.append((recorder.bytes_written, number))
            raw = frame_v2(110, rng.randbytes(253) + b"\1")  # FILE_TRANSFER_PROTOCOL
            frames.append(raw)
            recorder.write(FrameItem(0, Direction.RECEIVED, raw), now_ns)
        data = recorder.path.read_bytes()
        recorder.close(START_NS)
    return Killed(data, tuple(flushed), tuple(frames))


def recovered_frames(path: Path) -> list[bytes]:
    """Through the library's indexed reader, which wants a whole file."""
    with open(path, "rb") as file:
        return [ros1.rebuild(message.data) for *_, message in make_reader(file).iter_messages()]


@settings(max_examples=examples(40), deadline=None)
@given(offset=st.integers(8, len(killed().data)))
def test_a_file_cut_anywhere_gives_back_all_that_was_flushed(offset: int) -> None:
    with TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "cut.mcap").write_bytes(killed().data[:offset])
        saved = recover(folder / "cut.mcap", folder / "whole.mcap")
        found = recovered_frames(folder / "whole.mcap")
    at_least = max((count for size, count in killed().flushed if size <= offset), default=0)
    assert len(found) >= at_least
    assert found == list(killed().frames[: len(found)])
    assert saved.messages == len(found)
    assert not saved.condition.closed


def test_of_a_chunk_that_breaks_off_the_messages_before_the_break_are_saved(
    tmp_path: Path,
) -> None:
    (size, count) = killed().flushed[-1]
    (before_size, before_count) = killed().flushed[-2]
    cut = tmp_path / "cut.mcap"
    cut.write_bytes(killed().data[: before_size + (size - before_size) * 9 // 10])
    saved = recover(cut, tmp_path / "whole.mcap")
    assert saved.condition.broken_chunk
    assert before_count < saved.messages < count


def test_a_kill_loses_less_than_a_second() -> None:
    (_, count) = killed().flushed[-1]
    assert (len(killed().frames) - count) * 2 * MS < 1000 * MS


@pytest.mark.parametrize("compression", [MCAPCompression.Lz4, MCAPCompression.Zstd, None])
def test_a_last_chunk_of_unknown_length_is_read_to_the_end(
    tmp_path: Path, compression: MCAPCompression | None
) -> None:
    """A writer that seeks leaves 2^64-1 in the header of the chunk it is in."""
    rng = random.Random(2)
    options = MCAPWriteOptions(
        compression=compression, chunk_size=200_000, disable_seeking=False, compression_threads=0
    )
    context = foxglove.Context()
    whole = tmp_path / "open.mcap"
    with open(whole, "xb", buffering=0) as file:
        mcap = foxglove.open_mcap(file, context=context, writer_options=options)
        schema = foxglove.Schema(name="x/X", encoding="ros1msg", data=b"uint8 a")
        channel = foxglove.Channel("/x", message_encoding="ros1", schema=schema, context=context)
        for number in range(3000):
            channel.log(rng.randbytes(200), log_time=START_NS + number)
        data = whole.read_bytes()
        mcap.close()
    killed_here = tmp_path / "killed.mcap"
    killed_here.write_bytes(data)
    last_chunk = chunks_of(data)[-1]
    assert struct.unpack_from("<Q", data, last_chunk + 1) == (2**64 - 1,)
    complete = len(messages_of_prefix(tmp_path, data[:last_chunk]))
    saved = recover(killed_here, tmp_path / "whole.mcap")
    assert saved.condition.broken_chunk
    assert complete > 0
    if compression is MCAPCompression.Zstd:  # no block of it had been written out yet
        assert saved.messages == complete
    else:
        assert saved.messages > complete
    with open(tmp_path / "whole.mcap", "rb") as file:
        times = [message.log_time for *_, message in make_reader(file).iter_messages()]
    assert times == [START_NS + number for number in range(saved.messages)]


def chunks_of(data: bytes) -> list[int]:
    """Offsets of the chunk records."""
    found, at = [], 8
    while at + 9 <= len(data):
        opcode, length = struct.unpack_from("<BQ", data, at)
        if opcode == 6:
            found.append(at)
        at += 9 + length
    return found


def messages_of_prefix(folder: Path, data: bytes) -> list[object]:
    prefix = folder / "prefix.mcap"
    prefix.write_bytes(data)
    return list(messages_of(prefix))


def test_a_whole_file_is_copied_with_attachments_and_metadata(tmp_path: Path) -> None:
    source = record(tmp_path, a_flight())
    saved = recover(source, tmp_path / "copy.mcap")
    assert saved.condition.closed
    assert (saved.attachments, saved.metadata) == (1, 1)
    assert messages_of(tmp_path / "copy.mcap") == messages_of(source)


def test_an_attachment_whose_length_is_damaged_is_left_out(tmp_path: Path) -> None:
    """No bytes are as many as it says."""
    path = record(tmp_path, a_flight())
    data = bytearray(path.read_bytes())
    whole = Reading(path)
    others = [found for found in whole if not isinstance(found, Attachment)]
    assert whole.condition.damaged == 0
    length_at = data.index(b"text/toml") + len(b"text/toml")
    data[length_at : length_at + 8] = b"\xff" * 8
    path.write_bytes(data)
    damaged = Reading(path)
    assert list(damaged) == others
    assert damaged.condition.damaged == 1


def test_a_damaged_chunk_is_left_out_and_the_rest_is_saved(tmp_path: Path) -> None:
    data = bytearray(killed().data)
    second, third = chunks_of(bytes(data))[1:3]
    data[third - 2000] ^= 0xFF  # inside the second chunk or its index
    data[second + 5000] ^= 0xFF
    damaged = tmp_path / "damaged.mcap"
    damaged.write_bytes(data)
    saved = recover(damaged, tmp_path / "whole.mcap")
    assert saved.condition.damaged == 1
    found = recovered_frames(tmp_path / "whole.mcap")
    assert set(found) < set(killed().frames)
    assert found[-1] == killed().frames[killed().flushed[-1][1] - 1]


@settings(max_examples=examples(60), deadline=None)
@given(
    offset=st.integers(8, len(killed().data) - 1),
    garbage=st.binary(min_size=1, max_size=40),
)
def test_garbage_in_the_file_is_never_a_crash(offset: int, garbage: bytes) -> None:
    data = bytearray(killed().data[: 300 * 1024])
    offset %= len(data)
    offset = max(8, offset)
    data[offset : offset + len(garbage)] = garbage
    with TemporaryDirectory() as name:
        path = Path(name) / "x.mcap"
        path.write_bytes(data)
        reading = Reading(path)
        assert sum(1 for _ in reading) >= 0
        assert reading.condition.position == reading.condition.size


PARTS = 8
"""Every eighth record in each of so many tests."""


@pytest.mark.slow
@pytest.mark.parametrize("part", one_in(PARTS, range(PARTS)))
def test_a_cut_at_every_kind_of_record_gives_back_all_before_it_and_a_good_file(
    tmp_path: Path, part: int
) -> None:
    """At the beginning, in the head and in the middle of each record that the recorder writes."""
    data = record(tmp_path, a_flight() * 8, step_ns=50 * MS).read_bytes()
    found = list(records_of(data))
    chunk, footer = Opcode.CHUNK, Opcode.FOOTER
    assert {opcode for _, opcode, _ in found} >= {
        Opcode.HEADER,
        chunk,
        Opcode.MESSAGE_INDEX,
        Opcode.ATTACHMENT,
        Opcode.METADATA,
        Opcode.DATA_END,
        Opcode.SCHEMA,
        Opcode.CHANNEL,
        Opcode.STATISTICS,
        Opcode.CHUNK_INDEX,
        Opcode.ATTACHMENT_INDEX,
        Opcode.METADATA_INDEX,
        Opcode.SUMMARY_OFFSET,
        footer,
    }
    for at, opcode, size in found[part::PARTS]:
        whole = sum(1 for start, kind, length in found if kind == chunk and start + length <= at)
        before = messages_of_prefix(tmp_path, data[:at])
        for cut in {at, at + 1, at + 9, at + size // 2}:
            (tmp_path / "cut.mcap").write_bytes(data[:cut])
            saved = recover(tmp_path / "cut.mcap", tmp_path / "whole.mcap")
            got = list(messages_of(tmp_path / "whole.mcap"))
            assert got[: len(before)] == before, (opcode, cut)
            assert (len(before) > 0) == (whole > 0)
            assert not saved.condition.closed
            assert check(tmp_path / "whole.mcap").good
            (tmp_path / "whole.mcap").unlink()


def records_of(data: bytes) -> Iterator[tuple[int, int, int]]:
    """Where each record begins, its kind, and its size with its head."""
    at = 8
    while at + 9 <= len(data) - 8:
        opcode, length = struct.unpack_from("<BQ", data, at)
        yield at, opcode, 9 + length
        at += 9 + length


def test_a_chunk_that_unpacks_to_far_more_than_records_do_is_an_error(tmp_path: Path) -> None:
    """A file of 0.1 MB that would hold a million messages."""
    message = struct.pack("<BQHIQQ", Opcode.MESSAGE, 22, 1, 0, 0, 0)
    body = message * 1_000_000
    packed = lz4.frame.compress(body)
    head = struct.pack("<QQQII", 0, 1, len(body), 0, 3) + b"lz4" + struct.pack("<Q", len(packed))
    chunk = struct.pack("<BQ", Opcode.CHUNK, len(head) + len(packed)) + head + packed
    path = tmp_path / "bomb.mcap"
    path.write_bytes(b"\x89MCAP0\r\n" + chunk)
    with pytest.raises(BadRecordError, match="unpack to 31000000"):
        next(iter(Reading(path)))
