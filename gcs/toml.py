"""TOML files read into typed values; every error names file, line, key and what to do.

`msgspec` judges types and limits (`Document.convert`).  Its own messages know neither lines nor
alternatives, so a refused value is looked up in the file and described here.
"""

from __future__ import annotations

import difflib
import math
import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from types import NoneType, UnionType
from typing import Annotated, Literal, NamedTuple, TypeVar, Union, get_args, get_origin

import msgspec
from msgspec import inspect, structs

from gcs.toml_lines import KeyPath, find_lines

T = TypeVar("T")

TOML_HINT = "each key once, as KEY = VALUE, under its [table]; see https://toml.io"
WORDS_LISTED = 20
"""More than these are no hint but a page."""
_PAIR, _PAIRS = "[-5, 5]", "[[0, 0], [5, 0], [5, 5]]"


class TomlError(Exception):
    """What is wrong with a TOML file, where, and what to do about it.

    `line` counts from 1; 0 where it is not known.  `key` is the dotted path, empty for the whole
    file; elements of arrays count from 1: `fence[2].radius_m`.
    """

    def __init__(self, file: str, line: int, key: str, what: str, hint: str = "") -> None:
        self.file, self.line, self.key, self.what, self.hint = file, line, key, what, hint
        super().__init__(file, line, key, what, hint)

    def __str__(self) -> str:
        where = f"{self.file}:{self.line}" if self.line else self.file
        return f"{where}: {self.key}: {self.what}" if self.key else f"{where}: {self.what}"


@dataclass(frozen=True, slots=True)
class Document:
    """A file that is TOML: its values, and the line of every key."""

    file: str
    data: dict[str, object]
    lines: Mapping[KeyPath, int]

    def convert(self, kind: type[T], value: object, at: KeyPath = ()) -> T:
        """`value`, which stands at `at` in this file, as a `kind`.

        Raises TomlError about the first thing in it that does not fit.
        """
        try:
            return msgspec.convert(value, kind)
        except msgspec.ValidationError as error:
            wrong = _explain(value, kind, at) or _Wrong(at, str(error))
            raise self.error(*wrong) from None

    def error(self, at: KeyPath, what: str, hint: str = "") -> TomlError:
        """An error about the key at `at`."""
        return TomlError(self.file, self.line(at), dotted(at), what, hint)

    def unknown(self, at: KeyPath, known: Iterable[str]) -> TomlError:
        """An error about a key that is not one of `known`."""
        return self.error(at, "unknown key", did_you_mean(str(at[-1]), known))

    def has(self, at: KeyPath) -> bool:
        """Whether the file itself says something about the keys `at`, which lead through tables."""
        value: object = self.data
        for key in at:
            if not (isinstance(value, dict) and key in value):
                return False
            value = value[key]
        return True

    def line(self, at: KeyPath) -> int:
        """Of the key, else of the nearest table around it that has a line, else the first."""
        while at and at not in self.lines:
            at = at[:-1]
        return self.lines.get(at, 1)


def decode(data: bytes, file: str) -> str:
    """The text of a file; raises TomlError where it is not UTF-8."""
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        if b"\0" in data:
            raise TomlError(file, 0, "", "is no text", "a TOML file is wanted") from None
        raise TomlError(file, line, "text", "is not UTF-8") from None


def read(text: str, file: str) -> Document:
    """Parse; `file` is what errors call it.  Raises TomlError where the text is not TOML."""
    try:
        return Document(file, tomllib.loads(text), find_lines(text))
    except tomllib.TOMLDecodeError as error:
        found = re.search(r"\(at line (\d+)", str(error))
        line = int(found[1]) if found else len(text.splitlines())
        what = re.sub(r"\s*\(at .*\)$", "", str(error))
        raise TomlError(file, line, "", f"not TOML: {what}", TOML_HINT) from None
    except (ValueError, RecursionError) as error:
        # A number of thousands of digits, or arrays that are nested thousands deep.
        raise TomlError(file, 0, "", f"not TOML that can be read: {error}", TOML_HINT) from None


def dotted(at: KeyPath) -> str:
    """`("fence", 0, "name")` as people write it: `fence[1].name`."""
    shown = "".join(f"[{part + 1}]" if isinstance(part, int) else f".{part}" for part in at)
    return shown.lstrip(".")


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """A hint: the known word that is most like `word`, or all known words, or a few of many."""
    words = sorted(known)
    near = difflib.get_close_matches(word, words, n=1)
    if near:
        return f"did you mean {near[0]}?"
    if len(words) <= WORDS_LISTED:
        return f"known here: {', '.join(words)}"
    like = difflib.get_close_matches(word, words, n=3, cutoff=0.3) or words[:3]
    return f"known here are {len(words)} keys, such as {', '.join(like)}"


def none_of(value: object, words: Iterable[str]) -> tuple[str, str]:
    """What is wrong with a value that is not one of `words`, and a hint."""
    listed = list(words)
    near = difflib.get_close_matches(str(value), listed, n=1)
    hint = f"did you mean {near[0]}?" if near else "write one of them"
    return f"{shown(value)} is none of: {', '.join(listed)}", hint


# ------------------------------------------------------------- what does not fit, in words


class _Wrong(NamedTuple):
    at: KeyPath
    what: str
    hint: str = ""


