"""Makes the graph of messages: of a station's record, or of a link that is listened to."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from gcs.graph.model import Edge, Flow, Graph, Kind, Node
from gcs.record.ros1 import FRAME_BYTES
from gcs.report import Direction
from gcs.topics.describe import enum_name
from gcs.topics.topic import DecodeError, Fields, Heard, Topic, Value
from gcs.wire.dialect import MESSAGES_BY_NAME

HUB = "hub"
RECORDER = "recorder"
INPUTS = "/session/input"
FIRST_NUMBER = 1000
"""Operators from here up are MAVLink clients of a bridge (`gcs.bridge.bridge.FIRST_NUMBER`)."""
LEAST_SPAN_NS = 2_000_000_000
"""What is sent for less time has no rate."""
PAUSE_NS = 2_500_000_000
"""A longer silence is a pause: setpoints are streamed at 20 Hz, but not all the time."""
LEAST_MESSAGES = 4
LEAST_MESSAGES_A_PAUSE = 10
"""With more pauses than one in so many messages, they are commands and answers."""
MAX_COMPONENTS = 64
"""Forged system ids make no more nodes than this."""


@dataclass(slots=True)
class _Count:
    """The messages of one flow; the rate is of the time in which they were sent, without pauses."""

    messages: int = 0
    first_ns: int = 0
    last_ns: int = 0
    _sent_ns: int = 0
    _gaps: int = 0

    def add(self, time_ns: int) -> None:
        gap_ns = time_ns - self.last_ns
        if not self.messages:
            self.first_ns = time_ns
        elif 0 <= gap_ns <= PAUSE_NS:
            self._sent_ns += gap_ns
            self._gaps += 1
        self.messages += 1
        self.last_ns = max(self.last_ns, time_ns)

    @property
    def hz(self) -> float | None:
        pauses = self.messages - 1 - self._gaps
        if pauses * LEAST_MESSAGES_A_PAUSE > self.messages:
            return None  # now and then, and no stream
        if self._sent_ns < LEAST_SPAN_NS or self.messages < LEAST_MESSAGES:
            return None
        return self._gaps * 1e9 / self._sent_ns


@dataclass(slots=True)
class _Operator:
    name: str = ""
    keyboard: bool = False


@dataclass(slots=True)
class Traffic:
    """Takes messages in order; `graph` is what they add up to.

    `recorded`: they come from a station's record, so there is a station in the middle, and a
    recorder; else a link is in the middle.  `where`: the name of the record or link.
    """

    recorded: bool
    where: str
    _counts: dict[tuple[str, str, str, bool], _Count] = field(default_factory=dict)
    """Source, target, name, whether it has a rate."""
    _components: dict[tuple[int, int], str] = field(default_factory=dict)
    """What each says that it is."""
    _operators: dict[int, _Operator] = field(default_factory=dict)
    _on_link: dict[int, dict[tuple[int, int], None]] = field(default_factory=dict)
    """Link -> the components that were heard on it."""
    _asked_last: dict[str, int] = field(default_factory=dict)
    """Word -> the operator who asked it last."""
    _station: str = ""
    _whole: _Count = field(default_factory=_Count)

    def hear(self, heard: Heard) -> None:
        """One message.  What does not decode is counted as recorded, and is nobody's."""
        topic = heard.topic
        self._whole.add(heard.time_ns)
        if self.recorded:
            self._count(HUB, RECORDER, _recorded_as(topic), heard.time_ns)
        parts = topic.name.split("/")
        match parts:
            case ["", "mavlink", sysid, compid, name] if sysid.isdecimal() and compid.isdecimal():
                self._frame(heard, (int(sysid), int(compid)), name)
            case ["", "session", "input"]:
                self._input(heard)
            case ["", "gate", "decision"]:
                self._decision(heard)
            case _:
                pass

    def learn(self, heard: Heard) -> None:
        """One message from before: who is there, and not what passed between them."""
        if heard.topic.name != INPUTS:
            return
        kind, client, data = _session_input(heard)
        self._introduce(kind, client, data)
        command = data.get("command")
        if kind == "OperatorGone":
            self._operators.pop(client, None)
        elif isinstance(command, dict) and command.get("type") == "pending":
            self._operators.setdefault(client, _Operator()).keyboard = True

    def graph(self) -> Graph:
        nodes = [self._hub()]
        for client, operator in sorted(self._operators.items()):
            title = "keyboard" if operator.keyboard else f"operator {client}"
            nodes.append(Node(f"operator {client}", Kind.OPERATOR, title, operator.name))
        for component, said in sorted(self._components.items()):
            title, detail = _described(component, said)
            nodes.append(Node(_id(component), Kind.COMPONENT, title, detail))
        if self.recorded:
            nodes.append(Node(RECORDER, Kind.RECORDER, "recorder", self.where))
        flows: dict[tuple[str, str], list[Flow]] = {}
        for (source, target, name, is_stream), count in self._counts.items():
            flow = Flow(name, count.messages, count.hz if is_stream else None)
            flows.setdefault((source, target), []).append(flow)
        edges = [
            Edge(*ends, sorted(found, key=lambda flow: (-flow.messages, flow.name)))
            for ends, found in sorted(flows.items())
        ]
        seconds = (self._whole.last_ns - self._whole.first_ns) / 1e9
        return Graph(self.where, seconds, HUB, nodes, edges)

    # ------------------------------------------------------------------------- what is heard

    def _frame(self, heard: Heard, source: tuple[int, int], name: str) -> None:
        framed = self.recorded and len(heard.data) >= FRAME_BYTES
        if framed and heard.data[1] != Direction.RECEIVED:
            if heard.data[1] == Direction.SENT:
                self._sent(heard, source, name)
            return
        if source not in self._components:
            if len(self._components) >= MAX_COMPONENTS:
                return
            self._components[source] = ""
        if framed:
            self._on_link.setdefault(heard.data[0], {})[source] = None
        if name == "HEARTBEAT" and not self._components[source]:
            self._components[source] = _self_description(_fields(heard))
        self._count(_id(source), HUB, name, heard.time_ns)

    def _sent(self, heard: Heard, source: tuple[int, int], name: str) -> None:
        """The station's own frame; of a bridge also one that it passes on, or an answer in the
        vehicle's name."""
        if source not in self._components:
            self._station = _id(source)
        for target in self._targets(heard, name):
            self._count(HUB, _id(target), name, heard.time_ns)

    def _targets(self, heard: Heard, name: str) -> list[tuple[int, int]]:
        """Whom a sent frame is for: the components of its target, or all, among those who were
        heard on its link (where nobody was: anywhere)."""
        sysid: Value = 0
        if _has_target(name):
            sysid = _fields(heard).get("target_system", 0)
        there = [*(self._on_link.get(heard.data[0]) or self._components)]
        autopilots = [each for each in there if each[1] == 1] or there
        return [each for each in autopilots if sysid in (0, each[0])]

    def _input(self, heard: Heard) -> None:
        kind, client, data = _session_input(heard)
        self._introduce(kind, client, data)
        link = data.get("link")
        if kind == "ClientGone" and isinstance(link, int):
            self._on_link.pop(link, None)  # its number is another client's next
        command = data.get("command")
        if kind == "OperatorLine" and isinstance(command, dict):
            self._command(client, command, heard.time_ns)

    def _introduce(self, kind: Value, client: int, data: Fields) -> None:
        """Who an operator is."""
        for inner in ("setup", "config"):  # where the name is lies deeper in some records
            within = data.get(inner)
            data = within if isinstance(within, dict) else data
        if kind in ("Setup", "OperatorJoined"):
            self._operators.setdefault(client, _Operator()).name = str(data.get("name", ""))

    def _command(self, client: int, command: Fields, time_ns: int) -> None:
        what = command.get("type")
        operator = self._operators.setdefault(client, _Operator())
        operator.keyboard = operator.keyboard or what == "pending"
        word = str(command.get("word") if what == "ask" else what)
        self._asked_last[word] = client
        self._count(f"operator {client}", HUB, word, time_ns, stream=False)

    def _decision(self, heard: Heard) -> None:
        """A verdict or an ending goes to who asked.  What MAVLink clients ask for is in no
        operator's line; the words that it became are in the verdicts."""
        fields = _fields(heard)
        word = str(fields.get("word"))
        client = self._asked_last.get(word)
        who = re.fullmatch(r"operator (\d{1,9})", str(fields.get("source")))
        if who is not None and int(who[1]) >= FIRST_NUMBER:
            client = int(who[1])
            self._operators.setdefault(client, _Operator()).name = "MAVLink client"
            if fields.get("phase") == "verdict":
                self._count(f"operator {client}", HUB, word, heard.time_ns, stream=False)
        if client is None:
            return
        text = f"{fields.get('outcome', '')} {fields.get('code', '')}".strip()
        self._count(HUB, f"operator {client}", text, heard.time_ns, stream=False)

    def _count(
        self, source: str, target: str, name: str, time_ns: int, *, stream: bool = True
    ) -> None:
        self._counts.setdefault((source, target, name, stream), _Count()).add(time_ns)

    def _hub(self) -> Node:
        if not self.recorded:
            return Node(HUB, Kind.LINK, "link", self.where)
        detail = f"station {self._station}" if self._station else "station"
        return Node(HUB, Kind.STATION, "gate", detail)


