"""KML, GPX, CSV, fence.txt, rally.txt and old tables: what is read, and where it is refused."""

from __future__ import annotations

import math

import pytest
from pymavlink import mavutil, mavwp

from gcs.plan.errors import PlanError
from gcs.plan.formats.reader import read
from gcs.plan.model import (
    BreachReturn,
    Circle,
    EastNorth,
    Frame,
    Geodetic,
    Geographic,
    LatLon,
    Plain,
    Plan,
    Polygon,
)
from tests.each import each
from tests.sample_files import ELSEWHERE, SAMPLES, elsewhere


def sample(name: str) -> Plan:
    return read(name, (SAMPLES / name).read_bytes())


def test_a_polygon_of_kml_is_stayed_inside_and_its_hole_is_stayed_out_of() -> None:
    plan = sample("xml/field.kml")

    assert plan.name == "a field with a pond"
    field, pond = plan.fence.zones
    assert (field.inclusion, pond.inclusion) == (True, False)
    corners = ((47.397, 8.545), (47.397, 8.547), (47.3985, 8.547), (47.3985, 8.545))
    assert field.shape == Polygon(tuple(LatLon(*corner) for corner in corners))
    assert pond.shape == Polygon(
        (LatLon(47.3979, 8.5461), LatLon(47.3979, 8.5463), LatLon(47.3981, 8.5462))
    )
    assert (field.name, field.where, pond.where) == ("field", "9", "16")
    assert [(item.frame, item.place) for item in plan.items] == [
        (Frame.AMSL, Geographic(47.3978, 8.5456, 500.0)),
        (Frame.AMSL, Geographic(47.3980, 8.5458, 505.5)),
    ]
    assert [note.item for note in plan.notes] == ["<Point>"]


def test_a_route_of_gpx_is_above_the_sea_and_a_missing_height_is_told() -> None:
    plan = sample("xml/route.gpx")

    assert plan.name == "round the pond"
    assert {item.frame for item in plan.items} == {Frame.AMSL}
    assert plan.items[1].place == Geographic(47.3980, 8.5458, 505.5)
    assert math.isnan(plan.items[2].place[2])
    assert [(note.where, note.item) for note in plan.notes] == [("3", "<wpt>"), ("8", "<rtept>")]


def test_the_pieces_of_a_track_are_one_way_and_that_is_told() -> None:
    plan = sample("xml/track.gpx")

    assert [item.place[2] for item in plan.items] == [500.0, 501.0, 502.0]
    assert ["2 segments" in note.what for note in plan.notes] == [True]


def test_a_table_has_all_that_a_plan_has() -> None:
    plan = sample("csv/everything.csv")

    assert (plan.name, plan.firmware, plan.hover_speed_m_s) == ("a table", "px4", 4.5)
    assert plan.home == Geodetic(47.3977, 8.5455, 488.0)
    take_off, first, speed, last, jump, back = plan.items
    assert take_off.place == Geographic(47.3977, 8.5455, 10.0)
    assert (first.command, first.frame, first.params) == (16, Frame.HOME, (2.0, 0.0, 0.0, 90.0))
    assert (speed.command, speed.params, speed.place) == (
        178,
        (1.0, 3.0, -1.0, 0.0),
        Plain(0, 0, 0),
    )
    assert (last.frame, last.do_jump_id, plan.index_of(jump.params[0])) == (Frame.AMSL, 7, 3)
    assert back.command == 20
    field, tower, mast = plan.fence.zones
    assert (field.name, field.floor_above_home_m, field.ceiling_above_home_m) == ("field", 0, 50)
    assert isinstance(field.shape, Polygon)
    assert len(field.shape.corners) == 3
    assert (tower.inclusion, tower.shape) == (False, Circle(LatLon(47.3980, 8.5460), 12.5))
    assert mast.shape == Circle(EastNorth(4.0, 3.0), 1.5)
    assert plan.fence.breach_return == BreachReturn(47.3977, 8.5455, 20.0)


def test_the_least_table_is_a_list_of_places_above_home() -> None:
    plan = sample("csv/least.csv")

    assert [(item.command, item.frame) for item in plan.items] == [(16, Frame.HOME)] * 2
    assert math.isnan(plan.items[0].params[3])


