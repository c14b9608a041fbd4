"""One test of many cases: all are looked at, and what fails says in which."""

from __future__ import annotations

import inspect

import pytest

from tests.each import each


def test_every_case_is_looked_at_with_the_same_fixtures() -> None:
    seen: list[tuple[int, str]] = []

    @each("number", range(3))
    def looks(number: int, fixture: str) -> None:
        seen.append((number, fixture))

    assert list(inspect.signature(looks).parameters) == ["fixture"]
    looks(fixture="same")
    assert seen == [(0, "same"), (1, "same"), (2, "same")]


def test_what_fails_says_in_which_case() -> None:
    @each("number", range(3), said=lambda number: f"the {number}")
    def looks(number: int) -> None:
        assert number != 1

    with pytest.raises(AssertionError) as failed:
        looks()
    assert failed.value.__notes__ == ["number: the 1"]


def test_a_table_without_a_case_is_no_table() -> None:
    with pytest.raises(AssertionError, match="no case of number"):
        each("number", [])


def test_a_test_takes_what_it_is_given() -> None:
    with pytest.raises(AssertionError, match="takes no number"):

        @each("number", [1])
        def looks(other: int) -> None: ...
