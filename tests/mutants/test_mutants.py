"""The runner on a small package of its own: what is noticed is killed, what is not survives."""

from __future__ import annotations

import ast
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.mutants.mutant import Fate, Kind, Mutant, Result
from tests.mutants.report import Report
from tests.mutants.source import enums_of, sites

ROOT = Path(__file__).resolve().parents[2]

SOURCE = """
from enum import Enum


class Colour(Enum):
    RED = 1
    BLUE = 2


LIMIT = 10.0
WARM = frozenset({Colour.RED, Colour.BLUE})


def below(x: float) -> bool:
    return x < LIMIT


def countdown(n: int) -> int:
    while n > 0:
        n = n - 1
    return n


def untested(x: int) -> int:
    return x + 3


MOST = 40


def unused(x: int) -> int:
    return min(x, MOST)
"""

CHECKS = """
from planted.rules import MOST, WARM, Colour, below, countdown


def test_a_limit_on_both_sides() -> None:
    assert below(9.0)
    assert not below(11.0)


def test_it_ends() -> None:
    assert countdown(3) == 0


def test_one_of_the_two() -> None:
    assert Colour.RED in WARM


def test_a_constant_that_no_line_that_runs_reads() -> None:
    assert MOST == 40
"""


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, object]]:
    """What the runner says of the planted package, by mutant."""
    root = tmp_path_factory.mktemp("planted")
    (root / "planted").mkdir()
    (root / "planted" / "__init__.py").write_text("", encoding="utf-8")
    (root / "planted" / "rules.py").write_text(SOURCE, encoding="utf-8")
    (root / "checks").mkdir()
    (root / "checks" / "test_rules.py").write_text(CHECKS, encoding="utf-8")
    told = root / "told.json"
    done = subprocess.run(
        [sys.executable, "-m", "tests.mutants", "--root", str(root), "--package", "planted",
         "--tests", "checks", "--json", str(told)],
        cwd=ROOT, capture_output=True, text=True, check=False,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    assert done.returncode == 1, done.stdout + done.stderr  # fewer than 95 % are killed
    mutants = json.loads(told.read_text(encoding="utf-8"))["mutants"]
    return {mutant["key"].removeprefix("planted/rules.py "): mutant for mutant in mutants}


FATES = {
    "module: LIMIT = 10.0 -> 15.0": Fate.KILLED,
    "below: x < LIMIT -> x <= LIMIT": Fate.SURVIVED,
    "countdown: n > 0 -> n >= 0": Fate.KILLED,
    "countdown: n > 0 -> n > 1": Fate.KILLED,
    "countdown: n - 1 -> n + 1": Fate.TIMED_OUT,
    "countdown: n - 1 -> n - 2": Fate.KILLED,
    "module: with Colour.RED -> without": Fate.KILLED,
    "module: with Colour.BLUE -> without": Fate.SURVIVED,
    "untested: x + 3 -> x - 3": Fate.UNTESTED,
    "module: 40 -> 60": Fate.KILLED,
}


@pytest.mark.thorough
@pytest.mark.parametrize("key", FATES)
def test_a_planted_survivor_survives_and_a_planted_kill_is_killed(
    report: dict[str, dict[str, object]], key: str
) -> None:
    short = key.replace("LIMIT = 10.0", "10.0")
    assert report[short]["fate"] == FATES[key]


@pytest.mark.thorough
def test_it_names_the_test_that_killed_and_the_line(
    report: dict[str, dict[str, object]],
) -> None:
    killed = report["countdown: n > 0 -> n > 1"]
    assert killed["by"] == "checks/test_rules.py::test_it_ends"
    assert killed["where"] == "planted/rules.py:19"
    assert report["below: x < LIMIT -> x <= LIMIT"]["tests"] == 1


def test_a_tree_is_whole_again_after_each_alteration() -> None:
    tree = ast.parse(SOURCE)
    before = ast.dump(tree)
    assert [site for site in sites(tree, enums_of([tree])) if ast.dump(tree) != before] == []


ALTERED = [
    ("a <= b", "a < b"),
    ("a >= b", "a > b"),
    ("a == b", "a != b"),
    ("a is None", "a is not None"),
    ("a not in b", "a in b"),
    ("a and b", "a or b"),
    ("not a", "a"),
    ("-a", "a"),
    ("a * b", "a / b"),
    ("min(a, b)", "max(a, b)"),
    ("any(a)", "all(a)"),
    ("0", "1"),
    ("3", "4"),
    ("40", "60"),
    ("2.0", "3.0"),
    ("True", "False"),
    ("a[1]", "a[0]"),
    ("{1.0: a, 2.0: b}", None),
    ("f'{a:.1f} {a < b}'", None),
    ("say(3, a < b)", None),
    ("Colour.RED", "Colour.BLUE"),
    ("a in (Colour.RED, Colour.BLUE)", "without"),
    ("{Colour.RED: a, Colour.BLUE: b}", "Colour.RED: b"),
    ("pick(Colour.RED, Colour.BLUE)", "without"),
    ("a\n\nclass A:\n    x: Annotated[float, Meta(ge=2.0)]", "Annotated[float, Meta(ge=3.0)]"),
]


@pytest.mark.parametrize(("before", "after"), ALTERED)
def test_what_is_altered_and_to_what(before: str, after: str | None) -> None:
    tree = ast.parse(f"def f():\n    return {before}\n")
    enums = {"Colour": ("RED", "BLUE")}
    found = [site.after for site in sites(tree, enums)]
    assert (after in found) if after else not found


@pytest.mark.parametrize(
    "text",
    [
        "import a.b",
        "def f():\n    '''1 < 2'''",
        "def f(a: Literal[1, 2]) -> Literal[3]: ...",
        "assert 1 < 2",
        "@dataclass(frozen=True)\nclass A: ...",
        "def __str__(self):\n    return 1 < 2",
        "x = field(init=False)",
        "Alias: TypeAlias = Literal[1, 2]",
        "class A(Struct, frozen=True): ...",
        "class A:\n    x: int | None",
    ],
)
def test_what_is_left_alone(text: str) -> None:
    assert list(sites(ast.parse(text), {})) == []


def result(key: str, fate: Fate, *cells: str) -> Result:
    mutant = Mutant(key, "a.py", 1, Kind.LOGIC, "", "", 0, "a", cells=cells)
    return Result(mutant, fate, "a test", 1, 0.1)


def judged(
    results: list[Result], equivalent: dict[str, str], unreached: dict[str, str] | None = None
) -> Report:
    mutants = [r.mutant for r in results]
    return Report.of(mutants, results, equivalent, unreached or {}, 1.0)


def test_an_equivalent_mutant_does_not_count() -> None:
    results = [result("a", Fate.KILLED), result("b", Fate.SURVIVED)]
    assert not judged(results, {}).passed
    assert judged(results, {"b": "the same"}).passed


def test_an_entry_that_names_no_mutant_or_one_that_is_killed_fails() -> None:
    results = [result("a", Fate.KILLED)]
    assert not judged(results, {"gone": "the same"}).passed
    assert not judged(results, {"a": "the same"}).passed


def test_an_entry_of_a_table_that_is_never_read_does_not_count() -> None:
    never = dict.fromkeys(["HERE / tick", "THERE / tick"], "it does not happen")
    results = [
        result("a", Fate.SURVIVED, "HERE / tick"),
        result("b", Fate.SURVIVED, "HERE / tick", "THERE / tick"),
    ]
    assert judged(results, {}, never).passed
    elsewhere = result("c", Fate.SURVIVED, "HERE / tick", "ELSEWHERE / tick")
    assert not judged([*results, elsewhere], {}, never).passed
    assert judged([result("a", Fate.KILLED, "HERE / tick"), results[1]], {}, never).passed
    assert not judged(results[:1], {}, never).passed  # there is no such entry as THERE / tick


def test_fewer_than_95_percent_fail() -> None:
    killed = [result(str(i), Fate.KILLED) for i in range(19)]
    assert judged([*killed, result("last", Fate.TIMED_OUT)], {}).passed
    assert judged([*killed, result("last", Fate.SURVIVED)], {}).passed
    assert not judged([*killed[1:], result("last", Fate.UNTESTED)], {}).passed
