"""The gate as a viewer sees it: goals, the stopping point, the fence with its margin, the table."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import msgspec
import pytest

from gcs.report import (
    FenceItem,
    FenceShape,
    LegItem,
    LogEvent,
    PointEnu,
    PoseItem,
    RecordItem,
    SetpointItem,
    StopItem,
)
from tests.unit.record.flights import MS, SECOND, START_NS, decided, messages_of, record
from tests.unit.record.viewer import UPRIGHT, fsa, pictures, pose, readings

FAR = PointEnu(500.0, 0.0, 2.0)


def drawn(path: Path, topic: str) -> list[Any]:
    """All entities of a topic, in order."""
    return [entity for scene in pictures(path, topic) for entity in scene.entities]


# ---------------------------------------------------------------------------------- goals


def test_a_refused_goal_is_a_red_ball_with_its_reason(tmp_path: Path) -> None:
    goal = PointEnu(10.0, 5.0, 2.0)
    refused = decided(3, "refused", goal=goal, code="TOO_CLOSE", sentence="0.4 m from the mast")
    path = record(tmp_path, [pose((0.0, 0.0, -2.0)), refused])
    (entity,) = drawn(path, "/gate/goals")
    (ball,) = entity.spheres
    assert (ball.pose.position.x, ball.pose.position.y, ball.pose.position.z) == goal.enu
    assert ball.color.r > 0.8 > 0.3 > ball.color.g
    (line,) = entity.lines
    ends = [(point.x, point.y, point.z) for point in line.points]
    assert ends == [(0.0, 0.0, 2.0), goal.enu]
    assert [text.text for text in entity.texts] == ["REFUSED TOO_CLOSE: 0.4 m from the mast"]
    assert 3 <= entity.lifetime.seconds <= 4


def test_a_goal_that_no_vehicle_can_have_takes_no_frames_from_the_first_one(tmp_path: Path) -> None:
    refused = decided(3, "refused", goal=FAR, code="NO_VEHICLE", sentence="none is heard")
    path = record(tmp_path, [msgspec.structs.replace(refused, vehicle=0), pose((0.0, 0.0, -2.0))])
    (goal,) = drawn(path, "/gate/goals")
    (model,) = drawn(path, "/vehicle/1/model")
    assert (goal.frame_id, model.frame_id) == ("map", "base_link")


def test_an_accepted_goal_is_green_and_says_what_was_asked(tmp_path: Path) -> None:
    path = record(tmp_path, [decided(3, "accepted", goal=PointEnu(3.0, 0.0, 2.0))])
    (entity,) = drawn(path, "/gate/goals")
    assert entity.spheres[0].color.g > 0.8 > 0.3 > entity.spheres[0].color.r
    assert [text.text for text in entity.texts] == ["goto 3 0 2"]


def test_the_reason_for_a_goal_out_of_sight_stands_near_the_vehicle(tmp_path: Path) -> None:
    refused = decided(3, "refused", goal=FAR, code="OUTSIDE_FENCE", sentence="350.2 m outside")
    path = record(tmp_path, [pose((0.0, 0.0, -2.0)), refused])
    (entity,) = drawn(path, "/gate/goals")
    at = entity.texts[0].pose.position
    assert math.dist((at.x, at.y, at.z), (0.0, 0.0, 2.0)) < 40.0
    assert entity.spheres[0].pose.position.x == 500.0


def test_an_abort_and_a_refusal_without_a_goal_are_told_at_the_vehicle(tmp_path: Path) -> None:
    abort = decided(4, "aborted", phase="ending", code="FENCE_BREACH", sentence="braked")
    photo = decided(5, "refused", word="photo", code="BUSY", sentence="moving")
    path = record(tmp_path, [pose((1.0, 2.0, -3.0)), abort, photo])
    entities = drawn(path, "/gate/goals")
    assert [e.texts[0].text for e in entities] == [
        "ABORTED FENCE_BREACH: braked",
        "REFUSED BUSY: moving",
    ]
    assert {(e.texts[0].pose.position.x, e.texts[0].pose.position.y) for e in entities} == {
        (2.0, 1.0)
    }
    assert not any(entity.spheres for entity in entities)


def test_what_completes_and_what_has_no_place_is_not_drawn(tmp_path: Path) -> None:
    nowhere = decided(1, "refused", code="NO_VEHICLE")
    odd = decided(2, "refused", goal=PointEnu(math.nan, 0.0, 0.0), code="NON_FINITE")
    done = decided(3, "complete", phase="ending")
    path = record(tmp_path, [nowhere, odd, pose((0.0, 0.0, 0.0)), done])
    assert drawn(path, "/gate/goals") == []


# ------------------------------------------------------------------------------- markers


def test_the_predicted_stop_is_a_ring_that_vanishes(tmp_path: Path) -> None:
    path = record(tmp_path, [StopItem(1, (0.0, 0.0, -2.0), (3.0, 0.0, -2.0))])
    (entity,) = drawn(path, "/vehicle/1/stop")
    way, ring = entity.lines
    assert [(p.x, p.y, p.z) for p in way.points] == [(0.0, 0.0, 2.0), (0.0, 3.0, 2.0)]
    centre = [sum(getattr(p, axis) for p in ring.points) / len(ring.points) for axis in "xyz"]
    assert centre == pytest.approx((0.0, 3.0, 2.0), abs=1e-9)
    assert 0 < entity.lifetime.seconds * SECOND + entity.lifetime.nanos <= SECOND


def test_the_stop_says_how_fast_it_is_and_how_fast_it_may_be(tmp_path: Path) -> None:
    moving = PoseItem(1, (0.0, 0.0, -2.0), (3.0, 0.0, 0.0), UPRIGHT)
    stops = [
        StopItem(1, (0.0, 0.0, -2.0), (4.0, 0.0, -2.0), allowed_m_s=3.5),
        StopItem(1, (0.0, 0.0, -2.0), (4.0, 0.0, -2.0)),
    ]
    path = record(tmp_path, [moving, *stops], step_ns=SECOND)
    texts = [entity.texts[0].text for entity in drawn(path, "/vehicle/1/stop")]
    assert texts == ["3.0 of 3.5 m/s, stop 4.0 m", "3.0 m/s, stop 4.0 m"]


def test_the_leg_is_coloured_by_the_speed_that_is_allowed_and_by_the_one_flown(
    tmp_path: Path,
) -> None:
    places = ((0.0, 0.0, -2.0), (4.0, 0.0, -2.0), (8.0, 0.0, -2.0), (10.0, 0.0, -2.0))
    leg = LegItem(1, places, (6.0, 6.0, 3.0, 0.0))
    flown = [PoseItem(1, (n / 20, 0.0, -2.0), (3.0, 0.0, 0.0), UPRIGHT) for n in range(120)]
    path = record(tmp_path, [leg, *flown, LegItem(1, (), ())], step_ns=20 * MS)
    scenes = pictures(path, "/vehicle/1/leg")
    assert [len(scene.entities) for scene in scenes] == [1, 1, 1, 0]  # 2.4 s, once a second
    assert scenes[-1].deletions
    begun, late = scenes[0].entities[0], scenes[-2].entities[0]
    (ahead,) = begun.lines
    assert [(p.y, p.z) for p in ahead.points] == [(0.0, 2.0), (4.0, 2.0), (8.0, 2.0), (10.0, 2.0)]
    fast, still_fast, half, slow = ((c.r, c.g, c.b) for c in ahead.colors)
    assert fast == still_fast
    assert half == pytest.approx([(a + b) / 2 for a, b in zip(fast, slow, strict=True)])
    (words,) = begun.texts
    assert (words.text, words.pose.position.y) == ("slows from 6.0 m/s", 4.0)
    behind = late.lines[1]
    assert (behind.points[0].y, len(behind.points) <= 60) == (0.0, True)
    assert behind.points[-1].y == pytest.approx(5.0, abs=0.4)
    assert {(c.r, c.g, c.b) for c in behind.colors} == {half}


def test_a_long_reason_is_told_in_three_short_lines(tmp_path: Path) -> None:
    words = " ".join(f"word{n}" for n in range(60))
    refused = decided(3, "refused", goal=FAR, code="OUTSIDE_FENCE", sentence=words)
    replaced = decided(4, "superseded", goal=FAR, code="SUPERSEDED", sentence="by goto 1 0 2")
    path = record(tmp_path, [pose((0.0, 0.0, -2.0)), refused, replaced])
    long, short = (entity.texts[0].text.split("\n") for entity in drawn(path, "/gate/goals"))
    assert (len(long), max(map(len, long)) <= 40, long[-1][-1]) == (3, True, "…")
    assert short == ["SUPERSEDED: by goto 1 0 2"]


def test_a_vehicle_that_hovers_has_no_stop(tmp_path: Path) -> None:
    path = record(tmp_path, [StopItem(1, (0.0, 0.0, -2.0), (0.1, 0.0, -2.0))])
    assert drawn(path, "/vehicle/1/stop") == []


def test_the_setpoints_axes_vanish_when_no_setpoint_is_sent(tmp_path: Path) -> None:
    path = record(tmp_path, [SetpointItem(1, (1.0, 2.0, -3.0), 0.0)] * 40, step_ns=50 * MS)
    entities = drawn(path, "/vehicle/1/target")
    assert len(entities) == pytest.approx(10, abs=1)  # 2 s at 5 Hz
    entity = entities[0]
    assert 0 < entity.lifetime.seconds * SECOND + entity.lifetime.nanos <= SECOND
    assert [(line.points[0].x, line.points[0].y, line.points[0].z) for line in entity.lines] == [
        (2.0, 1.0, 3.0)
    ] * 3
    ahead = entity.lines[0].points[1]
    assert (ahead.x, ahead.y, ahead.z) == pytest.approx((2.0, 2.0, 3.0))  # heading 0 is north


# --------------------------------------------------------------------------------- fence


def test_the_margin_is_drawn_inside_an_inclusion_and_outside_an_exclusion(tmp_path: Path) -> None:
    box = [(-20.0, -20.0), (20.0, -20.0), (20.0, 20.0), (-20.0, 20.0)]
    zones = [
        FenceShape("yard", True, box, None, 0.0, 0.0, 20.0),
        FenceShape("mast", False, [], (5.0, 5.0), 3.0, None, None),
    ]
    path = record(tmp_path, [FenceItem(zones, None, 2.0, 0.5)])
    yard, mast = drawn(path, "/geofence")

    def near(entity: Any) -> list[Any]:
        return [
            p
            for line in entity.lines
            if line.color.b > 0.6  # paler than the boundary
            for p in line.points
        ]

    assert {round(max(abs(p.x), abs(p.y)), 6) for p in near(yard)} == {18.0}
    assert {round(p.z, 6) for p in near(yard)} == {0.5, 19.5}
    assert {round(math.hypot(p.x - 5, p.y - 5), 6) for p in near(mast)} == {5.0}
    assert {p.z for t in mast.triangles for p in t.points} == {0.0, 20.0}  # as high as the yard
    assert len(mast.triangles) == 4  # walls, bottom, top, margin


def test_without_a_margin_there_is_no_second_boundary(tmp_path: Path) -> None:
    zone = FenceShape("cage", True, [(0.0, 0.0), (5.0, 0.0), (5.0, 5.0)], None, 0.0, 0.0, 2.0)
    (cage,) = drawn(record(tmp_path, [FenceItem([zone], None)]), "/geofence")
    assert len(cage.triangles) == 1
    assert len(cage.lines) == 3  # below, above, and the edges between


def test_the_fence_is_a_json_topic_too(tmp_path: Path) -> None:
    zone = FenceShape("yard", True, [], (1.0, 2.0), 30.0, 0.0, 20.0)
    path = record(tmp_path, [FenceItem([zone], (47.0, 8.0, 488.0), 2.0, 0.5)])
    (found,) = readings(path, "/gate/fence")
    assert found["zones"][0]["centre"] == {"east_m": 1.0, "north_m": 2.0}
    assert (found["origin"], found["margin_h_m"], found["margin_v_m"]) == (
        [47.0, 8.0, 488.0],
        2.0,
        0.5,
    )


# -------------------------------------------------------------------------- table, events


def test_the_table_of_requests_grows_and_stands_after_any_seek(tmp_path: Path) -> None:
    flight: list[RecordItem] = [
        fsa("HOVERING"),
        decided(1, "accepted", goal=PointEnu(3.0, 0.0, 2.0)),
        decided(2, "refused", goal=FAR, code="OUTSIDE_FENCE", sentence="350.2 m outside"),
        decided(1, "aborted", phase="ending", code="OPERATOR", sentence="stopped"),
        decided(3, "accepted", word="arm"),
        decided(3, "complete", phase="ending", sentence="Complete"),
    ]
    tables = readings(record(tmp_path, flight, step_ns=SECOND), "/gate/requests")
    assert [len(table["rows"]) for table in tables] == [1, 1, 2, 2, 3, 3]
    assert tables[0]["rows"][0]["request"] == "nothing yet"
    arm, newest, oldest = tables[-1]["rows"]
    assert (arm["request"], arm["ending"], arm["reason"]) == ("arm", "complete", "")
    assert newest == {
        "at_s": 2.0,
        "request": "goto 500 0 2",
        "verdict": "refused",
        "ending": "",
        "reason": "OUTSIDE_FENCE: 350.2 m outside",
        "vehicle": 1,
        "source": "operator",
    }
    assert (oldest["verdict"], oldest["ending"]) == ("accepted", "aborted")
    assert oldest["reason"] == "OPERATOR: stopped"


def test_a_burst_of_requests_does_not_write_the_table_as_often(tmp_path: Path) -> None:
    burst: list[RecordItem] = [decided(n, "refused", code="BUSY") for n in range(1000)]
    tables = readings(record(tmp_path, burst, step_ns=2 * MS), "/gate/requests")
    assert len(tables) <= 12
    assert tables[-1]["rows"][0]["at_s"] == pytest.approx(2.0, abs=0.01)
    assert len(tables[-1]["rows"]) == 100


def test_a_request_is_an_event_from_verdict_to_ending_and_a_refusal_a_moment(
    tmp_path: Path,
) -> None:
    flight: list[RecordItem] = [
        decided(1, "accepted", goal=PointEnu(3.0, 0.0, 2.0)),
        decided(2, "refused", word="photo", code="BUSY"),
        decided(1, "complete", phase="ending"),
    ]
    refusal, flown = pictures(record(tmp_path, flight, step_ns=SECOND), "/events")
    assert refusal.start_time == refusal.end_time
    told = {pair.key: pair.value for pair in refusal.metadata}
    assert (told["request"], told["outcome"], told["code"]) == ("photo", "refused", "BUSY")
    assert flown.end_time.seconds - flown.start_time.seconds == 2
    assert {pair.key: pair.value for pair in flown.metadata}["request"] == "goto 3 0 2"


def test_numbers_of_a_decision_are_rounded_for_people(tmp_path: Path) -> None:
    exact = decided(
        1, "refused", numbers={"outside_m": 350.20000000000005, "lat_deg": 47.39774212345678}
    )
    (found,) = readings(record(tmp_path, [exact]), "/gate/decision")
    assert found["numbers"] == {"outside_m": 350.2, "lat_deg": 47.3977421}


# ----------------------------------------------------------------------- the first moment


def test_the_first_moment_has_static_frames_model_and_state(tmp_path: Path) -> None:
    """A viewer opens a record at its start and 0.1 s."""
    first = fsa("NO_VEHICLE", 4)
    path = record(tmp_path, [first, LogEvent(START_NS, 2, "x", "y")], step_ns=SECOND)
    early = {m.topic for m in messages_of(path) if m.log_time_ns < START_NS + 100 * MS}
    assert early >= {
        "/tf_static",
        "/vehicle/1/model",
        "/vehicle/1/fsa",
        "/vehicle/1/phase",
        "/gate/requests",
    }
    (static,) = pictures(path, "/tf_static")
    assert {t.child_frame_id for t in static.transforms} == {"local_ned", "base_link"}
