"""What the record is told besides frames and decisions: the set-up, the inputs, the simulator."""

from __future__ import annotations

from collections.abc import Iterable

from gcs import ipc
from gcs.gate.effects import Level
from gcs.report import AttachmentItem, FenceShape, InputItem, LogEvent, MetadataItem
from gcs.session.clients import FIRST
from gcs.session.effects import Effect, Emit, Record
from gcs.session.inputs import FileRead, OtherInput, RecorderGrew
from gcs.session.setup import Setup
from gcs.session.work import Log, Work


def introduction(setup: Setup) -> list[Effect]:
    """First of all: what this session is, in the record and on the screen."""
    config = setup.config
    values = (
        ("version", setup.version),
        ("endpoints", " ".join(setup.endpoints)),
        ("policy", setup.policy.name),
        ("station", f"{config.sysid}/{config.compid}"),
        ("speedup", f"{config.speedup:g}"),
        ("seed", str(config.sim.seed) if config.sim else ""),
    )
    policy = setup.policy_text.encode()
    return [
        Record(MetadataItem("mavgate", values)),
        Record(AttachmentItem("policy.toml", "application/toml", policy)),
        Record(InputItem.of("Setup", config)),
        Emit(hello(setup, setup.log_path), FIRST),
    ]


def hello(
    setup: Setup, log_path: str, fence: Iterable[FenceShape] = (), client: int = FIRST
) -> ipc.Hello:
    """The first event that an operator's program is told."""
    endpoints, policy = list(setup.endpoints), setup.policy.name
    return ipc.Hello(setup.version, log_path, endpoints, policy, list(fence), client=client)


def recorded(given: OtherInput) -> list[Effect]:
    """All but the frames, which are recorded as such; with them it is the audit's input."""
    match given:
        case RecorderGrew():
            return []
        case FileRead(token, path, data, error):
            size = -1 if data is None else len(data)
            told = {"token": token, "path": path, "size": size, "error": error}
            return [Record(InputItem.of("FileRead", told))]
        case _:
            return [Record(InputItem.of(type(given).__name__, given))]


def sim_line(text: str, now_ns: int) -> Work:
    """`LEVEL node: text`, as vehicle-sim prints it; anything else is an INFO line."""
    word, _, rest = text.partition(" ")
    node, colon, line = rest.partition(": ")
    if word in Level.__members__ and colon and node.startswith("vehicle"):
        # The operator has it from the vehicle itself; the record keeps both.
        return Record(LogEvent(now_ns, Level[word], f"sim.{node}", line))
    if word in Level.__members__ and colon:
        return Log(Level[word], f"sim.{node}", line)
    return Log(Level.INFO, "sim", text)
