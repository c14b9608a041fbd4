"""The arguments of the Python library's methods, checked before anything is asked for.

Each function takes the method's name and one argument under its own name, and raises BadArgument.
"""

from __future__ import annotations

import functools
import inspect
import math
import os
import reprlib
from collections.abc import Callable
from types import FunctionType
from typing import ParamSpec, SupportsFloat, TypeVar

from gcs.frames import Vec3
from gcs.ipc import Maybe3
from gcs.operator.failures import BadArgument

Given = float | None
P = ParamSpec("P")
R = TypeVar("R")
T = TypeVar("T")


def called_right(function: Callable[P, R]) -> Callable[P, R]:
    """Of a call that leaves an argument out, or has one too many: BadArgument, not a bare
    TypeError."""
    signature = inspect.signature(function)

    @functools.wraps(function)
    def call(*given: P.args, **named: P.kwargs) -> R:
        try:
            signature.bind(*given, **named)
        except TypeError as error:
            raise BadArgument(f"{function.__name__}: {error}") from None
        return function(*given, **named)

    return call


def all_called_right(kind: type[T]) -> type[T]:
    """The same of every public method of a class itself."""
    for name, member in [*vars(kind).items()]:
        if isinstance(member, FunctionType) and not name.startswith("_"):
            setattr(kind, name, called_right(member))
    return kind


def number(method: str, **given: object) -> Given:
    """As it travels: null for one that is not finite, which the gate refuses by name."""
    value = _number(method, given)
    return value if math.isfinite(value) else None


def numbers(method: str, **given: object) -> Maybe3:
    """Three of them, such as east, north and up."""
    a, b, c = (number(method, **{name: value}) for name, value in given.items())
    return (a, b, c)


def finite(method: str, **given: object) -> float:
    """Where null would mean that it is not given."""
    value = _number(method, given)
    if not math.isfinite(value):
        raise _bad(method, given, "a finite number")
    return value


def positive(method: str, **given: object) -> float:
    value = _number(method, given)
    if not value > 0.0:
        raise _bad(method, given, "greater than 0")
    return value


def seconds(method: str, **given: object) -> Given:
    """To wait for; None: for ever."""
    if _left_out(given):
        return None
    value = _number(method, given)
    if not value >= 0.0:
        raise _bad(method, given, "a number of seconds, not negative, or None")
    return value


def optional(method: str, **given: object) -> Given:
    """A finite number, or None: not given."""
    return None if _left_out(given) else finite(method, **given)


def degrees(method: str, **given: object) -> Given:
    """A heading, as the command line takes it, or None: not given."""
    value = optional(method, **given)
    if value is not None and abs(value) > 360.0:
        raise _bad(method, given, "from -360 to 360 degrees")
    return value


def place(method: str, **given: object) -> Vec3 | None:
    """East, north and up in metres, or None: not given."""
    ((name, value),) = given.items()
    if value is None:
        return None
    if isinstance(value, str) or not hasattr(value, "__iter__"):
        raise _bad(method, given, "three numbers: east, north, up")
    each = [finite(method, **{f"{name}[{index}]": one}) for index, one in enumerate(value)]
    if len(each) != 3:
        raise _bad(method, given, "three numbers: east, north, up")
    return (each[0], each[1], each[2])


def sysid(method: str, **given: object) -> int:
    """Of a vehicle."""
    ((_, value),) = given.items()
    if not isinstance(value, int) or not 1 <= value <= 255:
        raise _bad(method, given, "a system id, 1 to 255")
    return value


def text(method: str, **given: object) -> str:
    """A word or a name."""
    ((_, value),) = given.items()
    if not isinstance(value, str):
        raise _bad(method, given, "a text")
    return value


def path(method: str, **given: object) -> str:
    """Of a file: text, or a `Path`."""
    ((_, value),) = given.items()
    if not isinstance(value, str | os.PathLike):
        raise _bad(method, given, "a path")
    return str(os.fspath(value))


def _left_out(given: dict[str, object]) -> bool:
    return next(iter(given.values())) is None


def _number(method: str, given: dict[str, object]) -> float:
    ((_, value),) = given.items()
    if isinstance(value, SupportsFloat):  # numpy's numbers, too; no text is one
        try:
            return float(value)
        except (TypeError, ValueError, OverflowError):
            pass
    raise _bad(method, given, "a number")


def _bad(method: str, given: dict[str, object], wanted: str) -> BadArgument:
    ((name, value),) = given.items()
    return bad(method, name, wanted, value)


def bad(method: str, name: str, wanted: str, value: object) -> BadArgument:
    """What is wrong with one argument."""
    sentence = f"{method}: {name} must be {wanted}, not {reprlib.repr(value)}"
    number = value if isinstance(value, int | float) and abs(value) < 1e300 else None
    return BadArgument(sentence, {} if number is None else {name: float(number)})
