"""`gcs log replay`: which frames are played, and what is wrong is told."""

from __future__ import annotations

import struct
from contextlib import suppress
from io import BytesIO
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.exit_codes import ExitCode
from gcs.mcap_file.errors import BadRecordError
from gcs.mcap_file.reader import Reading
from gcs.replay.frames import vehicle_frames
from gcs.report import Direction, FrameItem
from tests.unit.cli.command_line import gcs
from tests.unit.record.flights import MS, a_flight, frame_v1, frame_v2, position_frame, record


def beat(mav_type: int, source: tuple[int, int]) -> bytes:
    return frame_v1(0, struct.pack("<IBBBBB", 0, mav_type, 12, 81, 4, 3), source=source)


def received(raw: bytes) -> FrameItem:
    return FrameItem(0, Direction.RECEIVED, raw)


def test_only_what_vehicles_sent_is_played_byte_by_byte_in_order(tmp_path: Path) -> None:
    signed = frame_v2(30, bytes(range(28)), signed=True)
    unknown = frame_v2(54321, b"\x01\x02\x03")
    of_vehicle = [beat(2, (1, 1)), position_frame(3).raw, signed, unknown, beat(2, (7, 1))]
    others = [
        FrameItem(0, Direction.SENT, beat(6, (255, 190))),
        FrameItem(0, Direction.REFUSED, position_frame(1).raw),
        received(beat(6, (252, 190))),
        received(frame_v1(76, bytes(33), source=(252, 190))),
    ]
    items = [*others, *map(received, of_vehicle), *others]
    file = record(tmp_path, items, step_ns=10 * MS)
    frames = vehicle_frames(Reading(file), BytesIO())
    assert [frames.read(number) for number in range(len(frames))] == of_vehicle
    assert [*frames.times_ns] == [frames.times_ns[0] + number * 10 * MS for number in range(5)]
    assert frames.left_out == 2 * len(others)
    part = vehicle_frames(Reading(file), BytesIO(), from_s=0.05, to_s=0.07)
    assert [part.read(number) for number in range(len(part))] == of_vehicle[1:4]
    alone = vehicle_frames(Reading(file), BytesIO(), sysid=7)
    assert [alone.read(number) for number in range(len(alone))] == of_vehicle[4:]


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (("--link", "nonsense"), ExitCode.USAGE, "no known kind of endpoint"),
        (("--link", "tcpout://127.0.0.1:9"), ExitCode.USAGE, "over UDP only"),
        (("--from", "1000"), ExitCode.BAD_FILE, "no frame of a vehicle in it in that time"),
        (("--vehicle", "9"), ExitCode.BAD_FILE, "no frame of a vehicle"),
        (("--speed", "0"), ExitCode.USAGE, "--speed"),
    ],
)
def test_what_is_wrong_is_told(
    tmp_path: Path, words: tuple[str, ...], code: ExitCode, said: str
) -> None:
    ended = gcs("log", "replay", record(tmp_path, a_flight()), *words)
    assert (ended.exit_code, said in ended.output) == (code, True), ended.output


@given(data=st.data())
def test_any_damage_is_told_or_passed_over(
    tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    directory = tmp_path_factory.mktemp("damaged")
    file = record(directory, a_flight())
    whole = bytearray(file.read_bytes())
    for _ in range(data.draw(st.integers(1, 5))):
        whole[data.draw(st.integers(0, len(whole) - 1))] = data.draw(st.integers(0, 255))
    file.write_bytes(whole)
    with suppress(BadRecordError):
        frames = vehicle_frames(Reading(file), BytesIO())
        assert all(frames.read(number) for number in range(len(frames)))


@pytest.mark.parametrize("data", [b"", b"text\n", bytes(8) + b"\xfe\x09", b"\x89MCAP0\r\n"])
def test_what_is_no_record_ends_with_exit_4(tmp_path: Path, data: bytes) -> None:
    file = tmp_path / "broken.mcap"
    file.write_bytes(data)
    assert gcs("log", "replay", file).exit_code == ExitCode.BAD_FILE
