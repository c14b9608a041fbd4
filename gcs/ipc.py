"""What a station and its operator say to each other: JSON, one object a line.

The operator (TUI, `--plain`, a one-shot command) writes `Command` lines to the station's standard
input and reads `Event` lines from its standard output.  The operator's frame is ENU, metres;
angles are degrees, clockwise from north; everything is converted once, in the session.  Both
unions are tagged by `type`; a line that does not decode is answered with a `Trouble` event.
What the record keeps too is a struct of `gcs/report.py`, or is made of one.

The words of requests and their arguments are one table (`gcs/operator/request_words.py`): typed
lines and one-shot commands alike become `Ask`.
"""

from __future__ import annotations

from typing import TypeAlias

import msgspec
from msgspec import DecodeError as DecodeError

from gcs.frames import Vec3 as Vec3
from gcs.report import FenceShape as FenceShape
from gcs.report import LogEvent as LogEvent

Maybe3 = tuple[float | None, float | None, float | None]
"""JSON has no NaN: what was typed as nan or inf travels as null and is refused by the gate."""


class Ask(msgspec.Struct, frozen=True, tag="ask", tag_field="type", omit_defaults=True):
    """One request.  `id` is the client's own number and comes back in every answer.

    `word` is one of: control arm disarm takeoff goto land rtl hold abort resume photo mode
    fence mission_start mission_upload mission_download mission_clear.
    """

    id: int
    word: str
    goal_enu: Maybe3 | None = None  # goto: metres east, north, up of the local origin
    yaw_deg: float | None = None
    up_m: float | None = None  # takeoff: metres above the take-off point
    mode: str = ""  # mode: the autopilot's own name for it
    force: bool = False  # disarm
    on: bool = True  # fence
    path: str = ""  # mission_upload: file to read; mission_download: where to write


class Pending(msgspec.Struct, frozen=True, tag="pending", tag_field="type"):
    """Keyboard manager: the pending goal changed; recorded and logged, nothing is sent."""

    goal_enu: Vec3
    yaw_deg: float | None = None


class Leave(msgspec.Struct, frozen=True, tag="leave", tag_field="type"):
    """The operator goes, in good order.  End of file says the same for an operator that is lost."""

    reason: str = "quit"


Command: TypeAlias = Ask | Pending | Leave


class Hello(msgspec.Struct, frozen=True, tag="hello", tag_field="type"):
    """First event: where the record is and what the station listens to."""

    version: str
    log_path: str
    endpoints: list[str]
    policy: str
    fence: list[FenceShape] = []


class Fences(msgspec.Struct, frozen=True, tag="fences", tag_field="type"):
    """The fence as it now stands (it is known in the local frame only once home or origin is)."""

    zones: list[FenceShape]


class VerdictEvent(msgspec.Struct, frozen=True, tag="verdict", tag_field="type"):
    """The answer to a request: `report.DecisionItem` for the client that asked."""

    id: int
    word: str
    outcome: str  # accepted | refused | superseded
    code: str = ""
    sentence: str = ""
    zone: str = ""
    numbers: dict[str, float | None] = {}
    goal_enu: Maybe3 | None = None


class EndingEvent(msgspec.Struct, frozen=True, tag="ending", tag_field="type"):
    """How an accepted request ended: `report.DecisionItem` for the client that asked."""

    id: int
    word: str
    ended: str  # complete | aborted | superseded | timed out | taken over
    code: str = ""
    sentence: str = ""


class ProgressEvent(msgspec.Struct, frozen=True, tag="progress", tag_field="type"):
    """A transfer or a climb under way: `done` of `total` in `unit`."""

    id: int
    what: str
    done: float
    total: float
    unit: str = ""


class StateEvent(msgspec.Struct, frozen=True, tag="state", tag_field="type"):
    """The gate's state machine moved: `report.FsaItem` after a transition."""

    before: str
    after: str
    event: str
    control: str
    severity: str


class Snapshot(msgspec.Struct, frozen=True, tag="snapshot", tag_field="type"):
    """At most ten a second, dropped when the reader is slow.  None = not known (yet)."""

    time_ns: int
    state: str
    control: str
    severity: str
    conditions: list[str]
    lost_pct: float
    log_path: str
    recording: bool
    recorded_mb: float
    active_goal_enu: Vec3 | None = None
    vehicle: str = ""  # "1/1 px4 quadrotor"
    vehicles: list[str] = []  # all that are heard on the links, this one among them
    listening: bool = False  # other vehicles or its settings may still come: wait a moment
    mode: str = ""
    armed: bool | None = None
    landed: str = ""
    pos_enu: Vec3 | None = None
    v_enu: Vec3 | None = None
    yaw_deg: float | None = None
    position_age_s: float | None = None
    home_enu: Vec3 | None = None
    gps: str = ""  # "3D fix, 10 satellites"
    estimator: str = ""  # "ok", or what is wrong with the vehicle's position
    battery_pct: float | None = None
    battery_v: float | None = None
    heartbeat_age_s: float | None = None
    rx_hz: float = 0.0
    setpoint_hz: float = 0.0
    mission_seq: int | None = None
    mission_total: int | None = None


class Trouble(msgspec.Struct, frozen=True, tag="trouble", tag_field="type"):
    """Something the operator must know that is not the flight: a bad line, a port in use, …

    `exit_code` is what a one-shot command should exit with because of it, 0 for none.
    """

    text: str
    hint: str = ""
    exit_code: int = 0


class Bye(msgspec.Struct, frozen=True, tag="bye", tag_field="type"):
    """Last event: the station has ended, the log is closed."""

    exit_code: int
    log_path: str
    sentence: str


Event: TypeAlias = (
    Hello
    | Fences
    | VerdictEvent
    | EndingEvent
    | ProgressEvent
    | StateEvent
    | LogEvent
    | Snapshot
    | Trouble
    | Bye
)

_encoder = msgspec.json.Encoder()
_command_decoder: msgspec.json.Decoder[Command] = msgspec.json.Decoder(Command)
_event_decoder: msgspec.json.Decoder[Event] = msgspec.json.Decoder(Event)


def encode(message: Command | Event) -> bytes:
    """One line, newline included.  NaN and infinity become null, as JSON has neither."""
    return _encoder.encode(message) + b"\n"


def decode_command(line: bytes) -> Command:
    """Raises msgspec.DecodeError (ValidationError for a wrong shape)."""
    return _command_decoder.decode(line)


def decode_event(line: bytes) -> Event:
    """Raises msgspec.DecodeError (ValidationError for a wrong shape)."""
    return _event_decoder.decode(line)
