"""The WebSocket server that viewers connect to: foxglove-sdk's, with the topics of a station.

Its callbacks run on its own threads; they decide nothing (`inbox.py`).  The SDK has no limit for
the number of connections, takes messages of 16 MiB, tells nobody where a page comes from (Origin),
and says that a connection has ended only by the end of its subscriptions and topics.
"""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable
from typing import Any

import foxglove
import msgspec
from foxglove.websocket import (
    Capability,
    ChannelView,
    Client,
    ClientChannel,
    MessageSchema,
    Parameter,
    ServerListener,
    ServiceRequest,
    ServiceSchema,
    StatusLevel,
    WebSocketServer,
)
from foxglove.websocket import Service as SdkService

from gcs import ipc
from gcs.live.clicked_goals import ENCODINGS, KINDS, MAX_MESSAGE_BYTES, kind_of
from gcs.live.inbox import Inbox
from gcs.live.inputs import Gone, Published
from gcs.live.parameters import Parameters
from gcs.live.services import MAX_REQUEST_BYTES, SERVICES, Answer, schema_of
from gcs.live.viewers import CALL_WAIT_NS

MESSAGE_BACKLOG = 512
"""Messages that wait for one viewer; then the oldest is dropped."""
MAX_VIEWER_TOPICS = 16
"""Topics that one viewer may publish on."""
MAX_DESCRIPTION_LETTERS = 128
"""Of such a topic's encoding and schema name, which are kept."""
CALL_WAIT_S = CALL_WAIT_NS / 1e9 + 1.0
FIRST_NS = 2_000_000_000
MAX_FIRST = 32
"""Messages that are kept from the first seconds of a topic, for who subscribes as it appears."""
STATUS_ID = "mavgate"
FIRST_PORTS = range(8765, 8775)
"""Tried in turn where no port is asked for; 8765 is what viewers offer."""


class PortTakenError(Exception):
    """Another program listens there."""


class LiveServer:
    """Topics out, calls and messages in; made with `start`."""

    def __init__(self, inbox: Inbox) -> None:
        self._inbox = inbox
        self._context = foxglove.Context()
        self._callbacks = Callbacks(inbox)
        self._channels: dict[int, foxglove.Channel] = {}
        self._topics: dict[str, int] = {}
        self._latched: dict[int, dict[str, tuple[bytes, int]]] = {}
        self._first: dict[int, list[tuple[bytes, int]]] = {}
        self._first_until_ns: dict[int, int] = {}
        self._last_ns = 0
        self._server: WebSocketServer | None = None

    def start(self, host: str, port: int) -> str:
        """Listen; the URL.  `port` 0: the first of `FIRST_PORTS` that is free.

        Raises PortTakenError, or OSError for an address that is not this machine's.
        """
        ports = [port] if port else FIRST_PORTS
        for each in ports:
            try:
                self._server = self._start(host, each)
            except PortTakenError:
                continue
            shown = f"[{host}]" if ":" in host else host
            return f"ws://{shown}:{self._server.port}"
        taken = f"{host}:{ports[0]}" if port else f"{host}:{ports[0]} to {ports[-1]}"
        raise PortTakenError(f"{taken}: the port is taken by another program")

    def _start(self, host: str, port: int) -> WebSocketServer:
        # The SDK logs every mistake of every viewer; nobody could read that beside a flight.
        logging.getLogger("foxglove").disabled = True
        try:
            return foxglove.start_server(
                name="mavgate",
                host=host,
                port=port,
                context=self._context,
                capabilities=[Capability.ClientPublish, Capability.Parameters, Capability.Services],
                supported_encodings=list(ENCODINGS),
                services=[self._service(name) for name in SERVICES],
                server_listener=self._callbacks,
                message_backlog_size=MESSAGE_BACKLOG,
            )
        except Exception as error:  # the SDK has one kind of error for all of them
            text = str(error)
            if "in use" in text.lower() or "only one usage" in text.lower():
                raise PortTakenError(text) from error
            raise OSError(text) from error

    def _service(self, name: str) -> SdkService:
        request = SERVICES[name].request
        return SdkService(
            name,
            schema=ServiceSchema(
                name=f"mavgate.{request.__name__}",
                request=_schema(f"mavgate.{request.__name__}", schema_of(request)),
                response=_schema("mavgate.Answer", schema_of(Answer)),
            ),
            handler=self._callbacks.on_call,
        )

    # --------------------------------------------------------------------------- the topics

    def topic(self, told: ipc.Topic) -> None:
        """A topic is there from now on; one of that name that was there goes on."""
        number = self._topics.get(told.topic)
        if number is not None:
            self._channels[told.number] = self._channels[number]
            self._latched[told.number] = self._latched[number]
            return
        self._topics[told.topic] = told.number
        self._latched[told.number] = {}
        if told.message_encoding != "ros1":  # of raw frames there will be others
            self._first[told.number] = []
        schema = foxglove.Schema(
            name=told.schema_name, encoding=told.schema_encoding, data=told.schema
        )
        self._channels[told.number] = foxglove.Channel(
            told.topic,
            schema=schema,
            message_encoding=told.message_encoding,
            metadata=dict(told.metadata),
            context=self._context,
        )

    def message(self, told: ipc.TopicMessage) -> None:
        """To every viewer that has subscribed to the topic."""
        number = told.number
        self._last_ns = max(self._last_ns, told.log_time_ns)
        if told.latch:
            self._latched[number][told.latch] = told.data, told.log_time_ns
        if number in self._first:
            self._keep_first(told)
        self._channels[number].base.log(told.data, told.log_time_ns)

    def _keep_first(self, told: ipc.TopicMessage) -> None:
        first = self._first[told.number]
        until_ns = self._first_until_ns.setdefault(told.number, told.log_time_ns + FIRST_NS)
        if told.log_time_ns >= until_ns or len(first) >= MAX_FIRST:
            del self._first[told.number]
        elif not told.latch:
            first.append((told.data, told.log_time_ns))

    def repeat(self) -> None:
        """Once more, on the topics that somebody has subscribed to since: what is said only once,
        and what came before a viewer could subscribe to a new topic.

        All who have subscribed get it, with the time that it had.
        """
        for topic in self._callbacks.take_subscribed():
            number = self._topics.get(topic, 0)
            again = list(self._latched.get(number, {}).values())
            if self._last_ns < self._first_until_ns.get(number, 0):
                again += self._first.get(number, [])
            for data, log_time_ns in again:
                self._channels[number].base.log(data, log_time_ns)

    # --------------------------------------------------------------------------- the viewers

    @property
    def parameters(self) -> Parameters:
        """As the viewers have set them."""
        return self._callbacks.parameters

    def trust(self, viewers: frozenset[int]) -> None:
        """Only these may set parameters."""
        self._callbacks.trusted = viewers

    def notice(self, text: str, *, warning: bool) -> None:
        """A sentence in every viewer's list of problems, in place of the one before."""
        if self._server is not None:
            level = StatusLevel.Warning if warning else StatusLevel.Info
            self._server.publish_status(text, level, STATUS_ID)

    def stop(self) -> None:
        if self._server is not None:
            self._server.stop()


