"""Who sends what to whom, from a record and from a link."""

from __future__ import annotations

import json
import struct
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec
import pytest

from gcs.bridge import bridge
from gcs.exit_codes import ExitCode
from gcs.graph.model import Edge, Flow, Graph, Kind, Node
from gcs.graph.svg import as_svg
from gcs.graph.text import as_dot, as_text
from gcs.graph.traffic import FIRST_NUMBER, Traffic
from gcs.report import DecisionItem, Direction, FrameItem, InputItem, RecordItem
from gcs.topics.topic import Heard, live_topic, recorded_topic
from gcs.wire.frame import Frame, split
from tests.unit.cli.command_line import gcs
from tests.unit.record.flights import MS, START_NS, frame_v1, frame_v2, position_frame, record


def beat(source: tuple[int, int], mav_type: int, autopilot: int) -> bytes:
    payload = struct.pack("<IBBBBB", 0, mav_type, autopilot, 81, 4, 3)
    return frame_v1(0, payload, source=source)


def asked(client: int, word: str) -> InputItem:
    command = {"type": "ask", "id": 1, "word": word}
    return InputItem.of("OperatorLine", {"client": client, "command": command})


def verdict(word: str, outcome: str, code: str = "") -> DecisionItem:
    return DecisionItem(1, 1, "operator", word, "verdict", outcome, code, "", "", None, {})


def to_vehicle(sysid: int) -> FrameItem:
    """COMMAND_LONG of the station to one vehicle."""
    payload = struct.pack("<7fHBBB", 1, 0, 0, 0, 0, 0, 0, 400, sysid, 1, 0)
    return FrameItem(0, Direction.SENT, frame_v2(76, payload, source=(255, 190)))


def a_session() -> Iterator[RecordItem]:
    """Two operators, two vehicles; positions of the first at 12.5 Hz for 8 s."""
    yield InputItem.of("Setup", {"name": "demo", "operator": "first operator"})
    yield InputItem.of("OperatorJoined", {"client": 2, "name": "gcs attach, pid 7"})
    yield FrameItem(0, Direction.RECEIVED, beat((1, 1), 2, 12))
    yield FrameItem(0, Direction.RECEIVED, beat((2, 1), 2, 3))
    yield asked(1, "arm")
    yield verdict("arm", "accepted")
    yield to_vehicle(1)
    yield asked(2, "goto")
    yield verdict("goto", "refused", "OTHER_OPERATOR")
    yield InputItem.of("OperatorLine", {"client": 1, "command": {"type": "pending"}})
    yield FrameItem(0, Direction.SENT, beat((255, 190), 6, 8))
    yield FrameItem(0, Direction.REFUSED, position_frame(1).raw)
    for number in range(101):
        yield position_frame(number)


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return record(tmp_path_factory.mktemp("log"), a_session(), step_ns=80 * MS)


def graph_of(session: Path) -> Any:
    ended = gcs("graph", "--log", session, "--json")
    assert ended.exit_code == 0, ended.output
    return json.loads(ended.output)


def flows(graph: Any, source: str, target: str) -> dict[str, tuple[int, float | None]]:
    (edge,) = [e for e in graph["edges"] if (e["source"], e["target"]) == (source, target)]
    return {flow["name"]: (flow["messages"], flow["hz"]) for flow in edge["flows"]}


def test_a_record_shows_operators_gate_vehicles_and_recorder(session: Path) -> None:
    graph = graph_of(session)
    told = {node["id"]: (node["kind"], node["title"], node["detail"]) for node in graph["nodes"]}
    assert told == {
        "hub": ("station", "gate", "station 255/190"),
        "operator 1": ("operator", "keyboard", "demo"),
        "operator 2": ("operator", "operator 2", "gcs attach, pid 7"),
        "1/1": ("component", "vehicle 1/1", "PX4 quadrotor"),
        "2/1": ("component", "vehicle 2/1", "ArduPilot quadrotor"),
        "recorder": ("recorder", "recorder", session.name),
    }


def test_what_passes_between_them_has_counts_and_rates(session: Path) -> None:
    graph = graph_of(session)
    assert flows(graph, "operator 1", "hub") == {"arm": (1, None), "pending": (1, None)}
    assert flows(graph, "hub", "operator 1") == {"accepted": (1, None)}
    assert flows(graph, "hub", "operator 2") == {"refused OTHER_OPERATOR": (1, None)}
    assert flows(graph, "hub", "1/1") == {"COMMAND_LONG": (1, None), "HEARTBEAT": (1, None)}
    assert flows(graph, "hub", "2/1") == {"HEARTBEAT": (1, None)}, "the command was not for it"
    count, hz = flows(graph, "1/1", "hub")["LOCAL_POSITION_NED"]
    assert count == 101
    assert hz == pytest.approx(12.5, rel=1e-3)
    assert flows(graph, "hub", "recorder")["MAVLink frames"][0] == 106


