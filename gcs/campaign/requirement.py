"""`--require "breaches == 0"`: NAME OP NUMBER, and nothing else."""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable
from typing import Final, NamedTuple

from gcs.campaign.statistics import Summary
from gcs.toml import did_you_mean

_COMPARE: Final[dict[str, Callable[[float, float], bool]]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "<=": operator.le,
    ">=": operator.ge,
    "<": operator.lt,
    ">": operator.gt,
}
_NAMES: Final[dict[str, Callable[[Summary], float]]] = {
    "flights": lambda told: told.flights,
    "breaches": lambda told: told.breaches.hits,
    "breach_share": lambda told: told.breaches.hits / max(1, told.breaches.of),
    "breach_bound": lambda told: told.breaches.high,
    "failures": lambda told: told.failures,
    "refused": lambda told: told.refused,
    "critical": lambda told: told.critical,
    "closest_m": lambda told: math.inf if told.closest_m is None else told.closest_m,
}
"""What can be required: `breach_bound` is the upper bound of the probability."""

_GRAMMAR: Final = re.compile(r"\s*(\w+)\s*(==|!=|<=|>=|<|>)\s*([-+]?\d+(?:\.\d*)?)\s*", re.ASCII)


class RequirementError(ValueError):
    """A requirement that cannot be read; `hint` says what would be right."""

    def __init__(self, what: str, hint: str) -> None:
        super().__init__(what)
        self.hint = hint


class Requirement(NamedTuple):
    text: str
    name: str
    compare: str
    number: float

    def value(self, told: Summary) -> float:
        return _NAMES[self.name](told)

    def met(self, told: Summary) -> bool:
        return _COMPARE[self.compare](self.value(told), self.number)


def parse(text: str) -> Requirement:
    """Raises RequirementError."""
    found = _GRAMMAR.fullmatch(text)
    if found is None:
        raise RequirementError(f"{text!r} is not NAME OP NUMBER", 'such as "breaches == 0"')
    name, compare, number = found.groups()
    if name not in _NAMES:
        raise RequirementError(f"{name}: nothing of that name", did_you_mean(name, _NAMES))
    return Requirement(text.strip(), name, compare, float(number))
