"""How a number may be typed: digits, a decimal point, an exponent, and nothing else.

`float()` takes more than anybody means by a number: `1_0` is ten to it, and so are digits of other
scripts and the words nan and inf.
"""

from __future__ import annotations

import math
import re

_NUMBER = re.compile(r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?", re.ASCII)
_WHOLE = re.compile(r"[+-]?\d{1,18}", re.ASCII)


def read_number(text: str) -> float:
    """A finite number.  Raises ValueError."""
    if not _NUMBER.fullmatch(text):
        raise ValueError(f"{text!r} is not a number")
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(f"{text!r} is not a finite number")
    return number


def read_whole_number(text: str) -> int:
    """A whole number.  Raises ValueError."""
    if not _WHOLE.fullmatch(text):
        raise ValueError(f"{text!r} is not a whole number")
    return int(text)
