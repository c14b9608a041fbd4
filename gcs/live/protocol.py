"""The messages of Foxglove's WebSocket protocol, as bytes and as values.  Pure.

https://github.com/foxglove/ws-protocol/blob/main/docs/spec.md; `foxglove.sdk.v1` is a newer name of
the same messages.  Text is JSON, told apart by `op`; binary messages begin with a byte that tells
them apart, and their numbers are little-endian.
"""

from __future__ import annotations

import base64
import struct
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, TypeAlias

import msgspec

SUBPROTOCOLS = ("foxglove.sdk.v1", "foxglove.websocket.v1")
"""Foxglove asks for the first, Lichtblick and older viewers for the second."""
CAPABILITIES = (
    *("clientPublish", "parameters", "parametersSubscribe", "services", "connectionGraph"),
)
METADATA = {"ROS_DISTRO": "humble"}
"""Foxglove and Lichtblick show the publish tools of their 3D panel, with which a click is a goal,
only where the server names a distribution of ROS.  There is no ROS here; of what else they do with
the name, ROS 2's names of the messages that are clicked, all is understood (`clicked_goals.py`)."""
INFO, WARNING = 0, 1

_MESSAGE_DATA, _CALL_RESPONSE = 1, 3
_CLIENT_MESSAGE, _CALL_REQUEST = 1, 2
_MESSAGE_HEADER = struct.Struct("<BIQ")
_CALL_HEADER = struct.Struct("<BIII")
_PUBLISH_HEADER = struct.Struct("<BI")
_TEXT_SCHEMAS = ("jsonschema", "ros1msg", "ros2msg", "ros2idl", "omgidl", "")
"""Encodings of schemas that are text; others are sent in base64."""


class BadClientMessageError(ValueError):
    """A message of a viewer that the protocol does not have: one sentence why."""


# ------------------------------------------------------------------------------ from viewers


Number = Annotated[int, msgspec.Meta(ge=0, lt=1 << 32)]


class Subscription(msgspec.Struct, frozen=True, rename="camel"):
    id: Number
    channel_id: Number


class ClientChannel(msgspec.Struct, frozen=True, rename="camel"):
    """A topic that a viewer publishes on."""

    id: Number
    encoding: str
    schema_name: str


class Parameter(msgspec.Struct, frozen=True):
    name: str
    value: Any = None


class _Op(msgspec.Struct, frozen=True, rename="camel", tag_field="op"):
    pass


class Subscribe(_Op, frozen=True, tag="subscribe"):
    subscriptions: list[Subscription]


class Unsubscribe(_Op, frozen=True, tag="unsubscribe"):
    subscription_ids: list[Number]


class Advertise(_Op, frozen=True, tag="advertise"):
    channels: list[ClientChannel]


class Unadvertise(_Op, frozen=True, tag="unadvertise"):
    channel_ids: list[Number]


class GetParameters(_Op, frozen=True, tag="getParameters"):
    """No names: all parameters."""

    parameter_names: list[str] = []
    id: str | None = None


class SetParameters(_Op, frozen=True, tag="setParameters"):
    parameters: list[Parameter]
    id: str | None = None


class SubscribeParameters(_Op, frozen=True, tag="subscribeParameterUpdates"):
    parameter_names: list[str] = []


class UnsubscribeParameters(_Op, frozen=True, tag="unsubscribeParameterUpdates"):
    parameter_names: list[str] = []


class SubscribeGraph(_Op, frozen=True, tag="subscribeConnectionGraph"):
    pass


class UnsubscribeGraph(_Op, frozen=True, tag="unsubscribeConnectionGraph"):
    pass


@dataclass(frozen=True, slots=True)
class ClientMessage:
    channel_id: int
    data: bytes


@dataclass(frozen=True, slots=True)
class CallRequest:
    service_id: int
    call_id: int
    encoding: str
    payload: bytes


TextRequest: TypeAlias = (
    Subscribe
    | Unsubscribe
    | Advertise
    | Unadvertise
    | GetParameters
    | SetParameters
    | SubscribeParameters
    | UnsubscribeParameters
    | SubscribeGraph
    | UnsubscribeGraph
)
ClientRequest: TypeAlias = TextRequest | ClientMessage | CallRequest

_decoder = msgspec.json.Decoder(TextRequest)


