"""Whole flights over real UDP: the lab's step, and the lines of a script."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.system.flight_log import only_log, readings, times_ns, whole
from tests.system.machine import KeptWaiting
from tests.system.patience import PATIENT_POLICY, patient
from tests.system.programs import children, gcs
from tests.system.station import simulated

pytestmark = pytest.mark.system

SCRIPT = "arm\ntakeoff 2\ngoto 3 0 2\ngoto 500 0 2\nland\n"


def test_l19_a_step_of_1_m_over_real_udp_takes_under_3_s_with_setpoints_at_20_hz(
    tmp_path: Path,
) -> None:
    with simulated(tmp_path, policy=patient("lab", tmp_path)) as operator:
        kept = KeptWaiting(operator.client.pid, *children(operator.client.pid))
        operator.fly("arm", "takeoff 1", "goto 1 0 1")
        kept_waiting_s = kept.seconds
        path = operator.log_path
        operator.leave()

    step = [
        (at_ns, decision["phase"], decision["outcome"])
        for at_ns, decision in readings(path, "/gate/decision")
        if decision["word"] == "goto"
    ]
    (accepted_ns, *accepted), (complete_ns, *complete) = step
    assert (accepted, complete) == (["verdict", "accepted"], ["ending", "complete"])
    assert (complete_ns - accepted_ns) / 1e9 < 3.0 + kept_waiting_s

    stream = times_ns(path, "SET_POSITION_TARGET_LOCAL_NED")
    flown = [at_ns for at_ns in stream if accepted_ns <= at_ns <= complete_ns]
    ticks, took_s = len(flown) - 1, (flown[-1] - flown[0]) / 1e9
    assert ticks / took_s < 21.0
    assert ticks > 19.0 * (took_s - kept_waiting_s), "a late tick is never made up for"


def test_a_script_gets_one_verdict_and_one_ending_for_each_line(tmp_path: Path) -> None:
    words = ("--speedup", "2", "--policy", PATIENT_POLICY, "--log-dir", str(tmp_path))
    ended = gcs("fly", "--sim", "--plain", *words, stdin=SCRIPT)

    assert ended.returncode == 0, ended.stderr
    arm, takeoff, near, far, land = SCRIPT.splitlines()
    answers = ended.stdout.splitlines()
    for line in (arm, takeoff, near, land):
        told = [answer.split(": ", 2)[1] for answer in answers if answer.startswith(f"{line}: ")]
        assert told == ["accepted", "complete"], (line, ended.stdout)
    (refusal,) = (answer for answer in answers if answer.startswith(f"{far}: "))
    assert refusal.startswith(f"{far}: refused OUTSIDE_FENCE: ")
    assert re.search(r" (349|350)\.\d m outside inclusion circle 'home'$", refusal)
    assert len(answers) == 9
    assert "Traceback" not in ended.stderr

    path = only_log(tmp_path)
    assert [state.state for state in whole(path).states][-1] == "GROUNDED"
