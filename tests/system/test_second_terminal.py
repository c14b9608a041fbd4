"""A station that flies, and other programs of its user: look, stop, take over, keep."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from gcs.config import SimConfig, StationConfig
from gcs.exit_codes import ExitCode
from gcs.shell import stations
from tests.system.flight_log import AUTO_LOITER
from tests.system.hostile_clients import setpoints_between
from tests.system.patience import PATIENT_POLICY, PATIENT_S, until
from tests.system.programs import GCS, LONGEST_S, alive, gcs, running
from tests.system.second_program import HoldWatch, loiter_seen_ns, noted_ns
from tests.system.station import PATIENT_VEHICLE, simulated, station, tapped
from tests.system.terminal import terminal
from tests.system.wire_tap import WireTap

pytestmark = pytest.mark.system

SOON_TICKS = 2
"""Of the station's, 50 ms each: from the word in another program to the hold on the wire."""


@pytest.fixture(autouse=True)
def runtime(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Stations of this test alone."""
    folder = tmp_path_factory.mktemp("run")
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(folder))
    return folder / "mavgate"


def listed(*words: str) -> Any:
    ended = gcs(*words, "--json")
    assert ended.returncode == 0, ended.stderr
    return json.loads(ended.stdout)


@pytest.mark.parametrize("program", ["gcs abort", "python"])
def test_an_abort_in_another_program_is_on_the_wire_at_once_and_complete_when_seen(
    tmp_path: Path, program: str
) -> None:
    watch = HoldWatch()
    with tapped(tmp_path, tap=WireTap(watch.hear)) as (operator, tap):
        operator.fly("arm", "takeoff 3")
        goto = operator.send("goto 60 0 3")
        told = noted_ns(program)
        operator.until(lambda: goto.settled, "its ending")
        assert watch.passed_ns
        assert setpoints_between(tap, told.sent_ns, watch.passed_ns[0]) <= SOON_TICKS
        assert told.complete_ns > loiter_seen_ns(tap, AUTO_LOITER)
        assert goto.outcome is not None
        assert (goto.outcome.ended, goto.outcome.code) == ("aborted", "OPERATOR")
        operator.leave()


def test_others_look_and_stop_and_leave_no_trace(tmp_path: Path) -> None:
    with simulated(tmp_path) as operator:
        operator.fly("arm", "takeoff 2")
        (found,) = listed("stations")
        assert found["vehicle"] == "1/1 px4 quadrotor"
        assert found["log_path"] == str(operator.log_path)
        link = ("--link", found["endpoints"][0])
        assert listed("status", *link)["state"] == "HOVERING"
        refused = gcs("goto", "1", "0", "2", *link)
        assert refused.returncode == ExitCode.REFUSED_BY_GATE
        assert "refused OTHER_OPERATOR: operator 1 (" in refused.stdout
        assert "take it over with --take, or by the words `station take`" in refused.stdout
        operator.fly("goto 1 0 2")
        assert listed("operations")[-1]["asked"]["word"] == "goto"
        number = listed("operations")[-1]["id"]
        ended = gcs("operations", "wait", str(number))
        assert (ended.returncode, "goto 1 0 2: complete" in ended.stdout) == (0, True)
        assert gcs("operations", "stop", str(number)).returncode == ExitCode.REFUSED_BY_GATE
        landed = gcs("land")
        assert (landed.returncode, landed.stdout) == (0, "land: complete\n")
        assert operator.send("hold").verdict is not None, "the first operator is where it was"
        operator.leave()
    assert gcs("stations").stdout == "no station is running\n"


def test_a_one_shot_that_takes_over_moves_the_vehicle_and_gives_the_station_back(
    tmp_path: Path,
) -> None:
    with simulated(tmp_path) as operator:
        operator.fly("arm", "takeoff 2")
        (found,) = listed("stations")
        moved = gcs("goto", "2", "0", "2", "--take", "--link", found["endpoints"][0])
        assert (moved.returncode, moved.stdout) == (
            0,
            "station take: complete\ngoto 2 0 2: complete\n",
        )
        operator.until(lambda: operator.said("taken over from operator 1"), "being told")
        operator.fly("goto 0 0 2")
        assert not operator.said("HOLDING")
        operator.leave()


@pytest.mark.thorough
def test_lines_of_a_second_operator_stop_an_operation_of_the_first(tmp_path: Path) -> None:
    with simulated(tmp_path) as operator, running(GCS, "attach", "--plain") as other:
        operator.fly("arm", "takeoff 3")
        goto = operator.send("goto 60 0 3")
        other.type("goto 1 0 3")
        other.until_out("goto 1 0 3: refused OTHER_OPERATOR")
        other.type("abort", "state")
        other.until_out("abort: complete")
        operator.until(lambda: goto.settled, "its ending")
        other.type("station take", "resume", "quit")
        other.until_out("resume: complete")
        assert other.ended() == 0
        operator.until(lambda: operator.said("HOLDING"), "a hold for the one who left")
        operator.fly("resume")
        operator.leave()


@pytest.mark.thorough
def test_a_second_screen_shows_the_flight_and_may_stop_it(tmp_path: Path) -> None:
    with simulated(tmp_path) as operator:
        operator.fly("arm", "takeoff 3")
        goto = operator.send("goto 60 0 3")
        with terminal(GCS, "attach") as screen:
            screen.until_text("px4 quadrotor   MOVING ")
            screen.press(" ")
            screen.until_text("abort: complete")
            operator.until(lambda: goto.settled, "its ending")
            screen.press("q")
            assert screen.process.wait(PATIENT_S) == 0
            screen.until_text("the station goes on")
        operator.fly("resume")
        operator.leave()


@pytest.mark.thorough
def test_a_screen_says_who_is_in_control_and_who_took_it(tmp_path: Path) -> None:
    with simulated(tmp_path) as operator, terminal(GCS, "attach") as screen:
        screen.until_text("control: operator 1", "ctrl operator 1")
        screen.press("o")
        screen.until_text("you are in control of the station")
        operator.until(lambda: operator.said("taken over from operator 1"), "being told")
        operator.fly("station take")
        screen.until_text("CONTROL WENT TO operator 1")
        screen.press("q")
        assert screen.process.wait(PATIENT_S) == 0
        operator.leave()


@pytest.fixture
def kept(tmp_path: Path) -> Iterator[int]:
    """The process of a station that flies, kept, after its first operator has left."""
    setup = StationConfig(
        sim=SimConfig(params=PATIENT_VEHICLE),
        policy_path=PATIENT_POLICY,
        log_dir=str(tmp_path),
        keep=True,
    )
    with station(setup) as operator:
        operator.connect()
        operator.fly("arm", "takeoff 2")
        pid = operator.client.pid
        ended = operator.leave()
        assert ended.bye is not None
        assert ended.bye.goes_on
        assert "STILL FLYING in AUTO.LOITER" in ended.bye.sentence
    yield pid
    if alive(pid):
        os.kill(pid, signal.SIGTERM)
        until(lambda: not alive(pid), "its end")


def test_a_kept_station_outlives_its_operator_and_is_flown_by_one_shots(
    kept: int, tmp_path: Path
) -> None:
    (found,) = listed("stations")
    assert (found["pid"], found["keep"]) == (kept, True)
    link = ("--link", found["endpoints"][0])
    other = gcs("goto", "2", "0", "2", *link, "--policy", "lab")
    assert other.returncode == ExitCode.USAGE
    assert "policy lab was asked for, it has patient" in other.stderr
    goto = ("goto", "2", "0", "2", *link, "--policy", PATIENT_POLICY, "--log-dir", str(tmp_path))
    held = gcs(*goto)
    assert held.returncode == ExitCode.REFUSED_BY_GATE
    assert "hint: gcs resume" in held.stderr
    assert gcs("resume", *link).returncode == 0
    moved = gcs(*goto)
    assert (moved.returncode, moved.stdout) == (0, "goto 2 0 2: complete\n")
    assert listed("status", *link)["state"] == "HOVERING", "a one-shot leaves it as it is"
    ended = gcs("stations", "end")
    assert ended.returncode == 0, ended.stderr
    until(lambda: not alive(kept), "its end")
    assert stations.running(stations.folder_of()) == []


def test_a_station_that_is_killed_is_not_found(kept: int) -> None:
    os.kill(kept, signal.SIGKILL)
    until(lambda: not alive(kept), "its end")
    assert gcs("stations").stdout == "no station is running\n"
    assert list(stations.folder_of().iterdir()) == []


def test_without_a_station_an_abort_says_that_there_is_no_vehicle() -> None:
    ended = gcs("abort", "--link", "udpin://127.0.0.1:0", "--timeout", "1")
    assert ended.returncode == ExitCode.NO_VEHICLE


def test_import_gcs_loads_next_to_nothing() -> None:
    code = "import sys, gcs; print(sorted(n for n in sys.modules if n.startswith(('gcs', 'ms'))))"
    ended = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=LONGEST_S, check=True
    )
    assert ended.stdout == "['gcs']\n"
