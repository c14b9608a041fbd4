"""The geometric path of a plan, in local NED metres."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import pytest

from gcs.frames import Vec3
from gcs.gate.airspace.projection import Origin, Projection
from gcs.plan.flown.path import flight_path
from gcs.plan.legs import FlightPath, Ground, LegKind, LoiterCircle, ProblemKind
from gcs.plan.model import AutopilotName, Frame, Geographic, Item, Local, Plan

ORIGIN = Origin(47.397742, 8.545594, 488.0)
PROJECTION = Projection(ORIGIN, "px4")
GROUND = Ground(
    "px4",
    home_ned=(0.0, 0.0, 0.0),
    start_ned=(0.0, 0.0, 0.0),
    north_east_of=PROJECTION.north_east,
    origin_alt_amsl_m=488.0,
    return_up_m=30.0,
)
COPTER = replace(GROUND, autopilot="ardupilot")
"""PX4 refuses LOITER_TURNS and splines at upload (scenario C8_upload_item_kinds)."""
NOTHING = (0.0, 0.0, 0.0, 0.0)
CIRCLE = (2.0, 0.0, 4.0, 0.0)


def at(
    north: float, east: float, up: float, command: int = 16, p: tuple[float, ...] = NOTHING
) -> Item:
    place = Local(north, east, up)
    return Item(command, Frame.LOCAL, (p[0], p[1], p[2], p[3]), place, 0)


def jump(to: int, repeats: float = 1.0) -> Item:
    return replace(at(0, 0, 0), command=177, frame=Frame.MISSION, params=(to, repeats, 0.0, 0.0))


def tag(number: float) -> Item:
    return replace(jump(0), command=600, params=(number, 0.0, 0.0, 0.0))


def to_tag(number: float, repeats: float = 1.0) -> Item:
    return replace(jump(0), command=601, params=(number, repeats, 0.0, 0.0))


def path(*items: Item, ground: Ground = GROUND) -> FlightPath:
    numbered = tuple(replace(item, do_jump_id=i) for i, item in enumerate(items, start=1))
    return flight_path(Plan("a", None, None, numbered), ground)


def legs(flown: FlightPath) -> list[tuple[int, str, Vec3]]:
    return [(leg.item, leg.kind.name, leg.to_ned) for leg in flown.legs]


def test_take_off_waypoints_and_landing() -> None:
    flown = path(at(0, 0, 5, 22), at(10, 0, 5), at(10, 10, 8), at(0, 0, 0, 21))

    assert legs(flown) == [
        (0, "CLIMB", (0, 0, -5)),
        (1, "STRAIGHT", (10, 0, -5)),
        (2, "STRAIGHT", (10, 10, -8)),
        (3, "STRAIGHT", (0, 0, -8)),
        (3, "DESCENT", (0, 0, 0)),
    ]
    assert [leg.floor_applies for leg in flown.legs] == [False, True, True, True, False]
    assert flown.problems == ()


def test_px4_flies_from_its_climb_to_the_take_off_position_and_ardupilot_does_not() -> None:
    items = (at(4, 0, 5, 22), at(10, 0, 5))

    px4, ardupilot = path(*items), path(*items, ground=replace(GROUND, autopilot="ardupilot"))

    assert [leg.to_ned for leg in px4.legs] == [(0, 0, -5), (4, 0, -5), (10, 0, -5)]
    assert [leg.to_ned for leg in ardupilot.legs] == [(0, 0, -5), (10, 0, -5)]


def test_a_take_off_in_the_air_does_not_descend() -> None:
    flown = path(at(0, 0, 5, 22), ground=replace(GROUND, start_ned=(0.0, 0.0, -9.0)))

    assert flown.legs == ()


def test_heights_count_from_their_own_datum() -> None:
    lat, lon = PROJECTION.lat_lon(10.0, 0.0)
    relative = Item(16, Frame.HOME, NOTHING, Geographic(lat, lon, 7.0), 1)
    amsl = Item(16, Frame.AMSL, NOTHING, Geographic(lat, lon, 500.0), 2)
    high_home = replace(GROUND, home_ned=(0.0, 0.0, -2.0))

    flown = flight_path(Plan("a", None, None, (relative, amsl)), high_home)

    assert [round(leg.to_ned[2], 6) for leg in flown.legs] == [-9.0, -12.0]


@pytest.mark.parametrize(("up", "return_down"), [(5.0, -30.0), (40.0, -40.0)])
def test_a_return_climbs_to_its_height_or_stays_above_it(up: float, return_down: float) -> None:
    flown = path(at(0, 0, up, 22), at(20, 0, up), replace(at(0, 0, 0), command=20))

    home_legs = [leg for leg in flown.legs if leg.item == 2]
    assert home_legs[-2].to_ned == pytest.approx((0, 0, return_down))
    assert home_legs[-2].kind is LegKind.RETURN
    assert home_legs[-1].to_ned == pytest.approx((0, 0, 0))


def test_what_follows_a_return_is_not_flown() -> None:
    flown = path(at(0, 0, 5, 22), replace(at(0, 0, 0), command=20), at(500, 0, 5))

    assert {leg.item for leg in flown.legs} == {0, 1}


def test_a_jump_adds_the_leg_that_only_it_flies() -> None:
    flown = path(at(0, 0, 5, 22), at(10, 0, 5), at(10, 10, 5), jump(2), at(0, 10, 5))

    assert ((10, 10, -5), (10, 0, -5)) in flown.segments
    assert ((10, 10, -5), (0, 10, -5)) in flown.segments
    assert len(flown.segments) == len(set(flown.segments)) == 5


def test_a_jump_that_never_jumps_adds_nothing() -> None:
    flown = path(at(0, 0, 5, 22), at(10, 0, 5), at(10, 10, 5), jump(2, repeats=0.0))

    assert len(flown.legs) == 3


def test_a_jump_forward_shows_both_ways() -> None:
    flown = path(at(0, 0, 5, 22), jump(4), at(10, 0, 5), at(0, 10, 5))

    assert ((0, 0, -5), (0, 10, -5)) in flown.segments
    assert ((0, 0, -5), (10, 0, -5)) in flown.segments


def test_a_jump_loop_without_a_waypoint_ends() -> None:
    assert path(at(0, 0, 5, 22), jump(3), jump(2)).problems == ()


def test_a_circle_is_entered_at_its_nearest_point_and_left_there_after_whole_turns() -> None:
    turns = at(20, 0, 5, 18, (2.0, 0.0, 6.0, 0.0))
    flown = path(at(0, 0, 5, 22), turns, at(20, 30, 5), ground=COPTER)

    assert flown.circles == (LoiterCircle(1, (20.0, 0.0, -5.0), 6.0),)
    assert flown.segments[1][1] == pytest.approx((14, 0, -5))
    assert flown.segments[2][0] == pytest.approx((14, 0, -5))


@pytest.mark.parametrize(("radius", "east"), [(6.0, -6.0), (-6.0, 6.0)])
def test_a_quarter_turn_leaves_the_circle_on_the_side_it_turns_to(
    radius: float, east: float
) -> None:
    turns = at(20, 0, 5, 18, (0.25, 0.0, radius, 0.0))
    flown = path(at(0, 0, 5, 22), turns, at(20, 0, 9), ground=COPTER)

    assert flown.segments[2][0] == pytest.approx((20, east, -5))


def test_turns_without_end_through_a_jump_are_given_up_and_said() -> None:
    turns = at(20, 0, 5, 18, (0.123, 0.0, 6.0, 0.0))
    flown = path(at(0, 0, 5, 22), turns, jump(2, -1.0), ground=COPTER)

    assert [problem.kind for problem in flown.problems] == [ProblemKind.TOO_MANY_WAYS]


def geographic(frame: Frame, place: Geographic, command: int = 16) -> Item:
    return Item(command, frame, NOTHING, place, 1)


def test_a_jump_to_a_tag_is_flown_as_a_jump_to_the_item_that_has_it() -> None:
    """Behind, ahead, from a spline, and never: each leg, region and circle is the same."""
    first, second, last = at(10, 0, 5), at(10, 10, 8, 82), at(0, 10, 5)
    ways: list[Callable[[Item], tuple[Item, ...]]] = [
        lambda jump: (at(0, 0, 5, 22), tag(7), first, second, jump, last),
        lambda jump: (at(0, 0, 5, 22), first, jump, second, tag(7), last),
        lambda jump: (at(0, 0, 5, 22), tag(3), first, tag(7), at(5, 5, 5, 18, CIRCLE), jump),
    ]
    for way, index in zip(ways, (2, 5, 4), strict=True):
        for repeats in (-1.0, 0.0, 3.0):
            by_tag = path(*way(to_tag(7, repeats)), ground=COPTER)
            by_item = path(*way(jump(index, repeats)), ground=COPTER)
            assert by_tag == by_item
            assert by_tag.problems == ()


def test_what_moves_nothing_of_the_vehicle_is_no_leg() -> None:
    plain = path(at(0, 0, 5, 22), at(10, 0, 5), at(10, 10, 8), ground=COPTER)
    for command in (181, 182, 183, 184, 211, 600, 42600):
        item = replace(jump(0), command=command)
        flown = path(at(0, 0, 5, 22), at(10, 0, 5), item, at(10, 10, 8), ground=COPTER)
        assert flown.problems == ()
        assert [leg.to_ned for leg in flown.legs] == [leg.to_ned for leg in plain.legs]


@pytest.mark.parametrize(
    ("item", "ground", "kind"),
    [
        (geographic(Frame.TERRAIN, Geographic(47.4, 8.5, 5.0)), GROUND, ProblemKind.TERRAIN),
        (
            geographic(Frame.HOME, Geographic(47.4, 8.5, 5.0)),
            replace(GROUND, north_east_of=None),
            ProblemKind.NO_ORIGIN,
        ),
        (
            geographic(Frame.AMSL, Geographic(47.4, 8.5, 500.0)),
            replace(GROUND, origin_alt_amsl_m=None),
            ProblemKind.NO_ORIGIN,
        ),
        (geographic(Frame.HOME, Geographic(0.0, 0.0, 5.0)), GROUND, ProblemKind.NO_POSITION),
        (geographic(Frame.HOME, Geographic(47.4, 8.5, math.nan)), GROUND, ProblemKind.NO_HEIGHT),
        (at(1, 0, 5, 82), GROUND, ProblemKind.REFUSED),
        (at(1, 0, 5, 112), GROUND, ProblemKind.NEVER_STARTS),
        (at(1, 0, 5, 530), COPTER, ProblemKind.REFUSED),
        (at(1, 0, 5, 18), COPTER, ProblemKind.NO_RADIUS),
        (at(1, 0, 5, 30001), GROUND, ProblemKind.NOT_FLOWN),
        (at(1, 0, 5, 5001), GROUND, ProblemKind.NOT_OF_A_MISSION),
        (at(1, 0, 5, 179), GROUND, ProblemKind.HOME_MOVES),
        (jump(9), GROUND, ProblemKind.JUMP_NOWHERE),
        (to_tag(9), COPTER, ProblemKind.JUMP_NOWHERE),
        (to_tag(9), GROUND, ProblemKind.REFUSED),
        (at(1, 0, 5, 183), GROUND, ProblemKind.REFUSED),
        (at(1, 0, 5, 94), COPTER, ProblemKind.OWN_DESCENT),
        (at(1, 0, 5, 20), replace(GROUND, return_up_m=None), ProblemKind.NO_RETURN_HEIGHT),
    ],
)
def test_what_cannot_be_known_is_a_problem(item: Item, ground: Ground, kind: ProblemKind) -> None:
    flown = path(item, ground=ground)

    assert [(problem.item, problem.kind) for problem in flown.problems] == [(0, kind)]
    assert "item 1" in flown.problems[0].sentence


@pytest.mark.parametrize(
    ("items", "found"),
    [
        ((at(5, 0, 5), at(0, 0, 5, 22), at(0, 0, 0, 20)), (1, "take-off must be the first")),
        ((at(0, 0, 5, 22), at(0, 0, 0, 21), at(0, 0, 5, 22)), (2, "take-off must be the first")),
        ((at(0, 0, 5, 93), at(0, 0, 5, 22)), (1, "take-off must be the first")),
        ((at(0, 0, 0, 178), at(0, 0, 0, 21), at(5, 0, 5)), (1, "landing must not be the first")),
        ((at(0, 0, 5, 22), at(0, 0, 0, 20), at(0, 0, 0, 112)), (2, "it waits for a condition")),
    ],
    ids=["after a waypoint", "after a landing", "after a delay", "landing", "after the return"],
)
def test_px4_never_starts_it_and_ardupilot_does(
    items: tuple[Item, ...], found: tuple[int, str]
) -> None:
    index, words = found
    (problem,) = path(*items).problems
    assert (problem.item, problem.kind) == (index, ProblemKind.NEVER_STARTS)
    assert words in problem.sentence
    assert path(*items, ground=COPTER).problems == ()


def test_a_take_off_after_what_does_not_fly_is_the_first_item_that_is_flown() -> None:
    speed = at(0, 0, 0, 178)
    assert path(speed, at(0, 0, 5, 22), at(5, 0, 5), at(0, 0, 0, 21)).problems == ()


def test_without_an_origin_a_plan_in_metres_still_has_a_path() -> None:
    ground = replace(GROUND, north_east_of=None, origin_alt_amsl_m=None)

    assert path(at(0, 0, 5, 22), at(3, 0, 5), ground=ground).problems == ()


@pytest.mark.parametrize(("autopilot", "down"), [("px4", 0.0), ("ardupilot", -5.0)])
def test_a_height_of_0_is_the_present_one_for_ardupilot(
    autopilot: AutopilotName, down: float
) -> None:
    lat, lon = PROJECTION.lat_lon(10.0, 0.0)
    level = geographic(Frame.HOME, Geographic(lat, lon, 0.0))

    flown = path(at(0, 0, 5, 22), level, ground=replace(GROUND, autopilot=autopilot))

    assert flown.legs[-1].to_ned[2] == down
