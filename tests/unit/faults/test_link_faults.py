"""Bad links out of a fault file: what comes through, counted by the frames' sequence numbers."""

from __future__ import annotations

from itertools import pairwise

import pytest

from tests.unit.faults.stage import MS, S, Stage
from vehicle_sim.wire import messages as m

AT_S, FOR_S = 5.0, 20.0
PING = m.Ping(0, 0, 0, 0)


def bad(keys: str, direction: str = "out") -> Stage:
    """On the ground, with the link bad between 5 s and 25 s; lived up to 26 s."""
    stage = Stage(
        "px4",
        f"[[fault]]\nat_s = {AT_S}\nfor_s = {FOR_S}\nkind = 'link'\n"
        f"direction = '{direction}'\n{keys}\n",
    )
    stage.run(26.0)
    return stage


def sequences(stage: Stage, from_s: float, to_s: float) -> list[int]:
    """Sequence numbers as they came, counted on over 255."""
    numbers: list[int] = []
    for at_ns, frame in stage.heard:
        if not from_s * S <= at_ns < to_s * S:
            continue
        last = numbers[-1] if numbers else frame.sequence
        # The nearest number to the last one that ends so: frames are out of order by a few.
        numbers.append(last + (frame.sequence - last + 128) % 256 - 128)
    return numbers


@pytest.mark.parametrize("rate", [0.05, 0.3])
def test_loss(rate: float) -> None:
    stage = bad(f"loss = {rate}")
    numbers = sequences(stage, AT_S, AT_S + FOR_S)
    span = numbers[-1] - numbers[0] + 1
    assert span > 3000
    assert 1.0 - len(numbers) / span == pytest.approx(rate, abs=0.04)
    assert len(set(numbers)) == len(numbers)
    before = sequences(stage, 0.0, AT_S)
    assert all(b - a == 1 for a, b in pairwise(before)), "a sound link loses nothing"


def test_duplicates() -> None:
    numbers = sequences(bad("duplicate = 0.2"), AT_S, AT_S + FOR_S)
    twice = len(numbers) - len(set(numbers))
    assert twice / len(set(numbers)) == pytest.approx(0.2, abs=0.04)
    assert len(set(numbers)) == numbers[-1] - numbers[0] + 1


def test_reordering() -> None:
    """What is held back is overtaken by what was sent in the next 50 ms, and not lost."""
    numbers = sequences(bad("reorder = 0.1"), AT_S, AT_S + FOR_S - 0.1)
    back = sum(b < a for a, b in pairwise(numbers))
    assert len(set(numbers)) == len(numbers)
    assert back > 20
    assert max(numbers) - min(numbers) + 1 - len(numbers) < 20, "only the last may be on its way"


@pytest.mark.parametrize("delay_s", [0.2, 1.0])
def test_delay(delay_s: float) -> None:
    stage = bad(f"delay_s = {delay_s}")
    ages_s = [
        at_ns / S - message.time_boot_ms / 1000.0
        for at_ns, frame in stage.heard
        if (AT_S + delay_s) * S < at_ns < 24 * S
        and isinstance(message := frame.message(), m.Attitude)
    ]
    assert len(ages_s) > 100
    assert delay_s - 0.001 <= min(ages_s) <= max(ages_s) <= delay_s + 0.021


def test_jitter_fills_its_range() -> None:
    stage = bad("delay_s = 0.1\njitter_s = 0.4")
    ages_s = [
        at_ns / S - message.time_boot_ms / 1000.0
        for at_ns, frame in stage.heard
        if 6 * S < at_ns < 24 * S and isinstance(message := frame.message(), m.Attitude)
    ]
    assert min(ages_s) < 0.15
    assert max(ages_s) > 0.45
    assert sum(ages_s) / len(ages_s) == pytest.approx(0.31, abs=0.03)


def test_loss_on_the_way_in_loses_orders_and_leaves_telemetry_alone() -> None:
    stage = Stage("px4", "[[fault]]\nat_s = 0\nkind='link'\ndirection='in'\nloss=0.5")
    stage.run(2.0)
    for _ in range(400):
        stage.send(PING)
        stage.run(0.02)
    answered = len(stage.all(m.Ping))
    assert answered / 400 == pytest.approx(0.5, abs=0.08)
    numbers = [frame.sequence for _, frame in stage.heard]
    assert all((b - a) % 256 == 1 for a, b in pairwise(numbers))


def test_a_link_that_is_not_there_is_said_and_harms_nothing() -> None:
    stage = Stage("px4", "[[fault]]\nat_s = 2\nkind = 'link'\nlink = 3\nout = true")
    stage.run(4.0)
    (line,) = [log for log in stage.logs if log.node == "faults"]
    assert (line.level, line.text.endswith("but there is no such thing")) == ("warning", True)
    assert stage.all(m.Heartbeat, 3 * S)


def test_every_fault_is_said_when_it_strikes_and_when_it_ends() -> None:
    stage = Stage("px4", "[[fault]]\nat_s = 2\nfor_s = 1.5\nkind = 'gps_lost'\nvehicle = 1")
    stage.run(5.0)
    said = [log.text for log in stage.logs if log.node == "faults"]
    assert said == ["vehicle 1: GPS is lost", "vehicle 1: GPS is back"]
    assert MS * 1000 == S