def test_of_what_was_before_only_who_is_there_is_learnt() -> None:
    traffic = Traffic(recorded=True, where="log")
    topic = recorded_topic("/session/input", "session.Input", "json", {}, b"")
    for item in (
        InputItem.of("OperatorJoined", {"client": 2, "name": "gcs attach, pid 7"}),
        InputItem.of("OperatorJoined", {"client": 3, "name": "gcs abort, pid 8"}),
        InputItem.of("OperatorLine", {"client": 2, "command": {"type": "pending"}}),
        asked(1, "arm"),
        InputItem.of("OperatorGone", {"client": 3, "reason": "left"}),
    ):
        traffic.learn(Heard(topic, START_NS, msgspec.json.encode(item)))
    nested = {"setup": {"config": {"name": "flight"}}, "start_ns": START_NS}
    traffic.learn(Heard(topic, START_NS, msgspec.json.encode(InputItem.of("Setup", nested))))
    graph = traffic.graph()
    operators = [node for node in graph.nodes if node.kind is Kind.OPERATOR]
    assert [(node.title, node.detail) for node in operators] == [
        ("operator 1", "flight"),
        ("keyboard", "gcs attach, pid 7"),
    ]
    assert graph.edges == []


def test_a_link_that_is_listened_to_is_the_middle() -> None:
    traffic = Traffic(recorded=False, where="udpin://127.0.0.1:14550")
    for raw in (beat((1, 1), 2, 12), beat((255, 190), 6, 8), position_frame(0).raw):
        (frame,) = split(raw)
        assert isinstance(frame, Frame)
        traffic.hear(Heard(live_topic(frame), START_NS, raw))
    graph = traffic.graph()
    assert [(node.kind, node.title) for node in graph.nodes] == [
        (Kind.LINK, "link"),
        (Kind.COMPONENT, "vehicle 1/1"),
        (Kind.COMPONENT, "ground station 255/190"),
    ]
    assert [edge.source for edge in graph.edges] == ["1/1", "255/190"]


HOSTILE = Graph(
    'a"b\\<&\n',
    1.0,
    "hub",
    [
        Node("hub", Kind.STATION, "gate"),
        Node("operator 1", Kind.OPERATOR, '<script>"\\', "x\x00\n]]>"),
        Node("1/1", Kind.COMPONENT, "vehicle 1/1", "&amp;" * 40),
    ],
    [
        Edge("operator 1", "hub", [Flow('a"\\<b>', 3)]),
        Edge("1/1", "hub", [Flow(f"M{number}", 9, 1.5) for number in range(30)]),
    ],
)


def test_a_picture_is_whole_xml_whatever_the_names_are() -> None:
    root = ET.fromstring(as_svg(HOSTILE))
    texts = [each.text for each in root.iter("{http://www.w3.org/2000/svg}text")]
    assert '<script>"\\' in texts
    assert "23 more" in texts
    assert 'label="<script>\\"\\\\\\nx\x00 ]]>"' in "\n".join(as_dot(HOSTILE))


def test_nothing_in_a_picture_lies_over_another(session: Path) -> None:
    """Boxes do not overlap, and all is on the page."""
    ended = gcs("graph", "--log", session, "--svg")
    root = ET.fromstring(ended.output)
    width, height = float(root.get("width", 0)), float(root.get("height", 0))
    boxes = [
        [float(each.get(name, 0)) for name in ("x", "y", "width", "height")]
        for each in root.iter("{http://www.w3.org/2000/svg}rect")
        if "box" in each.get("class", "")
    ]
    assert len(boxes) == 6
    for number, (x, y, w, h) in enumerate(boxes):
        assert x >= 0
        assert y >= 0
        assert x + w <= width
        assert y + h <= height
        for x2, y2, w2, h2 in boxes[:number]:
            assert x + w <= x2 or x2 + w2 <= x or y + h <= y2 or y2 + h2 <= y


def test_a_rate_is_of_the_time_in_which_it_is_sent() -> None:
    """Setpoints at 20 Hz for 5 s, a hold of a minute, and 5 s again."""
    traffic = Traffic(recorded=False, where="link")
    raw = position_frame(0).raw
    (frame,) = split(raw)
    assert isinstance(frame, Frame)
    topic = live_topic(frame)
    for start_s in (0, 65):
        for number in range(101):
            traffic.hear(Heard(topic, START_NS + start_s * 1000 * MS + number * 50 * MS, raw))
    (edge,) = traffic.graph().edges
    assert [(flow.messages, flow.hz) for flow in edge.flows] == [(202, 20.0)]


