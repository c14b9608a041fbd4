"""What a station and its operators say to each other: JSON, one object a line.

An operator's program (TUI, `--plain`, a one-shot command, a script) writes `Command` lines and
reads `Event` lines: the one that started the station through its standard input and output, any
other one through the station's local socket (`gcs/shell/stations.py` finds it), where its first
line is a `Join`.  The operator's frame is ENU, metres; angles are degrees, clockwise from north;
everything is converted once, in the session.  Both unions are tagged by `type`; a line that does
not decode is answered with a `Trouble` event.  What the record keeps too is a struct of
`gcs/report.py`, or is made of one.

Answers (`VerdictEvent`, `StreamVerdictEvent`, `OrbitEvent`, `EndingEvent`, `ProgressEvent`,
`ParametersEvent`, `FileDataEvent`, `FilesEvent`, `LogsEvent`, `OperationList`, `MessageEvent`,
`Topic`, `TopicMessage`) go to the operator who asked; all else goes to all.
`docs/json.md` is this module as a page; `SCHEMA` counts up when a field or a meaning that is there
changes, not when something is added.

The words of requests and their arguments are one table (`gcs/request_words.py`): typed
lines and one-shot commands alike become `Ask`.
"""

from __future__ import annotations

from typing import Annotated, TypeAlias

import msgspec
from msgspec import DecodeError as DecodeError

from gcs.frames import Vec3 as Vec3
from gcs.report import FenceShape as FenceShape
from gcs.report import LogEvent as LogEvent

SCHEMA = 1
"""Version of everything here.  A reader must pass over types and fields that it does not know."""

Maybe3 = tuple[float | None, float | None, float | None]
"""JSON has no NaN: what was typed as nan or inf travels as null and is refused by the gate."""

EVERY = -1
"""In place of a vehicle's number, of abort, hold, land and rtl: every one that flies."""


Lease = Annotated[float, msgspec.Meta(gt=0.0, le=86_400.0)]
"""Seconds, more than 0 and at most a day."""


class Circle(msgspec.Struct, frozen=True, omit_defaults=True):
    """What an orbit is asked for.

    Null or left out: as it is flown already, else 10 m at 1 m/s about the place where the vehicle
    is, with its nose to the centre, until something else is asked for.
    """

    centre_enu: Maybe3 | None = None  # metres; east and north, up, or all may be null
    radius_m: float | None = None  # positive: clockwise, seen from above; 2 to 1000
    speed_m_s: float | None = None
    turns: float | None = None  # 0 = until something else is asked for
    nose: str = ""  # centre | initial | free | along


class Ask(msgspec.Struct, frozen=True, tag="ask", tag_field="type", omit_defaults=True):
    """One request.  `id` is the client's own number and comes back in every answer.

    `word` is one of: control arm disarm takeoff goto heading speed orbit land rtl hold abort resume
    photo mode fence mission_start mission_upload mission_download mission_clear mission_set_current
    mission_check fence_upload fence_download fence_clear fence_put rally_upload rally_download
    rally_clear param_list param_get param_set file_read file_list file_crc log_list log_read
    stream_begin stream_end station_take station_release station_end.
    A goto has one of `goal_enu`, `move_enu`, `move_body` and `goal_global`.  Where it leads is
    settled when it arrives, by what the vehicle has reported then: the verdict's `goal_enu` tells.
    Of several vehicles: abort, hold, land and rtl without a `vehicle`, or with -1, are for every
    one that flies.  They have one verdict, accepted if one of them accepts it, and one ending, once
    all have ended: complete if all are, else that of the first which is not.  Anything else without
    a `vehicle` is for the first that was heard behind a bridge, and refused by any other station
    (SEVERAL_VEHICLES).
    """

    id: int
    word: str
    goal_enu: Maybe3 | None = None  # goto: metres east, north, up of the local origin
    move_enu: Maybe3 | None = None  # goto: metres east, north, up of where the vehicle is
    move_body: Maybe3 | None = None  # goto: metres forward, right, up of it, as its nose points
    goal_global: Maybe3 | None = None  # goto: latitude, longitude in degrees; metres above home
    amsl: bool = False  # goal_global: metres above mean sea level instead
    yaw_deg: float | None = None
    speed_m_s: float | None = None  # speed: of the legs of goto from now on; goto: of this one
    up_m: float | None = None  # takeoff: metres above the take-off point
    mode: str = ""  # mode: the autopilot's own name; mission_check: wait until it is shown
    force: bool = False  # disarm
    on: bool = True  # fence
    path: str = ""  # ..._upload: file to read; ..._download: where to write;
    #   file_read, file_list, file_crc: on the vehicle
    item: int = 0  # mission_set_current: where the next start begins, as MAVLink counts (seq);
    #   log_read: the vehicle's number of the log
    name: str = ""  # param_get, param_set: of the parameter
    value: float | None = None  # param_set
    offset: int = 0  # file_read, log_read: the first byte that is wanted
    operation: int = 0  # abort: only if this operation is still under way; 0 = whatever is
    vehicle: int = 0  # system id of the one that it is for
    orbit: Circle | None = None  # orbit
    lease_s: Lease | None = None  # aborted unless a `renew` comes within so long; null: no lease


