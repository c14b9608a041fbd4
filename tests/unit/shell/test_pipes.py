"""The link's pipes: whole lines in, bounded lines out."""

from __future__ import annotations

import os

import pytest

from gcs.shell.pipes import MAX_LINE_BYTES, MAX_QUEUED_BYTES, LineSink, LineSource


@pytest.fixture
def pipe() -> tuple[int, int]:
    return os.pipe()


def test_a_line_that_comes_in_pieces_is_one_line(pipe: tuple[int, int]) -> None:
    source = LineSource(pipe[0])
    os.write(pipe[1], b'{"a":')
    assert source.read() == []
    os.write(pipe[1], b"1}\nsecond\nthi")
    assert source.read() == [b'{"a":1}', b"second"]
    os.close(pipe[1])
    assert source.read() == [b"thi"]
    assert source.ended


def test_a_line_without_end_is_cut_and_does_not_grow(pipe: tuple[int, int]) -> None:
    source = LineSource(pipe[0])
    told: list[bytes] = []
    for _ in range(4):
        os.write(pipe[1], b"x" * (MAX_LINE_BYTES // 2))
        told += source.read()
    assert told
    assert all(len(line) <= 2 * MAX_LINE_BYTES for line in told)


def test_a_full_pipe_drops_snapshots_and_keeps_the_rest_in_order(pipe: tuple[int, int]) -> None:
    sink = LineSink(pipe[1])
    for _ in range(200):
        sink.put(b"filler\n" * 100)
    sink.offer(b"snapshot\n")
    sink.put(b"verdict\n")
    assert sink.dropped == 1
    got = b""
    while sink.waiting:
        got += os.read(pipe[0], 1 << 16)
        sink.flush()
    got += os.read(pipe[0], 1 << 16)
    assert got.endswith(b"filler\nverdict\n")
    assert b"snapshot" not in got


def test_a_reader_that_never_reads_is_given_up(pipe: tuple[int, int]) -> None:
    sink = LineSink(pipe[1])
    for _ in range(2 + MAX_QUEUED_BYTES // 60_000 + 2):
        sink.put(b"y" * 60_000)
    assert sink.broken
    assert not sink.waiting


def test_a_reader_that_is_gone_breaks_the_sink_and_nothing_else(pipe: tuple[int, int]) -> None:
    sink = LineSink(pipe[1])
    os.close(pipe[0])
    sink.put(b"hello\n")
    assert sink.broken
