"""`gcs log info | layout | recover`, as a user calls them."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path
from typing import Any

import pytest
from mcap.opcode import Opcode

from gcs.operator import joined
from gcs.record.viewer.layout import ANY_FLIGHT, layout
from gcs.shell.stations import Description
from tests.unit.cli.command_line import Ended, gcs
from tests.unit.record.flights import (
    MS,
    SECOND,
    START_NS,
    a_flight,
    messages_of,
    opened,
    record,
    summary_of,
    without_a_record_s_head,
)


def gcs_log(*args: str | Path) -> Ended:
    return gcs("log", *args)


@pytest.fixture
def flight(tmp_path: Path) -> Path:
    return record(tmp_path, a_flight(), step_ns=100 * MS)


@pytest.fixture
def killed_flight(tmp_path: Path) -> Path:
    """Flushed, and never closed."""
    recorder = opened(tmp_path, "killed")
    for number, item in enumerate(a_flight()):
        recorder.write(item, START_NS + number * 30 * MS)
    recorder.tick(START_NS + SECOND)
    killed = tmp_path / "killed.mcap"
    killed.write_bytes(recorder.path.read_bytes())
    recorder.close(START_NS + SECOND)
    return killed


WRONG = [
    *(
        (f"{command} {bad}", 4, f"{bad}.mcap: {why}")
        for command in (
            "info",
            "layout",
            "check",
            "recover -o out",
            "cut --to 1 -o out",
            "merge -o out",
        )
        for bad, why in (
            *(("empty", "the file is empty"), ("text", "not an MCAP file")),
            *(("begun", "not an MCAP file"), ("zeros", "not an MCAP file")),
        )
    ),
    *(
        (f"{command} -o taken", 2, "taken.mcap: exists already")
        for command in ("recover killed", "cut flight --to 1", "merge flight")
    ),
    ("recover killed -o nowhere/out", 7, "cannot write"),
    ("layout flight -o nowhere/out", 7, "cannot write"),
    ("info", 2, "--last"),
    ("info nothing", 4, "nothing.mcap"),
    ("cut flight -o out", 2, "--from"),
    ("cut flight --from 3 --to 2 -o out", 2, ""),
    ("cut flight --around 7 --to 2 -o out", 2, "--around"),
    ("cut flight --from 1000 -o out", 2, "there is no message from 1000"),
]
"""What is typed, the exit code, and what is told."""


@pytest.mark.parametrize(("typed", "code", "told"), WRONG, ids=[row[0] for row in WRONG])
def test_what_cannot_be_done_is_told_and_leaves_no_file(
    flight: Path, killed_flight: Path, tmp_path: Path, typed: str, code: int, told: str
) -> None:
    folder = tmp_path / "all"
    folder.mkdir()
    for name, data in {
        "flight": flight.read_bytes(),
        "killed": killed_flight.read_bytes(),
        "taken": b"precious",
        "empty": b"",
        "text": b"a text of some length",
        "begun": b"\x89MCAP",
        "zeros": bytes(100),
    }.items():
        (folder / f"{name}.mcap").write_bytes(data)
    before = {path: path.read_bytes() for path in folder.iterdir()}
    command, *words = typed.split()
    ended = gcs_log(command, *(w if w[0] in "-0123456789" else folder / f"{w}.mcap" for w in words))
    assert (ended.exit_code, told in ended.output) == (code, True), ended.output
    assert code != 4 or "hint:" in ended.output
    assert {path: path.read_bytes() for path in folder.iterdir()} == before


# ----------------------------------------------------------------------------------- info


def test_info_tells_what_is_in_a_flight(flight: Path) -> None:
    result = gcs_log("info", flight)
    assert result.exit_code == 0
    assert "complete" in result.output
    assert "2026-01-01 00:00:00 UTC" in result.output
    assert "/mavlink/1/1/LOCAL_POSITION_NED" in result.output
    assert "OUTSIDE_FENCE" in result.output
    assert "vehicle 1  MOVING" in result.output
    assert "policy.toml" in result.output


def test_info_json_is_for_programs(flight: Path) -> None:
    found = json.loads(gcs_log("info", flight, "--json").output)
    assert found["closed"] is True
    assert found["messages"] == len(messages_of(flight))
    assert found["seconds"] == pytest.approx(1.6)
    assert {topic["topic"] for topic in found["topics"]} == {m.topic for m in messages_of(flight)}
    assert [state["state"] for state in found["states"]] == ["HOVERING", "MOVING"]
    (decision,) = found["decisions"]
    assert (decision["request_id"], decision["outcome"]) == (7, "refused")
    assert found["metadata"] == {"versions": {"mavgate": "0"}}
    assert found["gaps"] == []


def test_a_record_that_a_station_still_writes_is_not_broken_and_no_newer_than_its_station(
    flight: Path, killed_flight: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    old, new = tmp_path / "old.mcap", tmp_path / "new.mcap"
    new.write_bytes(flight.read_bytes())
    old.write_bytes(killed_flight.read_bytes())  # written to last
    begun_ns = new.stat().st_mtime_ns - 1
    station = Description(4711, 1, [], log_path=str(old), started_ns=begun_ns)
    monkeypatch.setattr(joined, "running_stations", lambda: [station])
    assert gcs_log("info", "--last", old, new).output.startswith(f"{new}: ")
    for command in ("info", "check", "report"):
        ended = gcs_log(command, old)
        assert ended.exit_code == 0, ended.output
        assert "still being written by the running station of process 4711" in ended.output
        assert "NOT" not in ended.output
        assert "gcs log recover" not in ended.output


def test_info_works_on_a_killed_file_and_says_what_to_do(killed_flight: Path) -> None:
    result = gcs_log("info", killed_flight)
    assert result.exit_code == 0
    assert "NOT CLOSED" in result.output
    assert "viewers refuse such a file" in result.output
    assert f"hint: gcs log recover {killed_flight}" in result.output
    assert "OUTSIDE_FENCE" in result.output


def test_info_reports_silence_as_a_gap(tmp_path: Path) -> None:
    recorder = opened(tmp_path, "gap")
    item = a_flight()[5]
    for at_s in (0, 1, 5, 6):
        recorder.write(item, START_NS + at_s * SECOND)
    recorder.close(START_NS + 6 * SECOND)
    found = json.loads(gcs_log("info", recorder.path, "--json").output)
    assert found["gaps"] == [{"t_s": 1.0, "seconds": 4.0}]


def test_the_rate_of_a_topic_is_its_mean(tmp_path: Path) -> None:
    path = record(tmp_path, [a_flight()[5]] * 101, step_ns=20 * MS)
    (topic,) = json.loads(gcs_log("info", path, "--json").output)["topics"]
    assert (topic["messages"], topic["hz"]) == (101, pytest.approx(50.0))


def test_a_burst_has_no_rate(tmp_path: Path) -> None:
    path = record(tmp_path, [a_flight()[5]] * 50, step_ns=1 * MS)
    assert gcs_log("info", path, "--json").output.count('"hz":0.0') == 1
    assert re.search(r"\n/\S+ +50 +-  ", gcs_log("info", path).output)


def test_several_files_are_told_one_after_the_other(flight: Path, killed_flight: Path) -> None:
    told = gcs_log("info", flight, killed_flight).output
    assert told.index(f"{flight}: ") < told.index(f"{killed_flight}: ")
    lines = gcs_log("info", killed_flight, flight, "--json").output.splitlines()
    assert [json.loads(line)["path"] for line in lines] == [str(killed_flight), str(flight)]


def test_the_last_one_is_the_newest(
    flight: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "logs").mkdir()
    assert gcs_log("info", "--last").exit_code == 4
    for name, at_s in (("b", 100), ("a", 300), ("c", 200)):
        copy = tmp_path / "logs" / f"{name}.mcap"
        copy.write_bytes(flight.read_bytes())
        os.utime(copy, (at_s, at_s))
    last = gcs_log("info", "--last").output
    assert last.startswith(f"{Path('logs') / 'a.mcap'}: ")
    assert last.count(".mcap: ") == 1
    older = (Path("logs") / "b.mcap", Path("logs") / "c.mcap")
    assert gcs_log("info", "--last", *older).output.startswith(str(older[1]))


@pytest.mark.skipif(os.name != "posix", reason="a file's name is bytes on POSIX only")
def test_a_file_whose_name_is_not_utf8_is_told_in_json_too(flight: Path, tmp_path: Path) -> None:
    other = tmp_path / os.fsdecode(b"\xff.mcap")
    try:
        other.write_bytes(flight.read_bytes())
    except OSError:
        pytest.skip("this file system has no such names")
    found = json.loads(gcs_log("info", other, "--json").output)
    assert found["path"].endswith("\\udcff.mcap")


# --------------------------------------------------------------------------------- layout


def topics_in(value: Any) -> set[str]:
    """Every string in a layout that names a topic or a path into one."""
    if isinstance(value, dict):
        read = [pair for pair in value.items() if pair[0] != "publish"]  # the viewer's own
        return {t for k, v in read for t in topics_in(v) | topics_in(k)}
    if isinstance(value, list):
        return {t for v in value for t in topics_in(v)}
    if isinstance(value, str) and re.match(r"/\w", value):
        return {value.split(".")[0]}
    return set()


def panels_in(tree: Any) -> list[str]:
    if isinstance(tree, str):
        return [tree]
    return panels_in(tree["first"]) + panels_in(tree["second"])


def test_the_layout_names_only_topics_that_the_file_has(flight: Path, tmp_path: Path) -> None:
    out = tmp_path / "layout.json"
    assert gcs_log("layout", flight, "-o", out).exit_code == 0
    made = json.loads(out.read_text())
    existing = {message.topic for message in messages_of(flight)}
    assert topics_in(made) <= existing
    for topic in ("/geofence", "/vehicle/1/path", "/vehicle/1/setpoint", "/gate/requests"):
        assert topic in topics_in(made)
    assert set(panels_in(made["layout"])) == set(made["configById"])
    kinds = {panel.split("!")[0] for panel in made["configById"]}
    assert kinds == {
        "3D",
        "map",
        "Plot",
        "StateTransitions",
        "Indicator",
        "Gauge",
        "Table",
    }


def test_paths_into_json_topics_name_fields_of_their_schema(flight: Path) -> None:
    text = gcs_log("layout", flight).output
    summary = summary_of(flight)
    fields = {
        channel.topic: json.loads(summary.schemas[channel.schema_id].data)["properties"]
        for channel in summary.channels.values()
        if channel.message_encoding == "json"
    }
    paths = re.findall(r'"(/(?:vehicle/1|gate)/(?:state|fsa|decision))\.(\w+)"', text)
    assert len(paths) >= 5
    assert all(name in fields[topic] for topic, name in paths)


@pytest.mark.parametrize(
    "topics",
    [
        set(),
        {"/log"},
        {"/vehicle/3/state", "/mavlink/3/1/HEARTBEAT"},
        {"/geofence", "/vehicle/2/location", "/vehicle/10/location"},
    ],
)
def test_a_layout_is_made_of_whatever_there_is(topics: set[str]) -> None:
    made: Any = layout(topics)
    assert topics_in(made) <= topics
    panels = set(panels_in(made["layout"])) - {""}
    assert panels == made["configById"].keys()


def test_without_a_file_the_layout_is_for_any_flight() -> None:
    result = gcs_log("layout")
    assert result.exit_code == 0
    assert topics_in(json.loads(result.output)) <= ANY_FLIGHT


# -------------------------------------------------------------------------------- recover


def test_recover_makes_a_killed_file_whole(killed_flight: Path, tmp_path: Path) -> None:
    whole = tmp_path / "whole.mcap"
    result = gcs_log("recover", killed_flight, "-o", whole)
    assert result.exit_code == 0
    assert re.search(r"\d+ messages, 0\.\d s recovered", result.output)
    assert messages_of(whole) == messages_of(killed_flight)
    assert "complete" in gcs_log("info", whole).output


def test_recover_json(killed_flight: Path, tmp_path: Path) -> None:
    result = gcs_log("recover", killed_flight, "-o", tmp_path / "whole.mcap", "--json")
    found = json.loads(result.output)
    assert found["source_closed"] is False
    assert found["messages"] == len(messages_of(killed_flight))


def test_a_copy_of_a_complete_file_is_said_to_be_one(flight: Path, tmp_path: Path) -> None:
    result = gcs_log("recover", flight, "-o", tmp_path / "copy.mcap")
    assert "complete already" in result.output


def test_recover_says_how_much_behind_the_damage_could_not_be_read(
    flight: Path, tmp_path: Path
) -> None:
    unread = without_a_record_s_head(flight, Opcode.CHUNK)
    ended = gcs("log", "recover", flight, "-o", tmp_path / "whole.mcap")
    assert f"the rest of the file could not be read: its last {unread} bytes" in ended.output
    again = gcs("log", "recover", flight, "-o", tmp_path / "again.mcap", "--json")
    assert json.loads(again.output)["unread_bytes"] == unread


def test_of_a_file_whose_end_alone_is_missing_everything_was_read(
    flight: Path, tmp_path: Path
) -> None:
    flight.write_bytes(flight.read_bytes()[:-3])
    ended = gcs("log", "recover", flight, "-o", tmp_path / "whole.mcap")
    assert "could not be read" not in ended.output
