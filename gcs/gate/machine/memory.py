"""What the gate knows and what it has accepted to do.

What is known was reported, and is kept with the time at which it arrived; None means "not known"
and is never replaced by zero.  At most one accepted request is under way (`task`), and at most
one go-to waits for its tick (`pending`); so two fields are enough to give every request exactly
one verdict and every accepted one exactly one outcome.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from gcs.frames import Vec3
from gcs.gate.airspace.attitude_samples import BeforeThis
from gcs.gate.airspace.mission_box import MissionBox
from gcs.gate.airspace.pace import Paced
from gcs.gate.airspace.return_place import HOME, ReturnPlace
from gcs.gate.airspace.stopping import OnWayBack, OwnPath, Path, Setpoints
from gcs.gate.airspace.stream_samples import StreamSample
from gcs.gate.airspace.verifier import Verifier
from gcs.gate.condition import Condition
from gcs.gate.effects import CommandKind
from gcs.gate.inputs import Requested
from gcs.gate.machine.events import Event
from gcs.gate.refusal import Code
from gcs.gate.states import Control, FlightMode, LandedState, State

SECOND_NS = 1_000_000_000

CLIMBED_M = 0.5
"""A vehicle that is higher than this above the ground it stood on does not stand there, even if
it reports so."""

HOME_MOVED_M = 1.0
"""Home that moves further than this is another place; arming moves it by centimetres."""

OWN_PATHS = frozenset({State.TAKING_OFF, State.FLYING_MISSION, State.RETURNING})
"""States in which the vehicle flies a path of its own."""

GATE = 0
"""The request id of commands that the gate sends without a request: its own holds, landings and
returns."""


@dataclass(frozen=True, slots=True)
class Goal:
    """A verified position with the numbers it was cleared on.  Only these, and positions on the way
    there, are sent as setpoints."""

    pos_ned: Vec3
    yaw_rad: float | None
    evidence: tuple[tuple[str, float], ...]
    way_back: bool = False  # the vehicle that is sent there began outside
    speed_m_s: float = math.inf  # the most along the way there


@dataclass(frozen=True, slots=True)
class Task:
    """The accepted request that has no outcome yet.

    `deadline_ns` None: it may take as long as it takes.  `waiting` is a command that is sent as
    soon as the vehicle shows the mode that it needs for it; in STALE, as soon as it has a position.
    """

    requested: Requested
    kind: Event
    deadline_ns: int | None = None
    waiting: CommandKind | None = None


@dataclass(frozen=True, slots=True)
class FlownSample:
    """The sample of a client's stream that is flown, with the numbers it was cleared on."""

    sample: StreamSample
    evidence: tuple[tuple[str, float], ...]


