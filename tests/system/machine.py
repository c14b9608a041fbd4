"""How long the machine kept programs waiting, so that a test does not take it for their doing.

Linux counts how long a thread that could run stood in line for a processor, and how long the
host of a virtual machine took one away.  What a program waits for by itself (a socket, a lock, a
sleep) is in neither, so that a bound to which this time is added still finds it.
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path

_STOLEN = 8
"""The word of /proc/stat's first line: clock ticks that the host took, of all processors."""


class KeptWaiting:
    """Counts from where it is made on: for these processes, and for the thread that made it,
    since a test measures no better than it runs itself."""

    def __init__(self, *pids: int) -> None:
        self._pids = pids
        self._begin_ns = self._counted_ns()

    @property
    def seconds(self) -> float:
        """So far; a process may have ended, as long as nobody has waited for it."""
        return (self._counted_ns() - self._begin_ns) / 1e9

    def _counted_ns(self) -> int:
        if sys.platform != "linux":
            return 0
        threads = [Path("/proc/thread-self")]
        for pid in self._pids:
            threads += Path(f"/proc/{pid}/task").iterdir()
        stolen = int(Path("/proc/stat").read_text().split()[_STOLEN])
        return sum(map(_in_line_ns, threads)) + stolen * 1_000_000_000 // os.sysconf("SC_CLK_TCK")


def _in_line_ns(thread: Path) -> int:
    """0 of one that has ended meanwhile."""
    with suppress(FileNotFoundError, ProcessLookupError):
        return int((thread / "schedstat").read_text().split()[1])
    return 0
