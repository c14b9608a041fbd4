"""An abort into a running console: on the wire at once, whatever the console waits for."""

from __future__ import annotations

import time
from pathlib import Path

import pytest

from tests.system.flight_log import only_log, readings, whole
from tests.system.machine import KeptWaiting
from tests.system.patience import PATIENT_POLICY
from tests.system.programs import GCS, children, running
from tests.system.second_program import Stopwatch
from tests.system.vehicle_program import free_port, vehicle_sim
from tests.system.wire_tap import WireTap

pytestmark = pytest.mark.system

PATIENT = ("--policy", PATIENT_POLICY)
WITHIN_MS = 100.0
"""And what the machine kept console and station waiting."""


@pytest.mark.parametrize("typed", [("# never mind", "", "abort"), ("photo", "!hold")])
def test_a_stop_in_a_pipe_is_on_the_wire_while_a_goto_is_under_way(
    typed: tuple[str, ...], tmp_path: Path
) -> None:
    watch, port = Stopwatch(), free_port()
    with WireTap(watch.hear) as tap:
        tap.connect(port)
        link = ("--link", f"udpin://127.0.0.1:{port}", "--log-dir", str(tmp_path), *PATIENT)
        with (
            vehicle_sim("--link", f"udpout://127.0.0.1:{tap.vehicle_port}"),
            running(GCS, "fly", "--plain", *link) as program,
        ):
            program.type("arm", "takeoff 3", "goto 60 0 3", "goto 0 0 3")
            program.until_out("goto 60 0 3: accepted")
            time.sleep(0.5)
            kept = KeptWaiting(program.pid, *children(program.pid))
            took_ms = watch.latency_ms(lambda: program.type(*typed))
            kept_ms = kept.seconds * 1e3
            stop = next(line.strip("!") for line in typed if "abort" in line or "hold" in line)
            program.until_out(f"{stop}: complete")
            program.until_out("goto 60 0 3: aborted OPERATOR")
            assert program.process.stdin is not None
            program.process.stdin.close()
            assert program.ended() == 0
    assert took_ms < WITHIN_MS + kept_ms
    assert "goto 0 0 3: dropped by " + stop + ", which did not wait for it" in [
        line.strip() for line in program.out
    ]
    path = only_log(tmp_path)
    asked = [d["word"] for _, d in readings(path, "/gate/decision")]
    assert asked.count("goto") == 2  # its verdict and its outcome
    assert "HOLDING" in [change.state for change in whole(path).states]
