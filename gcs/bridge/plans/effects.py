"""What a plan server answers: a closed union of frozen values, for the bridge to put into practice.

`Reply` (of `gcs/bridge/effects.py`) is a message for the client; the others are here.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from gcs.bridge.client_plan import ClientPlan
from gcs.bridge.effects import Reply
from gcs.gate.refusal import Refusal
from gcs.wire.ids import MissionType


@dataclass(frozen=True, slots=True)
class Upload:
    """The client asks for this plan on board.

    Its verdict and ending are told to `PlanServer.decided` and `PlanServer.ended`.
    """

    plan: ClientPlan


@dataclass(frozen=True, slots=True)
class Clear:
    """The client asks for the plan of this kind (or ALL) to be taken off; answered as `Upload`."""

    kind: MissionType


@dataclass(frozen=True, slots=True)
class Withdraw:
    """What the client asked for last is not wanted any more: its transfer is to be stopped."""

    reason: str


@dataclass(frozen=True, slots=True)
class SetCurrent:
    """The client asks for the mission to go on at item `seq` (MISSION_SET_CURRENT): motion."""

    seq: int


@dataclass(frozen=True, slots=True)
class Pass:
    """The message changes nothing on board: it goes to the vehicle as it is."""


@dataclass(frozen=True, slots=True)
class Refused:
    """The message goes nowhere and is recorded as refused; its answer stands beside it.

    `name` is the message's.
    """

    name: str
    refusal: Refusal
    earlier: bool = False
    """It is not the message that was given: that one put an end to this one."""


PlanEffect: TypeAlias = Reply | Upload | Clear | Withdraw | SetCurrent | Pass | Refused
