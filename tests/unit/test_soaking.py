"""What a soak runs, and what it leaves to `make test`."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import cast

import pytest

from tests import soaking


@dataclass
class Item:
    """As much of a test as the choice looks at."""

    nodeid: str
    marks: tuple[str, ...] = ()
    obj: object = field(default=None)

    def get_closest_marker(self, name: str) -> str | None:
        return name if name in self.marks else None


class Drawn:
    is_hypothesis_test = True


FEW = Item("tests/loopback/test_a.py::test_flights[0]")
MANY = Item("tests/loopback/test_a.py::test_flights[1]", ("soak",))
PLAIN = Item("tests/loopback/test_a.py::test_a_flight")
DRAWN = Item("tests/unit/test_b.py::test_any", obj=Drawn)
LARGER = Item(f"{soaking.MORE[0]}[px4]")


def left_out() -> list[str]:
    items = [FEW, MANY, PLAIN, DRAWN, LARGER]
    return [item.nodeid for item in soaking.left_out(cast("list[pytest.Item]", items))]


def test_a_run_that_is_no_soak_leaves_out_what_is_marked(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(soaking, "SOAKING", False)
    assert left_out() == [MANY.nodeid]


def test_a_soak_runs_all_of_what_there_is_a_share_of_and_what_is_drawn_or_larger(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(soaking, "SOAKING", True)
    assert left_out() == [PLAIN.nodeid]


@dataclass
class Report:
    user_properties: list[tuple[str, object]]


@pytest.mark.parametrize("soaking_now", [True, False])
def test_a_soak_sums_up_what_its_tests_counted(
    soaking_now: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(soaking, "SOAKING", soaking_now)
    reports = [Report([("runs", 1_000), ("where", "here")]), Report([("runs", 200)])]
    told = list(soaking.counts(cast("list[pytest.TestReport]", reports)))
    assert told == (["runs: 1,200"] if soaking_now else [])


def test_what_asks_for_more_by_itself_is_there(pytestconfig: pytest.Config) -> None:
    for named in soaking.MORE:
        path, _, name = named.partition("::")
        assert f"def {name}" in (pytestconfig.rootpath / path).read_text(encoding="utf-8")
