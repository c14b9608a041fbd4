"""Commands on a station that runs: through it, at once where they stop, and listed."""

from __future__ import annotations

import json

import msgspec
import pytest

from gcs import ipc
from gcs.cli import oneshot_session, running, status
from gcs.cli.oneshot_session import OneShotConfig, sending
from gcs.config import StationConfig
from gcs.exit_codes import ExitCode
from gcs.operator import joined, preflight
from gcs.operator.client import StationClient
from gcs.operator.line_parser import parse_line
from gcs.operator.text.event_text import operation_line
from gcs.policy_digest import policy_digest
from gcs.request_words import SendRequests
from gcs.shell.stations import Description
from tests.unit.cli.command_line import gcs
from tests.unit.operator.fake_station import FakeConnection, FakeStation

LINK = "udpin://127.0.0.1:47001"
FOUND = Description(
    4711,
    1,
    [LINK],
    token="secret",
    vehicle="1/1 px4 quadrotor",
    log_path="/flights/a.mcap",
    policy="default",
    policy_digest=policy_digest("default"),
)


@pytest.fixture
def found(monkeypatch: pytest.MonkeyPatch) -> list[Description]:
    """The stations that run."""
    there = [FOUND]
    monkeypatch.setattr(joined, "running_stations", lambda: there)
    monkeypatch.setattr(running, "running_stations", lambda: there)
    return there


@pytest.fixture
def connection(monkeypatch: pytest.MonkeyPatch, found: list[Description]) -> FakeConnection:
    """What joining the station gives; starting one of its own fails the test."""
    fake = FakeConnection(FakeStation("airborne", client=2))

    def refuse(*_: object) -> None:
        raise AssertionError("a station of its own was started")

    monkeypatch.setattr(oneshot_session, "joined_station", lambda *_, **__: fake)
    monkeypatch.setattr(StationClient, "start", refuse)
    return fake


def run(
    line: str, how: OneShotConfig, links: tuple[str, ...] = ("udpin://127.0.0.1:47001",)
) -> int:
    parsed = parse_line(line)
    assert parsed is not None
    assert isinstance(parsed.action, SendRequests)
    task = sending(parsed.action, how.wait_s)
    return oneshot_session.run(StationConfig(endpoints=list(links)), how, task)


def words(connection: FakeConnection) -> list[str]:
    return [sent.word for sent in connection.sent if isinstance(sent, ipc.Ask)]


def test_a_command_on_a_link_that_a_station_has_goes_through_that_station(
    connection: FakeConnection, capsys: pytest.CaptureFixture[str]
) -> None:
    how = OneShotConfig(10.0, 60.0, as_json=False, what="goto 3 0 2")
    connection.station = in_state("HOVERING")
    assert run("goto 3 0 2", how) == ExitCode.DONE
    assert words(connection) == ["goto"]
    shown = capsys.readouterr()
    assert "goto 3 0 2: complete" in shown.out
    assert "gcs: through the running station of process 4711" in shown.err
    assert connection.sent[-1] == ipc.Leave("done")


def test_a_stop_waits_for_nothing_that_the_station_knows(connection: FakeConnection) -> None:
    connection.station = FakeStation("silent")
    how = OneShotConfig(10.0, 60.0, as_json=False, what="abort", stops=True)
    run("abort", how)
    assert connection.asked_at_s[0] == 0.0


def in_state(state: str) -> FakeStation:
    """Of a station that somebody else has started, with a vehicle in the air."""
    return FakeStation(state=state, armed=True, pos=(1.0, 1.0, 2.0), client=2)


@pytest.mark.parametrize(
    ("state", "code", "hint"),
    [("HOLDING", "HOLDING", "gcs resume"), ("EXTERNAL", "NOT_IN_CONTROL", "gcs control")],
)
def test_what_is_held_or_flown_by_others_stays_so_until_that_is_asked_for(
    connection: FakeConnection, capsys: pytest.CaptureFixture[str], state: str, code: str, hint: str
) -> None:
    connection.station = in_state(state)
    how = OneShotConfig(10.0, 60.0, as_json=False, what="goto 3 0 2")
    assert run("goto 3 0 2", how) == ExitCode.REFUSED_BY_GATE
    assert words(connection) == ["goto"]
    shown = capsys.readouterr()
    assert f"goto 3 0 2: refused {code}: " in shown.out
    assert f"  hint: {hint}\n" in shown.err


