"""CSV, Parquet, KML and GPX of every kind of log, read back by others."""

from __future__ import annotations

import csv
import sys
import xml.etree.ElementTree as ET
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest
from pymavlink.dialects.v20 import all as dialect

import gcs
from tests.unit.cli.command_line import Ended
from tests.unit.cli.command_line import gcs as run_gcs
from tests.unit.logfile.test_dataflash_and_ulog import bin_file, ulg_file
from tests.unit.logfile.test_import_tlog import imported
from tests.unit.logfile.tlogs import START_US, flight, write

__all__ = ["bin_file", "ulg_file"]

KML = {"k": "http://www.opengis.net/kml/2.2", "gx": "http://www.google.com/kml/ext/2.2"}
GPX = {"g": "http://www.topografix.com/GPX/1/1"}


def export(source: Path, target: Path, *more: str) -> Ended:
    ended = run_gcs("log", "export", source, "-o", target, *more)
    assert ended.exit_code == 0, ended.output
    return ended


@pytest.fixture
def tlog(tmp_path: Path) -> Path:
    return write(tmp_path / "a.tlog", flight(60))


@pytest.fixture
def square(tmp_path: Path) -> Path:
    """Two vehicles, ten positions a second for 4 s; before its fix the first one tells 0, 0."""
    frames = []
    senders = [dialect.MAVLink(None, srcSystem=n, srcComponent=1) for n in (1, 2)]
    for number in range(40):
        for which, sender in enumerate(senders):
            lat = 0 if number < 5 and which == 0 else 473977420 + number * 100
            lon = 0 if lat == 0 else 85455940 + which * 1000
            message = sender.global_position_int_encode(
                number * 100, lat, lon, 490_000 + number * 10, 2_000, 0, 0, 0, 0
            )
            frames.append(bytes(message.pack(sender)))
    return write(tmp_path / "square.tlog", frames, step_us=50_000)


