"""Autopilots' own logs are read in windows: what comes of it does not depend on their size."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcs.logfile.imports.log_clock import HOLD_NS, LogClock
from gcs.logfile.imports.onboard import import_onboard
from gcs.logfile.onboard.opened import open_onboard
from gcs.mcap_file.batch_writer import BatchWriter
from gcs.mcap_file.errors import BadLogError
from tests.shares import examples
from tests.unit.logfile.onboard_logs import (
    GPS_UTC_US,
    SYNC,
    as_text,
    data,
    df,
    fmt,
    m,
    parameter,
    subscribe,
    ulog,
    vehicle_log,
)
from tests.unit.record.flights import messages_of

pyulog = pytest.importorskip("pyulog")
MS = 1_000_000


class Read(NamedTuple):
    """All parts of a log together."""

    tables: dict[str, np.ndarray[Any, Any]]
    gaps: dict[int, bytes]


def read(path: Path, window_bytes: int = 4 << 20) -> Read:
    rows: dict[str, list[Any]] = {}
    gaps: dict[int, bytes] = {}
    for part in open_onboard(path, window_bytes).parts():
        for name, _, table in part.tables:
            rows.setdefault(name, []).append(table)
        gaps |= {gap.offset: gap.raw for gap in part.gaps}
    return Read({name: np.concatenate(each) for name, each in rows.items()}, gaps)


def of(path: Path, raw: bytes) -> Read:
    path.write_bytes(raw)
    return read(path)


def record_of(path: Path, window_bytes: int) -> list[tuple[object, ...]]:
    target = path.with_suffix(f".{window_bytes}.mcap")
    with open(target, "wb") as file:
        writer = BatchWriter(file)
        import_onboard("a log", "/log", open_onboard(path, window_bytes), [], writer)
        writer.finish()
    return [(each.topic, each.log_time_ns, each.data) for each in messages_of(target)]


def text_log() -> bytes:
    with TemporaryDirectory() as folder:
        (Path(folder) / "a.BIN").write_bytes(vehicle_log("ardupilot"))
        return as_text(Path(folder) / "a.BIN").encode()


LOGS: dict[str, Callable[[], bytes]] = {
    "bin": lambda: vehicle_log("ardupilot"),
    "log": text_log,
    "ulg": lambda: vehicle_log("px4"),
}


@pytest.mark.parametrize("kind", LOGS)
@settings(max_examples=examples(40), deadline=None)
@given(st.data())
def test_windows_of_any_size_give_what_one_window_gives(kind: str, data: st.DataObject) -> None:
    """Of whole logs and of damaged ones."""
    raw = bytearray(LOGS[kind]())
    for _ in range(data.draw(st.integers(0, 6))):
        at = data.draw(st.integers(200, len(raw) - 1))
        match data.draw(st.sampled_from(["flip", "lose", "insert", "end"])):
            case "flip":
                raw[at] ^= data.draw(st.integers(1, 255))
            case "lose":
                del raw[at : at + data.draw(st.integers(1, 300))]
            case "insert":
                raw[at:at] = data.draw(st.binary(min_size=1, max_size=300))
            case _ if len(raw) > 20_000:
                del raw[max(at, 20_000) :]
    with TemporaryDirectory() as folder:
        path = Path(folder) / "a.log"
        path.write_bytes(raw)
        whole = read(path)
        window_bytes = data.draw(st.integers(150, 70_000))
        parts = read(path, window_bytes)
        assert parts.gaps == whole.gaps
        assert parts.tables.keys() == whole.tables.keys()
        for name, table in whole.tables.items():
            assert parts.tables[name].tobytes() == table.tobytes(), name
        assert record_of(path, window_bytes) == record_of(path, 4 << 20)


@settings(max_examples=examples(300))
@given(st.lists(st.integers(0, 10_000), min_size=1), st.data())
def test_places_in_time_do_not_depend_on_windows_and_stay_near_their_times(
    steps_ms: list[int], data: st.DataObject
) -> None:
    told_ns = np.array(steps_ms, np.int64) * MS
    cut = data.draw(st.integers(0, len(told_ns)))
    whole = LogClock(0).log_times(told_ns)
    clock = LogClock(0)
    assert [*clock.log_times(told_ns[:cut]), *clock.log_times(told_ns[cut:])] == [*whole]
    latest_ns = np.maximum.accumulate(told_ns)
    assert (whole >= told_ns).all()
    # Nothing that comes later has its place before this.
    assert (whole >= latest_ns - HOLD_NS).all()
    assert (whole[told_ns >= latest_ns - HOLD_NS] == told_ns[told_ns >= latest_ns - HOLD_NS]).all()


def test_one_damaged_time_moves_no_other_message() -> None:
    told_ns = np.arange(20, dtype=np.int64) * MS
    told_ns[7] = 2**62
    clock = LogClock(0)
    placed_ns = clock.log_times(told_ns)
    assert [*np.delete(placed_ns, 7)] == [*np.delete(told_ns, 7)]
    assert (placed_ns[7], clock.late) == (6 * MS, 1)


def test_a_gap_of_hours_in_a_log_is_one() -> None:
    told_ns = np.concatenate((np.arange(10), np.arange(10) + 9_000_000)).astype(np.int64) * MS
    placed_ns = LogClock(0).log_times(told_ns)
    assert [*placed_ns[:10]] == [*told_ns[:10]]
    assert [*placed_ns[14:]] == [*told_ns[14:]]
    assert (np.diff(placed_ns) >= 0).all()


# ------------------------------------------------------------------------------- DataFlash

A = fmt(1, "AAA", "QB", "TimeUS,Value")
B = fmt(2, "BBB", "Qhc", "TimeUS,Value,Scaled")


def test_a_format_may_come_late_and_before_it_its_messages_are_a_gap(tmp_path: Path) -> None:
    early, late = df(2, "Qhh", 5, 1, 250), df(2, "Qhh", 7, 2, 350)
    first = A + df(1, "QB", 4, 1)
    found = of(tmp_path / "a.BIN", first + early + df(1, "QB", 6, 2) + B + late)
    assert found.gaps == {len(first): early}
    assert found.tables["BBB"][["Value", "Scaled"]].tolist() == [(2, 3.5)]
    assert found.tables["AAA"]["time_ns"].tolist() == [4_000, 6_000]


def test_a_name_with_two_layouts_has_two_tables(tmp_path: Path) -> None:
    other = fmt(1, "AAA", "Qf", "TimeUS,Other")
    raw = A + df(1, "QB", 1, 9) + other + df(1, "Qf", 2, 0.5) + A + df(1, "QB", 3, 8)
    tables = of(tmp_path / "a.BIN", raw).tables
    assert tables["AAA"]["Value"].tolist() == [9, 8]
    assert tables["AAA_2"]["Other"].tolist() == [0.5]


def test_a_format_without_a_length_has_no_messages(tmp_path: Path) -> None:
    bad, message = fmt(1, "AAA", "QB", "TimeUS,Value", size=2), df(1, "QB", 4, 1)
    found = of(tmp_path / "a.BIN", bad + message + B + df(2, "Qhh", 7, 2, 3))
    assert found.gaps == {len(bad): message}
    assert set(found.tables) == {"FMT", "BBB"}


def test_a_format_that_is_none_keeps_its_messages_as_bytes(tmp_path: Path) -> None:
    raw = fmt(1, "AAA", "QB", "TimeUS", size=12) + df(1, "QB", 4, 1)
    assert of(tmp_path / "a.BIN", raw).tables["AAA"]["data"].tobytes() == struct.pack("<QB", 4, 1)


def test_old_logs_tell_milliseconds_and_the_gps_time_of_week_beside_them(tmp_path: Path) -> None:
    """As ArduPilot wrote them before 2015: GPS.T is the autopilot's time."""
    gps = fmt(3, "GPS", "fff", "TimeMS,Week,T", size=15).replace(b"fff\0", b"III\0")
    raw = gps + df(3, "III", 5_000, 1_800, 60) + df(3, "III", 5_200, 1_800, 260)
    (first_ns, second_ns) = of(tmp_path / "a.BIN", raw).tables["GPS"]["time_ns"].tolist()
    # 1980-01-06 and 1,800 weeks, 5 s less the leap seconds.
    assert first_ns == (315_964_800 + 1_800 * 604_800 + 5 - 18) * 10**9
    assert second_ns - first_ns == 200 * MS


