"""What a client's message can mean, and what must be known of the vehicle to tell it.

Positions are metres in the vehicle's local NED frame (MAV_FRAME_LOCAL_NED), angles are radians
clockwise from north, speeds are metres per second.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from gcs import ipc
from gcs.frames import Vec3
from gcs.gate.airspace.projection import Origin
from gcs.gate.attitude import Attitude
from gcs.gate.policy.policy import StreamRules
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import State
from gcs.protocol.autopilot import Autopilot
from gcs.wire.messages import RallyPoint


def _clears_nothing(up_m: float) -> bool:
    return False


def _resumes() -> Refusal | None:
    return None


def _goes(goal_ned: Vec3, yaw_rad: float | None) -> Refusal | None:
    return None


def _rally_points_unknown(point: RallyPoint) -> Refusal | None:
    return Refusal(Code.NO_ORIGIN, "where the rally point lies is not known")


def _hears_nobody(_compid: int) -> bool:
    return False


@dataclass(frozen=True, slots=True)
class Seen:
    """The vehicle as it was last reported, and what the gate does with it.

    `state` and the fields after it have defaults with which less is allowed, not more; but for
    the last two, which the gate decides anyway.
    """

    autopilot: Autopilot
    origin: Origin | None
    home_ned: Vec3 | None
    home_amsl_m: float | None
    pos_ned: Vec3 | None
    v_ned: Vec3
    yaw_rad: float | None
    on_ground: bool
    armed: bool
    mode_name: str
    goal_ned: Vec3 | None
    """What the gate flies to or holds now; None where it sends no position."""
    takeoff_up_m: float
    """The vehicle's own default height of a take-off, above the take-off point."""
    state: State = State.NO_VEHICLE
    """Of the gate's machine."""
    in_control: bool = False
    """The client who asks is in control of the station, or nobody is."""
    manual_modes: tuple[str, ...] = ()
    """Modes flown with sticks that the policy lets a client ask for."""
    goal_yaw_rad: float | None = None
    """The heading that was asked for with `goal_ned`."""
    mission_paused: bool = False
    """A mission of this vehicle was stopped by a hold, and nothing else was flown since."""
    max_speed_m_s: float = 0.0
    """A client may set speeds up to this: the vehicle's own, which missions are verified with.
    0: none, as it is not known."""
    max_takeoff_up_m: float = 0.0
    """A client may set the default height of a take-off up to this; 0: not at all."""
    mission_items: int = 0
    """Items of the mission on board, as they were read back last; 0: not known."""
    land_starts: tuple[int, ...] = ()
    """MAVLink's numbers of the DO_LAND_START items of that mission."""
    awaited: bool = False
    """The gate waits for something that it has asked of the vehicle."""
    plan_transfer: bool = False
    """The station reads or writes a plan of the vehicle."""
    not_on_board: tuple[int, ...] = ()
    """Mission types, of fences and rally points, of which it is known that there is none."""
    stream: StreamRules | None = None
    """What full stick asks for; None: sticks are refused."""
    has_sticks: bool = False
    """The client who asks has sent sticks lately."""
    clears_takeoff: Callable[[float], bool] = _clears_nothing
    """Whether a climb from here, by so many metres, would be cleared if the vehicle were armed."""
    why_not_rally: Callable[[RallyPoint], Refusal | None] = _rally_points_unknown
    """Why the vehicle must not have a rally point there: its own failsafe would land there."""
    why_not_resume: Callable[[], Refusal | None] = _resumes
    """Why the gate would not hover under control here, once the vehicle is held; None: it would.
    The gate asks it again: this is so that what will be refused stops nothing first."""
    why_not_go_to: Callable[[Vec3, float | None], Refusal | None] = _goes
    """Why the gate would not fly it to this place, with this heading, once its hold is lifted;
    None: it would, or nobody knows.  So what will be refused lifts no hold first."""
    hears: Callable[[int], bool] = _hears_nobody
    """Whether a component of the vehicle's system, by its id, was ever heard on a vehicle link."""


@dataclass(frozen=True, slots=True)
class Sample:
    """One sample of a setpoint stream: what is to be flown now.  None = not given.

    An axis of a triple that the client left out is NaN.
    """

    pos_ned: Vec3 | None = None
    v_ned: Vec3 | None = None
    a_ned: Vec3 | None = None
    yaw_rad: float | None = None
    yaw_rate_rad_s: float | None = None
    attitude: Attitude | None = None


@dataclass(frozen=True, slots=True)
class Sticks:
    """A pilot's sticks; whether they fly the vehicle now, `stick_stream.StickStream` knows."""

    sample: Sample
    """The velocity and the yaw rate that they ask for."""
    centred: bool
    """All of them are in the middle: the sample asks for standstill."""
    resting: bool
    """They are so but for the throttle, which may be below the middle, as it is before a take-off
    where it has no spring."""
    note: str = ""
    """What of the message is ignored."""


@dataclass(frozen=True, slots=True)
class Words:
    """Requests, the second when the first is complete; their ids are filled in by the bridge.

    No request: what is asked for is so already, and is answered as done.
    """

    asks: tuple[ipc.Ask, ...]
    note: str = ""
    """What will not be flown as the message says, for the client to read; empty: nothing."""
    if_repeated: Sample | None = None
    """The same message as a sample, where its sender turns out to be streaming: `pace.Pace`."""
    answered_by: str = ""
    """The word whose completion answers the message; empty: the last one's."""


@dataclass(frozen=True, slots=True)
class Forward:
    """Moves the vehicle nowhere, as it is now: goes to it unchanged."""


@dataclass(frozen=True, slots=True)
class Reject:
    """Cannot be put in words that the gate can judge; the client is told, and it is recorded."""

    refusal: Refusal


Settled: TypeAlias = Words | Sample | Forward | Reject
Meaning: TypeAlias = Settled | Sticks
