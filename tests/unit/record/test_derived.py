"""What a viewer sees: frames, trail, fence, states, decisions, at modest rates."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pymap3d
import pytest

from gcs.frames import enu_from_ned
from gcs.record.derived.vehicle_json import euler_deg
from gcs.record.topics import Grid
from gcs.report import (
    FenceItem,
    GeodeticItem,
    InputItem,
    LogEvent,
    MissionItem,
    OriginItem,
    PointEnu,
    PoseItem,
    RecordItem,
    SetpointItem,
    StatusItem,
)
from tests.unit.record.flights import (
    MS,
    SECOND,
    START_NS,
    a_flight,
    decided,
    messages_of,
    record,
    summary_of,
)
from tests.unit.record.viewer import fsa, pictures, pose, readings, turned


def test_a_whole_flight_has_every_topic_and_each_decodes(tmp_path: Path) -> None:
    path = record(tmp_path, a_flight())
    summary = summary_of(path)
    schemas = {
        channel.topic: summary.schemas[channel.schema_id].name
        for channel in summary.channels.values()
    }
    assert schemas == {
        "/mavlink/1/1/LOCAL_POSITION_NED": "mavlink/LOCAL_POSITION_NED",
        "/link/0/garbage": "mavlink/Garbage",
        "/session/input": "session.Input",
        "/gate/decision": "gate.Decision",
        "/gate/requests": "gate.Requests",
        "/gate/fence": "gate.Fence",
        "/gate/goals": "foxglove.SceneUpdate",
        "/events": "foxglove.Event",
        "/origin": "foxglove.LocationFix",
        "/geofence": "foxglove.SceneUpdate",
        "/geofence/geojson": "foxglove.GeoJSON",
        "/mission": "foxglove.SceneUpdate",
        "/log": "foxglove.Log",
        "/tf_static": "foxglove.FrameTransforms",
        "/vehicle/1/tf": "foxglove.FrameTransforms",
        "/vehicle/1/model": "foxglove.SceneUpdate",
        "/vehicle/1/path": "foxglove.PosesInFrame",
        "/vehicle/1/setpoint": "foxglove.PoseInFrame",
        "/vehicle/1/target": "foxglove.SceneUpdate",
        "/vehicle/1/stop": "foxglove.SceneUpdate",
        "/vehicle/1/leg": "foxglove.SceneUpdate",
        "/vehicle/1/odometry": "foxglove.Odometry",
        "/vehicle/1/phase": "vehicle.Phase",
        "/vehicle/1/location": "foxglove.LocationFix",
        "/vehicle/1/state": "vehicle.State",
        "/vehicle/1/fsa": "gate.Fsa",
        "/vehicle/1/param": "vehicle.Param",
    }
    for topic, schema in schemas.items():
        if schema.startswith("foxglove."):
            assert pictures(path, topic)


# --------------------------------------------------------------------------------- frames


def test_the_static_frames_turn_ned_into_the_operators_enu(tmp_path: Path) -> None:
    path = record(tmp_path, [pose((1.0, 2.0, -3.0))])
    (static,) = pictures(path, "/tf_static")
    chain = {(t.parent_frame_id, t.child_frame_id): t.rotation for t in static.transforms}
    assert set(chain) == {("map", "local_ned"), ("base_link_frd", "base_link")}
    for v_ned in [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 2.0, -3.0)]:
        in_map = turned(chain["map", "local_ned"], v_ned)
        assert in_map == pytest.approx(enu_from_ned(v_ned), abs=1e-12)
    assert turned(chain["base_link_frd", "base_link"], (1.0, 1.0, 1.0)) == (1.0, -1.0, -1.0)


def test_the_body_frame_has_mavlinks_values_unchanged(tmp_path: Path) -> None:
    q = (math.sqrt(0.5), 0.0, 0.0, math.sqrt(0.5))
    path = record(tmp_path, [pose((1.0, 2.0, -3.0), q=q)])
    (message,) = pictures(path, "/vehicle/1/tf")
    (body,) = message.transforms
    assert (body.parent_frame_id, body.child_frame_id) == ("local_ned", "base_link_frd")
    assert (body.translation.x, body.translation.y, body.translation.z) == (1.0, 2.0, -3.0)
    assert (body.rotation.w, body.rotation.x, body.rotation.y, body.rotation.z) == q


def test_a_second_vehicle_has_frames_and_topics_of_its_own(tmp_path: Path) -> None:
    """Its local frame begins where its own origin is, 0.001 degrees east of the first one's."""
    flight: list[RecordItem] = [
        *(pose((0.0, 0.0, 0.0)), pose((5.0, 0.0, 0.0), sysid=2)),
        *(OriginItem(1, 47.0, 8.0, 488.0), OriginItem(2, 47.0, 8.001, 489.0)),
    ]
    path = record(tmp_path, flight)
    (message,) = pictures(path, "/vehicle/2/tf")
    (body,) = message.transforms
    assert (body.parent_frame_id, body.child_frame_id) == ("local_ned_2", "base_link_frd_2")
    (model,) = pictures(path, "/vehicle/2/model")
    assert model.entities[0].frame_id == "base_link_2"
    last_static = pictures(path, "/tf_static")[-1]
    assert [(t.parent_frame_id, t.child_frame_id) for t in last_static.transforms] == [
        ("map", "local_ned"),
        ("base_link_frd", "base_link"),
        ("map", "map_2"),
        ("map_2", "local_ned_2"),
        ("base_link_frd_2", "base_link_2"),
    ]
    offset = last_static.transforms[2].translation
    at_2 = pymap3d.geodetic2enu(47.0, 8.001, 489.0, 47.0, 8.0, 488.0)
    assert (offset.x, offset.y, offset.z) == pytest.approx(at_2, abs=0.3)
    (way,) = pictures(path, "/vehicle/2/path")
    assert way.frame_id == "map_2"


