"""ArduPilot's .BIN and PX4's .ulg as records: their own readers are the oracles."""

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
from pymavlink.DFReader import DFReader_binary

from gcs.logfile.imports.dataflash_vehicle import told as dataflash_told
from tests.sample_files import elsewhere
from tests.shares import examples
from tests.unit.cli.command_line import gcs as run_gcs
from tests.unit.logfile.test_import_tlog import imported
from tests.unit.record.flights import messages_of
from tests.unit.vehicle_logbook.flights import START_S, Flight, S
from vehicle_sim.autopilot.interface import StatusText
from vehicle_sim.autopilot.modes import Personality

pyulog = pytest.importorskip("pyulog")


def vehicle_log(personality: Personality) -> bytes:
    """A flight log that `vehicle-sim` writes."""
    flight = Flight(personality)
    flight.fly(2 * S, StatusText(4, "Wind is high"))
    (log,) = flight.logs
    return log


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


def by_dfreader(path: Path) -> dict[str, list[Any]]:
    found: dict[str, list[Any]] = {}
    with DFReader_binary(str(path)) as reader:
        while (message := reader.recv_msg()) is not None:
            found.setdefault(message.get_type(), []).append(message)
    return found


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


def test_without_pyulog_the_command_that_installs_it_is_told(
    tmp_path: Path, ulg_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import sys

    monkeypatch.setitem(sys.modules, "pyulog", None)
    ended = run_gcs("log", "import", ulg_file, "-o", tmp_path / "a.mcap")
    assert ended.exit_code == 4
    assert "pip install 'mavgate[logs]'" in ended.output


def test_a_dataflash_message_without_a_length_is_refused(tmp_path: Path, bin_file: Path) -> None:
    """DFReader would read it for ever."""
    raw = bytearray(bin_file.read_bytes())
    with DFReader_binary(str(bin_file)) as reader:
        second = reader.offsets[0x80][1]
    raw[second + 4] = 0
    bin_file.write_bytes(raw)
    ended = run_gcs("log", "import", bin_file, "-o", tmp_path / "a.mcap")
    assert ended.exit_code == 4
    assert "have no length" in ended.output


@pytest.mark.parametrize(
    "formats",
    [
        [b"big:uint64_t timestamp;float[4000000000] x;"],
        [b"a:b[60000] x;", b"b:uint8_t[60000] y;"],
        [b"a:b x;", b"b:a[2] y;"],
    ],
)
def test_a_ulog_format_that_would_fill_the_memory_is_refused(
    tmp_path: Path, formats: list[bytes]
) -> None:
    raw = b"ULog\x01\x12\x35\x01" + bytes(8)
    raw += b"".join(len(each).to_bytes(2, "little") + b"F" + each for each in formats)
    (tmp_path / "a.ulg").write_bytes(raw)
    ended = run_gcs("log", "import", tmp_path / "a.ulg", "-o", tmp_path / "a.mcap")
    assert ended.exit_code == 4
    assert "longer than a message can be" in ended.output


@pytest.mark.slow
@settings(max_examples=examples(60))
@given(st.data(), st.sampled_from(["ardupilot", "px4"]))
def test_a_damaged_log_is_read_as_far_as_it_goes_or_refused(
    data: st.DataObject, personality: Personality
) -> None:
    raw = bytearray(_LOGS.setdefault(personality, vehicle_log(personality)))
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


_LOGS: dict[Personality, bytes] = {}


def test_a_dataflash_log_that_begins_armed_tells_so_by_what_happens_then() -> None:
    """As an ArduCopter 4.7 writes it with LOG_DISARMED 0: no ARM, and no event of the arming."""
    events = [(15, True, "UNDEFINED"), (28, True, "IN_AIR"), (18, True, "ON_GROUND")]
    told = dataflash_told({"EV": np.zeros(3, [("Id", "u1")])})
    (events_told,) = (each for each in told if each.table == "EV")
    for number, armed, landed in (*events, (11, False, "ON_GROUND")):
        list(events_told.tell((number,), 0))
        vehicle = events_told.vehicle
        assert (vehicle.armed, vehicle.landed.name) == (armed, landed)
