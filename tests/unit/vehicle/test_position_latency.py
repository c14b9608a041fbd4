"""How late positions come: a clock of another rate is no delay, a queue is."""

from __future__ import annotations

import pytest

from gcs.vehicle.health.position_latency import Delay

MS = 1_000_000
SECOND = 1_000 * MS


class Script:
    """Positions ten times a second, stamped by a clock of the rate `rate`, through a queue."""

    def __init__(self, rate: float = 1.0, *, answers: bool = True) -> None:
        self.delay = Delay()
        self.rate, self.answers = rate, answers
        self.now_ns = 0

    def run(self, seconds: float, queue_s_per_s: float = 0.0, way_s: float = 0.0) -> int:
        """The greatest delay meanwhile; a question a second, its answer in the queue as well.

        `way_s`: so long is all on its way from the vehicle, from the first byte.
        """
        worst = 0
        start_ns = self.now_ns
        for _ in range(round(seconds * 10)):
            self.now_ns += 100 * MS
            queue_ns = round((self.now_ns - start_ns) * queue_s_per_s + way_s * SECOND)
            stamp_ms = round((self.now_ns - queue_ns) * self.rate / MS)
            worst = max(worst, self.delay.of(stamp_ms, self.now_ns))
            if self.answers and self.now_ns % SECOND == 0:
                asked_ns = self.delay.ask(self.now_ns - 20 * MS - queue_ns)
                self.delay.answered(asked_ns, self.now_ns)
        return worst


@pytest.mark.parametrize("rate", [0.5, 0.8, 0.95, 1.0, 1.05, 1.5])
def test_a_clock_of_another_rate_is_no_delay(rate: float) -> None:
    """station.md, bug 4: at 0.95 stale for good after 20 s, at 0.8 after 5 s."""
    assert Script(rate).run(60.0) <= 600 * MS


def test_without_answers_a_steady_growth_is_a_queue() -> None:
    assert Script(0.8, answers=False).run(60.0) > 10 * SECOND


@pytest.mark.parametrize("rate", [0.8, 1.0])
def test_a_queue_that_grows_is_delay_whatever_the_clock(rate: float) -> None:
    """Its question and answer take as long as the queue is."""
    script = Script(rate)
    script.run(10.0)
    assert script.run(10.0, queue_s_per_s=0.3) > 2 * SECOND


def test_an_answer_that_nobody_asked_for_tells_nothing() -> None:
    delay = Delay()
    delay.of(0, 0)
    delay.of(1000, 5 * SECOND)
    delay.answered(5 * SECOND - 1, 5 * SECOND)
    assert delay.of(1100, 5 * SECOND + 100 * MS) == pytest.approx(4 * SECOND, rel=0.01)


def test_a_position_that_came_long_before_the_answer_is_not_excused_by_it() -> None:
    delay = Delay()
    delay.of(0, 0)
    asked_ns = delay.ask(5 * SECOND)
    assert delay.of(1000, 5 * SECOND) == pytest.approx(4 * SECOND, rel=0.01)
    delay.answered(asked_ns, 5 * SECOND + 300 * MS)
    assert delay.of(1300, 5 * SECOND + 300 * MS) == pytest.approx(4 * SECOND, rel=0.01)


@pytest.mark.parametrize("way_s", [0.0, 0.3, 1.5, 3.0])
def test_a_delay_that_was_there_from_the_first_byte_shows(way_s: float) -> None:
    """The answers take as long; 20 ms are the way to the vehicle."""
    script = Script()
    script.run(3.0, way_s=way_s)
    assert script.delay.late_ns == pytest.approx(way_s * SECOND + 20 * MS, abs=MS)


def test_without_answers_it_does_not() -> None:
    script = Script(answers=False)
    script.run(3.0, way_s=3.0)
    assert script.delay.late_ns == 0


def test_one_answer_that_waited_says_nothing_of_the_way() -> None:
    script = Script()
    script.run(3.0)
    asked_ns = script.delay.ask(script.now_ns - SECOND)
    script.delay.answered(asked_ns, script.now_ns)
    script.answers = False
    script.run(0.5)
    assert script.delay.late_ns == pytest.approx(20 * MS, abs=MS)


def test_what_is_too_late_is_told_once_in_ten_seconds() -> None:
    script, told = Script(), []
    for _ in range(25):
        script.run(1.0, way_s=3.0)
        told.append(script.delay.trouble(SECOND, script.now_ns))
    (first, *_) = [each for each in told if each]
    assert "up to 3.0 s late" in first
    assert len([each for each in told if each]) == 3
    assert Script().delay.trouble(SECOND, SECOND) == ""