class Stream(msgspec.Struct, frozen=True, tag="stream", tag_field="type", omit_defaults=True):
    """One sample of a setpoint stream, of the operator in control: at least one of the first three,
    or an attitude: `roll_deg`, `pitch_deg`, `yaw_deg` and `thrust`.

    The vehicle flies it until the next one comes, and no longer than the policy's dead-man's time;
    it is sent on at most 20 times a second.  The first sample that clears begins the stream, where
    `stream_begin` did not; `stream_end`, or any request that is accepted, ends it.  A sample has no
    answer of its own: a `stream_verdict` tells when samples begin to be refused, and when they are
    flown again.
    """

    pos_enu: Maybe3 | None = None  # metres east, north, up of the local origin
    v_enu: Maybe3 | None = None  # metres per second
    a_enu: Maybe3 | None = None  # metres per second squared
    yaw_deg: float | None = None
    yaw_rate_deg_s: float | None = None  # clockwise
    roll_deg: float | None = None  # to the right
    pitch_deg: float | None = None  # nose up
    thrust: float | None = None  # 0 to 1; what it does is the vehicle's: `gcs/gate/attitude.py`
    vehicle: int = 0  # system id of the one that it is for; 0 = the first that was heard


class Pending(msgspec.Struct, frozen=True, tag="pending", tag_field="type"):
    """Keyboard manager: the pending goal of the vehicle that is shown changed; recorded and logged,
    nothing is sent."""

    goal_enu: Vec3
    yaw_deg: float | None = None


class Show(msgspec.Struct, frozen=True, tag="show", tag_field="type"):
    """From now on tell me of this vehicle, in place of the first one: snapshots and states, fence
    and mission path, messages that are subscribed to.  What was before of it is told at once."""

    vehicle: int  # system id; of one that is not heard there are snapshots without a vehicle


class Leave(msgspec.Struct, frozen=True, tag="leave", tag_field="type"):
    """The operator goes, in good order.  End of file says the same for an operator that is lost."""

    reason: str = "quit"
    hold: bool = False  # hold the vehicle whatever `Join.hold_on_leave` was: a Ctrl-C


class Join(msgspec.Struct, frozen=True, tag="join", tag_field="type"):
    """The first line on a station's socket, within 2 s: who comes.

    `hold_on_leave`: an operator who is in control when it leaves wants the vehicle held.  False
    is for one-shot commands, which leave the vehicle as it is; one that is lost is held anyway.
    """

    name: str  # what other operators are told: "gcs attach, pid 4711"
    schema: int = SCHEMA
    token: str = ""  # from the station's description; needed where the socket is a TCP port
    hold_on_leave: bool = True


class Subscribe(msgspec.Struct, frozen=True, tag="subscribe", tag_field="type"):
    """From now on tell me of these MAVLink messages of the vehicle, in place of those before.

    Each comes as a `MessageEvent` when it is heard, at most ten times a second.
    """

    messages: list[str]  # names as in the dialect: "BATTERY_STATUS"


class ListOperations(msgspec.Struct, frozen=True, tag="list_operations", tag_field="type"):
    """Asks for an `OperationList`; `id` comes back in it."""

    id: int


