"""The drawings: braille dots, the map's scale, markers, the height bar, the state chart."""

from __future__ import annotations

import math

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs import ipc
from gcs.gate.states import State
from gcs.tui import flight_numbers, look
from gcs.tui.braille import Canvas, clip
from gcs.tui.keyboard import PendingGoal
from gcs.tui.keymap import DEFAULT
from gcs.tui.panels import (
    decisions_panel,
    fsa_panel,
    height_panel,
    map_panel,
    mission_panel,
    vehicle_panel,
)
from gcs.tui.panels.frame_panels import footer, header
from gcs.tui.panels.graphs import Graphs
from gcs.tui.scene import Scene
from gcs.tui.view import HALF_SPANS_M, fit, nice_length, outline
from gcs.tui.wind import wind_of
from tests.unit.operator.fake_station import FakeStation

metres = st.floats(-1e4, 1e4)
points = st.tuples(metres, metres)


def scene_at(pos_enu: ipc.Vec3, goal_enu: ipc.Vec3 | None = None) -> Scene:
    scene = Scene()
    station = FakeStation()
    for event in station.hello():
        scene.update(event)
    station.pos = pos_enu
    station.target = goal_enu
    scene.update(station.snapshot())
    return scene


@pytest.mark.parametrize(
    ("x", "y", "char"),
    [(0, 0, "⠁"), (0, 1, "⠂"), (0, 2, "⠄"), (0, 3, "⡀"), (1, 0, "⠈"), (1, 1, "⠐"), (1, 2, "⠠"),
     (1, 3, "⢀")],
)  # fmt: skip
def test_each_dot_of_a_cell_is_its_own_braille_bit(x: int, y: int, char: str) -> None:
    canvas = Canvas(1, 1)
    canvas.dot(x, y, "")
    assert canvas.render().plain == char


def test_a_diagonal_line_is_drawn_from_corner_to_corner() -> None:
    canvas = Canvas(2, 1)
    canvas.line((0, 0), (3, 3), "")
    assert canvas.render().plain == "⠑⢄"


def test_what_lies_outside_is_not_drawn_and_does_no_harm() -> None:
    canvas = Canvas(3, 2)
    canvas.dot(-1, 0, "")
    canvas.dot(6, 8, "")
    canvas.glyph(-2, -4, "X", "")
    canvas.line((-50, -50), (-10, -10), "")
    assert canvas.render().plain.split() == []


@given(points, points)
def test_a_clipped_line_lies_inside_and_on_the_line(
    start: tuple[float, float], end: tuple[float, float]
) -> None:
    clipped = clip(start, end, 100.0, 60.0)
    if clipped is None:
        return
    length = math.dist(start, end) or 1.0
    for x, y in clipped:
        assert -1e-6 <= x <= 100 + 1e-6
        assert -1e-6 <= y <= 60 + 1e-6
        cross = (end[0] - start[0]) * (y - start[1]) - (end[1] - start[1]) * (x - start[0])
        assert abs(cross) / length < 1e-6


@given(st.lists(st.tuples(st.floats(-4000, 4000), st.floats(-4000, 4000)), max_size=5))
def test_every_point_is_inside_the_view(cloud: list[tuple[float, float]]) -> None:
    view = fit((0.0, 0.0), cloud, 100, 60)
    for east_m, north_m in cloud:
        x, y = view.dots(east_m, north_m)
        assert 0 <= x <= 100
        assert 0 <= y <= 60


def test_north_is_up_and_east_is_right() -> None:
    view = fit((0.0, 0.0), [], 100, 60)
    assert view.dots(0, 0) == (50, 30)
    assert view.dots(1, 0)[0] > 50
    assert view.dots(0, 1)[1] < 30


def test_zooming_stops_at_both_ends() -> None:
    closest, farthest = (fit((0.0, 0.0), [], 100, 60, zoom) for zoom in (-99, 99))
    assert closest.half_height_m == pytest.approx(HALF_SPANS_M[0])
    assert farthest.half_height_m == pytest.approx(HALF_SPANS_M[-1])


