"""How numbers and positions are written: the one place for every text that shows east, north, up.

Metres in the operator's frame (ENU), two decimals, and never -0.00.  Pure, and importable from
every room.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

from gcs.frames import Vec3, enu_from_ned

DECIMALS = 2
BEYOND_REACH_M = 1e10


def fixed(value: float, decimals: int, *, sign: bool = False) -> str:
    """`decimals` places; `sign` writes a plus before what is not negative.

    Rounded first, so that a small negative number is not written as -0.00.  What is farther than
    anything on Earth is written as a power of ten: `1e+30`.
    """
    if math.isfinite(value) and abs(value) >= BEYOND_REACH_M:
        return f"{value:{'+' if sign else ''}.3g}"
    rounded = round(value, decimals) + 0.0
    return f"{rounded:+.{decimals}f}" if sign else f"{rounded:.{decimals}f}"


def signed_enu(enu: Sequence[float | None] | None) -> str:
    """`E +1.00 N +0.00 U +2.00`, for panels and answers; a dash for what is not known."""
    east, north, up = (None, None, None) if enu is None else enu
    return f"E {_signed(east)} N {_signed(north)} U {_signed(up)}"


def labelled_enu(enu: Vec3) -> str:
    """`(1.00 E, 0.00 N, 2.00 U)`, for the gate's sentences."""
    east, north, up = (fixed(value, DECIMALS) for value in enu)
    return f"({east} E, {north} N, {up} U)"


def place(pos_ned: Vec3) -> str:
    """A NED position as `labelled_enu` writes it: the gate thinks in NED and speaks in ENU."""
    return labelled_enu(enu_from_ned(pos_ned))


def plain_enu(enu: Vec3) -> str:
    """`(1.00, 0.00, 2.00)`, for the log lines of the lab."""
    return "(" + ", ".join(fixed(value, DECIMALS) for value in enu) + ")"


def _signed(value: float | None) -> str:
    return "-" if value is None else fixed(value, DECIMALS, sign=True)
