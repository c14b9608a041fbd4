"""Kernels over many vehicles at once: the same source, with numpy rows in place of floats.

See `kernel.py` for what a kernel is.  Importing numpy takes a third of a vehicle's start, so only
fleets import this module.
"""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable
from dataclasses import fields
from typing import Any, Final, Generic, ParamSpec, TypeVar, cast

import numpy as np
import numpy.typing as npt

from vehicle_sim.numerics.kernel import anywhere

B = TypeVar("B")
P = ParamSpec("P")
R = TypeVar("R")

_DTYPES: Final[dict[str, type[np.generic]]] = {
    "float": np.float64,
    "int": np.uint64,
    "bool": np.bool_,
}
_BATCHED: Final[dict[Callable[..., object], Callable[..., object]]] = {}


class Lanes(Generic[B]):
    """`count` blocks side by side: every field is a row, every vehicle a column."""

    def __init__(self, block: type[B], count: int) -> None:
        rows: dict[str, memoryview] = {}
        fresh = block()
        for field in fields(cast(Any, block)):
            value = getattr(fresh, field.name)
            row: npt.NDArray[Any] = np.full(count, value, dtype=_DTYPES[str(field.type)])
            setattr(self, field.name, row)
            rows[field.name] = row.data
        self._lane = _lane_class(block, rows)

    @property
    def all(self) -> B:
        """The batch in the eyes of the type checker, for batched kernels."""
        return cast(B, self)

    def lane(self, index: int) -> B:
        """One vehicle's block: reads and writes go to its column."""
        return cast(B, self._lane(index))


def _lane_class(block: type[object], rows: dict[str, memoryview]) -> Callable[[int], object]:
    def window(row: memoryview) -> property:
        def get(self: Any) -> Any:
            return row[self._index]

        def put(self: Any, value: Any) -> None:
            row[self._index] = value

        return property(get, put)

    def begin(self: Any, index: int) -> None:
        self._index = index

    members: dict[str, object] = {name: window(row) for name, row in rows.items()}
    members["__slots__"] = ("_index",)
    members["__init__"] = begin
    return type(f"{block.__name__}Lane", (), members)


def batched(function: Callable[P, R]) -> Callable[P, R]:
    """The kernel over `Lanes`: the same source, rewritten once."""
    known = _BATCHED.get(function)
    if known is None:
        known = _BATCHED[function] = _compile(function)
    return cast(Callable[P, R], known)


def _compile(function: Callable[..., object]) -> Callable[..., object]:
    source = textwrap.dedent(inspect.getsource(function))
    names = function.__globals__
    tree = _Batch({name for name in names if _is_kernel(names[name])}).visit(ast.parse(source))
    ast.increment_lineno(tree, function.__code__.co_firstlineno - 1)
    definition = tree.body[0]
    definition.decorator_list = []
    definition.returns = None
    for argument in definition.args.args:
        argument.annotation = None
    ast.fix_missing_locations(tree)
    space: dict[str, Any] = {
        name: batched(value) if _is_kernel(value) else value
        for name, value in names.items()
        if name in function.__code__.co_names
    }
    space |= {"sqrt": np.sqrt, "anywhere": _anywhere}
    space |= {"_where": np.where, "_keep": _keep, "_float": _float}
    exec(compile(tree, inspect.getfile(function), "exec"), space)
    return cast(Callable[..., object], space[function.__name__])


def _is_kernel(value: object) -> bool:
    """What may be called: functions of Python, of which `anywhere` is written anew here."""
    return inspect.isfunction(value) and value is not anywhere


def _anywhere(condition: npt.NDArray[np.bool_]) -> bool:
    return bool(np.any(condition))


def _keep(value: object) -> object:
    """A row under a local name must not change when its field is written later."""
    return value.copy() if isinstance(value, np.ndarray) else value


def _float(value: npt.NDArray[np.uint64]) -> npt.NDArray[np.float64]:
    return value.astype(np.float64)


class _Batch(ast.NodeTransformer):
    """Python's words for one value into numpy's for many."""

    def __init__(self, kernels: set[str]) -> None:
        """By what names other kernels are called."""
        self._known = kernels | {"sqrt", "anywhere", "float"}

    def visit_IfExp(self, node: ast.IfExp) -> ast.expr:
        self.generic_visit(node)
        return _call("_where", node.test, node.body, node.orelse)

    def visit_BoolOp(self, node: ast.BoolOp) -> ast.expr:
        self.generic_visit(node)
        sign: ast.operator = ast.BitAnd() if isinstance(node.op, ast.And) else ast.BitOr()
        whole = node.values[0]
        for value in node.values[1:]:
            whole = ast.BinOp(whole, sign, value)
        return whole

    def visit_UnaryOp(self, node: ast.UnaryOp) -> ast.expr:
        self.generic_visit(node)
        return ast.UnaryOp(ast.Invert(), node.operand) if isinstance(node.op, ast.Not) else node

    def visit_Compare(self, node: ast.Compare) -> ast.expr:
        self.generic_visit(node)
        if len(node.ops) > 1:
            raise SyntaxError("a chained comparison cannot be batched; write `and`")
        return node

    def visit_Call(self, node: ast.Call) -> ast.expr:
        self.generic_visit(node)
        called = ast.unparse(node.func)
        if called in ("min", "max"):
            raise SyntaxError(f"{called}() cannot be batched; write a if c else b")
        if called == "float":
            return _call("_float", *node.args)
        if called not in self._known:
            raise SyntaxError(f"{called}() cannot be batched: it is no kernel")
        return node

    def visit_Assign(self, node: ast.Assign) -> ast.stmt:
        self.generic_visit(node)
        node.value = _kept(node.value)
        node.targets = [_in_place(target) for target in node.targets]
        return node

    def visit_AugAssign(self, node: ast.AugAssign) -> ast.stmt:
        self.generic_visit(node)
        old = ast.parse(ast.unparse(node.target), mode="eval").body
        return ast.Assign([_in_place(node.target)], ast.BinOp(old, node.op, node.value))

    def visit_Return(self, node: ast.Return) -> ast.stmt:
        self.generic_visit(node)
        if node.value is not None:
            node.value = _kept(node.value)
        return node


def _call(name: str, *arguments: ast.expr) -> ast.expr:
    return ast.Call(ast.Name(name, ast.Load()), list(arguments), [])


def _kept(value: ast.expr) -> ast.expr:
    if isinstance(value, ast.Tuple):
        value.elts = [_kept(part) for part in value.elts]
        return value
    return _call("_keep", value) if isinstance(value, ast.Attribute) else value


def _in_place(target: ast.expr) -> ast.expr:
    if isinstance(target, ast.Tuple):
        target.elts = [_in_place(part) for part in target.elts]
        return target
    if isinstance(target, ast.Attribute):
        row = ast.Attribute(target.value, target.attr, ast.Load())
        return ast.Subscript(row, ast.Slice(), ast.Store())
    return target
