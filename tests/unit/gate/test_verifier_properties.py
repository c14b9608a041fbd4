"""What must hold of every verdict: no worse input, no wider margin ever permits more."""

from __future__ import annotations

import dataclasses
import math

import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from msgspec import structs

from gcs.frames import Vec3
from gcs.gate.airspace.bounds import Cleared
from gcs.gate.airspace.verifier import Verifier
from gcs.gate.airspace.zones import Zone
from gcs.gate.geometry import Circle, Polygon, polygon_fault
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.refusal import Code, Refusal
from tests.shares import examples

STILL: Vec3 = (0.0, 0.0, 0.0)

ground = st.floats(-60.0, 60.0)
heights = st.floats(-2.0, 30.0)
places = st.tuples(ground, ground, heights.map(lambda up: -up))
velocities = st.tuples(*[st.floats(-8.0, 8.0)] * 3)
wider = st.floats(0.0, 5.0)
anything = st.floats(allow_nan=True, allow_infinity=True)


@st.composite
def zones(draw: st.DrawFn, inclusion: bool) -> Zone:
    floor = draw(st.sampled_from([-math.inf, 0.0, 3.0]))
    ceiling = draw(st.sampled_from([math.inf, 10.0, 25.0]))
    if draw(st.booleans()):
        radius_m = draw(st.floats(40.0, 90.0) if inclusion else st.floats(1.0, 15.0))
        return Zone(
            "c", inclusion, Circle(draw(st.tuples(ground, ground)), radius_m), floor, ceiling
        )
    n = draw(st.integers(3, 7))
    scale = (30.0, 90.0) if inclusion else (2.0, 20.0)
    east, north = draw(st.tuples(ground, ground)) if not inclusion else (0.0, 0.0)
    corners = tuple(
        (
            east + r * math.cos(math.tau * k / n),
            north + r * math.sin(math.tau * k / n),
        )
        for k, r in enumerate(draw(st.lists(st.floats(*scale), min_size=n, max_size=n)))
    )
    assume(polygon_fault(corners) is None)
    return Zone("p", inclusion, Polygon(corners), floor, ceiling)


@st.composite
def verifiers(draw: st.DrawFn) -> Verifier:
    inside = draw(st.lists(zones(inclusion=True), min_size=1, max_size=2))
    outside = draw(st.lists(zones(inclusion=False), max_size=2))
    policy = structs.replace(
        DEFAULT,
        bounds_inclusive=draw(st.booleans()),
        min_up_m=-5.0,
        margin_h_m=draw(st.floats(0.0, 3.0)),
        margin_v_m=draw(st.floats(0.0, 1.0)),
    )
    return Verifier(policy, (*inside, *outside), "px4", STILL, origin_known=False)


def changed(verifier: Verifier, **keys: float) -> Verifier:
    policy = structs.replace(verifier.policy, **keys)
    return dataclasses.replace(verifier, policy=policy)


@pytest.mark.slow
@settings(max_examples=examples(300))
@given(verifiers(), places, places, velocities, wider, wider)
def test_a_wider_margin_never_accepts_what_a_narrower_refuses(
    narrow: Verifier, goal: Vec3, start: Vec3, v: Vec3, more_h: float, more_v: float
) -> None:
    policy = narrow.policy
    wide = changed(
        narrow, margin_h_m=policy.margin_h_m + more_h, margin_v_m=policy.margin_v_m + more_v
    )
    if isinstance(wide.goal(goal, None, start, v), Cleared):
        assert isinstance(narrow.goal(goal, None, start, v), Cleared)
    for floor_applies in (True, False):
        if isinstance(wide.hold_point(start, v, floor_applies=floor_applies), Cleared):
            answer = narrow.hold_point(start, v, floor_applies=floor_applies)
            assert isinstance(answer, Cleared)
        if wide.predicted_stop(start, v, floor_applies=floor_applies) is None:
            assert narrow.predicted_stop(start, v, floor_applies=floor_applies) is None


@pytest.mark.slow
@settings(max_examples=examples(300))
@given(verifiers(), places, places)
def test_a_leg_that_is_cleared_leaves_no_zone_to_shapely_either(
    verifier: Verifier, goal: Vec3, start: Vec3
) -> None:
    if not isinstance(verifier.goal(goal, None, start, STILL), Cleared):
        return
    leg = shapely.LineString([(start[1], start[0]), (goal[1], goal[0])])
    low, high = sorted((-start[2], -goal[2]))
    # Inclusive bounds allow the boundary; the lab's slack is not in play with a margin.
    slack_m = 1e-5 - min(0.0, verifier.policy.margin_h_m - 1.0)
    for zone in verifier.zones:
        shape = zone.shape
        if isinstance(shape, Circle):
            body = shapely.Point(shape.centre_en).buffer(shape.radius_m, quad_segs=64)
        else:
            body = shapely.Polygon(shape.corners_en)
        if zone.inclusion:
            assert body.buffer(slack_m + 0.05).covers(leg)
            assert high <= zone.ceiling_up_m + 0.31
        elif zone.floor_up_m < low and high < zone.ceiling_up_m:
            assert not body.buffer(-1e-5).intersects(leg)


