"""Which places on the axes are flown, by the number of the flight: grid, random, Latin hypercube.

Chance is a hash of the campaign's seed, the axis's name and the flight's number: no generator whose
state has to be kept, the same numbers in every version of every library, and another axis changes
nothing of those that are there.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from hashlib import blake2b
from typing import TypeAlias

from gcs.campaign.plan import Axis, Choice, Plan

Places: TypeAlias = "list[float]"


def uniform(seed: int, what: str, number: int) -> float:
    """In [0, 1): each with 2^-53 of chance."""
    told = f"{seed}/{what}/{number}".encode()
    return (int.from_bytes(blake2b(told, digest_size=8).digest(), "big") >> 11) * 2.0**-53


def grid_size(axes: Sequence[Axis]) -> int:
    return math.prod(len(axis.values) for axis in axes if isinstance(axis, Choice))


def places_of(plan: Plan) -> Callable[[int], Places]:
    """The places of flight `number`, from 0 to `plan.flights` - 1.  Not of a search."""
    match plan.sample:
        case "grid":
            return lambda number: _grid(plan.axes, number)
        case "random":
            return lambda number: [uniform(plan.seed, axis.name, number) for axis in plan.axes]
        case "latin":
            columns = [latin(plan.seed, axis.name, plan.flights) for axis in plan.axes]
            return lambda number: [column[number] for column in columns]
        case "search":
            raise ValueError("a search chooses by what it has seen")


def latin(seed: int, what: str, count: int) -> Places:
    """One place in each of `count` equal parts of an axis, in an order of its own."""
    order = sorted(range(count), key=lambda number: uniform(seed, f"{what} part", number))
    found = [0.0] * count
    for part, number in enumerate(order):
        found[number] = (part + uniform(seed, what, number)) / count
    return found


def _grid(axes: Sequence[Axis], number: int) -> Places:
    """The last axis changes first."""
    places: Places = []
    for axis in reversed(axes):
        assert isinstance(axis, Choice)
        number, value = divmod(number, len(axis.values))
        places.append((value + 0.5) / len(axis.values))
    return places[::-1]