@given(st.floats(1e-3, 1e5))
def test_a_scale_bar_is_a_round_number_of_at_least_two_fifths(most_m: float) -> None:
    length_m = nice_length(most_m)
    assert 0.4 * most_m * (1 - 1e-9) <= length_m <= most_m
    assert f"{length_m:e}"[0] in "125"


def test_outlines_are_closed() -> None:
    circle = outline(ipc.FenceShape("c", True, centre_en=(1.0, 2.0), radius_m=3.0))
    assert circle[0] == pytest.approx(circle[-1])
    assert all(math.dist(point, (1.0, 2.0)) == pytest.approx(3.0) for point in circle)
    square = outline(ipc.FenceShape("p", True, corners_en=[(0, 0), (1, 0), (1, 1)]))
    assert square == [(0, 0), (1, 0), (1, 1), (0, 0)]


def test_the_map_shows_vehicle_home_and_both_goals_apart() -> None:
    scene = scene_at((1.0, 1.0, 2.0), goal_enu=(-1.0, -1.0, 2.0))
    scene.pending = PendingGoal((1.5, -1.0, 0.5))
    drawing = map_panel.draw(scene, 60, 20).plain.splitlines()
    picture = "\n".join(drawing[:-1])
    for glyph in (map_panel.HOME, map_panel.PENDING, map_panel.ACTIVE, "↗"):
        assert picture.count(glyph) == 1
    assert len(drawing) == 20
    assert all(len(row) <= 60 for row in drawing)


@pytest.mark.parametrize(
    ("yaw_deg", "arrow"), [(0, "↑"), (44, "↗"), (90, "→"), (180, "↓"), (-90, "←"), (359, "↑")]
)
def test_the_arrow_points_where_the_vehicle_heads(yaw_deg: float, arrow: str) -> None:
    assert map_panel.arrow(yaw_deg) == arrow


@pytest.mark.parametrize(("columns", "rows"), [(0, 0), (7, 3), (8, 4), (200, 60)])
def test_panels_draw_in_whatever_room_there_is(columns: int, rows: int) -> None:
    scene = scene_at((1.0, 1.0, 2.0))
    map_panel.draw(scene, columns, rows)
    height_panel.draw(scene, rows)
    map_panel.draw(Scene(), columns, rows)
    height_panel.draw(Scene(), rows)


def test_the_height_bar_puts_the_higher_above_the_lower() -> None:
    scene = scene_at((0.0, 0.0, 2.5), goal_enu=(0.0, 0.0, 1.5))
    scene.pending = PendingGoal((0.0, 0.0, 0.5))
    rows = height_panel.draw(scene, 20).plain.splitlines()
    order = [next(i for i, row in enumerate(rows) if mark in row) for mark in "◀◉◇"]
    assert order == sorted(order)
    assert rows[0].strip().startswith("3┤")


def test_every_state_has_its_place_in_the_chart_and_one_is_lit() -> None:
    assert {state for row in fsa_panel.ROWS for state in row} == set(State)
    chart = fsa_panel.draw(scene_at((0.0, 0.0, 0.0)))
    lit = [
        chart.plain[span.start : span.end] for span in chart.spans if "reverse" in str(span.style)
    ]
    assert [text.strip() for text in lit] == ["GROUNDED"]


def small_fence(across_m: float) -> Scene:
    scene = scene_at((0.0, 0.0, 0.0))
    half = across_m / 2
    corners = [(-half, -half), (half, -half), (half, half), (-half, half)]
    scene.update(ipc.Fences([ipc.FenceShape("cage", True, corners_en=corners)]))
    return scene


def fence_dots(scene: Scene) -> int:
    picture = map_panel.draw(scene, 70, 24)
    spans = [span for span in picture.spans if span.style == look.FENCE]
    chars = "".join(picture.plain[span.start : span.end] for span in spans)
    return sum((ord(char) - 0x2800).bit_count() for char in chars if 0x2800 <= ord(char) < 0x2900)


@pytest.mark.parametrize(("across_m", "seen"), [(10.0, True), (30.0, True), (31.0, False)])
def test_a_small_fence_is_shown_whole(across_m: float, seen: bool) -> None:
    assert (fence_dots(small_fence(across_m)) > 0) is seen