def test_what_comes_now_and_then_has_no_rate() -> None:
    """Four messages half a second apart, every ten seconds."""
    traffic = Traffic(recorded=False, where="link")
    raw = position_frame(0).raw
    (frame,) = split(raw)
    assert isinstance(frame, Frame)
    topic = live_topic(frame)
    for start_s in range(0, 100, 10):
        for number in range(4):
            traffic.hear(Heard(topic, START_NS + start_s * 1000 * MS + number * 500 * MS, raw))
    (edge,) = traffic.graph().edges
    assert [(flow.messages, flow.hz) for flow in edge.flows] == [(40, None)]


def test_text_tells_the_rest_as_one_line() -> None:
    lines = as_text(HOSTILE, 5)
    assert [line.split() for line in lines if "more" in line] == [["26", "more", "39.0", "Hz"]]


def test_what_is_wrong_is_told(session: Path, tmp_path: Path) -> None:
    assert gcs("graph", "--log", session, "--dot", "--svg").exit_code == ExitCode.USAGE
    (tmp_path / "empty.mcap").write_bytes(b"")
    assert gcs("graph", "--log", tmp_path / "empty.mcap").exit_code == ExitCode.BAD_FILE
    nowhere = tmp_path / "none" / "x.svg"
    assert gcs("graph", "--log", session, "--svg", "-o", nowhere).exit_code == ExitCode.RECORDER


def test_what_a_bridge_answers_goes_to_the_client_on_that_link(tmp_path: Path) -> None:
    """In the vehicle's name; when that client has gone the link's number is another one's."""
    text = frame_v2(253, struct.pack("<B50s", 4, b"goto: refused"), source=(1, 1))
    answer = FrameItem(1, Direction.SENT, text)
    command = to_vehicle(1).raw

    def items() -> Iterator[RecordItem]:
        yield FrameItem(0, Direction.RECEIVED, beat((1, 1), 2, 12))
        yield FrameItem(1, Direction.RECEIVED, beat((254, 190), 6, 8))
        yield FrameItem(0, Direction.SENT, command)
        yield answer
        yield InputItem.of("ClientGone", {"link": 1, "reason": "silent"})
        yield FrameItem(1, Direction.RECEIVED, beat((253, 190), 6, 8))
        yield answer
        yield answer

    graph = graph_of(record(tmp_path, items()))
    assert graph["nodes"][0]["detail"] == "station 255/190"
    assert flows(graph, "hub", "1/1") == {"COMMAND_LONG": (1, None)}
    assert flows(graph, "hub", "254/190") == {"STATUSTEXT": (1, None)}
    assert flows(graph, "hub", "253/190") == {"STATUSTEXT": (2, None)}


def test_what_mavlink_clients_are_answered_has_edges(tmp_path: Path) -> None:
    """They are operators from 1000 up, and no line of an operator is theirs."""
    assert FIRST_NUMBER == bridge.FIRST_NUMBER

    def items() -> Iterator[RecordItem]:
        yield FrameItem(0, Direction.RECEIVED, beat((1, 1), 2, 12))
        for word, phase, outcome, code in (
            ("goto", "verdict", "refused", "OUTSIDE_FENCE"),
            ("arm", "verdict", "accepted", ""),
            ("arm", "ending", "complete", ""),
        ):
            item = verdict(word, outcome, code)
            yield msgspec.structs.replace(item, source="operator 1000", phase=phase)

    graph = graph_of(record(tmp_path, items()))
    assert flows(graph, "operator 1000", "hub") == {"goto": (1, None), "arm": (1, None)}
    assert flows(graph, "hub", "operator 1000") == {
        "refused OUTSIDE_FENCE": (1, None),
        "accepted": (1, None),
        "complete": (1, None),
    }


def test_topics_are_listed_with_each_frame_once(tmp_path: Path) -> None:
    """A bridge has passed two of them on to a client, and refused one of the client's own."""
    log = record(tmp_path, crossed())
    told = json.loads(gcs("topic", "list", "--log", log, "--json").output)
    assert {row["topic"]: row["messages"] for row in told if "mavlink" in row["topic"]} == {
        "/mavlink/1/1/HEARTBEAT": 2,
        "/mavlink/254/190/HEARTBEAT": 1,
        "/mavlink/254/190/GPS_INPUT": 1,
    }
    told = json.loads(gcs("topic", "info", "HEARTBEAT", "--log", log, "--json").output)
    assert [(row["topic"], row["messages"]) for row in told["topics"]] == [
        ("/mavlink/1/1/HEARTBEAT", 2),
        ("/mavlink/254/190/HEARTBEAT", 1),
    ]


def crossed() -> Iterator[RecordItem]:
    beats = beat((1, 1), 2, 12)
    yield FrameItem(1, Direction.RECEIVED, beat((254, 190), 6, 8))
    for _ in range(2):
        yield FrameItem(0, Direction.RECEIVED, beats)
        yield FrameItem(1, Direction.SENT, beats)
    yield FrameItem(1, Direction.REFUSED, frame_v2(232, bytes(63), source=(254, 190)))
