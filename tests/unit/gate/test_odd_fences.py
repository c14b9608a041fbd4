"""Fences at the ends of the map, as a user writes them: judged right, or refused with a reason.

The date line, the poles, holes, closed rings, legs without length, ten kilometres.
"""

from __future__ import annotations

import pytest

from gcs.gate.airspace.bounds import Cleared
from gcs.gate.airspace.projection import Origin, Projection
from gcs.gate.airspace.verifier import Verifier, verifier_for
from gcs.gate.policy.parse import parse_policy
from gcs.gate.refusal import Code, Refusal
from tests.unit.gate.airspace import STILL, at

WIDE = "max_distance_m = 30000\n"
PERSONALITIES = ("px4", "ardupilot")
autopilots = pytest.mark.parametrize("autopilot", PERSONALITIES)


def fence(corners: str, autopilot: str, origin: Origin) -> Verifier:
    text = f'{WIDE}[[fence]]\nname = "a"\nkind = "polygon"\nframe = "geographic"\n{corners}'
    return verifier_for(parse_policy(text, "my.toml"), autopilot, (0.0, 0.0, 0.0), origin)


def flies_to(verifier: Verifier, origin: Origin, lat_deg: float, lon_deg: float) -> Code | None:
    """Why it may not fly there from the origin, 10 m up; None where it may."""
    projection = Projection(origin, verifier.autopilot)
    north_m, east_m = projection.north_east(lat_deg, lon_deg)
    answer = verifier.goal((north_m, east_m, -10.0), None, (0.0, 0.0, -10.0), STILL)
    return answer.code if isinstance(answer, Refusal) else None


@autopilots
@pytest.mark.parametrize("lon_deg", [179.995, 180.0, -180.0, -179.995])
def test_a_fence_across_the_date_line(autopilot: str, lon_deg: float) -> None:
    """2.2 km square, whatever side of the line the vehicle starts on."""
    corners = "corners = [[10.0, 179.99], [10.0, -179.99], [10.02, -179.99], [10.02, 179.99]]"
    origin = Origin(10.01, lon_deg, 0.0)
    verifier = fence(corners, autopilot, origin)
    for inside in (179.991, 179.999, -179.999, -179.991):
        assert flies_to(verifier, origin, 10.01, inside) is None
    for outside in (179.98, -179.98, 0.0):
        assert flies_to(verifier, origin, 10.01, outside) is not None


ROUND_THE_POLE = "corners = [[89.99, 0], [89.99, 90], [89.99, 180], [89.99, -90]]"


@pytest.mark.parametrize("lat_deg", [89.995, 90.0])
def test_a_fence_round_the_pole(lat_deg: float) -> None:
    """1.1 km from the pole to each corner; the other side of the pole is 180 degrees away."""
    origin = Origin(lat_deg, 0.0, 0.0)
    verifier = fence(ROUND_THE_POLE, "px4", origin)
    assert flies_to(verifier, origin, 89.997, 180.0) is None
    assert flies_to(verifier, origin, 89.997, 45.0) is None
    assert flies_to(verifier, origin, 89.985, 180.0) is Code.OUTSIDE_FENCE
    assert flies_to(verifier, origin, 89.991, 45.0) is Code.OUTSIDE_FENCE  # beside an edge


@pytest.mark.parametrize(
    ("corners", "lat_deg"),
    [
        (ROUND_THE_POLE, 89.995),
        ("corners = [[88.9, -170], [88.9, 170], [89.1, 170], [89.1, -170]]", 89.0),
        ("corners = [[85, -120], [85, 0], [85, 120]]", 85.0),
    ],
    ids=["round the pole", "behind the pole", "round it, 560 km away"],
)
def test_near_a_pole_ardupilots_own_map_is_torn(corners: str, lat_deg: float) -> None:
    """In that map the second zone reaches all round the pole, and is a 20 degrees' part of it."""
    verifier = fence(corners, "ardupilot", Origin(lat_deg, 0.0, 0.0))
    answer = verifier.goal(at(5, 5, 10), None, at(0, 0, 10), STILL)
    assert isinstance(answer, Refusal)
    assert answer.code is Code.POLICY
    assert "the vehicle's own map does not hold at" in answer.sentence


@autopilots
def test_a_fence_too_far_to_compute_with_is_refused(autopilot: str) -> None:
    origin = Origin(47.4, 8.5, 488.0)
    corners = "corners = [[-47.4, -170.5], [-47.4, -170.51], [-47.41, -170.51]]"
    answer = fence(corners, autopilot, origin).goal(at(5, 5, 10), None, at(0, 0, 10), STILL)
    assert isinstance(answer, Refusal)
    assert answer.sentence == "fence zone 'a': corner 1 is not a place within 1000 km"


HOLED = """
[[fence]]
name = "field"
radius_m = 100
[[fence]]
name = "hole"
kind = "polygon"
inclusion = false
corners = [[20, -10], [40, -10], [40, 10], [20, 10], [20, -10]]
"""


def holed() -> Verifier:
    return verifier_for(parse_policy(HOLED, "my.toml"), "px4", (0.0, 0.0, 0.0), None)


@pytest.mark.parametrize(
    ("goal", "code"),
    [
        ((30, 0), Code.INSIDE_EXCLUSION),
        ((60, 0), Code.LEG_LEAVES_FENCE),
        ((40, 50), None),
        ((41, 0), Code.TOO_CLOSE),
        ((0, 0), None),
    ],
)
def test_a_hole_is_not_entered_crossed_or_touched(
    goal: tuple[float, float], code: Code | None
) -> None:
    """(0, 0) is where it is: a leg without length."""
    answer = holed().goal(at(*goal, 10), None, at(0, 0, 10), STILL)
    assert (answer.code if isinstance(answer, Refusal) else None) is code


def test_a_leg_without_length_is_judged_as_its_point() -> None:
    verifier = holed()
    here, hole = at(0, 0, 10), at(30, 0, 10)
    assert verifier.mission_leg(here, here, floor_applies=True) is None
    assert verifier.mission_leg(hole, hole, floor_applies=True) is not None
    assert verifier.mission_region("it", [here], [here], floor_applies=True) is None
    assert verifier.mission_region("it", [hole], [hole], floor_applies=True) is not None


@autopilots
def test_a_fence_of_ten_kilometres(autopilot: str) -> None:
    """The overshoot behind a goal so far away is 0.9 m at the most."""
    origin = Origin(47.4, 8.5, 488.0)
    corners = "corners = [[47.35, 8.43], [47.35, 8.57], [47.45, 8.57], [47.45, 8.43]]"
    verifier = fence(corners, autopilot, origin)
    assert flies_to(verifier, origin, 47.4499, 8.4301) is None
    assert flies_to(verifier, origin, 47.4501, 8.5) is Code.OUTSIDE_FENCE
    assert flies_to(verifier, origin, 47.4, 8.57) is not None
    answer = verifier.goal(at(0, 0, 10), None, at(4000, 4000, 10), STILL)
    assert isinstance(answer, Cleared)