def test_a_fence_that_is_off_is_dashed() -> None:
    scene = small_fence(10.0)
    whole = fence_dots(scene)
    scene.fence_on = False
    assert 0 < fence_dots(scene) < whole / 3


def test_a_vehicle_that_holds_by_itself_has_no_active_goal() -> None:
    scene = scene_at((1.0, 0.0, 2.0), goal_enu=(3.0, 0.0, 2.0))
    assert scene.active_enu == (3.0, 0.0, 2.0)
    assert scene.snapshot is not None
    scene.update(msgspec.structs.replace(scene.snapshot, state="HOLDING"))
    assert "active none" in vehicle_panel.goals(scene).plain


def test_of_a_lost_vehicle_only_the_ages_are_bright() -> None:
    seen = msgspec.structs.replace(
        FakeStation().snapshot(), state="NO_VEHICLE", heartbeat_age_s=9.0, position_age_s=9.0
    )
    rows = vehicle_panel.rows(seen, 1, lost=True)
    bright = [value for _, value, style in rows if style != look.DIM]
    assert len(bright) == 2
    assert all("9.0 s" in value for value in bright)


OTHER = ipc.OperatorInfo(2, "gcs attach, pid 4711")


def controlled_by(operator: ipc.OperatorInfo | None, state: str = "HOVERING") -> Scene:
    scene = scene_at((0.0, 0.0, 2.0))
    assert scene.snapshot is not None
    scene.update(msgspec.structs.replace(scene.snapshot, in_control=operator, state=state))
    return scene


@pytest.mark.parametrize(
    ("operator", "state", "told"),
    [
        (ipc.OperatorInfo(1, "gcs fly, pid 4710"), "HOVERING", "you, NONE NOMINAL"),
        (OTHER, "HOVERING", "operator 2, NONE NOMINAL"),
        (None, "HOVERING", "nobody, NONE NOMINAL"),
        (OTHER, "EXTERNAL", "the pilot, NONE NOMINAL"),
    ],
)
def test_who_is_in_control_is_on_the_panel(
    operator: ipc.OperatorInfo | None, state: str, told: str
) -> None:
    panel = vehicle_panel.draw(controlled_by(operator, state)).plain
    assert f"ctrl {told}\n" in panel


@pytest.mark.parametrize(
    ("columns", "told"), [(140, "control: operator 2 (gcs attach, pid 4711) "), (80, "operator 2 ")]
)
def test_another_operator_in_control_is_in_the_header(columns: int, told: str) -> None:
    line = header(controlled_by(OTHER), columns).plain
    assert told in line
    assert "MB" in line
    assert len(line) <= columns


@pytest.mark.parametrize("operator", [ipc.OperatorInfo(1, "gcs fly, pid 4710"), None])
def test_the_header_says_nothing_of_control_that_one_has_or_would_get(
    operator: ipc.OperatorInfo | None,
) -> None:
    assert "control" not in header(controlled_by(operator), 140).plain


def test_an_operator_is_told_who_has_taken_control_over_and_how_to_have_it_back() -> None:
    scene = controlled_by(OTHER)
    assert scene.answer.text.startswith("CONTROL WENT TO operator 2 (gcs attach, pid 4711)")
    assert "o takes it back" in scene.answer.text
    assert look.ANSWER[scene.answer.kind] == look.WARN
    assert scene.snapshot is not None
    mine = ipc.OperatorInfo(1, "gcs fly, pid 4710")
    scene.update(msgspec.structs.replace(scene.snapshot, in_control=mine))
    assert scene.answer.text == "you are in control of the station"
    scene.update(msgspec.structs.replace(scene.snapshot, in_control=None))
    assert scene.answer.text.startswith("CONTROL WENT TO nobody")


