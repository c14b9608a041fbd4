"""The rows of a `QGC WPL PB 110` file: protobuf text, one block a waypoint.

waypoint {
  seq: 0
  frame: 3
  command: 16
  x: 47.397742
  ...
}
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from gcs.plan.errors import PlanError

_NAMES = {
    **{name: name for name in ("seq", "current", "frame", "command", "autocontinue")},
    **{f"param{number}": f"p{number}" for number in (1, 2, 3, 4)},
    "x": "lat",
    "y": "lon",
    "z": "alt",
}
_FIELD = re.compile(r"(\w+)\s*:\s*(\S+)")
_WORDS = {"true": "1", "false": "0"}


def waypoint_blocks(
    file: str, lines: Iterator[tuple[str, str]]
) -> Iterator[tuple[str, dict[str, str]]]:
    """(line of its beginning, cells by the names of a WPL table) of each block.

    Raises PlanError for a line that is neither a field nor the beginning or end of a block, and
    for a block that lacks a field.
    """
    begun, cells = "", dict[str, str]()
    for where, line in lines:
        field = _FIELD.fullmatch(line)
        if not begun and re.fullmatch(r"waypoint\s*\{", line):
            begun, cells = where, {}
        elif begun and line == "}":
            missing = [name for name, cell in _NAMES.items() if cell not in cells]
            if missing:
                raise PlanError(file, begun, "waypoint", f"has no {', '.join(missing)}")
            yield begun, cells
            begun = ""
        elif begun and field is not None and field[1] in _NAMES:
            cells[_NAMES[field[1]]] = _WORDS.get(field[2], field[2])
        else:
            expected = "one of " + ", ".join(_NAMES) if begun else '"waypoint {"'
            raise PlanError(file, where, "line", f'is "{line[:40]}"', expected)
    if begun:
        raise PlanError(file, begun, "waypoint", "has no end", '"}"', "is the file whole?")
