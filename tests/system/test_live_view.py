"""A live view: viewers see the topics, stop the vehicle, and fly it once they have the code."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from websockets.exceptions import InvalidStatus

from gcs.exit_codes import ExitCode
from gcs.live.program import Opened, Wanted, opened_by
from gcs.mcap_file.format import Message
from gcs.mcap_file.reader import Reading
from gcs.operator.errors import ExitError
from tests.system.patience import until
from tests.system.station import Station, simulated
from tests.system.viewer import Viewer, viewer

pytestmark = pytest.mark.system

DECISIONS, FSA, STATE = "/gate/decision", "/vehicle/1/fsa", "/vehicle/1/state"


@pytest.fixture(autouse=True)
def runtime(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """Stations of this test alone."""
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path_factory.mktemp("run")))


def opened(operator: Station) -> Opened:
    """A live view of this station."""
    live = opened_by(Wanted(operator.client.pid, "127.0.0.1", 0))
    assert live is not None
    return live


@contextmanager
def watched(tmp_path: Path) -> Iterator[tuple[Station, Viewer, Opened]]:
    """A station with a vehicle on the ground, and a viewer that watches the gate."""
    with simulated(tmp_path) as operator:
        live = opened(operator)
        with viewer(live.url) as looker:
            looker.subscribe(FSA, STATE)
            looker.until(lambda: bool(looker.of(STATE)), "the vehicle's state")
            yield operator, looker, live
        operator.leave()


def decided(looker: Viewer) -> list[tuple[str, str]]:
    """Word and outcome of what was decided, in order."""
    return [(each.json["word"], each.json["outcome"]) for each in looker.of(DECISIONS)]


def state(looker: Viewer) -> str:
    found = looker.of(FSA)
    return str(found[-1].json["state"]) if found else ""


def told(looker: Viewer, words: str) -> bool:
    return any(words in status for status in looker.statuses)


def test_a_goal_that_is_clicked_inside_is_flown_and_one_outside_refused_with_the_reason(
    tmp_path: Path,
) -> None:
    with watched(tmp_path) as (operator, looker, live):
        assert looker.call("take_control", code=live.code)["accepted"]
        assert looker.call("arm")["accepted"]
        looker.until(lambda: bool(looker.of(STATE)[-1].json.get("armed")), "armed")
        looker.subscribe(DECISIONS)
        assert looker.call("takeoff", up_m=3.0)["accepted"]
        looker.until(lambda: ("takeoff", "complete") in decided(looker), "the take-off")
        looker.messages.clear()

        looker.click(4.0, 2.0)
        looker.until(lambda: ("goto", "complete") in decided(looker), "the goal")
        looker.until(lambda: state(looker) == "HOVERING", "HOVERING")
        last = looker.of(STATE)[-1].json
        assert last["east_m"] == pytest.approx(4.0, abs=0.7)
        assert last["north_m"] == pytest.approx(2.0, abs=0.7)
        assert last["up_m"] == pytest.approx(3.0, abs=0.7)
        assert decided(looker) == [("goto", "accepted"), ("goto", "complete")]
        sources = {heard.json["source"] for heard in looker.of(DECISIONS)}
        assert sources == {"operator 3"}  # 1 has started the station, 2 is the live view

        looker.click(1.0, 0.0, frame="base_link")
        looker.until(lambda: told(looker, "must be in the frame 'map'"), "the refusal")
        looker.send({"op": "subscribeConnectionGraph"})
        heartbeats = "vehicle 1/1/HEARTBEAT"
        looker.until(lambda: heartbeats in looker.graph, "the connection graph")
        assert looker.graph[heartbeats] == ["vehicle 1/1"]

        looker.messages.clear()
        looker.click(900.0, 0.0)
        looker.until(lambda: bool(looker.of(DECISIONS)), "the refusal")
        (refused,) = (heard.json for heard in looker.of(DECISIONS))
        assert (refused["outcome"], refused["code"]) == ("refused", "OUTSIDE_FENCE")
        looker.until(lambda: told(looker, "refused OUTSIDE_FENCE"), "the sentence")
        assert told(looker, refused["sentence"])
        looker.until(lambda: state(looker) == "HOVERING", "HOVERING still")
        answer = looker.call("goto", east_m=900.0, north_m=0.0)
        assert not answer["accepted"]
        assert answer["code"] == "OUTSIDE_FENCE"
        assert "m outside inclusion circle 'home'" in answer["sentence"]
        operator.dialogue.poll(0.0)
        assert looker.call("land")["accepted"]
        looker.until(lambda: state(looker) == "GROUNDED", "on the ground")


def test_without_the_code_a_viewer_stops_the_vehicle_and_moves_nothing(tmp_path: Path) -> None:
    with watched(tmp_path) as (operator, looker, live):
        operator.fly("arm", "takeoff 2")
        for service, request in (
            ("take_control", {"code": live.code[:-1]}),
            ("goto", {"east_m": 1.0, "north_m": 0.0}),
            ("step", {"direction": "up"}),
            ("takeoff", {"up_m": 5.0}),
            ("arm", {}),
            ("resume", {}),
        ):
            answer = looker.call(service, **request)
            assert (answer["accepted"], answer["code"]) == (False, "OTHER_OPERATOR"), service
        looker.click(1.0, 0.0)
        looker.until(lambda: told(looker, "take_control"), "the sentence about it")
        looker.until(lambda: state(looker) == "HOVERING", "HOVERING still")
        looker.set_parameter("goal_height_m", 9.0)
        assert looker.parameters["goal_height_m"] == 0.0
        assert looker.call("hold")["accepted"]
        looker.until(lambda: state(looker) == "HOLDING", "HOLDING")
        operator.fly("resume")
        assert looker.call("abort")["accepted"]
        looker.until(lambda: state(looker) == "HOLDING", "HOLDING")


def test_when_the_viewer_in_control_goes_the_vehicle_holds_and_control_returns(
    tmp_path: Path,
) -> None:
    with simulated(tmp_path) as operator:
        live = opened(operator)
        operator.fly("arm", "takeoff 2")
        with viewer(live.url) as flyer:
            flyer.subscribe(FSA)
            assert flyer.call("take_control", code=live.code)["accepted"]
            refused = operator.send("goto 1 0 2").verdict
            assert refused is not None
            assert refused.code == "OTHER_OPERATOR"
            assert "viewer" in refused.sentence
            flyer.set_parameter("goal_height_m", 4.0)
            assert flyer.parameters["goal_height_m"] == 4.0
            assert flyer.call("goto", east_m=60.0, north_m=0.0)["accepted"]
        operator.until(lambda: operator.said("Current State: HOLDING"), "HOLDING")
        operator.fly("resume", "goto 0 0 2")
        log_path = operator.log_path
        operator.leave()
    inputs = [
        r.data for r in Reading(log_path) if isinstance(r, Message) and b'"client":3' in r.data
    ]
    kinds = [json.loads(each)["kind"] for each in inputs if each.startswith(b'{"kind"')]
    assert kinds == ["OperatorJoined", "OperatorLine", "OperatorLine", "OperatorGone"]


def test_a_late_viewer_has_the_log_the_decisions_the_trail_and_what_was_said_only_once(
    tmp_path: Path,
) -> None:
    """By the older name of the protocol."""
    kept = ("/geofence", "/tf_static", "/vehicle/1/model", "/gate/fence", "/vehicle/1/path")
    with simulated(tmp_path) as operator:
        live = opened(operator)
        operator.fly("arm", "takeoff 2")
        with viewer(live.url, "foxglove.websocket.v1") as late:
            late.subscribe(*kept, "/log", DECISIONS)
            late.until(lambda: all(map(late.of, kept)), "what is kept")
            late.until(lambda: ("takeoff", "complete") in decided(late), "the decisions")
            late.until(lambda: len(late.of("/log")) > 5, "the log")
            log_path = operator.log_path
        operator.leave()
    recorded = {record.data for record in Reading(log_path) if isinstance(record, Message)}
    assert {heard.data for heard in late.messages} <= recorded


def test_a_page_that_is_not_known_is_not_let_in_and_the_others_are_told(tmp_path: Path) -> None:
    with watched(tmp_path) as (_, looker, live):
        with (
            pytest.raises(InvalidStatus, match="403"),
            viewer(live.url, origin="https://evil.example"),
        ):
            pass
        looker.until(lambda: told(looker, "a page of 'https://evil.example'"), "who was not let in")
        with viewer(live.url, origin="https://app.foxglove.dev") as page:
            assert page.info["name"] == "mavgate"
        layout = json.loads(Path(live.layout).read_text())["configById"]
        code = json.loads(layout["CallService!take_control"]["requestPayload"])
        assert code == {"code": live.code}
    until(lambda: not Path(live.layout).exists(), "the layout goes with the live view")


@pytest.mark.thorough
def test_a_viewer_is_told_what_is_in_the_record(tmp_path: Path) -> None:
    topic = "/mavlink/1/1/LOCAL_POSITION_NED"
    with watched(tmp_path) as (operator, looker, _):
        looker.subscribe(topic)
        operator.fly("arm")
        looker.subscribe(DECISIONS)
        operator.fly("takeoff 2", "land")
        looker.until(lambda: ("land", "complete") in decided(looker), "the landing")
        seen = {(heard.log_time_ns, heard.data) for heard in looker.of(topic)}
        told = {(heard.log_time_ns, heard.data) for heard in looker.of(DECISIONS)}
        log_path = operator.log_path
    recorded = {
        (record.log_time_ns, record.data)
        for record in Reading(log_path)
        if isinstance(record, Message)
    }
    assert len(seen) > 50
    assert seen | told <= recorded


@pytest.mark.thorough
def test_a_pose_in_ros_1_encoding_is_a_goal_with_a_heading(tmp_path: Path) -> None:
    with watched(tmp_path) as (operator, looker, live):
        operator.fly("arm", "takeoff 2")
        assert looker.call("take_control", code=live.code)["accepted"]
        looker.advertise(5, "/move_base_simple/goal", "geometry_msgs/PoseStamped", "ros1")
        pose = (2.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)  # faces east
        header = struct.pack("<IIII", 1, 2, 3, 3) + b"map"
        looker.publish(5, header + struct.pack("<7d", *pose))
        looker.until(lambda: state(looker) == "MOVING", "MOVING")
        looker.until(lambda: state(looker) == "HOVERING", "HOVERING")
        assert looker.of(STATE)[-1].json["yaw_deg"] == pytest.approx(90.0, abs=5.0)


def test_a_port_that_is_taken_is_told_with_a_hint(tmp_path: Path) -> None:
    with simulated(tmp_path) as operator:
        live = opened(operator)
        port = int(live.url.rpartition(":")[2])
        with pytest.raises(ExitError, match="taken by another program") as told:
            opened_by(Wanted(operator.client.pid, "127.0.0.1", port))
        assert told.value.exit_code == ExitCode.ADDRESS_IN_USE
        other = opened(operator)
        assert other.url != live.url
        operator.leave()
