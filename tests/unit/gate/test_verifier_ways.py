"""May it stay, climb, come home, fly a mission; and what if something is not known?"""

from __future__ import annotations

import math

from msgspec import structs

from gcs.frames import Vec3
from gcs.gate.airspace.bounds import Cleared
from gcs.gate.airspace.projection import Origin
from gcs.gate.airspace.verifier import Verifier, check_start, verifier_for
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import Circle
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.zonespec import CircleSpec
from gcs.gate.refusal import Code, Refusal
from tests.unit.gate.airspace import HOME, OUTER, STILL, TOWER, around, at, flying, go

NAN = math.nan


# -------------------------------------------------------------- hold, take-off, return


def test_a_hold_needs_to_be_inside_and_able_to_stop_not_to_keep_the_margin() -> None:
    verifier = flying()

    def hold(pos_ned: Vec3, v_ned: Vec3 = STILL, *, floor_applies: bool = True) -> Code | None:
        answer = verifier.hold_point(pos_ned, v_ned, floor_applies=floor_applies)
        return answer.code if isinstance(answer, Refusal) else None

    assert hold(at(149.0, 0, 2)) is None
    assert hold(at(150.0, 0, 2)) is Code.TOO_CLOSE
    assert hold(at(150.5, 0, 2)) is Code.OUTSIDE_FENCE
    assert hold(at(149.0, 0, 2), at(5, 0, 0)) is Code.CANNOT_STOP
    assert hold(at(0, 0, 0.0)) is Code.TOO_CLOSE
    assert hold(at(0, 0, -0.1), floor_applies=False) is None
    assert hold(at(0, 0, 55)) is Code.OUTSIDE_FENCE


def test_a_take_off_judges_the_climb_and_its_top() -> None:
    def off(verifier: Verifier, up_m: float, start: Vec3) -> Code | None:
        answer = verifier.takeoff(up_m, start)
        return answer.code if isinstance(answer, Refusal) else None

    verifier = flying()
    ground = at(0, 0, -0.04)
    assert off(verifier, 2.0, ground) is None
    assert off(verifier, 0.5, ground) is None
    assert off(verifier, 0.0, ground) is Code.TOO_LOW
    assert off(verifier, -2.0, ground) is Code.TOO_LOW
    assert off(verifier, 31.0, ground) is Code.TOO_HIGH
    assert off(verifier, 0.2, ground) is Code.TOO_CLOSE
    assert off(verifier, 30.0, at(0, 0, 25)) is Code.OUTSIDE_FENCE
    assert off(verifier, 2.0, at(149, 0, 0)) is Code.TOO_CLOSE
    lid = Zone("lid", False, Circle((0.0, 0.0), 9.0), 5.0, 8.0)
    assert off(around(OUTER, lid), 12.0, ground) is Code.LEG_LEAVES_FENCE
    assert off(around(OUTER, lid), 3.0, ground) is None


def test_a_return_over_a_tower_is_clear_and_through_it_is_blocked_by_name() -> None:
    verifier = around(OUTER, TOWER)
    assert isinstance(verifier.return_path(at(40, 0, 5), HOME, 30.0), Cleared)
    blocked = verifier.return_path(at(40, 0, 5), HOME, 15.0)
    assert isinstance(blocked, Refusal)
    assert (blocked.code, blocked.zone) == (Code.RTL_BLOCKED, "tower")
    assert "the way home goes inside exclusion polygon 'tower'" in blocked.sentence


def test_a_return_stays_at_its_height_where_that_is_above_the_return_height() -> None:
    verifier = around(OUTER, TOWER)
    assert isinstance(verifier.return_path(at(40, 0, 25), HOME, 10.0), Cleared)


def test_a_return_height_above_the_ceiling_blocks_and_says_so() -> None:
    blocked = flying().return_path(at(10, 0, 5), HOME, 60.0)
    assert isinstance(blocked, Refusal)
    assert blocked.sentence == (
        "return blocked: the climb to return height goes 10.0 m above the ceiling of "
        "inclusion circle 'home'"
    )


def test_a_return_that_touches_is_too_close_to_say() -> None:
    verifier = around(OUTER, TOWER)
    assert isinstance(verifier.return_path(at(40, 0, 20.0), HOME, 20.0), Refusal)
    assert isinstance(verifier.return_path(at(40, 0, 20.1), HOME, 20.0), Cleared)


def test_a_return_needs_no_floor_and_no_margin() -> None:
    assert isinstance(flying().return_path(at(149.5, 0, 1), HOME, 10.0), Cleared)


# ----------------------------------------------------------------------------- mission


def code_of(refusal: Refusal | None) -> Code | None:
    return None if refusal is None else refusal.code


def test_a_leg_of_a_mission_is_judged_with_its_end() -> None:
    verifier = around(OUTER, TOWER)
    corner = at(0, 40, 10)
    assert verifier.mission_leg(at(0, 0, 10), corner, floor_applies=True) is None
    through = verifier.mission_leg(corner, at(50, -40, 10), floor_applies=True)
    assert code_of(through) is Code.LEG_LEAVES_FENCE
    outside = verifier.mission_leg(corner, at(160, 40, 10), floor_applies=True)
    assert code_of(outside) is Code.OUTSIDE_FENCE
    nowhere = verifier.mission_leg(corner, at(NAN, 0, 10), floor_applies=True)
    assert code_of(nowhere) is Code.NON_FINITE


def test_a_leg_that_leaves_or_reaches_the_ground_is_free_of_the_floor() -> None:
    verifier = around(OUTER, TOWER)
    over, ground = at(0, 40, 10), at(0, 40, 0)
    assert verifier.mission_leg(ground, over, floor_applies=False) is None
    assert verifier.mission_leg(over, ground, floor_applies=False) is None
    assert code_of(verifier.mission_leg(over, ground, floor_applies=True)) is Code.TOO_CLOSE


