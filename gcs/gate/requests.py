"""The requests that a client can make, as a closed union of frozen dataclasses.

Positions are metres in the vehicle's local NED frame (MAV_FRAME_LOCAL_NED).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from gcs.frames import Vec3
from gcs.gate.states import FlightMode


@dataclass(frozen=True, slots=True)
class GoTo:
    """Fly straight to `goal_ned` and hover; `yaw_rad` None leaves the heading to the autopilot.
    `speed_m_s` is the most along the way; None: what the policy's `[pace]` lets it."""

    goal_ned: Vec3
    yaw_rad: float | None = None
    speed_m_s: float | None = None


@dataclass(frozen=True, slots=True)
class TakeControl:
    """Take control of a vehicle that flies: verify the present position as hold goal, send it as
    setpoint, and command guided mode (px4 OFFBOARD, ardupilot GUIDED)."""


@dataclass(frozen=True, slots=True)
class Arm:
    """Arm the vehicle on the ground."""


@dataclass(frozen=True, slots=True)
class Disarm:
    """Disarm the vehicle on the ground; with `force` in the air too, where the policy allows it
    and it is requested twice."""

    force: bool = False


@dataclass(frozen=True, slots=True)
class TakeOff:
    """Climb to `up_m` metres above the take-off point, then take control and hover."""

    up_m: float


@dataclass(frozen=True, slots=True)
class Land:
    """Land where the vehicle is."""


@dataclass(frozen=True, slots=True)
class ReturnHome:
    """Return home in the vehicle's own return mode, if the way is clear."""


@dataclass(frozen=True, slots=True)
class Hold:
    """Stop in the vehicle's own hold mode and stay there; the goal is forgotten."""


@dataclass(frozen=True, slots=True)
class Abort:
    """As `Hold`; a vehicle that stands on the ground is disarmed, if it is armed."""


@dataclass(frozen=True, slots=True)
class Resume:
    """Take control again after a hold: from HOLDING (or EXTERNAL) to HOVERING, at the present
    position."""


@dataclass(frozen=True, slots=True)
class TakePhoto:
    """Take a picture while hovering."""


@dataclass(frozen=True, slots=True)
class StartMission:
    """Start the verified mission that is on board, at its item number `seq` (MAVLink's count), from
    which it was verified; None: at its first one."""

    seq: int | None = None


@dataclass(frozen=True, slots=True)
class BeginStream:
    """Fly the setpoint stream of this client from now on: hold until its first sample clears."""


@dataclass(frozen=True, slots=True)
class EndStream:
    """End the setpoint stream that is flown, and hover where the vehicle is."""


@dataclass(frozen=True, slots=True)
class SetMode:
    """Set a mode by the autopilot's own name.  It is treated as the request that means the same;
    `meaning` OTHER is refused.

    `instead` is the mode that this station sends where `name` is another one of the same kind;
    `meaning` is OTHER then.
    """

    name: str
    meaning: FlightMode
    instead: str = ""


@dataclass(frozen=True, slots=True)
class SwitchFence:
    """Switch the fence on or off, where the policy allows it (the lab's does)."""

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
    | BeginStream
    | EndStream
    | SetMode
    | SwitchFence
)
