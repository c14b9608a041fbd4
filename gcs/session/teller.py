"""What was decided, told twice: to the operator and to the record."""

from __future__ import annotations

import math

from gcs import ipc
from gcs.frames import Vec3, enu_from_ned
from gcs.gate import effects
from gcs.gate.effects import Level
from gcs.gate.machine.gate import Gate
from gcs.gate.requests import GoTo, Request
from gcs.record.items import DecisionItem, FsaItem, LogItem
from gcs.session.effects import Effect, Emit, Record
from gcs.session.requests import Asked
from gcs.session.work import Decide, Log

NODE = "state_and_safety"


def log(line: Log, now_ns: int) -> list[Effect]:
    """One line, to the screen and to the record."""
    level = int(line.level)
    return [
        Emit(ipc.LogEvent(now_ns, level, line.node, line.text)),
        Record(LogItem(level, line.node, line.text)),
    ]


def requested(asked: Asked, request: Request) -> Log:
    """A request arrived; for a goal the gate adds the lab's `Requested Position`."""
    if isinstance(request, GoTo):
        return Log(Level.INFO, "keyboard_manager", "Sending Position")
    return Log(Level.INFO, NODE, f"Requested: {asked.word}")


def verdict(told: Decide, asked: Asked, sysid: int) -> list[Effect]:
    """Accepted, refused or superseded; with the numbers it was decided on."""
    refusal = told.refusal
    numbers = refusal.numbers if refusal else told.evidence
    code = refusal.code.value if refusal else ""
    sentence = refusal.sentence if refusal else ""
    zone = refusal.zone if refusal else ""
    goal_enu = None if told.goal_ned is None else enu_from_ned(told.goal_ned)
    ruling = told.ruling.value
    event = ipc.VerdictEvent(
        asked.client_id, asked.word, ruling, code, sentence, zone, dict(numbers), goal_enu
    )
    item = DecisionItem(
        sysid,
        told.request_id,
        asked.source,
        asked.word,
        "verdict",
        ruling,
        code,
        sentence,
        zone,
        told.goal_ned,
        numbers,
    )
    return [Emit(event), Record(item)]


def outcome(told: effects.Outcome, asked: Asked, sysid: int) -> list[Effect]:
    """How an accepted request ended."""
    code = told.code.value if told.code else ""
    kind = told.kind.value
    item = DecisionItem(
        sysid,
        told.request_id,
        asked.source,
        asked.word,
        "ending",
        kind,
        code,
        told.sentence,
        "",
        None,
        (),
    )
    event = ipc.EndingEvent(asked.client_id, asked.word, kind, code, told.sentence)
    return [Emit(event), Record(item)]


def transition(told: effects.Transition, goal_ned: Vec3 | None, sysid: int) -> list[Effect]:
    """The gate's state machine went to another state."""
    before, after = told.before.name, told.after.name
    control, severity = told.control.name, told.severity.name
    item = FsaItem(sysid, int(told.after), after, before, told.event, control, severity, goal_ned)
    return [Emit(ipc.StateEvent(before, after, told.event, control, severity)), Record(item)]


def reminder(gate: Gate, sysid: int) -> list[Effect]:
    """The state once more: a state bar in a viewer ends at its last message."""
    state = gate.state
    item = FsaItem(
        sysid,
        int(state),
        state.name,
        state.name,
        "reminder",
        gate.control.name,
        gate.severity.name,
        gate.active_goal_ned,
    )
    return [Record(item)]


def triple(enu: Vec3) -> str:
    """(east, north, up) for a log line, without a negative zero."""
    return "(" + ", ".join(_number(value) for value in enu) + ")"


def _number(value: float) -> str:
    return f"{value:.2f}" if not math.isfinite(value) or abs(value) >= 0.005 else "0.00"
