"""Sine and cosine from plain arithmetic: the same bits everywhere, for one vehicle and for many."""

from __future__ import annotations


def sincos(angle_rad: float) -> tuple[float, float]:
    """Sine and cosine of an angle within -pi .. pi, to better than 1e-12.

    The Taylor series of the half angle (Abramowitz and Stegun, 4.3.65 and 4.3.66), up to the
    powers 19 and 18, in Horner's form; then the double angle.
    """
    x = 0.5 * angle_rad
    z = x * x
    s = 1.0 - z / 342.0
    s = 1.0 - z / 272.0 * s
    s = 1.0 - z / 210.0 * s
    s = 1.0 - z / 156.0 * s
    s = 1.0 - z / 110.0 * s
    s = 1.0 - z / 72.0 * s
    s = 1.0 - z / 42.0 * s
    s = 1.0 - z / 20.0 * s
    s = x * (1.0 - z / 6.0 * s)
    c = 1.0 - z / 306.0
    c = 1.0 - z / 240.0 * c
    c = 1.0 - z / 182.0 * c
    c = 1.0 - z / 132.0 * c
    c = 1.0 - z / 90.0 * c
    c = 1.0 - z / 56.0 * c
    c = 1.0 - z / 30.0 * c
    c = 1.0 - z / 12.0 * c
    c = 1.0 - z / 2.0 * c
    return 2.0 * s * c, 1.0 - 2.0 * s * s
