"""The whole mission before the gate's verifier: legs, circles, problems, and the ways home."""

from __future__ import annotations

from dataclasses import replace

import pytest

from gcs.frames import ned_from_enu
from gcs.gate.airspace.projection import Origin, Projection
from gcs.gate.airspace.verifier import Verifier, verifier_for
from gcs.gate.policy.parse import DEFAULT, parse_policy
from gcs.gate.policy.zonespec import CircleSpec
from gcs.gate.refusal import Code
from gcs.plan.legs import Ground
from gcs.plan.model import Frame, Item, Local, Plan
from gcs.plan.verify import Verification, verify
from gcs.wire.ids import Cmd

ORIGIN = Origin(47.397742, 8.545594, 488.0)
HOME = (0.0, 0.0, 0.0)
GROUND = Ground("px4", HOME, HOME, Projection(ORIGIN, "px4").north_east, 488.0, return_up_m=30.0)
TOWER = CircleSpec(3.0, (10.0, 10.0), name="tower", inclusion=False)
"""East 10, north 10: between home and the far corner, beside every leg of ROUND."""


COPTER = replace(GROUND, autopilot="ardupilot")


def verifier(*zones: CircleSpec, blocked_return: str) -> Verifier:
    policy = parse_policy(f'mission.blocked_return = "{blocked_return}"', "my.toml")
    return verifier_for(policy, "px4", HOME, ORIGIN, zones)


def item(command: Cmd, east: float, north: float, up: float, *, radius_m: float = 0.0) -> Item:
    return Item(command, Frame.LOCAL, (1.0, 0.0, radius_m, 0.0), Local(north, east, up), 0)


ROUND = (
    item(Cmd.NAV_TAKEOFF, 0, 0, 5),
    item(Cmd.NAV_WAYPOINT, 20, 0, 5),
    item(Cmd.NAV_WAYPOINT, 20, 20, 5),
    item(Cmd.NAV_WAYPOINT, 0, 20, 5),
    item(Cmd.NAV_LAND, 0, 0, 0),
)


def checked(
    *items: Item,
    ground: Ground = GROUND,
    zones: tuple[CircleSpec, ...] = (TOWER,),
    blocked_return: str = DEFAULT.mission.blocked_return,
) -> Verification:
    numbered = tuple(replace(one, do_jump_id=i) for i, one in enumerate(items, start=1))
    return verify(
        Plan("a", None, None, numbered), ground, verifier(*zones, blocked_return=blocked_return)
    )


def test_every_leg_and_circle_has_a_verdict_and_the_numbers_add_up() -> None:
    circle = item(Cmd.NAV_LOITER_TURNS, 40, 0, 5, radius_m=4.0)
    found = checked(*ROUND[:2], circle, ground=COPTER, zones=())
    assert [(v.item, v.kind, v.radius_m) for v in found.verdicts] == [
        (0, "climb", 0.0),
        (1, "leg", 0.0),
        (2, "leg", 0.0),
        (2, "entry", 0.0),
        (2, "turn", 0.0),
        (2, "circle", 4.0),
    ]
    assert found.refusal is None
    assert found.return_warning is None
    assert dict(found.evidence) == pytest.approx({"legs": 3.0, "length_m": 5.0 + 20.0 + 16.0})


def test_the_first_refusal_names_its_item() -> None:
    far = item(Cmd.NAV_WAYPOINT, 300, 0, 5)
    refusal = checked(*ROUND[:2], far, far, zones=()).refusal
    assert refusal is not None
    assert refusal.code is Code.OUTSIDE_FENCE
    assert refusal.sentence.startswith("item 3: ")
    assert refusal.zone == "home"
    assert refusal.numbers


def test_a_circle_that_leaves_the_fence_is_refused_though_the_way_to_it_is_clear() -> None:
    wide = item(Cmd.NAV_LOITER_TURNS, 40, 0, 5, radius_m=140.0)
    found = checked(ROUND[0], wide, ground=COPTER, zones=())
    assert [v.kind for v in found.verdicts if v.refusal is not None] == ["circle"]
    assert found.refusal is not None
    assert found.refusal.sentence.startswith("item 2: the circle of 140")


