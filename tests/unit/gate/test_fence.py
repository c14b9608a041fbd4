"""Zones as written, placed in the local frame."""

from __future__ import annotations

import math

import pytest

from gcs.gate.airspace.projection import Origin, Projection
from gcs.gate.airspace.zones import Zone, build_zones
from gcs.gate.geometry import Circle, Polygon
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.zonespec import BoxSpec, CircleSpec, Frame, PolygonSpec
from gcs.gate.refusal import Code, Refusal

HOME_NED = (10.0, 20.0, -3.0)
PX4 = Projection(Origin(47.397742, 8.545594, 488.0), "px4")


def only(built: tuple[Zone, ...] | Refusal) -> Zone:
    assert isinstance(built, tuple)
    (zone,) = built
    return zone


def test_the_default_is_a_circle_around_home_with_heights_above_home() -> None:
    zone = only(build_zones(DEFAULT.fence, HOME_NED, None))
    assert zone == Zone("home", True, Circle((20.0, 10.0), 150.0), 3.0, 53.0)
    assert zone.title == "inclusion circle 'home'"


def test_the_default_cannot_be_placed_before_home_is_known() -> None:
    refusal = build_zones(DEFAULT.fence, None, PX4)
    assert isinstance(refusal, Refusal)
    assert refusal.code is Code.NO_ORIGIN
    assert "home is not known yet" in refusal.sentence
    assert refusal.zone == "home"


def test_a_local_box_needs_neither_home_nor_origin_and_counts_heights_from_the_origin() -> None:
    sides = ((-5.0, 6.0), (-7.0, 8.0))
    spec = BoxSpec(*sides, name="cage", frame="local", floor_up_m=0.0, ceiling_up_m=2.0)
    corners = ((-5.0, -7.0), (6.0, -7.0), (6.0, 8.0), (-5.0, 8.0))
    for home_ned in (None, HOME_NED):
        zone = only(build_zones([spec], home_ned, None))
        assert zone == Zone("cage", True, Polygon(corners), 0.0, 2.0)


def test_a_box_of_home_moves_with_home() -> None:
    spec = BoxSpec((-1.0, 1.0), (-2.0, 2.0), name="yard", frame="home")
    shape = only(build_zones([spec], HOME_NED, None)).shape
    assert shape == Polygon(((19.0, 8.0), (21.0, 8.0), (21.0, 12.0), (19.0, 12.0)))


@pytest.mark.parametrize(("frame", "floor_up_m"), [("home", 8.0), ("local", 5.0)])
def test_a_floor_counts_from_where_its_zone_does(frame: Frame, floor_up_m: float) -> None:
    """5 m above home, which is 3 m above the origin; or 5 m above the origin."""
    spec = CircleSpec(50.0, name="loft", frame=frame, floor_up_m=5.0)
    assert only(build_zones([spec], HOME_NED, None)).floor_up_m == floor_up_m


def test_a_geographic_zone_is_projected_as_the_vehicle_does() -> None:
    centre = PX4.lat_lon(100.0, 200.0)
    spec = CircleSpec(50.0, centre, name="field", inclusion=False, frame="geographic")
    zone = only(build_zones([spec], None, PX4))
    assert isinstance(zone.shape, Circle)
    assert zone.shape.centre_en == pytest.approx((200.0, 100.0), abs=1e-6)
    assert (zone.floor_up_m, zone.ceiling_up_m) == (-math.inf, math.inf)
    assert zone.title == "exclusion circle 'field'"


def test_a_geographic_zone_without_an_origin_is_no_origin() -> None:
    spec = CircleSpec(50.0, (47.4, 8.5), name="field", frame="geographic")
    refusal = build_zones([spec], HOME_NED, None)
    assert isinstance(refusal, Refusal)
    assert refusal.code is Code.NO_ORIGIN
    assert "GPS_GLOBAL_ORIGIN" in refusal.sentence


def test_a_geographic_ceiling_counts_from_home_and_waits_for_it() -> None:
    spec = CircleSpec(50.0, (47.4, 8.5), name="field", frame="geographic", ceiling_up_m=30.0)
    assert isinstance(build_zones([spec], None, PX4), Refusal)
    assert only(build_zones([spec], HOME_NED, PX4)).ceiling_up_m == 33.0


def test_a_geographic_polygon_that_crosses_itself_is_refused_by_name() -> None:
    bow = ((47.0, 8.0), (47.001, 8.001), (47.001, 8.0), (47.0, 8.001))
    refusal = build_zones([PolygonSpec(bow, name="bow", frame="geographic")], None, PX4)
    assert isinstance(refusal, Refusal)
    assert refusal.code is Code.POLICY
    assert "'bow'" in refusal.sentence
    assert "intersects itself" in refusal.sentence


def test_one_zone_that_cannot_be_placed_leaves_none() -> None:
    far = CircleSpec(9.0, (47.4, 8.5), name="far", frame="geographic")
    assert isinstance(build_zones([*DEFAULT.fence, far], HOME_NED, None), Refusal)
