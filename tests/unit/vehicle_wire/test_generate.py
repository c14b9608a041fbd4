"""`messages.py` and `layouts.py` are what the generator writes."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import vehicle_sim
from vehicle_sim.wire import generate
from vehicle_sim.wire.dialect import CRC_EXTRAS, LAYOUTS
from vehicle_sim.wire.messages import TYPES
from vehicle_sim.wire.supplement import Layout, MessageField

PACKAGE = Path(vehicle_sim.__file__).parent


@pytest.mark.parametrize("path", generate.files(), ids=lambda path: path.name)
def test_a_generated_file_is_up_to_date(path: Path) -> None:
    current = path.read_text(encoding="utf-8")
    assert current == generate.files()[path], "run `make messages`"


def test_the_program_uses_every_message_class() -> None:
    used: set[str] = set()
    for path in PACKAGE.rglob("*.py"):
        if path.parent == PACKAGE / "wire":
            continue
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                used |= {node.attr} if node.value.id == "m" else set()
            if isinstance(node, ast.ImportFrom) and node.module == "vehicle_sim.wire.messages":
                used |= {alias.name for alias in node.names}
    assert {kind.__name__ for kind in TYPES.values()} - used == set()


def test_the_program_needs_neither_the_generator_nor_what_it_reads() -> None:
    for path in PACKAGE.rglob("*.py"):
        if path.name in ("generate.py", "dialect.py"):
            continue
        tree = ast.parse(path.read_text(encoding="utf-8"))
        loaded = {node.module for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
        unwanted = ("generate", "dialect", "selection", "supplement")
        assert not loaded & {f"vehicle_sim.wire.{name}" for name in unwanted}, path


FIELDS = (
    MessageField("targetSystem", "uint64_t", 0),
    MessageField("count", "int16_t", 0),
    MessageField("Vcc", "uint16_t", 0),
    MessageField("q", "float", 4),
    MessageField("name", "char", 16),
    MessageField("digest", "uint8_t", 8),
    MessageField("more", "double", 0, True),
    MessageField("cells", "int8_t", 3, True),
    MessageField("note", "char", 9, True),
)


def test_a_message_of_every_kind_of_field() -> None:
    source = generate.messages_source([Layout(900, "TEST_ALL", 1, FIELDS)])
    wanted = '''class TestAll(NamedTuple):
    """TEST_ALL (900)."""

    target_system: int
    count_: int
    Vcc: int
    q: tuple[float, ...]
    name: bytes
    digest: bytes
    more: float = 0.0
    cells: tuple[int, ...] = (0,) * 3
    note: bytes = b""
'''
    assert wanted in source


def test_the_packing_of_every_kind_of_field() -> None:
    """Base: 8 + 2 + 2 + 4 x 4 + 16 + 8 bytes; the arrays are the 4th and the 8th field."""
    source = generate.layouts_source([Layout(900, "TEST_ALL", 1, FIELDS)], {900: 1})
    assert '900: Packing("<QhH4f16s8sd3b9s", 52, ((3, 4), (7, 3))),' in source


def test_classes_stand_in_order_of_their_numbers() -> None:
    second, first = Layout(2, "SECOND", 1, FIELDS), Layout(1, "FIRST", 1, FIELDS)
    source = generate.messages_source([second, first])
    assert source.index("class First(") < source.index("class Second(")


def test_a_checksum_is_known_for_every_message_that_has_a_class() -> None:
    assert set(TYPES) == set(LAYOUTS)
    assert set(TYPES) <= set(CRC_EXTRAS)
