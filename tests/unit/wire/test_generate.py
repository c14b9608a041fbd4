"""`messages.py` and `ids.py` are what the generator writes, and hold nothing that is not used."""

from __future__ import annotations

import ast
from dataclasses import dataclass
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


@dataclass(frozen=True)
class Source:
    """What a file of the program names; its whole tree would be a hundred times as large."""

    path: Path
    imports: list[ast.ImportFrom]
    attributes: set[tuple[str, str]]
    """`x.y` as (x, y)."""


@cache
def sources() -> list[Source]:
    """Every file of the program."""
    return [_read(path) for path in PACKAGE.rglob("*.py")]


def _read(path: Path) -> Source:
    source = Source(path, [], set())
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            source.imports.append(node)
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            source.attributes.add((node.value.id, node.attr))
    return source


def names_from(module: str) -> set[str]:
    """What the program outside gcs/wire uses of a module of gcs/wire: the X of `from
    gcs.wire.module import X`, and of `m.X` after `from gcs.wire import module as m`."""
    return {
        name
        for source in sources()
        if source.path.parent != PACKAGE / "wire"
        for name in _imported(source, module) | _via_alias(source, module)
    }


def _imported(source: Source, module: str) -> set[str]:
    return {
        alias.name
        for node in source.imports
        if node.module == f"gcs.wire.{module}"
        for alias in node.names
    }


def _via_alias(source: Source, module: str) -> set[str]:
    aliases = {
        alias.asname or alias.name
        for node in source.imports
        if node.module == "gcs.wire"
        for alias in node.names
        if alias.name == module
    }
    return {name for owner, name in source.attributes if owner in aliases}


@pytest.mark.slow
def test_the_program_uses_every_message_class() -> None:
    assert {cls.__name__ for cls in CLASSES.values()} - names_from("messages") == set()


@pytest.mark.slow
def test_the_program_uses_every_enum() -> None:
    assert {choice.class_name for choice in selection.ENUMS} - names_from("ids") == set()


def test_the_program_asks_for_every_message_that_has_an_id_only() -> None:
    asked = set().union(*(source.attributes for source in sources()))
    assert {("MsgId", name) for name in selection.IDS_ONLY} - asked == set()


def test_the_program_does_not_need_the_generator() -> None:
    for source in sources():
        loaded = {node.module for node in source.imports}
        loaded -= {"gcs.wire.selection"} if source.path.name == "generate.py" else set()
        assert not loaded & {"gcs.wire.selection", "gcs.wire.generate"}, source.path


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
