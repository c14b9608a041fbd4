"""What the parts of the session return: effects for the shell, and work for other parts.

No part calls another one sideways.  A part returns a list of `Work`; the session's queue
(`queue.py`) hands each item to the part that it is for, until only effects are left.
"""

from __future__ import annotations

from typing import Final, TypeAlias

import msgspec

from gcs import ipc
from gcs.bridge.client_plan import ClientPlan
from gcs.bridge.effects import BridgeEffect
from gcs.frames import Vec3
from gcs.gate import effects as gate_effects
from gcs.gate import inputs as gate_inputs
from gcs.gate.condition import Condition
from gcs.gate.effects import Level, Ruling
from gcs.gate.refusal import Refusal
from gcs.gate.requests import Request
from gcs.protocol.effects import Send
from gcs.session.effects import Effect
from gcs.wire.ids import MissionType

STATION: Final = -1
"""The owner of work that is no vehicle's; vehicles have their slots, from 0 up."""


class ForOwner(msgspec.Struct, frozen=True):
    """Work for another owner, and whatever it leads to."""

    owner: int
    work: tuple[Work, ...]


class GateInput(msgspec.Struct, frozen=True, gc=False):
    """An input for the owner's gate; of the station: for every vehicle's gate."""

    given: gate_inputs.Input


def condition(name: Condition, active: bool, text: str) -> GateInput:
    """Something that is watched is wrong, or no longer."""
    return GateInput(gate_inputs.ConditionChanged(name, active, text))


class GateAnswered(msgspec.Struct, frozen=True, gc=False):
    """All effects of one gate input are carried out; the gate can take the next one."""


GATE_ANSWERED: Final = GateAnswered()


class AskGate(msgspec.Struct, frozen=True, gc=False):
    """The request that was opened as `request_id`, for the vehicle's gate."""

    request_id: int
    request: Request


class GiveVerdict(msgspec.Struct, frozen=True, gc=False):
    """The verdict on a request that the gate does not decide (mission transfers) or has decided."""

    request_id: int
    ruling: Ruling
    refusal: Refusal | None = None
    evidence: tuple[tuple[str, float], ...] = ()
    goal_ned: Vec3 | None = None


class Log(msgspec.Struct, frozen=True, gc=False):
    """A line of the node `node`, for the screen and the record; one that is not `recorded` says
    what can be done, not what was."""

    level: Level
    node: str
    text: str
    recorded: bool = True


class ToScreens(msgspec.Struct, frozen=True, gc=False):
    """Tell the operators who are shown this vehicle."""

    event: ipc.Event


class TellOperator(msgspec.Struct, frozen=True, gc=False):
    """An event for the operator who made the request `request_id`, which is not over yet."""

    request_id: int
    event: ipc.Event


class AskMission(msgspec.Struct, frozen=True, gc=False):
    """The request that was opened as `request_id`, about missions: for the vehicle's jobs.

    `plan` is what a MAVLink client sent, in place of a file; `kind` is which plan it is about.
    """

    request_id: int
    ask: ipc.Ask
    plan: ClientPlan | None = None
    kind: MissionType = MissionType.MISSION


class AskReader(msgspec.Struct, frozen=True, gc=False):
    """The request that was opened as `request_id`, about parameters, files or logs of the vehicle:
    for its jobs."""

    request_id: int
    ask: ipc.Ask


class AskOrbit(msgspec.Struct, frozen=True, gc=False):
    """The request of an operator that was opened as `request_id`, for an orbit."""

    request_id: int
    ask: ipc.Ask
    operator: int


class AskSpeed(msgspec.Struct, frozen=True, gc=False):
    """The request that was opened as `request_id`, for the speed of the next legs."""

    request_id: int
    speed_m_s: float


class OrbitSample(msgspec.Struct, frozen=True, gc=False):
    """The next sample of the orbit that an operator has asked for; None: it is over."""

    operator: int
    sample: ipc.Stream | None


class StopTransfer(msgspec.Struct, frozen=True, gc=False):
    """The mission transfer that was opened as `request_id` is to end, if it is under way."""

    request_id: int


class StreamOver(msgspec.Struct, frozen=True, gc=False):
    """Its operator is not in control any more: the stream at the vehicle with that system id (0:
    the first) is ended by the request that was opened as `request_id`."""

    vehicle: int
    request_id: int


class EndSession(msgspec.Struct, frozen=True, gc=False):
    """The station is to be left: the vehicle is seen safe first."""

    reason: str


class PlaceFence(msgspec.Struct, frozen=True, gc=False):
    """Home or origin became known or moved: the fence is to be placed anew."""


class SecondDue(msgspec.Struct, frozen=True, gc=False):
    """What the session does once a second is due."""


class SnapshotDue(msgspec.Struct, frozen=True, gc=False):
    """The operator is to be shown how everything stands."""


class CheckStart(msgspec.Struct, frozen=True, gc=False):
    """A position was handled: is the vehicle inside the fence where it starts?"""

    pos_ned: Vec3


Work: TypeAlias = (
    Effect
    | gate_effects.Effect
    | ForOwner
    | GateInput
    | GateAnswered
    | AskGate
    | GiveVerdict
    | Log
    | ToScreens
    | TellOperator
    | AskMission
    | AskReader
    | AskOrbit
    | AskSpeed
    | OrbitSample
    | StopTransfer
    | StreamOver
    | EndSession
    | SecondDue
    | SnapshotDue
    | PlaceFence
    | CheckStart
    | Send
    | BridgeEffect
)
"""`Send` is a message that moves nothing, for the vehicle; motion leaves as the gate's
`SendSetpoint` and `SendCommand`, with a permit."""
