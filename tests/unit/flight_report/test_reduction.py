"""Series, lanes and tracks keep what matters and stay small."""

from __future__ import annotations

import itertools
import math
import random

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from gcs.flight_report.lanes import MAX_CHANGES, Lane, Span
from gcs.flight_report.series import MAX_ROWS, Series
from gcs.flight_report.track import KEPT_POINTS, Track, TrackPoint, simplified


def series_of(values: list[float | None], step_s: float = 0.1) -> Series:
    series = Series(("value",))
    for number, value in enumerate(values):
        series.add(number * step_s, (value,))
    return series


class TestSeries:
    def test_a_short_one_is_kept_as_it_is(self) -> None:
        assert series_of([1.0, 2.0, 3.0]).rows() == [
            (0.0, [1.0]),
            (0.1, [2.0]),
            (0.2, [3.0]),
        ]

    def test_a_long_one_keeps_its_extremes(self) -> None:
        values: list[float | None] = [math.sin(i / 50) for i in range(100_000)]
        values[54_321], values[54_322] = 9.0, -9.0
        rows = series_of(values).rows()
        drawn = [row[0] for _, row in rows if row[0] is not None]
        assert len(rows) <= MAX_ROWS
        assert (max(drawn), min(drawn)) == (9.0, -9.0)

    def test_a_peak_is_near_its_time(self) -> None:
        values: list[float | None] = [0.0] * 50_000
        values[20_000] = 1.0
        (peak_s,) = [t_s for t_s, row in series_of(values).rows() if row == [1.0]]
        assert peak_s == pytest.approx(2_000.0, abs=5_000.0 / 500)

    @given(st.integers(1, 6_000), st.integers(0, 2**32))
    @example(MAX_ROWS + 1, 0)
    def test_rows_are_few_and_their_times_rise(self, count: int, seed: int) -> None:
        chance = random.Random(seed)
        values = [None if chance.random() < 0.2 else chance.random() for _ in range(count)]
        rows = series_of(values).rows()
        times = [t_s for t_s, _ in rows]
        assert len(rows) <= MAX_ROWS
        assert times == sorted(times)
        known = [value for value in values if value is not None]
        drawn = [row[0] for _, row in rows if row[0] is not None]
        assert (max(drawn, default=0.0), min(drawn, default=0.0)) == (
            max(known, default=0.0),
            min(known, default=0.0),
        )

    def test_a_silence_interrupts_the_line(self) -> None:
        series = Series(("value",))
        for t_s in (0.0, 0.1, 0.2, 60.0, 60.1):
            series.add(t_s, (1.0,))
        assert [row for t_s, row in series.rows() if 0.2 < t_s < 60.0] == [[None]]

    def test_nan_and_infinity_are_unknown(self) -> None:
        assert series_of([math.nan, math.inf, None]).empty
        assert not series_of([math.nan, 1.0]).empty

    def test_columns_are_reduced_each_by_itself(self) -> None:
        series = Series(("a", "b"))
        for i in range(10_000):
            series.add(float(i), (float(i), float(-i)))
        rows = series.rows()
        assert rows[-1][1] == [9_999.0, -9_999.0]
        assert rows[0][1] == [0.0, 0.0]


class TestLane:
    def test_spans_follow_each_other(self) -> None:
        lane = Lane("Gate")
        for t_s, state in ((1.0, "A"), (2.0, "A"), (3.0, "B")):
            lane.add(t_s, state)
        assert lane.spans(5.0) == [Span(1.0, 3.0, "A"), Span(3.0, 5.0, "B")]

    def test_a_sliver_is_drawn_as_the_state_before_it(self) -> None:
        lane = Lane("Gate")
        for t_s, state in (
            (0.0, "MOVING"),
            (4.0, "HOVERING"),
            (4.05, "VERIFYING"),
            (4.1, "MOVING"),
        ):
            lane.add(t_s, state)
        assert lane.debounced(9.0, 0.4) == [Span(0.0, 9.0, "MOVING")]

    def test_one_that_never_rests_is_cut_off(self) -> None:
        lane = Lane("Gate")
        for number in range(2 * MAX_CHANGES):
            lane.add(float(number), str(number))
        assert lane.cut_off
        assert len(lane.changes) == MAX_CHANGES


class TestTrack:
    def test_a_straight_line_is_two_points(self) -> None:
        line = [TrackPoint(float(i), (float(i), 0.0, 5.0)) for i in range(1_000)]
        kept = simplified(line, 2)
        assert kept == [line[0], line[-1]]

    def test_corners_outlive_straight_stretches(self) -> None:
        square = [
            TrackPoint(float(i), (x, y, 5.0))
            for i, (x, y) in enumerate(
                [(float(k), 0.0) for k in range(100)] + [(100.0, float(k)) for k in range(100)]
            )
        ]
        assert (100.0, 0.0, 5.0) in [point.enu for point in simplified(square, 3)]

    def test_an_hour_keeps_its_shape(self) -> None:
        track = Track()
        for i in range(18_000):
            angle = i / 300
            track.add(i / 5, (50 * math.cos(angle), 50 * math.sin(angle), 10.0), flying=True)
        (piece,) = track.drawn()
        assert len(piece) <= KEPT_POINTS
        assert all(abs(math.hypot(*point.enu[:2]) - 50.0) < 1e-6 for point in piece)
        # No chord between two kept points cuts the circle by more than half a metre.
        for one, two in itertools.pairwise(piece):
            middle = [(a + b) / 2 for a, b in zip(one.enu, two.enu, strict=True)]
            assert math.hypot(*middle[:2]) > 49.5
        assert track.length_m == pytest.approx(50 * 17_999 / 300, rel=1e-3)

    def test_nothing_is_drawn_through_a_gap(self) -> None:
        track = Track()
        for t_s in (0.0, 0.2, 30.0, 30.2):
            track.add(t_s, (t_s, 0.0, 5.0), flying=True)
        assert [len(piece) for piece in track.drawn()] == [2, 2]
        assert track.length_m == pytest.approx(0.4)

    def test_an_estimate_that_wanders_on_the_ground_is_no_flight(self) -> None:
        track = Track()
        for i in range(100):
            track.add(i / 5, (i % 2 * 1.0, 0.0, 0.0), flying=False)
        assert track.length_m == 0.0
