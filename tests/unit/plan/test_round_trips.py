"""What is written is read back the same; what was uploaded is recognised when it comes down."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.plan.compare import same_meaning
from gcs.plan.errors import PlanError
from gcs.plan.formats.reader import read
from gcs.plan.formats.wpl_writer import write_wpl
from gcs.plan.formats.writer import write
from gcs.plan.model import AutopilotName, Circle, Fence, Geodetic, Item, LatLon, Plan, Zone
from gcs.plan.wire import from_wire, to_wire
from tests.sample_files import elsewhere
from tests.unit.plan.samples import LOCAL, WHO
from tests.unit.plan.strategies import plans


def _without_nan(item: Item) -> Item:
    """ArduPilot's tables have no way to say "unset"."""
    p1, p2, p3, p4 = item.params
    return replace(item, params=(p1, p2, p3, 0.0 if math.isnan(p4) else p4))


@given(plans("px4"))
def test_a_plan_survives_a_plan_file(plan: Plan) -> None:
    written = write("a.plan", plan, "px4")

    assert read("a.plan", written.data) == plan
    assert written.lost == ()


@given(plans("px4"))
def test_a_plan_survives_a_px4_waypoint_table(plan: Plan) -> None:
    plan = replace(plan, home=None)

    again = read("a.txt", write_wpl(plan, "px4").data, "px4")

    assert again.items == plan.items or again.home is not None
    assert again.fence == plan.fence
    assert again.rally == plan.rally


@given(plans("ardupilot"))
def test_a_plan_survives_an_ardupilot_waypoint_table(plan: Plan) -> None:
    plan = replace(plan, items=tuple(map(_without_nan, plan.items)))

    assert read("a.txt", write_wpl(plan, "ardupilot").data, "ardupilot") == plan


@given(plans("px4"), st.sampled_from(WHO))
def test_a_plan_survives_the_wire(plan: Plan, who: AutopilotName) -> None:
    sent = to_wire(plan, who)

    again = from_wire(sent, who)

    assert len(again.items) == len(plan.items)
    assert to_wire(again, who) == sent
    assert same_meaning(sent, to_wire(again, who), who) == []
    assert [item.seq for item in sent] == list(range(len(sent)))


def test_floors_and_ceilings_are_named_when_they_are_lost() -> None:
    zone = Zone(Circle(LatLon(47.0, 8.0), 5.0), inclusion=True, ceiling_above_home_m=2.0)
    plan = Plan("a", "px4", Geodetic(47.0, 8.0, 488.0), fence=Fence((zone,)))

    for suffix in ("plan", "txt"):
        lost = write(f"a.{suffix}", plan, "px4").lost
        assert any("ceiling" in finding.what for finding in lost)


def test_a_plan_in_metres_is_not_written_in_degrees() -> None:
    plan = read("a.toml", LOCAL.encode())

    for suffix in ("plan", "txt"):
        with pytest.raises(PlanError, match="metres"):
            write(f"a.{suffix}", plan, "px4")
    with pytest.raises(PlanError, match="metres"):
        to_wire(plan, "px4")


def test_an_unknown_suffix_is_not_written() -> None:
    with pytest.raises(PlanError, match="suffix"):
        write("a.kmz", read("a.toml", LOCAL.encode()), "px4")


def test_a_real_plan_survives_every_format() -> None:
    path = elsewhere("plans", "MC_mission_box.plan")
    plan = read(path.name, path.read_bytes())

    assert read(path.name, write("x.plan", plan, "px4").data) == plan
    table = read("x.txt", write("x.waypoints", plan, "px4").data, "px4")
    assert table.items == plan.items
