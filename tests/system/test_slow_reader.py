"""An operator's program that stops reading does not disturb the flight."""

from __future__ import annotations

import fcntl
import os
import signal
import time
from itertools import pairwise
from pathlib import Path

import pytest

from gcs import ipc
from gcs.config import StationConfig
from gcs.operator.client import StationClient, StationEnded, StationEvent
from gcs.operator.conversation import exit_code_of
from tests.system.flight_log import only_log, times_ns, whole
from tests.system.machine import KeptWaiting
from tests.system.patience import PATIENT_POLICY, PATIENT_S, until
from tests.system.programs import GCS, children, running
from tests.system.station import simulated

pytestmark = pytest.mark.system

FLY = (GCS, "fly", "--sim", "--plain", "--policy", PATIENT_POLICY)
STOPPED_S = 3.0
UNDISTURBED_S = 0.5
"""A link that waits stands for seconds.  What the machine kept it waiting is added."""
FILLS_S = 2.0
"""Ten snapshots a second fill a pipe of 4096 bytes in less."""
SLOW_S = 1.5


def longest_gap_s(path: Path, since_ns: int) -> float:
    """Between setpoints, from the last one before the reader stopped on."""
    stream = times_ns(path, "SET_POSITION_TARGET_LOCAL_NED")
    before = [at_ns for at_ns in stream if at_ns < since_ns]
    stream = stream[max(0, len(before) - 1) :]
    assert len(stream) > 20
    return max(after - before for before, after in pairwise(stream)) / 1e9


def test_a_stopped_operators_program_leaves_the_setpoint_stream_alone(tmp_path: Path) -> None:
    with running(*FLY, "--log-dir", str(tmp_path)) as program:
        program.type("arm", "takeoff 1.5")
        program.until_out("takeoff 1.5: complete")
        (station,) = children(program.pid)
        kept = KeptWaiting(station)
        os.kill(program.pid, signal.SIGSTOP)
        stop_ns = time.time_ns()
        until(lambda: time.time_ns() > stop_ns + STOPPED_S * 1e9, "3 s without a reader")
        os.kill(program.pid, signal.SIGCONT)
        program.type("goto 1 0 1.5", "state")
        program.until_out("goto 1 0 1.5: complete")
        program.until_out("state: HOVERING, control OURS")
        kept_waiting_s = kept.seconds
        program.type("quit")
        assert program.ended() == 0

    path = only_log(tmp_path)
    assert whole(path).states[-1].state == "HOLDING"
    assert longest_gap_s(path, since_ns=stop_ns) < UNDISTURBED_S + kept_waiting_s


@pytest.mark.skipif(not hasattr(fcntl, "F_SETPIPE_SZ"), reason="needs a pipe of chosen size")
@pytest.mark.thorough
def test_a_pipe_that_is_full_costs_snapshots_and_nothing_else(tmp_path: Path) -> None:
    with simulated(tmp_path) as operator:
        process = operator.client._process
        assert process.stdout is not None
        fcntl.fcntl(process.stdout, fcntl.F_SETPIPE_SZ, 4096)
        operator.fly("arm", "takeoff 1.5")
        heard = len(operator.events)
        kept, stop_ns = KeptWaiting(operator.client.pid), time.time_ns()
        resume_s = time.monotonic() + STOPPED_S
        until(lambda: time.monotonic() > resume_s, "3 s in which nobody reads")
        operator.fly("goto 1 0 1.5")
        kept_waiting_s = kept.seconds
        path = operator.log_path
        operator.leave()

    snapshots = [event for event in operator.events[heard:] if isinstance(event, ipc.Snapshot)]
    ages_s = [(b.time_ns - a.time_ns) / 1e9 for a, b in pairwise(snapshots)]
    assert max(ages_s) > STOPPED_S / 2, "some were dropped"
    assert longest_gap_s(path, since_ns=stop_ns) < UNDISTURBED_S + kept_waiting_s


@pytest.mark.skipif(not hasattr(fcntl, "F_SETPIPE_SZ"), reason="needs a pipe of chosen size")
def test_the_good_bye_comes_through_a_pipe_that_is_full_at_the_end() -> None:
    client = StationClient.start(StationConfig(endpoints=["udpin://127.0.0.1:0"], record=False))
    try:
        process = client._process
        assert process.stdout is not None
        fcntl.fcntl(process.stdout, fcntl.F_SETPIPE_SZ, 4096)
        fills_s = time.monotonic() + FILLS_S
        until(lambda: time.monotonic() > fills_s, "a full pipe")
        client.send(ipc.Leave("done"))
        resume_s = time.monotonic() + SLOW_S
        until(lambda: time.monotonic() > resume_s, "a reader that is slow at the end")
        events: list[StationEvent] = []
        while not events or not isinstance(events[-1], StationEnded):
            events += client.poll(PATIENT_S).events
    finally:
        client.close()
    assert isinstance(events[-2], ipc.Bye)
    assert exit_code_of(events[-1]) == 0
