"""What the tests of the record share: frames, a clock's start, and ways to look into a file."""

from __future__ import annotations

import struct
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from mcap.reader import make_reader
from mcap.records import Channel
from mcap.summary import Summary
from pymavlink.dialects.v20 import all as dialect
from pymavlink.generator.mavcrc import x25crc

from gcs.mcap_file.format import MAGIC, RECORD_HEAD, Message
from gcs.mcap_file.reader import Reading
from gcs.record.writer import Recorder
from gcs.report import (
    AttachmentItem,
    DecisionItem,
    Direction,
    FenceItem,
    FenceShape,
    FrameItem,
    FsaItem,
    GarbageItem,
    GeodeticItem,
    InputItem,
    LegItem,
    LogEvent,
    MetadataItem,
    MissionItem,
    ParamItem,
    PointEnu,
    PoseItem,
    RecordItem,
    SetpointItem,
    StatusItem,
    StopItem,
)

START_NS = 1_767_225_600_000_000_000
MS = 1_000_000
SECOND = 1_000_000_000


class Logged(NamedTuple):
    topic: str
    log_time_ns: int
    data: bytes


def frame_v2(
    msgid: int, payload: bytes, seq: int = 0, source: tuple[int, int] = (1, 1), signed: bool = False
) -> bytes:
    """A MAVLink 2 frame; trailing zeros are cut, as every sender does."""
    payload = payload[:1] + payload[1:].rstrip(b"\0")
    header = struct.pack("<BBBBBB", len(payload), int(signed), 0, seq, *source)
    body = header + msgid.to_bytes(3, "little") + payload
    crc_extra = dialect.mavlink_map[msgid].crc_extra if msgid in dialect.mavlink_map else 0
    checksum = x25crc(body + bytes([crc_extra])).crc
    signature = bytes(range(13)) if signed else b""
    return b"\xfd" + body + struct.pack("<H", checksum) + signature


def frame_v1(msgid: int, payload: bytes, seq: int = 0, source: tuple[int, int] = (1, 1)) -> bytes:
    body = struct.pack("<BBBBB", len(payload), seq, *source, msgid) + payload
    crc_extra = dialect.mavlink_map[msgid].crc_extra if msgid in dialect.mavlink_map else 0
    return b"\xfe" + body + struct.pack("<H", x25crc(body + bytes([crc_extra])).crc)


def position_frame(number: int) -> FrameItem:
    """LOCAL_POSITION_NED whose time_boot_ms is `number`."""
    payload = struct.pack("<I6f", number, 1.0, 2.0, -3.0, 0.1, 0.2, -0.3)
    return FrameItem(0, Direction.RECEIVED, frame_v2(32, payload, number & 0xFF))


def decided(
    number: int,
    outcome: str,
    *,
    phase: str = "verdict",
    word: str = "goto",
    goal: PointEnu | None = None,
    code: str = "",
    sentence: str = "",
    zone: str = "",
    source: str = "operator",
    numbers: Mapping[str, float | None] | None = None,
) -> DecisionItem:
    """What is decided on a request of vehicle 1."""
    return DecisionItem(
        vehicle=1,
        request_id=number,
        source=source,
        word=word,
        phase="verdict" if phase == "verdict" else "ending",
        outcome=outcome,
        code=code,
        sentence=sentence,
        zone=zone,
        goal=goal,
        numbers=dict(numbers or {}),
    )


def messages_of(path: Path) -> list[Logged]:
    """Every message that can be read, in file order."""
    topics: dict[int, str] = {}
    found = []
    for record in Reading(path):
        if isinstance(record, Message):
            found.append(Logged(topics[record.channel_id], record.log_time_ns, record.data))
        elif isinstance(record, Channel):
            topics[record.id] = record.topic
    return found


def opened(directory: Path, name: str = "f", *, sealed: bool = False, **how: Any) -> Recorder:
    """A recorder of `20260101-000000_<name>.mcap`; `how` as for `Recorder.open`."""
    return Recorder.open(directory, name, "20260101-000000", START_NS, sealed=sealed, **how)


def record(directory: Path, items: Iterable[RecordItem], step_ns: int = 20 * MS) -> Path:
    """Record items, `step_ns` apart, flushing when due; the closed file."""
    recorder = opened(directory, "test")
    now_ns = START_NS
    for item in items:
        recorder.write(item, now_ns)
        now_ns += step_ns
        if now_ns >= recorder.deadline_ns:
            assert recorder.tick(now_ns) == []
    assert recorder.close(now_ns)
    return recorder.path


def summary_of(path: Path) -> Summary:
    """As the library's indexed reader finds it."""
    with open(path, "rb") as file:
        found = make_reader(file).get_summary()
    assert found is not None
    return found


def without_a_record_s_head(path: Path, opcode: int) -> int:
    """The first record of that kind begins with zeros; gives the bytes from there on."""
    data = bytearray(path.read_bytes())
    at = len(MAGIC)
    while data[at] != opcode:
        at += RECORD_HEAD.size + RECORD_HEAD.unpack_from(data, at)[1]
    data[at : at + RECORD_HEAD.size] = bytes(RECORD_HEAD.size)
    path.write_bytes(data)
    return len(data) - at


def a_flight() -> list[RecordItem]:
    """One of everything, as a short flight with one refused goal."""
    upright = (1.0, 0.0, 0.0, 0.0)
    home = FenceShape("home", True, [], (0.0, 0.0), 150.0, 0.0, 50.0)
    tower = FenceShape("tower", False, [(10, 10), (20, 10), (20, 20)], None, 0.0, 0.0, None)
    return [
        MetadataItem("versions", (("mavgate", "0"),)),
        AttachmentItem("policy.toml", "text/toml", b"[fence]"),
        InputItem.of("start", {"seed": 1}),
        FenceItem([home, tower], (47.397742, 8.545594, 488.0)),
        MissionItem(1, "square", ((0.0, 0.0, -5.0), (10.0, 0.0, -5.0))),
        position_frame(0),
        PoseItem(1, (1.0, 2.0, -3.0), (3.0, 4.0, -0.5), upright),
        GeodeticItem(1, 47.397742, 8.545594, 491.0, 3.0),
        StatusItem(1, True, "OFFBOARD", "in_air", 80.0, 15.2, 100.0, 0.0),
        FsaItem(1, "HOVERING", 1, "GROUNDED", "airborne", "ours", "nominal", None),
        SetpointItem(1, (1.0, 2.0, -3.0), None),
        StopItem(1, (1.0, 2.0, -3.0), (1.0, 5.0, -3.0)),
        LegItem(1, ((1.0, 2.0, -3.0), (1.0, 5.0, -3.0)), (2.0, 0.0)),
        decided(
            7,
            "refused",
            code="OUTSIDE_FENCE",
            sentence="500.0 m east is 350.0 m outside home",
            zone="home",
            goal=PointEnu(500.0, 0.0, 2.0),
            numbers={"distance_m": 350.0},
        ),
        FsaItem(1, "MOVING", 3, "HOVERING", "goto", "ours", "nominal", PointEnu(0.0, 1.0, 2.0)),
        ParamItem(1, "MPC_XY_VEL_MAX", 12.0),
        LogEvent(START_NS, 2, "gate", "Complete"),
        GarbageItem(0, b"\xfd\x00", "truncated"),
    ]
