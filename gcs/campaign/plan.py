"""What a campaign is, whole: whoever has a `Plan` needs no file more to fly any of its flights.

An axis is what differs between flights: values to choose from, or a range.  A *place* on an axis is
a number from 0 to 1, which every way of sampling speaks of; `Axis.at` says which value is there.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from hashlib import blake2b
from typing import Literal, TypeAlias

import msgspec

from gcs.campaign.case import Case, Rules, Task, Value

Sample: TypeAlias = Literal["grid", "random", "latin", "search"]
TASK, POLICY, FAULT, SEED = "task", "policy", "fault", "seed"


class Choice(msgspec.Struct, frozen=True, tag=True):
    """One of these, all as likely."""

    name: str
    values: tuple[Value, ...]

    def at(self, place: float) -> Value:
        return self.values[min(int(place * len(self.values)), len(self.values) - 1)]


class Range(msgspec.Struct, frozen=True, tag=True):
    """Any number from `low` to `high`."""

    name: str
    low: float
    high: float

    def at(self, place: float) -> Value:
        """Rounded to six digits, so that a row says it whole."""
        number = self.low + place * (self.high - self.low)
        return round(number, 6 - math.ceil(math.log10(abs(number)))) if number else 0.0


Axis: TypeAlias = Choice | Range


class Plan(msgspec.Struct, frozen=True):
    """`flights` is how many are flown; `faults` are the texts of fault files by name."""

    name: str
    simulator: str
    sample: Sample
    flights: int
    seed: int
    timeout_s: float
    tasks: tuple[Task, ...]
    rules: tuple[Rules, ...]
    faults: dict[str, str]
    axes: tuple[Axis, ...]

    @property
    def digest(self) -> str:
        """Of all that the flights depend on."""
        return blake2b(encode(self), digest_size=8).hexdigest()

    def inputs(self, places: Sequence[float]) -> dict[str, Value]:
        """The values at one place an axis."""
        pairs = zip(self.axes, places, strict=True)
        return {axis.name: axis.at(place) for axis, place in pairs}

    def case(self, number: int, inputs: Mapping[str, Value]) -> Case:
        """Flight `number`.  Its seed is its own where no axis says it."""
        inputs = {**inputs, SEED: inputs.get(SEED, self.seed * 1_000_000 + number)}
        table = {k: v for k, v in inputs.items() if k not in (TASK, POLICY, FAULT)}
        fault = str(inputs.get(FAULT, ""))
        if fault:
            table |= {"faults": self.faults[fault], "faults_file": fault}
        return Case(
            number,
            next(task for task in self.tasks if task.name == inputs[TASK]),
            next(rules for rules in self.rules if rules.name == inputs[POLICY]),
            self.simulator,
            table,
            self.timeout_s,
            dict(inputs),
        )


def encode(plan: Plan) -> bytes:
    return msgspec.msgpack.encode(plan, order="deterministic")


def decode(data: bytes) -> Plan:
    """Raises msgspec.DecodeError."""
    return msgspec.msgpack.decode(data, type=Plan)