def client_request(data: bytes, *, text: bool) -> ClientRequest:
    """What a viewer says.  Raises BadClientMessageError."""
    try:
        if text:
            made: ClientRequest = _decoder.decode(data)
            return made
        if data[:1] == bytes([_CLIENT_MESSAGE]):
            _, channel = _PUBLISH_HEADER.unpack_from(data)
            return ClientMessage(channel, data[_PUBLISH_HEADER.size :])
        if data[:1] == bytes([_CALL_REQUEST]):
            _, service, call, length = _CALL_HEADER.unpack_from(data)
            begin = _CALL_HEADER.size + length
            encoding = data[_CALL_HEADER.size : begin].decode(errors="replace")
            return CallRequest(service, call, encoding, data[begin:])
    except (msgspec.DecodeError, RecursionError, struct.error) as error:
        raise BadClientMessageError(f"the message cannot be read: {error}") from error
    raise BadClientMessageError(f"a message that begins with {data[:1]!r} is not known here")


# -------------------------------------------------------------------------------- to viewers


def _text(op: str, **fields: object) -> bytes:
    return msgspec.json.encode({"op": op, **fields})


def server_info(session: str, encodings: Iterable[str]) -> bytes:
    """`session`: by it viewers tell a new server from one that they connect to again."""
    return _text(
        "serverInfo",
        name="mavgate",
        capabilities=CAPABILITIES,
        supportedEncodings=[*encodings],
        metadata=METADATA,
        sessionId=session,
    )


def channel(
    number: int, topic: str, encoding: str, schema_name: str, schema_encoding: str, schema: bytes
) -> dict[str, object]:
    """One topic of ours, for `advertise`."""
    if schema_encoding in _TEXT_SCHEMAS:
        text = schema.decode(errors="replace")
    else:
        text = base64.b64encode(schema).decode()
    return {
        "id": number,
        "topic": topic,
        "encoding": encoding,
        "schemaName": schema_name,
        "schemaEncoding": schema_encoding,
        "schema": text,
    }


def advertise(channels: list[dict[str, object]]) -> bytes:
    return _text("advertise", channels=channels)


def service(number: int, name: str, request: tuple[str, bytes], response: tuple[str, bytes]) -> Any:
    """One service, for `advertise_services`; a request and a response are a schema's name and its
    JSON schema."""

    def described(of: tuple[str, bytes]) -> dict[str, str]:
        return {
            "encoding": "json",
            "schemaName": of[0],
            "schemaEncoding": "jsonschema",
            "schema": of[1].decode(),
        }

    return {
        "id": number,
        "name": name,
        "type": request[0],
        "request": described(request),
        "response": described(response),
    }


def advertise_services(services: list[Any]) -> bytes:
    return _text("advertiseServices", services=services)


def status(text: str, level: int, number: str) -> bytes:
    """A later one of the same number takes its place in the viewer's list."""
    return _text("status", level=level, message=text, id=number)


def parameter_values(values: Mapping[str, float], number: str | None) -> bytes:
    parameters = [{"name": n, "value": v, "type": "float64"} for n, v in values.items()]
    return _text("parameterValues", parameters=parameters, **({"id": number} if number else {}))


def message_data(subscription: int, log_time_ns: int, data: bytes) -> bytes:
    return _MESSAGE_HEADER.pack(_MESSAGE_DATA, subscription, log_time_ns) + data


def call_response(service_id: int, call_id: int, payload: bytes) -> bytes:
    return _CALL_HEADER.pack(_CALL_RESPONSE, service_id, call_id, 4) + b"json" + payload


def call_failure(service_id: int, call_id: int, text: str) -> bytes:
    return _text("serviceCallFailure", serviceId=service_id, callId=call_id, message=text)


def graph_update(
    published: Mapping[str, list[str]],
    subscribed: Mapping[str, list[str]],
    services: Mapping[str, list[str]],
    removed: Iterable[str],
) -> bytes:
    """Names of topics and services, and the ids of the nodes at each; `removed` are topics."""
    return _text(
        "connectionGraphUpdate",
        publishedTopics=[{"name": n, "publisherIds": ids} for n, ids in published.items()],
        subscribedTopics=[{"name": n, "subscriberIds": ids} for n, ids in subscribed.items()],
        advertisedServices=[{"name": n, "providerIds": ids} for n, ids in services.items()],
        removedTopics=[*removed],
        removedServices=[],
    )
