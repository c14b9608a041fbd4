"""Arithmetic that is written once, for one vehicle and for many.

A *block* is a slotted dataclass of floats, integers and booleans: the state of a part of one
vehicle.  A *kernel* is a plain function over blocks.  Called with blocks it runs in Python floats;
`lanes.batched(kernel)` runs the same source over numpy rows with one vehicle a column.  IEEE-754
makes + - * / sqrt and comparisons the same in both, so equal inputs give equal bytes, whatever
the number of vehicles.

What a kernel may use: arithmetic, comparisons, `and`/`or`/`not`, `a if c else b` (a batch
evaluates both sides), `sqrt` of math, `float(x)`, `anywhere(c)`, other kernels, local names, and
attributes of blocks.  An `if` statement may only ask what is the same for every vehicle.
Integers are unsigned and 64 bits wide; mask what may overflow.  No `min`, `max`, `**`, `math` or
loops over vehicles.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Final, ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")

KERNELS: Final[set[Callable[..., object]]] = set()


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Declare `function` a kernel.  It stays what it is."""
    KERNELS.add(function)
    return function


def anywhere(condition: bool) -> bool:
    """Whether it holds for this vehicle; in a batch, for any of them."""
    return condition