# ------------------------------------------------------------------------------------ ULog

FORMATS = m("F", "a:uint64_t timestamp;int16_t v;uint8_t[2] _padding0;") + m(
    "F", "sensor_gps:uint64_t timestamp;uint64_t time_utc_usec;"
)
GPS = subscribe(9, "sensor_gps") + data(9, "QQ", 2_000_000, GPS_UTC_US)
BASE_NS = (GPS_UTC_US - 2_000_000) * 1000


def test_a_ulog_is_what_its_own_reader_reads(tmp_path: Path) -> None:
    """A subscription that comes late, texts with a tag, drop-outs, parameters that change."""
    body = [
        FORMATS,
        parameter("MAV_SYS_ID", 7),
        subscribe(1, "a"),
        GPS,
        data(1, "Qh", 2_100_000, 1),
        SYNC,
        m("O", struct.pack("<H", 33)),
        subscribe(2, "a", 1),
        data(2, "Qh", 2_050_000, 3),
        m("L", b"4" + struct.pack("<Q", 2_300_000) + b"a warning"),
        m("C", b"6" + struct.pack("<HQ", 1, 2_400_000) + b"tagged"),
        parameter("MAV_SYS_ID", 8),
        m("I", b"\x0bchar[2] aboxy"),
    ]
    path = tmp_path / "a.ulg"
    path.write_bytes(ulog(*body))
    theirs = pyulog.ULog(str(path))
    found = read(path, 50)
    for each in theirs.data_list:
        mine = found.tables[f"{each.name}_{each.multi_id}"]
        for name, values in each.data.items():
            assert mine[name].tolist() == values.tolist()
        assert ((mine["time_ns"] - BASE_NS) // 1000).tolist() == each.data["timestamp"].tolist()
    texts = found.tables["logged_messages"]
    assert texts[["level", "text"]].tolist() == [(4, b"a warning"), (6, b"tagged")]
    assert found.tables["dropouts"]["duration_ms"].tolist() == [theirs.dropouts[0].duration]
    assert found.tables["parameters"]["value"].tolist() == [7, 8]
    assert not found.gaps
    assert open_onboard(path).first_ns == BASE_NS + 2_050_000_000


def test_padding_may_be_left_out_and_a_crash_may_have_appended_data(tmp_path: Path) -> None:
    """pyulog reads neither."""
    body = FORMATS, subscribe(1, "a"), data(1, "Qh", 5, 1), data(1, "QhH", 6, 2, 0)
    cut_off = m("D", bytes(12))[:-4]
    begins = len(ulog(*body)) + len(cut_off)
    raw = ulog(*body, flags=bytes(8) + b"\1" + bytes(7), appended=(begins,)) + cut_off
    found = of(tmp_path / "a.ulg", raw + data(1, "Qh", 7, 3))
    assert found.tables["a_0"]["v"].tolist() == [1, 2, 3]
    assert found.gaps == {begins - len(cut_off): cut_off}


def test_damage_in_a_ulog_is_a_gap_up_to_where_messages_follow_one_another(tmp_path: Path) -> None:
    head = ulog(FORMATS, subscribe(1, "a"), data(1, "Qh", 5, 1))
    tail = data(1, "Qh", 6, 2) + data(1, "Qh", 7, 3)
    for damage in (
        b"\0\0\0 no message",
        data(1, "Qh", 8, 9)[2:],
        data(77, "Qh", 8, 9),
        b"\xff" * 70,
    ):
        found = of(tmp_path / "a.ulg", head + damage + tail)
        assert found.gaps == {len(head): damage}
        assert found.tables["a_0"]["v"].tolist() == [1, 2, 3]
    single = SYNC + data(1, "Qh", 6, 2)
    found = of(tmp_path / "a.ulg", head + b"\xff" * 70 + single)
    assert (list(found.gaps), found.tables["a_0"]["v"].tolist()) == ([len(head)], [1, 2])


def test_a_format_that_no_message_can_have_is_subscribed_in_vain(tmp_path: Path) -> None:
    """And takes no memory."""
    formats = {
        "big": ["big:uint64_t timestamp;float[4000000000] x;"],
        "a": ["a:b[60000] x;", "b:uint8_t[60000] y;"],
        "b": ["a:b x;", "b:a[2] y;"],
        "c": ["c:nothing x;"],
        "d60": [f"d{n}:d{n - 1}[2] x;" for n in range(60, 0, -1)],
    }
    for topic, texts in formats.items():
        vain = subscribe(1, topic)
        raw = ulog(*(m("F", text) for text in texts), vain, SYNC)
        assert list(of(tmp_path / "a.ulg", raw).gaps.values()) == [vain]


def test_a_ulog_with_a_feature_that_changes_how_it_is_read_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "a.ulg"
    path.write_bytes(ulog(FORMATS, GPS, flags=bytes(8) + b"\2" + bytes(7)))
    with pytest.raises(BadLogError, match="features that are not known"):
        read(path)
