"""Inputs and messages in a person's words, as the audit tells them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any
from zlib import crc32

import msgspec

from gcs import ipc
from gcs.audit.compare import LOG_TOPIC, Pair
from gcs.audit.messages import INPUT_TOPIC, Stored
from gcs.audit.turns import Given, RecorderTurn, Unreadable
from gcs.record.log_line import read_log_line
from gcs.report import Direction
from gcs.session.inputs import (
    ClientCame,
    ClientFlooded,
    ClientGone,
    Datagram,
    DiskLow,
    FileRead,
    FileWritten,
    LinkEvent,
    OperatorGone,
    OperatorJoined,
    OperatorLine,
    OperatorNoise,
    RecorderChanged,
    RecorderGrew,
    RuleSaid,
    SignalCame,
    SimGone,
    SimLine,
    Wake,
)
from gcs.vehicle.record_items import FaultKept
from gcs.wire.codec import decode
from gcs.wire.frame import Frame, split

MOST_LETTERS = 300
_FRAMES: dict[int, str] = {
    Direction.RECEIVED: "frame received",
    Direction.SENT: "frame sent",
    Direction.REFUSED: "frame refused",
}

Fields = dict[str, str]


# ------------------------------------------------------------------------------------ inputs


def kind_of_input(given: Given) -> str:
    """Under which name inputs are counted."""
    match given:
        case Datagram():
            return "datagrams"
        case Wake():
            return "ticks"
        case OperatorLine() | OperatorNoise():
            return "operators' lines"
        case OperatorJoined() | OperatorGone():
            return "operators that came and went"
        case ClientCame() | ClientGone() | ClientFlooded():
            return "MAVLink clients that came and went"
        case FileRead() | FileWritten():
            return "files"
        case RuleSaid():
            return "answers of the operator's own rule"
        case LinkEvent():
            return "links' news"
        case RecorderChanged() | RecorderGrew() | DiskLow() | RecorderTurn():
            return "recorder's news"
        case SimLine() | SimGone():
            return "simulator's lines"
        case SignalCame():
            return "signals"
        case FaultKept():
            return "exceptions"
        case Unreadable():
            return "unreadable"


def told_input(given: Given) -> str:
    """What came in."""
    match given:
        case Datagram(link, data):
            names = [item.name if isinstance(item, Frame) else "garbage" for item in split(data)]
            return f"{_short(', '.join(names) or 'no bytes')} on link {link}"
        case Wake():
            return "a tick"
        case OperatorLine(client, command):
            return f"operator {client}: {_command(command)}"
        case OperatorNoise(client, text):
            return f"operator {client}, no command: {_short(text)}"
        case OperatorJoined(client, name):
            return f"operator {client} ({name}) joined"
        case OperatorGone(client, reason):
            return f"operator {client} went: {reason}"
        case ClientCame(link, name):
            return f"client {name} came on link {link}"
        case ClientGone(link, reason):
            return f"the client on link {link} went: {reason}"
        case ClientFlooded(link, dropped):
            return f"the client on link {link} flooded: {dropped} datagrams dropped"
        case FileRead(_, path, data):
            size = "not read" if data is None else f"{len(data)} bytes read"
            return f"{path}: {size}"
        case FileWritten(_, path, error):
            return f"{path}: {error or 'written'}"
        case RuleSaid(request_id, refusal):
            return f"the own rule on request {request_id}: {refusal or 'permitted'}"
        case SimLine(text):
            return f"the simulator printed {_short(text)!r}"
        case SimGone(exit_code):
            return f"the simulator ended with {exit_code}"
        case SignalCame(name):
            return name
        case LinkEvent(link, text):
            return f"link {link}: {text}"
        case RecorderChanged(_, _, text):
            return f"the recorder: {text}"
        case RecorderGrew(size_bytes):
            return f"{size_bytes} bytes are recorded"
        case DiskLow(free_bytes):
            return f"{free_bytes} bytes are left on the disk"
        case FaultKept(report):
            return f"an exception: {report.splitlines()[-1] if report else ''}"
        case RecorderTurn.TICK:
            return "the recorder's clock"
        case RecorderTurn.END:
            return "the record's end"
        case Unreadable(why):
            return f"an input that cannot be read: {why}"


def _command(command: ipc.Command) -> str:
    values = msgspec.to_builtins(command)
    defaults = {"type", "id", "word"}
    rest = " ".join(f"{k}={_value(v)}" for k, v in values.items() if k not in defaults)
    return f"{values.get('word', values['type'])} {rest}".rstrip()


# ---------------------------------------------------------------------------------- messages


def kind_of_message(message: Stored) -> str:
    """Under which name messages are counted."""
    if message.is_frame:
        return _FRAMES.get(message.data[1], "frame")
    if message.is_garbage:
        return "garbage"
    match message.topic.split("/"):
        case ["", "gate", "decision"]:
            return "decision"
        case ["", "log"]:
            return "log line"
        case ["", "session", "input"]:
            return "input"
        case ["", "vehicle", _, "fsa"]:
            return "state"
        case ["", "vehicle", _, "param"]:
            return "parameter"
        case _:
            return "picture"


def told_pair(pair: Pair) -> tuple[str, str]:
    """Recorded and reproduced; of two of a kind, what they are and where they differ."""
    recorded, reproduced = pair
    if recorded is None or reproduced is None:
        return _told(recorded), _told(reproduced)
    (title, left), (other, right) = _parts(recorded), _parts(reproduced)
    names = [n for n in dict.fromkeys((*left, *right)) if left.get(n) != right.get(n)]
    if not names:
        times = (message.log_time_ns for message in (recorded, reproduced))
        told = [f"{title} at {time_ns} ns" for time_ns in times]
        return told[0], told[1]
    return _listed(title, left, names), _listed(other, right, names)


def _told(message: Stored | None) -> str:
    if message is None:
        return "nothing"
    title, fields = _parts(message)
    return _listed(title, fields, list(fields))


def _listed(title: str, fields: Fields, names: list[str]) -> str:
    return _short(f"{title}: " + ", ".join(f"{n} {fields[n]}" for n in names if n in fields))


def _parts(message: Stored) -> tuple[str, Fields]:
    """What it is, and what it says, field by field."""
    if message.is_frame:
        return _frame(message)
    if message.is_garbage:
        return "garbage", {"bytes": message.raw.hex(" ")}
    if message.topic == LOG_TOPIC:
        _, node, line = read_log_line(message.data) or (0, "", "")
        return "log", {"line": line, "from": node}
    try:
        tree = msgspec.json.decode(message.data)
    except (msgspec.MsgspecError, UnicodeDecodeError):
        return message.topic, {
            "bytes": str(len(message.data)),
            "checksum": f"{crc32(message.data):08x}",
        }
    if not isinstance(tree, dict):
        return message.topic, {"value": _value(tree)}
    if message.topic == INPUT_TOPIC and isinstance(tree.get("data"), dict):
        return f"input {tree.get('kind')}", _flat(tree["data"])
    title = message.topic
    if "word" in tree and "request_id" in tree:
        title = f"#{tree['request_id']} {tree['word']}"
    return title, _flat(tree)


def _frame(message: Stored) -> tuple[str, Fields]:
    name = message.topic.rpartition("/")[2]
    items = split(message.raw)
    frame = items[0] if len(items) == 1 else None
    fields = {"link": str(message.data[0])}
    if not isinstance(frame, Frame):
        return f"{name}, damaged", {**fields, "bytes": message.raw.hex(" ")}
    fields["seq"] = str(frame.seq)
    decoded = decode(frame)
    if decoded is None:
        return name, {**fields, "payload": frame.payload.hex(" ")}
    return name, {**fields, **_flat(msgspec.to_builtins(decoded))}


def _flat(tree: Mapping[str, Any]) -> Fields:
    return {name: _value(value) for name, value in tree.items()}


def _value(value: Any) -> str:  # whatever JSON has
    if isinstance(value, float):
        return f"{value:.9g}"
    return value if isinstance(value, str) else msgspec.json.encode(value).decode()


def _short(text: str) -> str:
    return text if len(text) <= MOST_LETTERS else f"{text[:MOST_LETTERS]}…"
