"""The protocol's state without a socket: what each viewer is sent, and what it asks for.

Bytes are as in https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md.
"""

from __future__ import annotations

import base64
import json
import struct
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gcs import ipc
from gcs.live.effects import Frame, Notice, Reply, Values
from gcs.live.inputs import (
    Asked,
    Call,
    Called,
    Came,
    Gone,
    Graph,
    ParametersAsked,
    Published,
    Said,
)
from gcs.live.server import (
    KEPT,
    MAX_VIEWER_TOPICS,
    Server,
    ServerEffect,
)
from gcs.live.services import SERVICES, Answer

POINT = "geometry_msgs/msg/PointStamped"
JSON, RAW, LOG = 11, 12, 13
"""The station's numbers of three topics; the server's own are 1, 2, 3."""


class Script:
    def __init__(self) -> None:
        self.server = Server("session")
        self.topic(JSON, "/gate/fence")
        self.topic(RAW, "/raw", "ros1", "ros1msg", b"float32 x")
        self.topic(LOG, "/log", "protobuf", "protobuf", b"\x01\xff")

    def topic(
        self,
        number: int,
        name: str,
        encoding: str = "json",
        schema_encoding: str = "jsonschema",
        schema: bytes = b"{}",
    ) -> list[ServerEffect]:
        told = ipc.Topic(number, name, encoding, "Name", schema_encoding, schema)
        return self.server.handle(told)

    def come(self, viewer: int) -> list[Any]:
        return texts(self.server.handle(Came(viewer)))

    def say(self, viewer: int, **message: object) -> list[ServerEffect]:
        return self.server.handle(Said(viewer, json.dumps(message).encode(), True))

    def subscribe(self, viewer: int, number: int, topic: int) -> list[ServerEffect]:
        wanted = [{"id": number, "channelId": topic}]
        return self.say(viewer, op="subscribe", subscriptions=wanted)

    def advertise(self, viewer: int, number: int, schema: str = POINT) -> list[ServerEffect]:
        channel = {"id": number, "topic": "/t", "encoding": "json", "schemaName": schema}
        return self.say(viewer, op="advertise", channels=[channel])

    def record(self, number: int, data: bytes, at_ns: int = 5, latch: str = "") -> Any:
        return self.server.handle(ipc.TopicMessage(number, at_ns, data, latch))


def texts(effects: list[ServerEffect]) -> list[Any]:
    return [json.loads(each.data) for each in effects if isinstance(each, Frame) and each.text]


def warning(effects: list[ServerEffect]) -> str:
    (told,) = texts(effects)
    assert (told["op"], told["level"]) == ("status", 1)
    return str(told["message"])


def message(viewer: int, subscription: int, at_ns: int, data: bytes) -> Frame:
    framed = b"\x01" + subscription.to_bytes(4, "little") + at_ns.to_bytes(8, "little") + data
    return Frame(viewer, framed, text=False, of_a_topic=True)


def test_a_viewer_is_greeted_with_what_it_needs_to_show_its_tools() -> None:
    info, topics, services = Script().come(1)
    assert info["op"] == "serverInfo"
    assert set(info["capabilities"]) == {
        *("clientPublish", "parameters", "parametersSubscribe", "services", "connectionGraph"),
    }
    assert info["metadata"]["ROS_DISTRO"]  # without it viewers have no publish tools
    assert info["supportedEncodings"][0] == "json"
    assert [each["topic"] for each in topics["channels"]] == ["/gate/fence", "/raw", "/log"]
    raw, log = topics["channels"][1:]
    assert (raw["encoding"], raw["schemaEncoding"], raw["schema"]) == (
        *("ros1", "ros1msg", "float32 x"),
    )
    assert base64.b64decode(log["schema"]) == b"\x01\xff"
    assert [each["name"] for each in services["services"]] == [*SERVICES]
    for each in services["services"]:
        assert json.loads(each["request"]["schema"])["type"] == "object"
        assert each["response"]["schemaEncoding"] == "jsonschema"


def test_a_message_goes_to_who_has_subscribed_as_it_is() -> None:
    script = Script()
    script.come(1)
    script.come(2)
    assert script.subscribe(2, 70, 2) == []
    assert script.record(RAW, b"\x01\x02", 1 << 40) == [message(2, 70, 1 << 40, b"\x01\x02")]
    script.say(2, op="unsubscribe", subscriptionIds=[70, 71])
    assert script.record(RAW, b"\x03") == []
    assert script.subscribe(2, 70, 2) == [message(2, 70, 5, b"\x03")]
    assert script.server.handle(Gone(2)) == [Gone(2)]
    assert script.record(RAW, b"\x04") == []


