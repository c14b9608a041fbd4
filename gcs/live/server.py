"""What each viewer is sent, and what it asks for: the protocol's state, without a socket.  Pure.

`handle` takes what viewers say, what the station records and what `viewers.py` answers; it answers
with frames for viewers and with what they ask for.  Who subscribes late is sent the last message of
the topic, of some topics more, so that a viewer that comes late is not empty.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import TypeAlias, assert_never

import msgspec

from gcs import ipc
from gcs.live import protocol
from gcs.live.clicked_goals import ENCODINGS
from gcs.live.effects import Answering, Frame, Notice, Reply, Values
from gcs.live.inputs import Asked, Call, Called, Came, Gone, Graph, ParametersAsked, Published, Said
from gcs.live.parameters import Parameters
from gcs.live.services import SERVICES, Answer, schema_of

KEPT = {"/log": 200, "/gate/decision": 100, "/events": 100}
"""How many of the last messages of a topic there are for who subscribes late; 1 of the others.
What is repeated in a next file of the record (`latch`) is kept for each of its subjects."""
MAX_VIEWER_TOPICS = 32
"""Topics that one viewer may publish on."""
MAX_NAME_LETTERS = 128
"""Of their encoding and schema name, which are kept."""
STATUS_ID = "mavgate"
PARAMETERS = frozenset(Parameters.__struct_fields__)


ServerInput: TypeAlias = Came | Said | Gone | Graph | ipc.Topic | ipc.TopicMessage | Answering
ServerEffect: TypeAlias = Frame | Asked


@dataclass(slots=True)
class _Viewer:
    subscriptions: dict[int, int] = field(default_factory=dict)
    """Number of the subscription -> of our topic."""
    by_topic: dict[int, int] = field(default_factory=dict)
    topics: dict[int, protocol.ClientChannel] = field(default_factory=dict)
    """What it publishes on."""
    parameters: set[str] = field(default_factory=set)
    graph: bool = False


@dataclass(slots=True)
class _Topic:
    number: int
    described: dict[str, object]
    last: deque[tuple[bytes, int]]
    latched: dict[str, tuple[bytes, int]] = field(default_factory=dict)


class Server:
    """All viewers of one live view, as the protocol sees them."""

    def __init__(self, session: str) -> None:
        """`session`: another one for each server that there is."""
        self._info = protocol.server_info(session, ENCODINGS)
        self._services = dict(enumerate(SERVICES, 1))
        response = ("mavgate.Answer", schema_of(Answer))
        self._offered = protocol.advertise_services(
            [
                protocol.service(
                    number,
                    name,
                    (f"mavgate.{kind.__name__}", schema_of(kind)),
                    response,
                )
                for number, name in self._services.items()
                for kind in (SERVICES[name].request,)
            ]
        )
        self._viewers: dict[int, _Viewer] = {}
        self._topics: dict[int, _Topic] = {}
        self._by_name: dict[str, _Topic] = {}
        self._all: list[_Topic] = []
        self._graph = Graph({}, {})

    @property
    def graph_wanted(self) -> bool:
        """Whether a viewer has subscribed to the connection graph."""
        return any(viewer.graph for viewer in self._viewers.values())

    def handle(self, given: ServerInput) -> list[ServerEffect]:
        match given:
            case ipc.TopicMessage():
                return self._message(given)
            case Said(viewer, data, text):
                return self._said(viewer, data, text)
            case Came(viewer):
                return self._came(viewer)
            case Gone(viewer):
                self._viewers.pop(viewer, None)
                return [given]
            case ipc.Topic():
                return self._topic(given)
            case Reply(call, answer):
                payload = msgspec.json.encode(answer)
                data = protocol.call_response(call.service_id, call.call_id, payload)
                return self._frames([call.viewer], data, text=False)
            case Notice(viewer, text, warning):
                level = protocol.WARNING if warning else protocol.INFO
                data = protocol.status(text, level, STATUS_ID)
                return self._frames(self._viewers if viewer is None else [viewer], data)
            case Values():
                return self._values(given)
            case Graph():
                return self._graph_is(given)
            case _:
                assert_never(given)

    def _frames(
        self, viewers: Iterable[int], data: bytes, *, text: bool = True
    ) -> list[ServerEffect]:
        return [Frame(viewer, data, text) for viewer in viewers if viewer in self._viewers]

    # ------------------------------------------------------------------------- the station

    def _topic(self, told: ipc.Topic) -> list[ServerEffect]:
        """A topic is there from now on; one of that name that was there goes on."""
        known = self._by_name.get(told.topic)
        if known is not None:
            self._topics[told.number] = known
            return []
        # Not the station's number: that one begins anew with a new connection to it.
        number = len(self._all) + 1
        described = protocol.channel(
            number,
            told.topic,
            told.message_encoding,
            told.schema_name,
            told.schema_encoding,
            told.schema,
        )
        made = _Topic(number, described, deque(maxlen=KEPT.get(told.topic, 1)))
        self._all.append(made)
        self._by_name[told.topic] = self._topics[told.number] = made
        return self._frames(self._viewers, protocol.advertise([described]))

    def _message(self, told: ipc.TopicMessage) -> list[ServerEffect]:
        topic = self._topics.get(told.number)
        if topic is None:
            return []
        if told.latch:
            topic.latched[told.latch] = (told.data, told.log_time_ns)
        else:
            topic.last.append((told.data, told.log_time_ns))
        number = topic.number
        return [
            _of_topic(viewer, subscription, told.log_time_ns, told.data)
            for viewer, each in self._viewers.items()
            if (subscription := each.by_topic.get(number)) is not None
        ]

    # ------------------------------------------------------------------------- the viewers

    def _came(self, viewer: int) -> list[ServerEffect]:
        self._viewers[viewer] = _Viewer()
        topics = protocol.advertise([topic.described for topic in self._all])
        return [Frame(viewer, data, True) for data in (self._info, topics, self._offered)]

    def _said(self, viewer: int, data: bytes, text: bool) -> list[ServerEffect]:
        said_by = self._viewers.get(viewer)
        if said_by is None:
            return []
        try:
            request = protocol.client_request(data, text=text)
        except protocol.BadClientMessageError as error:
            return self._mistake(viewer, str(error))
        match request:
            case protocol.ClientMessage(channel, published):
                topic = said_by.topics.get(channel)
                if topic is None:
                    return self._mistake(viewer, f"channel {channel} was not advertised")
                return [Published(viewer, topic.encoding, topic.schema_name, published)]
            case protocol.CallRequest():
                return self._call(viewer, request)
            case protocol.Subscribe(subscriptions):
                return [one for each in subscriptions for one in self._subscribe(viewer, each)]
            case protocol.Unsubscribe(numbers):
                for number in numbers:
                    of_topic = said_by.subscriptions.pop(number, None)
                    if of_topic is not None:
                        del said_by.by_topic[of_topic]
            case protocol.Advertise(channels):
                return self._advertise(viewer, said_by, channels)
            case protocol.Unadvertise(numbers):
                for number in numbers:
                    said_by.topics.pop(number, None)
            case protocol.GetParameters(names, request_id):
                return [ParametersAsked(viewer, tuple(names), request_id)]
            case protocol.SetParameters(parameters, request_id):
                values = {each.name: each.value for each in parameters}
                return [ParametersAsked(viewer, tuple(values), request_id, values)]
            case protocol.SubscribeParameters(names):
                said_by.parameters |= PARAMETERS & set(names or PARAMETERS)
            case protocol.UnsubscribeParameters(names):
                said_by.parameters -= set(names or PARAMETERS)
            case protocol.SubscribeGraph():
                said_by.graph = True
                return self._frames([viewer], self._graph_update(()))
            case protocol.UnsubscribeGraph():
                said_by.graph = False
            case _:
                assert_never(request)
        return []

    def _mistake(self, viewer: int, text: str) -> list[ServerEffect]:
        return self._frames([viewer], protocol.status(text, protocol.WARNING, "request"))

    def _subscribe(self, viewer: int, wanted: protocol.Subscription) -> list[ServerEffect]:
        subscriber, number = self._viewers[viewer], wanted.channel_id
        if not 0 < number <= len(self._all):
            return self._mistake(viewer, f"there is no channel {number}")
        if wanted.id in subscriber.subscriptions or number in subscriber.by_topic:
            return self._mistake(viewer, f"subscription {wanted.id} or its channel is taken")
        subscriber.subscriptions[wanted.id] = number
        subscriber.by_topic[number] = wanted.id
        topic = self._all[number - 1]
        return [
            _of_topic(viewer, wanted.id, log_time_ns, data)
            for data, log_time_ns in (*topic.latched.values(), *topic.last)
        ]

    def _advertise(
        self, viewer: int, said_by: _Viewer, channels: list[protocol.ClientChannel]
    ) -> list[ServerEffect]:
        """Of any schema: viewers advertise all that their tools may publish.  What is no goal is
        refused once it is published."""
        for channel in channels:
            kept = (channel.encoding, channel.schema_name)
            room = len(said_by.topics) < MAX_VIEWER_TOPICS or channel.id in said_by.topics
            if not room or sum(map(len, kept)) > MAX_NAME_LETTERS:
                return self._mistake(viewer, f"channel {channel.id} is one too many, or too long")
            said_by.topics[channel.id] = channel
        return []

    def _call(self, viewer: int, asked: protocol.CallRequest) -> list[ServerEffect]:
        service, why = self._services.get(asked.service_id), ""
        if service is None:
            why = f"there is no service {asked.service_id}"
        elif asked.encoding != "json":
            why = f"the request of {service} must be json, not {asked.encoding[:40]!r}"
        else:
            call = Call(viewer, asked.service_id, asked.call_id)
            return [Called(call, service, asked.payload)]
        return self._frames([viewer], protocol.call_failure(asked.service_id, asked.call_id, why))

    def _values(self, given: Values) -> list[ServerEffect]:
        if given.viewer is not None:
            data = protocol.parameter_values(given.values, given.request)
            return self._frames([given.viewer], data)
        effects: list[ServerEffect] = []
        for viewer, each in self._viewers.items():
            wanted = {n: v for n, v in given.values.items() if n in each.parameters}
            if wanted:
                effects.append(Frame(viewer, protocol.parameter_values(wanted, None), True))
        return effects

    def _graph_is(self, graph: Graph) -> list[ServerEffect]:
        if graph == self._graph:
            return []
        before, self._graph = self._graph, graph
        gone = {*before.published, *before.subscribed} - {*graph.published, *graph.subscribed}
        data = self._graph_update(sorted(gone))
        return self._frames([n for n, each in self._viewers.items() if each.graph], data)

    def _graph_update(self, removed: Iterable[str]) -> bytes:
        services = {name: ["gate"] for name in SERVICES}
        return protocol.graph_update(
            self._graph.published, self._graph.subscribed, services, removed
        )


def _of_topic(viewer: int, subscription: int, log_time_ns: int, data: bytes) -> Frame:
    framed = protocol.message_data(subscription, log_time_ns, data)
    return Frame(viewer, framed, text=False, of_a_topic=True)