def test_csv_of_one_message_reads_back_exactly(tmp_path: Path, tlog: Path) -> None:
    export(tlog, tmp_path / "a.csv", "--message", "ATTITUDE")
    expected = gcs.columns(tlog, "ATTITUDE")
    with open(tmp_path / "a.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(expected) == 10
    for row, one in zip(rows, expected, strict=True):
        assert int(row["time_ns"]) == one["time_ns"]
        assert np.float32(row["roll"]) == one["roll"]
    assert list(rows[0]) == list(expected.dtype.names or ())


def test_csv_without_a_name_is_a_file_for_each_kind(tmp_path: Path, tlog: Path) -> None:
    ended = export(tlog, tmp_path / "a.csv")
    files = sorted(path.name for path in tmp_path.glob("*.csv"))
    assert files == [
        "a.ATTITUDE.csv",
        "a.HEARTBEAT.csv",
        "a.LOCAL_POSITION_NED.csv",
        "a.MISSION_CURRENT.csv",
        "a.PARAM_VALUE.csv",
        "a.STATUSTEXT.csv",
    ]
    assert "a.STATUSTEXT.csv: 10 messages" in ended.output
    text = (tmp_path / "a.STATUSTEXT.csv").read_text(encoding="utf-8")
    assert "text 2," in text


def test_csv_of_a_record_is_that_of_its_source(tmp_path: Path, tlog: Path) -> None:
    imported(tlog, tmp_path / "r.mcap")
    for source, target in ((tlog, "a.csv"), (tmp_path / "r.mcap", "b.csv")):
        export(source, tmp_path / target, "--message", "PARAM_VALUE")
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()


def test_csv_of_autopilots_own_logs_and_of_their_records(
    tmp_path: Path, bin_file: Path, ulg_file: Path
) -> None:
    for source, name in ((bin_file, "ATT"), (ulg_file, "vehicle_attitude_0")):
        export(source, tmp_path / f"{name}.csv", "--message", name)
        count = imported(source, tmp_path / f"{name}.mcap")["messages"]
        assert isinstance(count, int)
        export(tmp_path / f"{name}.mcap", tmp_path / f"{name}2.csv", "--message", name)
        with open(tmp_path / f"{name}.csv", newline="", encoding="utf-8") as file:
            ours = list(csv.DictReader(file))
        with open(tmp_path / f"{name}2.csv", newline="", encoding="utf-8") as file:
            theirs = list(csv.DictReader(file))
        assert len(ours) > 10
        for a, b in zip(ours, theirs, strict=True):
            # In a record no two messages have the same time: each may be 1 ns behind the other.
            assert 0 <= int(b.pop("time_ns")) - int(a.pop("time_ns")) < count
            assert a == b


def test_a_message_that_is_not_there_is_exit_4(tmp_path: Path, tlog: Path) -> None:
    ended = run_gcs("log", "export", tlog, "-o", tmp_path / "a.csv", "--message", "GPS_RAW_INT")
    assert ended.exit_code == 4
    assert "no GPS_RAW_INT" in ended.output
    assert not (tmp_path / "a.csv").exists()


def test_where_one_file_is_there_already_none_is_left(tmp_path: Path, tlog: Path) -> None:
    (tmp_path / "a.STATUSTEXT.csv").write_text("mine")
    ended = run_gcs("log", "export", tlog, "-o", tmp_path / "a.csv")
    assert ended.exit_code == 2
    assert [path.name for path in tmp_path.glob("*.csv")] == ["a.STATUSTEXT.csv"]
    assert (tmp_path / "a.STATUSTEXT.csv").read_text() == "mine"


def test_kml_has_a_line_and_a_track_of_each_vehicle(tmp_path: Path, square: Path) -> None:
    export(square, tmp_path / "a.kml")
    root = ET.parse(tmp_path / "a.kml").getroot()
    names = [each.text for each in root.iterfind(".//k:Placemark/k:name", KML)]
    assert names == ["vehicle 1", "vehicle 1, with times", "vehicle 2", "vehicle 2, with times"]
    lines = [each.text or "" for each in root.iterfind(".//k:LineString/k:coordinates", KML)]
    lon, lat, alt = map(float, lines[1].split()[0].split(","))
    assert (lon, lat, alt) == (8.5456940, 47.3977420, 490.0)
    assert not any(place.startswith("0.0") for place in lines[0].split())
    whens = root.findall(".//gx:Track/k:when", KML)
    coords = root.findall(".//gx:Track/gx:coord", KML)
    assert len(whens) == len(coords) == len(lines[0].split()) + len(lines[1].split())


def test_gpx_has_the_positions_at_their_times_five_times_a_second(
    tmp_path: Path, square: Path
) -> None:
    export(square, tmp_path / "a.gpx")
    root = ET.parse(tmp_path / "a.gpx").getroot()
    tracks = root.findall("g:trk", GPX)
    assert [track.findtext("g:name", "", GPX) for track in tracks] == ["vehicle 1", "vehicle 2"]
    points = tracks[1].findall(".//g:trkpt", GPX)
    assert len(points) == 20  # 4 s
    positions = gcs.columns(square, "GLOBAL_POSITION_INT", sysid=2)
    for point in points:
        when = datetime.fromisoformat(point.findtext("g:time", "", GPX))
        (one,) = positions[abs(positions["time_ns"] / 1e9 - when.timestamp()) < 0.001]
        assert float(point.attrib["lat"]) == pytest.approx(one["lat"] / 1e7, abs=1e-9)
        assert float(point.attrib["lon"]) == pytest.approx(one["lon"] / 1e7, abs=1e-9)
        assert float(point.findtext("g:ele", "", GPX)) == pytest.approx(one["alt"] / 1e3)
    assert START_US


def test_the_tracks_of_autopilots_own_logs(tmp_path: Path, bin_file: Path, ulg_file: Path) -> None:
    """flights.py's vehicle stands at 47.3978, 8.5459, 493 m in its global position."""
    for source in (bin_file, ulg_file):
        imported(source, tmp_path / f"{source.suffix}.mcap")
        for number, each in enumerate((source, tmp_path / f"{source.suffix}.mcap")):
            target = tmp_path / f"{source.suffix}{number}.gpx"
            export(each, target)
            point = ET.parse(target).getroot().find(".//g:trkpt", GPX)
            assert point is not None
            assert float(point.attrib["lat"]) == pytest.approx(47.3978, abs=1e-6)
            assert float(point.attrib["lon"]) == pytest.approx(8.5459, abs=1e-6)
            assert float(point.findtext("g:ele", "", GPX)) == pytest.approx(493.0, abs=0.01)


def test_a_log_without_positions_has_no_track(tmp_path: Path, tlog: Path) -> None:
    ended = run_gcs("log", "export", tlog, "-o", tmp_path / "a.gpx")
    assert ended.exit_code == 4
    assert "no position" in ended.output
    assert not (tmp_path / "a.gpx").exists()


@pytest.mark.parametrize("name", ["a.txt", "a"])
def test_an_unknown_suffix_is_a_usage_error(tmp_path: Path, tlog: Path, name: str) -> None:
    ended = run_gcs("log", "export", tlog, "-o", tmp_path / name)
    assert ended.exit_code == 2
    assert ".gpx" in ended.output


def test_a_tlog_is_not_exported_as_a_tlog(tmp_path: Path, tlog: Path) -> None:
    ended = run_gcs("log", "export", tlog, "-o", tmp_path / "b.tlog")
    assert ended.exit_code == 4
    assert "not an MCAP" in ended.output


def test_without_pyarrow_the_command_that_installs_it_is_told(
    tmp_path: Path, tlog: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    monkeypatch.delitem(sys.modules, "gcs.logfile.exports.parquet", raising=False)
    ended = run_gcs("log", "export", tlog, "-o", tmp_path / "b.parquet")
    assert ended.exit_code == 2
    assert "pip install 'mavgate[parquet]'" in ended.output


def test_parquet_reads_back_exactly(tmp_path: Path, tlog: Path) -> None:
    pytest.importorskip("pyarrow")
    import pyarrow.parquet

    export(tlog, tmp_path / "a.parquet", "--message", "STATUSTEXT")
    export(tlog, tmp_path / "b.parquet", "--message", "ATTITUDE")
    texts = pyarrow.parquet.read_table(tmp_path / "a.parquet").to_pydict()
    expected = gcs.columns(tlog, "STATUSTEXT")
    assert texts["text"] == [text.decode() for text in expected["text"].tolist()]
    assert texts["time_ns"] == expected["time_ns"].tolist()
    angles = pyarrow.parquet.read_table(tmp_path / "b.parquet").to_pydict()
    assert angles["roll"] == gcs.columns(tlog, "ATTITUDE")["roll"].tolist()