class Check(msgspec.Struct, frozen=True, tag="check", tag_field="type"):
    """What would the gate say to this request now?  Any operator may ask; nothing is done.

    Answered with `Checked`.  Only what the gate decides by itself can be checked so: goto, takeoff,
    control, arm, land, rtl, hold, resume, photo, mode and others; not missions and orbits.
    """

    asked: Ask  # its `id` comes back


class Renew(msgspec.Struct, frozen=True, tag="renew", tag_field="type"):
    """The operator who asked for an operation still looks at it: its lease begins anew.

    Where none comes in time, the station aborts the operation, within a second.  It has no answer;
    for an operation that has ended, or of somebody else, nothing is done.
    """

    operation: int


class Note(msgspec.Struct, frozen=True, tag="note", tag_field="type"):
    """What this operator's program has done or was told, in words: recorded and logged, no more."""

    text: str


class Preflight(msgspec.Struct, frozen=True, tag="preflight", tag_field="type"):
    """What is known of everything that matters before a take-off?  Any operator may ask; nothing
    is sent to the vehicle for it.  Answered with `PreflightReport`."""

    id: int
    vehicle: int = 0  # system id of the one that it is about; 0 = the first that was heard


class WatchTopics(msgspec.Struct, frozen=True, tag="watch_topics", tag_field="type"):
    """From now on tell me of everything that goes into the record, as the topics of its file.

    First come the topics that are there and the latest of what is said only once (fence, static
    frames, models, parameters).  A station that does not record answers with a `Trouble`.
    """


Command: TypeAlias = (
    Ask
    | Stream
    | Pending
    | Show
    | Leave
    | Join
    | Subscribe
    | ListOperations
    | Check
    | Renew
    | Note
    | Preflight
    | WatchTopics
)


class Hello(msgspec.Struct, frozen=True, tag="hello", tag_field="type"):
    """First event: where the record is and what the station listens to."""

    version: str
    log_path: str
    endpoints: list[str]
    policy: str
    fence: list[FenceShape] = []
    schema: int = SCHEMA
    client: int = 1  # the number that the station knows this operator by; 1 has started it
    client_ports: list[str] = []  # where MAVLink clients reach the vehicle through the station
    battery_low_pct: float = 0.0  # from where on the policy calls a battery low


class OperatorInfo(msgspec.Struct, frozen=True):
    """One operator's program that is connected."""

    client: int
    name: str


class Operators(msgspec.Struct, frozen=True, tag="operators", tag_field="type"):
    """Who is connected, and who is in control of the station; told whenever that changes.

    Only the operator in control can ask for everything.  The others look, and may ask for abort,
    hold, land, rtl and disarm, and for `station_take`.
    """

    operators: list[OperatorInfo]
    in_control: int  # client number; 0 = nobody: the first who asks for something gets it


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
    operation: int = 0  # the station's own number of this request


class Checked(msgspec.Struct, frozen=True, tag="checked", tag_field="type"):
    """The answer to `Check`: the verdict that the request would get now.

    A goto is also judged by itself, as from where the vehicle will hover: `goal_code` is empty
    where it clears or cannot be judged yet.  So a goal can be looked at while the vehicle stands on
    the ground or flies to another one.
    """

    id: int
    word: str
    outcome: str  # accepted | refused | waits: it is decided later, as a goto during a climb
    code: str = ""
    sentence: str = ""
    zone: str = ""
    numbers: dict[str, float | None] = {}
    goal_code: str = ""
    goal_sentence: str = ""
    goal_zone: str = ""


class PreflightRow(msgspec.Struct, frozen=True):
    """One thing that was looked at before a take-off."""

    name: str
    verdict: str  # pass | caution | fail
    sentence: str
    remedies: list[str] = []  # commands that mend it
    waits: bool = False  # what it is about has not been told yet, and may still come


class PreflightReport(msgspec.Struct, frozen=True, tag="preflight_report", tag_field="type"):
    """The answer to `Preflight`: every row of the list, in its order.

    Two rows are only as good as what the station has read of the vehicle, and it reads neither by
    itself: `unread` are parameters that shape a stop, each by every name that it may have, for
    param_get; with `mission_unverified` there is a mission on board for mission_check.
    """

    id: int
    rows: list[PreflightRow]
    vehicle: int = 0  # system id; 0 = none is heard
    unread: list[list[str]] = []
    mission_unverified: bool = False

    @property
    def fails(self) -> bool:
        """Whether any row does."""
        return any(row.verdict == "fail" for row in self.rows)


