"""The latest verdicts and endings, the newest at the bottom, for a wide screen."""

from __future__ import annotations

import textwrap
from itertools import islice

from rich.text import Text

from gcs.tui import look
from gcs.tui.scene import Scene

ROWS_EACH = 2
"""A sentence with its numbers seldom fits one."""


def draw(scene: Scene, columns: int, rows: int) -> Text:
    """As many as there is room for, each with how long ago it was."""
    told: list[tuple[str, str]] = []
    for each in islice(reversed(scene.decisions), rows):
        ago_s = max(0, scene.now_ns - each.time_ns) / 1e9
        ago = f"{ago_s:4.0f} s " if ago_s < 1000 else f"{ago_s / 60:4.0f} m "
        lines = textwrap.wrap(
            ago + each.text, max(columns, 20), max_lines=ROWS_EACH, placeholder=" …",
            subsequent_indent=" " * len(ago), drop_whitespace=True,
        )  # fmt: skip
        if len(told) + len(lines) > rows:
            break
        style = look.ANSWER.get(each.kind, look.DIM)
        told = [*((line, style) for line in lines), *told]
    picture = Text(no_wrap=True, end="")
    for n, (line, style) in enumerate(told):
        picture.append("\n" if n else "").append(line, style)
    return picture if told else Text("nothing accepted or refused yet", look.DIM)
