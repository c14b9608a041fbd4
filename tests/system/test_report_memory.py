"""A record much larger than the memory that its report takes."""

from __future__ import annotations

import random
import subprocess
import sys
from pathlib import Path

import pytest

from gcs.report import GarbageItem, RecordItem
from tests.unit.flight_report.test_scan import a_flight_that_loses_gps
from tests.unit.record.flights import MS, record

pytestmark = pytest.mark.system

FILE_MB = 160
MOST_MB = 110
"""The program itself takes 40, and 16 of the file are kept."""

SCAN = """
import re, sys
from pathlib import Path
from gcs.flight_report.scan import scan
from gcs.flight_report.render import page
# The peak counts from here (proc(5), clear_refs): compiling modules without a cache takes more.
Path("/proc/self/clear_refs").write_text("5")
flight = scan(Path(sys.argv[1]))
page(flight)
# Not ru_maxrss: that counts what the process had before its exec, which was the test's.
peak = re.search(r"VmHWM:\\s+(\\d+) kB", Path("/proc/self/status").read_text())
print(flight.messages, peak[1])
"""


@pytest.mark.skipif(sys.platform != "linux", reason="/proc is of Linux")
@pytest.mark.thorough
def test_the_file_is_not_held_in_memory(tmp_path: Path) -> None:
    noise = random.Random(1).randbytes(1_000_000)
    items: list[RecordItem] = [GarbageItem(0, noise, "garbage")] * FILE_MB
    path = record(tmp_path, [*a_flight_that_loses_gps(), *items], 125 * MS)
    assert path.stat().st_size > FILE_MB * 1_000_000
    ended = subprocess.run(
        [sys.executable, "-c", SCAN, str(path)], capture_output=True, text=True, check=True
    )
    messages, kilobytes = (int(word) for word in ended.stdout.split())
    assert messages > FILE_MB
    assert kilobytes < MOST_MB * 1000
