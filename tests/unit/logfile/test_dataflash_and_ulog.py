"""ArduPilot's .BIN and .log and PX4's .ulg as records: their own readers are the oracles."""

from __future__ import annotations

import json
import math
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.reader import make_reader
from mcap_ros1.decoder import DecoderFactory
from pymavlink.DFReader import DFReader_binary, DFReader_text

from gcs.logfile.imports.dataflash_vehicle import told as dataflash_told
from gcs.record.ros1 import decode_garbage
from tests.sample_files import elsewhere
from tests.shares import examples
from tests.unit.cli.command_line import gcs as run_gcs
from tests.unit.logfile.onboard_logs import as_text, by_dfreader, vehicle_log
from tests.unit.logfile.test_import_tlog import imported
from tests.unit.record.flights import messages_of
from tests.unit.vehicle_logbook.flights import START_S
from vehicle_sim.autopilot.modes import Personality

pyulog = pytest.importorskip("pyulog")


@pytest.fixture
def bin_file(tmp_path: Path) -> Path:
    (tmp_path / "a.BIN").write_bytes(vehicle_log("ardupilot"))
    return tmp_path / "a.BIN"


@pytest.fixture
def ulg_file(tmp_path: Path) -> Path:
    (tmp_path / "a.ulg").write_bytes(vehicle_log("px4"))
    return tmp_path / "a.ulg"


def decoded(record: Path) -> dict[str, list[tuple[int, Any]]]:
    """Log time and message of every ROS 1 topic, by a decoder of another project."""
    found: dict[str, list[tuple[int, Any]]] = {}
    with open(record, "rb") as file:
        for one in make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages(
            [m for m in _topics(record) if m.startswith(("/dataflash", "/ulog"))]
        ):
            found.setdefault(one.channel.topic, []).append(
                (one.message.log_time, one.decoded_message)
            )
    return found


def _topics(record: Path) -> set[str]:
    return {message.topic for message in messages_of(record)}


def assert_every_value_is_dfreaders(path: Path, record: Path) -> None:
    theirs = by_dfreader(path)
    ours = decoded(record)
    assert set(ours) == {f"/dataflash/{kind}" for kind in theirs}
    for kind, messages in theirs.items():
        mine = ours[f"/dataflash/{kind}"]
        assert len(mine) == len(messages), kind
        for (log_ns, ours_), message in zip(mine, messages, strict=True):
            for name in message.get_fieldnames():
                a, b = getattr(ours_, name), getattr(message, name)
                if isinstance(a, str):
                    assert a.rstrip("\0").encode() == bytes(str(b), "utf-8"), (kind, name)
                elif hasattr(b, "__len__"):
                    assert list(a) == list(b), (kind, name)
                else:
                    assert a == pytest.approx(b, rel=1e-12) or math.isnan(a), (kind, name)
            if hasattr(message, "TimeUS"):
                assert log_ns == pytest.approx(message._timestamp * 1e9, abs=20_000), kind


@pytest.mark.slow
def test_a_real_dataflash_log_keeps_every_message_of_every_kind(tmp_path: Path) -> None:
    path = elsewhere("logs", "test.BIN")
    told = imported(path, tmp_path / "a.mcap")
    counts = {kind: len(messages) for kind, messages in by_dfreader(path).items()}
    assert len(counts) == 47
    assert told["kinds"] == counts
    assert_every_value_is_dfreaders(path, tmp_path / "a.mcap")


@pytest.mark.slow
def test_the_vehicles_dataflash_log_is_as_dfreader_reads_it(tmp_path: Path, bin_file: Path) -> None:
    told = imported(bin_file, tmp_path / "a.mcap")
    assert told["garbage_bytes"] == 0
    assert_every_value_is_dfreaders(bin_file, tmp_path / "a.mcap")


def test_damage_within_a_dataflash_log_is_kept_and_counted(tmp_path: Path, bin_file: Path) -> None:
    raw = bin_file.read_bytes()
    with DFReader_binary(str(bin_file)) as reader:
        place = reader.offsets[reader.name_to_id["ATT"]][5]
    bin_file.write_bytes(raw[:place] + b"damaged bytes" + raw[place:])
    told = imported(bin_file, tmp_path / "a.mcap")
    assert (told["garbage_bytes"], told["garbage_stretches"]) == (13, 1)
    (garbage,) = (m for m in messages_of(tmp_path / "a.mcap") if m.topic == "/link/0/garbage")
    assert garbage.data.endswith(b"damaged bytes")


