"""Sine and cosine by arithmetic."""

from __future__ import annotations

from math import cos, pi, sin

from vehicle_sim.numerics.angles import sincos


def test_it_is_right_to_a_millionth_of_a_millionth_all_round() -> None:
    worst = 0.0
    for step in range(-20_000, 20_001):
        angle = pi * step / 20_000
        s, c = sincos(angle)
        worst = max(worst, abs(s - sin(angle)), abs(c - cos(angle)))
    assert worst < 1e-12


def test_nothing_turned_is_exactly_nothing() -> None:
    assert sincos(0.0) == (0.0, 1.0)


def test_left_and_right_mirror_exactly() -> None:
    for angle in (0.1, 1.0, 2.0, 3.0):
        s, c = sincos(angle)
        assert sincos(-angle) == (-s, c)
