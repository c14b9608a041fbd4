"""`gcs log import` and `export` of .tlog files, as a user calls them."""

from __future__ import annotations

import json
import struct
from contextlib import suppress
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.reader import make_reader
from mcap_ros1.decoder import DecoderFactory
from pymavlink.dialects.v20 import all as dialect

import gcs
from gcs.mcap_file.errors import BadLogError
from gcs.record.writer import Recorder
from gcs.report import Direction, FrameItem, GarbageItem
from tests.sample_files import elsewhere
from tests.shares import examples, one_in
from tests.unit.cli.command_line import Ended
from tests.unit.cli.command_line import gcs as run_gcs
from tests.unit.logfile.tlogs import START_US, flight, read_by_pymavlink, stamped, unknown, write
from tests.unit.record.flights import messages_of


def imported(source: Path, target: Path) -> dict[str, object]:
    ended = run_gcs("log", "import", source, "-o", target, "--json")
    assert ended.exit_code == 0, ended.output
    told: dict[str, object] = json.loads(ended.output)
    return told


def exported(source: Path, target: Path) -> bytes:
    ended = run_gcs("log", "export", source, "-o", target)
    assert ended.exit_code == 0, ended.output
    return target.read_bytes()


def the_way_back(source: Path, folder: Path) -> dict[str, object]:
    told = imported(source, folder / "a.mcap")
    assert exported(folder / "a.mcap", folder / "b.tlog") == source.read_bytes()
    return told


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "count", "kinds", "garbage"),
    one_in(2, [("arducopter_sitl.tlog", 8_276, 33, 0), ("quad_2015.tlog", 75_477, 35, 27_613)]),
)
def test_real_flights_come_back_byte_for_byte(
    tmp_path: Path, name: str, count: int, kinds: int, garbage: int
) -> None:
    """Counts: pymavlink's, see test_tlog.py; shared/data/README.md has 75,477 messages."""
    told = the_way_back(elsewhere("logs", name), tmp_path)
    assert told["read"] == count
    assert told["garbage_bytes"] == garbage
    theirs: dict[str, int] = {}
    for message in read_by_pymavlink(elsewhere("logs", name)):
        kind = message.get_type()
        theirs[kind] = theirs.get(kind, 0) + 1
    theirs.pop("BAD_DATA", 0)
    assert told["kinds"] == theirs
    assert len(theirs) == kinds