@dataclass
class Memory:
    """Mutable, and owned by one gate.  The values of all fields are immutable, so a shallow copy
    is enough."""

    autopilot: str
    state: State = State.NO_VEHICLE
    control: Control = Control.NONE

    # as reported
    heard_ns: int | None = None
    heard_before: bool = False
    lost_in_flight: bool = False  # we flew it when it was heard last; a return or landing goes on
    armed: bool = False
    mode: FlightMode | None = None
    mode_name: str = ""
    guided_used: bool = False  # it was armed, or first heard, in the guided mode that it is in
    failsafe: bool = False  # one of the vehicle's own is active
    landed: LandedState = LandedState.UNDEFINED
    landed_ns: int | None = None
    ground_down_m: float | None = None  # local down of the ground that it stood on last
    pos_ned: Vec3 | None = None
    v_ned: Vec3 | None = None
    pos_ns: int | None = None
    yaw_rad: float | None = None  # where the nose points; None: not told of late
    late_s: float = 0.0  # how old it was when it came
    boot_ms: int = 0  # the vehicle's own time stamp of the last position
    home_ned: Vec3 | None = None
    arrival_h_m: float | None = None  # how near beside a goal is there; None: the policy's radius
    return_up_m: float | None = None  # the vehicle's return height, above home
    return_places: tuple[ReturnPlace, ...] | None = None  # where it may end but at home
    return_unknown: str = ""  # why these are not known
    climb_ends_within_m: float = 0.0  # how near its height the vehicle itself ends a climb
    verifier: Verifier | None = None
    conditions: tuple[tuple[Condition, str], ...] = ()
    mission_items: int = 0
    mission_within: MissionBox | None = None  # where it is flown, as verified before its start
    mission_over: bool = False  # the mission on board is at its last item, or past it
    photo_ok: bool = False
    photo_index: int | None = None  # of the last picture that was reported
    silence_reported: CommandKind | None = None  # the operator knows that this had no answer
    operator_lost: bool = False  # and does not come back

    # accepted
    task: Task | None = None
    pending: Requested | None = None  # a go-to that waits for the next tick
    hold: Goal | None = None  # where the vehicle hovers
    goal: Goal | None = None  # where the vehicle flies to
    within_since_ns: int | None = None  # at `goal` since then, in place and heading
    paced: Paced | None = None  # what was sent last on the way to a position
    paced_ns: int = 0  # when that was

    # a client's setpoint stream
    streamer: str = ""  # whose it is; it means nothing but in STREAMING
    flown: FlownSample | None = None  # None: the vehicle is held at `hold` in its place
    sample_ns: int = 0  # when the sample that is flown came
    streamed_ns: int = 0  # when the last sample came, good or not
    leant: tuple[tuple[int, BeforeThis], ...] = ()  # when attitudes came that were flown, and which
    stream_refused: bool = False  # and the client was told
    good_since_ns: int | None = None  # refused before, its samples would be good since then
    refused_elsewhere: tuple[tuple[str, Code], ...] = ()
    """By source, told once: see `StepContext.refuse`."""
    refused_elsewhere_ns: int = 0  # when the last sample was refused where no stream is flown

    # commanded
    outstanding: tuple[tuple[int, CommandKind], ...] = ()  # (request id, kind), not answered yet
    asked_mode: FlightMode | None = None  # commanded, and not shown by the heartbeat yet
    asked_until_ns: int = 0  # when that mode is overdue
    guided_until_ns: int = 0  # until then our own GUIDED command may still take effect
    takeoff_until_ns: int = 0  # until then our own take-off command may still take effect
    ask_control_ns: int | None = None  # when GUIDED is to be commanded
    hold_again_ns: int | None = None  # when HOLD, not shown yet, is to be commanded again
    hold_requested: bool = False  # that HOLD was asked for, and is not the gate's own
    top_ned: Vec3 = (0.0, 0.0, 0.0)  # where the take-off that was verified ends
    lifted: bool = False  # it was reported in the air since the take-off or mission began
    force_asked_ns: int | None = None  # when a forced disarm was asked for the first time

    # in STALE
    back_to: State | None = None  # the state that a position too old interrupted
    grace_until_ns: int | None = None  # until then the verified setpoints go on

    def copy(self) -> Memory:
        """An independent copy; far cheaper than `dataclasses.replace`."""
        copied = object.__new__(Memory)
        copied.__dict__.update(self.__dict__)
        return copied

    @property
    def airborne(self) -> bool:
        """Reported in the air.  Where nothing is known, neither this nor `on_ground` is sure."""
        return self.landed in (LandedState.IN_AIR, LandedState.TAKEOFF, LandedState.LANDING)

    @property
    def climbed(self) -> bool:
        """Its position is higher than the ground that it stood on."""
        if self.pos_ned is None or self.ground_down_m is None:
            return False
        return self.ground_down_m - self.pos_ned[2] > CLIMBED_M

    @property
    def on_ground(self) -> bool:
        """Reported to stand, and its position is no higher; or disarmed, and not reported in the
        air.  An armed vehicle of which nothing is reported is not taken to stand."""
        if self.landed is LandedState.ON_GROUND and not self.climbed:
            return True
        return not (self.armed or self.airborne)

    @property
    def flown_state(self) -> State:
        """The state; in STALE the state that a position too old interrupted, if there is one."""
        return self.back_to or self.state

    @property
    def path(self) -> Path:
        """What the vehicle flies, or has flown and settles at; None where it is sent to no place.

        A client's velocities lead to no place.  A vehicle that is held obeys its hold mode.
        """
        if self.flown_state is State.FLYING_MISSION:
            return OwnPath(self.mission_within)
        if self.flown_state in OWN_PATHS:
            return OwnPath()
        if self.comes_back and self.hold is not None:
            return OnWayBack(self.hold.pos_ned)
        if self.flown_state is State.STREAMING and self.flown is not None:
            sample = self.flown.sample
            return Setpoints() if sample.pos_ned is not None and sample.v_ned is None else None
        follows = self.control is Control.OURS and self.flown_state is not State.HOLDING
        return Setpoints() if follows and (self.goal or self.hold) is not None else None

    def turn_left_deg(self, within_deg: float | None) -> float:
        """How far the nose points from the heading of the goal that is flown; 0 where it is within
        so many degrees of it.  Where the goal names no heading, the vehicle tells none, or none is
        waited for (None), no turn is left."""
        goal = self.goal
        if within_deg is None or goal is None or goal.yaw_rad is None or self.yaw_rad is None:
            return 0.0
        left_deg = math.degrees(abs(math.remainder(goal.yaw_rad - self.yaw_rad, math.tau)))
        return left_deg if left_deg > within_deg else 0.0

    @property
    def comes_back(self) -> bool:
        """It is outside, and is flown to a place inside."""
        return self.flown_state is State.HOVERING and self.hold is not None and self.hold.way_back

    @property
    def counted_conditions(self) -> tuple[Condition, ...]:
        """The conditions that count: that it is outside forbids no way back inside."""
        names = tuple(name for name, _ in self.conditions)
        if not self.comes_back:
            return names
        return tuple(name for name in names if name is not Condition.FENCE_BREACHED)

    @property
    def returns_to(self) -> tuple[ReturnPlace, ...]:
        """Every place where a return may end, home first; empty where not all of them are known."""
        if self.home_ned is None or self.return_places is None:
            return ()
        return (ReturnPlace(HOME, self.home_ned), *self.return_places)

    def position_age_ns(self, now_ns: int) -> int | None:
        """How long ago the last position arrived; None before the first one."""
        return None if self.pos_ns is None else now_ns - self.pos_ns
