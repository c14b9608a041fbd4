"""Whether the battery lasts for a mission, as the policy says how long a full one flies."""

from __future__ import annotations

from dataclasses import replace

import pytest

from gcs.gate.airspace.projection import Origin, Projection
from gcs.gate.airspace.verifier import verifier_for
from gcs.gate.policy.parse import parse_policy
from gcs.gate.refusal import Code
from gcs.plan.flight_time import flight_time
from gcs.plan.legs import Ground
from gcs.plan.model import Frame, Item, Local, Plan
from gcs.plan.settings import USUAL
from gcs.plan.verify import Verification, verify
from gcs.wire.ids import Cmd

ORIGIN = Origin(47.397742, 8.545594, 488.0)
HOME = (0.0, 0.0, 0.0)
GROUND = Ground(
    "px4",
    HOME,
    HOME,
    Projection(ORIGIN, "px4").north_east,
    488.0,
    30.0,
    USUAL["px4"],
    on_ground=True,
    battery_pct=100.0,
)


def item(command: int, *params: float, to: tuple[float, float, float] = (0.0, 0.0, 10.0)) -> Item:
    p1, p2, p3, p4 = (*params, 0.0, 0.0, 0.0, 0.0)[:4]
    return Item(command, Frame.LOCAL, (p1, p2, p3, p4), Local(*to), 0)


OUT_AND_BACK = (
    item(Cmd.NAV_TAKEOFF, to=(0.0, 0.0, 10.0)),
    item(Cmd.NAV_WAYPOINT, to=(100.0, 0.0, 10.0)),
    item(Cmd.NAV_WAYPOINT, to=(0.0, 0.0, 10.0)),
)


def plan_of(*items: Item) -> Plan:
    numbered = tuple(replace(one, do_jump_id=n) for n, one in enumerate(items, start=1))
    return Plan("a test", None, None, numbered)


def judged(
    *items: Item, endurance_s: float | None, ground: Ground = GROUND, low_pct: float = 20.0
) -> Verification:
    written = '"none"' if endurance_s is None else f"{endurance_s}"
    text = f"battery.endurance_s = {written}\nbattery.low_pct = {low_pct}"
    verifier = verifier_for(parse_policy(text, "my.toml"), "px4", HOME, ORIGIN, ())
    return verify(plan_of(*items), ground, verifier)


LANDS = (*OUT_AND_BACK, item(Cmd.NAV_LAND, to=(0.0, 0.0, 0.0)))
TAKES_S = flight_time(plan_of(*LANDS), GROUND).time_s


def test_without_a_time_in_the_policy_no_mission_is_refused_for_its_time() -> None:
    for_ever = item(Cmd.DO_JUMP, 2.0, -1.0)
    for ground in (GROUND, replace(GROUND, battery_pct=1.0), replace(GROUND, battery_pct=None)):
        found = judged(*OUT_AND_BACK, for_ever, endurance_s=None, ground=ground)
        assert found.refusal is None
        assert "flight_s" not in dict(found.evidence)


@pytest.mark.parametrize("left_pct", [100.0, 60.0])
def test_it_lasts_to_the_second_until_it_is_low(left_pct: float) -> None:
    ground = replace(GROUND, battery_pct=left_pct)
    just_s = TAKES_S / (left_pct - 20.0) * 100.0
    found = judged(*LANDS, endurance_s=just_s + 1.0, ground=ground)
    assert found.refusal is None
    assert dict(found.evidence)["flight_s"] == pytest.approx(TAKES_S)
    refusal = judged(*LANDS, endurance_s=just_s - 1.0, ground=ground).refusal
    assert refusal is not None
    assert refusal.code is Code.BATTERY_REACH
    numbers = dict(refusal.numbers)
    assert numbers["flight_s"] == pytest.approx(TAKES_S)
    assert numbers["battery_lasts_s"] < TAKES_S
    assert numbers["battery_pct"] == left_pct


def test_the_refusal_names_the_item_where_the_battery_is_low() -> None:
    far = item(Cmd.NAV_WAYPOINT, to=(140.0, 0.0, 10.0))
    found = judged(OUT_AND_BACK[0], far, OUT_AND_BACK[2], far, endurance_s=80.0)
    assert found.refusal is not None
    sentence = found.refusal.sentence
    assert sentence.startswith("item 3 (NAV_WAYPOINT) is done only after about ")
    assert sentence.endswith(
        "; the battery is low after 64 s: 100 % are left of 80 s, and 20 % are kept"
    )


def test_the_way_home_of_a_mission_that_ends_in_the_air_counts() -> None:
    ends_far = OUT_AND_BACK[:2]
    home_s = flight_time(plan_of(*ends_far), GROUND).time_s
    refusal = judged(*ends_far, endurance_s=home_s / 0.8 - 1.0).refusal
    assert refusal is not None
    assert refusal.sentence.startswith("the mission, its return and landing included, takes about")
    assert judged(*ends_far, endurance_s=home_s / 0.8 + 1.0).refusal is None


@pytest.mark.parametrize("endurance_s", [600.0, 50_000.0, 100_000.0])
def test_what_repeats_for_ever_outlasts_every_battery(endurance_s: float) -> None:
    found = judged(*OUT_AND_BACK, item(Cmd.DO_JUMP, 2.0, -1.0), endurance_s=endurance_s)
    assert found.refusal is not None
    assert found.refusal.sentence.startswith("item 4 (DO_JUMP) repeats for ever, and item ")


def test_so_does_what_is_repeated_as_often_as_an_item_can_say() -> None:
    found = judged(*OUT_AND_BACK, item(Cmd.DO_JUMP, 2.0, 32_767.0), endurance_s=3_000.0)
    assert found.refusal is not None
    assert found.refusal.code is Code.BATTERY_REACH


def test_a_battery_that_is_low_flies_no_mission() -> None:
    found = judged(*LANDS, endurance_s=10_000.0, ground=replace(GROUND, battery_pct=20.0))
    assert found.refusal is not None
    assert "low after 0 s" in found.refusal.sentence


def test_a_battery_of_which_nothing_is_told_flies_no_mission() -> None:
    found = judged(*LANDS, endurance_s=10_000.0, ground=replace(GROUND, battery_pct=None))
    assert found.refusal is not None
    assert found.refusal.code is Code.BATTERY_REACH
    assert "has not told how much charge" in found.refusal.sentence


def test_what_leaves_the_fence_is_told_before_the_battery() -> None:
    far = item(Cmd.NAV_WAYPOINT, to=(500.0, 0.0, 10.0))
    codes = [each.code for each in judged(*LANDS[:1], far, endurance_s=60.0).refusals]
    assert codes[0] is not Code.BATTERY_REACH
    assert codes[-1] is Code.BATTERY_REACH


def test_the_time_is_not_judged_where_the_way_is_not_known() -> None:
    nowhere = item(Cmd.DO_JUMP, 9.0, 1.0)
    codes = [each.code for each in judged(*LANDS[:3], nowhere, endurance_s=5.0).refusals]
    assert codes == [Code.BAD_MISSION]
