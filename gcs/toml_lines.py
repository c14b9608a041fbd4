"""Where each key of a TOML text stands, as `tomllib` forgets line numbers when it has parsed."""

from __future__ import annotations

import re
from typing import TypeAlias

KeyPath: TypeAlias = tuple[str | int, ...]
"""Keys down to a value; the n-th element of an array is the int n, from 0."""

_HEADER = re.compile(r"\s*(\[\[?)\s*([^\[\]]+?)\s*\]\]?\s*$")
_KEY = re.compile(r"""\s*((?:[A-Za-z0-9_-]+|"[^"]*"|'[^']*')(?:\s*\.\s*[A-Za-z0-9_"'-]+)*)\s*=""")
_STRING = re.compile(r'"""|\'\'\'|"(?:\\.|[^"\\])*"|\'[^\']*\'')


def find_lines(text: str) -> dict[KeyPath, int]:
    """The line, from 1, of every table header and key of a TOML text that parses."""
    lines: dict[KeyPath, int] = {}
    counts: dict[tuple[str, ...], int] = {}
    table: KeyPath = ()
    depth, quotes = 0, ""
    for number, raw in enumerate(text.split("\n"), start=1):
        line, quotes = _bare(raw, quotes)
        if depth == 0 and not line.startswith("\0"):
            if header := _HEADER.match(line):
                table = _table_path(header[1] == "[[", _dotted(header[2]), counts)
                _note(lines, table, number)
                continue
            if key := _KEY.match(line):
                _note(lines, (*table, *_dotted(key[1])), number)
        depth += sum(map(line.count, "[{")) - sum(map(line.count, "]}"))
    return lines


def _note(lines: dict[KeyPath, int], path: KeyPath, number: int) -> None:
    """Note the line of `path`, and of every table around it that has no line yet."""
    for end in range(1, len(path) + 1):
        lines.setdefault(path[:end], number)


def _bare(raw: str, quotes: str) -> tuple[str, str]:
    """A line without the insides of its strings and without its comment, and the quotes that
    are still open at its end.  A line that begins inside a string begins with NUL."""
    begun = ""
    if quotes:
        _, closed, raw = raw.partition(quotes)
        begun = "\0"
        if not closed:
            return begun, quotes
    kept, at = begun, 0
    while at < len(raw):
        if raw[at] == "#":
            break
        string = _STRING.match(raw, at)
        if string is None:
            kept, at = kept + raw[at], at + 1
            continue
        at = string.end()
        if len(string[0]) == 3 and string[0] in ('"""', "'''"):
            end = raw.find(string[0], at)
            if end < 0:
                return kept, string[0]
            at = end + 3
        elif "=" not in kept:
            kept += re.sub(r"[\[\]{}]", "_", string[0])
    return kept, ""


def _table_path(
    is_item: bool, names: tuple[str, ...], counts: dict[tuple[str, ...], int]
) -> KeyPath:
    """The path of a header.  Tables of an array are counted as they come; a name under an array
    belongs to its last table."""
    if is_item:
        counts[names] = counts.get(names, -1) + 1
    path: list[str | int] = []
    for end in range(1, len(names) + 1):
        path.append(names[end - 1])
        if names[:end] in counts:
            path.append(counts[names[:end]])
    return tuple(path)


def _dotted(name: str) -> tuple[str, ...]:
    return tuple(part.strip().strip("\"'") for part in name.split("."))
