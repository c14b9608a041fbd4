"""What the bridge answers, as a closed union of frozen values, which the session carries out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from gcs import ipc
from gcs.bridge.client_plan import ClientPlan
from gcs.gate.effects import Level
from gcs.gate.refusal import Refusal
from gcs.protocol.effects import Address
from gcs.wire.ids import MissionType
from gcs.wire.messages import Message


@dataclass(frozen=True, slots=True)
class Joined:
    """A client has sent its first good frame: it is an operator from now on."""

    client: int
    name: str


@dataclass(frozen=True, slots=True)
class Lost:
    """A client is gone, or has been silent for too long."""

    client: int
    reason: str


@dataclass(frozen=True, slots=True)
class ClientRequest:
    """What a client asks for, in an operator's words."""

    client: int
    command: ipc.Command


@dataclass(frozen=True, slots=True)
class ClientRefused:
    """What a client asks for is refused before the gate sees it; `ask` names it."""

    client: int
    ask: ipc.Ask
    refusal: Refusal


@dataclass(frozen=True, slots=True)
class AsksPlan:
    """A client asks for `plan` on board, or (None) for the plan of that kind to be taken off."""

    client: int
    ask: ipc.Ask
    kind: MissionType
    plan: ClientPlan | None


@dataclass(frozen=True, slots=True)
class StopsPlan:
    """A client does not want what it asked for with `AsksPlan` as `ask_id` any more."""

    client: int
    ask_id: int
    reason: str


@dataclass(frozen=True, slots=True)
class AboutVehicle:
    """What is about the vehicle with that system id (0: the first, before it is heard).

    What is in no such effect is about all of them.
    """

    vehicle: int
    effects: tuple[BridgeEffect, ...]


@dataclass(frozen=True, slots=True)
class ForwardToVehicle:
    """A frame of a client that goes to the vehicle as it is; for all, on each link once."""

    raw: bytes


@dataclass(frozen=True, slots=True)
class AsksVehicle:
    """A message that the bridge sends to the vehicle in a client's name (`source`)."""

    source: Address
    message: Message


@dataclass(frozen=True, slots=True)
class AsksForStreams:
    """The gate's own streams are to be asked for once more: a client may have made them slower."""

    msgids: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class ChangesRallyPoints:
    """A client's message that goes to the vehicle may change its rally points, and is not answered:
    RALLY_POINT."""


@dataclass(frozen=True, slots=True)
class ForwardToLink:
    """A frame that goes to a client's link as it is."""

    link: int
    raw: bytes


@dataclass(frozen=True, slots=True)
class Reply:
    """A message for a client, in the name of the component that it addressed."""

    link: int
    source: Address
    message: Message


@dataclass(frozen=True, slots=True)
class LogLine:
    """A line for the log."""

    level: Level
    text: str


BridgeEffect: TypeAlias = (
    Joined
    | Lost
    | ClientRequest
    | ClientRefused
    | AboutVehicle
    | AsksPlan
    | StopsPlan
    | ForwardToVehicle
    | AsksVehicle
    | AsksForStreams
    | ChangesRallyPoints
    | ForwardToLink
    | Reply
    | LogLine
)
