"""The grid of ticks: what is due at each of them, and none of them twice."""

from __future__ import annotations

from itertools import pairwise

import pytest

from gcs.gate.condition import Condition
from gcs.gate.inputs import ConditionChanged, Tick
from gcs.session.speedup_waits import Times
from gcs.session.work import GateInput, Log, SecondDue, SnapshotDue, Work
from gcs.station.ticks import Ticks
from tests.unit.station.vehicles import SECOND_NS

START_NS = 7 * SECOND_NS + 123
MS_NS = 1_000_000
TICK_NS = 50 * MS_NS


def gate_ticks(work: list[Work]) -> list[int]:
    """How late each tick is that the gate hears of."""
    given = [item.given for item in work if isinstance(item, GateInput)]
    return [tick.lateness_ns for tick in given if isinstance(tick, Tick)]


def late(works: list[list[Work]], *, before: bool = False) -> list[bool]:
    """Whether lateness is a condition after each tick: as was told last."""
    stands = []
    for work in works:
        given = [item.given for item in work if isinstance(item, GateInput)]
        told = [change for change in given if isinstance(change, ConditionChanged)]
        assert all(each.condition is Condition.TICK_LATE for each in told)
        before = told[-1].active if told else before
        stands.append(before)
    return stands


def on_time(ticks: Ticks, count: int) -> list[list[Work]]:
    return [ticks.wake(ticks.next_ns) for _ in range(count)]


def test_the_first_tick_is_one_period_after_the_start() -> None:
    ticks = Ticks(START_NS, Times(1.0))
    assert ticks.next_ns == START_NS + TICK_NS
    assert ticks.wake(START_NS + TICK_NS - 1) == []
    assert gate_ticks(ticks.wake(START_NS + TICK_NS)) == [0]


def test_every_tick_is_the_gate_s_every_second_one_shows_and_every_twentieth_is_a_second() -> None:
    works = on_time(Ticks(START_NS, Times(1.0)), 60)
    assert all(gate_ticks(work) == [0] for work in works)
    assert sum(SnapshotDue() in work for work in works) == 30
    seconds = [number for number, work in enumerate(works) if SecondDue() in work]
    assert [b - a for a, b in pairwise(seconds)] == [20, 20]


def test_the_gate_is_asked_before_what_is_shown_of_it() -> None:
    (work,) = on_time(Ticks(START_NS, Times(1.0)), 1)
    assert isinstance(work[0], GateInput)
    assert work[-2:] == [SecondDue(), SnapshotDue()]


@pytest.mark.parametrize("late_ms", [1, 49, 50, 51, 1_000, 3_600_000])
def test_however_late_it_is_it_is_one_tick_and_the_grid_stays(late_ms: int) -> None:
    ticks = Ticks(START_NS, Times(1.0))
    now_ns = ticks.next_ns + late_ms * MS_NS
    assert gate_ticks(ticks.wake(now_ns)) == [late_ms * MS_NS]
    assert ticks.wake(now_ns) == []
    assert now_ns < ticks.next_ns <= now_ns + TICK_NS
    assert (ticks.next_ns - START_NS) % TICK_NS == 0


@pytest.mark.parametrize(("late_ms", "told"), [(0, False), (5, False), (30, True), (130, True)])
def test_what_is_later_than_a_good_kernel_makes_it_is_logged(late_ms: int, told: bool) -> None:
    ticks = Ticks(START_NS, Times(1.0))
    work = ticks.wake(ticks.next_ns + late_ms * MS_NS)
    lines = [item.text for item in work if isinstance(item, Log)]
    assert lines == ([f"a tick came {late_ms} ms late"] if told else [])


def test_a_gap_in_the_stream_is_a_condition_for_ten_seconds_after_the_last_one() -> None:
    ticks = Ticks(START_NS, Times(1.0))
    assert late([ticks.wake(ticks.next_ns + 300 * MS_NS)]) == [True]
    on_time(ticks, 100)
    assert late([ticks.wake(ticks.next_ns + 300 * MS_NS)]) == [True]
    stands = late(on_time(ticks, 210), before=True)
    assert stands == [True] * 199 + [False] * 11  # at 10 s it is over


def test_that_ticks_are_on_time_is_told_once_a_second() -> None:
    works = on_time(Ticks(START_NS, Times(1.0)), 40)
    told = [number for number, work in enumerate(works) if late([work], before=True) == [False]]
    assert told == [0, 20]


def test_sped_up_a_tick_is_late_after_as_much_real_time() -> None:
    ticks = Ticks(START_NS, Times(10.0))
    assert late([ticks.wake(ticks.next_ns + 2_400 * MS_NS)]) == [False]
    assert late([ticks.wake(ticks.next_ns + 2_600 * MS_NS)]) == [True]
