"""How late a viewer of a live view is, alone and beside 300 hostile ones; about a minute.

A message's lateness is from its log time in the station to its arrival in this process.  A hostile
crowd (`tests/system/hostile_viewers.py`) comes in the second half; it is told whether the station's
setpoints were late meanwhile.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from gcs.live.program import Wanted, opened_by
from gcs.shell import stations
from tests.system.hostile_clients import intervals_ms, resident_kb
from tests.system.hostile_viewers import MODULE
from tests.system.station import tapped
from tests.system.viewer import Viewer, viewer

SECONDS = 20.0
CROWD = 300
TOPICS = (
    *("/mavlink/1/1/LOCAL_POSITION_NED", "/mavlink/1/1/ATTITUDE", "/vehicle/1/state"),
    *("/vehicle/1/fsa", "/vehicle/1/setpoint"),
)


def lateness_ms(looker: Viewer, crowd: subprocess.Popen[bytes] | None) -> list[float]:
    """For so long, or until the crowd has gone."""
    end_s = time.monotonic() + SECONDS
    found: list[float] = []

    def done() -> bool:
        now_ns = time.time_ns()
        found.extend((now_ns - heard.log_time_ns) / 1e6 for heard in looker.messages)
        looker.messages.clear()
        return time.monotonic() >= end_s if crowd is None else crowd.poll() is not None

    looker.until(done, "the end", 600.0)
    return sorted(found)


def told(what: str, values: list[float]) -> None:
    shares = ", ".join(f"p{p} {values[len(values) * p // 100]:.1f}" for p in (50, 95, 99))
    print(f"{what}: {shares}, most {values[-1]:.1f} ms ({len(values)})", flush=True)


def main() -> None:
    with (
        tempfile.TemporaryDirectory() as folder,
        tapped(Path(folder)) as (operator, tap),
    ):
        operator.fly("arm", "takeoff 3")
        live = opened_by(Wanted(operator.client.pid, "127.0.0.1", 0))
        assert live is not None
        (described,) = [
            each
            for each in stations.running(*stations.folders_of())
            if each.pid == operator.client.pid
        ]
        with viewer(live.url) as looker:
            looker.subscribe(*TOPICS)
            looker.until(lambda: bool(looker.messages), "a message")
            looker.messages.clear()
            begin_ns = time.monotonic_ns()
            told("a viewer alone", lateness_ms(looker, None))
            told("setpoints", sorted(intervals_ms(tap, begin_ns, time.monotonic_ns())))
            before_kb, begin_ns = resident_kb(described.pid), time.monotonic_ns()
            port = live.url.rpartition(":")[2]
            words = [sys.executable, "-m", MODULE, port, str(CROWD), "1"]
            crowd = subprocess.Popen(words, stdout=subprocess.PIPE)
            told(f"beside {CROWD} hostile ones", lateness_ms(looker, crowd))
            told("setpoints", sorted(intervals_ms(tap, begin_ns, time.monotonic_ns())))
            said, _ = crowd.communicate()
            print(f"they were {json.loads(said)}")
            print(f"the station has grown by {resident_kb(described.pid) - before_kb} kB")
        operator.leave()


if __name__ == "__main__":
    main()
