"""What `make test` leaves to `make thorough`, by the names of tests and by their number."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain
from typing import cast

import pytest

from tests.shares import one_in, other_flights


@dataclass(frozen=True)
class Named:
    """As much of a test as is looked at."""

    nodeid: str
    marked: bool = False

    def get_closest_marker(self, _name: str) -> bool:
        return self.marked


def left_out(*tests: str | Named) -> set[str]:
    named = [test if isinstance(test, Named) else Named(test) for test in tests]
    return {item.nodeid for item in other_flights(cast("list[pytest.Item]", named))}


def flights(test: str, *cases: str) -> list[str]:
    return [f"tests/loopback/{test}[{case}]" for case in cases]


def test_of_two_autopilots_one_flies() -> None:
    assert len(left_out(*flights("test_a.py::test_b", "px4", "ardupilot"))) == 1


@pytest.mark.parametrize("count", range(1, 20))
def test_of_more_cases_one_in_five_is_flown(count: int) -> None:
    left = left_out(*flights("test_a.py::test_b", *map(str, range(count))))
    assert abs(count - len(left) - count / 5) < 1
    assert len(left) < count


def test_every_test_is_flown_in_a_case_of_its_own() -> None:
    one, other = flights("test_a.py::test_b", "1", "2"), flights("test_a.py::test_c", "1", "2")
    assert len(left_out(*one, *other) & set(one)) == 1
    assert len(left_out(*one, *other) & set(other)) == 1
    assert left_out("tests/loopback/test_a.py::test_d") == set()


def test_what_is_left_out_already_is_no_case() -> None:
    case, marked = flights("test_a.py::test_b", "1", "2")
    assert left_out(case, Named(marked, marked=True)) == set()


def test_a_table_is_looked_at_as_a_whole() -> None:
    assert left_out(*(f"tests/unit/gate/test_a.py::test_b[{n}]" for n in range(9))) == set()


def test_either_flies_about_half_of_a_file() -> None:
    tests = [flights(f"test_a.py::test_{number}", "px4", "ardupilot") for number in range(200)]
    of_px4 = [name for name in left_out(*chain(*tests)) if "px4" in name]
    assert 70 < len(of_px4) < 130


def test_one_in_so_many_cases_is_the_share() -> None:
    cases = list(one_in(2, ["a", ("b", 1), pytest.param("c", id="it")]))
    assert [case.values for case in cases] == [("a",), ("b", 1), ("c",)]
    assert cases[2].id == "it"
    assert [[mark.name for mark in case.marks] for case in cases] == [[], ["thorough"], []]
