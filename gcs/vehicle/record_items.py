"""What the record is told besides frames and decisions: the set-up, the inputs, the simulator.

With the frames that were received it is all that a fresh session needs to do the same again
(`gcs/audit`).  An input is handled at the log_time of the first message that is recorded of it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from pathlib import PurePath

import msgspec

from gcs import ipc
from gcs.gate.effects import Level
from gcs.report import AttachmentItem, FenceShape, InputItem, LogEvent, MetadataItem, StatusItem
from gcs.session.effects import Effect, Emit, Record
from gcs.session.inputs import TAGS, Datagram, FileRead, Input, OtherInput
from gcs.session.requests import FIRST
from gcs.session.setup import Setup
from gcs.session.work import Log, Work
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.blanking import datagram_without_keys, without_keys
from gcs.wire.messages import AutopilotVersion

STAGES = ((255, ""), (192, "-rc"), (128, "-beta"), (64, "-alpha"), (0, "-dev"))
"""FIRMWARE_VERSION_TYPE, as PX4 writes it behind the version."""


@dataclass(frozen=True, slots=True)
class Start:
    """All that a session is made with; the first input that is recorded, as `Setup`."""

    setup: Setup
    start_ns: int


@dataclass(frozen=True, slots=True)
class Pieces:
    """The next `items` frames and garbage of `link` came as one read of a stream, of which `rest`
    is in no item yet.  Recorded as `Datagram`, before these; also for an empty datagram.  All else
    needs no word: the items of one datagram have log_times without a gap."""

    link: int
    items: int
    rest: bytes = b""


@dataclass(frozen=True, slots=True)
class FileKept:
    """A `FileRead`, whose bytes are the attachment of that name; `size` is -1 without any."""

    token: int
    path: str
    size: int
    attachment: str
    error: str


@dataclass(frozen=True, slots=True)
class FaultKept:
    """An exception at `input`, one of `kind`: while it was handled, so that nothing else is
    recorded of it, or (`handled`) while its effects were performed.  It was given at `at_ns`."""

    report: str
    handled: bool
    kind: str
    input: msgspec.Raw
    at_ns: int


def introduction(setup: Setup, start_ns: int) -> list[Effect]:
    """First of all: what this session is, in the record and on the screen."""
    config = setup.config
    values = (
        ("version", setup.version),
        ("endpoints", " ".join(setup.endpoints)),
        ("policy", setup.policy.name),
        ("station", f"{config.sysid}/{config.compid}"),
        ("speedup", f"{config.speedup:g}"),
        ("seed", str(config.sim.seed) if config.sim else ""),
        ("environment", setup.environment),
        ("command_line", config.command_line),
    )
    return [
        Record(MetadataItem("mavgate", values)),
        Record(AttachmentItem.of_file("policy.toml", setup.policy_text.encode())),
        *_own_rule(setup),
        Record(InputItem.of("Setup", Start(setup, start_ns))),
        Emit(hello(setup, setup.log_path), FIRST),
    ]


def _own_rule(setup: Setup) -> list[Effect]:
    """Its source, for whoever reads what it refused."""
    path, text = setup.config.rule_path, setup.rule_text
    if isinstance(path, msgspec.UnsetType) or isinstance(text, msgspec.UnsetType):
        return []
    return [Record(AttachmentItem.of_file(path, text.encode()))]


def hello(
    setup: Setup, log_path: str, fence: Iterable[FenceShape] = (), operator: int = FIRST
) -> ipc.Hello:
    """The first event that an operator's program is told."""
    endpoints, policy = list(setup.endpoints), setup.policy.name
    return ipc.Hello(
        setup.version,
        log_path,
        endpoints,
        policy,
        list(fence),
        client=operator,
        client_ports=list(setup.client_ports),
        battery_low_pct=setup.policy.battery.low_pct,
    )


