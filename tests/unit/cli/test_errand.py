"""The one-shot commands: take control if need be, ask, see it happen, exit with what it was."""

from __future__ import annotations

import json
from functools import partial

import msgspec
import pytest

from gcs import ipc
from gcs.cli import say, typed, words
from gcs.cli.dialogue import Asked, Dialogue
from gcs.cli.errand import ErrandConfig, asking, run_over
from gcs.cli.exits import Exit, Fail
from gcs.cli.hush import Hush
from gcs.cli.progress import Ticker
from gcs.cli.status import report, rows
from tests.unit.cli.fake_link import LANDED_KNOWN_S, FakeClient, FakeLink, NoInterrupts


def run(line: str, link: FakeLink | None = None, *, wait_s: float = 60.0) -> tuple[int, FakeClient]:
    parsed = typed.parse_line(line)
    assert parsed is not None
    assert isinstance(parsed.action, words.Request)
    client = FakeClient(link)
    how = ErrandConfig(10.0, wait_s, as_json=False, what=line)
    return run_over(client, NoInterrupts(), how, asking(parsed.action, wait_s)), client


def asked(client: FakeClient) -> list[str]:
    return [command.word for command in client.sent if isinstance(command, ipc.Ask)]


def test_a_goto_takes_control_of_a_vehicle_that_flies_without_us() -> None:
    code, client = run("goto 3 0 2", FakeLink("airborne"))
    assert code == Exit.DONE
    assert asked(client) == ["control", "goto"]
    assert client.link.pos == (3.0, 0.0, 2.0)
    assert isinstance(client.sent[-1], ipc.Leave)


def test_a_vehicle_is_judged_once_it_is_known_whether_it_flies() -> None:
    code, client = run("arm", FakeLink("late landed"))
    assert code == Exit.DONE
    assert client.asked_at_s[0] > LANDED_KNOWN_S


@pytest.mark.parametrize("line", ["land", "hold", "arm", "mode LOITER"])
def test_what_is_no_move_needs_no_control(line: str) -> None:
    _, client = run(line, FakeLink("airborne"))
    assert asked(client) == [line.split()[0]]


def test_refused_by_the_gate_is_six_and_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    code, _ = run("goto 500 0 2", FakeLink("airborne"))
    assert code == Exit.REFUSED_BY_GATE
    assert "goto 500 0 2: refused OUTSIDE_FENCE: 350 m" in capsys.readouterr().out


def test_what_takes_too_long_is_eight(capsys: pytest.CaptureFixture[str]) -> None:
    code, client = run("goto 100 0 2", FakeLink("airborne"), wait_s=2.0)
    assert code == Exit.NOT_COMPLETED
    assert "goto 100 0 2: not completed within 2 s" in capsys.readouterr().err
    assert client.link.state == "HOLDING"


@pytest.mark.parametrize(
    ("outcome", "code", "ended", "ending_code", "exit_code"),
    [
        ("accepted", "", "complete", "", Exit.DONE),
        ("accepted", "", "aborted", "VEHICLE_REFUSED", Exit.REFUSED_BY_VEHICLE),
        ("accepted", "", "timed out", "DEADLINE", Exit.NOT_COMPLETED),
        ("accepted", "", "taken over", "MODE_CHANGED", Exit.NOT_COMPLETED),
        ("refused", "BUSY", "", "", Exit.REFUSED_BY_GATE),
        ("refused", "NO_VEHICLE", "", "", Exit.NO_LINK),
        ("refused", "BAD_MISSION", "", "", Exit.BAD_FILE),
        ("refused", "RECORDER_DOWN", "", "", Exit.RECORDER),
        ("superseded", "SUPERSEDED", "", "", Exit.REFUSED_BY_GATE),
        ("accepted", "", "", "", Exit.NOT_COMPLETED),
    ],
)
def test_exit_codes_mean_something(
    outcome: str, code: str, ended: str, ending_code: str, exit_code: Exit
) -> None:
    one = Asked(ipc.Ask(1, "goto"), "goto", ipc.VerdictEvent(1, "goto", outcome, code))
    if ended:
        one.ending = ipc.EndingEvent(1, "goto", ended, ending_code)
    assert one.exit == exit_code


def test_no_vehicle_is_three() -> None:
    with pytest.raises(Fail) as failed:
        run("land", FakeLink("silent"))
    assert failed.value.exit_code == Exit.NO_LINK
    assert "vehicle-sim" in failed.value.hint


