"""Loss, counted from gaps in sequence numbers."""

from __future__ import annotations

import copy

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.protocol.sequence import SequenceTracker


@pytest.mark.parametrize(
    ("seqs", "lost"),
    [
        ([5], 0),
        ([5, 6, 7], 0),
        ([254, 255, 0, 1], 0),
        ([5, 8], 2),
        ([250, 3], 8),
        ([5, 5, 6], 0),
        ([5, 7, 6, 8], 0),
        ([5, 9, 6, 10], 2),
    ],
)
def test_gaps_are_losses_and_latecomers_are_not(seqs: list[int], lost: int) -> None:
    tracker = SequenceTracker()
    for seq in seqs:
        tracker.seen(1, 1, seq)
    assert tracker.lost == lost
    assert tracker.received == len(seqs)


def test_senders_do_not_disturb_each_other() -> None:
    tracker = SequenceTracker()
    assert tracker.seen(1, 1, 10) == 0
    assert tracker.seen(1, 100, 200) == 0
    assert tracker.seen(2, 1, 0) == 0
    assert tracker.seen(1, 1, 12) == 1
    assert tracker.seen(1, 100, 201) == 0
    assert tracker.senders[1, 1].lost == 1
    assert tracker.lost == 1


def test_frames_are_numbered_without_a_wrap_and_late_ones_are_lower() -> None:
    tracker = SequenceTracker()
    for seq in (254, 255, 0, 1):
        newest = tracker.number(1, 1, seq)
        tracker.seen(1, 1, seq)
    assert newest == 257
    assert tracker.number(1, 1, 255) == 255
    assert tracker.number(1, 1, 1) == 257
    assert tracker.number(1, 1, 3) == 259
    assert tracker.number(2, 1, 9) == 9


def test_a_sender_that_was_away_may_begin_anew() -> None:
    tracker = SequenceTracker()
    tracker.seen(1, 1, 200)
    tracker.restart(1, 1)
    assert tracker.number(1, 1, 0) == 201
    assert tracker.seen(1, 1, 0) == 0
    assert tracker.number(1, 1, 1) == 202
    assert tracker.lost == 0


@given(st.lists(st.integers(0, 255), max_size=6), st.integers(0, 255), st.integers(1, 300))
def test_frames_in_a_row_are_counted_as_one_after_the_other(
    before: list[int], first: int, many: int
) -> None:
    one, all_at_once = SequenceTracker(), SequenceTracker()
    for seq in before:
        one.seen(1, 1, seq)
        all_at_once.seen(1, 1, seq)
    untouched = copy.deepcopy(all_at_once.senders)
    seqs = bytes((first + n) & 0xFF for n in range(many))
    in_turn = [one.in_turn((1, 1), seq) for seq in seqs]
    if all_at_once.all_in_turn((1, 1), seqs):
        assert None not in in_turn
        assert all_at_once.senders == one.senders
    else:
        assert in_turn[0] is None
        assert all_at_once.senders == untouched


def test_a_gap_within_frames_in_a_row_counts_none_of_them() -> None:
    tracker = SequenceTracker()
    tracker.seen(1, 1, 10)
    assert not tracker.all_in_turn((1, 1), bytes((11, 12, 14)))
    assert tracker.received == 1
    assert tracker.all_in_turn((1, 1), bytes((11, 12)))
    tracker.restart(1, 1)
    assert not tracker.all_in_turn((1, 1), bytes((13, 14)))
    assert tracker.received == 3
