"""Sizes and ages as a user writes them."""

from __future__ import annotations

import click
import pytest

from gcs.cli.records.options import Age, Size


@pytest.mark.parametrize(
    ("text", "size_bytes"),
    [("500MB", 500_000_000), ("2GB", 2_000_000_000), ("1.5G", 1_500_000_000), ("1000 kB", 10**6)],
)
def test_a_size_is_a_number_with_a_unit_of_a_thousand(text: str, size_bytes: int) -> None:
    assert Size().convert(text, None, None) == size_bytes


@pytest.mark.parametrize("text", ["", "MB", "-500MB", "500", "0MB", "500 TB", "1e9", "nan"])
def test_what_is_no_size_of_a_file_is_refused(text: str) -> None:
    with pytest.raises(click.BadParameter, match=r"as in 500MB|too small"):
        Size().convert(text, None, None)


@pytest.mark.parametrize(
    ("text", "seconds"), [("1h", 3600.0), ("30min", 1800.0), ("90", 90.0), ("1.5 h", 5400.0)]
)
def test_an_age_is_a_number_with_a_unit(text: str, seconds: float) -> None:
    assert Age().convert(text, None, None) == seconds


@pytest.mark.parametrize("text", ["", "h", "-1h", "5s", "1 day", "inf"])
def test_what_is_no_age_of_a_file_is_refused(text: str) -> None:
    with pytest.raises(click.BadParameter, match=r"as in 90s|too short"):
        Age().convert(text, None, None)
