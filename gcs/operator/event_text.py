"""How a station's events are written: one exact line each, that can be searched for."""

from __future__ import annotations

from gcs import ipc
from gcs.enu_text import signed_enu
from gcs.gate.refusal import Code
from gcs.operator.errors import error_lines

LEVELS = ("", "DEBUG", "INFO", "WARN", "ERROR", "FATAL")


def verdict_line(label: str, event: ipc.VerdictEvent) -> str:
    """`goto 500 0 2: refused OUTSIDE_FENCE: the goal is ...`, `arm: accepted`."""
    return answer_line(label, event.outcome, event.code, event.sentence)


def outcome_line(label: str, event: ipc.EndingEvent) -> str:
    """`goto 3 0 2: complete`, `goto 3 0 2: aborted OPERATOR: ...`."""
    return answer_line(label, event.ended, event.code, event.sentence)


def answer_line(label: str, what: str, code: str, sentence: str) -> str:
    """Label, what became of the request, and the reason if there is one."""
    coded = f"{what} {code}" if code else what
    why = reason(what, code, sentence)
    return f"{label}: {coded}: {why}" if why else f"{label}: {coded}"


def reason(what: str, code: str, sentence: str) -> str:
    """The sentence; empty if it only repeats `what`.

    Whoever can still read that the operator is lost is the operator, who left in good order.
    """
    if code == Code.OPERATOR_LOST:
        return sentence.replace("the operator is lost", "the operator left")
    return "" if sentence.lower() == what else sentence


def log_line(event: ipc.LogEvent) -> str:
    """`INFO  gate: HOVERING -> MOVING`."""
    return f"{LEVELS[event.level]:<5} {event.node}: {event.text}"


def trouble_lines(event: ipc.Trouble) -> list[str]:
    return error_lines(event.text, event.hint)


def bye_lines(bye: ipc.Bye) -> list[str]:
    """Where the vehicle is, and where the record."""
    lines = [f"gcs: {bye.sentence}"] if bye.sentence else []
    return [*lines, f"log: {bye.log_path}"] if bye.log_path else lines


def whole_degrees(yaw_deg: float) -> int:
    """A heading in whole degrees clockwise from north, 0 to 359."""
    return round(yaw_deg) % 360


def state_line(seen: ipc.Snapshot | None) -> str:
    """One line: state, control, severity, position in m, mode, motors, battery.

    `state: HOVERING, control OURS, severity NOMINAL, at E +0.00 N +0.00 U +2.00 m, ...`
    """
    if seen is None:
        return "state: nothing heard yet"
    armed = {None: "armed unknown", True: "armed", False: "disarmed"}[seen.armed]
    battery = "-" if seen.battery_pct is None else f"{seen.battery_pct:.0f}"
    return (
        f"state: {seen.state}, control {seen.control}, severity {seen.severity}, "
        f"at {signed_enu(seen.pos_enu)} m, mode {seen.mode or '-'}, {armed}, battery {battery} %"
    )
