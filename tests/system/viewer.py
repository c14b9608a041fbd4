"""A viewer in the test's own process: Foxglove's WebSocket protocol as it is described in
https://github.com/foxglove/ws-protocol, spoken with the websockets package.
"""

from __future__ import annotations

import itertools
import json
import struct
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from websockets.sync.client import ClientConnection, connect
from websockets.typing import Origin, Subprotocol

from tests.system.patience import PATIENT_S

MESSAGE, SERVICE_RESPONSE = 1, 3
CLIENT_MESSAGE, SERVICE_REQUEST = 1, 2
_MESSAGE_HEADER = struct.Struct("<BIQ")
_SERVICE_HEADER = struct.Struct("<BIII")


@dataclass(frozen=True)
class Heard:
    """One message of a topic."""

    topic: str
    log_time_ns: int
    data: bytes

    @property
    def json(self) -> Any:
        return json.loads(self.data)


@dataclass
class Viewer:
    """Keeps all that it hears; `until` reads."""

    connection: ClientConnection
    topics: dict[str, dict[str, Any]] = field(default_factory=dict)
    services: dict[str, int] = field(default_factory=dict)
    messages: list[Heard] = field(default_factory=list)
    statuses: list[str] = field(default_factory=list)
    parameters: dict[str, Any] = field(default_factory=dict)
    info: dict[str, Any] = field(default_factory=dict)
    _subscribed: dict[int, str] = field(default_factory=dict)
    _responses: dict[int, dict[str, Any]] = field(default_factory=dict)
    failures: list[str] = field(default_factory=list)
    graph: dict[str, list[str]] = field(default_factory=dict)
    """Topic -> nodes that publish it."""
    _numbers: Iterator[int] = field(default_factory=lambda: itertools.count(1))

    def until(self, condition: Callable[[], bool], what: str, timeout_s: float = PATIENT_S) -> None:
        deadline_s = time.monotonic() + timeout_s
        while not condition():
            left_s = deadline_s - time.monotonic()
            assert left_s > 0.0, f"not within {timeout_s:g} s: {what}; {self.statuses[-5:]}"
            try:
                self._take(self.connection.recv(timeout=left_s))
            except TimeoutError:
                continue

    def subscribe(self, *topics: str) -> None:
        self.until(lambda: all(topic in self.topics for topic in topics), f"the topics {topics}")
        wanted = []
        for topic in topics:
            number = next(self._numbers)
            self._subscribed[number] = topic
            wanted.append({"id": number, "channelId": self.topics[topic]["id"]})
        self.send({"op": "subscribe", "subscriptions": wanted})

    def call(self, service: str, **request: object) -> dict[str, Any]:
        """Call it and wait for the response."""
        self.until(lambda: service in self.services, f"the service {service}")
        number, encoding = next(self._numbers), b"json"
        header = _SERVICE_HEADER.pack(
            SERVICE_REQUEST, self.services[service], number, len(encoding)
        )
        self.connection.send(header + encoding + json.dumps(request).encode())
        self.until(lambda: number in self._responses, f"the response of {service}")
        return self._responses[number]

    def advertise(self, number: int, topic: str, schema_name: str, encoding: str = "json") -> None:
        channel = {"id": number, "topic": topic, "encoding": encoding, "schemaName": schema_name}
        self.send({"op": "advertise", "channels": [channel]})

    def publish(self, number: int, data: bytes) -> None:
        self.connection.send(struct.pack("<BI", CLIENT_MESSAGE, number) + data)

    def click(self, east_m: float, north_m: float, frame: str = "map") -> None:
        """As the 3D panel's publish tool does; the point is on the ground of the panel."""
        self.advertise(1, "/clicked_point", "geometry_msgs/PointStamped")
        point = {"x": east_m, "y": north_m, "z": 0.0}
        stamped = {"header": {"stamp": {"sec": 1, "nsec": 2}, "frame_id": frame}, "point": point}
        self.publish(1, json.dumps(stamped).encode())

    def set_parameter(self, name: str, value: float) -> None:
        parameters = [{"name": name, "value": value}]
        self.parameters.pop(name, None)
        self.send({"op": "setParameters", "parameters": parameters, "id": "set"})
        self.until(lambda: name in self.parameters, f"the answer about {name}")

    def of(self, topic: str) -> list[Heard]:
        return [heard for heard in self.messages if heard.topic == topic]

    def send(self, message: dict[str, object]) -> None:
        self.connection.send(json.dumps(message))

    def _take(self, data: str | bytes) -> None:
        if isinstance(data, str):
            self._take_json(json.loads(data))
        elif data[0] == MESSAGE:
            _, subscription, log_time_ns = _MESSAGE_HEADER.unpack_from(data)
            topic = self._subscribed[subscription]
            self.messages.append(Heard(topic, log_time_ns, data[_MESSAGE_HEADER.size :]))
        elif data[0] == SERVICE_RESPONSE:
            _, _, call, encoding_length = _SERVICE_HEADER.unpack_from(data)
            payload = data[_SERVICE_HEADER.size + encoding_length :]
            self._responses[call] = json.loads(payload)

    def _take_json(self, message: dict[str, Any]) -> None:
        match message["op"]:
            case "serverInfo":
                self.info = message
            case "advertise":
                self.topics |= {channel["topic"]: channel for channel in message["channels"]}
            case "advertiseServices":
                self.services |= {each["name"]: each["id"] for each in message["services"]}
            case "status":
                self.statuses.append(message["message"])
            case "parameterValues":
                self.parameters |= {each["name"]: each["value"] for each in message["parameters"]}
            case "serviceCallFailure":
                self.failures.append(message["message"])
            case "connectionGraphUpdate":
                published = message["publishedTopics"]
                self.graph = {each["name"]: each["publisherIds"] for each in published}


@contextmanager
def viewer(
    url: str, subprotocol: str = "foxglove.sdk.v1", origin: str | None = None
) -> Iterator[Viewer]:
    """Connected, and it knows the topics and services that are there."""
    with connect(
        url,
        subprotocols=[Subprotocol(subprotocol)],
        origin=Origin(origin) if origin else None,
        max_size=None,
        max_queue=None,  # it answers pings while the test does something else
        open_timeout=PATIENT_S,
        ping_timeout=PATIENT_S,
    ) as connection:
        made = Viewer(connection)
        made.until(lambda: bool(made.info and made.services), "the server's greeting")
        yield made
