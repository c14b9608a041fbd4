"""A layout fits the flight: camera, grid and map, for one vehicle, a fleet and the lab."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest

from gcs.frames import Vec3
from gcs.live.services import request_of
from gcs.record.viewer.extent import extent_of, survey
from gcs.record.viewer.layout import PURPOSES, Purpose, any_flight, layout, layout_for
from gcs.record.viewer.live_layout import live_layout
from gcs.record.viewer.panel_scene import cell_size, zoom
from gcs.report import FenceItem, FenceShape, GeodeticItem, RecordItem
from tests.sample_files import elsewhere
from tests.unit.record.flights import MS, record
from tests.unit.record.viewer import pose

OURS = {
    "lichtblickPanelTitle",  # Lichtblick's name for foxglovePanelTitle
    "showLine",  # of a plot's path: points alone
    "foxglovePanelTitle",
}
"""Keys that the example has no use for in a panel of that kind."""


def square(side_m: float) -> list[RecordItem]:
    """A flight round a square, 5 m up, with the map's place known."""
    corners = [(0.0, 0.0), (side_m, 0.0), (side_m, side_m), (0.0, side_m)]
    fence = FenceShape(
        "yard",
        True,
        [(-5.0, -5.0), (side_m + 5, -5.0), (side_m + 5, side_m + 5)],
        None,
        0,
        0.0,
        9.0,
    )
    flight: list[RecordItem] = [FenceItem([fence], (47.4, 8.5, 488.0), 2.0, 0.5)]
    for north, east in corners:
        flight += [pose((north, east, -5.0)), GeodeticItem(1, 47.4, 8.5, 493.0, 5.0)]
    return flight


def camera_of(made: Any, panel: str = "3D!main") -> Any:
    return made["configById"][panel]["cameraState"]


def corners_seen(camera: Any, points: list[Vec3]) -> bool:
    """Whether a camera of 45 degrees sees them all: its direction from phi and thetaOffset."""
    phi, theta = math.radians(camera["phi"]), math.radians(camera["thetaOffset"])
    away = (
        math.sin(phi) * -math.sin(theta),
        math.sin(phi) * -math.cos(theta),
        math.cos(phi),
    )
    eye = [t + camera["distance"] * a for t, a in zip(camera["targetOffset"], away, strict=True)]
    for point in points:
        ray = [p - e for p, e in zip(point, eye, strict=True)]
        forward = -sum(r * a for r, a in zip(ray, away, strict=True))
        if forward <= 0 or math.acos(forward / math.hypot(*ray)) > math.radians(45 / 2) * 1.35:
            return False
    return True


@pytest.mark.parametrize("side_m", [4.0, 60.0, 800.0])
def test_camera_grid_and_map_fit_the_flight(tmp_path: Path, side_m: float) -> None:
    """The complaint: 4 m wide a speck, 60 m wide out of view."""
    made: Any = layout_for(record(tmp_path, square(side_m), step_ns=250 * MS))
    camera = camera_of(made)
    assert corners_seen(camera, [(0, 0, 5), (side_m, 0, 5), (side_m, side_m, 5), (0, side_m, 5)])
    assert camera["distance"] < 5 * (side_m + 10)
    ground = made["configById"]["3D!main"]["layers"]["grid"]
    assert 10 <= ground["divisions"] <= 50
    assert ground["size"] >= side_m
    where = made["configById"]["map!main"]
    assert where["center"]["lat"] == pytest.approx(47.4 + side_m / 2 / 111_195, abs=1e-4)
    metres_per_pixel = 156_543.034 * math.cos(math.radians(47.4)) / 2 ** where["zoomLevel"]
    assert side_m / metres_per_pixel < 300


