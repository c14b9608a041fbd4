"""Strict reading of a TOML text: every key is asked for, and what nobody asked for is an error.

`tomllib` knows no line numbers once it has parsed, so `find_lines` looks where each key stands.
"""

from __future__ import annotations

import difflib
import math
import re
import tomllib
from collections.abc import Mapping, Sequence
from typing import NoReturn, TypeVar

Path = tuple[str | int, ...]
"""Keys down to a value; the n-th table of an array is the int n."""

Word = TypeVar("Word", bound=str)

_HEADER = re.compile(r"\s*(\[\[?)\s*([^\[\]]+?)\s*\]\]?\s*$")
_KEY = re.compile(r"""\s*((?:[A-Za-z0-9_-]+|"[^"]*"|'[^']*')(?:\s*\.\s*[A-Za-z0-9_"'-]+)*)\s*=""")
_STRING = re.compile(r'"""|\'\'\'|"(?:\\.|[^"\\])*"|\'[^\']*\'')


class PolicyError(Exception):
    """What is wrong with a policy file, where, and what to do about it."""

    def __init__(self, file: str, line: int, key: str, what: str, hint: str = "") -> None:
        self.file, self.line, self.key, self.what, self.hint = file, line, key, what, hint
        super().__init__(file, line, key, what, hint)

    def __str__(self) -> str:
        where = f"{self.file}:{self.line}" if self.line else self.file
        return f"{where}: {self.key}: {self.what}" if self.key else f"{where}: {self.what}"


class Table:
    """One table of the file.  Ask for its keys, then say `done`."""

    def __init__(
        self, data: Mapping[str, object], path: Path, file: str, lines: Mapping[Path, int]
    ) -> None:
        self._data, self._path, self._file, self._lines = data, path, file, lines
        self._asked: list[str] = []

    def number(self, key: str, default: float, *, least: float, most: float = 1.0e5) -> float:
        value = self._get(key)
        return default if value is None else self._number(key, value, least, most)

    def number_or_none(self, key: str, default: float | None, *, least: float) -> float | None:
        """A number, or the word "none"."""
        value = self._get(key)
        if value is None or value == "none":
            return default if value is None else None
        return self._number(key, value, least, 1.0e5)

    def flag(self, key: str, default: bool) -> bool:
        value = self._get(key)
        if value is None:
            return default
        if not isinstance(value, bool):
            self.fail(key, f"{_shown(value)} is neither true nor false")
        return value

    def text(self, key: str, default: str | None) -> str:
        """Not empty; required where `default` is None."""
        value = self._get(key)
        if value is None:
            return self.missing(key) if default is None else default
        if not isinstance(value, str) or not value.strip():
            self.fail(key, f"{_shown(value)} is not a text", "write it in quotes")
        return value

    def word(self, key: str, default: Word, words: Sequence[Word]) -> Word:
        """One of `words`."""
        value = self._get(key)
        if value is None:
            return default
        found = next((word for word in words if word == value), None)
        if found is None:
            listed = ", ".join(words)
            self.fail(key, f"{_shown(value)} is none of: {listed}", _meant(str(value), words))
        return found

    def pair(self, key: str, default: tuple[float, float] | None) -> tuple[float, float]:
        """Two numbers; required where `default` is None."""
        value = self._get(key)
        if value is None:
            return self.missing(key) if default is None else default
        return self._pair(key, value)

    def pairs(self, key: str) -> tuple[tuple[float, float], ...]:
        value = self._get(key)
        if value is None:
            self.missing(key)
        if not isinstance(value, list):
            self.fail(key, f"{_shown(value)} is not a list of pairs", "such as [[0, 0], [5, 0]]")
        return tuple(self._pair(key, item) for item in value)

    def table(self, key: str) -> Table:
        """A table that is left out reads as an empty one."""
        value = self._get(key)
        if value is None:
            value = {}
        if not isinstance(value, dict):
            self.fail(key, "is a table", f"write it as [{self._name(key)}]")
        return Table(value, (*self._path, key), self._file, self._lines)

    def tables(self, key: str) -> list[Table]:
        value = self._get(key)
        if value is None:
            return []
        if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
            self.fail(key, "is a list of tables", f"write each as [[{self._name(key)}]]")
        return [
            Table(item, (*self._path, key, i), self._file, self._lines)
            for i, item in enumerate(value)
        ]

    def keys(self) -> list[str]:
        return list(self._data)

    def has(self, key: str) -> bool:
        return key in self._data

    def done(self) -> None:
        """Every key that nobody asked for is unknown."""
        for key in self._data:
            if key not in self._asked:
                self.fail(key, "unknown key", _meant(key, self._asked))

    def missing(self, key: str) -> NoReturn:
        raise PolicyError(self._file, self._line(), self._name(key), "is missing here")

    def fail(self, key: str, what: str, hint: str = "") -> NoReturn:
        raise PolicyError(self._file, self._line(key), self._name(key), what, hint)

    def _get(self, key: str) -> object:
        self._asked.append(key)
        return self._data.get(key)

    def _number(self, key: str, value: object, least: float, most: float) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float):
            self.fail(key, f"{_shown(value)} is not a number", "write it without quotes or unit")
        if not math.isfinite(value):
            self.fail(key, f"{_shown(value)} is not finite")
        if not least <= value <= most:
            self.fail(key, f"{value:g} is impossible", f"between {least:g} and {most:g}")
        return float(value)

    def _pair(self, key: str, value: object) -> tuple[float, float]:
        if not isinstance(value, list) or len(value) != 2:
            self.fail(key, f"{_shown(value)} is not a pair of numbers", "such as [-5, 5]")
        return (
            self._number(key, value[0], -1.0e6, 1.0e6),
            self._number(key, value[1], -1.0e6, 1.0e6),
        )

    def _line(self, key: str | None = None) -> int:
        """Of the key, else of the nearest thing around it that has a line."""
        path = self._path if key is None else (*self._path, key)
        while path and path not in self._lines:
            path = path[:-1]
        return self._lines.get(path, 1)

    def _name(self, key: str) -> str:
        shown = "".join(f"[{p + 1}]" if isinstance(p, int) else f".{p}" for p in (*self._path, key))
        return shown.lstrip(".")


def read(text: str, file: str) -> Table:
    """Raises PolicyError where the text is not TOML."""
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        found = re.search(r"\(at line (\d+)", str(error))
        line = int(found[1]) if found else len(text.splitlines())
        what = re.sub(r"\s*\(at .*\)$", "", str(error))
        raise PolicyError(file, line, "", f"not TOML: {what}") from None
    return Table(data, (), file, find_lines(text))


def find_lines(text: str) -> dict[Path, int]:
    """The line, from 1, of every table header and key of a TOML text that parses."""
    lines: dict[Path, int] = {}
    counts: dict[tuple[str, ...], int] = {}
    table: Path = ()
    depth, quotes = 0, ""
    for number, raw in enumerate(text.splitlines(), start=1):
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


def _note(lines: dict[Path, int], path: Path, number: int) -> None:
    """Where `path` stands, and whatever it is in that has no line of its own."""
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


def _table_path(is_item: bool, names: tuple[str, ...], counts: dict[tuple[str, ...], int]) -> Path:
    """Counts the tables of an array as they come; a name under one belongs to its last."""
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


def _meant(word: str, words: Sequence[str]) -> str:
    near = difflib.get_close_matches(word, words, n=1)
    return f"did you mean {near[0]}?" if near else f"known here: {', '.join(sorted(words))}"


def _shown(value: object) -> str:
    return f'"{value}"' if isinstance(value, str) else str(value)
