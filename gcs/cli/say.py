"""How events read on a console: one exact, greppable line each."""

from __future__ import annotations

from gcs import ipc
from gcs.gate.refusal import Code

LEVELS = ("", "DEBUG", "INFO", "WARN", "ERROR", "FATAL")


def verdict_line(label: str, event: ipc.VerdictEvent) -> str:
    """`goto 500 0 2: refused OUTSIDE_FENCE: the goal is ...`, `arm: accepted`."""
    return told(label, event.outcome, event.code, event.sentence)


def ending_line(label: str, event: ipc.EndingEvent) -> str:
    """`goto 3 0 2: complete`, `goto 3 0 2: aborted OPERATOR: ...`."""
    return told(label, event.ended, event.code, event.sentence)


def told(label: str, what: str, code: str, sentence: str) -> str:
    """Label, what became of it, and why where there is a why."""
    coded = f"{what} {code}" if code else what
    why = reason(what, code, sentence)
    return f"{label}: {coded}: {why}" if why else f"{label}: {coded}"


def reason(what: str, code: str, sentence: str) -> str:
    """The sentence, but for one that only repeats `what`.

    Whoever can still read that the operator is lost is the operator, who left in good order.
    """
    if code == Code.OPERATOR_LOST and sentence.endswith("is lost"):
        return "the operator left"
    return "" if sentence.lower() == what else sentence


def log_line(event: ipc.LogEvent) -> str:
    """`INFO  gate: HOVERING -> MOVING`."""
    return f"{LEVELS[event.level]:<5} {event.node}: {event.text}"


def trouble_lines(event: ipc.Trouble) -> list[str]:
    lines = [f"gcs: {event.text}"]
    return [*lines, f"  hint: {event.hint}"] if event.hint else lines


def farewell_lines(bye: ipc.Bye) -> list[str]:
    """Where the vehicle is, and where the record."""
    lines = [f"gcs: {bye.sentence}"] if bye.sentence else []
    return [*lines, f"log: {bye.log_path}"] if bye.log_path else lines


def heading(yaw_deg: float) -> int:
    """Whole degrees clockwise from north, 0 to 359."""
    return round(yaw_deg) % 360


def enu(position: ipc.Vec3 | ipc.Maybe3 | None) -> str:
    """`E +1.00 N +0.00 U +2.00`, a dash for what is not known."""
    if position is None:
        return "E - N - U -"
    shown = ["-" if metres is None else f"{metres + 0.0:+.2f}" for metres in position]
    # -0.004 would read as -0.00, which is no number anybody means.
    shown = [text.replace("-0.00", "+0.00") for text in shown]
    return f"E {shown[0]} N {shown[1]} U {shown[2]}"


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
        f"at {enu(seen.pos_enu)} m, mode {seen.mode or '-'}, {armed}, battery {battery} %"
    )