def test_a_fence_that_is_much_larger_than_the_flight_does_not_make_it_a_speck() -> None:
    far = FenceShape("home", True, [], (0.0, 0.0), 150.0, 0.0, 50.0)
    near = FenceShape("mast", False, [], (6.0, 0.0), 2.0, None, None)
    found = extent_of([(0.0, 0.0, 0.0), (4.0, 4.0, 3.0)], FenceItem([far, near], None))
    assert found is not None
    assert found.high_enu == (8.0, 4.0, 3.0)


def test_without_a_file_the_camera_goes_with_the_vehicle() -> None:
    made: Any = layout_for(None)
    main = made["configById"]["3D!main"]
    assert (main["followMode"], main["followTf"]) == ("follow-position", "base_link")
    assert made["configById"]["map!main"]["followTopic"] == "/vehicle/1/location"


@pytest.mark.parametrize("purpose", PURPOSES)
def test_every_panel_has_its_title_for_both_viewers(purpose: Purpose) -> None:
    made: Any = layout(any_flight(2), purpose)
    for name, config in made["configById"].items():
        assert config["foxglovePanelTitle"] == config["lichtblickPanelTitle"] != "", name


@pytest.mark.parametrize("purpose", PURPOSES)
def test_panels_have_no_keys_but_those_that_a_viewer_knows(purpose: Purpose) -> None:
    example = json.loads(elsewhere("foxglove_layout_example.json").read_text())["configById"]
    known: dict[str, set[str]] = {"Table": {"topicPath"}}
    for name, config in example.items():
        known.setdefault(name.split("!")[0], set()).update(_keys(config))
    for name, config in layout(any_flight(2), purpose)["configById"].items():
        assert _keys(config) <= known[name.split("!")[0]] | OURS, name


def _keys(config: Any) -> set[str]:
    """Of a panel, its camera, its grid, and its plots' paths."""
    found = set(config)
    for inner in (config.get("cameraState", {}), config.get("layers", {}).get("grid", {})):
        found |= set(inner)
    for path in config.get("paths", []):
        found |= set(path)
    return found


def test_a_fleet_shows_every_vehicle(tmp_path: Path) -> None:
    flight = [*square(10.0), pose((3.0, 3.0, -4.0), sysid=2), pose((0.0, 3.0, -4.0), sysid=2)]
    made: Any = layout_for(record(tmp_path, flight, step_ns=250 * MS), "fleet")
    shown = made["configById"]["3D!main"]["topics"]
    assert {"/vehicle/1/model", "/vehicle/2/model", "/vehicle/1/path", "/vehicle/2/path"} <= set(
        shown
    )
    assert shown["/vehicle/1/path"]["gradient"] != shown["/vehicle/2/path"]["gradient"]
    assert "frame:base_link_2" in made["configById"]["3D!main"]["transforms"]
    heights = [path["value"] for path in made["configById"]["Plot!height"]["paths"]]
    assert heights == ["/vehicle/1/state.up_m", "/vehicle/2/state.up_m"]


def test_the_frames_are_those_of_the_file(tmp_path: Path) -> None:
    flight: list[RecordItem] = [pose((0.0, 0.0, 0.0), sysid=4), pose((0.0, 0.0, 0.0), sysid=2)]
    path = record(tmp_path, flight)
    assert survey(path).suffixed == {2}
    made: Any = layout_for(path)
    assert made["configById"]["3D!chase"]["followTf"] == "base_link_2"


def test_the_lab_sees_its_cage() -> None:
    made: Any = layout(any_flight(), "lab")
    corners = [(e, n, u) for e in (-5.0, 5.0) for n in (-5.0, 5.0) for u in (0.0, 2.0)]
    assert corners_seen(camera_of(made), corners)
    assert {"Plot!east", "Plot!north", "Plot!up", "Table!requests"} <= set(made["configById"])


def test_the_setpoint_is_not_joined_across_the_mission() -> None:
    made: Any = layout(any_flight())
    up, setpoint = made["configById"]["Plot!height"]["paths"]
    assert (up["showLine"], setpoint["showLine"]) == (True, False)