class StreamVerdictEvent(msgspec.Struct, frozen=True, tag="stream_verdict", tag_field="type"):
    """The samples of this operator's stream are refused from now on, and the vehicle is held in its
    place; or they are flown from now on.  Told where that changes."""

    outcome: str  # accepted | refused
    code: str = ""
    sentence: str = ""
    zone: str = ""
    numbers: dict[str, float | None] = {}
    vehicle: int = 0  # system id


class OrbitEvent(msgspec.Struct, frozen=True, tag="orbit", tag_field="type"):
    """The orbit of this operator that is flown, twice a second."""

    time_ns: int
    centre_enu: Vec3
    radius_m: float  # positive: clockwise, seen from above
    speed_m_s: float
    nose: str  # centre | initial | free | along
    turns: float  # that were flown
    circling: bool  # false: still on the way to the circle
    centre_lat_lon_amsl: tuple[float, float, float] | None = None  # null without an origin
    vehicle: int = 0  # system id


class EndingEvent(msgspec.Struct, frozen=True, tag="ending", tag_field="type"):
    """How an accepted request ended: `report.DecisionItem` for the client that asked."""

    id: int
    word: str
    ended: str  # complete | aborted | superseded | timed out | taken over
    code: str = ""
    sentence: str = ""
    numbers: dict[str, float | None] = {}  # photo: `picture`, the vehicle's number of it


class Operation(msgspec.Struct, frozen=True, tag="operation", tag_field="type"):
    """An accepted request of any operator: told when it is accepted and when it has ended.

    `state` is running, or how it ended: complete, aborted, superseded, timed out, taken over.
    """

    id: int  # the station's own number, the same for all operators
    asked: Ask
    client: int
    operator: str
    since_ns: int
    state: str = "running"
    code: str = ""
    sentence: str = ""
    ended_ns: int | None = None


class OperationList(msgspec.Struct, frozen=True, tag="operations", tag_field="type"):
    """Every operation that is running, and the latest that have ended, the oldest first."""

    id: int
    operations: list[Operation]


class MessageEvent(msgspec.Struct, frozen=True, tag="message", tag_field="type"):
    """A MAVLink message of the vehicle that was subscribed to; dropped when the reader is slow.

    `fields` are as on the wire, with the dialect's names and units; arrays are lists.
    """

    name: str
    time_ns: int
    sysid: int
    compid: int
    fields: dict[str, int | float | str | list[int | float | str] | None]


class Topic(msgspec.Struct, frozen=True, tag="topic", tag_field="type"):
    """A topic of the record, before its first message; for whoever has sent `watch_topics`.

    The fields are those of a channel and of its schema in an MCAP file.
    """

    number: int
    topic: str
    message_encoding: str
    schema_name: str
    schema_encoding: str
    schema: bytes
    metadata: dict[str, str] = {}


class TopicMessage(msgspec.Struct, frozen=True, tag="topic_message", tag_field="type", gc=False):
    """One message of a topic, as it goes into the record.  Raw frames are dropped when the reader
    is slow, the others are not."""

    number: int  # of the topic
    log_time_ns: int
    data: bytes
    latch: str = ""  # not empty: the last word on this, until another with the same latch comes


class Parameter(msgspec.Struct, frozen=True):
    """A parameter of the vehicle as it holds it."""

    name: str
    value: int | float | None  # a whole number where its type is; null = not a finite number
    kind: str  # real32, int32 ...: MAV_PARAM_TYPE


class ParametersEvent(msgspec.Struct, frozen=True, tag="parameters", tag_field="type"):
    """Parameters that were asked for with param_list (at most 50 an event), param_get, param_set:
    between the verdict and the ending of the request."""

    id: int
    parameters: list[Parameter]


class FileDataEvent(msgspec.Struct, frozen=True, tag="file_data", tag_field="type"):
    """The next bytes of what file_read or log_read reads, in order."""

    id: int
    offset: int
    data: bytes  # base64
    size: int  # of all of it, as the vehicle has told it; ArduPilot's @PARAM says too much


