"""When frames of a record are due."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.replay.player import LATE_NS, LOOP_PAUSE_NS, Key, Player, keys_of

MS = 1_000_000
SECOND = 1_000_000_000
LOG_NS = 1_767_225_600_000_000_000
NOW_NS = 77 * SECOND


def every(step_ns: int, count: int) -> list[int]:
    return [LOG_NS + number * step_ns for number in range(count)]


def played(player: Player, until_ns: int) -> list[tuple[int, int]]:
    """(frame, when) of a shell that is always in time."""
    sent = []
    now_ns = NOW_NS
    while now_ns <= until_ns:
        due = player.advance(now_ns)
        sent += [(number, now_ns - NOW_NS) for number in range(due.first, due.end)]
        deadline_ns = player.deadline_ns()
        if deadline_ns is None:
            break
        now_ns = deadline_ns
    return sent


@pytest.mark.parametrize("speed", [0.1, 1.0, 3.0, 10.0])
def test_each_frame_is_due_by_its_own_time_and_not_by_the_one_before(speed: float) -> None:
    sent = played(Player(every(20 * MS, 1000), NOW_NS, speed=speed), NOW_NS + 10**12)
    assert [number for number, _ in sent] == [*range(1000)]
    for number, at_ns in sent:
        assert abs(at_ns - number * 20 * MS / speed) <= 1, "rounding does not add up"


def test_a_late_shell_keeps_the_grid() -> None:
    player = Player(every(20 * MS, 100), NOW_NS)
    assert (player.advance(NOW_NS + 90 * MS).end, player.deadline_ns()) == (5, NOW_NS + 100 * MS)


def test_a_shell_that_slept_sends_no_burst() -> None:
    player = Player(every(20 * MS, 1000), NOW_NS)
    player.advance(NOW_NS)
    due = player.advance(NOW_NS + LATE_NS + SECOND)
    assert (due.first, due.end, player.slipped) == (1, 2, 1)


def test_a_pause_stops_it_and_the_schedule_goes_on_from_there() -> None:
    player = Player(every(20 * MS, 100), NOW_NS)
    player.advance(NOW_NS + 50 * MS)
    player.press(Key.PAUSE, NOW_NS + 50 * MS)
    assert player.deadline_ns() is None
    assert player.advance(NOW_NS + 9 * SECOND).end == 3
    assert player.position_s(NOW_NS + 9 * SECOND) == pytest.approx(0.05)
    player.press(Key.PAUSE, NOW_NS + 9 * SECOND)
    assert player.deadline_ns() == NOW_NS + 9 * SECOND + 10 * MS


def test_seeking_takes_both_ends_for_what_they_are() -> None:
    player = Player(every(SECOND, 21), NOW_NS)
    player.press(Key.ON, NOW_NS)
    assert player.advance(NOW_NS).first == 5
    player.press(Key.FAR_BACK, NOW_NS)
    assert player.advance(NOW_NS).first == 0
    player.press(Key.FAR_ON, NOW_NS)
    due = player.advance(NOW_NS)
    assert (due.first, due.end, player.ended) == (20, 21, True)
    player.press(Key.BEGIN, NOW_NS)
    assert (player.ended, player.advance(NOW_NS).first) == (False, 0)


def test_a_change_of_speed_takes_effect_from_where_it_is() -> None:
    player = Player(every(SECOND, 100), NOW_NS)
    player.advance(NOW_NS + SECOND)
    player.press(Key.FASTER, NOW_NS + SECOND)
    assert (player.speed, player.deadline_ns()) == (2.0, NOW_NS + SECOND + SECOND // 2)
    player.press(Key.SLOWER, NOW_NS + SECOND)
    player.press(Key.SLOWER, NOW_NS + SECOND)
    assert (player.speed, player.deadline_ns()) == (0.5, NOW_NS + 3 * SECOND)


def test_a_loop_begins_again() -> None:
    player = Player(every(20 * MS, 3), NOW_NS, loop=True)
    sent = played(player, NOW_NS + 40 * MS + LOOP_PAUSE_NS + 40 * MS)
    assert [number for number, _ in sent] == [0, 1, 2, 0, 1, 2]
    assert sent[3][1] == 40 * MS + LOOP_PAUSE_NS
    assert not player.ended


@given(
    st.lists(st.integers(0, 2 * SECOND), min_size=1, max_size=30),
    st.lists(st.tuples(st.sampled_from([*Key]), st.integers(0, SECOND)), max_size=20),
)
def test_whatever_is_pressed_frames_go_in_order_between_seeks_and_it_ends(
    gaps_ns: list[int], presses: list[tuple[Key, int]]
) -> None:
    times_ns = [LOG_NS]
    for gap_ns in gaps_ns:
        times_ns.append(times_ns[-1] + gap_ns)
    player, now_ns = Player(times_ns, NOW_NS), NOW_NS
    for key, wait_ns in presses:
        now_ns += wait_ns
        due = player.advance(now_ns)
        assert 0 <= due.first <= due.end <= len(times_ns)
        player.press(key, now_ns)
        assert 0.0 <= player.position_s(now_ns) <= player.length_s
    if player.paused:
        player.press(Key.PAUSE, now_ns)
    for _ in range(len(times_ns) + 1):
        deadline_ns = player.deadline_ns()
        if deadline_ns is None:
            break
        now_ns = max(now_ns, deadline_ns)
        player.advance(now_ns)
    assert player.ended


def test_the_bytes_of_keys() -> None:
    assert [*keys_of(b" \x1b[C\x1bOD+x-")] == [
        Key.PAUSE,
        Key.ON,
        Key.BACK,
        Key.FASTER,
        Key.SLOWER,
    ]
    assert [*keys_of(b"q")] == [None]
