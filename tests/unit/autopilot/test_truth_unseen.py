"""What decides sees sensors and estimates, and never the body itself."""

from __future__ import annotations

import ast
from pathlib import Path

import vehicle_sim
from tests.each import each

ROOMS = ("autopilot", "estimation", "control_loops")
_ROOT = Path(vehicle_sim.__file__).parent
FILES = sorted(file for room in ROOMS for file in (_ROOT / room).rglob("*.py"))


@each("file", FILES, said=lambda file: str(file.relative_to(_ROOT)))
def test_no_one_reaches_for_the_body_of_the_blocks(file: Path) -> None:
    """The import contract sees names of modules; a body can also be had from `Blocks`."""
    reached = [
        node.lineno
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8")))
        if isinstance(node, ast.Attribute)
        and node.attr in ("body", "_body")
        and not (isinstance(node.value, ast.Name) and node.value.id == "airframe")
    ]
    assert reached == []


def test_the_truth_is_read_in_one_place_of_the_autopilot() -> None:
    readers = [
        str(file.relative_to(_ROOT))
        for file in FILES
        if "motion_of(" in file.read_text(encoding="utf-8")
    ]
    assert readers == ["autopilot/view.py"]
