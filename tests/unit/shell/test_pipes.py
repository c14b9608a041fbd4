"""The link's pipes: whole lines in, bounded lines out."""

from __future__ import annotations

import os
import select
import threading
from types import SimpleNamespace

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


@pytest.fixture(params=["posix", "win32"])
def platform(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    """On Windows threads read and write the pipes; they work here as well."""
    platform: str = request.param
    monkeypatch.setattr("gcs.shell.pipes.sys", SimpleNamespace(platform=platform))
    return platform


FILLER = b"filler\n" * 100
MORE_THAN_A_PIPE = 1000
"""So many fillers are more than any system's pipe takes, and fewer than a sink gives up at."""


@pytest.mark.usefixtures("platform")
def test_what_waits_at_the_end_is_written_as_the_reader_reads(pipe: tuple[int, int]) -> None:
    sink = LineSink(pipe[1])
    for _ in range(MORE_THAN_A_PIPE):
        sink.put(FILLER)
    sink.put(b"bye\n")
    got: list[bytes] = []

    def read_all() -> None:
        with os.fdopen(pipe[0], "rb") as reader:
            got.append(reader.read())

    reading = threading.Thread(target=read_all)
    reading.start()
    try:
        sink.drain(60.0)
    finally:
        os.close(pipe[1])
        reading.join()
    assert got == [FILLER * MORE_THAN_A_PIPE + b"bye\n"]


@pytest.mark.usefixtures("platform")
def test_a_reader_that_does_not_read_at_the_end_is_not_waited_for(pipe: tuple[int, int]) -> None:
    sink = LineSink(pipe[1])
    for _ in range(MORE_THAN_A_PIPE):
        sink.put(FILLER)
    sink.drain(0.0)
    assert not sink.broken
    os.close(pipe[0])
    sink.drain(60.0)
    assert sink.broken


@pytest.mark.usefixtures("platform")
def test_lines_come_through_whichever_way_the_platform_reads(pipe: tuple[int, int]) -> None:
    source = LineSource(pipe[0])
    os.write(pipe[1], b"one\ntwo\nthr")
    os.close(pipe[1])
    lines: list[bytes] = []
    while not source.ended:
        assert select.select([source], [], [], 60.0)[0] == [source]
        lines += source.read()
    assert lines == [b"one", b"two", b"thr"]


def test_a_sink_that_hangs_up_ends_the_file_after_what_is_queued(pipe: tuple[int, int]) -> None:
    sink = LineSink(pipe[1])
    line = b"x" * 999 + b"\n"
    for _ in range(100):  # more than the pipe holds
        sink.put(line)
    sink.hang_up()
    sink.put(b"too late\n")
    read = b""
    while piece := os.read(pipe[0], 1 << 16):
        read += piece
        sink.flush()
    assert read == line * 100
    os.write(pipe[1], b"into the null device")
    os.close(pipe[0])
    os.close(pipe[1])
