"""Slow and hostile viewers of a live view cost the flight nothing."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from gcs.live.program import Wanted, opened_by
from gcs.shell import stations
from tests.system.hostile_clients import intervals_ms, resident_kb, setpoints_between
from tests.system.hostile_viewers import MODULE
from tests.system.machine import KeptWaiting
from tests.system.programs import LONGEST_S, alive, children
from tests.system.second_program import HoldWatch
from tests.system.slow_viewer import slow_viewer
from tests.system.station import tapped
from tests.system.test_hostile_clients import GROWS_KB, SOON_TICKS, assert_undisturbed
from tests.system.viewer import viewer
from tests.system.wire_tap import WireTap

pytestmark = [
    pytest.mark.system,
    pytest.mark.skipif(sys.platform != "linux", reason="/proc"),
]

VIEWERS = 80
SLOW_S = 4.0
TICKS_HZ = 20.0


@pytest.mark.thorough
def test_they_delay_no_setpoint_and_no_abort_and_cost_the_station_no_memory(
    tmp_path: Path, tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path_factory.mktemp("run")))
    watch = HoldWatch()
    with tapped(tmp_path, tap=WireTap(watch.hear)) as (operator, tap):
        operator.fly("arm", "takeoff 3")
        (described,) = stations.running(stations.folder_of())
        before = set(children(os.getpid()))
        live = opened_by(Wanted(described.pid, "127.0.0.1", 0))
        assert live is not None
        port = int(live.url.rpartition(":")[2])
        started = set(children(os.getpid())) - before
        (live_view,) = filter(alive, started)  # `ps`, which told of them, is not any more
        before_kb = resident_kb(described.pid)

        kept, begin_ns = KeptWaiting(described.pid), time.monotonic_ns()
        with slow_viewer(port):
            operator.dialogue.wait_until(lambda: False, SLOW_S)
        assert_undisturbed(intervals_ms(tap, begin_ns, time.monotonic_ns()), kept)

        kept, begin_ns = KeptWaiting(described.pid), time.monotonic_ns()
        words = [sys.executable, "-m", MODULE, str(port)]
        crowd = subprocess.Popen([*words, str(VIEWERS), "1"], stdout=subprocess.PIPE)
        operator.until(lambda: crowd.poll() is not None, "the end of the crowd", LONGEST_S)
        assert_undisturbed(intervals_ms(tap, begin_ns, time.monotonic_ns()), kept)
        told, _ = crowd.communicate()
        assert crowd.returncode == 0
        assert sum(json.loads(told).values()) == VIEWERS
        assert resident_kb(described.pid) - before_kb < GROWS_KB

        crowd = subprocess.Popen([*words, "100000", "2"], stdout=subprocess.DEVNULL)
        try:
            with viewer(live.url) as looker:
                held = len(watch.passed_ns)
                kept, asked_ns = KeptWaiting(live_view), time.monotonic_ns()
                assert looker.call("abort")["accepted"]
                operator.until(lambda: len(watch.passed_ns) > held, "a hold on the wire")
                ticks = setpoints_between(tap, asked_ns, watch.passed_ns[held])
                assert ticks <= SOON_TICKS + kept.seconds * TICKS_HZ
        finally:
            crowd.terminate()
            crowd.wait()
        operator.until(lambda: operator.said("Current State: HOLDING"), "HOLDING")
        operator.fly("resume", "goto 1 0 3")
        assert operator.leave().exit_code == 0
