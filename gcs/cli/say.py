"""How events read on a console: one exact, greppable line each."""

from __future__ import annotations

from gcs import ipc

LEVELS = ("", "DEBUG", "INFO", "WARN", "ERROR", "FATAL")


def verdict_line(label: str, event: ipc.VerdictEvent) -> str:
    """`goto 500 0 2: refused OUTSIDE_FENCE: the goal is ...`, `arm: accepted`."""
    return _told(label, event.outcome, event.code, event.sentence)


def ending_line(label: str, event: ipc.EndingEvent) -> str:
    """`goto 3 0 2: complete`, `goto 3 0 2: aborted OPERATOR: ...`."""
    return _told(label, event.ended, event.code, event.sentence)


def _told(label: str, what: str, code: str, sentence: str) -> str:
    coded = f"{what} {code}" if code else what
    return f"{label}: {coded}: {sentence}" if sentence else f"{label}: {coded}"


def log_line(event: ipc.LogEvent) -> str:
    """`INFO  gate: HOVERING -> MOVING`."""
    return f"{LEVELS[event.level]:<5} {event.node}: {event.text}"


def trouble_lines(event: ipc.Trouble) -> list[str]:
    lines = [f"gcs: {event.text}"]
    return [*lines, f"  hint: {event.hint}"] if event.hint else lines


def enu(position: ipc.Vec3 | ipc.Maybe3 | None) -> str:
    """`E +1.00 N +0.00 U +2.00`, a dash for what is not known."""
    if position is None:
        return "E - N - U -"
    shown = ["-" if metres is None else f"{metres + 0.0:+.2f}" for metres in position]
    # -0.004 would read as -0.00, which is no number anybody means.
    shown = [text.replace("-0.00", "+0.00") for text in shown]
    return f"E {shown[0]} N {shown[1]} U {shown[2]}"


def state_line(seen: ipc.Snapshot | None) -> str:
    """`state: HOVERING OURS NOMINAL E +0.00 N +0.00 U +2.00 OFFBOARD armed battery 98 %`."""
    if seen is None:
        return "state: nothing heard yet"
    armed = {None: "armed unknown", True: "armed", False: "disarmed"}[seen.armed]
    battery = "-" if seen.battery_pct is None else f"{seen.battery_pct:.0f}"
    return (
        f"state: {seen.state} {seen.control} {seen.severity} {enu(seen.pos_enu)} "
        f"{seen.mode or '-'} {armed} battery {battery} %"
    )
