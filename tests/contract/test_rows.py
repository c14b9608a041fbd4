"""No row of the contract is without a test that names it."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

from tests.contract.rows import ROWS

FIRST_LINES = [
    (ast.get_docstring(node) or "").splitlines()[:1]
    for path in Path(__file__).parent.glob("test_*.py")
    for node in ast.parse(path.read_text(encoding="utf-8")).body
    if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")
]


@pytest.mark.parametrize("row", ROWS)
def test_a_row_has_a_test_that_names_it(row: str) -> None:
    assert [f"{row}."] in FIRST_LINES