def test_another_reader_reads_the_record(tmp_path: Path) -> None:
    """mcap's own, with its index, and a ROS 1 decoder of another project."""
    source = write(tmp_path / "a.tlog", flight(600))
    imported(source, tmp_path / "a.mcap")
    with open(tmp_path / "a.mcap", "rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        summary = reader.get_summary()
        assert summary is not None
        assert summary.statistics is not None
        everything = list(reader.iter_messages())
        assert summary.statistics.message_count == len(everything)
        topics = ["/mavlink/1/1/PARAM_VALUE"]
        decoded = [m.decoded_message for m in reader.iter_decoded_messages(topics=topics)]
    expected = [m for m in read_by_pymavlink(source) if m.get_type() == "PARAM_VALUE"]
    assert [m.param_value for m in decoded] == [m.param_value for m in expected]
    assert [m.frame.seq for m in decoded] == [m.get_seq() for m in expected]


def test_log_times_rise_strictly_and_the_files_are_the_recorders(tmp_path: Path) -> None:
    """The messages of frames are those that the recorder makes of the same frames."""
    frames = flight(300)
    source = write(tmp_path / "a.tlog", frames, step_us=0)
    imported(source, tmp_path / "a.mcap")
    ours = messages_of(tmp_path / "a.mcap")
    times = [message.log_time_ns for message in ours]
    assert all(b > a for a, b in pairwise(times))
    recorder = Recorder.open(tmp_path, "test", "20260101-000000", START_US * 1000)
    for number, frame in enumerate(frames):
        recorder.write(FrameItem(0, Direction.RECEIVED, frame), START_US * 1000 + number)
    recorder.close(START_US * 1000 + 300)
    theirs = messages_of(recorder.path)
    assert [m for m in ours if m.topic.startswith("/mavlink")] == [
        m._replace(log_time_ns=t.log_time_ns)
        for m, t in zip(theirs, (o for o in ours if o.topic.startswith("/mavlink")), strict=True)
    ]


def test_old_flights_have_the_topics_of_our_own(tmp_path: Path) -> None:
    sender = dialect.MAVLink(None, srcSystem=3, srcComponent=1)
    messages = []
    for number in range(200):
        messages += [
            sender.attitude_encode(number * 20, 0.0, 0.0, 1.0, 0, 0, 0),
            sender.global_position_int_encode(
                number * 20, 473977420 + number * 10, 85455940, 490_000, 2_000, 111, 0, 0, 0
            ),
        ]
        if number % 50 == 0:
            messages += [
                sender.heartbeat_encode(2, 3, 209, 4, 4),
                sender.sys_status_encode(0, 0, 0, 0, 15_200, 0, 77, 0, 0, 0, 0, 0, 0),
            ]
    messages += [
        sender.statustext_encode(2, b"Crash: Disarming"),
        sender.param_value_encode(b"WPNAV_SPEED", 500.0, 9, 1, 0),
        sender.heartbeat_encode(2, 3, 81, 9, 4),
    ]
    source = write(tmp_path / "a.tlog", [bytes(m.pack(sender)) for m in messages])
    imported(source, tmp_path / "a.mcap")
    last: dict[str, bytes] = {m.topic: m.data for m in messages_of(tmp_path / "a.mcap")}
    state = json.loads(last["/vehicle/3/state"])
    assert state["mode"] == "GUIDED"
    assert state["armed"] is True
    assert (state["battery_v"], state["battery_pct"]) == (15.2, 77.0)
    assert state["alt_amsl_m"] == 490.0
    # 1e-6 degrees a message, 0.11132 m: ArduPilot's projection (projection.py has the source).
    assert state["north_m"] == pytest.approx(199 * 10 * 0.011131884502145034, abs=1.2)
    assert state["up_m"] == pytest.approx(2.0)
    assert json.loads(last["/vehicle/3/param"])["value"] == 500.0
    assert b"Crash: Disarming" in last["/log"]
    assert {"/vehicle/3/tf", "/vehicle/3/path", "/vehicle/3/location", "/tf_static"} <= set(last)


def test_a_damaged_time_stamp_neither_moves_the_rest_nor_is_lost(tmp_path: Path) -> None:
    frames = flight(60)
    times = [START_US + 20_000 * number for number in range(60)]
    for number, time_us in ((20, 2**64 - 1), (30, times[30] + 10**13), (40, 0)):
        times[number] = time_us
    source = tmp_path / "a.tlog"
    source.write_bytes(b"".join(stamped(f, t) for f, t in zip(frames, times, strict=True)))
    told = the_way_back(source, tmp_path)
    assert told["seconds"] == pytest.approx(59 * 0.02, abs=1e-3)
    # The first one does not fit into nanoseconds of 64 bits.
    assert told["garbage_bytes"] == 8


@pytest.mark.parametrize(("step_us", "seconds"), [(10**12, 10**6 + 59 * 0.02), (-(10**12), 0.58)])
def test_a_clock_that_is_set_is_believed(tmp_path: Path, step_us: int, seconds: float) -> None:
    """A million seconds on, as when a GPS tells the time; back, log times stand still."""
    times = [START_US + 20_000 * n + (step_us if n >= 30 else 0) for n in range(60)]
    source = tmp_path / "a.tlog"
    source.write_bytes(b"".join(stamped(f, t) for f, t in zip(flight(60), times, strict=True)))
    told = the_way_back(source, tmp_path)
    assert told["seconds"] == pytest.approx(seconds, abs=1e-6)
    assert told["garbage_bytes"] == 0


def test_unknown_messages_and_forged_ids_are_kept(tmp_path: Path) -> None:
    frames = [unknown(), *flight(3), unknown(b"again")]
    told = the_way_back(write(tmp_path / "a.tlog", frames), tmp_path)
    assert told["kinds"] == {
        "UNKNOWN_59999": 2,
        "LOCAL_POSITION_NED": 1,
        "ATTITUDE": 1,
        "STATUSTEXT": 1,
    }


@pytest.mark.slow
def test_more_components_than_a_file_has_channels_for_are_kept(tmp_path: Path) -> None:
    heartbeats = []
    for number in range(5_000):
        sender = dialect.MAVLink(None, srcSystem=number % 250 + 1, srcComponent=number // 250)
        heartbeats.append(bytes(sender.heartbeat_encode(2, 8, 0, 0, 4).pack(sender)))
    the_way_back(write(tmp_path / "a.tlog", heartbeats), tmp_path)
    topics = {message.topic for message in messages_of(tmp_path / "a.mcap")}
    assert "/mavlink/more" in topics


def test_a_flight_of_our_own_is_exported_as_pymavlink_reads_it(tmp_path: Path) -> None:
    """Refused frames were never on the link; garbage has no place between time stamps."""
    frames = flight(30) + flight(30, mavlink1=True)
    recorder = Recorder.open(tmp_path, "test", "20260101-000000", START_US * 1000)
    for number, frame in enumerate(frames):
        direction = Direction.SENT if number % 2 else Direction.RECEIVED
        recorder.write(FrameItem(0, direction, frame), START_US * 1000 + number * 1_000_000)
    recorder.write(FrameItem(0, Direction.REFUSED, frames[0]), START_US * 1000 + 10**9)
    recorder.write(GarbageItem(0, b"noise", "text"), START_US * 1000 + 2 * 10**9)
    recorder.close(START_US * 1000 + 3 * 10**9)
    exported(recorder.path, tmp_path / "b.tlog")
    theirs = list(read_by_pymavlink(tmp_path / "b.tlog"))
    assert [bytes(m.get_msgbuf()) for m in theirs] == frames
    assert theirs[5]._timestamp == pytest.approx(START_US / 1e6 + 0.005, abs=2e-6)


@pytest.mark.slow
@settings(max_examples=examples(60))
@given(
    st.lists(
        st.one_of(
            st.integers(0, 17).map(lambda n: stamped(flight(18)[n])),
            st.builds(
                lambda n, t: stamped(flight(18, mavlink1=True)[n], t),
                st.integers(0, 17),
                st.integers(0, 2**64 - 1),
            ),
            st.integers(0, 17).map(lambda n: flight(18)[n]),
            st.binary(min_size=1, max_size=6).map(lambda b: stamped(unknown(b))),
            st.binary(max_size=30),
        ),
        max_size=14,
    )
)
def test_whatever_is_in_a_tlog_comes_back_byte_for_byte(parts: list[bytes]) -> None:
    with TemporaryDirectory() as folder:
        source = Path(folder) / "source.tlog"
        source.write_bytes(stamped(flight(1)[0]) + b"".join(parts))
        the_way_back(source, Path(folder))


# -------------------------------------------------------------------------------- bad input


def failed(*args: object) -> Ended:
    ended = run_gcs("log", *args)
    assert ended.exit_code != 0
    assert "Traceback" not in ended.output
    return ended


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "empty"),
        (b"hello\n" * 50, "no MAVLink frame"),
        (b"\x89MCAP0\r\n", "MCAP"),
        (b"\xfd\xff" * 1000, "no MAVLink frame"),
    ],
)
def test_what_is_no_log_is_refused(tmp_path: Path, content: bytes, reason: str) -> None:
    (tmp_path / "a.tlog").write_bytes(content)
    ended = failed("import", tmp_path / "a.tlog", "-o", tmp_path / "b.mcap")
    assert ended.exit_code == 4
    assert reason in ended.output
    assert not (tmp_path / "b.mcap").exists()


