"""`messages.py` and `ids.py` are what the generator writes, and hold nothing that is not used."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

import pytest

import gcs
from gcs.wire import generate, selection
from gcs.wire.dialect import FieldDef, MessageDef
from gcs.wire.messages import CLASSES

PACKAGE = Path(gcs.__file__).parent


@pytest.mark.parametrize("path", generate.files(), ids=lambda path: path.name)
def test_a_generated_file_is_up_to_date(path: Path) -> None:
    current = path.read_text(encoding="utf-8")
    assert current == generate.files()[path], "run `make messages`"


Nodes = list[ast.AST]


@cache
def nodes() -> list[tuple[Path, Nodes]]:
    """Every file of the program, parsed, as all nodes of its tree."""
    sources = ((path, path.read_text(encoding="utf-8")) for path in PACKAGE.rglob("*.py"))
    return [(path, [*ast.walk(ast.parse(source))]) for path, source in sources]


def names_from(module: str) -> set[str]:
    """What the program outside gcs/wire uses of a module of gcs/wire."""
    outside = (tree for path, tree in nodes() if path.parent != PACKAGE / "wire")
    return {name for tree in outside for name in _imported(tree, module) | _via_alias(tree, module)}


def _imported(tree: Nodes, module: str) -> set[str]:
    """The X of `from gcs.wire.module import X`."""
    return {
        alias.name
        for node in tree
        if isinstance(node, ast.ImportFrom) and node.module == f"gcs.wire.{module}"
        for alias in node.names
    }


def _via_alias(tree: Nodes, module: str) -> set[str]:
    """The X of `m.X` after `from gcs.wire import module as m`."""
    aliases = {
        alias.asname or alias.name
        for node in tree
        if isinstance(node, ast.ImportFrom) and node.module == "gcs.wire"
        for alias in node.names
        if alias.name == module
    }
    return {
        node.attr
        for node in tree
        if isinstance(node, ast.Attribute)
        and isinstance(node.value, ast.Name)
        and node.value.id in aliases
    }


@pytest.mark.slow
def test_the_program_uses_every_message_class() -> None:
    assert {cls.__name__ for cls in CLASSES.values()} - names_from("messages") == set()


@pytest.mark.slow
def test_the_program_uses_every_enum() -> None:
    assert {choice.class_name for choice in selection.ENUMS} - names_from("ids") == set()


def test_the_program_asks_for_every_message_that_has_an_id_only() -> None:
    asked = {
        ast.unparse(node) for _, tree in nodes() for node in tree if isinstance(node, ast.Attribute)
    }
    assert {f"MsgId.{name}" for name in selection.IDS_ONLY} - asked == set()


def test_the_program_does_not_need_the_generator() -> None:
    for path, tree in nodes():
        loaded = {node.module for node in tree if isinstance(node, ast.ImportFrom)}
        loaded -= {"gcs.wire.selection"} if path.name == "generate.py" else set()
        assert not loaded & {"gcs.wire.selection", "gcs.wire.generate"}, path


def field(
    name: str,
    type_: str,
    array_length: int = 0,
    *,
    extension: bool = False,
    units: str = "",
    enum: str = "",
) -> FieldDef:
    return FieldDef(name, type_, array_length, 0, extension, enum, units)


def test_a_message_of_every_kind_of_field() -> None:
    fields = (
        field("distance", "float", units="m"),
        field("mode", "uint8", enum="MAV_MODE"),
        field("voltages", "uint16", 10, units="mV"),
        field("q", "float", 4),
        field("name", "char", 16),
        field("letter", "char"),
        field("more", "double", extension=True),
        field("cells", "int8", 3, extension=True),
        field("note", "char", 9, extension=True),
    )
    source = generate.messages_source([MessageDef(900, "TEST_ALL", 1, 50, 70, fields)])
    _, _, found = source.partition("    MSG_ID: ClassVar[MsgId]\n\n\n")
    wanted = '''class TestAll(Message, frozen=True, gc=False):
    """TEST_ALL (900): 50 bytes, 70 with extensions."""

    MSG_ID: ClassVar[MsgId] = MsgId.TEST_ALL
    distance: float  # m
    mode: int  # MAV_MODE
    voltages: tuple[int, ...]  # 10 x mV
    q: tuple[float, ...]  # 4 values
    name: str  # at most 16 bytes
    letter: str  # 1 byte
    more: float = 0.0
    cells: tuple[int, ...] = (0,) * 3  # 3 values
    note: str = ""  # at most 9 bytes
'''
    assert found.startswith(wanted)


def test_classes_stand_in_order_of_their_ids() -> None:
    second = MessageDef(2, "SECOND", 1, 0, 0, ())
    first = MessageDef(1, "FIRST", 1, 0, 0, ())
    source = generate.messages_source([second, first])
    assert source.index("class First(") < source.index("class Second(")
