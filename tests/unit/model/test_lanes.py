"""One source of arithmetic, for one vehicle and for many."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from math import sqrt

import pytest

from vehicle_sim.numerics.kernel import anywhere
from vehicle_sim.numerics.lanes import Lanes, batched

_MASK = 0xFFFFFFFFFFFFFFFF


@dataclass(slots=True)
class Toy:
    x: float = 1.0
    old: float = 0.0
    size: float = 0.0
    key: int = 7
    high: bool = False


def _bounded(value: float, top: float) -> float:
    return top if value > top else -top if value < -top else value


def _both(toy: Toy) -> tuple[float, float]:
    return toy.x, toy.old


def _turn(toy: Toy, push: float, k: int) -> None:
    before = toy.x
    toy.x = _bounded(toy.x * 1.1 + push, 3.0)
    toy.old = before
    x, old = _both(toy)
    toy.x += 0.25
    toy.size = sqrt(x * x + old * old) if x > old and not toy.high else 0.0
    toy.key = (toy.key + (k * 0x9E3779B97F4A7C15 & _MASK)) & _MASK
    toy.high = toy.x > 2.0 or toy.old < -2.0
    if anywhere(toy.high):
        toy.size -= 1.0 if toy.high else 0.0
    toy.x += float(toy.key >> 48) * 1e-6


def _chained(toy: Toy) -> None:
    toy.high = 0.0 < toy.x < 1.0


def _bytes(toy: Toy) -> bytes:
    return struct.pack("<dddQ?", toy.x, toy.old, toy.size, toy.key, toy.high)


@pytest.mark.parametrize("count", [1, 2, 33])
def test_a_batch_ends_in_the_same_bytes_as_each_vehicle_by_itself(count: int) -> None:
    alone = [Toy(key=index) for index in range(count)]
    together = Lanes(Toy, count)
    for index in range(count):
        together.lane(index).key = index
    turn = batched(_turn)
    for k in range(1, 200):
        push = 0.3 if k % 7 else -0.9
        for toy in alone:
            _turn(toy, push, k)
        turn(together.all, push, k)
    assert [_bytes(together.lane(index)) for index in range(count)] == [_bytes(t) for t in alone]
    assert len({_bytes(toy) for toy in alone}) == count


def test_a_lane_reads_and_writes_its_own_column_as_plain_numbers() -> None:
    together = Lanes(Toy, 3)
    middle = together.lane(1)
    middle.x = 5.0
    assert (together.lane(0).x, together.lane(1).x, together.lane(2).x) == (1.0, 5.0, 1.0)
    assert type(middle.x) is float
    assert type(middle.key) is int
    assert middle.high is False


def test_what_cannot_be_batched_is_said_when_it_is_compiled() -> None:
    with pytest.raises(SyntaxError, match="chained"):
        batched(_chained)
    with pytest.raises(SyntaxError, match="no kernel"):
        batched(_bytes)
