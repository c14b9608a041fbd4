"""Which tests `make soak` runs: those that draw new examples there, or that ask for more.

All others would do again what `make test` has done.
"""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Final, TypeAlias

import pytest

SOAKING: Final = "MAVGATE_SOAK" in os.environ
MORE: Final = (
    "tests/unit/gate/test_explore.py::test_an_outcome_that_was_learnt_is_the_outcome_of_a_run",
    "tests/unit/vehicle_services/test_fuzz.py::test_no_message_whatever_brings_the_vehicle_down",
    "tests/scenarios/test_scenarios.py",
)
"""Tests that ask for more in a soak by themselves."""


Counted: TypeAlias = Callable[[str, object], None]
"""pytest's `record_property`: a number that a test counted, and what of.  A soak sums them up."""


def counts(reports: Iterable[pytest.TestReport]) -> Iterator[str]:
    """What all tests of a soak counted together, a line each."""
    sums: Counter[str] = Counter()
    for report in reports:
        for name, value in report.user_properties:
            if SOAKING and isinstance(value, int):
                sums[name] += value
    for name, total in sums.items():
        yield f"{name}: {total:,}"


def left_out(items: Sequence[pytest.Item]) -> list[pytest.Item]:
    """The tests that this run does not need, of all that were collected."""
    if not SOAKING:
        return [item for item in items if item.get_closest_marker("soak")]
    shared = {_function(item) for item in items if item.get_closest_marker("soak")}
    return [item for item in items if not (_function(item) in shared or _draws(item))]


def _function(item: pytest.Item) -> str:
    """Without the parameters: a share of these is in `make test`."""
    return item.nodeid.partition("[")[0]


def _draws(item: pytest.Item) -> bool:
    by_hypothesis = getattr(getattr(item, "obj", None), "is_hypothesis_test", False)
    return by_hypothesis or item.nodeid.startswith(MORE)
