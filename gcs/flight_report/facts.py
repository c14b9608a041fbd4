"""What a record tells of one vehicle, whatever message it came in: a closed union of values.

The scan makes facts of messages; the series of the plots and the findings are made of facts.
`None` is not known.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from gcs.frames import Vec3
from gcs.report import ConditionItem


@dataclass(frozen=True, slots=True)
class Identity:
    """Which autopilot it is (`px4`, `ardupilot`, or another), and what kind of vehicle."""

    autopilot: str
    kind: str


@dataclass(frozen=True, slots=True)
class Pose:
    """Where it is and how it moves; angles in degrees, `yaw_deg` 0..360 clockwise from north."""

    pos_enu: Vec3
    groundspeed_mps: float
    climb_mps: float
    roll_deg: float
    pitch_deg: float
    yaw_deg: float
    alt_rel_m: float | None = None
    """Above home, where the vehicle told it."""


@dataclass(frozen=True, slots=True)
class Status:
    """What it is doing; `landed` is a name of MAV_LANDED_STATE without its prefix."""

    armed: bool
    mode: str
    landed: str
    rx_hz: float | None
    """Messages that are received of it, a second."""
    lost_pct: float | None


@dataclass(frozen=True, slots=True)
class Battery:
    voltage_v: float | None
    current_a: float | None
    remaining_pct: float | None


@dataclass(frozen=True, slots=True)
class Cells:
    """How many cells the battery reports one by one."""

    count: int


@dataclass(frozen=True, slots=True)
class Vibration:
    """VIBRATION as it is sent: its three numbers mean other things for PX4 than for ArduPilot."""

    x: float
    y: float
    z: float
    clipped: int
    """How often an accelerometer was at its limit, since the start, all accelerometers."""


@dataclass(frozen=True, slots=True)
class Gps:
    fix_type: int
    satellites: int | None
    hdop: float | None
    accuracy_m: float | None
    """Horizontal."""


@dataclass(frozen=True, slots=True)
class Estimator:
    """Each is an innovation over what it may be: at 1 the measurement is rejected.

    `autopilot` is whose message it came in: PX4 sends ESTIMATOR_STATUS, ArduPilot
    EKF_STATUS_REPORT; a simulator may send both.
    """

    autopilot: str
    velocity: float | None
    position: float | None
    height: float | None
    compass: float | None


@dataclass(frozen=True, slots=True)
class Text:
    """STATUSTEXT, whole; `severity` as MAV_SEVERITY, 0 is the worst."""

    severity: int
    text: str


@dataclass(frozen=True, slots=True)
class Machine:
    """The gate's state machine after a transition."""

    state: str
    event: str
    control: str
    severity: str
    goal_enu: Vec3 | None
    conditions: tuple[ConditionItem, ...] | None = None
    """What makes up the severity; None: an older record, which has it in its log alone."""


@dataclass(frozen=True, slots=True)
class Decision:
    """A verdict on a request or the ending of an accepted one, as `gcs.report.DecisionItem`."""

    vehicle: int
    request_id: int
    source: str
    word: str
    phase: str
    outcome: str
    code: str
    sentence: str
    goal_enu: Vec3 | None
    numbers: dict[str, float | None]


@dataclass(frozen=True, slots=True)
class LogLine:
    """A line of the station's log; `level` 1 debug to 5 fatal."""

    level: int
    node: str
    text: str


@dataclass(frozen=True, slots=True)
class Sample:
    """Values of neighbouring columns of a plot of `gcs/flight_report/sampled.py`, from `first` on.

    `leads`: a row is drawn now, with what the other columns had last.
    """

    plot: str
    values: tuple[float | None, ...]
    first: int = 0
    leads: bool = True


@dataclass(frozen=True, slots=True)
class Acceleration:
    """Of the first accelerometer, m/s², in the body's axes."""

    xyz: Vec3


@dataclass(frozen=True, slots=True)
class Rotation:
    """Of the first gyroscope, rad/s, in the body's axes."""

    xyz: Vec3


@dataclass(frozen=True, slots=True)
class Field:
    """How strong the field is that the first compass measures."""

    gauss: float


@dataclass(frozen=True, slots=True)
class Failed:
    """Which of the sensors that are in use are not healthy, by what the autopilot says."""

    sensors: frozenset[str]
    in_use: frozenset[str]


@dataclass(frozen=True, slots=True)
class Clock:
    """The vehicle's own, seconds since it started."""

    boot_s: float


@dataclass(frozen=True, slots=True)
class Build:
    """Empty where it is not told."""

    firmware: str = ""
    hardware: str = ""


@dataclass(frozen=True, slots=True)
class Parameter:
    """`value` None: only its default is told."""

    name: str
    value: float | None
    default: float | None = None


@dataclass(frozen=True, slots=True)
class Fix:
    """Degrees, and metres above mean sea level and above home."""

    lat_deg: float
    lon_deg: float
    alt_amsl_m: float
    alt_rel_m: float


@dataclass(frozen=True, slots=True)
class PlanItem:
    """A place of the mission that was sent to a vehicle, or read from it.

    `vehicle` 0: that whose channel it is.  `above_home`: its height counts from there, else from
    mean sea level.
    """

    vehicle: int
    seq: int
    lat_deg: float
    lon_deg: float
    alt_m: float
    above_home: bool


Fact: TypeAlias = (
    Identity
    | Pose
    | Status
    | Battery
    | Cells
    | Vibration
    | Gps
    | Estimator
    | Text
    | Machine
    | Decision
    | LogLine
    | Sample
    | Acceleration
    | Rotation
    | Field
    | Failed
    | Clock
    | Build
    | Parameter
    | Fix
    | PlanItem
)
