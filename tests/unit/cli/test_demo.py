"""The demo's script, flown on a fake station on a virtual clock."""

from __future__ import annotations

import io
from dataclasses import replace

import pytest
from rich.console import Console

from gcs import ipc
from gcs.cli.demo import demo
from gcs.cli.demo import script as demo_script
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError
from gcs.operator.line_parser import parse_line
from tests.unit.operator.fake_station import FakeConnection, FakeStation, NoInterrupts


def yard() -> FakeConnection:
    """A station whose gate answers as that of the demo's policy."""
    mast = ("LEG_LEAVES_FENCE", "the leg goes inside the mast")
    outside = ("OUTSIDE_FENCE", "34.2 m outside")
    refusals = {(12.0, 16.0, 5.0): mast, (60.0, 8.0, 5.0): outside}
    return FakeConnection(FakeStation(refusals=refusals))


def fly(connection: FakeConnection) -> tuple[int, str]:
    out = io.StringIO()
    console = Console(file=out, width=100, highlight=False)
    code = demo.run_over(connection, NoInterrupts(), console, "missions/demo.toml", 10.0)
    return code, out.getvalue()


def test_the_script_comes_out_as_written_and_is_told_on_a_pipe() -> None:
    connection = yard()
    code, told = fly(connection)
    assert code == ExitCode.DONE
    assert "\x1b" not in told
    assert "goto 60 8 5: refused OUTSIDE_FENCE: 34.2 m outside" in told
    assert "goto 9 18 5: aborted OPERATOR" in told
    assert "✗" not in told
    assert "logs/x.mcap" in told
    assert connection.station.state == "GROUNDED"
    assert isinstance(connection.sent[-1], ipc.Leave)


def test_it_shows_all_that_it_must() -> None:
    expected = {step.expect for step in demo_script.SCRIPT}
    assert expected == {
        "complete",
        "refused OUTSIDE_FENCE",
        "refused LEG_LEAVES_FENCE",
        "refused BUSY",
        "aborted OPERATOR",
    }
    lines = " ".join(step.line for step in demo_script.SCRIPT)
    for word in ("arm", "takeoff", "control", "photo", "abort", "resume", "mission", "land"):
        assert word in lines
    for step in demo_script.SCRIPT:
        assert parse_line(step.line.format(mission="x")) is not None


def test_a_flight_that_is_not_as_scripted_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    first = replace(demo_script.SCRIPT[0], expect="refused BUSY")
    monkeypatch.setattr(demo_script, "SCRIPT", (first, *demo_script.SCRIPT[1:]))
    with pytest.raises(
        ExitError, match="arm came to 'complete', expected 'refused BUSY'"
    ) as failed:
        fly(yard())
    assert failed.value.exit_code == ExitCode.NOT_COMPLETED


def test_ctrl_c_in_the_demo_leaves_through_the_station() -> None:
    interrupts = NoInterrupts()
    interrupts.name = "SIGINT"
    connection = FakeConnection()
    out = io.StringIO()
    console = Console(file=out)
    assert demo.run_over(connection, interrupts, console, "x", 10.0) == ExitCode.INTERRUPTED
    assert out.getvalue().endswith(
        "gcs: left\ngcs: the simulation has ended with it, and its vehicle\nlog: logs/x.mcap\n"
    )
    assert connection.sent == [ipc.Leave("interrupted")]
