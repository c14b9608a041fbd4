"""What can be asked of the gate, as a closed union.

Positions are metres in the vehicle's local NED frame (MAV_FRAME_LOCAL_NED).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from gcs.frames import Vec3
from gcs.gate.states import FlightMode


@dataclass(frozen=True, slots=True)
class GoTo:
    """Fly straight to `goal_ned` and hover; `yaw_rad` None leaves heading to the autopilot."""

    goal_ned: Vec3
    yaw_rad: float | None = None


@dataclass(frozen=True, slots=True)
class TakeControl:
    """Verify the present position as the hold goal, stream it, ask for OFFBOARD / GUIDED."""


@dataclass(frozen=True, slots=True)
class Arm:
    pass


@dataclass(frozen=True, slots=True)
class Disarm:
    force: bool = False


@dataclass(frozen=True, slots=True)
class TakeOff:
    """Climb to `up_m` metres above the take-off point, then take control and hover."""

    up_m: float


@dataclass(frozen=True, slots=True)
class Land:
    pass


@dataclass(frozen=True, slots=True)
class ReturnHome:
    pass


@dataclass(frozen=True, slots=True)
class Hold:
    pass


@dataclass(frozen=True, slots=True)
class Abort:
    """Hold now, forget the goal; on the ground: disarm if armed."""


@dataclass(frozen=True, slots=True)
class Resume:
    """Leave HOLDING (or EXTERNAL) for HOVERING at the present position."""


@dataclass(frozen=True, slots=True)
class TakePhoto:
    pass


@dataclass(frozen=True, slots=True)
class StartMission:
    pass


@dataclass(frozen=True, slots=True)
class SetMode:
    """A mode by the autopilot's own name; motion modes map to the request they mean."""

    name: str
    meaning: FlightMode


@dataclass(frozen=True, slots=True)
class SwitchFence:
    """The lab's cage switch; refused under any policy that does not allow it."""

    on: bool


Request: TypeAlias = (
    GoTo
    | TakeControl
    | Arm
    | Disarm
    | TakeOff
    | Land
    | ReturnHome
    | Hold
    | Abort
    | Resume
    | TakePhoto
    | StartMission
    | SetMode
    | SwitchFence
)
