"""`gcs preflight` waits for what comes slowly, reads what is unread, and exits with the verdict."""

from __future__ import annotations

import json
from functools import partial

import pytest

from gcs import ipc
from gcs.cli.oneshot_session import OneShotConfig, run_over
from gcs.cli.preflight import _look
from gcs.exit_codes import ExitCode
from tests.unit.operator.fake_station import FakeConnection, FakeStation, NoInterrupts

FAILS = ipc.PreflightRow("battery", "fail", "12 %")
WAITS = ipc.PreflightRow("gps", "caution", "nothing yet", waits=True)


class Reporting(FakeStation):
    """Tells these reports, one after the other, the last one for ever."""

    def __init__(self, *reports: ipc.PreflightReport) -> None:
        super().__init__()
        self.reports = list(reports)

    def handle(self, command: ipc.Command, now_s: float) -> list[ipc.Event]:
        if isinstance(command, ipc.Preflight) and self.reports:
            told = self.reports.pop(0) if len(self.reports) > 1 else self.reports[0]
            return [ipc.PreflightReport(command.id, told.rows, 1, told.unread)]
        return super().handle(command, now_s)


def run(
    station: FakeStation, *, as_json: bool = False, timeout_s: float = 3.0
) -> tuple[int, FakeConnection]:
    connection = FakeConnection(station)
    how = OneShotConfig(10.0, 0.0, as_json, "preflight", placed=False, told=False)
    task = partial(_look, as_json=as_json, timeout_s=timeout_s)
    return run_over(connection, NoInterrupts(), how, task), connection


def test_cautions_alone_end_with_0_and_a_failure_with_1(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert run(FakeStation())[0] == ExitCode.DONE
    assert capsys.readouterr().out.endswith("preflight: caution: failsafes\n")
    assert run(FakeStation(preflight_rows=[FAILS]))[0] == ExitCode.DIFFERENT
    assert "FAIL     battery    12 %" in capsys.readouterr().out


def test_as_json_it_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    run(FakeStation(preflight_rows=[FAILS]), as_json=True)
    told = json.loads(capsys.readouterr().out)
    assert told["type"] == "preflight_report"
    assert told["rows"][-1]["verdict"] == "fail"


def test_what_comes_slowly_is_waited_for_up_to_the_timeout() -> None:
    ready = ipc.PreflightRow("gps", "pass", "3D fix")
    late = [ipc.PreflightReport(0, [WAITS])] * 3
    code, connection = run(Reporting(*late, ipc.PreflightReport(0, [ready])))
    assert code == ExitCode.DONE
    looks = sum(isinstance(each, ipc.Preflight) for each in connection.sent)
    assert looks == 5, "one more after that, as something may have been read meanwhile"
    _, connection = run(Reporting(late[0]), timeout_s=2.0)
    assert sum(isinstance(each, ipc.Preflight) for each in connection.sent) == 6


def test_what_is_unread_is_read_by_the_first_name_that_it_has() -> None:
    unread = ipc.PreflightReport(0, [WAITS], 1, [["WP_SPD", "WPNAV_SPEED"]])
    _, connection = run(Reporting(unread), timeout_s=0.5)
    asked = [each for each in connection.sent if isinstance(each, ipc.Ask)]
    assert [(each.word, each.name) for each in asked][:1] == [("param_get", "WP_SPD")]
