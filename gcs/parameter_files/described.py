"""What an autopilot says of its own parameters: PX4's component metadata (`parameters.json`).

https://mavlink.io/en/services/component_information.html.  ArduPilot has none on board.
"""

from __future__ import annotations

import lzma
from typing import Final

import msgspec

PATHS: Final = ("/etc/extras/parameters.json.xz", "/etc/extras/parameters.json")
"""Where a PX4 has it, the compressed one first."""


class Choice(msgspec.Struct, frozen=True):
    value: float
    description: str


class Bit(msgspec.Struct, frozen=True):
    index: int
    description: str


class Description(msgspec.Struct, frozen=True, rename="camel"):
    """One parameter, by parameter.schema.json."""

    name: str
    type: str = ""
    short_desc: str = ""
    long_desc: str = ""
    units: str = ""
    min: float | None = None
    max: float | None = None
    default: float | None = None
    reboot_required: bool = False
    values: list[Choice] = []
    bitmask: list[Bit] = []

    def beyond(self, value: float) -> tuple[str, dict[str, float | None]]:
        """Why the value is not within its bounds, and the numbers; nothing where it is."""
        low, high = self.min, self.max
        if (low is None or value >= low) and (high is None or value <= high):
            return "", {}
        least = "" if low is None else f" from {_text(low)}"
        most = "" if high is None else f" to {_text(high)}"
        told = f"the vehicle's own bounds are{least}{most}"
        return f"{self.name}: {_text(value)} {self.units}".rstrip() + f": {told}", {
            "value": value,
            "min": low,
            "max": high,
        }


class _File(msgspec.Struct):
    parameters: list[Description]


def described(path: str, data: bytes) -> dict[str, Description]:
    """By name.  Raises ValueError for what is no such file."""
    try:
        text = lzma.decompress(data) if path.endswith(".xz") else data
        known = msgspec.json.decode(text, type=_File)
    except (lzma.LZMAError, EOFError, msgspec.DecodeError) as error:
        raise ValueError(f"{path}: {error}") from None
    return {each.name: each for each in known.parameters}


def lines_of(known: Description) -> list[str]:
    """As a person reads it."""
    lines = [known.short_desc or "no description"]
    if known.long_desc:
        lines += ["", *known.long_desc.splitlines()]
    facts = [("unit", known.units), ("minimum", known.min), ("maximum", known.max)]
    facts += [("default", known.default)]
    lines += [f"{name}: {_text(value)}" for name, value in facts if value not in (None, "")]
    lines += [f"  {_text(each.value)}: {each.description}" for each in known.values]
    lines += [f"  bit {each.index}: {each.description}" for each in known.bitmask]
    return [*lines, "takes effect after a restart"] if known.reboot_required else lines


def _text(value: float | str | None) -> str:
    return value if isinstance(value, str) else f"{value:g}"
