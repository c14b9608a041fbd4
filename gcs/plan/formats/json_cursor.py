"""A place in a JSON document that knows its path, so that every error can name it."""

from __future__ import annotations

import json
import math
from typing import TypeAlias

from gcs.plan.errors import PlanError

Json: TypeAlias = "bool | int | float | str | list[Json] | dict[str, Json] | None"


class _DuplicateKeyError(ValueError):
    """A key that stands twice in one object: JSON allows it, and readers differ in which value
    they keep."""


def _unique(pairs: list[tuple[str, Json]]) -> dict[str, Json]:
    keys = dict(pairs)
    if len(keys) != len(pairs):
        names = [key for key, _ in pairs]
        raise _DuplicateKeyError(next(key for key in names if names.count(key) > 1))
    return keys


def _no_constant(token: str) -> Json:
    raise ValueError(f"{token} is no JSON (unset values are null)")


def parse(file: str, data: bytes) -> Node:
    """Raises PlanError with the line where the text stops being JSON."""
    try:
        text = data.decode("utf-8-sig")
        value = json.loads(text, object_pairs_hook=_unique, parse_constant=_no_constant)
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise PlanError(file, str(line), "text", "is not UTF-8") from None
    except json.JSONDecodeError as error:
        where = f"{error.lineno}:{error.colno}"
        raise PlanError(file, where, "JSON", error.msg.lower(), hint="is the file whole?") from None
    except _DuplicateKeyError as error:
        raise PlanError(file, "", str(error), "the key stands twice in one object") from None
    except ValueError as error:
        raise PlanError(file, "", "JSON", str(error)) from None
    except RecursionError:
        raise PlanError(file, "", "JSON", "is nested too deeply") from None
    return Node(file, "", value)


class Node:
    """One value and where it stands.  Every reading method raises PlanError if it does not fit."""

    __slots__ = ("_value", "file", "path")

    def __init__(self, file: str, path: str, value: Json) -> None:
        self.file = file
        self.path = path
        self._value = value

    @property
    def is_null(self) -> bool:
        return self._value is None

    def error(self, what: str, expected: str = "", hint: str = "") -> PlanError:
        leaf = self.path.rpartition(".")[2] or "file"
        return PlanError(self.file, self.path, leaf, what, expected, hint)

    def _wrong(self, expected: str) -> PlanError:
        shown = json.dumps(self._value)
        return self.error(f"is {shown if len(shown) <= 40 else shown[:37] + '...'}", expected)

    def _object(self) -> dict[str, Json]:
        if not isinstance(self._value, dict):
            raise self._wrong("an object")
        return self._value

    def find(self, key: str) -> Node | None:
        """The member of that name, None where it is missing or null."""
        value = self._object().get(key)
        return None if value is None else self._child(key, value)

    def get(self, key: str, hint: str = "") -> Node:
        """The member of that name, which must be there (null will do)."""
        members = self._object()
        if key not in members:
            raise self._child(key, None).error("is missing", hint=hint)
        return self._child(key, members[key])

    def _child(self, key: str, value: Json) -> Node:
        return Node(self.file, f"{self.path}.{key}" if self.path else key, value)

    def items(self, count: int | None = None) -> list[Node]:
        """The elements of a list, of `count` elements if given."""
        if not isinstance(self._value, list):
            raise self._wrong("a list" if count is None else f"a list of {count}")
        if count is not None and len(self._value) != count:
            raise self.error(f"has {len(self._value)} elements", str(count))
        return [Node(self.file, f"{self.path}[{i}]", v) for i, v in enumerate(self._value)]

    def number(self, low: float = -math.inf, high: float = math.inf) -> float:
        """Finite, within [low, high]."""
        value = self._value
        expected = "a number" if high == math.inf else f"a number from {low:g} to {high:g}"
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self._wrong(expected)
        try:
            number = float(value)
        except OverflowError:
            raise self._wrong(expected) from None
        if not math.isfinite(number) or not low <= number <= high:
            raise self._wrong(expected)
        return number

    def number_or_unset(self) -> float:
        """As `number`, and null as NaN."""
        return math.nan if self._value is None else self.number()

    def integer(self, low: int = 0, high: int = 2**31 - 1) -> int:
        """A whole number within [low, high]; 3.0 is one."""
        number = self.number(low, high)
        if number != int(number):
            raise self._wrong("a whole number")
        return int(number)

    def boolean(self) -> bool:
        if not isinstance(self._value, bool):
            raise self._wrong("true or false")
        return self._value

    def text(self) -> str:
        if not isinstance(self._value, str):
            raise self._wrong("a text")
        return self._value

    def version(self, *supported: int, hint: str = "") -> int:
        """The member `version`, which must be one of `supported`."""
        node = self.get("version")
        told = " or ".join(str(number) for number in supported)
        if isinstance(node._value, bool) or node._value not in supported:
            wrong = node._wrong(told)
            raise node.error(wrong.what, told, hint)
        return node.integer()
