"""What is altered, and which tests have to notice: one entry for each part of the project.

To put another package under the runner, add a `Target` here.  A package whose decisions stand in
a table of values (as the gate's do) names a `ValueTable` as well: its entries are altered as
values, whatever the source text looks like.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Final

ROOT: Final = Path(__file__).resolve().parents[2]


@dataclass(frozen=True, slots=True)
class ValueTable:
    """A mapping `attribute` of the module `module`; `alterations` names the module that alters it.

    That module has `alterations(table)`, an iterator over `TableAlteration`s, and `name_of(entry)`.
    """

    module: str
    attribute: str
    alterations: str


@dataclass(frozen=True, slots=True)
class Target:
    """Paths are relative to the project's root.

    `nearest` names, for parts of the packages, the tests that a mutant there has to face; without
    an entry it faces all that reach it.  Two parts whose tests fly the same vehicle would else
    face each other's.

    `skip` are files whose source text is not altered, each with the reason.  `deselect` are parts
    of test ids that are left out; `slow` are such as run only when they are asked for.  `settings`
    are TOML files whose values are altered, where the package reads them with `Path.read_text`.
    """

    name: str
    packages: tuple[str, ...]
    tests: tuple[str, ...]
    nearest: tuple[tuple[str, tuple[str, ...]], ...] = ()
    skip: tuple[tuple[str, str], ...] = ()
    deselect: tuple[str, ...] = ()
    slow: tuple[str, ...] = ()
    settings: tuple[str, ...] = ()
    tables: tuple[ValueTable, ...] = ()
    root: Path = ROOT

    def tests_near(self, file: str) -> tuple[str, ...]:
        """What the ids of the tests begin with that a mutant in this file has to face."""
        for part, tests in self.nearest:
            if file.startswith(part):
                return tests
        return self.tests

    def sources(self) -> list[Path]:
        """Every file whose text is altered, in the order of their names."""
        skipped = [pattern for pattern, _ in self.skip]
        return sorted(
            path
            for package in self.packages
            for path in (self.root / package).rglob("*.py")
            if not any(path.relative_to(self.root).match(pattern) for pattern in skipped)
        )

    def test_files(self) -> list[Path]:
        """In the order of their names."""
        paths = [self.root / test for test in self.tests]
        files = [file for path in paths for file in path.rglob("*.py")]
        return sorted({*files, *(path for path in paths if path.is_file())})


TARGETS: Final = {
    target.name: target
    for target in (
        Target(
            name="gate",
            packages=("gcs/gate",),
            tests=(
                "tests/unit/gate",
                "tests/unit/session",
                "tests/unit/vehicle",
                "tests/unit/station",
            ),
            skip=(
                ("gcs/gate/machine/rows/*.py", "its values are altered in the table"),
                ("gcs/gate/machine/render.py", "prints the table; its test is the golden copy"),
                ("gcs/gate/machine/sentences.py", "sentences only"),
            ),
            deselect=("test_the_printed_copy_is_the_table",),
            slow=("tests/unit/gate/test_explore",),
            settings=("gcs/gate/policy/default.toml", "gcs/gate/policy/lab.toml"),
            tables=(ValueTable("gcs.gate.machine.table", "TABLE", "tests.mutants.gate_table"),),
        ),
        Target(
            name="bridge",
            packages=("gcs/bridge",),
            tests=(
                "tests/unit/bridge",
                "tests/unit/test_policy_file.py",
                "tests/loopback/test_bridge.py",
                "tests/loopback/test_operator_control.py",
            ),
            nearest=(
                ("gcs/bridge/setup_policy/names.py", ("tests/unit/test_policy_file.py",)),
                ("gcs/bridge/setup_policy", ("tests/unit/bridge/setup_policy",)),
                (
                    "gcs/bridge/translate",
                    (
                        "tests/unit/bridge/test_meaning",
                        "tests/unit/bridge/test_sticks.py",
                        "tests/unit/bridge/test_attitudes.py",
                        "tests/unit/bridge/test_chosen_before_arming.py",
                        "tests/unit/bridge/test_mission_mode.py",
                    ),
                ),
                ("gcs/bridge/plans", ("tests/unit/bridge/test_plan",)),
                ("gcs/bridge/catalog", ("tests/unit/bridge/test_catalog.py",)),
            ),
            skip=(
                ("gcs/bridge/catalog/explain.py", "sentences only"),
                ("gcs/bridge/setup_policy/explain.py", "sentences only"),
            ),
        ),
        Target(
            name="vehicle",
            packages=("vehicle_sim/autopilot/failsafes", "vehicle_sim/estimation"),
            tests=(
                "tests/unit/failsafes",
                "tests/unit/vehicle_services/test_arm_authorization.py",
                "tests/unit/estimator",
            ),
            nearest=(
                (
                    "vehicle_sim/autopilot/failsafes",
                    (
                        "tests/unit/failsafes",
                        "tests/unit/vehicle_services/test_arm_authorization.py",
                    ),
                ),
                ("vehicle_sim/estimation", ("tests/unit/estimator",)),
            ),
            deselect=("test_many.py",),  # a batch is made of the source text, which is unaltered
        ),
    )
}