def test_the_vehicles_ulog_is_as_pyulog_reads_it(tmp_path: Path, ulg_file: Path) -> None:
    told = imported(ulg_file, tmp_path / "a.mcap")
    theirs = pyulog.ULog(str(ulg_file))
    ours = decoded(tmp_path / "a.mcap")
    kinds = told["kinds"]
    assert isinstance(kinds, dict)
    topics = {f"{each.name}_{each.multi_id}": each.data for each in theirs.data_list}
    assert set(topics) <= set(kinds)
    assert len(topics) > 10
    for name, data in topics.items():
        mine = ours[f"/ulog/{name}"]
        assert len(mine) == kinds[name] == len(data["timestamp"])
        for field, values in data.items():
            plain = field.replace("[", "_").replace("]", "").replace(".", "_")
            found = [getattr(message, plain) for _, message in mine]
            assert np.array_equal(np.array(found, values.dtype), values, equal_nan=True), field
    assert kinds["logged_messages"] == len(theirs.logged_messages)
    assert kinds["parameters"] == len(theirs.initial_parameters) + len(theirs.changed_parameters)


@pytest.mark.parametrize("kind", ["bin", "ulg"])
def test_both_have_the_topics_of_our_own_flights(
    tmp_path: Path, bin_file: Path, ulg_file: Path, kind: str
) -> None:
    """flights.py: position is (t, 2 t, -t / 2) metres at t seconds, the start is START_S."""
    imported(bin_file if kind == "bin" else ulg_file, tmp_path / "a.mcap")
    states = [
        (message.log_time_ns, json.loads(message.data))
        for message in messages_of(tmp_path / "a.mcap")
        if message.topic == "/vehicle/1/state"
    ]
    assert len(states) > 5
    for log_ns, state in states[-5:]:
        t = (log_ns - START_S * 1e9) / 1e9
        assert state["north_m"] == pytest.approx(t, abs=0.25)
        assert state["east_m"] == pytest.approx(2 * t, abs=0.5)
        assert state["up_m"] == pytest.approx(t / 2, abs=0.125)
    topics = _topics(tmp_path / "a.mcap")
    assert {"/vehicle/1/tf", "/vehicle/1/path", "/vehicle/1/location", "/tf_static"} <= topics
    assert {"/vehicle/1/param", "/log"} <= topics
    logged = b"".join(m.data for m in messages_of(tmp_path / "a.mcap") if m.topic == "/log")
    assert b"Wind is high" in logged


def test_damage_within_a_ulog_is_kept_and_told_with_its_place(
    tmp_path: Path, ulg_file: Path
) -> None:
    raw = ulg_file.read_bytes()
    place = raw.index(b"Wind is high") + len(b"Wind is high")
    ulg_file.write_bytes(raw[:place] + b"\xff" * 40 + raw[place:])
    ended = run_gcs("log", "import", ulg_file, "-o", tmp_path / "a.mcap")
    told = f"40 damaged bytes in 1 stretches, the first at byte {place}"
    assert told in ended.output
    with open(tmp_path / "a.mcap", "rb") as file:
        (info,) = (each for each in make_reader(file).iter_metadata() if each.name == "ulog")
    assert info.metadata["file_corruption"] == told


