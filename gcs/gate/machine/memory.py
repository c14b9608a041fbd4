"""What the gate knows and intends: one owner, values that do not change under a reader.

Facts are what was reported, with the time it arrived; None is not known, never zero.
Intentions are what was accepted and not yet ended.  There is at most one request under way
(`task`) and at most one go-to waiting for its tick (`pending`), so "exactly one verdict, exactly
one outcome" is a matter of two fields.
"""

from __future__ import annotations

from dataclasses import dataclass

from gcs.frames import Vec3
from gcs.gate.airspace.verifier import Verifier
from gcs.gate.condition import Condition
from gcs.gate.effects import CommandKind
from gcs.gate.inputs import Requested
from gcs.gate.machine.events import Event
from gcs.gate.states import Control, FlightMode, LandedState, State

SECOND_NS = 1_000_000_000

CLIMBED_M = 0.5
"""Higher than this above where it stood, a vehicle is not on the ground, whatever it reports."""

GATE = 0
"""The request id of what nobody asked for: the gate's own holds, landings and returns."""


@dataclass(frozen=True, slots=True)
class Goal:
    """A verified position, and the numbers it was cleared on; nothing else is ever streamed."""

    pos_ned: Vec3
    yaw_rad: float | None
    evidence: tuple[tuple[str, float], ...]


@dataclass(frozen=True, slots=True)
class Task:
    """The accepted request that has no outcome yet.

    `waiting` is a command that goes out once the vehicle shows the mode it needs first.
    """

    requested: Requested
    kind: Event
    deadline_ns: int | None = None
    waiting: CommandKind | None = None


@dataclass
class Memory:
    """Mutable, and owned by one gate.  Every field's value is immutable: a copy is shallow."""

    autopilot: str
    state: State = State.NO_VEHICLE
    control: Control = Control.NONE

    # as reported
    heard_ns: int | None = None
    heard_before: bool = False
    armed: bool = False
    mode: FlightMode | None = None
    mode_name: str = ""
    landed: LandedState = LandedState.UNDEFINED
    landed_ns: int | None = None
    stood_down_m: float | None = None  # local down of where it stood last
    pos_ned: Vec3 | None = None
    v_ned: Vec3 | None = None
    pos_ns: int | None = None
    boot_ms: int = 0
    home_ned: Vec3 | None = None
    return_up_m: float | None = None
    verifier: Verifier | None = None
    conditions: tuple[tuple[Condition, str], ...] = ()
    mission_name: str = ""
    mission_items: int = 0
    mission_over: bool = False
    photo_ok: bool = False
    photo_index: int | None = None  # of the last picture that was told
    silence_told: CommandKind | None = None
    deserted: bool = False  # the operator is lost, and does not come back

    # intended
    task: Task | None = None
    pending: Requested | None = None
    hold: Goal | None = None
    goal: Goal | None = None
    within_since_ns: int | None = None

    # commanded
    outstanding: tuple[tuple[int, CommandKind], ...] = ()
    asked_mode: FlightMode | None = None
    asked_until_ns: int = 0
    guided_until_ns: int = 0  # our own GUIDED may still take effect
    takeoff_until_ns: int = 0  # our own take-off may still take effect
    ask_control_ns: int | None = None
    hold_again_ns: int | None = None  # HOLD is commanded, and not shown yet
    top_down_m: float = 0.0  # local down of the height a take-off ends at
    lifted: bool = False

    # interrupted by a position too old
    back_to: State | None = None
    grace_until_ns: int | None = None

    force_asked_ns: int | None = None

    def copy(self) -> Memory:
        """Another memory of the same; far cheaper than `dataclasses.replace`."""
        twin = object.__new__(Memory)
        twin.__dict__.update(self.__dict__)
        return twin

    @property
    def airborne(self) -> bool:
        """Reported in the air; not known is not in the air, and not on the ground either."""
        return self.landed in (LandedState.IN_AIR, LandedState.TAKEOFF, LandedState.LANDING)

    @property
    def climbed(self) -> bool:
        """Its position is above where it stood."""
        if self.pos_ned is None or self.stood_down_m is None:
            return False
        return self.stood_down_m - self.pos_ned[2] > CLIMBED_M

    @property
    def on_ground(self) -> bool:
        """Reported so and seen no higher, or disarmed and not reported in the air; armed and not
        known is not."""
        if self.landed is LandedState.ON_GROUND and not self.climbed:
            return True
        return not (self.armed or self.airborne)

    @property
    def flies(self) -> State:
        """The state, or the one that a position too old interrupted."""
        return self.back_to or self.state

    def position_age_ns(self, now_ns: int) -> int | None:
        """None before the first position."""
        return None if self.pos_ns is None else now_ns - self.pos_ns