def test_who_comes_late_has_the_last_log_the_last_of_each_and_what_is_said_once() -> None:
    script = Script()
    for number in range(KEPT["/log"] + 50):
        script.record(LOG, b"%d" % number, number)
    script.record(RAW, b"old")
    script.record(RAW, b"new")
    script.record(JSON, b"1", latch="fence")
    script.record(JSON, b"2", latch="mission")
    script.record(JSON, b"3", latch="fence")
    script.come(1)
    log = script.subscribe(1, 9, 3)
    assert len(log) == KEPT["/log"]
    assert log[0] == message(1, 9, 50, b"50")
    assert script.subscribe(1, 8, 2) == [message(1, 8, 5, b"new")]
    assert script.subscribe(1, 7, 1) == [message(1, 7, 5, b"3"), message(1, 7, 5, b"2")]


def test_a_topic_that_comes_later_is_told_and_one_that_is_told_again_goes_on() -> None:
    script = Script()
    script.come(1)
    (told,) = texts(script.topic(14, "/events"))
    assert told["channels"][0]["id"] == 4
    script.subscribe(1, 0, 2)
    assert script.topic(3, "/raw", "ros1", "ros1msg") == []  # after a new connection
    assert script.record(3, b"x") == [message(1, 0, 5, b"x")]


def test_subscriptions_that_make_no_sense_are_told_and_change_nothing() -> None:
    script = Script()
    script.come(1)
    script.subscribe(1, 1, 1)
    assert "no channel 9" in warning(script.subscribe(1, 2, 9))
    assert "no channel 0" in warning(script.subscribe(1, 2, 0))
    assert "is taken" in warning(script.subscribe(1, 1, 2))
    assert "is taken" in warning(script.subscribe(1, 2, 1))
    assert "cannot be read" in warning(script.subscribe(1, -1, 2))
    assert "cannot be read" in warning(script.subscribe(1, 1 << 32, 2))
    assert script.record(JSON, b"x") == [message(1, 1, 5, b"x")]


def test_what_a_viewer_publishes_is_handed_on_whatever_its_tools_advertise() -> None:
    script = Script()
    script.come(1)
    assert script.advertise(1, 7) == script.advertise(1, 8, "geometry_msgs/Other") == []
    said = Said(1, struct.pack("<BI", 1, 7) + b"goal", False)
    assert script.server.handle(said) == [Published(1, "json", POINT, b"goal")]
    script.say(1, op="unadvertise", channelIds=[7, 99])
    assert "was not advertised" in warning(script.server.handle(said))


def test_a_viewer_has_so_many_topics_with_short_names_and_no_more() -> None:
    script = Script()
    script.come(1)
    assert "too long" in warning(script.advertise(1, 1, "x" * 1_000))
    for number in range(MAX_VIEWER_TOPICS):
        assert script.advertise(1, number) == []
    assert script.advertise(1, 3) == []
    assert "one too many" in warning(script.advertise(1, 999))


def test_a_call_is_handed_on_and_answered_to_its_viewer() -> None:
    script = Script()
    script.come(1)
    request = struct.pack("<BIII", 2, 1, 77, 4) + b"json" + b'{"a":1}'
    call = Call(1, 1, 77)
    assert script.server.handle(Said(1, request, False)) == [Called(call, "abort", b'{"a":1}')]
    (frame,) = script.server.handle(Reply(call, Answer(False, "no", "BUSY")))
    assert isinstance(frame, Frame)
    assert frame.data[:17] == struct.pack("<BIII", 3, 1, 77, 4) + b"json"
    assert json.loads(frame.data[17:])["code"] == "BUSY"
    script.server.handle(Gone(1))
    assert script.server.handle(Reply(call, Answer(True, ""))) == []