def test_a_mission_keeps_room_for_the_wind_that_it_is_verified_for() -> None:
    """A quarter of a metre for each m/s, where that is more than the margin of a goal."""
    near = CircleSpec(5.0, (0.0, 0.0), name="mast", inclusion=False)
    wide = CircleSpec(100.0, (0.0, 0.0), name="field", inclusion=True)

    def verdicts(margin_m: float, wind_m_s: float, away_m: float) -> list[Code | None]:
        policy = structs.replace(DEFAULT, margin_h_m=margin_m, mission_wind_m_s=wind_m_s)
        verifier = verifier_for(policy, "px4", HOME, Origin(47.0, 8.0, 400.0), (wide, near))
        east = 5.0 + away_m
        a, b = at(east, -20, 10), at(east, 20, 10)
        leg = verifier.mission_leg(a, b, floor_applies=True)
        region = verifier.mission_region("it", (a, b), (at(east + 9, 0, 10),), floor_applies=True)
        ring = verifier.mission_circle(at(0, 0, 10), east)
        goal = verifier.goal(b, None, a, STILL)
        return [
            *map(code_of, (leg, region, ring)),
            goal.code if isinstance(goal, Refusal) else None,
        ]

    close = Code.TOO_CLOSE
    assert verdicts(0.5, 0.0, 0.6) == [None, None, None, None]
    assert verdicts(0.5, 8.0, 1.9) == [close, close, close, None]
    assert verdicts(0.5, 8.0, 2.1) == [None, None, None, None]
    assert verdicts(0.5, 12.0, 2.9) == [close, close, close, None]
    assert verdicts(2.0, 8.0, 2.1) == [None, None, None, None]
    assert verdicts(2.0, 2.0, 1.9) == [close, close, close, close]


def test_a_loiter_circle_is_judged_by_its_line_and_not_by_what_it_goes_round() -> None:
    verifier = around(OUTER, TOWER)
    assert verifier.mission_circle(at(0, 40, 10), 20.0) is None
    assert verifier.mission_circle(at(0, 40, 10), 60.0) is None
    assert code_of(verifier.mission_circle(at(0, 40, 10), 45.0)) is Code.INSIDE_EXCLUSION
    assert code_of(verifier.mission_circle(at(0, 40, 30), 111.0)) is Code.OUTSIDE_FENCE
    assert code_of(verifier.mission_circle(at(0, 40, 10), NAN)) is Code.NON_FINITE


# ----------------------------------------------------------------------- what is unknown


def test_without_home_the_default_fence_refuses_everything_that_moves() -> None:
    verifier = verifier_for(DEFAULT, "px4", None, Origin(47.0, 8.0, 400.0))
    here = at(0, 0, 2)
    assert go(verifier, here, here) is Code.NO_ORIGIN
    assert isinstance(verifier.takeoff(2.0, here), Refusal)
    assert isinstance(verifier.hold_point(here, STILL, floor_applies=True), Refusal)
    assert verifier.predicted_stop(here, STILL, floor_applies=True) is not None
    way_home = verifier.return_path(here, HOME, 10.0)
    assert isinstance(way_home, Refusal)
    assert way_home.code is Code.RTL_BLOCKED


def test_a_geographic_plan_zone_waits_for_the_origin_and_is_then_kept_out_of() -> None:
    hangar = CircleSpec(10.0, (47.001, 8.0), name="hangar", inclusion=False, frame="geographic")
    before = verifier_for(DEFAULT, "px4", HOME, None, [hangar])
    assert go(before, at(0, 10, 2), at(0, 0, 2)) is Code.NO_ORIGIN
    after = verifier_for(DEFAULT, "px4", HOME, Origin(47.0, 8.0, 400.0), [hangar])
    assert after.origin_known
    assert go(after, at(0, 10, 2), at(0, 0, 2)) is None
    assert go(after, at(0, 111, 2), at(0, 0, 2)) is Code.INSIDE_EXCLUSION


def test_a_verifier_without_zones_and_with_the_fence_on_knows_nothing() -> None:
    verifier = Verifier(DEFAULT, (), "px4", HOME, origin_known=True)
    assert go(verifier, at(0, 1, 2), at(0, 0, 2)) is Code.NO_ORIGIN


def test_the_start_must_be_inside_but_neither_margin_nor_floor_count() -> None:
    verifier = flying()
    assert check_start(verifier, at(0, 0, -0.5)) is None
    assert check_start(verifier, at(149.5, 0, 0)) is None
    refusal = check_start(verifier, at(200, 0, 0))
    assert refusal is not None
    assert refusal.sentence == (
        "start position (200.00 E, 0.00 N, 0.00 U) is 50.0 m outside inclusion circle 'home'"
    )
    tower = check_start(around(OUTER, TOWER), at(25, 0, 0))
    assert tower is not None
    assert tower.code is Code.INSIDE_EXCLUSION
    nan = check_start(verifier, (NAN, 0.0, 0.0))
    assert nan is not None
    assert nan.code is Code.NON_FINITE


def test_heights_count_from_home_not_from_the_origin() -> None:
    verifier = verifier_for(DEFAULT, "px4", at(0, 0, 100), None)
    assert go(verifier, at(0, 0, 102), at(0, 0, 105)) is None
    assert go(verifier, at(0, 0, 2), at(0, 0, 105)) is Code.TOO_LOW
    assert go(verifier, at(0, 0, 151), at(0, 0, 105)) is Code.OUTSIDE_FENCE
