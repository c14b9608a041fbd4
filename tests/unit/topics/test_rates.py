"""Rates against Python's own statistics of the times between messages."""

from __future__ import annotations

import itertools
import statistics

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.topics.rates import Intervals


@given(st.lists(st.integers(1, 10**9), min_size=1, max_size=50))
def test_a_rate_is_the_mean_and_the_spread_of_the_times_between(gaps_ns: list[int]) -> None:
    times = Intervals.over(None)
    for at_ns in itertools.accumulate(gaps_ns, initial=1_767_225_600_000_000_000):
        times.add(at_ns)
    rate = times.rate()
    gaps_s = [gap / 1e9 for gap in gaps_ns]
    assert rate is not None
    assert rate.hz == pytest.approx(1.0 / statistics.fmean(gaps_s))
    assert (rate.min_s, rate.max_s, rate.window) == (min(gaps_s), max(gaps_s), len(gaps_s) + 1)
    assert rate.std_dev_s == pytest.approx(statistics.pstdev(gaps_s), abs=1e-12)


def test_a_window_is_of_the_newest() -> None:
    times = Intervals.over(3)
    for at_ns in (0, 100, 1_000_000_000, 2_000_000_000, 3_000_000_000):
        times.add(at_ns)
    rate = times.rate()
    assert rate is not None
    assert (rate.hz, rate.window, times.total) == (1.0, 3, 5)


def test_one_message_has_no_rate_and_a_burst_none_in_a_list() -> None:
    times = Intervals.over(None)
    times.add(5)
    assert times.rate() is None
    times.add(5_000_000)
    assert times.rate() is not None
    assert times.rate(least_span_s=1.0) is None
