"""The layout's file: made at once, anew with the fence, private, and gone in the end."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

import msgspec

from gcs import ipc
from gcs.live.session_layout import SessionLayout, remove_left
from gcs.record.fence_topic import written as written_fence
from gcs.report import FenceItem, FenceShape

FENCE = FenceItem([FenceShape("yard", True, [], (100.0, 0.0), 10.0, 0.0, 9.0)], None)


def written(layout: SessionLayout) -> Any:
    return json.loads(Path(layout.path).read_text())["configById"]


def test_it_stands_beside_the_record_and_follows_vehicles_and_fence(tmp_path: Path) -> None:
    layout = SessionLayout(str(tmp_path / "flight.mcap"), "8765", "abcd2345")
    path = tmp_path / "flight_viewer-8765.json"
    assert layout.path == str(path)
    assert written(layout)["Indicator!fsa"]["path"] == "/vehicle/1/fsa.state"
    layout.topic(ipc.Topic(1, "/vehicle/7/state", "json", "S", "jsonschema", b"{}"))
    layout.topic(ipc.Topic(2, "/gate/fence", "json", "F", "jsonschema", b"{}"))
    layout.message(ipc.TopicMessage(2, 1, msgspec.json.encode(written_fence(FENCE))))
    assert written(layout)["Indicator!fsa"]["path"] == "/vehicle/7/fsa.state"
    camera = written(layout)["3D!main"]["cameraState"]
    assert camera["targetOffset"][0] == 55.0  # between the origin and the far end of the fence
    if sys.platform != "win32":
        assert path.stat().st_mode & 0o077 == 0  # it holds the code
    layout.remove()
    assert not [*tmp_path.iterdir()]


def test_what_a_killed_view_has_left_goes_once_its_session_is_over(tmp_path: Path) -> None:
    over = ["20260101-000000_a_viewer-8765.json", "20260101-000000_a_viewer-8766.json.new"]
    stays = [
        "20260101-000001_b_viewer-8765.json",
        "20260101-000002_c_part3_viewer-8765.json",
        "20260101-000000_a.mcap",
        "mine_viewer-8765.json",
    ]
    for name in (*over, *stays):
        (tmp_path / name).touch()
    running = ["20260101-000001_b_part2.mcap", "20260101-000002_c.mcap"]
    remove_left(tmp_path, (str(tmp_path / name) for name in running))
    assert sorted(each.name for each in tmp_path.iterdir()) == sorted(stays)


def test_where_it_cannot_be_written_it_says_why(tmp_path: Path) -> None:
    layout = SessionLayout(str(tmp_path / "nowhere" / "flight.mcap"), "8765", "abcd2345")
    assert layout.path == ""
    assert "No such file" in layout.why
    layout.remove()
    assert "does not record" in SessionLayout("", "8765", "abcd2345").why
