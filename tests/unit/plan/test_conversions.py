"""There and back through every two formats that can hold a plan, and what is lost by name."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import permutations
from typing import Literal, NamedTuple, TypeAlias

import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from gcs.gate.airspace.projection import Origin, Projection
from gcs.plan.errors import Level, PlanError
from gcs.plan.formats.convert import at_height, convert
from gcs.plan.formats.reader import read
from gcs.plan.formats.writer import FORMATS, Format
from gcs.plan.model import (
    BreachReturn,
    Circle,
    Fence,
    Frame,
    Geodetic,
    Geographic,
    Item,
    LatLon,
    Plain,
    Plan,
    Polygon,
    RallyPoint,
    Zone,
)
from gcs.plan.place import georeference
from tests.each import each
from tests.sample_files import elsewhere
from tests.shares import examples
from tests.unit.plan.strategies import corners, heights, latitudes, longitudes, plans, rally

Holds: TypeAlias = Literal["whole", "route", "fenced", "flight"]
HOLD: dict[Holds, tuple[Format, ...]] = {
    "whole": ("plan", "csv", "wpl"),
    "route": ("plan", "csv", "wpl", "kml", "gpx"),
    "fenced": ("plan", "csv", "wpl", "kml"),
    "flight": ("plan", "csv", "wpl", "toml"),
}
"""Which formats hold which kind of plan whole."""
HOME = Geodetic(47.397742, 8.545594, 488.0)
NOTHING = (0.0, 0.0, 0.0, math.nan)


class Meaning(NamedTuple):
    """A plan as it is flown: degrees to 7 digits, heights above the sea to the millimetre."""

    items: list[object]
    zones: list[object]
    rally: list[object]
    breach: object


def meaning(plan: Plan, home: Geodetic) -> Meaning:
    projection = Projection(Origin(home.lat_deg, home.lon_deg, 0.0), "ardupilot")
    plan = georeference(plan, projection.lat_lon)
    return Meaning(
        [_item(item, home) for item in plan.items],
        [(zone.inclusion, zone.shape) for zone in plan.fence.zones],
        [tuple(point)[:3] for point in map(_point, plan.rally)],
        plan.fence.breach_return,
    )


def _point(point: object) -> tuple[float, float, float]:
    return (point.lat_deg, point.lon_deg, point.alt_above_home_m)  # type: ignore[attr-defined]


def _item(item: Item, home: Geodetic) -> object:
    # ArduPilot's tables have no NaN, and its copters no use for the heading of a waypoint.
    params = tuple(0.0 if math.isnan(p) else p for p in item.params)
    place: tuple[float, ...] = tuple(0.0 if math.isnan(p) else p for p in item.place)
    frame = item.frame
    if isinstance(item.place, Geographic):
        base_m = (home.alt_amsl_m or 0.0) if item.frame is Frame.HOME else 0.0
        frame = Frame.AMSL if frame is Frame.HOME else frame
        place = (*item.place[:2], round(item.place.alt_m + base_m, 3))
    return (item.command, frame, params, place, item.do_jump_id, item.autocontinue)


def flown(plan: Plan, home: Geodetic) -> list[object]:
    """Items without their names; none of these files jumps."""
    items = tuple(replace(item, do_jump_id=1) for item in plan.items)
    return meaning(replace(plan, items=items), home).items


def numbered(items: list[Item]) -> tuple[Item, ...]:
    return tuple(replace(item, do_jump_id=n) for n, item in enumerate(items, start=1))


near = st.builds(
    LatLon,
    st.integers(473_900_000, 474_100_000).map(lambda n: n / 1e7),
    st.integers(85_300_000, 85_600_000).map(lambda n: n / 1e7),
)


@st.composite
def flights(draw: st.DrawFn) -> Plan:
    """What TOML can say: a take-off from home, waypoints with their waits, an end."""
    up_m = draw(st.integers(8, 400)) / 8
    begin = Item(22, Frame.HOME, NOTHING, Geographic(*HOME_PLACE, up_m), 1)
    items = [begin]
    for place in draw(st.lists(near, min_size=1, max_size=6)):
        params = (draw(st.integers(0, 80)) / 8, 0.0, 0.0, draw(st.integers(-360, 360)) * 1.0)
        up_m = draw(st.integers(8, 400)) / 8
        if draw(st.booleans()):
            items.append(Item(178, Frame.MISSION, (1.0, 3.0, -1.0, 0.0), Plain(0.0, 0.0, 0.0), 0))
        items.append(Item(16, Frame.HOME, params, Geographic(*place, up_m), 0))
    match draw(st.sampled_from(["land", "return", "hold"])):
        case "land":
            items.append(Item(21, Frame.HOME, NOTHING, Geographic(*place, 0.0), 0))
        case "return":
            items.append(Item(20, Frame.MISSION, (0.0,) * 4, Plain(0.0, 0.0, 0.0), 0))
    return Plan("a", "ardupilot", HOME, numbered(items))


HOME_PLACE = (HOME.lat_deg, HOME.lon_deg)
waypoints = st.builds(
    Item,
    command=st.just(16),
    frame=st.sampled_from([Frame.AMSL, Frame.HOME]),
    params=st.just(NOTHING),
    place=st.builds(Geographic, latitudes.filter(bool), longitudes, heights),
    do_jump_id=st.just(0),
)
homes = st.builds(Geodetic, latitudes.filter(bool), longitudes, heights)
routes = st.builds(
    Plan,
    name=st.just("a"),
    firmware=st.just("ardupilot"),
    home=homes,
    items=st.lists(waypoints, min_size=1, max_size=6).map(numbered),
)
polygons = st.lists(corners, min_size=3, max_size=6).filter(lambda c: c[0] != c[-1])
fenced = st.builds(
    replace,
    routes,
    fence=st.builds(
        Fence,
        st.lists(
            st.builds(Zone, st.builds(lambda c: Polygon(tuple(c)), polygons), st.booleans()),
            max_size=3,
        ).map(tuple),
        st.one_of(st.none(), st.builds(BreachReturn, latitudes, longitudes, heights)),
    ),
    rally=st.lists(rally, max_size=2).map(tuple),
)


def through(plan: Plan, kind: Format) -> Plan:
    """Written and read again; whatever changes the flight must not be lost."""
    path = f"a{FORMATS[kind][0]}"
    written = convert(path, plan, kind, "ardupilot", plan.home or HOME)
    assert [loss for loss in written.lost if loss.level is Level.WARNING] == []
    again = read(path, written.data, "ardupilot")
    return replace(again, home=again.home or plan.home)


def there_and_back(plan: Plan, holds: Holds) -> None:
    assert plan.home is not None
    for first, second in permutations(HOLD[holds], 2):
        again = through(through(plan, first), second)
        assert meaning(again, plan.home) == meaning(plan, plan.home), (first, second)


@settings(max_examples=examples(40))
@given(plans("ardupilot"))
def test_a_whole_plan_survives_each_two_formats(plan: Plan) -> None:
    there_and_back(plan, "whole")


@settings(max_examples=examples(40))
@given(routes)
def test_a_route_survives_each_two_formats(plan: Plan) -> None:
    there_and_back(plan, "route")


@settings(max_examples=examples(40))
@given(fenced)
def test_a_fence_of_polygons_survives_each_two_formats(plan: Plan) -> None:
    there_and_back(plan, "fenced")


@settings(max_examples=examples(40))
@given(flights())
def test_a_flight_in_metres_survives_each_two_formats(plan: Plan) -> None:
    there_and_back(plan, "flight")


ZONE = Zone(Circle(LatLon(47.398, 8.546), 20.0), False, 0.0, 30.0, "tower")
LADEN = Plan(
    "a",
    "px4",
    HOME,
    (
        Item(22, Frame.HOME, NOTHING, Geographic(*HOME_PLACE, 10.0), 1),
        Item(16, Frame.HOME, (3.0, 0.0, 0.0, 90.0), Geographic(47.398, 8.5457, 12.0), 2),
        Item(206, Frame.MISSION, (8.0, 0.0, 1.0, 0.0), Plain(0.0, 0.0, 0.0), 3),
        Item(206, Frame.MISSION, (0.0, 0.0, 1.0, 0.0), Plain(0.0, 0.0, 0.0), 4),
        Item(18, Frame.HOME, (2.0, 0.0, 5.0, 0.0), Geographic(47.398, 8.546, 12.0), 9),
        Item(21, Frame.HOME, NOTHING, Geographic(47.3981, 8.546, 0.0), 10),
    ),
    Fence((ZONE,), BreachReturn(47.398, 8.546, 20.0)),
    (RallyPoint(47.398, 8.546, 20.0),),
    hover_speed_m_s=4.0,
)
LOST: dict[Format, list[str]] = {
    "csv": [],
    "plan": ["fence zone tower: its floor and ceiling are not kept by this format"],
    "wpl": [
        "home: is not kept by this format",
        "firmware: that it was written for px4 is not kept by this format",
        "speeds: are not kept by this format",
        "doJumpId: items are numbered in their order",
        "fence zone tower: its floor and ceiling are not kept by this format",
    ],
    "kml": [
        "firmware: that it was written for px4 is not kept by this format",
        "speeds: are not kept by this format",
        "fence zone tower: its circle is kept as a polygon of 72 corners, on the safe side",
        "NAV_TAKEOFF: is kept as a point of the route (item 1)",
        "NAV_WAYPOINT: its wait of 3 s, heading is not kept by this format (item 2)",
        "DO_SET_CAM_TRIGG_DIST: is not kept by this format (items 3, 4)",
        "NAV_LOITER_TURNS: is kept as a point of the route (item 5)",
        "NAV_LAND: is not kept by this format (item 6)",
    ],
    "gpx": [
        "firmware: that it was written for px4 is not kept by this format",
        "speeds: are not kept by this format",
        "fence: its 1 zones are not kept by this format",
        "rally points: 1 are not kept by this format",
        "NAV_TAKEOFF: is kept as a point of the route (item 1)",
        "NAV_WAYPOINT: its wait of 3 s, heading is not kept by this format (item 2)",
        "DO_SET_CAM_TRIGG_DIST: is not kept by this format (items 3, 4)",
        "NAV_LOITER_TURNS: is kept as a point of the route (item 5)",
        "NAV_LAND: is not kept by this format (item 6)",
    ],
    "toml": [
        "home: is not kept: metres count from where it takes off",
        "firmware: that it was written for px4 is not kept by this format",
        "hover speed: is not kept by this format",
        "rally points: 1 are not kept by this format",
        "fence: its return point is not kept by this format",
        "fence zone tower: is not kept: a fence in TOML has a zone to stay inside",
        "DO_SET_CAM_TRIGG_DIST: is not kept by this format (items 3, 4)",
        "NAV_LOITER_TURNS: is kept as a plain waypoint (item 5)",
        "NAV_LAND: has a waypoint over it, at the height before (item 6)",
    ],
}


@each("kind", FORMATS)
def test_what_is_lost_has_its_name(kind: Format) -> None:
    lost = convert("a", LADEN, kind).lost
    assert [f"{loss.item}: {loss.what}" for loss in lost] == LOST[kind]


def test_a_circle_becomes_the_polygon_that_allows_no_more() -> None:
    """Shapely's distances, in the plane of the circle: the farthest corner inside, the nearest edge
    outside."""
    plane = Projection(Origin(47.398, 8.546, 0.0), "px4")
    for inclusion in (True, False):
        zone = replace(ZONE, inclusion=inclusion)
        data = convert("a.kml", replace(LADEN, fence=Fence((zone,))), "kml").data
        (shape,) = (zone.shape for zone in read("a.kml", data).fence.zones)
        assert isinstance(shape, Polygon)
        ring = shapely.Polygon([plane.north_east(*corner) for corner in shape.corners])
        circle = shapely.Point(0.0, 0.0).buffer(20.0, quad_segs=2000)
        small, large = (ring, circle) if inclusion else (circle, ring)
        assert large.buffer(1e-4).contains(small)
        assert 0.998 < small.area / large.area < 1.0


METRES = """\
schema = 1
frame = "home"
[[waypoint]]
north_m = 10
east_m = 20
up_m = 5
[fence]
north_m = [-5, 30]
east_m = [-5, 30]
"""


@each("kind", ["plan", "wpl", "kml", "gpx"])
def test_metres_need_the_place_of_home(kind: Format) -> None:
    plan = read("a.toml", METRES.encode())
    with pytest.raises(PlanError, match="metres"):
        convert("a", plan, kind)
    again = read("a", convert("a", plan, kind, "px4", HOME).data, "px4")
    point = again.items[1].place
    assert isinstance(point, Geographic)
    # Ten metres north are 10 / 6371000 rad on the sphere of PX4's own map.
    assert point.lat_deg == pytest.approx(47.397742 + math.degrees(10 / 6_371_000), abs=2e-7)
    east_deg = math.degrees(20 / 6_371_000 / math.cos(math.radians(47.397742)))
    assert point.lon_deg == pytest.approx(8.545594 + east_deg, abs=2e-7)


def test_a_table_in_metres_needs_none() -> None:
    plan = read("a.toml", METRES.encode())
    assert replace(read("a.csv", convert("a.csv", plan, "csv").data), name=plan.name) == plan


def test_a_height_for_what_has_none_is_above_home() -> None:
    plan = at_height(read("a.csv", b"command,lat_deg,lon_deg\n,47,8\nNAV_LAND,47,8\n"), 30.0)
    assert plan.items[0].place == Geographic(47.0, 8.0, 30.0)
    assert math.isnan(plan.items[1].place[2])


@each(
    "name",
    [
        "plans/MC_mission_box.plan",
        "plans/multicopter_mission_geofence_avoid.plan",
        "plans/ce_geofence_outfield.plan",
        "wpl/mpmission.txt",
        "fences/fence-110.txt",
        "plans/qgroundcontrol_sample_with_survey.plan",
        "rally/rally.txt",
    ],
)
def test_real_files_survive_the_formats_that_hold_whole_plans(name: str) -> None:
    path = elsewhere(*name.split("/"))
    plan = read(path.name, path.read_bytes())
    home = plan.home or HOME
    for first, second in permutations(HOLD["whole"], 2):
        again = read("b", convert("b", plan, first, "ardupilot", home).data, "ardupilot")
        again = read("c", convert("c", again, second, "ardupilot", home).data, "ardupilot")
        assert meaning(again, home)[1:] == meaning(plan, home)[1:]
        # A table of waypoints numbers its items in their order.
        assert flown(again, home) == flown(plan, home)
