"""The one clock: how long it does nothing, where a turn waits for more datagrams."""

from __future__ import annotations

import time

import pytest

from gcs.shell.clock import Clock

MS = 1_000_000


@pytest.mark.parametrize(
    ("speedup", "ahead_ms", "slept_s"),
    [(1.0, 2.0, [0.002]), (10.0, 2.0, [0.0002]), (1.0, -1.0, [])],
)
def test_a_pause_is_on_the_clock_s_own_time_and_never_backwards(
    monkeypatch: pytest.MonkeyPatch, speedup: float, ahead_ms: float, slept_s: list[float]
) -> None:
    slept: list[float] = []
    monkeypatch.setattr(time, "sleep", slept.append)
    monkeypatch.setattr(time, "perf_counter_ns", lambda: 7)
    clock = Clock(speedup)
    clock.pause_until(clock.now_ns() + round(ahead_ms * MS))
    assert slept == slept_s