class FileInfo(msgspec.Struct, frozen=True):
    """What a folder on the vehicle holds."""

    name: str
    size: int | None  # bytes; null = a folder, or not told
    crc: int | None = None  # CRC-32 of the content, as MAVLink FTP has it; of file_crc only


class FilesEvent(msgspec.Struct, frozen=True, tag="files", tag_field="type"):
    """What file_list has found (at most 50 an event), or file_crc."""

    id: int
    files: list[FileInfo]


class LogInfo(msgspec.Struct, frozen=True):
    """A flight log that the vehicle keeps."""

    number: int
    size: int  # bytes
    time_utc_s: int  # of the last write, seconds since 1970; 0 = not known


class LogsEvent(msgspec.Struct, frozen=True, tag="logs", tag_field="type"):
    """What log_list has found (at most 50 an event)."""

    id: int
    logs: list[LogInfo]


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


class OtherVehicle(msgspec.Struct, frozen=True):
    """A vehicle of the station beside the one that a snapshot is of."""

    vehicle: int  # system id
    state: str
    severity: str
    conditions: list[str] = []
    mode: str = ""
    armed: bool | None = None
    on_ground: bool = False  # it was last seen there
    pos_enu: Vec3 | None = None  # metres east, north, up in the frame of the snapshot's vehicle
    goal_enu: Vec3 | None = None  # the same; the goal that it flies to, or hovers at
    battery_pct: float | None = None


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
    failsafes: list[str] = []  # its own, one a case: "low battery: land"
    mends: list[str] = []  # what sets right those that are weak: "gcs param set NAV_DLL_ACT 2"
    battery_pct: float | None = None
    battery_v: float | None = None
    heartbeat_age_s: float | None = None
    rx_hz: float = 0.0
    setpoint_hz: float = 0.0
    mission_seq: int | None = None
    mission_total: int | None = None
    in_control: OperatorInfo | None = None  # of the station; None = nobody
    others: list[OtherVehicle] = []  # that the station flies as well, in the order they were met

    @property
    def sysid(self) -> int:
        """The system id of the vehicle that it is of; 0 = none."""
        return int(self.vehicle.partition("/")[0] or 0)


class TrailPoint(msgspec.Struct, frozen=True, array_like=True):
    """Where the vehicle was, and how, at one second of its flight; an array in JSON."""

    time_ns: int
    pos_enu: Vec3  # metres
    speed_m_s: float | None
    battery_pct: float | None
    in_air: bool


class History(msgspec.Struct, frozen=True, tag="history", tag_field="type"):
    """What was before, for an operator who has joined: the last ten minutes of the vehicle's way,
    the latest lines of the log, and since when it has been in the air."""

    trail: list[TrailPoint]
    log: list[LogEvent]
    in_air_since_ns: int | None = None  # on the clock of the snapshots; null: on the ground


class MissionItem(msgspec.Struct, frozen=True, array_like=True):
    """One item of a mission on board; an array in JSON."""

    seq: int  # as MAVLink counts, and `Snapshot.mission_seq`
    command: str  # MAV_CMD: "NAV_WAYPOINT"
    alt_m: float | None = None  # metres above `datum`; null: it has no place
    datum: str = ""  # home | sea | ground


class MissionPath(msgspec.Struct, frozen=True, tag="mission_path", tag_field="type"):
    """The mission on board as it was verified: its path and its items; empty where there is none.
    Told when it changes, of the vehicle that snapshots are of."""

    points_enu: list[Vec3]  # metres; the legs join them in order
    items: list[MissionItem] = []
    unverified: str = ""  # why what is on board may not be flown as it is; empty: nothing is wrong


class VehicleFence(msgspec.Struct, frozen=True, tag="vehicle_fence", tag_field="type"):
    """The fence that was uploaded to the vehicle, which it keeps by itself, whoever has put it on
    board; the policy's is `Fences`.  Told when it changes, of the vehicle that snapshots are of."""

    zones: list[FenceShape]


class OperatorGoal(msgspec.Struct, frozen=True, tag="operator_goal", tag_field="type"):
    """The operator in control has another goal in mind: its `Pending`, for the others."""

    client: int
    goal_enu: Vec3
    yaw_deg: float | None = None
    vehicle: int = 0  # system id of the one that it is for; 0 = the first that was heard


