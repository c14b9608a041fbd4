"""The one-shot commands: take control if need be, send, see the outcome, exit with what it was."""

from __future__ import annotations

import json
from functools import partial

import msgspec
import pytest

from gcs import ipc
from gcs.cli.oneshot_session import OneShotConfig, run_over, sending
from gcs.cli.progress import ProgressDisplay
from gcs.cli.status import report
from gcs.exit_codes import ExitCode
from gcs.operator.dialogue import Dialogue
from gcs.operator.errors import ExitError
from gcs.operator.line_parser import parse_line
from gcs.request_words import SendRequests
from tests.unit.operator.fake_station import (
    LANDED_KNOWN_S,
    FakeConnection,
    FakeStation,
    NoInterrupts,
)


def run(
    line: str, station: FakeStation | None = None, *, wait_s: float = 60.0
) -> tuple[int, FakeConnection]:
    parsed = parse_line(line)
    assert parsed is not None
    assert isinstance(parsed.action, SendRequests)
    connection = FakeConnection(station)
    how = OneShotConfig(10.0, wait_s, as_json=False, what=line)
    code = run_over(connection, NoInterrupts(), how, sending(parsed.action, wait_s))
    return code, connection


def sent_words(connection: FakeConnection) -> list[str]:
    return [command.word for command in connection.sent if isinstance(command, ipc.Ask)]


def test_a_goto_takes_control_of_a_vehicle_that_flies_without_us() -> None:
    code, connection = run("goto 3 0 2", FakeStation("airborne"))
    assert code == ExitCode.DONE
    assert sent_words(connection) == ["control", "goto"]
    assert connection.station.pos == (3.0, 0.0, 2.0)
    assert isinstance(connection.sent[-1], ipc.Leave)


def test_a_vehicle_is_judged_once_it_is_known_whether_it_flies() -> None:
    code, connection = run("arm", FakeStation("late landed"))
    assert code == ExitCode.DONE
    assert connection.asked_at_s[0] > LANDED_KNOWN_S


def test_a_stop_goes_out_with_the_first_word_of_the_vehicle() -> None:
    connection = FakeConnection(FakeStation("late landed"))
    how = OneShotConfig(10.0, 60.0, as_json=False, what="abort", placed=False)
    task = sending(SendRequests((ipc.Ask(0, "abort"),)), 60.0)
    assert run_over(connection, NoInterrupts(), how, task) == ExitCode.DONE
    assert connection.asked_at_s == [pytest.approx(0.1)]


def test_whoever_leaves_before_the_end_sends_nothing_but_that_and_is_told_where_the_vehicle_is(
    capsys: pytest.CaptureFixture[str],
) -> None:
    code, connection = run("rtl", FakeStation("airborne"), wait_s=0.3)
    assert code == ExitCode.NOT_COMPLETED
    assert sent_words(connection) == ["rtl"]
    assert connection.sent[1:] == [ipc.Leave("done")]
    told = capsys.readouterr().err
    assert "rtl: not completed within 0.3 s" in told
    assert "log: logs/x.mcap" in told


@pytest.mark.parametrize("line", ["land", "hold", "arm", "mode LOITER"])
def test_what_is_no_move_needs_no_control(line: str) -> None:
    _, connection = run(line, FakeStation("airborne"))
    assert sent_words(connection) == [line.split()[0]]


def test_refused_by_the_gate_is_six_and_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    code, _ = run("goto 500 0 2", FakeStation("airborne"))
    assert code == ExitCode.REFUSED_BY_GATE
    assert "goto 500 0 2: refused OUTSIDE_FENCE: 350 m" in capsys.readouterr().out


def test_what_takes_too_long_is_eight(capsys: pytest.CaptureFixture[str]) -> None:
    code, connection = run("goto 100 0 2", FakeStation("airborne"), wait_s=2.0)
    assert code == ExitCode.NOT_COMPLETED
    assert "goto 100 0 2: not completed within 2 s" in capsys.readouterr().err
    assert connection.station.state == "HOLDING"


def test_how_much_of_the_log_is_shown_is_asked_for(capsys: pytest.CaptureFixture[str]) -> None:
    shown = []
    for level in (1, 3, 4):
        how = OneShotConfig(10.0, 60.0, as_json=False, what="goto", min_level=level)
        task = sending(SendRequests((ipc.Ask(0, "goto", goal_enu=(500.0, 0.0, 2.0)),)), 60.0)
        run_over(FakeConnection(FakeStation("airborne")), NoInterrupts(), how, task)
        shown.append(capsys.readouterr().err.count("gate:"))
    assert shown[0] > shown[1] >= shown[2] == 0


def test_no_vehicle_is_three() -> None:
    with pytest.raises(ExitError) as failed:
        run("land", FakeStation("silent"))
    assert failed.value.exit_code == ExitCode.NO_VEHICLE
    assert "vehicle-sim" in failed.value.hint


def test_ctrl_c_while_waiting_is_130_and_tells_where_the_vehicle_is(
    capsys: pytest.CaptureFixture[str],
) -> None:
    interrupts = NoInterrupts()
    connection = FakeConnection(FakeStation("airborne"))

    def task(dialogue: Dialogue, _display: ProgressDisplay) -> ExitCode:
        interrupts.name = "SIGINT"
        dialogue.wait_settled(dialogue.send(ipc.Ask(0, "land")))
        return ExitCode.DONE

    how = OneShotConfig(10.0, 60.0, as_json=False, what="land")
    assert run_over(connection, interrupts, how, task) == ExitCode.INTERRUPTED
    assert isinstance(connection.sent[-1], ipc.Leave)
    assert capsys.readouterr().err == "gcs: left\nlog: logs/x.mcap\n"


def test_status_is_a_table_or_json(capsys: pytest.CaptureFixture[str]) -> None:
    for as_json in (False, True):
        how = OneShotConfig(10.0, 0.0, as_json, "status")
        task = partial(report, as_json=as_json)
        assert run_over(FakeConnection(), NoInterrupts(), how, task) == ExitCode.DONE
    table, line = capsys.readouterr().out.rstrip().rsplit("\n", 1)
    assert "GROUNDED, control NONE" in table
    assert json.loads(line)["state"] == "GROUNDED"


class ReadLate(FakeStation):
    """Reads its vehicle's own failsafes `after_s` after the start."""

    after_s = 4.0

    def snapshot(self) -> ipc.Snapshot:
        known = ["geofence breach: hold"] if self.time_s >= self.after_s else []
        return msgspec.structs.replace(super().snapshot(), failsafes=known)


@pytest.mark.parametrize(("after_s", "told"), [(4.0, "geofence breach: hold"), (60.0, "not read")])
def test_status_waits_for_failsafes_that_are_being_read(
    after_s: float, told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    station = ReadLate()
    station.after_s = after_s
    station.preflight_rows = [ipc.PreflightRow("failsafes", "caution", "are read", waits=True)]
    how = OneShotConfig(10.0, 0.0, as_json=False, what="status")
    run_over(FakeConnection(station), NoInterrupts(), how, partial(report, as_json=False))
    assert told in capsys.readouterr().out