def test_an_existing_file_is_not_overwritten(tmp_path: Path) -> None:
    source = write(tmp_path / "a.tlog", flight(3))
    (tmp_path / "b.mcap").write_bytes(b"precious")
    assert failed("import", source, "-o", tmp_path / "b.mcap").exit_code == 2
    assert (tmp_path / "b.mcap").read_bytes() == b"precious"


def test_a_folder_that_is_not_there_is_the_targets_error(tmp_path: Path) -> None:
    source = write(tmp_path / "a.tlog", flight(3))
    ended = failed("import", source, "-o", tmp_path / "no" / "b.mcap")
    assert ended.exit_code == 7
    assert "cannot write" in ended.output


def test_an_mcap_of_another_tool_has_no_frames_to_export(tmp_path: Path) -> None:
    from mcap.writer import Writer

    with open(tmp_path / "a.mcap", "wb") as file:
        writer = Writer(file)
        writer.start()
        schema = writer.register_schema("Thing", "jsonschema", b"{}")
        channel = writer.register_channel("/mavlink/1/1/ATTITUDE", "json", schema)
        writer.add_message(channel, 1, b"{}", 1)
        writer.finish()  # type: ignore[no-untyped-call]  # mcap leaves it bare
    ended = failed("export", tmp_path / "a.mcap", "-o", tmp_path / "b.tlog")
    assert ended.exit_code == 4
    assert "no MAVLink frames" in ended.output
    assert not (tmp_path / "b.tlog").exists()


@pytest.mark.slow
@settings(max_examples=examples(150))
@given(st.data())
def test_a_damaged_record_is_exported_as_far_as_it_goes_or_refused(data: st.DataObject) -> None:
    """Bytes changed, cut off, and lengths of 2^63: no traceback, no endless memory."""
    raw = bytearray(_a_record())
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(raw) - 9))
        match data.draw(st.sampled_from(["byte", "length", "cut"])):
            case "byte":
                raw[at] ^= data.draw(st.integers(1, 255))
            case "length":
                huge = data.draw(st.sampled_from([2**63, 2**64 - 1, 2**31, 2**40]))
                struct.pack_into("<Q", raw, at, huge)
            case _:
                del raw[max(at, 20) :]
    with TemporaryDirectory() as folder:
        source = Path(folder) / "a.mcap"
        source.write_bytes(raw)
        ended = run_gcs("log", "export", source, "-o", Path(folder) / "b.tlog")
        assert ended.exit_code in (0, 4), ended.output
        assert "Traceback" not in ended.output
        with suppress(BadLogError):
            assert len(gcs.columns(source, "ATTITUDE")) <= 1000


_RECORD: list[bytes] = []


def _a_record() -> bytes:
    if not _RECORD:
        with TemporaryDirectory() as folder:
            source = write(Path(folder) / "a.tlog", flight(60))
            imported(source, Path(folder) / "a.mcap")
            _RECORD.append((Path(folder) / "a.mcap").read_bytes())
    return _RECORD[0]


def test_a_record_that_was_imported_has_the_columns_of_its_source(tmp_path: Path) -> None:
    source = write(tmp_path / "a.tlog", flight(600))
    imported(source, tmp_path / "a.mcap")
    for name in ("ATTITUDE", "PARAM_VALUE", "STATUSTEXT"):
        ours = gcs.columns(tmp_path / "a.mcap", name)
        assert len(ours) == 100
        assert np.array_equal(ours, gcs.columns(source, name))