class BridgeLink(msgspec.Struct, frozen=True):
    """One link on which vehicles are, as a bridge counts it."""

    link: int
    name: str  # its endpoint
    rx_hz: float = 0.0  # frames a second, received
    tx_hz: float = 0.0  # sent
    lost_pct: float = 0.0  # of the vehicle's frames on this link, by their sequence numbers


class BridgeClient(msgspec.Struct, frozen=True):
    """One MAVLink client of a bridge: one peer on one client port."""

    client: int  # its number among the operators, from 1000 up; 0 = it is sent to, and not heard
    link: int
    name: str  # "udp 127.0.0.1:14551"
    ids: list[str] = []  # "255/190": who it has said that it is; empty before its first frame
    rx_hz: float = 0.0  # frames a second that it sends
    tx_hz: float = 0.0  # that it is sent
    refused: int = 0  # its frames that did not go to the vehicle, since it came
    dropped: int = 0  # its datagrams over the rate limit, which nobody looked at; it is told
    signed: str = ""  # empty: not signed; else what is known of its signatures
    in_control: bool = False
    silent_s: float = 0.0  # since its last frame
    verified: bool = True  # false: a port with a key took it in, and it has not signed anything yet


class BridgeVehicle(msgspec.Struct, frozen=True):
    """One vehicle of several, or behind a bridge, in short; `Snapshot` has one in full."""

    vehicle: int  # system id
    name: str  # "1/1 px4 quadrotor"
    state: str
    control: str
    severity: str
    conditions: list[str] = []
    mode: str = ""
    armed: bool | None = None
    link: int = 0  # that it is answered on
    lost_pct: float = 0.0  # of its frames, by their sequence numbers
    silent_s: float = 0.0  # since anything was heard of it
    pos_enu: Vec3 | None = None  # metres east, north, up of its own local origin
    v_enu: Vec3 | None = None  # metres per second
    battery_pct: float | None = None


class BridgeStatus(msgspec.Struct, frozen=True, tag="bridge", tag_field="type"):
    """Who is connected to the bridge, and what goes through it; at most two a second, dropped when
    the reader is slow.  A station without a bridge tells it where it flies several vehicles."""

    time_ns: int
    links: list[BridgeLink]
    clients: list[BridgeClient]
    vehicles: list[BridgeVehicle] = []  # in the order in which they were met


class BridgeDecision(msgspec.Struct, frozen=True, tag="bridge_decision", tag_field="type"):
    """What the bridge decided of one thing that a MAVLink client sent.

    For refusals, and for what was accepted of motion and of configuration; what is only forwarded
    is not told one by one.
    """

    time_ns: int
    client: int
    name: str  # of the client
    what: str  # "DO_REPOSITION", "PARAM_SET FENCE_ENABLE"
    outcome: str  # accepted | refused | superseded
    code: str = ""
    sentence: str = ""
    vehicle: int = 0  # system id; 0 = none, as before one is heard


class Trouble(msgspec.Struct, frozen=True, tag="trouble", tag_field="type"):
    """Something the operator must know that is not the flight: a bad line, a port in use, …

    `exit_code` is what a one-shot command should exit with because of it, 0 for none.
    """

    text: str
    hint: str = ""
    exit_code: int = 0


class Bye(msgspec.Struct, frozen=True, tag="bye", tag_field="type"):
    """Last event: the station has ended and the log is closed, or this operator has left it."""

    exit_code: int
    log_path: str
    sentence: str
    goes_on: bool = False  # the station lives on without this operator


Event: TypeAlias = (
    Hello
    | Operators
    | Fences
    | VerdictEvent
    | Checked
    | PreflightReport
    | StreamVerdictEvent
    | OrbitEvent
    | EndingEvent
    | Operation
    | OperationList
    | ProgressEvent
    | ParametersEvent
    | FileDataEvent
    | FilesEvent
    | LogsEvent
    | MessageEvent
    | Topic
    | TopicMessage
    | StateEvent
    | LogEvent
    | Snapshot
    | History
    | MissionPath
    | VehicleFence
    | OperatorGoal
    | BridgeStatus
    | BridgeDecision
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
