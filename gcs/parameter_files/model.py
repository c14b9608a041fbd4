"""What a file of parameters holds, whatever its format, and how two of them differ."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from gcs.float32 import float32, value_text


@dataclass(frozen=True, slots=True)
class Entry:
    """One parameter.  `kind`: its type (real32, int32 ...), empty where the file has none."""

    name: str
    value: int | float
    kind: str = ""
    line: int = 0

    @property
    def text(self) -> str:
        return value_text(self.value)


@dataclass(frozen=True, slots=True)
class Difference:
    """One name whose values differ; None: it is not there."""

    name: str
    a: Entry | None
    b: Entry | None


Entries = Mapping[str, Entry]


class ParameterFileError(Exception):
    """`text` begins with the file, and the line where one is wrong."""

    def __init__(self, text: str, hint: str = "") -> None:
        super().__init__(text)
        self.hint = hint


def differences(a: Entries, b: Entries) -> list[Difference]:
    """By name.  Values are compared as the float32 that they travel in, unless both are whole."""
    found = []
    for name in sorted({*a, *b}):
        one, other = a.get(name), b.get(name)
        if one is None or other is None or not same(one.value, other.value):
            found.append(Difference(name, one, other))
    return found


def same(a: int | float, b: int | float) -> bool:
    """Whether a vehicle would hold the same."""
    if a != a or b != b:
        return a != a and b != b
    return a == b or (not (isinstance(a, int) and isinstance(b, int)) and float32(a) == float32(b))