def _schema(name: str, data: bytes) -> MessageSchema:
    return MessageSchema(
        encoding="json", schema=foxglove.Schema(name=name, encoding="jsonschema", data=data)
    )


class Callbacks(ServerListener):
    """What the SDK calls, on its own threads."""

    def __init__(self, inbox: Inbox) -> None:
        self._inbox = inbox
        self._lock = threading.Lock()
        self._topics: dict[int, dict[int, str]] = {}
        """What each viewer publishes on: number of its topic -> encoding and schema, by a NUL."""
        self._subscriptions: dict[int, set[int]] = {}
        self._subscribed: set[str] = set()
        self.parameters = Parameters()
        self.trusted: frozenset[int] = frozenset()

    def take_subscribed(self) -> set[str]:
        """Topics that somebody has subscribed to since the last time."""
        if not self._subscribed:
            return set()
        with self._lock:
            taken, self._subscribed = self._subscribed, set()
        return taken

    def on_subscribe(self, client: Client, channel: ChannelView) -> None:
        with self._lock:
            self._subscriptions.setdefault(client.id, set()).add(channel.id)
            self._subscribed.add(channel.topic)

    def on_unsubscribe(self, client: Client, channel: ChannelView) -> None:
        self._forget(client.id, self._subscriptions, lambda kept: kept.discard(channel.id))

    def on_client_advertise(self, client: Client, channel: ClientChannel) -> None:
        described = f"{channel.encoding}\0{channel.schema_name}"
        if len(described) > MAX_DESCRIPTION_LETTERS or kind_of(channel.schema_name) not in KINDS:
            return
        with self._lock:
            topics = self._topics.setdefault(client.id, {})
            if len(topics) < MAX_VIEWER_TOPICS:
                topics[channel.id] = described

    def on_client_unadvertise(self, client: Client, client_channel_id: int) -> None:
        self._forget(client.id, self._topics, lambda kept: kept.pop(client_channel_id, None))

    def _forget(
        self, viewer: int, of: dict[int, Any], remove: Callable[[Any], object]
    ) -> None:  # a set of subscriptions or a dictionary of topics
        with self._lock:
            kept = of.get(viewer)
            if kept is None:
                return
            remove(kept)
            if not kept:
                del of[viewer]
            gone = viewer not in self._subscriptions and viewer not in self._topics
        if gone:
            self._inbox.put(Gone(viewer))

    def on_message_data(self, client: Client, client_channel_id: int, data: bytes) -> None:
        described = self._topics.get(client.id, {}).get(client_channel_id)
        if described is None:
            return
        encoding, _, schema_name = described.partition("\0")
        # One byte too many is enough to be refused.
        self._inbox.put(
            Published(client.id, encoding, schema_name, bytes(data[: MAX_MESSAGE_BYTES + 1]))
        )

    def on_call(self, request: ServiceRequest) -> bytes:
        viewer = request.client_id
        watching = viewer in self._subscriptions or viewer in self._topics
        payload = bytes(request.payload[: MAX_REQUEST_BYTES + 1])
        answer = self._inbox.call(
            viewer, request.service_name, payload, watching=watching, wait_s=CALL_WAIT_S
        )
        return msgspec.json.encode(answer)

    def on_get_parameters(
        self, client: Client, param_names: list[str], request_id: str | None = None
    ) -> list[Parameter]:
        values = msgspec.structs.asdict(self.parameters)
        wanted = [name for name in param_names if name in values] or list(values)
        return [Parameter(name, value=values[name]) for name in wanted]

    def on_set_parameters(
        self, client: Client, parameters: list[Parameter], request_id: str | None = None
    ) -> list[Parameter]:
        """The values as they are now, which tells a viewer that only looks that it set nothing."""
        if client.id in self.trusted:
            asked: dict[str, object] = {each.name: each.get_value() for each in parameters}
            with self._lock:
                self.parameters = self.parameters.changed(asked)
        return self.on_get_parameters(client, [each.name for each in parameters], request_id)
