"""The one clock: wall time fixed once at start, then monotonic, so that it never jumps."""

from __future__ import annotations

import time


class Clock:
    """Nanoseconds since the Unix epoch, advancing `speedup` times as fast as the monotonic clock.

    A session's time-outs, its 20 Hz grid and the record's `log_time` all live on it; an NTP step
    or a suspended laptop cannot make it go back.  `perf_counter_ns` is the monotonic clock on
    Linux and macOS; on Windows, before Python 3.13, `monotonic_ns` moves in steps of 16 ms.
    """

    __slots__ = ("_mono_start_ns", "_speedup", "start_ns")

    def __init__(self, speedup: float = 1.0) -> None:
        self._speedup = speedup
        self.start_ns = time.time_ns()
        self._mono_start_ns = time.perf_counter_ns()

    def now_ns(self) -> int:
        elapsed_ns = time.perf_counter_ns() - self._mono_start_ns
        if self._speedup != 1.0:
            elapsed_ns = int(elapsed_ns * self._speedup)
        return self.start_ns + elapsed_ns

    def seconds_until(self, deadline_ns: int) -> float:
        """Real seconds until `deadline_ns`, never negative: what `select` should wait."""
        return max(0.0, (deadline_ns - self.now_ns()) / 1e9 / self._speedup)

    def stamp(self) -> str:
        """Local wall time of the start as YYYYMMDD-HHMMSS, for the log file's name."""
        return time.strftime("%Y%m%d-%H%M%S", time.localtime(self.start_ns // 1_000_000_000))
