"""The page of a campaign needs no network, and what a file says is text in it."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec

from gcs.campaign.page import campaign_page, lead, nearness, probability
from gcs.campaign.sampling import places_of
from gcs.campaign.statistics import summary
from tests.unit.campaign.campaigns import Pretended, sampled


def test_the_page_says_what_was_found(tmp_path: Path) -> None:
    plan = msgspec.structs.replace(sampled(tmp_path, "latin", 60), name="<script>alert(1)</script>")
    places = places_of(plan)
    engine = Pretended(lambda flight: 5.0 - float(flight[1]["wind_m_s"]))
    rows = [engine.row((n, plan.inputs(places(n)))) for n in range(60)]
    told = summary(plan, rows, "abc")
    page = campaign_page(plan, told, rows, {})
    hits = sum(row.breach for row in rows)
    assert 0 < hits < 60
    assert f"{hits} of 60 flights left the fence; the worst by" in lead(told)
    assert lead(told) in page
    assert probability(told) in page
    assert "<script>alert" not in page
    assert not re.search(r'(src|href)="(?!data:|#)', page)
    assert page.count("<circle") == 2 * 60  # over wind and over gusts


def test_of_a_search_no_probability_is_told(tmp_path: Path) -> None:
    plan = sampled(tmp_path, "search", 10)
    rows = [Pretended(lambda _: 1.0).row((n, plan.inputs([0.5] * 5))) for n in range(10)]
    told = summary(plan, rows, "")
    assert probability(told) == ""
    assert " % to " not in campaign_page(plan, told, rows, {})
    assert lead(told) == "None of 10 flights left its fence; the nearest came to 1.00 m."


def test_a_flight_that_stayed_inside_is_not_told_as_one_outside(tmp_path: Path) -> None:
    plan = sampled(tmp_path, "latin", 2)
    row = Pretended(lambda _: 1.0).row((0, plan.inputs([0.5] * 5)))
    of = "above the ceiling of inclusion circle 'home'"
    near = msgspec.structs.replace(row, closest_m=39.66, closest_of=of)
    beyond = msgspec.structs.replace(row, closest_m=-2.0, closest_of=of)
    assert nearness(near) == "39.66 m from being above the ceiling of inclusion circle 'home'"
    assert nearness(beyond) == "2.00 m above the ceiling of inclusion circle 'home'"
