"""Columns: every value as pymavlink decodes it, from a .tlog and from a record."""

from __future__ import annotations

import math
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import gcs
from gcs.mcap_file.errors import BadLogError
from gcs.record.writer import Recorder
from gcs.report import Direction, FrameItem
from gcs.wire.dialect import MESSAGES_BY_NAME
from tests.sample_files import elsewhere
from tests.shares import one_in
from tests.unit.logfile.tlogs import START_US, flight, read_by_pymavlink, write

HEAD = 4


def decoded(message: Any, names: list[str]) -> list[object]:
    """The values of a message of pymavlink; text as bytes; 0 for a field that it does not know."""
    values: list[object] = []
    for name in names:
        value = getattr(message, name) if name in message.fieldnames else 0
        values.append(value.encode("latin1") if isinstance(value, str) else value)
    return values


def same(ours: object, theirs: object) -> bool:
    if isinstance(theirs, list | tuple):
        return all(map(same, list(np.asarray(ours).tolist()), theirs))
    if isinstance(theirs, bytes):
        return ours == theirs.split(b"\0")[0]
    if isinstance(theirs, float) and math.isnan(theirs):
        return math.isnan(float(np.float64(ours)))  # type: ignore[arg-type]
    return ours == theirs


REAL_FLIGHTS = ("arducopter_sitl.tlog", "quad_2015.tlog")


@pytest.mark.slow
@pytest.mark.parametrize(
    "parts",
    one_in(2, [pytest.param(("logs", name), id=name) for name in REAL_FLIGHTS]),
)
def test_every_message_of_a_real_flight_is_as_pymavlink_decodes_it(parts: tuple[str, str]) -> None:
    path = elsewhere(*parts)
    kinds: dict[str, list[Any]] = {}
    for message in read_by_pymavlink(path):
        if message.get_type() != "BAD_DATA":
            kinds.setdefault(message.get_type(), []).append(message)
    assert len(kinds) > 30
    for kind, messages in kinds.items():
        found = gcs.columns(path, kind)
        assert found.dtype.names is not None
        names = list(found.dtype.names[HEAD:])
        assert len(found) == len(messages), kind
        for row, message in zip(found.tolist(), messages, strict=True):
            assert all(map(same, row[HEAD:], decoded(message, names))), kind
            assert row[0] == round(message._timestamp * 1e6) * 1000
            source = (message.get_seq(), message.get_srcSystem(), message.get_srcComponent())
            assert row[1:HEAD] == source


@pytest.fixture
def record(tmp_path: Path) -> Path:
    """Two vehicles, MAVLink 1 and 2, 600 frames."""
    recorder = Recorder.open(tmp_path, "test", "20260101-000000", START_US * 1000)
    now_ns = START_US * 1000
    pairs = zip(flight(300), flight(300, mavlink1=True, sysid=2, seed=2), strict=True)
    for frame in (frame for pair in pairs for frame in pair):
        recorder.write(FrameItem(0, Direction.RECEIVED, frame), now_ns)
        now_ns += 10_000_000
        if now_ns >= recorder.deadline_ns:
            recorder.tick(now_ns)
    assert recorder.close(now_ns)
    return recorder.path


@pytest.mark.parametrize(
    "name", ["LOCAL_POSITION_NED", "ATTITUDE", "STATUSTEXT", "PARAM_VALUE", "HEARTBEAT"]
)
def test_a_record_and_a_tlog_of_the_same_frames_give_the_same(
    tmp_path: Path, record: Path, name: str
) -> None:
    pairs = zip(flight(300), flight(300, mavlink1=True, sysid=2, seed=2), strict=True)
    frames = [frame for pair in pairs for frame in pair]
    tlog = write(tmp_path / "a.tlog", frames, step_us=10_000)
    mine, theirs = gcs.columns(record, name), gcs.columns(tlog, name)
    assert len(mine) == 100
    assert mine.tobytes() == theirs.tobytes()


def test_one_vehicle_can_be_asked_for(record: Path) -> None:
    one = gcs.columns(record, "ATTITUDE", sysid=1)
    two = gcs.columns(record, "ATTITUDE", sysid=2, compid=1)
    assert (len(one), len(two)) == (50, 50)
    assert set(one["sysid"].tolist()) == {1}
    assert len(gcs.columns(record, "ATTITUDE", compid=9)) == 0


def test_a_record_that_was_not_closed_is_read_as_far_as_it_goes(
    tmp_path: Path, record: Path
) -> None:
    whole = record.read_bytes()
    killed = tmp_path / "killed.mcap"
    killed.write_bytes(whole[: len(whole) * 2 // 3])
    found = gcs.columns(killed, "ATTITUDE")
    every = gcs.columns(record, "ATTITUDE")
    assert 0 < len(found) < len(every)
    assert found.tobytes() == every[: len(found)].tobytes()


def test_the_fields_are_the_dialects(record: Path) -> None:
    found = gcs.columns(record, "MISSION_CURRENT")
    assert found.dtype.names is not None
    expected = [field.name for field in MESSAGES_BY_NAME["MISSION_CURRENT"].fields]
    assert list(found.dtype.names) == ["time_ns", "frame_seq", "sysid", "compid", *expected]


def test_nothing_of_a_kind_is_an_empty_array(record: Path) -> None:
    assert len(gcs.columns(record, "GPS_RAW_INT")) == 0


def test_a_message_that_does_not_exist_is_a_key_error(record: Path) -> None:
    with pytest.raises(KeyError, match="NO_SUCH"):
        gcs.columns(record, "NO_SUCH")


def test_a_file_that_is_neither_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_bytes(b"hello")
    with pytest.raises(BadLogError, match="no MAVLink frame"):
        gcs.columns(tmp_path / "a.txt", "ATTITUDE")


def test_a_summary_that_lies_is_not_believed(tmp_path: Path, record: Path) -> None:
    """Lengths and places of 2^63 in the chunk index: no endless memory, no traceback."""
    raw = bytearray(record.read_bytes())
    footer = len(raw) - 8 - 20
    (summary,) = struct.unpack_from("<Q", raw, footer)
    at, spoilt = summary, 0
    while at < footer - 9:
        opcode, length = struct.unpack_from("<BQ", raw, at)
        if opcode == 0x08:
            struct.pack_into("<Q", raw, at + 9 + 24, 2**63)
            spoilt += 1
        at += 9 + length
    assert spoilt
    bad = tmp_path / "bad.mcap"
    bad.write_bytes(raw)
    assert len(gcs.columns(bad, "ATTITUDE")) <= 100
