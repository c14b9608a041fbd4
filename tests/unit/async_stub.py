"""`gcs/operator/async_station.pyi`: the types of the library for asyncio, made of its classes.

Run: python -m tests.unit.async_stub, which writes it anew.
"""

from __future__ import annotations

import ast
import builtins
import inspect
import subprocess
import sys
import textwrap
from collections.abc import Callable, Iterator
from pathlib import Path

from gcs.operator.async_proxy import Kind, members_of
from gcs.operator.connect import connect
from gcs.operator.operation import Operation
from gcs.operator.station import Station
from gcs.operator.stream import Stream

STUB = Path(__file__).parents[2] / "gcs" / "operator" / "async_station.pyi"
HEAD = '''"""Made by `python -m tests.unit.async_stub`: the types of `async_station.py`."""

'''
CLASSES = {Operation: "AsyncOperation", Stream: "AsyncStream", Station: "AsyncStation"}
RENAMED = {
    **{kind.__name__: name for kind, name in CLASSES.items()},
    "Iterator": "AsyncIterator",
}
CONNECTING = """
class Connecting:
    def __await__(self) -> Generator[object, None, AsyncStation]: ...
    async def __aenter__(self) -> AsyncStation: ...
    async def __aexit__(self, *_: object) -> None: ...
"""


class Stub(ast.NodeTransformer):
    """Turns a function that waits into what the stub says of it, and notes what it must import."""

    def __init__(self) -> None:
        self.imports = {"from collections.abc import AsyncIterator, Generator"}

    def function(self, function: Callable[..., object], kind: Kind, name: str = "") -> str:
        (node,) = ast.parse(textwrap.dedent(inspect.getsource(function))).body
        assert isinstance(node, ast.FunctionDef)
        given = node.args
        for annotated in (*given.args, *given.kwonlyargs):
            if annotated.annotation is not None:
                annotated.annotation = self._annotation(annotated.annotation, function)
        returns = self._annotation(node.returns, function) if node.returns else None
        if name:
            returns = ast.Name("Connecting")
        given.defaults = [_default(each) for each in given.defaults]
        given.kw_defaults = [each and _default(each) for each in given.kw_defaults]
        made = (ast.AsyncFunctionDef if kind is Kind.AWAITED else ast.FunctionDef)(
            name=name or node.name,
            args=given,
            body=[ast.Expr(ast.Constant(...))],
            decorator_list=[ast.Name("property")] if kind is Kind.PROPERTY else [],
            returns=returns,
        )
        return ast.unparse(ast.fix_missing_locations(made))

    def _annotation(self, annotation: ast.expr, function: Callable[..., object]) -> ast.expr:
        for node in ast.walk(annotation):
            if isinstance(node, ast.Name) and node.id in RENAMED:
                node.id = RENAMED[node.id]
            elif isinstance(node, ast.Name) and not hasattr(builtins, node.id):
                self.imports.add(_import_of(node.id, function.__module__))
        return annotation


def _default(value: ast.expr) -> ast.expr:
    return value if isinstance(value, ast.Constant | ast.UnaryOp) else ast.Constant(...)


def _import_of(name: str, module: str) -> str:
    """As the module does it, else from there."""
    tree = ast.parse(inspect.getsource(sys.modules[module]))
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and name in [each.name for each in node.names]:
            return f"from {node.module} import {name}"
    return f"from {module} import {name}"


def _classes(stub: Stub) -> Iterator[str]:
    for kind, name in CLASSES.items():
        yield f"\nclass {name}:\n"
        if hasattr(kind, "__enter__"):
            yield f"    async def __aenter__(self) -> {name}: ...\n"
            yield "    async def __aexit__(self, *_: object) -> None: ...\n"
        for _, shape, function in members_of(kind):
            yield textwrap.indent(stub.function(function, shape), "    ") + "\n"
    yield CONNECTING
    yield "\n" + stub.function(connect, Kind.AT_ONCE, "aconnect") + "\n"


def text() -> str:
    """The stub, before `ruff format`."""
    stub = Stub()
    classes = "".join(_classes(stub))
    return HEAD + "\n".join(sorted(stub.imports)) + "\n" + classes


if __name__ == "__main__":
    STUB.write_text(text(), encoding="utf-8")
    for command in (["check", "--select", "I", "--fix", "--quiet"], ["format", "--quiet"]):
        subprocess.run([sys.executable, "-m", "ruff", *command, str(STUB)], check=True)
