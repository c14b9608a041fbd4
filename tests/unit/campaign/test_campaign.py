"""A campaign that is stopped goes on, a search finds, and what is kept is flown again."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import msgspec
import pytest

from gcs.campaign.campaign import Campaign, kept
from gcs.campaign.case import ERROR, Row
from gcs.campaign.engine import Flight, Flown
from gcs.campaign.plan import Plan
from gcs.campaign.store import OtherCampaignError, Store, rows_digest
from tests.unit.campaign.campaigns import Pretended, sampled


def near(flight: Flight) -> float:
    """A corner of the ranges leaves the fence: 1 % of them, with one of the autopilots."""
    inputs = flight[1]
    away = math.hypot(
        float(inputs["wind_m_s"]) / 8.0 - 0.83, float(inputs["gust_m_s"]) / 1.5 - 0.35
    )
    return 4.0 * away - 0.3 + 2.0 * (inputs["autopilot"] == "px4")


def campaign(plan: Plan, folder: Path, engine: Callable[..., object]) -> Campaign:
    store = Store(folder)
    store.begin(plan)
    return Campaign(plan, store, engine, lambda: 0.0, lambda _: None)  # type: ignore[arg-type]


@pytest.mark.parametrize("sample", ["random", "search"])
def test_one_that_was_stopped_has_the_same_rows_in_the_end(sample: str, tmp_path: Path) -> None:
    plan = sampled(tmp_path, sample, 150)
    whole = campaign(plan, tmp_path / "whole", Pretended(near)).run()
    assert [row.id for row in whole] == list(range(150))
    first, second = Pretended(near, fails_after=61), Pretended(near)
    with pytest.raises(KeyboardInterrupt):
        campaign(plan, tmp_path / "parts", first).run()
    again = campaign(plan, tmp_path / "parts", second).run()
    assert rows_digest(again) == rows_digest(whole)
    assert not set(first.flown) & set(second.flown)
    assert Store(tmp_path / "parts").rows() == whole


def test_what_is_stored_is_what_was_flown(tmp_path: Path) -> None:
    plan = sampled(tmp_path, "latin", 3)
    row = Row(
        id=2,
        inputs=plan.case(2, plan.inputs([0.1] * 5)).inputs,
        outcome=ERROR,
        closest_m=0.1 + 0.2,
        answers="arm: accepted\n",
        digest="0f",
        error="é",
        exit_code=6,
    )
    store = Store(tmp_path / "one")
    store.begin(plan)
    store.append(plan, [row, msgspec.structs.replace(row, id=1, closest_m=None)])
    store.append(plan, [row])
    assert store.rows() == [msgspec.structs.replace(row, id=1, closest_m=None), row]
    assert store.plan() == plan
    with pytest.raises(OtherCampaignError):
        store.begin(msgspec.structs.replace(plan, seed=9))


@pytest.mark.parametrize("seed", range(3))
def test_a_search_finds_what_chance_rarely_meets(seed: int, tmp_path: Path) -> None:
    """4.4 breaches are expected of 100 flights by chance in one half of the choices."""
    plan = msgspec.structs.replace(sampled(tmp_path, "search", 100), seed=seed)
    rows = campaign(plan, tmp_path / "search", Pretended(near)).run()
    assert sum(row.breach for row in rows) >= 25
    assert min(row.closest_m or 0.0 for row in rows) < -0.25


def test_kept_are_breaches_failures_and_the_worst_of_each_cell(tmp_path: Path) -> None:
    plan = sampled(tmp_path, "random", 80)
    rows = campaign(plan, tmp_path / "kept", Pretended(near)).run()
    rows[7] = msgspec.structs.replace(rows[7], outcome=ERROR, closest_m=None)
    chosen = {row.id for row in kept(rows, 100)}
    assert {row.id for row in rows if row.breach} | {7} <= chosen
    for cell in {row.cell for row in rows}:
        worst = min(
            (r for r in rows if r.cell == cell and r.closest_m is not None),
            key=lambda r: r.closest_m or 0.0,
        )
        assert worst.id in chosen
    assert kept(rows, 3) == kept(rows, 100)[:3]


def test_a_flight_that_becomes_another_row_is_told(tmp_path: Path) -> None:
    plan = sampled(tmp_path, "random", 4)
    engine = Pretended(near)
    of = campaign(plan, tmp_path / "again", engine)
    rows = of.run()

    def altered(flights: list[Flight], *, recorded: bool) -> list[Flown]:
        flown = list(engine(flights, recorded=recorded))
        return [
            (msgspec.structs.replace(row, digest="other") if row.id == 2 else row, data)
            for row, data in flown
        ]

    of.fly = altered  # type: ignore[assignment]
    assert of.keep(rows) == [2]
    assert of.store.record(1).read_bytes() == b"a record"
    assert of.keep(rows) == []
