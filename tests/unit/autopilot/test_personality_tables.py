"""What PX4 and ArduCopter do differently stands in tables, and nowhere as a comparison.

The tables: `AutopilotRules` (`autopilot/rules.py`) for how they fly, `Profile`
(`services/profile.py`) for how they speak, and dictionaries by `Personality` beside what uses them.
"""

from __future__ import annotations

import ast
from pathlib import Path
from typing import Final, get_args

import pytest

import vehicle_sim
from tests.each import each
from vehicle_sim.autopilot.modes import Personality

ROOT: Final = Path(vehicle_sim.__file__).parent
FILES: Final = [str(file.relative_to(ROOT)) for file in sorted(ROOT.rglob("*.py"))]
NAMES: Final = frozenset(get_args(Personality))


def _names_one(node: ast.AST) -> bool:
    """A personality's name, or a tuple, list or set that has one."""
    if isinstance(node, ast.Tuple | ast.List | ast.Set):
        return any(_names_one(each) for each in node.elts)
    return isinstance(node, ast.Constant) and node.value in NAMES


def comparisons(source: str) -> list[int]:
    """The lines that compare with a personality's name: `==`, `in`, `case`."""
    found = []
    for node in ast.walk(ast.parse(source)):
        match node:
            case ast.Compare():
                compared = [node.left, *node.comparators]
            case ast.MatchValue():
                compared = [node.value]
            case _:
                continue
        if any(_names_one(each) for each in compared):
            found.append(compared[0].lineno)
    return found


@pytest.mark.parametrize(
    "source",
    [
        'x = personality == "px4"',
        'if profile.name != "ardupilot": pass',
        'x = 1 if "px4" == name else 2',
        'x = personality in ("px4", other)',
        'match personality:\n    case "ardupilot": pass',
    ],
)
def test_a_comparison_is_found(source: str) -> None:
    assert len(comparisons(source)) == 1


def test_a_table_is_no_comparison() -> None:
    assert comparisons('TABLE = {"px4": 1, "ardupilot": 2}\nx = TABLE["px4"] == 1') == []


@each("file", FILES)
def test_nothing_is_compared_with_a_personality(file: str) -> None:
    assert comparisons((ROOT / file).read_text(encoding="utf-8")) == []
