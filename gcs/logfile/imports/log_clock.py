"""Where the messages of an autopilot's own log have their places in time."""

from __future__ import annotations

import numpy as np

from gcs.mcap_file.batch_writer import Times

HOLD_NS = 2_000_000_000
"""A message may be so much older than one before it.  Loggers write a message up to a second after
its time."""
JUMP_NS = 60_000_000_000
"""A time that is further ahead is damaged, unless the times after it are there, too."""
_AGREED = 5


class LogClock:
    """Goes over the messages of a log in the order of the file.

    What a message has for its place depends on those before it alone, so on no window.
    """

    def __init__(self, first_ns: int) -> None:
        self.latest_ns = first_ns
        """Of the times that can be believed."""
        self.late = 0
        """Messages that do not have their own times for their places."""
        self._ahead = 0
        """So many in a row were too far ahead."""

    def log_times(self, told_ns: Times) -> Times:
        """A message's own time; of one that is later than `HOLD_NS`, the earliest that is left; of
        one whose time cannot be believed, the latest before it."""
        latest_ns = np.maximum.accumulate(np.concatenate(([self.latest_ns], told_ns)))
        if (np.diff(latest_ns) > JUMP_NS).any():
            latest_ns, placed_ns = self._one_by_one(told_ns)
        else:
            latest_ns, placed_ns = latest_ns[1:], told_ns
            self._ahead = 0
        placed_ns = np.maximum(placed_ns, latest_ns - HOLD_NS)
        if len(latest_ns):
            self.latest_ns = int(latest_ns[-1])
        self.late += int((placed_ns != told_ns).sum())
        return placed_ns

    def _one_by_one(self, told_ns: Times) -> tuple[Times, Times]:
        """The latest of each message and those before it, and what each has for its place."""
        latest_ns = self.latest_ns
        latest, placed = [], []
        for time_ns in told_ns.tolist():
            self._ahead = self._ahead + 1 if time_ns - latest_ns > JUMP_NS else 0
            if self._ahead in (0, _AGREED):
                latest_ns = max(latest_ns, time_ns)
                self._ahead = 0
                placed.append(time_ns)
            else:
                placed.append(latest_ns)
            latest.append(latest_ns)
        return np.array(latest, np.int64), np.array(placed, np.int64)
