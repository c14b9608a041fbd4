"""What a viewer publishes becomes a goal: ROS messages in JSON and in ROS 1 encoding.

The messages are those of ROS: geometry_msgs/PointStamped is a Header (uint32 seq, time stamp,
string frame_id) and a Point (three float64), PoseStamped has a quaternion x, y, z, w after it.
"""

from __future__ import annotations

import json
import math
import struct

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs.live.clicked_goals import (
    MAX_GOAL_BYTES,
    BadMessageError,
    ClickedGoal,
    clicked_goal,
)

POINT, POSE = "geometry_msgs/PointStamped", "geometry_msgs/PoseStamped"


def in_json(frame: str, **parts: object) -> bytes:
    stamp = {"sec": 1, "nsec": 2}
    return json.dumps({"header": {"seq": 0, "stamp": stamp, "frame_id": frame}, **parts}).encode()


def in_ros1(frame: str, *numbers: float) -> bytes:
    name = frame.encode()
    header = struct.pack("<IIII", 7, 1, 2, len(name)) + name
    return header + struct.pack(f"<{len(numbers)}d", *numbers)


def about_up(degrees: float) -> dict[str, float]:
    """A turn, anticlockwise from above."""
    half = math.radians(degrees) / 2.0
    return {"x": 0.0, "y": 0.0, "z": math.sin(half), "w": math.cos(half)}


@pytest.mark.parametrize("name", [POINT, "geometry_msgs/msg/PointStamped"])
def test_a_point_in_json(name: str) -> None:
    data = in_json("map", point={"x": 3.5, "y": -2.0, "z": 0.25})
    assert clicked_goal("json", name, data) == ClickedGoal((3.5, -2.0, 0.25))


def test_a_point_in_ros_1() -> None:
    assert clicked_goal("ros1", POINT, in_ros1("map", 3.5, -2.0, 0.25)) == ClickedGoal(
        (3.5, -2.0, 0.25)
    )


@pytest.mark.parametrize(
    ("turn_deg", "heading_deg"), [(0.0, 90.0), (90.0, 0.0), (180.0, 270.0), (-90.0, 180.0)]
)
def test_a_pose_has_a_heading(turn_deg: float, heading_deg: float) -> None:
    """A turn of 0 faces east (x), one of 90 north: REP 103."""
    turn = about_up(turn_deg)
    pose = {"position": {"x": 1.0, "y": 2.0, "z": 0.0}, "orientation": turn}
    stamped = {"timestamp": {"sec": 0, "nsec": 0}, "frame_id": "map", "pose": pose}
    for goal in (
        clicked_goal("json", POSE, in_json("map", pose=pose)),
        clicked_goal("ros1", POSE, in_ros1("map", 1.0, 2.0, 0.0, 0.0, 0.0, turn["z"], turn["w"])),
        clicked_goal("json", "foxglove.PoseInFrame", json.dumps(stamped).encode()),
    ):
        assert goal.at_enu == (1.0, 2.0, 0.0)
        assert goal.yaw_deg is not None
        assert math.remainder(goal.yaw_deg - heading_deg, 360.0) == pytest.approx(0.0, abs=1e-9)


def test_a_pose_without_a_direction_has_no_heading() -> None:
    data = in_ros1("map", 1.0, 2.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    assert clicked_goal("ros1", POSE, data).yaw_deg is None


def test_the_frames_of_the_record_are_known_and_no_others() -> None:
    at = {"x": 1.0, "y": 2.0, "z": -3.0}
    for frame in ("map", "/map"):
        assert clicked_goal("json", POINT, in_json(frame, point=at)).at_enu == (1.0, 2.0, -3.0)
    assert clicked_goal("json", POINT, in_json("local_ned", point=at)).at_enu == (2.0, 1.0, 3.0)
    for frame in ("base_link", "local_ned_2", ""):
        with pytest.raises(BadMessageError, match=f"'map', not in '{frame}'"):
            clicked_goal("json", POINT, in_json(frame, point=at))


def test_a_heading_in_north_east_down_is_clockwise_from_north() -> None:
    """About z, which points down: 90 degrees are east."""
    pose = {"position": {"x": 1.0, "y": 2.0, "z": -3.0}, "orientation": about_up(90.0)}
    goal = clicked_goal("json", POSE, in_json("local_ned", pose=pose))
    assert goal.yaw_deg == pytest.approx(90.0)


@pytest.mark.parametrize(
    ("encoding", "name", "data", "why"),
    [
        ("json", POINT, b"", "cannot be read"),
        ("json", POINT, b"[1,2,3]", "cannot be read"),
        ("json", POINT, b"{}", "neither a point nor a pose"),
        ("json", POINT, in_json("map", point={"x": "east", "y": 0}), "cannot be read"),
        ("json", POINT, b"[" * 4_000, "cannot be read"),
        ("json", POINT, b" " * (MAX_GOAL_BYTES + 1), "bytes"),
        ("ros1", POINT, b"", "cannot be read as ros1"),
        ("ros1", POINT, in_ros1("map", 1.0, 2.0), "cannot be read as ros1"),
        ("ros1", POINT, struct.pack("<IIII", 0, 0, 0, 0xFFFFFFFF), "cannot be read as ros1"),
        ("ros1", POSE, in_ros1("map", 1.0, 2.0, 3.0), "cannot be read as ros1"),
        ("cdr", POINT, b"", "encoding"),
        ("json", "geometry_msgs/PoseWithCovarianceStamped", b"{}", "a goal is one of"),
        ("json", "", b"{}", "a goal is one of"),
    ],
)
def test_what_is_no_goal_is_told_in_a_sentence(
    encoding: str, name: str, data: bytes, why: str
) -> None:
    with pytest.raises(BadMessageError, match=why):
        clicked_goal(encoding, name, data)


@given(st.sampled_from(["json", "ros1"]), st.sampled_from([POINT, POSE]), st.binary(max_size=200))
def test_any_bytes_are_a_goal_or_a_sentence(encoding: str, name: str, data: bytes) -> None:
    try:
        found: object = clicked_goal(encoding, name, data)
    except BadMessageError as error:
        found = str(error)
    assert found
    assert isinstance(found, ClickedGoal | str)