def test_json_topics_have_no_arrays_of_arrays(tmp_path: Path) -> None:
    """A viewer's rule: it says so of the whole topic, and shows nothing of it."""

    def check(schema: Any, topic: str) -> None:
        if schema["type"] == "array":
            assert schema["items"]["type"] != "array", topic
            check(schema["items"], topic)
        for inner in schema.get("properties", {}).values():
            check(inner, topic)

    schemas = summary_of(record(tmp_path, a_flight())).schemas.values()
    found = [one for one in schemas if one.encoding == "jsonschema"]
    assert len(found) >= 7
    for one in found:
        check(json.loads(one.data), one.name)


def test_a_pose_that_is_not_finite_is_not_drawn(tmp_path: Path) -> None:
    path = record(tmp_path, [pose((math.nan, 0.0, 0.0)), pose((0.0, 0.0, math.inf))])
    topics = {message.topic for message in messages_of(path)}
    assert "/vehicle/1/tf" not in topics
    assert "/vehicle/1/path" not in topics
    (state, *_) = readings(path, "/vehicle/1/state")
    assert "north_m" not in state


# ---------------------------------------------------------------------------------- rates


def test_a_fast_vehicle_is_recorded_at_modest_rates(tmp_path: Path) -> None:
    flight: list[RecordItem] = []
    for number in range(1000):  # ten seconds at 100 Hz
        flight.append(pose((number / 100, 0.0, -2.0)))
        flight.append(GeodeticItem(1, 47.0, 8.0, 490.0, 2.0))
    path = record(tmp_path, flight, step_ns=5 * MS)
    count: dict[str, int] = {}
    for message in messages_of(path):
        count[message.topic] = count.get(message.topic, 0) + 1
    assert count["/vehicle/1/tf"] == pytest.approx(250, abs=2)
    assert count["/vehicle/1/state"] == pytest.approx(50, abs=1)
    assert count["/vehicle/1/location"] == pytest.approx(50, abs=1)
    assert count["/vehicle/1/path"] == pytest.approx(10, abs=1)
    assert count["/vehicle/1/model"] == 1


