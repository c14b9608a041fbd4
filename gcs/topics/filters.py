"""Conditions on the fields of a message, as people type them: `z < -5 and abs(vx) > 1`.

The text is parsed by Python's own parser, and only what is named here is taken of it:
comparisons, `and or not in`, arithmetic, `abs min max len`, fields (`goal.up_m`,
`satellite_snr[3]`) and names of enum entries (`MAV_STATE_ACTIVE`).  Nothing is executed.
"""

from __future__ import annotations

import ast
import math
import operator
from collections.abc import Callable
from functools import cache
from typing import Any, TypeAlias

from gcs.topics.selector import SelectorError, no_such_field, value_at
from gcs.topics.topic import Fields, Topic, Value
from gcs.wire.dialect import ENUMS

MAX_TEXT = 1000
MAX_DEPTH = 60
_HINT = "such as 'z < -5' or 'system_status == MAV_STATE_ACTIVE'"

_Test: TypeAlias = Callable[["_Message"], Any]
"""One node of the expression.  `Any`, as fields have values of all kinds, ends in `Filter`."""

_BINARY: dict[type[ast.operator], Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Mod: operator.mod,
    ast.BitAnd: operator.and_,
    ast.BitOr: operator.or_,
}
_UNARY: dict[type[ast.unaryop], Callable[[Any], Any]] = {
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
    ast.Not: operator.not_,
}
_COMPARE: dict[type[ast.cmpop], Callable[[Any, Any], bool]] = {
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.In: lambda item, box: item in box,
    ast.NotIn: lambda item, box: item not in box,
}
_CALLS: dict[str, Callable[..., Any]] = {"abs": abs, "min": min, "max": max, "len": len}
_CONSTANTS: dict[str, Value] = {"nan": math.nan, "inf": math.inf, "true": True, "false": False}


class FilterError(ValueError):
    """The text is no condition, or names what the messages have not; `hint` helps."""

    def __init__(self, text: str, why: str, hint: str = _HINT) -> None:
        super().__init__(f"filter {text!r}: {why}")
        self.hint = hint


class _Message:
    """What a condition is asked about."""

    __slots__ = ("fields", "topic")

    def __init__(self, topic: Topic, fields: Fields) -> None:
        self.topic, self.fields = topic, fields


class Filter:
    """One condition; `filter(topic, fields)` says whether a message has it."""

    def __init__(self, text: str) -> None:
        """Raises FilterError."""
        self.text = text
        if len(text) > MAX_TEXT:
            raise FilterError(text[:20] + "...", f"is longer than {MAX_TEXT} characters")
        try:
            tree = ast.parse(text.strip(), mode="eval").body
        except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
            why = error.msg if isinstance(error, SyntaxError) else "cannot be read"
            raise FilterError(text, f"is no condition: {why}") from error
        self._test = self._compiled(tree, 0)

    def __call__(self, topic: Topic, fields: Fields) -> bool:
        """Raises FilterError for a field that messages of the topic never have."""
        try:
            return bool(self._test(_Message(topic, fields)))
        except (TypeError, ZeroDivisionError, OverflowError, ValueError) as error:
            if isinstance(error, FilterError):
                raise
            return False  # a value that is not there, or of another kind, meets no condition

    def _compiled(self, node: ast.expr, depth: int) -> _Test:
        if depth > MAX_DEPTH:
            raise FilterError(self.text, "is nested too deeply")
        deeper = depth + 1
        match node:
            case ast.BoolOp(op=ast.And(), values=values):
                parts = [self._compiled(each, deeper) for each in values]
                return lambda message: all(part(message) for part in parts)
            case ast.BoolOp(values=values):
                parts = [self._compiled(each, deeper) for each in values]
                return lambda message: any(part(message) for part in parts)
            case ast.UnaryOp(op=sign, operand=operand) if type(sign) in _UNARY:
                act, inner = _UNARY[type(sign)], self._compiled(operand, deeper)
                return lambda message: act(inner(message))
            case ast.BinOp(left=left, op=sign2, right=right) if type(sign2) in _BINARY:
                do = _BINARY[type(sign2)]
                first, second = self._compiled(left, deeper), self._compiled(right, deeper)
                return lambda message: do(_number(first(message)), _number(second(message)))
            case ast.Compare():
                return self._comparison(node, deeper)
            case ast.Call(func=ast.Name(id=name), args=args, keywords=[]) if name in _CALLS:
                call, given = _CALLS[name], [self._compiled(each, deeper) for each in args]
                return lambda message: call(*[each(message) for each in given])
            case ast.Constant(value=bool() | int() | float() | str() as value):
                return lambda _message: value
            case ast.List(elts=elements) | ast.Tuple(elts=elements):
                items = [self._compiled(each, deeper) for each in elements]
                return lambda message: [item(message) for item in items]
            case ast.Name() | ast.Attribute() | ast.Subscript():
                return self._field(node)
            case _:
                raise FilterError(self.text, f"{ast.unparse(node)!r} is not taken in a condition")

    def _comparison(self, node: ast.Compare, depth: int) -> _Test:
        sides = [self._compiled(each, depth) for each in (node.left, *node.comparators)]
        signs = [type(sign) for sign in node.ops]
        if not all(sign in _COMPARE for sign in signs):
            raise FilterError(self.text, f"{ast.unparse(node)!r} is no comparison of values")
        tests = [_COMPARE[sign] for sign in signs]

        def compare(message: _Message) -> bool:
            values = [side(message) for side in sides]
            return all(test(a, b) for test, a, b in zip(tests, values, values[1:], strict=False))

        return compare

    def _field(self, node: ast.expr) -> _Test:
        path: list[str | int] = []
        while not isinstance(node, ast.Name):
            match node:
                case ast.Attribute(value=before, attr=name):
                    path.insert(0, name)
                    node = before
                case ast.Subscript(value=before, slice=ast.Constant(value=int(index))):
                    path.insert(0, index)
                    node = before
                case _:
                    raise FilterError(self.text, f"{ast.unparse(node)!r} is no field")
        path.insert(0, node.id)
        whole = tuple(path)
        constant = _constant(node.id) if len(whole) == 1 else None

        def look(message: _Message) -> Value:
            fields, topic = message.fields, message.topic
            steps = whole
            # `m.z` (rostopic's habit) and `LOCAL_POSITION_NED.z` are `z`.
            if len(steps) > 1 and steps[0] not in fields and steps[0] in ("m", topic.message):
                steps = steps[1:]
            if steps[0] not in fields:
                if constant is not None:
                    return constant
                if not topic.is_mavlink:
                    return None  # what is not known is left out of the JSON topics
            try:
                return value_at(fields, steps, topic.message)
            except SelectorError as error:
                if steps[0] in fields:
                    return None
                missing = no_such_field(topic.message, str(steps[0]), list(fields))
                raise FilterError(self.text, str(missing), missing.hint) from error

        return look


def _constant(name: str) -> Value:
    return _CONSTANTS.get(name.lower(), _entries().get(name))


@cache
def _entries() -> dict[str, int]:
    return {entry.name: entry.value for enum in ENUMS.values() for entry in enum.entries}


def _number(value: Any) -> Any:
    """Arithmetic is for numbers: a text times a billion would take all memory."""
    if not isinstance(value, int | float):
        raise TypeError("no number")
    return value