@given(verifiers(), places, places, velocities, st.floats(1.0, 4.0))
def test_faster_never_permits_more(
    verifier: Verifier, goal: Vec3, start: Vec3, v: Vec3, k: float
) -> None:
    faster = (v[0] * k, v[1] * k, v[2] * k)
    if isinstance(verifier.goal(goal, None, start, faster), Cleared):
        assert isinstance(verifier.goal(goal, None, start, v), Cleared)
    if verifier.predicted_stop(start, faster, floor_applies=True) is None:
        assert verifier.predicted_stop(start, v, floor_applies=True) is None


@given(verifiers(), places, places, velocities)
def test_weaker_brakes_and_a_stranger_never_permit_more(
    verifier: Verifier, goal: Vec3, start: Vec3, v: Vec3
) -> None:
    stranger = dataclasses.replace(verifier, autopilot="betaflight")
    weak = structs.replace(
        verifier.policy.braking["px4"], react_s=1.0, a_brake_h_m_s2=1.0, a_brake_v_m_s2=1.0
    )
    policy = structs.replace(verifier.policy, braking={"px4": weak})
    for worse in (stranger, dataclasses.replace(verifier, policy=policy)):
        if isinstance(worse.goal(goal, None, start, v), Cleared):
            assert isinstance(verifier.goal(goal, None, start, v), Cleared)


@given(verifiers(), zones(inclusion=False), places, places, velocities)
def test_one_more_zone_never_permits_more(
    verifier: Verifier, zone: Zone, goal: Vec3, start: Vec3, v: Vec3
) -> None:
    more = dataclasses.replace(verifier, zones=(*verifier.zones, zone))
    if isinstance(more.goal(goal, None, start, v), Cleared):
        assert isinstance(verifier.goal(goal, None, start, v), Cleared)


@given(verifiers(), places, places, velocities)
def test_an_unknown_fence_never_permits_anything(
    verifier: Verifier, goal: Vec3, start: Vec3, v: Vec3
) -> None:
    unknown = dataclasses.replace(verifier, zones=())
    assert isinstance(unknown.goal(goal, None, start, v), Refusal)
    assert isinstance(unknown.takeoff(2.0, start), Refusal)


@pytest.mark.slow
@settings(max_examples=examples(300))
@given(verifiers(), st.tuples(*[anything] * 3), st.tuples(*[anything] * 3), anything, anything)
def test_whatever_the_numbers_there_is_an_answer_and_never_yes_to_nonsense(
    verifier: Verifier, pos: Vec3, v: Vec3, yaw: float, up_m: float
) -> None:
    finite = all(map(math.isfinite, (*pos, *v, yaw)))
    for fence_on in (True, False):
        asked = dataclasses.replace(verifier, fence_on=fence_on)
        answer = asked.goal(pos, yaw, (0.0, 0.0, -5.0), v)
        if not finite:
            assert isinstance(answer, Refusal)
            assert answer.code is Code.NON_FINITE
        moving = asked.goal((0.0, 0.0, -5.0), None, pos, v)
        held = asked.hold_point(pos, v, floor_applies=False)
        breach = asked.predicted_stop(pos, v, floor_applies=True)
        if not all(map(math.isfinite, (*pos, *v))):
            assert isinstance(moving, Refusal)
            assert isinstance(held, Refusal)
            assert breach is not None
            assert breach.brake_pos_ned is None
        climb = asked.takeoff(up_m, pos)
        home = asked.return_path(pos, v, up_m)
        if not all(map(math.isfinite, (*pos, up_m))):
            assert isinstance(climb, Refusal)
            assert isinstance(home, Refusal)


@pytest.mark.slow
@settings(max_examples=examples(300))
@given(verifiers(), places, velocities, st.booleans())
def test_a_brake_is_always_a_place_that_may_be_held(
    verifier: Verifier, pos: Vec3, v: Vec3, floor_applies: bool
) -> None:
    breach = verifier.predicted_stop(pos, v, floor_applies=floor_applies)
    if breach is not None and breach.brake_pos_ned is not None:
        held = verifier.hold_point(breach.brake_pos_ned, STILL, floor_applies=floor_applies)
        assert isinstance(held, Cleared)


@pytest.mark.slow
@settings(max_examples=examples(300))
@given(verifiers(), places, places)
def test_what_is_verified_as_a_goal_can_be_hovered_at(
    verifier: Verifier, goal: Vec3, start: Vec3
) -> None:
    roomy = changed(verifier, margin_h_m=2.0, margin_v_m=0.3)
    if isinstance(roomy.goal(goal, None, start, STILL), Cleared):
        assert roomy.predicted_stop(goal, (0.1, -0.1, 0.1), floor_applies=True) is None