@each("where", [SAMPLES / "tables/fence_of_the_old_kind.txt", ELSEWHERE / "fences/fence.txt"])
def test_a_list_of_fence_points_is_what_pymavlink_reads(where: object) -> None:
    path = elsewhere(str(where))
    loader = mavwp.MAVFenceLoader()
    loader.load(str(path))
    back, *corners = [(point.lat, point.lng) for point in loader.points]

    fence = read(path.name, path.read_bytes()).fence

    (zone,) = fence.zones
    assert isinstance(zone.shape, Polygon)
    assert zone.inclusion
    assert [tuple(corner) for corner in zone.shape.corners] == corners[:-1]
    assert fence.breach_return == BreachReturn(*back, 0.0)


@each("where", [SAMPLES / "tables/rally_of_the_old_kind.txt", ELSEWHERE / "rally/rally.txt"])
def test_a_list_of_rally_points_is_what_pymavlink_reads(where: object) -> None:
    path = elsewhere(str(where))
    loader = mavwp.MAVRallyLoader()
    loader.load(str(path))

    plan = read(path.name, path.read_bytes())

    assert [
        (int(p.lat_deg * 1e7), int(p.lon_deg * 1e7), p.alt_above_home_m) for p in plan.rally
    ] == [(point.lat, point.lng, point.alt) for point in loader.rally_points]


def test_a_table_of_version_100_is_what_pymavlink_reads() -> None:
    path = SAMPLES / "tables/version_100.txt"
    mavutil.set_dialect("common")
    loader = mavwp.MAVWPLoader()
    loader.load(str(path))

    plan = read(path.name, path.read_bytes())

    assert [(item.command, *item.params, *item.place) for item in plan.items] == [
        (w.command, w.param1, w.param2, w.param3, w.param4, w.x, w.y, w.z) for w in loader.wpoints
    ]
    assert plan.items[1].place == Geographic(47.3978, 8.5456, 12.0)


def kml(inside: str) -> str:
    return f'<kml xmlns="http://www.opengis.net/kml/2.2"><Placemark>\n{inside}\n</Placemark></kml>'


def line(coordinates: str, mode: str = "absolute") -> str:
    return kml(
        f"<LineString><altitudeMode>{mode}</altitudeMode>"
        f"<coordinates>\n{coordinates}\n</coordinates></LineString>"
    )


GPX = "<gpx><rte>\n{}\n</rte></gpx>"
REFUSED: list[tuple[str, str, str, str]] = [
    ("a.kml", kml("<Point/>"), "1", "has no line string and no polygon"),
    ("a.kml", "<kml><Placemark>", "1", "is not well-formed: no element found"),
    ("a.kml", "<kml>\n<a>\n</b></kml>", "3", "is not well-formed: mismatched tag"),
    ("a.kml", "<svg/>", "1", "is the outermost element"),
    ("a.kml", "<a>" * 200, "1", "elements deep"),
    ("a.kml", '<?xml version="1.0" encoding="klingon"?><kml/>', "1", "unknown encoding"),
    ("a.kml", line("8.5,47.3,10\n8.5,147.3,10"), "4", "latitude 147.3"),
    ("a.kml", line("8.5, 47.3, 10"), "3", 'has "8.5,"'),
    ("a.kml", line("8.5,47.3,1O"), "3", 'is "1O"'),
    ("a.kml", line("8.5,47.3", "seaFloor"), "2", 'altitudeMode "seaFloor"'),
    ("a.kml", kml("<LineString/>"), "2", "has no <coordinates>"),
    ("a.kml", kml("<LineString/>\n<LineString/>"), "3", "is one of 2 line strings"),
    ("a.kml", kml("<Track/>"), "2", "is a recorded track"),
    ("a.gpx", "<gpx><wpt lat='1' lon='2'/></gpx>", "1", "has no route and no track"),
    ("a.gpx", GPX.format(""), "1", "has no points"),
    ("a.gpx", GPX.format('<rtept lat="47"/>'), "2", 'is ""'),
    ("a.gpx", GPX.format('<rtept lat="47" lon="8"><ele>high</ele></rtept>'), "2", 'is "high"'),
    ("a.csv", "", "1", "is empty"),
    ("a.csv", "lat_deg,hue\n", "1", '"hue" is not known'),
    ("a.csv", "lat_deg,lat_deg\n", "1", "is there twice"),
    ("a.csv", "lat_deg,lon_deg\n47,8,9\n", "2", "has 3 cells"),
    ("a.csv", "command,lat_deg\nNAV_FLY,47\n", "2", 'is "NAV_FLY"'),
    ("a.csv", "what\nhouse\n", "2", 'is "house"'),
    ("a.csv", "what,lat_deg,lon_deg\ninclusion,47,8\n", "2", "a polygon of 1 corners"),
    ("a.csv", 'lat_deg,lon_deg\n47,"8\n', "2", "is no CSV"),
    ("a.csv", "id,lat_deg,lon_deg\n3,47,8\n3,47,8\n", "3", "3 is also that of line 2"),
    ("a.csv", "frame,lat_deg,lon_deg\nMOON,47,8\n", "2", 'is "MOON"'),
    ("a.txt", "47.1 8.5\n47.1 8.5\n", "2", "the list ends after 2 points"),
    ("a.txt", "47.1 8.5\n47.1 8,5\n", "2", 'is "8,5"'),
    ("a.txt", "47.1 8.5\n97.1 8.5\n", "2", "latitude 97.1"),
    ("a.txt", "RALLY 47.1 8.5 20\n", "1", 'is "RALLY 47.1 8.5 20"'),
    ("a.kmz", "PK\x03\x04", "1", "is a ZIP archive"),
]


