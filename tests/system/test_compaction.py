"""The record of a station is compacted by a process of its own, once the station has ended."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.shares import one_in
from tests.system.flight_log import whole
from tests.system.patience import PATIENT_S
from tests.system.programs import gcs
from tests.unit.record.flights import MS, a_flight, messages_of, record

ON_THE_GROUND = "wait 180\nquit\n"


def within(seconds: float, true: Callable[[], bool]) -> bool:
    limit_s = time.monotonic() + seconds
    while not true():
        if time.monotonic() > limit_s:
            return False
        time.sleep(0.005)
    return True


@pytest.mark.skipif(os.name != "posix", reason="signals")
@pytest.mark.thorough
def test_a_process_that_is_told_to_end_leaves_a_whole_file_and_no_other(tmp_path: Path) -> None:
    flight = record(tmp_path / "logs", a_flight() * 3000, step_ns=5 * MS // 2)
    messages = messages_of(flight)
    copy = flight.with_name(f".{flight.name}.compacting")
    with subprocess.Popen([sys.executable, "-m", "gcs.record.compact", str(flight)]) as process:
        assert within(PATIENT_S, copy.exists)
        process.send_signal(signal.SIGTERM)
        process.wait(PATIENT_S)
    assert list(flight.parent.iterdir()) == [flight]
    assert messages_of(flight) == messages
    assert whole(flight).damaged == 0


@pytest.mark.parametrize("option", one_in(2, ["--compact", "--no-compact"]))
def test_a_station_ends_at_once_and_its_record_is_compacted_unless_told_not_to(
    tmp_path: Path, option: str
) -> None:
    arguments = ("fly", "--plain", "--sim", "--speedup", "20", "--log-dir", str(tmp_path), option)
    ended = gcs(*arguments, stdin=ON_THE_GROUND)
    assert ended.returncode == 0, ended.stderr
    (path,) = tmp_path.glob("*.mcap")
    written = path.stat().st_size
    assert written > 1_000_000
    if option == "--compact":
        assert within(PATIENT_S, lambda: path.stat().st_size < written)
        assert list(tmp_path.iterdir()) == [path]
    else:
        time.sleep(1.0)
        assert path.stat().st_size == written
    assert whole(path).damaged == 0
