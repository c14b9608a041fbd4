"""What was decided, told twice: to the operator and to the record.  Log lines are the gate's."""

from __future__ import annotations

import math

from gcs import ipc
from gcs.frames import Vec3, enu_from_ned
from gcs.gate import effects, requests
from gcs.gate.effects import Level
from gcs.gate.refusal import Refusal
from gcs.record.items import DecisionItem, FsaItem
from gcs.session.desk import Asked
from gcs.session.outbox import Outbox

NODE = "state_and_safety"


def requested(out: Outbox, asked: Asked, wish: requests.Request, now_ns: int) -> None:
    """A request arrived; for a goal the gate adds the lab's `Requested Position`."""
    if isinstance(wish, requests.GoTo):
        out.say(Level.INFO, "keyboard_manager", "Sending Position", now_ns)
    else:
        out.say(Level.INFO, NODE, f"Requested: {asked.word}", now_ns)


def verdict(
    out: Outbox,
    request_id: int,
    asked: Asked,
    sysid: int,
    outcome: effects.Ruling,
    refusal: Refusal | None,
    *,
    evidence: tuple[tuple[str, float], ...] = (),
    goal_ned: Vec3 | None = None,
) -> None:
    """Accepted, refused or superseded; with the numbers it was decided on."""
    numbers = refusal.numbers if refusal else evidence
    code = refusal.code.value if refusal else ""
    sentence = refusal.sentence if refusal else ""
    zone = refusal.zone if refusal else ""
    goal_enu = None if goal_ned is None else enu_from_ned(goal_ned)
    out.emit(
        ipc.VerdictEvent(
            asked.client_id,
            asked.word,
            outcome.value,
            code,
            sentence,
            zone,
            dict(numbers),
            goal_enu,
        )
    )
    out.record(
        DecisionItem(
            sysid,
            request_id,
            asked.source,
            asked.word,
            "verdict",
            outcome.value,
            code,
            sentence,
            zone,
            goal_ned,
            numbers,
        )
    )


def ending(out: Outbox, told: effects.Outcome, asked: Asked, sysid: int) -> None:
    """How an accepted request ended."""
    code = told.code.value if told.code else ""
    ended = told.kind.value
    out.emit(ipc.EndingEvent(asked.client_id, asked.word, ended, code, told.sentence))
    out.record(
        DecisionItem(
            sysid,
            told.request_id,
            asked.source,
            asked.word,
            "ending",
            ended,
            code,
            told.sentence,
            "",
            None,
            (),
        )
    )


def transition(out: Outbox, told: effects.Transition, goal_ned: Vec3 | None, sysid: int) -> None:
    """The machine moved."""
    before, after = told.before.name, told.after.name
    control, severity = told.control.name, told.severity.name
    out.emit(ipc.StateEvent(before, after, told.event, control, severity))
    out.record(
        FsaItem(sysid, int(told.after), after, before, told.event, control, severity, goal_ned)
    )


def triple(enu: Vec3) -> str:
    """(east, north, up) for a log line, without a negative zero."""
    return "(" + ", ".join(_number(value) for value in enu) + ")"


def _number(value: float) -> str:
    return f"{value:.2f}" if not math.isfinite(value) or abs(value) >= 0.005 else "0.00"
