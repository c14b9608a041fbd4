"""What the machine keeps a program waiting is counted, and nothing else is."""

from __future__ import annotations

import os
import subprocess
import sys
import time

import pytest

from tests.system.machine import KeptWaiting
from tests.system.patience import until

pytestmark = [
    pytest.mark.system,
    pytest.mark.skipif(sys.platform != "linux", reason="/proc"),
]


def test_who_shares_a_processor_is_kept_waiting_and_who_sleeps_is_not() -> None:
    programs = ("while True: pass", "while True: pass", "import time; time.sleep(600)")
    started = [subprocess.Popen([sys.executable, "-c", program]) for program in programs]
    try:
        processor = min(os.sched_getaffinity(0))
        for each in started[:2]:
            os.sched_setaffinity(each.pid, {processor})
        one, other, asleep = (each.pid for each in started)
        kept = KeptWaiting(one, other)
        until(lambda: kept.seconds > 1.0, "a second in line")
        calm, self_alone = KeptWaiting(asleep), KeptWaiting()
        time.sleep(0.5)
        assert calm.seconds - self_alone.seconds < 0.1
    finally:
        for each in started:
            each.kill()
            each.wait()