def test_ctrl_c_while_waiting_is_130_and_tells_where_the_vehicle_is(
    capsys: pytest.CaptureFixture[str],
) -> None:
    interrupts = NoInterrupts()
    client = FakeClient(FakeLink("airborne"))

    def errand(dialogue: Dialogue, _ticker: Ticker) -> Exit:
        interrupts.name = "SIGINT"
        dialogue.settle(dialogue.ask(ipc.Ask(0, "land")))
        return Exit.DONE

    how = ErrandConfig(10.0, 60.0, as_json=False, what="land")
    assert run_over(client, interrupts, how, errand) == Exit.INTERRUPTED
    assert isinstance(client.sent[-1], ipc.Leave)
    assert capsys.readouterr().err == "gcs: left\nlog: logs/x.mcap\n"


CAUTION = "CAUTION: vehicle_failsafe_weak: the vehicle's own failsafes: none"


@pytest.mark.parametrize(("cautions", "told"), [(True, True), (False, False)])
def test_a_standing_caution_is_told_where_it_is_asked_for(cautions: bool, told: bool) -> None:
    hidden = Hush(cautions=cautions).hides(ipc.LogEvent(0, 3, "gate", CAUTION), None)
    assert hidden is not told


def test_only_the_copy_of_an_own_refusal_is_hidden() -> None:
    hush = Hush(cautions=True)
    copy = ipc.LogEvent(0, 3, "gate", "Refused (BUSY): the vehicle is MOVING")
    assert not hush.hides(copy, None)
    verdict = ipc.VerdictEvent(1, "goto", "refused", "BUSY", "the vehicle is MOVING")
    hush.hides(verdict, Asked(ipc.Ask(1, "goto"), "goto"))
    assert hush.hides(copy, None)
    assert not hush.hides(ipc.LogEvent(0, 3, "gate", "Refused (STALE): too old"), None)
    assert not hush.hides(ipc.LogEvent(0, 4, "gate", copy.text), None)
    lost = ipc.EndingEvent(1, "goto", "aborted", "OPERATOR_LOST", "the operator is lost")
    hush.hides(lost, Asked(ipc.Ask(1, "goto"), "goto"))
    assert hush.hides(ipc.LogEvent(0, 3, "gate", "goto: aborted: the operator is lost"), None)


@pytest.mark.parametrize(
    ("ending", "line"),
    [
        (ipc.EndingEvent(1, "arm", "complete", "", "Complete"), "arm: complete"),
        (
            ipc.EndingEvent(1, "arm", "aborted", "OPERATOR_LOST", "the operator is lost"),
            "arm: aborted OPERATOR_LOST: the operator left",
        ),
        (
            ipc.EndingEvent(1, "arm", "aborted", "LINK_LOST", "not heard any more"),
            "arm: aborted LINK_LOST: not heard any more",
        ),
    ],
)
def test_an_ending_says_why_where_there_is_a_why(ending: ipc.EndingEvent, line: str) -> None:
    assert say.ending_line("arm", ending) == line


def test_a_heading_goes_round_and_a_rate_not_measured_is_left_out() -> None:
    seen = msgspec.structs.replace(FakeLink().snapshot(), yaw_deg=359.7, rx_hz=0.0)
    shown = dict(rows(seen))
    assert shown["heading"] == "0 deg"
    assert shown["link"] == "0.0 % lost"


def test_the_progress_line_makes_room_for_an_answer(capsys: pytest.CaptureFixture[str]) -> None:
    with Ticker("goto", 0.0, shown=True) as ticker:
        ticker.hear(FakeLink().snapshot(), 1.5)
        ticker.clear()
        drawn = capsys.readouterr().err
        # It ends with the cursor at the start of an empty line.
        assert drawn.endswith("\x1b[1A\x1b[2K")
        ticker.hear(FakeLink().snapshot(), 2.5)
    assert "2 s" in capsys.readouterr().err


def test_status_is_a_table_or_json(capsys: pytest.CaptureFixture[str]) -> None:
    for as_json in (False, True):
        how = ErrandConfig(10.0, 0.0, as_json, "status")
        errand = partial(report, as_json=as_json)
        assert run_over(FakeClient(), NoInterrupts(), how, errand) == Exit.DONE
    table, line = capsys.readouterr().out.rstrip().rsplit("\n", 1)
    assert "GROUNDED, control NONE" in table
    assert json.loads(line)["state"] == "GROUNDED"


def test_unknown_values_are_dashes() -> None:
    shown = dict(rows(FakeLink("silent").snapshot()))
    assert shown["position"].startswith("E - N - U -")


def test_progress_is_silent_for_a_second_and_on_a_pipe(capsys: pytest.CaptureFixture[str]) -> None:
    event = ipc.ProgressEvent(1, "upload", 3, 7, "items")
    for shown, now_s in ((False, 5.0), (True, 0.5)):
        with Ticker("upload", 0.0, shown=shown) as ticker:
            ticker.hear(event, now_s)
    assert capsys.readouterr().err == ""
    with Ticker("upload", 0.0, shown=True) as ticker:
        ticker.hear(event, 1.5)
    assert "3 of 7 items" in capsys.readouterr().err
