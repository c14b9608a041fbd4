"""What decides sees sensors and estimates, and never the body itself."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import vehicle_sim
from tests.each import each
from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.interface import Geodetic
from vehicle_sim.plant.body import Body

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


def attributes(thing: object) -> Iterator[object]:
    slots = (name for kind in type(thing).__mro__ for name in getattr(kind, "__slots__", ()))
    names = [*getattr(thing, "__dict__", ()), *slots]
    yield from (getattr(thing, name, None) for name in names)
    if isinstance(thing, dict):
        yield from thing.values()
    elif isinstance(thing, list | tuple | set | frozenset):
        yield from thing
    yield getattr(thing, "__self__", None)


def reached(start: object) -> Iterator[object]:
    seen: dict[int, object] = {}
    todo = [start]
    while todo:
        thing = todo.pop()
        if thing is None or isinstance(thing, type) or id(thing) in seen:
            continue
        seen[id(thing)] = thing
        yield thing
        todo += attributes(thing)


def test_no_attribute_of_the_flights_state_leads_to_the_body() -> None:
    vehicle = Autopilot("px4", Geodetic(47.4, 8.5, 488.0), 1)
    body = vehicle.blocks.body
    assert isinstance(body, Body)
    assert not any(thing is body for thing in reached(vehicle.state))
    assert any(thing is body for thing in reached(vehicle.parts.faults))
