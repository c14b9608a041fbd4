"""The drawings in ASCII, for a terminal that cannot show anything else."""

from __future__ import annotations

import sys
from typing import Final

from rich.console import RenderableType
from rich.table import Table
from rich.text import Text

_BRAILLE: Final = {
    0x2800 + dots: " " if not dots else "." if dots.bit_count() < 3 else ":" for dots in range(256)
}
SIGNS: Final = {
    **_BRAILLE,
    **str.maketrans("↑↗→↘↓↙←↖⌂◇◉○◆✗●◀▔┤├─│╌┄█░°·…±▲⇧≥✓▶■", "^/>\\v/<\\Ho@OoX*<~++-|::#.'-~~!^>+>#"),
}
"""Each sign of ours, and the letter that stands for it."""


def needed() -> bool:
    """Whether the terminal's encoding is another one than UTF-8."""
    encoding = getattr(sys.__stdout__, "encoding", None) or ""
    return bool(encoding) and "utf" not in encoding.lower().replace("-", "")


def in_ascii(drawing: RenderableType) -> RenderableType:
    """Sign for sign, so that all styles stay in their places; what is unknown is a `?`."""
    if isinstance(drawing, Text):
        return text_in_ascii(drawing)
    if isinstance(drawing, Table):
        made = Table.grid(padding=drawing.padding)
        cells = [[in_ascii(cell) for cell in column.cells] for column in drawing.columns]
        for row in zip(*cells, strict=True):
            made.add_row(*row)
        return made
    return ascii_of(drawing) if isinstance(drawing, str) else drawing


def text_in_ascii(text: Text) -> Text:
    copy = text.copy()
    copy.plain, copy.overflow = ascii_of(text.plain), "crop"  # an ellipsis is one sign
    return copy


def ascii_of(text: str) -> str:
    return text.translate(SIGNS).encode("ascii", "replace").decode("ascii")
