"""Flights in real time, on a stand-in for a real autopilot: our own vehicle and its viewer."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import msgspec
import pytest

from gcs.campaign.case import LANDED
from gcs.campaign.real_autopilot import private_network
from gcs.campaign.real_time_flights import GUARD, fly_apart
from gcs.campaign.spec import read_plan

TEXT = """\
name = "beside"
sample = "grid"
timeout_s = 60
[[task]]
name = "up"
lines = ["arm", "takeoff 2", "land"]
[vary]
autopilot = ["px4"]
"""
STAND_IN = """\
#!/bin/sh
exec {python} -m vehicle_sim --link udpout://127.0.0.1:14540,onboard --view udp://127.0.0.1:14550
"""


@pytest.mark.skipif(private_network() is None, reason="no private networks on this system")
def test_a_flight_on_a_stand_in(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run = tmp_path / "run"
    run.write_text(STAND_IN.format(python=sys.executable), encoding="utf-8")
    run.chmod(0o755)
    monkeypatch.setenv("MAVGATE_PX4", str(tmp_path))
    file = tmp_path / "campaign.toml"
    file.write_text(TEXT, encoding="utf-8")
    plan = read_plan(file)
    case = plan.case(0, plan.inputs([0.0] * len(plan.axes)))
    case = msgspec.structs.replace(case, simulator="px4-sitl")
    [row] = fly_apart([case], 1, tmp_path)
    assert (row.outcome, row.error) == (LANDED, "")
    assert row.max_up_m == pytest.approx(2.0, abs=0.4)
    assert (tmp_path / "000000.mcap").stat().st_size > 100_000


def test_a_flight_ends_with_all_that_it_started_when_its_pipe_closes() -> None:
    """What it started holds the other end of the output for as long as it lives."""
    command = ["sh", "-c", "sleep 1000 & echo $!; wait"]
    process = subprocess.Popen(
        ["sh", "-c", GUARD, "sh", *command],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        process_group=0,
    )
    assert process.stdin is not None
    assert process.stdout is not None
    with process:
        assert int(process.stdout.readline()) > 0
        process.stdin.close()
        assert process.stdout.read() == b""
    assert process.returncode != 0
