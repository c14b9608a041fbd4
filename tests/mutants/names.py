"""Which lines, and which test files, use a name that is defined outside functions: its value is
altered at import.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

Line = tuple[str, int]


class Uses:
    """Over all files of a package.  A name is taken for the same one wherever it is written."""

    def __init__(self, sources: Sequence[Path], root: Path) -> None:
        self._lines: dict[str, set[Line]] = {}
        self._passed_on: dict[str, set[str]] = {}
        for path in sources:
            file = path.relative_to(root).as_posix()
            self._read(ast.parse(path.read_text(encoding="utf-8")).body, file)

    def of(self, names: Sequence[str]) -> list[Line]:
        """Lines in functions that use one of `names`, or what is made of them elsewhere."""
        known = self.made_of(names)
        return sorted(line for name in known for line in self._lines.get(name, ()))

    def made_of(self, names: Sequence[str]) -> set[str]:
        """`names`, and those that are defined by them elsewhere."""
        known, waiting = set(names), list(names)
        while waiting:
            for name in self._passed_on.get(waiting.pop(), set()) - known:
                known.add(name)
                waiting.append(name)
        return known

    def _read(self, body: Sequence[ast.stmt], file: str) -> None:
        for statement in body:
            if isinstance(statement, ast.ClassDef):
                self._read(statement.body, file)
            elif isinstance(statement, ast.FunctionDef):
                self._note(statement, file)
            elif not isinstance(statement, ast.Import | ast.ImportFrom):
                for node in ast.walk(statement):
                    if isinstance(node, ast.Lambda):
                        self._note(node, file)
                made = set(_defined(statement))
                for name in _used(statement):
                    self._passed_on.setdefault(name, set()).update(made - {name})

    def _note(self, code: ast.FunctionDef | ast.Lambda, file: str) -> None:
        for node in ast.walk(code):
            for name in _used(node, deep=False):
                self._lines.setdefault(name, set()).add(
                    (file, getattr(node, "lineno", code.lineno))
                )


class Mentions:
    """Which test files write a name, or import a file of the tests that does.

    A test that looks at a table itself runs none of the lines that read it.
    """

    def __init__(self, files: Sequence[Path], root: Path) -> None:
        trees = {
            path.relative_to(root).as_posix(): ast.parse(path.read_text(encoding="utf-8"))
            for path in files
        }
        self._names = {file: set(_used(tree)) for file, tree in trees.items()}
        for file, tree in trees.items():
            for imported in _imported(tree):
                self._names[file] |= set(_used(trees[imported])) if imported in trees else set()

    def of(self, names: Iterable[str]) -> set[str]:
        """Files that write one of them, from the root on."""
        wanted = set(names)
        return {file for file, written in self._names.items() if wanted & written}


def _imported(tree: ast.Module) -> Iterator[str]:
    """Files that an import may mean: of `from a import b` both a and a/b."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module:
            folder = node.module.replace(".", "/")
            yield f"{folder}.py"
            yield from (f"{folder}/{each.name}.py" for each in node.names)


def _defined(statement: ast.stmt) -> Iterator[str]:
    targets = statement.targets if isinstance(statement, ast.Assign) else []
    if isinstance(statement, ast.AnnAssign):
        targets = [statement.target]
    for target in targets:
        yield from (n.id for n in ast.walk(target) if isinstance(n, ast.Name))


def _used(code: ast.AST, *, deep: bool = True) -> Iterator[str]:
    for node in ast.walk(code) if deep else (code,):
        match node:
            case ast.Name(id=name) | ast.Attribute(attr=name) | ast.keyword(arg=str(name)):
                yield name
            case ast.alias(name=name):
                yield name
            case _:
                pass