def _explain(value: object, kind: object, at: KeyPath) -> _Wrong | None:
    """The first thing in `value` that does not fit `kind`; None if all of it fits."""
    try:
        msgspec.convert(value, kind)
        return None
    except msgspec.ValidationError:
        kind = _wanted(kind)
    origin, args = get_origin(kind), get_args(kind)
    if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
        return _explain_table(value, kind, at)
    if origin is tuple and args[-1] is ...:
        return _explain_array(value, args[0], at)
    if origin is tuple:
        return _explain_pair(value, args, at)
    if isinstance(origin, type) and issubclass(origin, Mapping):
        if not isinstance(value, dict):
            return _Wrong(at, "is a table", f"write it as [{dotted(at)}]")
        return _first(_explain(entry, args[1], (*at, key)) for key, entry in value.items())
    return _Wrong(at, *_explain_single(value, kind))


def _wanted(kind: object) -> object:
    """Without the `None` of an optional value, which no file can say, and without limits on the
    length of an array."""
    if get_origin(kind) in (Union, UnionType):
        kind = next(member for member in get_args(kind) if member is not NoneType)
    return get_args(kind)[0] if _is_array(kind) and get_origin(kind) is Annotated else kind


def _is_array(kind: object) -> bool:
    if get_origin(kind) is Annotated:
        kind = get_args(kind)[0]
    return get_origin(kind) is tuple


def _first(found: Iterable[_Wrong | None]) -> _Wrong | None:
    return next((wrong for wrong in found if wrong is not None), None)


def _explain_table(value: object, kind: type[msgspec.Struct], at: KeyPath) -> _Wrong | None:
    if not isinstance(value, dict):
        return _Wrong(at, "is a table", f"write it as [{dotted(at)}]")
    fields = structs.fields(kind)
    tag = kind.__struct_config__.tag_field
    known = [field.encode_name for field in fields] + ([tag] if tag else [])
    unknown = [key for key in value if key not in known]
    for field in fields:
        name = field.encode_name
        if name in value:
            wrong = _explain(value[name], field.type, (*at, name))
            if wrong is not None:
                return wrong
        elif field.required:
            return _Wrong((*at, name), "is missing", _missing_hint(name, field.type, unknown))
    return _Wrong((*at, unknown[0]), "unknown key", did_you_mean(unknown[0], known))


def _missing_hint(name: str, kind: object, unknown: list[str]) -> str:
    near = difflib.get_close_matches(name, unknown, n=1)
    if near:
        return f"`{near[0]}` is unknown here: did you mean {name}?"
    kind = _wanted(kind)
    if get_origin(kind) is tuple:
        args = get_args(kind)
        if _is_table(args[0]):
            return f"write at least one [[{name}]]"
        return f"such as {name} = {_PAIRS if args[-1] is ... else _PAIR}"
    if get_origin(kind) is Literal:
        return f'{name} = "{get_args(kind)[0]}"'
    number = isinstance(inspect.type_info(kind), inspect.FloatType)
    return f"{name} = a number" if number else f'{name} = "..."'


def _is_table(kind: object) -> bool:
    kind = get_origin(kind) or kind
    return isinstance(kind, type) and issubclass(kind, msgspec.Struct | Mapping)


def _explain_array(value: object, element: object, at: KeyPath) -> _Wrong | None:
    tables = _is_table(element)
    if not isinstance(value, list) or (tables and not all(isinstance(v, dict) for v in value)):
        if tables:
            return _Wrong(at, "is a list of tables", f"write each as [[{dotted(at)}]]")
        if isinstance(inspect.type_info(element), inspect.StrType):
            return _Wrong(at, f"{shown(value)} is not a list of texts", f'such as ["{value}"]')
        return _Wrong(at, f"{shown(value)} is not a list of pairs", f"such as {_PAIRS}")
    found = (_explain(entry, element, (*at, number)) for number, entry in enumerate(value))
    return _first(found) or _Wrong(at, f"has {len(value)} entries, which is too few")


def _explain_pair(value: object, members: tuple[object, ...], at: KeyPath) -> _Wrong | None:
    if not isinstance(value, list) or len(value) != len(members):
        return _Wrong(at, f"{shown(value)} is not a pair of numbers", f"such as {_PAIR}")
    found = (_explain(*both, at) for both in zip(value, members, strict=True))
    return _first(found)


def _explain_single(value: object, kind: object) -> tuple[str, str]:
    if get_origin(kind) is Literal:
        return none_of(value, get_args(kind))
    match inspect.type_info(kind):
        case inspect.FloatType(ge=least, le=most):
            return _explain_number(value, least, most)
        case inspect.BoolType():
            return f"{shown(value)} is neither true nor false", ""
        case inspect.IntType(ge=least, le=most):
            if isinstance(value, float) and math.isfinite(value):
                return f"{value:g} is not a whole number", f"between {least} and {most}"
            return _explain_number(value, least, most)
        case _:
            return f"{shown(value)} is not a text", "write it in quotes"


def _explain_number(value: object, least: float | None, most: float | None) -> tuple[str, str]:
    if isinstance(value, bool):
        return f"{shown(value)} is not a number", ""
    if not isinstance(value, int | float):
        return f"{shown(value)} is not a number", "write it without quotes or unit"
    limits = f"between {least:g} and {most:g}"
    try:
        number = float(value)
    except OverflowError:
        return "the number is too large", limits
    if not math.isfinite(number):
        return f"{number} is not finite", limits
    return f"{number:g} is impossible", limits


def shown(value: object) -> str:
    """A value as errors quote it."""
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else str(value)
