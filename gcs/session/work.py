"""What the parts of the session return: effects for the shell, and work for other parts.

No part calls another one sideways.  A part returns a list of `Work`; the session's queue
(`queue.py`) hands each item to the part that it is for, until only effects are left.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from gcs.frames import Vec3
from gcs.gate import effects as gate_effects
from gcs.gate import inputs as gate_inputs
from gcs.gate.effects import Level, Ruling
from gcs.gate.refusal import Refusal
from gcs.gate.requests import Request
from gcs.protocol.effects import Send
from gcs.session.effects import Effect
from gcs.wire.frame import Frame


@dataclass(frozen=True, slots=True)
class ToGate:
    """An input for the vehicle's gate."""

    given: gate_inputs.Input


@dataclass(frozen=True, slots=True)
class GateAnswered:
    """All effects of one gate input are carried out; the gate can take the next one."""


@dataclass(frozen=True, slots=True)
class AskGate:
    """The request that was opened as `request_id`, for the vehicle's gate."""

    request_id: int
    request: Request


@dataclass(frozen=True, slots=True)
class Decide:
    """The verdict on a request that the gate does not decide (mission transfers) or has decided."""

    request_id: int
    ruling: Ruling
    refusal: Refusal | None = None
    evidence: tuple[tuple[str, float], ...] = ()
    goal_ned: Vec3 | None = None


@dataclass(frozen=True, slots=True)
class FrameReceived:
    """A good frame came in on link number `link`."""

    link: int
    frame: Frame


@dataclass(frozen=True, slots=True)
class Log:
    """A line of the node `node`, for the screen and the record."""

    level: Level
    node: str
    text: str


@dataclass(frozen=True, slots=True)
class PlaceFence:
    """Home or origin became known or moved: the fence is to be placed anew."""


@dataclass(frozen=True, slots=True)
class SecondDue:
    """What the session does once a second is due."""


@dataclass(frozen=True, slots=True)
class SnapshotDue:
    """The operator is to be shown how everything stands."""


@dataclass(frozen=True, slots=True)
class CheckStart:
    """A position was handled: is the vehicle inside the fence where it starts?"""

    pos_ned: Vec3


Work: TypeAlias = (
    Effect
    | gate_effects.Effect
    | ToGate
    | GateAnswered
    | AskGate
    | Decide
    | FrameReceived
    | Log
    | SecondDue
    | SnapshotDue
    | PlaceFence
    | CheckStart
    | Send
)
"""`Send` is a message that moves nothing, for the vehicle; motion leaves as the gate's
`SendSetpoint` and `SendCommand`, with a permit."""
