"""Long work in steps: a generator that yields between them and returns what it found.

So a tick need not wait for it; who has time goes through all of them at once (`drained`).
"""

from __future__ import annotations

from collections.abc import Generator
from typing import TypeAlias, TypeVar

T = TypeVar("T")
Steps: TypeAlias = Generator[None, None, T]


def drained(steps: Steps[T]) -> T:
    """What `steps` returns, after all of them."""
    while True:
        try:
            next(steps)
        except StopIteration as over:
            found: T = over.value
            return found