def test_what_is_hinted_at_is_not_refused_where_somebody_else_is_in_control() -> None:
    mends = ["gcs param set NAV_DLL_ACT 2"]
    seen = msgspec.structs.replace(in_state("HOVERING").snapshot(), mends=mends)
    report = ipc.PreflightReport(1, [ipc.PreflightRow("failsafes", "fail", "weak", mends)])
    for client, ending in ((1, " --take"), (2, "")):
        now = msgspec.structs.replace(seen, in_control=ipc.OperatorInfo(client, "gcs fly"))
        assert dict(status.rows(now, 2))["what mends them"] == mends[0] + ending
        assert any(line.endswith(mends[0] + ending) for line in preflight.lines(report, now, 2))


def test_control_is_taken_over_only_when_that_is_asked_for(connection: FakeConnection) -> None:
    how = OneShotConfig(10.0, 60.0, as_json=False, what="land", take=True)
    run("land", how)
    assert words(connection)[0] == "station_take"


DEFAULT = ("udpin://127.0.0.1:14550",)


@pytest.mark.parametrize("line", ["abort", "goto 1 0 2"])
def test_the_only_station_will_do_where_no_link_is_named(
    connection: FakeConnection, line: str
) -> None:
    how = OneShotConfig(10.0, 60.0, as_json=False, what=line, anywhere=True)
    connection.station = in_state("HOVERING")
    assert run(line, how, DEFAULT) == ExitCode.DONE
    assert words(connection)[-1] == line.split()[0]


def test_a_link_that_is_named_is_not_the_one_of_a_station_elsewhere(
    connection: FakeConnection, capsys: pytest.CaptureFixture[str]
) -> None:
    named = OneShotConfig(10.0, 60.0, as_json=False, what="goto")
    with pytest.raises(AssertionError, match="of its own"):
        run("goto 1 0 2", named, DEFAULT)
    assert "name its link: --link udpin://127.0.0.1:47001" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("typed", "told", "hint"),
    [
        (("--policy", "lab"), "policy lab was asked for, it has default", "leave out --policy"),
        (
            ("--log-dir", "/elsewhere"),
            "log_dir /elsewhere was asked for, it has /flights",
            "leave out --log-dir",
        ),
        (
            ("--vehicle", 2),
            "vehicle 2 was asked for, it has 1/1 px4 quadrotor",
            "leave out --vehicle",
        ),
    ],
)
@pytest.mark.parametrize(
    "command", [("goto", 3, 0, 2), ("status",), ("mission", "clear")], ids=lambda words: words[0]
)
def test_an_option_that_a_running_station_cannot_honour_is_refused(
    connection: FakeConnection,
    command: tuple[object, ...],
    typed: tuple[object, ...],
    told: str,
    hint: str,
) -> None:
    ended = gcs(*command, "--link", LINK, *typed)
    assert ended.exit_code == ExitCode.USAGE
    assert f"the running station of process 4711, which differs: {told}" in ended.output
    assert f"{hint} to use that station as it is" in ended.output
    assert f"gcs stations end --link {LINK}" in ended.output
    assert connection.sent == []


def test_an_option_that_says_what_the_station_has_is_none_the_less_right(
    connection: FakeConnection,
) -> None:
    connection.station = in_state("HOVERING")
    typed = ("--policy", "default", "--log-dir", "/flights", "--vehicle", 1)
    assert gcs("goto", 3, 0, 2, "--link", LINK, *typed).exit_code == ExitCode.DONE


def test_a_policy_that_cannot_be_read_is_told_as_such(connection: FakeConnection) -> None:
    ended = gcs("goto", 3, 0, 2, "--link", LINK, "--policy", "missing.toml")
    assert ended.exit_code == ExitCode.BAD_FILE
    assert connection.sent == []


def test_a_stop_takes_any_policy_and_log_but_stops_no_other_vehicle(
    connection: FakeConnection,
) -> None:
    typed = ("--policy", "lab", "--log-dir", "/elsewhere")
    assert gcs("abort", "--link", LINK, *typed).exit_code == ExitCode.DONE
    assert words(connection) == ["abort"]
    ended = gcs("abort", "--link", LINK, "--vehicle", 2)
    assert ended.exit_code == ExitCode.USAGE
    assert "vehicle 2 was asked for, it has 1/1 px4 quadrotor" in ended.output
    assert words(connection) == ["abort"]


THERE = ["1/1 px4 quadrotor", "2/1 ardupilot quadrotor"]
BRIDGE = msgspec.structs.replace(FOUND, vehicles=THERE)