def test_nine_panels_with_the_states_over_the_whole_width() -> None:
    made: Any = layout(any_flight())
    assert len(made["configById"]) == 9
    rows = made["configById"]["StateTransitions!phase"]["paths"]
    assert [row["value"] for row in rows] == ["/vehicle/1/phase.state", "/vehicle/1/phase.mode"]
    assert (made["layout"]["direction"], made["layout"]["second"]) == (
        "column",
        "StateTransitions!phase",
    )


def test_a_record_without_phases_shows_the_states_as_they_were() -> None:
    topics = {"/vehicle/1/fsa", "/vehicle/1/state", "/vehicle/1/tf", "/gate/decision"}
    made: Any = layout(topics)
    rows = [row["value"] for row in made["configById"]["StateTransitions!phase"]["paths"]]
    assert rows == ["/vehicle/1/fsa.state", "/vehicle/1/state.mode"]


def test_the_state_is_the_gates_own_and_not_the_one_that_stood_a_while() -> None:
    made: Any = layout(any_flight())
    assert made["configById"]["Indicator!fsa"]["path"] == "/vehicle/1/fsa.state"


def test_an_imported_log_has_no_panels_of_a_gate() -> None:
    leaves = ("tf", "model", "path", "location", "state", "phase")
    made: Any = layout({"/log", *(f"/vehicle/1/{leaf}" for leaf in leaves)})
    kinds = {name.split("!")[0] for name in made["configById"]}
    assert kinds == {"3D", "map", "Plot", "RosOut", "StateTransitions"}
    rows = made["configById"]["StateTransitions!phase"]["paths"]
    assert [row["value"] for row in rows] == ["/vehicle/1/phase.mode", "/vehicle/1/phase.landed"]


@pytest.mark.parametrize(
    ("least", "cell"), [(0.2, 0.2), (0.21, 0.5), (1.0, 1.0), (3.0, 5.0), (7.0, 10.0), (40.0, 50.0)]
)
def test_cells_are_round_numbers(least: float, cell: float) -> None:
    assert cell_size(least) == pytest.approx(cell)


def test_the_map_zooms_out_by_one_for_twice_the_width() -> None:
    assert zoom(100.0, 47.0) - zoom(200.0, 47.0) == 1
    assert zoom(1e9, 0.0) == 2


def test_in_the_layout_of_a_live_view_a_click_is_in_the_map_and_every_button_is_a_service() -> None:
    yard = FenceShape(
        "yard", True, [(-40.0, -30.0), (60.0, -30.0), (60.0, 30.0)], None, 0.0, 0.0, 9
    )
    made: Any = live_layout([3, 1], FenceItem([yard], None), "abcd2345")
    main = made["configById"]["3D!main"]
    assert (main["followMode"], main["followTf"]) == ("follow-none", "map")
    assert main["publish"]["pointTopic"]
    assert {"frame:base_link", "frame:base_link_1"} <= set(main["transforms"])
    assert corners_seen(camera_of(made), [(-40, -30, 0), (60, -30, 9), (60, 30, 9)])
    buttons = {
        config["serviceName"]: json.loads(config["requestPayload"])
        for name, config in made["configById"].items()
        if name.startswith("CallService!")
    }
    assert {"take_control", "abort", "hold", "land"} <= set(buttons)
    for service, request in buttons.items():
        assert request_of(service, json.dumps(request).encode())
    assert buttons["take_control"] == {"code": "abcd2345"}
    assert _leaves(made["layout"]) == set(made["configById"])


def test_before_the_fence_is_known_the_live_layout_stands_in_the_map_too() -> None:
    made: Any = live_layout([], None, "abcd2345")
    assert made["configById"]["3D!main"]["followTf"] == "map"
    assert corners_seen(camera_of(made), [(-20, -20, 0), (20, 20, 0)])


def _leaves(tree: Any) -> set[str]:
    return {tree} if isinstance(tree, str) else _leaves(tree["first"]) | _leaves(tree["second"])
