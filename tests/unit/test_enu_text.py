"""How positions are written: every form, and every number that could read wrongly."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.enu_text import fixed, labelled_enu, plain_enu, signed_enu
from gcs.frames import Vec3

INF, NAN = math.inf, math.nan

SIGNED = {
    (1.0, 0.0, 2.0): "E +1.00 N +0.00 U +2.00",
    (-0.004, -0.0, -0.006): "E +0.00 N +0.00 U -0.01",
    (-10.0, 12345.678, 0.005): "E -10.00 N +12345.68 U +0.01",
    (NAN, INF, -INF): "E +nan N +inf U -inf",
    (None, 1.0, None): "E - N +1.00 U -",
}
LABELLED = {
    (1.0, 0.0, 2.0): "(1.00 E, 0.00 N, 2.00 U)",
    (-0.004, -0.0, -0.006): "(0.00 E, 0.00 N, -0.01 U)",
    (-10.0, 12345.678, 0.005): "(-10.00 E, 12345.68 N, 0.01 U)",
    (NAN, INF, -INF): "(nan E, inf N, -inf U)",
}
PLAIN = {
    (1.0, 0.0, 2.0): "(1.00, 0.00, 2.00)",
    (-0.004, -0.0, -0.006): "(0.00, 0.00, -0.01)",
    (-10.0, 12345.678, 0.005): "(-10.00, 12345.68, 0.01)",
    (NAN, INF, -INF): "(nan, inf, -inf)",
}


@pytest.mark.parametrize(("enu", "text"), SIGNED.items())
def test_with_labels_before_and_signs(enu: tuple[float | None, ...], text: str) -> None:
    assert signed_enu(enu) == text


def test_a_position_that_is_not_known_is_three_dashes() -> None:
    assert signed_enu(None) == "E - N - U -"


@pytest.mark.parametrize(("enu", "text"), LABELLED.items())
def test_with_labels_behind(enu: Vec3, text: str) -> None:
    assert labelled_enu(enu) == text


@pytest.mark.parametrize(("enu", "text"), PLAIN.items())
def test_without_labels(enu: Vec3, text: str) -> None:
    assert plain_enu(enu) == text


@given(st.floats(-1e9, 1e9), st.integers(0, 3))
def test_what_is_written_is_the_nearest_number_and_never_minus_zero(
    value: float, decimals: int
) -> None:
    text = fixed(value, decimals)
    # 1e-6: the float nearest to the written number, of numbers up to 1e9.
    assert abs(float(text) - value) <= 0.5 * 10.0**-decimals + 1e-6
    assert not (text.startswith("-") and float(text) == 0.0)
    assert fixed(value, decimals, sign=True).lstrip("+") == text


def test_what_is_farther_than_anything_on_earth_is_no_row_of_digits() -> None:
    assert labelled_enu((1e30, -1e30, 2.0)) == "(1e+30 E, -1e+30 N, 2.00 U)"
    assert signed_enu((1e30, 0.0, 2.0)) == "E +1e+30 N +0.00 U +2.00"
    assert labelled_enu((6.4e6, 0.0, 2.0)) == "(6400000.00 E, 0.00 N, 2.00 U)"
