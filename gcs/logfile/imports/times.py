"""Log times from the time stamps of a file that may be damaged."""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray

from gcs.logfile.batch_writer import Times, strictly_increasing
from gcs.logfile.frames import Mask

JUMP_US = 3_600_000_000
"""A time stamp that is further from those around it is damaged."""
LAST_US = 2**63 // 1000
"""Nanoseconds since 1970 in 63 bits end here."""

_AROUND = 5


def log_times(time_us: NDArray[np.uint64], known: Mask, last_ns: int) -> Times:
    """Nanoseconds, strictly increasing and later than `last_ns`.

    What is not `known` gets the time of the one before it.  A time stamp that is `JUMP_US` away
    from the median of five around it is not believed; a clock that was set is.
    """
    at_us = np.minimum(time_us, np.uint64(LAST_US)).astype(np.int64)
    known = known & (time_us < LAST_US)
    if known.any():
        known[known] = _believed(at_us[known])
    source = np.maximum.accumulate(np.where(known, np.arange(len(at_us)), -1))
    filled_ns = np.where(source >= 0, at_us[source] * 1000, last_ns)
    return strictly_increasing(filled_ns, last_ns)


def _believed(at_us: NDArray[np.int64]) -> Mask:
    steps = np.diff(at_us)
    if not len(steps) or (abs(steps) < JUMP_US).all():
        return np.ones(len(at_us), np.bool_)
    around = sliding_window_view(np.pad(at_us, _AROUND // 2, mode="reflect"), _AROUND)
    believed: Mask = abs(at_us - np.median(around, axis=1)) < JUMP_US
    return believed
