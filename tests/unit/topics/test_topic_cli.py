"""`gcs topic` on a record, as a user calls it."""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from pymavlink.dialects.v20 import all as dialect

from gcs.exit_codes import ExitCode
from gcs.report import Direction, FrameItem, RecordItem
from tests.shares import examples
from tests.unit.cli.command_line import Ended, gcs
from tests.unit.record.flights import MS, a_flight, frame_v1, frame_v2, record

STEP_NS = 20 * MS


def position(number: int) -> FrameItem:
    """LOCAL_POSITION_NED at z = -number, with vx = 0.1 (no float32 is)."""
    payload = struct.pack("<I6f", number, 1.0, 2.0, -float(number), 0.1, 0.0, math.nan)
    return FrameItem(0, Direction.RECEIVED, frame_v2(32, payload, number))


def heartbeat(number: int) -> FrameItem:
    return FrameItem(
        0, Direction.RECEIVED, frame_v1(0, struct.pack("<IBBBBB", 0, 2, 12, 81, 4, 3), number)
    )


@pytest.fixture(scope="module")
def flight(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Positions at 25 Hz, heartbeats between them, and one of everything."""

    def items() -> Iterator[RecordItem]:
        yield from a_flight()
        for number in range(10):
            yield position(number)
            yield heartbeat(number)

    return record(tmp_path_factory.mktemp("log"), items(), step_ns=STEP_NS)


def topic(flight: Path, command: str, *words: str) -> Ended:
    return gcs("topic", command, *words, "--log", flight)


def objects(ended: Ended) -> list[Any]:
    assert ended.exit_code == 0, ended.output
    return [json.loads(line) for line in ended.output.splitlines()]


def test_list_tells_topics_counts_and_types(flight: Path) -> None:
    (rows,) = objects(topic(flight, "list", "--json"))
    found = {row["topic"]: row for row in rows}
    assert found["/mavlink/1/1/HEARTBEAT"]["messages"] == 10
    assert found["/gate/decision"]["type"] == "gate.Decision"
    assert "/mavlink/1/1/HEARTBEAT " in topic(flight, "list").output
    (one,) = objects(topic(flight, "list", "heartbeat", "--json"))
    assert [row["topic"] for row in one] == ["/mavlink/1/1/HEARTBEAT"]


def test_echo_tells_what_pymavlink_decodes(flight: Path) -> None:
    parser = dialect.MAVLink(None)
    said = objects(topic(flight, "echo", "LOCAL_POSITION_NED", "--from", "0.25", "--json"))
    assert len(said) == 10
    for number, one in enumerate(said):
        (peer,) = parser.parse_buffer(position(number).raw)
        expected = peer.to_dict()
        expected.pop("mavpackettype")
        assert {**one["fields"], "vz": None} == {**expected, "vz": None}
        assert one["fields"]["vz"] is None, "JSON has no NaN"


def test_echo_filters_counts_and_names_enum_values(flight: Path) -> None:
    ended = topic(flight, "echo", "LOCAL_POSITION_NED.z", "--filter", "z < -5", "-n", "2")
    assert ended.output == "-6\n-7\n"
    ended = topic(flight, "echo", "HEARTBEAT", "-n", "1")
    assert "system_status: 4  # MAV_STATE_ACTIVE\n" in ended.output
    assert "type: 2  # MAV_TYPE_QUADROTOR\n" in ended.output
    ended = topic(flight, "echo", "/gate/decision.goal.east_m", "HEARTBEAT.type", "-n", "1")
    assert ended.output == "/gate/decision.goal.east_m: 500\n"


def test_hz_is_of_the_log_times(flight: Path) -> None:
    (whole,) = objects(topic(flight, "hz", "HEARTBEAT", "--json"))
    assert whole["hz"] == pytest.approx(1e9 / (2 * STEP_NS), rel=1e-6)
    assert whole["min_s"] == pytest.approx(whole["max_s"]) == pytest.approx(0.04)
    assert whole["window"] == 10
    windows = objects(topic(flight, "hz", "HEARTBEAT", "-w", "4", "--json"))
    assert [one["window"] for one in windows] == [4, 4]
    assert "average rate: 25.000  min: 0.0400 s" in topic(flight, "hz", "HEARTBEAT").output


def test_info_tells_units_and_enum_values_without_a_record(flight: Path) -> None:
    told = gcs("topic", "info", "EXTENDED_SYS_STATE").output
    assert "EXTENDED_SYS_STATE (message 245)" in told
    assert "uint8 landed_state  [MAV_LANDED_STATE]" in told
    assert "2  MAV_LANDED_STATE_IN_AIR" in told
    assert "float z  [m]" in gcs("topic", "info", "LOCAL_POSITION_NED.z").output
    assert "/mavlink/1/1/HEARTBEAT: 10 messages" in topic(flight, "info", "HEARTBEAT").output
    assert "\nnumber goal.east_m" in topic(flight, "info", "/gate/decision").output


def test_show_draws_what_is_there_without_colours(flight: Path) -> None:
    ended = topic(flight, "show", "LOCAL_POSITION_NED.z", "LOCAL_POSITION_NED.y")
    assert ended.exit_code == 0
    assert "a /mavlink/1/1/LOCAL_POSITION_NED.z  last -9.000  min -9.000" in ended.output
    assert "\x1b" not in ended.output
    assert any("⠀" < char <= "⣿" for char in ended.output)


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (("echo", "LOCAL_POSITION_NED.zz"), ExitCode.USAGE, "has no field 'zz'"),
        (("echo", "HEARTBEAT", "--filter", "z <"), ExitCode.USAGE, "is no condition"),
        (("echo", "HEARTBEAT", "--filter", "zz < 1"), ExitCode.USAGE, "has no field 'zz'"),
        (("echo", "NOTHING"), ExitCode.BAD_FILE, "no NOTHING in it"),
        (("hz", "NOTHING"), ExitCode.BAD_FILE, "no NOTHING in it"),
        (("hz", "HARTBEAT"), ExitCode.BAD_FILE, "did you mean 'HEARTBEAT'?"),
        (("show", "HEARTBEAT"), ExitCode.USAGE, "name a field of it"),
        (("show", "/gate/decision.word"), ExitCode.USAGE, "is no number"),
        (("echo", ".z"), ExitCode.USAGE, "names no topic"),
        (("echo", "/tf_static"), ExitCode.BAD_FILE, "are not decoded here"),
        (("list", "--link", "udpin://127.0.0.1:0"), ExitCode.USAGE, "a record has no link"),
    ],
)
def test_what_is_wrong_is_told_in_a_sentence(
    flight: Path, words: tuple[str, ...], code: ExitCode, said: str
) -> None:
    ended = topic(flight, *words)
    assert (ended.exit_code, said in ended.output) == (code, True), ended.output


@pytest.mark.parametrize("command", ["echo", "hz", "list", "info"])
def test_a_file_in_the_place_of_a_topic_is_not_waited_for_on_a_link(
    flight: Path, command: str
) -> None:
    ended = gcs("topic", command, flight)
    assert ended.exit_code == ExitCode.USAGE
    assert f"is a file, not a topic\n  hint: a record is named by --log: --log {flight}" in (
        ended.output
    )


def test_what_is_not_decoded_is_passed_over_and_told(flight: Path) -> None:
    ended = topic(flight, "echo", "/tf_static", "HEARTBEAT.type", "-n", "1")
    assert ended.output == "/mavlink/1/1/HEARTBEAT.type: 2\n"
    ended = topic(flight, "echo", "/tf_static", "HEARTBEAT.type")
    assert ended.exit_code == ExitCode.DONE
    assert "passed over: /tf_static: 1 messages" in ended.output
    nothing_kept = topic(flight, "echo", "HEARTBEAT", "--filter", "type == 99")
    assert (nothing_kept.exit_code, nothing_kept.output) == (ExitCode.DONE, "")


def broken(flight: Path) -> dict[str, bytes]:
    whole = flight.read_bytes()
    return {
        "empty": b"",
        "text": b"no log at all\n",
        "tlog": bytes(8) + position(1).raw,
        "magic only": whole[:8],
        "hostile length": whole[:8] + b"\x06" + b"\xff" * 8,
        "cut": whole[: len(whole) // 2],
    }


def test_broken_files_end_with_exit_4_or_what_is_whole_in_them(
    flight: Path, tmp_path: Path
) -> None:
    for name, data in broken(flight).items():
        file = tmp_path / "broken.mcap"
        file.write_bytes(data)
        ended = gcs("topic", "list", "--log", file)
        expected = ExitCode.DONE if name == "cut" else ExitCode.BAD_FILE
        assert ended.exit_code == expected, (name, ended.output)
    assert gcs("topic", "list", "--log", tmp_path / "none").exit_code == ExitCode.BAD_FILE
    assert gcs("topic", "list", "--log", tmp_path).exit_code != ExitCode.BUG


@pytest.mark.slow
@settings(max_examples=examples(60), suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_any_damage_is_told_or_passed_over(
    flight: Path, tmp_path: Path, data: st.DataObject
) -> None:
    whole = bytearray(flight.read_bytes())
    for _ in range(data.draw(st.integers(1, 5))):
        whole[data.draw(st.integers(8, len(whole) - 1))] = data.draw(st.integers(0, 255))
    file = tmp_path / "damaged.mcap"
    file.write_bytes(whole)
    for words in (("list",), ("echo", "HEARTBEAT", "decision"), ("hz", "HEARTBEAT")):
        assert gcs("topic", *words, "--log", file).exit_code in (ExitCode.DONE, ExitCode.BAD_FILE)


def test_a_rate_counts_a_frame_once_that_a_bridge_passed_on(tmp_path: Path) -> None:
    """A client's heartbeat goes on to the vehicle and to another client; somebody on link 2 calls
    itself the vehicle."""

    def beat(link: int, direction: Direction, sysid: int, number: int) -> FrameItem:
        payload = struct.pack("<IBBBBB", 0, 6, 8, 0, 4, 3)
        return FrameItem(link, direction, frame_v1(0, payload, number, source=(sysid, 1)))

    def items() -> Iterator[RecordItem]:
        for number in range(10):
            yield beat(0, Direction.RECEIVED, 1, number)
            yield beat(1, Direction.RECEIVED, 254, number)
            yield beat(0, Direction.SENT, 254, number)
            yield beat(2, Direction.SENT, 254, number)
            yield beat(2, Direction.REFUSED, 1, number)
            yield beat(0, Direction.SENT, 255, number)

    path = record(tmp_path, items(), step_ns=STEP_NS)
    rates = {each["topic"]: each for each in objects(topic(path, "hz", "HEARTBEAT", "--json"))}
    for sysid in (1, 254, 255):
        told = rates[f"/mavlink/{sysid}/1/HEARTBEAT"]
        assert told["window"] == 10
        assert told["hz"] == pytest.approx(1e9 / (6 * STEP_NS))