def test_what_cannot_be_known_of_the_path_refuses_before_any_leg() -> None:
    nowhere = replace(ROUND[0], command=Cmd.NAV_RETURN_TO_LAUNCH, frame=Frame.MISSION)
    no_height = replace(GROUND, return_up_m=None)
    refusal = checked(ROUND[0], nowhere, ground=no_height).refusal
    assert refusal is not None
    assert refusal.code is Code.RTL_BLOCKED
    assert "item 2 (NAV_RETURN_TO_LAUNCH): the vehicle's return height" in refusal.sentence

    jump = replace(nowhere, command=Cmd.DO_JUMP, params=(9.0, 1.0, 0.0, 0.0))
    refusal = checked(ROUND[0], jump).refusal
    assert refusal is not None
    assert refusal.code is Code.BAD_MISSION


def test_a_return_through_an_exclusion_zone_refuses_the_mission() -> None:
    refusal = checked(*ROUND).refusal
    assert refusal is not None
    assert (refusal.code, refusal.zone) == (Code.RTL_BLOCKED, "tower")
    assert refusal.sentence.startswith(
        "item 3: a failsafe return from here cannot be stopped: return blocked: "
    )
    assert refusal.sentence.endswith("(the policy's mission.blocked_return)")


@pytest.mark.parametrize(
    ("choice", "refused"), [("refuse", True), ("refuse_exclusions", False), ("warn", False)]
)
def test_a_return_above_a_ceiling_refuses_the_mission_where_the_policy_says_so(
    choice: str, refused: bool
) -> None:
    low_ceiling = CircleSpec(100.0, name="hall", ceiling_up_m=20.0)
    found = checked(*ROUND, zones=(low_ceiling,), blocked_return=choice)
    assert (found.refusal is not None) == refused
    assert found.return_warning is not None


def test_an_exclusion_zone_is_found_behind_the_ceiling_that_hides_it() -> None:
    """The return passes both; the ceiling of the first zone would only be told of."""
    low_ceiling = CircleSpec(100.0, name="hall", ceiling_up_m=20.0)
    refusal = checked(*ROUND, zones=(low_ceiling, TOWER)).refusal
    assert refusal is not None
    assert refusal.zone == "tower"


def test_a_return_through_a_zone_is_a_warning_where_the_policy_says_so() -> None:
    found = checked(*ROUND, blocked_return="warn")
    assert found.refusal is None
    assert [blocked.item for blocked in found.blocked_returns] == [2]
    assert found.blocked_returns[0].refusal.code is Code.RTL_BLOCKED
    assert found.blocked_returns[0].refusal.zone == "tower"
    assert found.return_warning is not None
    after, why = found.return_warning
    assert after == "the vehicle's own failsafe return cannot be gated; after item 3"
    assert "exclusion circle 'tower'" in why
    assert dict(found.evidence)["returns_blocked"] == 1.0
    assert dict(found.evidence)["return_blocked_after_item"] == 3.0


def test_every_blocked_return_is_named_once() -> None:
    low_ceiling = CircleSpec(100.0, name="hall", ceiling_up_m=20.0)
    found = checked(*ROUND, zones=(low_ceiling,))
    assert [blocked.item for blocked in found.blocked_returns] == [0, 1, 2, 3, 4]
    assert found.return_warning is not None
    assert found.return_warning[0].endswith("after item 1, 2, 3, 4, 5")
    assert dict(found.evidence)["returns_blocked"] == 5.0


def test_without_a_return_height_nothing_is_said_of_returns() -> None:
    found = checked(*ROUND, ground=replace(GROUND, return_up_m=None))
    assert found.refusal is None
    assert found.blocked_returns == ()


def test_the_way_starts_where_the_vehicle_is() -> None:
    inside_the_tower = replace(GROUND, start_ned=ned_from_enu((10.0, 10.0, 5.0)))
    refusal = checked(*ROUND, ground=inside_the_tower).refusal
    assert refusal is not None
    assert refusal.zone == "tower"