@pytest.mark.parametrize(
    ("typed", "asked"),
    [
        (("goto", 3, 0, 2), ["goto"]),
        (("land",), ["land"]),
        (("abort",), ["abort"]),
    ],
)
def test_of_a_bridge_the_vehicle_that_was_named_is_asked_and_no_other(
    found: list[Description],
    connection: FakeConnection,
    typed: tuple[object, ...],
    asked: list[str],
) -> None:
    found[:] = [BRIDGE]
    connection.station = FakeStation("airborne")
    gcs(*typed, "--link", LINK, "--vehicle", 2, "--wait", 1)
    sent = [each for each in connection.sent if isinstance(each, ipc.Ask)]
    assert [(each.word, each.vehicle) for each in sent] == [(word, 2) for word in asked]


def test_the_status_of_a_vehicle_of_a_bridge_is_of_that_one(
    found: list[Description], connection: FakeConnection
) -> None:
    found[:] = [BRIDGE]
    connection.station = FakeStation("airborne")
    ended = gcs("status", "--link", LINK, "--vehicle", 2)
    assert ended.exit_code == ExitCode.DONE, ended.output
    assert "2/1 px4 quadrotor" in ended.output


def test_a_stop_of_the_first_vehicle_of_a_bridge_is_for_that_one_alone(
    found: list[Description], connection: FakeConnection
) -> None:
    found[:] = [BRIDGE]
    gcs("abort", "--link", LINK, "--vehicle", 1)
    assert [each.vehicle for each in connection.sent if isinstance(each, ipc.Ask)] == [1]


@pytest.mark.parametrize("command", [("goto", 3, 0, 2), ("abort",), ("status",)])
def test_a_vehicle_that_a_bridge_does_not_have_is_refused_with_those_that_it_has(
    found: list[Description], connection: FakeConnection, command: tuple[object, ...]
) -> None:
    found[:] = [BRIDGE]
    ended = gcs(*command, "--link", LINK, "--vehicle", 3)
    assert ended.exit_code == ExitCode.USAGE
    there = "1/1 px4 quadrotor, 2/1 ardupilot quadrotor"
    assert f"vehicle 3 was asked for, it has {there}" in ended.output
    assert connection.sent == []


def test_stations_are_listed_without_their_tokens(found: list[Description]) -> None:
    (shown,) = json.loads(gcs("stations", "--json").output)
    assert (shown["pid"], shown["token"]) == (4711, "")
    assert "4711  1/1 px4 quadrotor, since " in gcs("stations").output
    found.clear()
    assert gcs("stations").output == "no station is running\n"


@pytest.mark.parametrize("command", [["attach", "--plain"], ["operations"], ["stations", "end"]])
def test_where_none_runs_that_is_said(command: list[str], found: list[Description]) -> None:
    found.clear()
    ended = gcs(*command)
    assert ended.exit_code == ExitCode.NO_VEHICLE
    assert "no station is running" in ended.output
    assert "gcs fly" in ended.output


def test_of_several_one_must_be_named(found: list[Description]) -> None:
    found.append(Description(4712, 1, ["udpin://127.0.0.1:47002"]))
    ended = gcs("abort")
    assert ended.exit_code == ExitCode.USAGE
    assert "4711 (1/1 px4 quadrotor) on udpin://127.0.0.1:47001" in ended.output
    assert "--link" in ended.output


@pytest.mark.parametrize(
    ("state", "code", "sentence", "ended_s", "line"),
    [
        ("running", "", "", None, "running, for 12 s"),
        ("complete", "", "complete", 3, "complete, after 3 s"),
        ("aborted", "OPERATOR", "stopped by the operator", 3, None),
    ],
)
def test_an_operation_is_one_line(
    state: str, code: str, sentence: str, ended_s: int | None, line: str | None
) -> None:
    ended_ns = None if ended_s is None else ended_s * 10**9
    ask = ipc.Ask(1, "goto", goal_enu=(3.0, 0.0, 2.0))
    operation = ipc.Operation(7, ask, 2, "gcs fly, pid 1", 0, state, code, sentence, ended_ns)
    expected = line or "aborted OPERATOR: stopped by the operator, after 3 s"
    who = "asked by operator 2 (gcs fly, pid 1)"
    assert operation_line(operation, 12 * 10**9) == f"  7  goto 3 0 2: {expected}, {who}"


def test_an_operation_of_one_of_several_vehicles_names_it() -> None:
    operation = ipc.Operation(7, ipc.Ask(1, "land", vehicle=2), 2, "gcs fly, pid 1", 0)
    assert operation_line(operation, 0).startswith("  7  land of vehicle 2: running")