@each("case", REFUSED)
def test_what_is_wrong_is_told_with_its_line(case: tuple[str, str, str, str]) -> None:
    name, text, where, what = case
    with pytest.raises(PlanError) as caught:
        read(name, text.encode())
    assert (caught.value.where, what in caught.value.what) == (where, True), str(caught.value)


def attempt(name: str, data: bytes) -> Plan | PlanError:
    try:
        return read(name, data)
    except PlanError as error:
        return error


ELSEWHERE_READ: dict[str, tuple[int, int, int]] = {
    "fences/fence-110.txt": (0, 3, 0),
    "fences/fence.txt": (0, 1, 0),
    "fences/springvalleybottom-foamy-fence.txt": (0, 1, 0),
    "plans/MC_mission_box.plan": (6, 0, 0),
    "plans/ce_geofence_outfield.plan": (0, 2, 0),
    "plans/example-mission.plan": (5, 0, 2),
    "plans/multicopter_mission_geofence_avoid.plan": (5, 3, 0),
    "plans/qgroundcontrol_sample.plan": (6, 0, 0),
    "plans/qgroundcontrol_sample_with_digicam_control.plan": (1, 0, 0),
    "plans/qgroundcontrol_sample_with_survey.plan": (13, 0, 0),
    "plans/qgroundcontrol_sample_without_mission.plan": (0, 0, 0),
    "rally/rally-110.txt": (0, 0, 2),
    "rally/rally.txt": (0, 0, 2),
    "wpl/cmac-foamy-mission-cw.txt": (11, 0, 0),
    "wpl/mission_planner_sample.txt": (4, 0, 0),
    "wpl/mpmission.txt": (6, 0, 0),
}
"""Items that are flown, zones, rally points."""
ELSEWHERE_REFUSED = {
    "structured_scan": ("mission.items[1].complexItemType", "as a polygon"),
    "survey_missing_items": ("mission.items[1].TransectStyleComplexItem.Items", "is missing"),
    "survey_wrong_version": ("mission.items[1].version", "is 9"),
    "wrong_mission_version": ("mission.version", "is 7"),
    "wrong_overall_version": ("version", "is 42"),
}


def test_every_file_of_other_projects_is_read_or_refused_at_its_place() -> None:
    elsewhere("plans")
    seen = set()
    for folder in ("plans", "wpl", "fences", "rally"):
        for path in sorted((ELSEWHERE / folder).iterdir()):
            name = f"{folder}/{path.name}"
            answer = attempt(name, path.read_bytes())
            if isinstance(answer, Plan):
                counts = (len(answer.items), len(answer.fence.zones), len(answer.rally))
                assert counts == ELSEWHERE_READ[name], name
                seen.add(name)
            else:
                key = next(key for key in ELSEWHERE_REFUSED if key in name)
                where, what = ELSEWHERE_REFUSED[key]
                assert (answer.file, answer.where, what in answer.what) == (name, where, True)
    assert seen == set(ELSEWHERE_READ)