def test_the_ending_of_a_take_over_does_not_hide_who_is_in_control() -> None:
    """The station's snapshot of it comes before the ending."""
    scene = controlled_by(OTHER)
    scene.update(ipc.VerdictEvent(1, "station_take", "accepted"))
    assert scene.snapshot is not None
    mine = ipc.OperatorInfo(1, "gcs fly, pid 4710")
    scene.update(msgspec.structs.replace(scene.snapshot, in_control=mine))
    scene.update(ipc.EndingEvent(1, "station_take", "complete"))
    assert scene.answer.text == "you are in control of the station"


def test_whoever_looks_on_is_told_of_a_change_between_others() -> None:
    scene = controlled_by(OTHER)
    assert scene.snapshot is not None
    third = ipc.OperatorInfo(3, "Python script, pid 9")
    scene.update(msgspec.structs.replace(scene.snapshot, in_control=third))
    assert scene.answer.text == "operator 3 (Python script, pid 9) is in control now"


def test_control_that_nobody_had_is_no_news_to_the_one_who_gets_it() -> None:
    scene = scene_at((0.0, 0.0, 2.0))
    assert scene.snapshot is not None
    nobody = msgspec.structs.replace(scene.snapshot, in_control=None)
    mine, scene = scene.snapshot, Scene()
    for seen in (FakeStation().hello()[0], nobody, mine):
        scene.update(seen)
    assert scene.answer.text == ""


@pytest.mark.parametrize(("columns", "named"), [(120, True), (64, False)])
def test_the_log_name_gives_way_to_what_is_wrong(columns: int, named: bool) -> None:
    scene = scene_at((0.0, 0.0, 0.0))
    scene.fence_on = False
    line = header(scene, columns).plain
    assert "FENCE OFF" in line
    assert ("x.mcap" in line) is named
    assert len(line) <= columns


def test_a_heading_never_reads_360() -> None:
    seen = msgspec.structs.replace(FakeStation().snapshot(), yaw_deg=359.9)
    assert any("000°" in value for _, value, _ in vehicle_panel.rows(seen, 1))


def test_unknown_values_are_dashes_not_zeros() -> None:
    scene = Scene()
    scene.update(FakeStation("silent").snapshot())
    assert "no vehicle heard yet" in vehicle_panel.draw(scene).plain
    scene = scene_at((0.0, 0.0, 0.0))
    assert "active none" in vehicle_panel.goals(scene).plain


def test_the_footer_fits_two_lines_of_eighty() -> None:
    lines = footer(80).plain.splitlines()
    assert len(lines) <= 2
    assert all(len(line) <= 80 for line in lines)


def test_no_key_is_bound_twice() -> None:
    names = [name for key in DEFAULT.keys for name in key.names]
    assert len(names) == len(set(names))


def path_dots(scene: Scene, *, style: str) -> int:
    picture = map_panel.draw(scene, 60, 20)
    map_end = picture.plain.rindex("\n")
    spans = [span for span in picture.spans if span.style == style and span.end <= map_end]
    return sum(span.end - span.start for span in spans)


def test_the_path_of_the_mission_is_drawn_and_gone_with_it() -> None:
    scene = scene_at((0.0, 0.0, 2.0))
    scene.update(ipc.MissionPath([(0.0, 0.0, 5.0), (10.0, 0.0, 5.0), (10.0, 10.0, 5.0)]))
    assert path_dots(scene, style=look.MISSION) > 10
    assert "mission" in map_panel.draw(scene, 60, 20).plain.splitlines()[-1]
    scene.update(ipc.MissionPath([]))
    assert path_dots(scene, style=look.MISSION) == 0


SQUARE = ipc.MissionPath(
    [(0.0, 0.0, 5.0), (10.0, 0.0, 5.0)],
    [
        ipc.MissionItem(0, "NAV_TAKEOFF", 5.0, "home"),
        ipc.MissionItem(1, "DO_CHANGE_SPEED"),
        *(ipc.MissionItem(n, "NAV_WAYPOINT", 512.5, "sea") for n in range(2, 60)),
    ],
)


def mission_rows(scene: Scene, rows: int = 12) -> list[str]:
    return mission_panel.draw(scene, 33, rows).plain.splitlines()