def recorded(given: OtherInput) -> list[Effect]:
    """All but the frames, which are recorded as such; with them it is the audit's input."""
    match given:
        case FileRead(token, path, None, error):
            return [Record(InputItem.of("FileRead", FileKept(token, path, -1, "", error)))]
        case FileRead(token, path, data, error):
            assert data is not None
            name = attachment_name(path, data)
            kept = FileKept(token, path, len(data), name, error)
            return [
                Record(AttachmentItem(name, "application/octet-stream", data)),
                Record(InputItem.of("FileRead", kept)),
            ]
        case _:
            return [Record(InputItem.of(TAGS[type(given)], given))]


def attachment_name(path: str, data: bytes) -> str:
    """One name a content: the recorder keeps an attachment of the same name and content once."""
    return f"read-{sha256(data).hexdigest()[:16]}-{PurePath(path).name}"


def pieces(link: int, items: int, rest: bytes) -> Sequence[Effect]:
    """How a datagram was cut, of which nothing or not all shows in what is recorded of it."""
    # `rest` may be the beginning of a SETUP_SIGNING, whose key is in no record.
    return (Record(InputItem.of("Datagram", Pieces(link, items, without_keys(rest)))),)


def fault(given: Input, report: str, handled: bool, at_ns: int) -> Record:
    """See `FaultKept`.  Raises nothing: an input that has no JSON is left out."""
    kind = TAGS[type(given)]
    if isinstance(given, Datagram):
        given = Datagram(given.link, datagram_without_keys(given.data))
    try:
        as_json = msgspec.json.encode(given)
    except (TypeError, ValueError):
        as_json = b"null"
    kept = FaultKept(report, handled, kind, msgspec.Raw(as_json), at_ns)
    return Record(InputItem.of("Fault", kept))


def vehicle(telemetry: Telemetry, told: AutopilotVersion, of: str = "") -> MetadataItem:
    """What vehicle this was, and with what firmware; `of` is in its name, as in `stood_on`."""
    values = (
        ("vehicle", telemetry.label),
        ("firmware", firmware(told.flight_sw_version)),
        ("firmware_hash", bytes(told.flight_custom_version).hex()),
        ("uid", f"{told.uid:016x}"),
    )
    return MetadataItem(f"vehicle{of}", values)


def firmware(flight_sw_version: int) -> str:
    """AUTOPILOT_VERSION.flight_sw_version: major, minor and patch, then FIRMWARE_VERSION_TYPE."""
    major, minor, patch, kind = flight_sw_version.to_bytes(4, "big")
    stage = next((name for least, name in STAGES if kind >= least), "")
    return f"{major}.{minor}.{patch}{stage}"


def status(telemetry: Telemetry, lost_pct: float) -> StatusItem:
    """How the vehicle is: once a second, and when its mode, armed or landed state changes."""
    return StatusItem(
        telemetry.sysid,
        bool(telemetry.armed),
        telemetry.mode_name,
        telemetry.landed.name,
        telemetry.battery_pct,
        telemetry.battery_v,
        telemetry.rx_hz,
        lost_pct,
    )


def stood_on(
    parameters: Mapping[str, float], fence: Sequence[FenceShape], of: str = ""
) -> list[Effect]:
    """What the vehicle's parameters and the fence were, as files; nothing of what is not known.

    `of` is in their names, for every vehicle but the first.
    """
    kept = {f"parameters{of}.json": parameters, f"fence{of}.json": fence}
    return [Record(AttachmentItem.of_json(name, what)) for name, what in kept.items() if what]


def sim_line(text: str, now_ns: int) -> Work:
    """`LEVEL node: text`, as vehicle-sim prints it; anything else is an INFO line."""
    word, _, rest = text.partition(" ")
    node, colon, line = rest.partition(": ")
    if word in Level.__members__ and colon and node.startswith("vehicle"):
        # The operator has it from the vehicle itself; the record keeps both, this one out of sight.
        return Record(LogEvent(now_ns, Level.DEBUG, f"sim.{node}", line))
    if word in Level.__members__ and colon:
        return Log(Level[word], f"sim.{node}", line)
    return Log(Level.INFO, "sim", text)
