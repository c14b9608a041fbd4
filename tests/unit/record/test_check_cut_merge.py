"""`gcs log check | cut | merge`, as a user calls them, on good, broken and several records."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.reader import make_reader
from mcap.records import Attachment, Metadata
from mcap.writer import Writer

from gcs.mcap_file.errors import BadRecordError
from gcs.mcap_file.reader import Reading
from gcs.record.check import check
from gcs.record.parts import Rotation
from gcs.report import ParamItem, PoseItem
from tests.shares import examples
from tests.unit.cli.command_line import Ended, gcs
from tests.unit.record.flights import (
    MS,
    SECOND,
    START_NS,
    a_flight,
    messages_of,
    opened,
    position_frame,
    record,
)


def gcs_log(*args: str | Path) -> Ended:
    return gcs("log", *args)


@pytest.fixture
def flight(tmp_path: Path) -> Path:
    """One of everything in 1.6 s, then 20 s of positions."""
    return record(tmp_path, a_flight() + [position_frame(n) for n in range(200)], step_ns=100 * MS)


def kinds(path: Path) -> dict[str, int]:
    return check(path).counts


# ----------------------------------------------------------------------------------- check


def test_what_the_recorder_wrote_is_good(flight: Path) -> None:
    ended = gcs_log("check", flight)
    assert ended.exit_code == 0, ended.output
    assert f"good: {len(messages_of(flight))} messages" in ended.output
    assert check(flight).not_decoded == 0


def test_a_file_that_was_not_closed_is_not_good(flight: Path) -> None:
    flight.write_bytes(flight.read_bytes()[: flight.stat().st_size * 9 // 10])
    ended = gcs_log("check", flight)
    assert ended.exit_code == 1
    assert "file: it was not closed" in ended.output
    assert "hint: gcs log recover" in ended.output


def offsets(data: bytes, wanted: int) -> list[int]:
    """Where the bodies of the records of a kind begin."""
    found, at = [], 8
    while at + 9 <= len(data):
        opcode, length = struct.unpack_from("<BQ", data, at)
        if opcode == wanted:
            found.append(at + 9)
        at += 9 + length
    return found


@pytest.mark.parametrize(
    ("opcode", "into", "kind"),
    [
        (0x06, 60, "file"),  # a chunk
        (0x07, 8, "index"),  # the log_time of a message index's first entry
        (0x0B, 0, "index"),  # the statistics' count of messages
        (0x08, 17, "index"),  # a chunk index's offset
    ],
)
def test_a_byte_that_is_not_as_written_is_found(
    flight: Path, opcode: int, into: int, kind: str
) -> None:
    data = bytearray(flight.read_bytes())
    data[offsets(bytes(data), opcode)[0] + into] ^= 0x01
    flight.write_bytes(data)
    assert kind in kinds(flight)
    assert gcs_log("check", flight).exit_code == 1


def written(path: Path, schema: str, encoding: str, messages: list[tuple[int, bytes]]) -> Path:
    with open(path, "wb") as file:
        writer = Writer(file)
        writer.start()
        number = writer.register_schema("x", schema, b"x") if schema else 7
        channel = writer.register_channel("/x", encoding, number)
        for at_ns, data in messages:
            writer.add_message(channel, at_ns, data, at_ns)
        writer.finish()  # type: ignore[no-untyped-call]  # mcap leaves it bare
    return path


@pytest.mark.parametrize(
    ("schema", "encoding", "messages", "found"),
    [
        ("jsonschema", "json", [(1, b"{}"), (2, b"[1]")], {}),
        ("jsonschema", "json", [(1, b"{"), (2, b"")], {"message": 2}),
        ("jsonschema", "json", [(2, b"{}"), (1, b"{}")], {"order": 1}),
        ("jsonschema", "protobuf", [(1, b"\x08\x01")], {"channel": 1}),
        ("", "json", [(1, b"{}")], {"channel": 1}),
        ("protobuf", "protobuf", [(1, b"\x08\x96\x01"), (2, b"\x12\x02ab"), (3, b"")], {}),
        ("protobuf", "protobuf", [(1, b"\x08"), (2, b"\x12\x05ab"), (3, b"\xff")], {"message": 3}),
        ("ros1msg", "cdr", [(1, b"?")], {}),
    ],
)
def test_other_tools_files_are_checked_too(
    tmp_path: Path,
    schema: str,
    encoding: str,
    messages: list[tuple[int, bytes]],
    found: dict[str, int],
) -> None:
    assert kinds(written(tmp_path / "x.mcap", schema, encoding, messages)) == found


def test_of_many_findings_a_few_are_told_and_all_counted(tmp_path: Path) -> None:
    path = written(tmp_path / "x.mcap", "jsonschema", "json", [(n, b"{") for n in range(100)])
    ended = gcs_log("check", path)
    assert ended.output.count("  message: message") == 5
    assert "message: 95 more" in ended.output
    found = json.loads(gcs_log("check", path, "--json").output)
    assert (found["good"], found["counts"]) == (False, {"message": 100})


@pytest.mark.slow
@settings(max_examples=examples(60), deadline=None)
@given(data=st.data())
def test_garbage_in_a_file_is_found_or_harmless_and_never_a_crash(data: st.DataObject) -> None:
    with TemporaryDirectory() as name:
        path = record(Path(name), a_flight())
        whole = path.read_bytes()
        at = data.draw(st.integers(8, len(whole) - 1))
        garbage = data.draw(st.binary(min_size=1, max_size=20))
        path.write_bytes((whole[:at] + garbage + whole[at + len(garbage) :])[: len(whole)])
        check(path)
        path.write_bytes(whole[:at])
        assert "file" in kinds(path)


# ------------------------------------------------------------------------------------- cut


def test_a_cut_holds_its_stretch_and_every_state_as_it_was_at_its_beginning(
    flight: Path, tmp_path: Path
) -> None:
    out = tmp_path / "cut.mcap"
    ended = gcs_log("cut", flight, "--from", "5", "--to", "10", "-o", out)
    assert ended.exit_code == 0, ended.output
    begin_ns = messages_of(flight)[0].log_time_ns + 5 * SECOND
    found = messages_of(out)
    inside = [m for m in messages_of(flight) if begin_ns <= m.log_time_ns <= begin_ns + 5 * SECOND]
    assert [message for message in found if message.log_time_ns >= begin_ns] == inside
    before = {m.topic: m for m in found if m.log_time_ns < begin_ns}
    assert {
        "/tf_static",
        "/geofence",
        "/mission",
        "/vehicle/1/model",
        "/vehicle/1/param",
        "/vehicle/1/fsa",
    } <= before.keys()
    assert not {t for t in before if t.startswith(("/mavlink", "/gate/decision", "/session"))}
    assert all(begin_ns - m.log_time_ns < 1000 for m in before.values())
    others = [e for e in Reading(out) if isinstance(e, Attachment | Metadata)]
    assert len(others) == 2
    assert kinds(out) == {}


def test_of_parameters_each_ones_latest_value_is_repeated(tmp_path: Path) -> None:
    values = [ParamItem(1, "A", 1.0), ParamItem(1, "B", 2.0), ParamItem(1, "A", 3.0)]
    path = record(tmp_path, [*values, position_frame(0)], step_ns=SECOND)
    gcs_log("cut", path, "--from", "2.5", "-o", tmp_path / "cut.mcap")
    found = [json.loads(m.data) for m in messages_of(tmp_path / "cut.mcap") if "param" in m.topic]
    assert found == [{"name": "B", "value": 2.0}, {"name": "A", "value": 3.0}]


def test_a_cut_around_a_request(flight: Path, tmp_path: Path) -> None:
    out = tmp_path / "cut.mcap"
    at_ns = next(m.log_time_ns for m in messages_of(flight) if m.topic == "/gate/decision")
    assert gcs_log("cut", flight, "--around", "7", "--margin", "0.3", "-o", out).exit_code == 0
    times = [m.log_time_ns for m in messages_of(out)]
    assert abs(times[-1] - at_ns - 300 * MS) < 10, "what comes at once is a nanosecond apart"
    decision = [m for m in messages_of(out) if m.topic == "/gate/decision"]
    assert [m.log_time_ns for m in decision] == [at_ns]
    unknown = gcs_log("cut", flight, "--around", "8", "-o", tmp_path / "no.mcap")
    assert (unknown.exit_code, "its requests are 7 to 7" in unknown.output) == (2, True)


# ----------------------------------------------------------------------------------- merge


def test_parts_become_one_record(tmp_path: Path) -> None:
    recorder = opened(tmp_path, rotation=Rotation(age_ns=5 * SECOND))
    for item in a_flight():
        recorder.write(item, START_NS)
    for number in range(100):
        recorder.write(position_frame(number), START_NS + number * 200 * MS)
        recorder.tick(START_NS + number * 200 * MS)
    recorder.close(START_NS + 20 * SECOND)
    assert len(recorder.parts) >= 3
    out = tmp_path / "whole.mcap"
    assert gcs_log("merge", *reversed(recorder.parts), "-o", out).exit_code == 0
    assert messages_of(out) == [m for path in recorder.parts for m in messages_of(path)]
    assert kinds(out) == {}
    others = [e for e in Reading(out) if isinstance(e, Attachment | Metadata)]
    assert len(others) == 2


def pose(vehicle: int, east_m: float) -> PoseItem:
    return PoseItem(vehicle, (0.0, east_m, -2.0), (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))


def test_two_vehicles_are_in_one_record_by_time(tmp_path: Path) -> None:
    one = record(tmp_path / "a", [pose(1, n) for n in range(50)])
    two = record(tmp_path / "b", [pose(2, n) for n in range(50)])
    out = tmp_path / "both.mcap"
    assert gcs_log("merge", one, two, "-o", out).exit_code == 0
    found = messages_of(out)
    assert sorted(found) == sorted(messages_of(one) + messages_of(two))
    times = [message.log_time_ns for message in found]
    assert times == sorted(times)
    assert kinds(out) == {}
    with open(out, "rb") as file:
        assert len(list(make_reader(file).iter_messages())) == len(found)


def test_two_vehicles_of_one_number_are_not_mixed_unless_told_apart(tmp_path: Path) -> None:
    one = record(tmp_path / "a", [pose(1, n) for n in range(5)])
    other = one.rename(tmp_path / "first.mcap")
    two = record(tmp_path / "a", [pose(1, n) for n in range(5)])
    out = tmp_path / "both.mcap"
    refused = gcs_log("merge", other, two, "-o", out)
    assert (refused.exit_code, "--prefix" in refused.output) == (2, True)
    assert not out.exists()
    assert gcs_log("merge", other, two, "--prefix", "-o", out).exit_code == 0
    topics = {message.topic for message in messages_of(out)}
    assert {"/first/vehicle/1/tf", "/20260101_000000_test/vehicle/1/tf"} <= topics


def test_a_killed_part_is_merged_as_far_as_it_goes(flight: Path, tmp_path: Path) -> None:
    killed = tmp_path / "killed.mcap"
    killed.write_bytes(flight.read_bytes()[:-500])
    out = tmp_path / "out.mcap"
    ended = gcs_log("merge", killed, "-o", out)
    assert (ended.exit_code, "was not closed" in ended.output) == (0, True)
    assert kinds(out) == {}


def test_an_error_in_a_source_leaves_no_file(flight: Path, tmp_path: Path) -> None:
    from gcs.record.merge import merge

    bad, out = tmp_path / "bad.mcap", tmp_path / "out.mcap"
    bad.write_bytes(b"no MCAP")
    with pytest.raises(BadRecordError):
        merge([flight, bad], out)
    assert not out.exists()
