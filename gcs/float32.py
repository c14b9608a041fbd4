"""32-bit floats, as parameters travel in them, and the shortest text that means one."""

from __future__ import annotations

import math
import struct
from decimal import Decimal


def float32(value: float) -> float:
    """The nearest float32; infinite where there is none."""
    try:
        return float(struct.unpack("<f", struct.pack("<f", value))[0])
    except OverflowError:
        return math.copysign(math.inf, value)


def value_text(value: int | float) -> str:
    """The shortest decimal that is this float32, or this whole number."""
    if isinstance(value, int):
        return str(value)
    if not math.isfinite(value):
        return "nan" if math.isnan(value) else "inf" if value > 0 else "-inf"
    text = next(
        (text for digits in range(1, 9) if float32(float(text := f"{value:.{digits}g}")) == value),
        f"{value:.9g}",
    )
    return f"{Decimal(text):f}" if "e" in text and 1e-7 <= abs(value) < 1e15 else text