def test_the_mission_panel_says_what_is_on_board_how_far_it_is_and_what_comes() -> None:
    scene = scene_at((0.0, 0.0, 2.0))
    assert mission_rows(scene)[0] == "mission: none that was verified"
    scene.update(SQUARE)
    assert mission_rows(scene)[:4] == [
        "mission: 60 items from 0, verified",
        "   0 takeoff             5 m",
        "   1 change speed        ",
        "   2 waypoint            512.5 m amsl",
    ]
    assert scene.snapshot is not None
    flying = msgspec.structs.replace(scene.snapshot, state="FLYING_MISSION", mission_seq=2)
    scene.update(flying)
    assert [row[:5] for row in mission_rows(scene)[1:4]] == ["✓  1 ", "▶  2 ", "   3 "]
    scene.update(msgspec.structs.replace(flying, state="HOLDING", mission_seq=59))
    shown = mission_rows(scene)
    assert shown[-1].startswith("■ 59 waypoint")  # the last one, where the window ends
    assert len(shown) == 12
    scene.update(ipc.MissionPath([], [], "another mission is on board than was verified"))
    assert "another mission is on board" in mission_rows(scene)[1]


def test_the_mission_panel_shows_a_transfer_and_the_last_verdict() -> None:
    scene = scene_at((0.0, 0.0, 2.0))
    scene.update(ipc.ProgressEvent(9, "uploading", 3, 6, "items"))
    assert "█████░░░░░ uploading 3/6" in mission_rows(scene)
    scene.update(ipc.EndingEvent(9, "mission_upload", "aborted", "NO_ANSWER", "no answer"))
    assert mission_rows(scene)[1] == "mission upload: aborted"
    scene.update(ipc.EndingEvent(9, "mission_upload", "complete"))
    assert mission_rows(scene)[1].startswith(":mission upload FILE")
    scene.update(ipc.VerdictEvent(10, "mission_start", "refused", "OUTSIDE_FENCE", "350 m out"))
    scene.update(ipc.VerdictEvent(11, "goto", "accepted"))
    assert "refused" in "".join(mission_rows(scene)[1:3])


def test_the_fence_on_board_is_drawn_where_it_is_not_the_policy_s() -> None:
    scene = scene_at((0.0, 0.0, 2.0))
    yard = [(-8.0, -8.0), (8.0, -8.0), (8.0, 8.0), (-8.0, 8.0)]
    scene.update(ipc.VehicleFence([ipc.FenceShape("yard", True, corners_en=yard)]))
    assert path_dots(scene, style=look.OWN_FENCE) > 10
    assert "its own" in map_panel.draw(scene, 90, 20).plain.splitlines()[-1]
    turned = [(x + 0.1, y) for x, y in [*yard[1:], yard[0]]]
    scene.update(ipc.Fences([ipc.FenceShape("policy", True, corners_en=turned)]))
    assert path_dots(scene, style=look.OWN_FENCE) == 0
    hole = [(2.0, 2.0), (6.0, 2.0), (6.0, 6.0), (2.0, 6.0)]
    scene.update(ipc.VehicleFence([ipc.FenceShape("hole", False, corners_en=hole)]))
    scene.pending = PendingGoal((8.0, 8.0, 2.0))
    assert path_dots(scene, style=look.NO_FLY) > 10


def test_whoever_joins_sees_the_way_that_was_flown_before() -> None:
    flown = [
        ipc.TrailPoint(n * 10**9, (n / 10, 0.0, 2.0), 0.1, 90.0 - n / 20, in_air=True)
        for n in range(60)
    ]
    scene = Scene()
    for event in [
        *FakeStation().hello(),
        ipc.History(flown, [], in_air_since_ns=0),
        msgspec.structs.replace(
            FakeStation().snapshot(), time_ns=61 * 10**9, armed=True, landed="IN_AIR"
        ),
    ]:
        scene.update(event)
    assert path_dots(scene, style=look.TRAIL) > 3
    assert scene.numbers.flown_ns == 61 * 10**9
    assert scene.numbers.samples[0].battery_pct == 90.0