@pytest.mark.parametrize(
    ("service", "encoding", "why"),
    [(99, b"json", "there is no service 99"), (1, b"cdr", "must be json, not 'cdr'")],
)
def test_a_call_that_nobody_can_answer_fails(service: int, encoding: bytes, why: str) -> None:
    script = Script()
    script.come(1)
    header = struct.pack("<BIII", 2, service, 5, len(encoding))
    (told,) = texts(script.server.handle(Said(1, header + encoding + b"{}", False)))
    assert (told["op"], told["serviceId"], told["callId"]) == ("serviceCallFailure", service, 5)
    assert why in told["message"]


def test_parameters_are_asked_for_set_and_subscribed_to() -> None:
    script = Script()
    script.come(1)
    script.come(2)
    assert script.say(1, op="getParameters", parameterNames=[], id="a") == [
        ParametersAsked(1, (), "a")
    ]
    wanted = [{"name": "step_m", "value": 2, "type": "float64"}]
    assert script.say(1, op="setParameters", parameters=wanted) == [
        ParametersAsked(1, ("step_m",), None, {"step_m": 2})
    ]
    (told,) = texts(script.server.handle(Values(1, {"step_m": 2.0}, "a")))
    value = {"name": "step_m", "value": 2.0, "type": "float64"}
    assert told == {"op": "parameterValues", "parameters": [value], "id": "a"}
    script.say(2, op="subscribeParameterUpdates", parameterNames=["step_m", "other"])
    changed = Values(None, {"step_m": 3.0, "goal_height_m": 1.0})
    (frame,) = script.server.handle(changed)
    assert isinstance(frame, Frame)
    assert frame.viewer == 2
    assert b"goal_height_m" not in frame.data
    script.say(2, op="unsubscribeParameterUpdates", parameterNames=[])
    assert script.server.handle(changed) == []


def test_the_graph_goes_to_who_has_asked_and_again_when_it_changes() -> None:
    script = Script()
    script.come(1)
    graph = Graph({"gate/goto": ["gate"]}, {"gate/goto": ["vehicle 1/1"]})
    assert script.server.handle(graph) == []
    (told,) = texts(script.say(1, op="subscribeConnectionGraph"))
    assert told["publishedTopics"] == [{"name": "gate/goto", "publisherIds": ["gate"]}]
    assert told["subscribedTopics"] == [{"name": "gate/goto", "subscriberIds": ["vehicle 1/1"]}]
    assert {"name": "abort", "providerIds": ["gate"]} in told["advertisedServices"]
    assert script.server.handle(graph) == []
    (told,) = texts(script.server.handle(Graph({}, {})))
    assert told["removedTopics"] == ["gate/goto"]
    script.say(1, op="unsubscribeConnectionGraph")
    assert not script.server.graph_wanted


def test_a_notice_is_told_to_one_or_to_all() -> None:
    script = Script()
    script.come(1)
    script.come(2)
    (one,) = script.server.handle(Notice(2, "no", warning=True))
    assert isinstance(one, Frame)
    assert (one.viewer, json.loads(one.data)["level"]) == (2, 1)
    both = script.server.handle(Notice(None, "yes", warning=False))
    assert [each["level"] for each in texts(both)] == [0, 0]


OPS = (
    *("subscribe", "unsubscribe", "advertise", "unadvertise", "getParameters", "setParameters"),
    *("subscribeParameterUpdates", "subscribeConnectionGraph", "fetchAsset"),
)
VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(
                ["id", "channelId", "topic", "encoding", "schemaName", "name", "value"]
            ),
            inner,
            max_size=4,
        )
    ),
    max_leaves=8,
)
KEYS = st.sampled_from(
    ["subscriptions", "subscriptionIds", "channels", "channelIds", "parameters", "parameterNames"]
)


@pytest.mark.slow
@given(st.sampled_from(OPS), st.dictionaries(KEYS, VALUES), st.binary(max_size=40), st.booleans())
def test_whatever_a_viewer_says_it_is_answered_and_no_one_else(
    op: str, fields: dict[str, object], data: bytes, raw: bool
) -> None:
    script = Script()
    script.come(1)
    script.come(2)
    said = data if raw else json.dumps({"op": op, **fields}).encode()
    for text in (True, False):
        for effect in script.server.handle(Said(1, said, text)):
            assert isinstance(effect, Frame | Called | Published | ParametersAsked)
            asked: Frame | Asked = effect
            assert (asked.call.viewer if isinstance(asked, Called) else asked.viewer) == 1
    assert script.subscribe(2, 1, 1) == []
    assert script.record(JSON, b"x")[-1] == message(2, 1, 5, b"x")
