"""`gcs log audit` on what the programs recorded: a script, one-shots, and two operators."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import pytest

from tests.system.flight_log import only_log
from tests.system.patience import PATIENT_POLICY
from tests.system.programs import GCS, gcs, running
from tests.system.station import simulated, tapped
from tests.system.vehicle_program import free_port, vehicle_sim

pytestmark = pytest.mark.system

PATIENT = ("--policy", PATIENT_POLICY)
SCRIPT = """\
arm
takeoff 3
goto 4 0 3
goto 500 0 3
mission upload demo
land
quit
"""


def audited(*logs: Path) -> str:
    """What it says, where it finds no difference."""
    ended = gcs("log", "audit", *map(str, logs))
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert "no difference: every decision and every message is reproduced" in ended.stdout
    return ended.stdout


@pytest.mark.thorough
def test_a_script_of_gcs_fly_is_reproduced(tmp_path: Path) -> None:
    ended = gcs("fly", "--sim", "--plain", *PATIENT, "--log-dir", str(tmp_path), stdin=SCRIPT)
    assert "goto 500 0 3: refused OUTSIDE_FENCE" in ended.stdout, ended.stdout + ended.stderr
    told = audited(only_log(tmp_path))
    assert "files 1" in told
    assert "note:" not in told


@pytest.mark.thorough
def test_one_shot_commands_are_reproduced(tmp_path: Path) -> None:
    port = free_port()
    link = ("--link", f"udpin://127.0.0.1:{port}", *PATIENT, "--log-dir", str(tmp_path))
    with vehicle_sim("--link", f"udpout://127.0.0.1:{port}"):
        for words in (("arm",), ("takeoff", "2"), ("goto", "1", "0", "2"), ("land",)):
            ended = gcs(*words, *link)
            assert ended.returncode == 0, ended.stdout + ended.stderr
    logs = sorted(tmp_path.glob("*.mcap"))
    assert len(logs) == 4
    ended = gcs("log", "audit", *map(str, logs))
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert ended.stdout.count("no difference: every decision") == 4


@pytest.mark.thorough
def test_a_link_that_is_a_stream_is_reproduced(tmp_path: Path) -> None:
    port = free_port()
    with vehicle_sim("--link", f"tcpin://127.0.0.1:{port}"):
        url = f"tcpout://127.0.0.1:{port}"
        words = ("--link", url, "--plain", *PATIENT, "--log-dir", str(tmp_path))
        ended = gcs("fly", *words, stdin=SCRIPT)
    assert "land: complete" in ended.stdout, ended.stdout + ended.stderr
    audited(only_log(tmp_path))


def test_two_operators_are_reproduced(
    tmp_path: Path, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path_factory.mktemp("run")))
    with simulated(tmp_path) as operator:
        operator.fly("arm", "takeoff 2")
        with running(GCS, "attach", "--plain") as other:
            other.type("goto 1 0 2")
            other.until_out("goto 1 0 2: refused OTHER_OPERATOR")
            other.type("station take", "goto 2 0 2")
            other.until_out("goto 2 0 2: complete")
            other.type("quit")
            assert other.ended() == 0
        operator.fly("land")
        log = operator.log_path
        operator.leave()
    assert "operators that came and went" in audited(log)


@pytest.mark.thorough
def test_a_killed_station_s_record_is_audited_as_far_as_it_goes(tmp_path: Path) -> None:
    with tapped(tmp_path) as (operator, _):
        operator.fly("arm", "takeoff 2")
        os.kill(operator.client.pid, signal.SIGKILL)
        log = operator.log_path
    ended = gcs("log", "audit", str(log))
    assert ended.returncode == 1, ended.stdout + ended.stderr
    assert "note: the record breaks off" in ended.stdout