def test_what_the_operator_in_control_has_in_mind_is_shown_to_those_who_look_on() -> None:
    scene = controlled_by(OTHER)
    scene.update(ipc.OperatorGoal(2, (1.5, -1.0, 2.0)))
    assert map_panel.OTHERS in map_panel.draw(scene, 60, 20).plain
    mine = controlled_by(ipc.OperatorInfo(1, "gcs fly"))
    mine.update(ipc.OperatorGoal(1, (1.5, -1.0, 2.0)))
    assert map_panel.OTHERS not in map_panel.draw(mine, 60, 20).plain


@pytest.mark.parametrize("pan_en", [(0.0, 0.0), (0.3, -0.2)])
def test_a_cell_of_the_map_is_the_place_that_is_drawn_in_it(pan_en: tuple[float, float]) -> None:
    scene = scene_at((0.0, 0.0, 2.0))
    scene.pan_en = pan_en
    east_m, north_m = map_panel.place(scene, 60, 20, (40, 7))
    scene.pending = PendingGoal((east_m, north_m, 2.0))
    scene.zoom = 0
    row = map_panel.draw(scene, 60, 20).plain.splitlines()[7]
    assert row.index(map_panel.PENDING) == pytest.approx(40, abs=1)


def test_graphs_and_decisions_fill_a_wide_screen() -> None:
    scene = scene_at((0.0, 0.0, 2.0))
    assert scene.snapshot is not None
    for n in range(30):
        later = msgspec.structs.replace(scene.snapshot, time_ns=(n + 1) * 10**9)
        scene.update(later)
    scene.update(ipc.VerdictEvent(1, "goto", "refused", "OUTSIDE_FENCE", "350.0 m too far"))
    for rows in (36, 20, 18):  # 20 is what 200x60 has left beside an alarm
        graphs = Graphs(scene.numbers).draw(60, rows).plain
        assert len(graphs.splitlines()) <= rows
        for name in ("height, m", "speed, m/s", "battery, %"):
            assert name in graphs
    assert (
        "goto: refused OUTSIDE_FENCE: 350.0 m too far" in decisions_panel.draw(scene, 70, 8).plain
    )


@pytest.mark.parametrize(
    ("event", "words"),
    [
        (
            ipc.MessageEvent("WIND_COV", 0, 1, 1, {"wind_x": 0.0, "wind_y": 6.0}),
            "6.0 m/s from 270°",
        ),
        (ipc.MessageEvent("WIND", 0, 1, 1, {"speed": 6.0, "direction": 90.0}), "6.0 m/s from 090°"),
    ],
)
def test_the_wind_is_told_with_where_it_comes_from(event: ipc.MessageEvent, words: str) -> None:
    wind = wind_of(event, None)
    assert wind is not None
    assert wind.words(0) == words
    assert wind.words(6 * 10**9) == "-"


def test_the_fence_is_as_far_as_its_nearest_side_or_ceiling() -> None:
    circle = ipc.FenceShape("c", True, centre_en=(0.0, 0.0), radius_m=50.0, ceiling_up_m=10.0)
    tower = ipc.FenceShape("t", False, corners_en=[(20, -5), (30, -5), (30, 5), (20, 5)])
    assert flight_numbers.fence_m([circle], (0.0, 0.0, 2.0)) == pytest.approx(8.0)
    assert flight_numbers.fence_m([circle, tower], (17.0, 0.0, 2.0)) == pytest.approx(3.0)
    assert flight_numbers.fence_m([circle], (60.0, 0.0, 2.0)) == pytest.approx(-10.0)
    assert flight_numbers.fence_m([], (0.0, 0.0, 0.0)) is None


def test_minutes_left_are_those_of_the_use_in_the_air() -> None:
    numbers = flight_numbers.FlightNumbers()
    seen = msgspec.structs.replace(FakeStation().snapshot(), armed=True, landed="IN_AIR")
    for second in range(61):
        numbers.seen(
            msgspec.structs.replace(
                seen, time_ns=second * 10**9, battery_pct=80.0 - second * 10.0 / 60.0
            )
        )
    # 10 % a minute, 70 % are left, 20 % are to stay.
    assert numbers.minutes_left(20.0) == pytest.approx(5.0)
    assert flight_numbers.FlightNumbers().minutes_left(20.0) is None
