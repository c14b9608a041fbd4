"""One frame of a client, as it is given to be judged, and what comes of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from gcs.bridge.catalog import Row
from gcs.bridge.conversation.pending_requests import From
from gcs.bridge.effects import BridgeEffect
from gcs.bridge.peers.client import Exchange
from gcs.bridge.translate.meaning import Seen
from gcs.gate.refusal import Refusal
from gcs.protocol.effects import Address
from gcs.wire.frame import Frame
from gcs.wire.messages import Message

Look: TypeAlias = Callable[[], Seen | None]
"""How the vehicle is at this moment; None before one is heard."""


@dataclass(frozen=True, slots=True)
class Judged:
    """`refused`: the frame goes nowhere, and is recorded as refused."""

    refused: bool
    effects: Sequence[BridgeEffect]


@dataclass(frozen=True, slots=True)
class Received:
    """One frame of a client, and who it is from and for."""

    client: Exchange
    by: From
    frame: Frame
    look: Look
    now_ns: int
    autopilot: Address
    """Of the vehicle; `by.addressed` is another component of it where the client names one."""
    in_control: bool = False
    """The client is the one in control."""


def refuse(given: Received, message: Message | None, row: Row, refusal: Refusal) -> Judged:
    """It goes nowhere, and the client is told why."""
    dialogue = given.client.dialogue
    return Judged(True, dialogue.refuse(given.by, message, row.name, refusal, given.now_ns))
