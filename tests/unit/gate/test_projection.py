"""The vehicle's own projections, held against pymap3d and against the ellipsoid they are not."""

from __future__ import annotations

import math

import pymap3d
import pymap3d.vincenty
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.gate.airspace.projection import METRES_PER_DEGREE, SPHERE_RADIUS_M, Origin, Projection

ZURICH = Origin(47.397742, 8.545594, 488.0)
CANBERRA = Origin(-35.363262, 149.165237, 584.0)
SPHERE = pymap3d.Ellipsoid(SPHERE_RADIUS_M, SPHERE_RADIUS_M)

personalities = st.sampled_from(["px4", "ardupilot"])
origins = st.builds(Origin, st.floats(-75.0, 75.0), st.floats(-180.0, 180.0), st.floats(-50, 3000))
reach = st.floats(-5000.0, 5000.0)


@given(personalities, origins, reach, reach, st.floats(-500.0, 500.0))
def test_there_and_back_is_the_same_place(
    autopilot: str, origin: Origin, north_m: float, east_m: float, down_m: float
) -> None:
    projection = Projection(origin, autopilot)
    back = projection.ned_from_geodetic(*projection.geodetic_from_ned((north_m, east_m, down_m)))
    # A longitude of 180 degrees has an ulp of 2.8e-14 degrees, 3e-9 m at the equator.
    assert back == pytest.approx((north_m, east_m, down_m), abs=1e-7)


@given(origins, reach, reach)
def test_px4_is_the_tangent_plane_of_the_sphere_but_for_its_curvature(
    origin: Origin, north_m: float, east_m: float
) -> None:
    lat, lon, alt = Projection(origin, "px4").geodetic_from_ned((north_m, east_m, 0.0))
    n, e, _ = pymap3d.geodetic2ned(
        lat, lon, alt, origin.lat_deg, origin.lon_deg, origin.alt_amsl_m, ell=SPHERE
    )
    # c R against (R + h) sin c: d^3 / 6 R^2 for the arc, d h / R for the height of the origin.
    d = math.hypot(north_m, east_m)
    allowed = d**3 / (6 * SPHERE_RADIUS_M**2) + d * abs(origin.alt_amsl_m) / SPHERE_RADIUS_M + 1e-6
    assert math.hypot(n - north_m, e - east_m) <= allowed


@pytest.mark.parametrize("origin", [ZURICH, CANBERRA])
@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_both_agree_with_the_ellipsoid_to_a_few_metres_a_kilometre_and_no_better(
    origin: Origin, autopilot: str
) -> None:
    off_m = []
    for north_m, east_m in ((1000.0, 0.0), (0.0, 1000.0)):
        lat, lon = Projection(origin, autopilot).lat_lon(north_m, east_m)
        true_m, _ = pymap3d.vincenty.vdist(origin.lat_deg, origin.lon_deg, lat, lon)
        off_m.append(abs(float(true_m) - 1000.0))
    assert 1.0 < max(off_m) < 5.0


def test_ardupilot_counts_a_fixed_length_for_a_degree() -> None:
    projection = Projection(CANBERRA, "ardupilot")
    north_m, east_m = projection.north_east(CANBERRA.lat_deg + 1e-7, CANBERRA.lon_deg)
    assert north_m == pytest.approx(0.011131884502145034, rel=1e-6)
    assert east_m == 0.0
    _, east_m = projection.north_east(CANBERRA.lat_deg, CANBERRA.lon_deg + 0.01)
    scale = math.cos(math.radians(CANBERRA.lat_deg))
    assert east_m == pytest.approx(0.01 * METRES_PER_DEGREE * scale, rel=1e-9)


def test_ardupilot_scales_longitude_at_the_mean_latitude() -> None:
    _, east_m = Projection(CANBERRA, "ardupilot").north_east(
        CANBERRA.lat_deg + 0.1, CANBERRA.lon_deg + 0.1
    )
    scale = math.cos(math.radians(CANBERRA.lat_deg + 0.05))
    assert east_m == pytest.approx(0.1 * METRES_PER_DEGREE * scale, rel=1e-9)


@pytest.mark.parametrize("autopilot", ["px4", "ardupilot"])
def test_the_date_line_is_no_edge(autopilot: str) -> None:
    projection = Projection(Origin(0.0, 179.9999, 0.0), autopilot)
    north_m, east_m = projection.north_east(0.0, -179.9999)
    assert north_m == pytest.approx(0.0, abs=1e-9)
    assert east_m == pytest.approx(22.25, abs=0.05)
    assert projection.lat_lon(0.0, east_m)[1] == pytest.approx(-179.9999, abs=1e-9)


def test_the_origin_is_nothing_away_from_itself() -> None:
    for autopilot in ("px4", "ardupilot"):
        projection = Projection(ZURICH, autopilot)
        assert projection.ned_from_geodetic(47.397742, 8.545594, 490.0) == (0.0, 0.0, -2.0)
        assert projection.geodetic_from_ned((0.0, 0.0, 0.0)) == (47.397742, 8.545594, 488.0)


@pytest.mark.parametrize("pole", [90.0, -90.0])
def test_px4_reaches_a_pole_whatever_the_rounding(pole: float) -> None:
    """There the sine of the latitude is 1, and a rounding error may put it above."""
    for hundredths in range(1, 500):
        origin = Origin(math.copysign(90.0 - hundredths / 100.0, pole), 8.0, 0.0)
        north_m = math.radians(pole - origin.lat_deg) * SPHERE_RADIUS_M
        lat_deg, _ = Projection(origin, "px4").lat_lon(north_m, 0.0)
        assert lat_deg == pytest.approx(pole, abs=1e-5)


@pytest.mark.parametrize("lat_deg", [90.0, 89.9, -89.9])
def test_ardupilots_longitudes_are_no_shorter_than_a_hundredth(lat_deg: float) -> None:
    """The cosine of 89.9 degrees is 0.0017; the vehicle takes 0.01 there."""
    projection = Projection(Origin(lat_deg, 8.0, 0.0), "ardupilot")
    north_m, east_m = projection.north_east(lat_deg, 9.0)
    assert north_m == 0.0
    assert east_m == pytest.approx(0.01 * METRES_PER_DEGREE)
    assert projection.lat_lon(0.0, east_m) == pytest.approx((lat_deg, 9.0))


def test_ardupilots_longitudes_are_the_cosine_where_it_is_more_than_a_hundredth() -> None:
    """The cosine of 89.3 degrees is 0.0122."""
    _, east_m = Projection(Origin(89.3, 8.0, 0.0), "ardupilot").north_east(89.3, 9.0)
    assert east_m == pytest.approx(math.cos(math.radians(89.3)) * METRES_PER_DEGREE)