def test_a_log_in_text_is_as_dfreader_reads_it(tmp_path: Path, bin_file: Path) -> None:
    """Real messages too; a text with a comma, of which DFReader drops the rest, is whole."""
    for name, source in (("made", bin_file), ("real", elsewhere("logs", "test.BIN"))):
        path = tmp_path / f"{name}.log"
        said = "MSG, 9000000, one, two" if name == "made" else ""
        # DFReader leaves out lines whose last value is empty.
        lines = [line for line in as_text(source).splitlines() if not line.endswith(", ")]
        path.write_text("\n".join([*lines, said, ""]), encoding="utf-8")
        told = imported(path, tmp_path / f"{name}.mcap")
        theirs = by_dfreader(path, DFReader_text)
        assert told["kinds"] == {kind: len(messages) for kind, messages in theirs.items()}
        assert told["format"] == ".log"
        ours = decoded(tmp_path / f"{name}.mcap")
        for kind, messages in theirs.items():
            mine = ours[f"/dataflash/{kind}"]
            for (log_ns, ours_), message in zip(mine, messages, strict=True):
                for field in message.get_fieldnames():
                    a, b = getattr(ours_, field), getattr(message, field)
                    if isinstance(b, str):
                        a = a.rstrip("\0")
                        assert a == b or (said and a.startswith(f"{b}, ")), (kind, field)
                    else:
                        assert a == pytest.approx(b, rel=1e-6) or math.isnan(a), (kind, field)
                if hasattr(message, "TimeUS"):
                    assert log_ns == pytest.approx(message._timestamp * 1e9, abs=20_000), kind


def test_a_log_in_text_and_its_binary_form_are_the_same_flight(
    tmp_path: Path, bin_file: Path
) -> None:
    (tmp_path / "a.log").write_text(as_text(bin_file), encoding="utf-8")
    states = []
    for name in ("a.BIN", "a.log"):
        imported(tmp_path / name, tmp_path / f"{name}.mcap")
        states.append(
            [m.data for m in messages_of(tmp_path / f"{name}.mcap") if m.topic.endswith("/state")]
        )
    assert len(states[0]) > 5
    assert states[0] == states[1]


def test_a_line_that_is_none_is_kept_and_told_with_its_place(
    tmp_path: Path, bin_file: Path
) -> None:
    lines = as_text(bin_file).splitlines(keepends=True)
    place = next(n for n, line in enumerate(lines) if line.startswith("ATT"))
    wrong = ["ATT, 5, 6\n", "ATT, x" + lines[place][5:], "NEVER, 1\n"]
    path = tmp_path / "a.log"
    path.write_text("".join([*lines[:place], *wrong, *lines[place:]]), encoding="utf-8")
    told = imported(path, tmp_path / "a.mcap")
    assert (told["garbage_bytes"], told["garbage_stretches"]) == (sum(map(len, wrong)), 1)
    (garbage,) = (m for m in messages_of(tmp_path / "a.mcap") if m.topic == "/link/0/garbage")
    reason, raw = decode_garbage(garbage.data)
    assert raw.decode() == "".join(wrong)
    assert f"byte {sum(map(len, lines[:place]))} on" in reason


@pytest.mark.slow
@settings(max_examples=examples(60))
@given(st.data(), st.sampled_from(["ardupilot", "px4"]))
def test_a_damaged_log_is_read_as_far_as_it_goes_or_refused(
    data: st.DataObject, personality: Personality
) -> None:
    raw = bytearray(vehicle_log(personality))
    for _ in range(data.draw(st.integers(1, 5))):
        at = data.draw(st.integers(0, len(raw) - 1))
        if data.draw(st.booleans()):
            raw[at] ^= data.draw(st.integers(1, 255))
        else:
            del raw[max(at, 30) :]
    with TemporaryDirectory() as folder:
        source = Path(folder) / "a.log"
        source.write_bytes(raw)
        ended = run_gcs("log", "import", source, "-o", Path(folder) / "a.mcap")
        assert ended.exit_code in (0, 4), ended.output
        assert "Traceback" not in ended.output


def test_a_dataflash_log_that_begins_armed_tells_so_by_what_happens_then() -> None:
    """As an ArduCopter 4.7 writes it with LOG_DISARMED 0: no ARM, and no event of the arming."""
    events = [(15, True, "UNDEFINED"), (28, True, "IN_AIR"), (18, True, "ON_GROUND")]
    told = dataflash_told(1, is_copter=True)
    (events_told,) = (each for each in told if each.table == "EV")
    for number, armed, landed in (*events, (11, False, "ON_GROUND")):
        list(events_told.tell((number,), 0))
        vehicle = events_told.vehicle
        assert (vehicle.armed, vehicle.landed.name) == (armed, landed)
