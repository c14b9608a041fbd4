"""What `make test` leaves to `make thorough`, by the places of tests and by their number."""

from __future__ import annotations

from collections.abc import Iterator
from types import ModuleType
from typing import cast

import pytest

from tests.shares import one_in, other_flights

FILE = ModuleType("test_a")
vars(FILE).update(helper=1, test_first=2, test_second=3, test_third=4)


class Case:
    """As much of a test as is looked at."""

    module = FILE

    def __init__(
        self, test: str, case: str, *, file: str = "contract/test_a.py", marked: bool = False
    ) -> None:
        self.nodeid = f"tests/{file}::{test}[{case}]"
        self.originalname, self.case, self.marked = test, case, marked

    def get_closest_marker(self, _name: str) -> bool:
        return self.marked


def flown(*cases: Case) -> str:
    """The cases that `make test` flies, of those whose names are a letter."""
    left = cast("Iterator[Case]", other_flights(cast("list[pytest.Item]", cases)))
    out = [case.nodeid for case in left]
    return "".join(case.case for case in cases if case.nodeid not in out)


@pytest.mark.parametrize(
    ("test", "cases", "some"),
    [
        ("test_first", "p", "p"),
        ("test_second", "p", "p"),
        ("test_first", "pa", "p"),
        ("test_second", "pa", "a"),
        ("test_first", "abcde", "a"),
        ("test_second", "abcdef", "b"),
        ("test_first", "abcdefghijk", "afk"),
        ("test_second", "abcdefghijk", "bg"),
    ],
)
def test_one_case_in_five_is_flown_and_the_place_of_the_test_tells_which(
    test: str, cases: str, some: str
) -> None:
    assert flown(*(Case(test, case) for case in cases)) == some


@pytest.mark.parametrize(
    ("test", "some"), [("test_first", "p"), ("test_second", ""), ("test_third", "a")]
)
def test_of_whole_flights_every_second_test_is_flown(test: str, some: str) -> None:
    assert flown(*(Case(test, case, file="loopback/test_a.py") for case in "pa")) == some


def test_what_is_left_out_already_is_no_case_and_tables_are_looked_at_as_a_whole() -> None:
    assert flown(Case("test_first", "p", marked=True), Case("test_first", "a")) == "pa"
    assert flown(*(Case("test_first", case, file="unit/gate/test_a.py") for case in "pa")) == "pa"


def test_one_in_so_many_cases_is_the_share() -> None:
    cases = list(one_in(2, ["a", ("b", 1), pytest.param("c", id="it")]))
    assert [case.values for case in cases] == [("a",), ("b", 1), ("c",)]
    assert cases[2].id == "it"
    assert [[mark.name for mark in case.marks] for case in cases] == [[], ["thorough"], []]