def _id(component: tuple[int, int]) -> str:
    return f"{component[0]}/{component[1]}"


def _recorded_as(topic: Topic) -> str:
    """The topics of a record in few words."""
    first = topic.name.split("/")[1]
    return "MAVLink frames" if first == "mavlink" else f"/{first}"


def _has_target(name: str) -> bool:
    definition = MESSAGES_BY_NAME.get(name)
    return definition is not None and any(
        each.name == "target_system" for each in definition.fields
    )


def _fields(heard: Heard) -> Fields:
    try:
        return heard.fields()
    except DecodeError:
        return {}


def _session_input(heard: Heard) -> tuple[Value, int, Fields]:
    """What reached the session: its kind, the operator's number, and all of it."""
    fields = _fields(heard)
    data = fields.get("data")
    if not isinstance(data, dict):
        return "", 1, {}
    client = data.get("client", 1)
    return fields.get("kind"), client if isinstance(client, int) else 1, data


def _self_description(heartbeat: Fields) -> str:
    """ "PX4 quadrotor" """
    autopilot = enum_name("HEARTBEAT", "autopilot", heartbeat.get("autopilot"))
    kind = enum_name("HEARTBEAT", "type", heartbeat.get("type"))
    autopilot = autopilot.removeprefix("MAV_AUTOPILOT_").replace("ARDUPILOTMEGA", "ArduPilot")
    names = (autopilot, kind.removeprefix("MAV_TYPE_").lower())
    return " ".join(name for name in names if name and name != "INVALID").replace("_", " ")


def _described(component: tuple[int, int], said: str) -> tuple[str, str]:
    """Title and detail of a component."""
    what = "vehicle" if component[1] == 1 else "component"
    if said == "gcs":
        what, said = "ground station", ""
    return f"{what} {_id(component)}", said
