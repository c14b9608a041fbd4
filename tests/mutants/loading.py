"""Makes one module of the package under test another one, before anything imports it."""

from __future__ import annotations

import ast
import importlib
import sys
from collections.abc import Callable, Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from itertools import islice
from pathlib import Path
from types import CodeType, ModuleType

from tests.mutants.mutant import Kind, Mutant
from tests.mutants.settings import altered_settings
from tests.mutants.source import Enums, altered
from tests.mutants.targets import Target, ValueTable


class _AlteredSource(SourceFileLoader):
    """Compiles another tree in the place of the file's own text, and leaves no cache behind."""

    def __init__(self, name: str, path: str, tree: ast.Module) -> None:
        super().__init__(name, path)
        self._tree = tree

    def get_code(self, fullname: str) -> CodeType:
        return compile(self._tree, self.path, "exec", dont_inherit=True)


class _AlteredValue(SourceFileLoader):
    """Runs the module, and then puts another value in the place of one of its own."""

    def __init__(self, name: str, path: str, attribute: str, change: Change) -> None:
        super().__init__(name, path)
        self._attribute, self._change = attribute, change

    def exec_module(self, module: ModuleType) -> None:
        super().exec_module(module)
        setattr(module, self._attribute, self._change(getattr(module, self._attribute)))


Change = Callable[[object], object]


class _Finder(MetaPathFinder):
    def __init__(self, name: str, make: Callable[[str], SourceFileLoader]) -> None:
        self._name, self._make = name, make

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname != self._name:
            return None
        spec = PathFinder.find_spec(fullname, path)
        if spec is not None and spec.origin is not None:
            spec.loader = self._make(spec.origin)
        return spec


def change_value(table: ValueTable, change: Change) -> None:
    """From now on, importing the table's module gives it the changed value."""
    name = table.module

    def make(path: str) -> SourceFileLoader:
        return _AlteredValue(name, path, table.attribute, change)

    sys.meta_path.insert(0, _Finder(name, make))


def change_text(file: Path, number: int) -> None:
    """From now on, reading the settings file gives the altered text."""
    changed, read_text = altered_settings(file, number), Path.read_text

    def read(self: Path, encoding: str | None = None, errors: str | None = None) -> str:
        return changed if self.resolve() == file else read_text(self, encoding, errors)

    Path.read_text = read  # type: ignore[method-assign]


def load_altered(target: Target, mutant: Mutant, enums: Enums) -> None:
    """From now on, importing the mutant's module, or reading its file, gives the altered one."""
    assert mutant.module not in sys.modules, f"{mutant.module} is imported already"
    if mutant.kind is Kind.SETTING:
        change_text(target.root / mutant.file, mutant.number)
        return
    if mutant.table is not None:
        table = target.tables[mutant.table]
        change_value(table, lambda value: nth(table, mutant.number)(value))
        return
    tree = altered(target.root / mutant.file, mutant.number, enums)
    sys.meta_path.insert(
        0, _Finder(mutant.module, lambda path: _AlteredSource(mutant.module, path, tree))
    )


def nth(table: ValueTable, number: int) -> Change:
    """The table's alteration of that number."""

    def change(value: object) -> object:
        made = importlib.import_module(table.alterations).alterations(value)
        changed: object = next(islice(made, number, None)).apply(value)
        return changed

    return change
