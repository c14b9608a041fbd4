"""A table that one test looks at as a whole, since what each of its cases takes is less than what
pytest does for a test."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable
from functools import wraps
from typing import TypeVar

T = TypeVar("T")


def each(
    name: str, cases: Iterable[T], said: Callable[[T], object] = repr
) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """As `parametrize` with one name.  What fails says in which case, and ends the test."""
    table = list(cases)
    assert table, f"no case of {name}"

    def looking(test: Callable[..., None]) -> Callable[..., None]:
        @wraps(test)
        def look(**others: object) -> None:
            for case in table:
                try:
                    test(**{name: case}, **others)
                except Exception as failed:
                    failed.add_note(f"{name}: {said(case)}")
                    raise

        signature = inspect.signature(test)
        rest = [one for one in signature.parameters.values() if one.name != name]
        assert len(rest) < len(signature.parameters), f"{test.__name__} takes no {name}"
        vars(look)["__signature__"] = signature.replace(parameters=rest)
        return look

    return looking