def test_a_rate_limit_does_not_halve_an_input_just_above_it() -> None:
    grid = Grid(25.0)
    sent = sum(grid.due(START_NS + number * SECOND // 30) for number in range(300))
    assert sent == pytest.approx(250, abs=1)


def test_a_rate_limit_does_not_catch_up_after_silence() -> None:
    grid = Grid(10.0)
    assert grid.due(START_NS)
    later = START_NS + 10 * SECOND
    assert [grid.due(later + n * MS) for n in (0, 1, 2, 99, 100)] == [1, 0, 0, 0, 1]


def test_every_setpoint_is_recorded_heights_up(tmp_path: Path) -> None:
    path = record(tmp_path, [SetpointItem(1, (1.0, 2.0, -3.0), 0.0)] * 20)
    found = pictures(path, "/vehicle/1/setpoint")
    assert len(found) == 20
    at = found[0].pose.position
    assert found[0].frame_id == "map"
    assert (at.x, at.y, at.z) == (2.0, 1.0, 3.0)
    facing = turned(found[0].pose.orientation, (1.0, 0.0, 0.0))
    assert facing == pytest.approx((0.0, 1.0, 0.0), abs=1e-12)  # heading 0 is north


def test_a_hovering_vehicle_does_not_repeat_its_trail(tmp_path: Path) -> None:
    path = record(tmp_path, [pose((0.0, 0.0, -2.0))] * 500)
    assert len(pictures(path, "/vehicle/1/path")) == 1


# ----------------------------------------------------------------------------- state bars


def test_the_state_is_recorded_on_change_with_each_flush_and_at_close(tmp_path: Path) -> None:
    silence: list[RecordItem] = [InputItem.of("tick", {})] * 125  # 2.5 s
    path = record(tmp_path, [fsa("HOVERING"), *silence, fsa("MOVING", 3), *silence[:3]])
    found = [
        (message.log_time_ns - START_NS, json.loads(message.data)["state"])
        for message in messages_of(path)
        if message.topic == "/vehicle/1/fsa"
    ]
    assert [state for _, state in found] == ["HOVERING"] * 4 + ["MOVING"] * 2
    times_s = [round(at_ns / SECOND, 1) for at_ns, _ in found]
    assert times_s == [0.0, 0.8, 1.6, 2.4, 2.5, 2.6]


def test_reminders_from_the_session_do_not_double_the_rate(tmp_path: Path) -> None:
    path = record(tmp_path, [fsa("HOVERING")] * 150)  # 3 s at 50 Hz
    assert len(readings(path, "/vehicle/1/fsa")) == pytest.approx(4, abs=1)


def test_heights_are_up_and_angles_degrees(tmp_path: Path) -> None:
    half = math.sqrt(0.5)
    item = PoseItem(1, (1.0, 2.0, -3.0), (3.0, 4.0, -0.5), (half, 0.0, 0.0, -half))
    status = StatusItem(1, True, "OFFBOARD", "in_air", 80.0, None, 98.0, math.nan)
    path = record(tmp_path, [status, item, item], step_ns=300 * MS)
    state = readings(path, "/vehicle/1/state")[-1]
    assert (state["east_m"], state["north_m"], state["up_m"]) == (2.0, 1.0, 3.0)
    assert (state["groundspeed_mps"], state["climb_mps"]) == (5.0, 0.5)
    assert state["yaw_deg"] == pytest.approx(270.0)
    assert (state["mode"], state["armed"], state["battery_pct"]) == ("OFFBOARD", True, 80.0)
    assert "battery_v" not in state  # not known
    assert "lost_pct" not in state  # JSON has no NaN


@pytest.mark.parametrize(
    ("roll", "pitch", "yaw"), [(0, 0, 0), (30, 0, 0), (0, 20, 0), (0, 0, 90), (10, -20, 200)]
)
def test_euler_angles_of_known_rotations(roll: float, pitch: float, yaw: float) -> None:
    (cr, sr), (cp, sp), (cy, sy) = (
        (math.cos(math.radians(a) / 2), math.sin(math.radians(a) / 2)) for a in (roll, pitch, yaw)
    )
    q = (
        cr * cp * cy + sr * sp * sy,
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
    )
    assert euler_deg(q) == pytest.approx((roll, pitch, yaw), abs=1e-9)


# ------------------------------------------------------------------ decisions, log, scenes


def test_a_refused_goal_is_recorded_with_reason_and_numbers(tmp_path: Path) -> None:
    path = record(tmp_path, a_flight())
    (decision,) = readings(path, "/gate/decision")
    assert decision["goal"] == {"east_m": 500.0, "north_m": 0.0, "up_m": 2.0}
    assert decision["outcome"] == "refused"
    assert decision["code"] == "OUTSIDE_FENCE"
    assert decision["numbers"] == {"distance_m": 350.0}
    assert decision["zone"] == "home"


def test_a_goal_that_is_no_number_is_still_json(tmp_path: Path) -> None:
    goal, numbers = PointEnu(1.0, math.nan, math.inf), {"distance_m": math.nan}
    item = decided(1, "refused", code="NON_FINITE", goal=goal, numbers=numbers)
    (decision,) = readings(record(tmp_path, [item]), "/gate/decision")
    assert decision["goal"] == {"east_m": 1.0, "north_m": None, "up_m": None}
    assert decision["numbers"] == {"distance_m": None}


def test_inputs_are_recorded_as_they_came(tmp_path: Path) -> None:
    items = [InputItem.of("ask", {"word": "goto"}), InputItem.of('odd "kind"', [1, 2])]
    found = readings(record(tmp_path, items), "/session/input")
    assert found == [
        {"kind": "ask", "data": {"word": "goto"}},
        {"kind": 'odd "kind"', "data": [1, 2]},
    ]


def test_log_lines_keep_node_and_level(tmp_path: Path) -> None:
    path = record(
        tmp_path, [LogEvent(START_NS, level, "gate", f"line {level}") for level in range(1, 6)]
    )
    found = pictures(path, "/log")
    assert [(line.level, line.name, line.message) for line in found] == [
        (level, "gate", f"line {level}") for level in range(1, 6)
    ]
    assert found[0].timestamp.seconds == START_NS // SECOND


def test_the_fence_is_drawn_with_its_walls_in_map(tmp_path: Path) -> None:
    path = record(tmp_path, a_flight())
    (scene,) = pictures(path, "/geofence")
    assert len(scene.deletions) == 1  # the fence before it goes
    home, tower = scene.entities
    assert {home.frame_id, tower.frame_id} == {"map"}
    assert {point.z for point in home.triangles[0].points} == {0.0, 50.0}
    assert max(point.x for point in home.triangles[0].points) == pytest.approx(150.0)
    assert len(tower.triangles[0].indices) == 3 * 6  # three walls of two triangles
    assert all(math.isfinite(point.z) for point in tower.triangles[0].points)
    assert home.triangles[0].color.g > home.triangles[0].color.r  # keeps in
    assert tower.triangles[0].color.r > tower.triangles[0].color.g  # keeps out


def test_the_fence_is_on_the_map_where_the_origin_is_known(tmp_path: Path) -> None:
    path = record(tmp_path, a_flight())
    (message,) = pictures(path, "/geofence/geojson")
    home, tower = json.loads(message.geojson)["features"]
    ring = home["geometry"]["coordinates"][0]
    assert ring[0] == ring[-1]
    top_lat = max(lat for _, lat in ring)
    assert (top_lat - 47.397742) * 111_194.9 == pytest.approx(150.0, abs=0.1)
    assert len(tower["geometry"]["coordinates"][0]) == 4


def test_without_an_origin_there_is_no_fence_on_the_map(tmp_path: Path) -> None:
    path = record(tmp_path, [FenceItem([], None)])
    assert "/geofence" in {message.topic for message in messages_of(path)}
    assert "/geofence/geojson" not in {message.topic for message in messages_of(path)}


def test_a_mission_is_a_line_of_numbered_points(tmp_path: Path) -> None:
    path = record(tmp_path, [MissionItem(1, "m", ((0.0, 0.0, -5.0), (10.0, 0.0, -5.0)))])
    (scene,) = pictures(path, "/mission")
    points = scene.entities[0].lines[0].points
    assert [(point.x, point.y, point.z) for point in points] == [(0, 0, 5), (0, 10, 5)]
    assert [text.text for text in scene.entities[0].texts] == ["1", "2"]


def test_each_vehicle_has_its_mission_until_it_is_cleared(tmp_path: Path) -> None:
    """In its own frame: homes are apart."""
    way = ((0.0, 0.0, -5.0), (10.0, 0.0, -5.0))
    known = [pose((0.0, 0.0, 0.0)), pose((0.0, 0.0, 0.0), sysid=2)]
    told = [MissionItem(1, "a", way), MissionItem(2, "b", way), MissionItem(1, "", ())]
    scenes = pictures(record(tmp_path, [*known, *told]), "/mission")
    assert [[(e.id, e.frame_id, e.texts[0].text) for e in scene.entities] for scene in scenes] == [
        [("mission 1", "map", "1")],
        [("mission 1", "map", "1: 1"), ("mission 2", "map_2", "2: 1")],
        [("mission 2", "map_2", "1")],
    ]
    assert all(scene.deletions for scene in scenes)


def test_the_fields_of_json_topics_are_a_file_format(tmp_path: Path) -> None:
    summary = summary_of(record(tmp_path, a_flight()))
    fields = {
        schema.name: [
            (name, "goal" if name == "goal" else inner["type"])
            for name, inner in json.loads(schema.data)["properties"].items()
        ]
        for schema in summary.schemas.values()
        if schema.encoding == "jsonschema"
    }
    assert {name: " ".join(f"{n}:{t}" for n, t in found) for name, found in fields.items()} == {
        "gate.Decision": (
            "vehicle:integer request_id:integer source:string word:string phase:string"
            " outcome:string code:string sentence:string zone:string goal:goal numbers:object"
        ),
        "gate.Fsa": (
            "state:string state_id:integer before:string event:string control:string"
            " severity:string goal:goal conditions:array"
        ),
        "gate.Fence": "zones:array origin:array margin_h_m:number margin_v_m:number",
        "gate.Requests": "rows:array",
        "session.Input": "kind:string data:object",
        "vehicle.Phase": "state:string control:string severity:string mode:string landed:string",
        "vehicle.Param": "name:string value:number",
        "vehicle.State": (
            "east_m:number north_m:number up_m:number groundspeed_mps:number climb_mps:number"
            " roll_deg:number pitch_deg:number yaw_deg:number alt_amsl_m:number alt_rel_m:number"
            " armed:boolean mode:string landed:string battery_pct:number battery_v:number"
            " rx_hz:number lost_pct:number allowed_mps:number"
        ),
    }


def test_json_schemas_use_only_what_viewers_read(tmp_path: Path) -> None:
    summary = summary_of(record(tmp_path, a_flight()))
    found = [s for s in summary.schemas.values() if s.encoding == "jsonschema"]
    assert len(found) == 8

    def check(schema: dict[str, Any]) -> None:
        if schema["type"] == "array":
            check(schema["items"])
            return
        if schema["type"] == "object":
            for inner in schema["properties"].values():
                check(inner)
        elif schema["type"] == "array":
            assert schema["items"]["type"] != "array"
            check(schema["items"])
        else:
            assert schema["type"] in ("string", "number", "integer", "boolean")

    for schema in found:
        check(json.loads(schema.data))
