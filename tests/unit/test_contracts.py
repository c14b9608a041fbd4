"""A bad import in any room breaks an import contract of pyproject.toml."""

from __future__ import annotations

import tomllib
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
from grimp import ImportGraph, build_graph
from importlinter.configuration import configure
from importlinter.contracts.acyclic_siblings import AcyclicSiblingsContract
from importlinter.contracts.forbidden import ForbiddenContract

ROOT = Path(__file__).parents[2]
OPTIONS: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"][
    "importlinter"
]
CONTRACTS = {contract["id"]: contract for contract in OPTIONS["contracts"]}
IMPURE = (
    *("gcs.shell", "gcs.cli", "gcs.tui", "gcs.live", "gcs.operator", "gcs.record"),
    *("vehicle_sim.shell", "vehicle_sim.testing"),
)
"""Rooms that may know the world outside."""


@pytest.fixture(scope="module")
def imports() -> ImportGraph:
    configure()
    return build_graph(
        *OPTIONS["root_packages"],
        include_external_packages=True,
        exclude_type_checking_imports=False,
        cache_dir=None,
    )


def broken(contract_id: str, imports: ImportGraph) -> bool:
    given = CONTRACTS[contract_id]
    options = {key: str(x) if isinstance(x, bool) else x for key, x in given.items()}
    kinds = {"forbidden": ForbiddenContract, "acyclic_siblings": AcyclicSiblingsContract}
    contract = kinds[options["type"]](options["name"], OPTIONS, options)
    return not contract.check(deepcopy(imports), verbose=False).kept


def with_import(imports: ImportGraph, importer: str, imported: str) -> ImportGraph:
    assert importer in imports.modules
    bad = deepcopy(imports)
    if imported not in bad.modules:
        bad.add_module(imported, is_squashed=True)
    bad.add_import(importer=importer, imported=imported)
    return bad


def rooms() -> list[str]:
    """Every package of both programs, but for the impure ones and what lies in them."""
    found = []
    for package in OPTIONS["root_packages"]:
        for init in sorted((ROOT / package).rglob("__init__.py")):
            room = ".".join(init.parent.relative_to(ROOT).parts)
            if not any(f"{room}.".startswith(f"{impure}.") for impure in IMPURE):
                found.append(room)
    return found


@pytest.mark.slow
@pytest.mark.parametrize("room", rooms())
def test_a_room_is_pure_where_it_is_not_named(room: str, imports: ImportGraph) -> None:
    module = min((imports.find_children(room) or {room}) - {"gcs.__main__"})
    assert broken("pure", with_import(imports, module, "asyncio"))


@pytest.mark.slow
@pytest.mark.parametrize(
    ("contract_id", "importer", "imported"),
    [
        ("libraries", "gcs.station.ticks", "mcap"),
        ("libraries", "gcs.gate.machine.step_context", "click"),
        ("cores", "gcs.vehicle.vehicle", "gcs.shell.loop"),
        ("cores", "gcs.bridge.routing", "gcs.record.writer"),
        ("cores", "vehicle_sim.services.telemetry.info", "vehicle_sim.shell.runtime"),
        ("wordless", "gcs.gate.machine.gate", "gcs.ipc"),
        ("record", "gcs.record.writer", "gcs.station.session"),
        ("inside", "gcs.tui.app", "gcs.station.session"),
        ("inside", "gcs.flight_report.scan", "gcs.vehicle.vehicle"),
        ("inside", "gcs.operator.station", "gcs.session.effects"),
        ("logfile", "gcs.station.session", "gcs.logfile.tables"),
        ("truth", "vehicle_sim.control_loops.cascade", "vehicle_sim.plant.body"),
        ("operator", "gcs.operator.station", "gcs.protocol.command"),
        ("acyclic", "gcs.session.work", "gcs.station.session"),
        ("acyclic", "gcs.vehicle.health.battery", "gcs.vehicle.missions.missions"),
    ],
)
def test_each_contract_sees_what_it_is_for(
    contract_id: str, importer: str, imported: str, imports: ImportGraph
) -> None:
    assert broken(contract_id, with_import(imports, importer, imported))
