"""`gcs log report`, as a user calls it."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from mcap.opcode import Opcode

from gcs.report import ConditionItem, FsaItem, PoseItem, RecordItem, StatusItem
from tests.unit.cli.command_line import gcs
from tests.unit.flight_report.test_scan import a_flight_that_loses_gps
from tests.unit.record.flights import MS, a_flight, record, without_a_record_s_head


@pytest.fixture
def flight(tmp_path: Path) -> Path:
    return record(tmp_path, a_flight_that_loses_gps(), step_ns=125 * MS)


def test_the_page_stands_beside_the_record(flight: Path) -> None:
    ended = gcs("log", "report", flight)
    written = flight.with_suffix(".html")
    assert ended.exit_code == 0
    assert str(written) in ended.output
    assert "the GPS lost its fix" in ended.output
    assert written.read_text(encoding="utf-8").startswith("<!doctype html>")


def test_it_is_written_where_it_is_told(flight: Path, tmp_path: Path) -> None:
    page = tmp_path / "mine.html"
    assert gcs("log", "report", flight, "-o", page).exit_code == 0
    assert page.exists()
    assert not flight.with_suffix(".html").exists()
    assert [path for path in tmp_path.iterdir() if path.name.startswith(".")] == []


def test_another_vehicle_of_a_fleet(tmp_path: Path) -> None:
    upright = (1.0, 0.0, 0.0, 0.0)
    states = [StatusItem(n, True, "OFFBOARD", "IN_AIR", 90.0, 16.0, 9.0, 0.0) for n in (1, 2)]
    poses = [PoseItem(n, (0.0, 0.0, -5.0 * n), (0.0, 0.0, 0.0), upright) for n in (1, 2)]
    path = record(tmp_path, [*states, *poses], step_ns=400 * MS)
    page = tmp_path / "two.html"
    ended = gcs("log", "report", path, "--vehicle", "2", "-o", page)
    assert ended.exit_code == 0
    assert "This is vehicle 2;" in ended.output
    assert "Also in the record: Vehicle 1" in ended.output
    html = page.read_text(encoding="utf-8")
    assert "vehicle 2</li>" in html
    assert "Also in the record: Vehicle 1" in html


def test_of_a_fleet_every_vehicle_is_told_and_that_two_came_too_close(tmp_path: Path) -> None:
    upright = (1.0, 0.0, 0.0, 0.0)
    rows: list[RecordItem] = []
    for landed in ("ON_GROUND", "IN_AIR", "ON_GROUND"):
        rows += [StatusItem(n, True, "OFFBOARD", landed, 90.0, 16.0, 9.0, 0.0) for n in (1, 2)]
        rows += [PoseItem(n, (0.0, 0.0, -5.0), (0.0, 0.0, 0.0), upright) for n in (1, 2)]
        close = ConditionItem("too_close", "CAUTION", "vehicle 1: 3.0 m away")
        wrong = (close,) if landed == "IN_AIR" else ()
        rows.append(FsaItem(2, "HOVERING", 5, "HOVERING", "x", "OURS", "CAUTION", None, wrong))
    path = record(tmp_path, rows, step_ns=400 * MS)
    said = gcs("log", "report", path).output.splitlines()
    assert [line[:36] for line in said if "flew for" in line] == [
        "Vehicle 1: The vehicle flew for 2 s,",
        "Vehicle 2: The vehicle flew for 2 s,",
    ]
    (wrong_line,) = [line for line in said if "too close" in line]
    assert wrong_line.startswith("Vehicle 2: At ")
    told = json.loads(gcs("log", "report", path, "--json").output)
    assert told["what_happened"].count("flew for") == 2
    assert "too close" in told["vehicles"][1]["what_went_wrong"]


def test_a_vehicle_that_is_not_there(flight: Path) -> None:
    ended = gcs("log", "report", flight, "--vehicle", "9")
    assert ended.exit_code == 2
    assert "vehicles in it: 1" in ended.output
    assert not flight.with_suffix(".html").exists()


def test_json_alone_writes_no_page(flight: Path) -> None:
    ended = gcs("log", "report", flight, "--json")
    assert ended.exit_code == 0
    assert json.loads(ended.output)["vehicles"][0]["name"] == "PX4 quadrotor"
    assert not flight.with_suffix(".html").exists()


def test_json_and_page(flight: Path, tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    ended = gcs("log", "report", flight, "--json", "-o", page)
    assert json.loads(ended.output)["closed"] is True
    assert page.exists()


@pytest.mark.parametrize("data", [b"", b"text", b"\x89MCAP0\r"])
def test_a_broken_input_is_exit_4_and_a_sentence(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / "broken.mcap"
    path.write_bytes(data)
    ended = gcs("log", "report", path)
    assert ended.exit_code == 4
    assert "broken.mcap" in ended.output
    assert "Traceback" not in ended.output
    assert not path.with_suffix(".html").exists()


def test_what_is_no_log_of_another_program_is_exit_4(tmp_path: Path) -> None:
    path = tmp_path / "old.tlog"
    path.write_bytes(bytes(100))
    ended = gcs("log", "report", path)
    assert ended.exit_code == 4
    assert "there is no MAVLink frame" in ended.output


def test_the_record_is_never_overwritten(flight: Path) -> None:
    before = flight.read_bytes()
    assert gcs("log", "report", flight, "-o", flight).exit_code == 2
    assert flight.read_bytes() == before


def test_a_folder_that_is_not_there(flight: Path, tmp_path: Path) -> None:
    ended = gcs("log", "report", flight, "-o", tmp_path / "no" / "page.html")
    assert ended.exit_code == 7
    assert "cannot write" in ended.output


def test_a_damaged_record_is_called_damaged_on_the_terminal(flight: Path) -> None:
    whole = gcs("log", "report", flight).output
    assert "record is damaged" not in whole
    unread = without_a_record_s_head(flight, Opcode.STATISTICS)
    ended = gcs("log", "report", flight)
    assert f"The record is damaged: its last {unread} bytes could not be read." in ended.output
    assert f"its last {unread} bytes" in flight.with_suffix(".html").read_text(encoding="utf-8")
    assert json.loads(gcs("log", "report", flight, "--json").output)["unread_bytes"] == unread


def test_a_record_of_which_no_message_could_be_read_is_not_called_empty(flight: Path) -> None:
    unread = without_a_record_s_head(flight, Opcode.CHUNK)
    ended = gcs("log", "report", flight).output
    assert "nothing was written" not in ended
    assert "No message of the record could be read." in ended
    assert f"The record is damaged: its last {unread} bytes could not be read." in ended


def test_of_a_damaged_record_nothing_went_wrong_in_what_could_be_read(tmp_path: Path) -> None:
    path = record(tmp_path, a_flight(), step_ns=125 * MS)
    good = gcs("log", "report", path).output
    assert "Nothing went wrong." in good
    without_a_record_s_head(path, Opcode.STATISTICS)
    ended = gcs("log", "report", path).output
    assert "Nothing went wrong in what could be read." in ended
