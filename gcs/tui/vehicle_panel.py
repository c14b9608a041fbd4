"""Mode, position, battery and link, the two goals side by side, and the gate's last word."""

from __future__ import annotations

import math
import textwrap

import msgspec
from rich.text import Text

from gcs import ipc
from gcs.enu_text import signed_enu
from gcs.gate.condition import Condition
from gcs.operator.control_text import control_words
from gcs.operator.event_text import whole_degrees
from gcs.tui import look
from gcs.tui.scene import REFUSED, Scene

OLD_POSITION_S = 0.5
OLD_HEARTBEAT_S = 2.5
LOW_BATTERY_PCT = 25.0


def draw(scene: Scene) -> Text:
    """Eight rows of 32 cells, and one for conditions that are not nominal."""
    seen = scene.snapshot
    panel = Text(no_wrap=True, end="")
    if seen is None or not seen.vehicle:
        panel.append("no vehicle heard yet\n", look.WARN)
        for endpoint in scene.talk.hello.endpoints if scene.talk.hello else ["starting the link …"]:
            panel.append(f"{endpoint}\n", look.DIM)
        panel.append("start one: vehicle-sim, gcs fly --sim\n", look.DIM)
        panel.append("or name its link: --link URL\n", look.DIM)
        return panel
    for name, value, style in rows(seen, scene.talk.number, lost=scene.lost):
        panel.append(f"{name:<5}", look.DIM)
        panel.append(value, style)
        panel.append("\n")
    return panel


def rows(seen: ipc.Snapshot, number: int, *, lost: bool = False) -> list[tuple[str, str, str]]:
    """Name, value, style, for operator `number`.  Of a vehicle that is lost the ages are
    bright and all else is dim."""
    shown = _rows(msgspec.structs.replace(seen, rx_hz=0.0) if lost else seen, number)
    if not lost:
        return shown
    return [(name, value, style if style == look.BAD else look.DIM) for name, value, style in shown]


def _rows(seen: ipc.Snapshot, number: int) -> list[tuple[str, str, str]]:
    armed = {None: "arm?", True: "ARMED", False: "disarmed"}[seen.armed]
    speed = "-" if seen.v_enu is None else f"{math.hypot(*seen.v_enu):.1f} m/s"
    heading = "-" if seen.yaw_deg is None else f"{whole_degrees(seen.yaw_deg):03d}°"
    position_age = _age(seen.position_age_s)
    return [
        ("mode", f"{seen.mode or '-'} {armed}", look.WARN if seen.armed else look.PLAIN),
        (
            "ctrl",
            f"{control_words(seen, number, short=True)}, {seen.control} {seen.severity}",
            look.SEVERITY.get(seen.severity, look.BAD),
        ),
        ("pos", signed_enu(seen.pos_enu), look.VEHICLE),
        ("", f"{speed} {heading} age {position_age}", _if(seen.position_age_s, OLD_POSITION_S)),
        ("batt", _battery(seen), _battery_style(seen.battery_pct)),
        ("link", f"{seen.rx_hz:.0f} Hz, {seen.lost_pct:.1f} % lost", look.PLAIN),
        (
            "",
            f"heard {_age(seen.heartbeat_age_s)}, sent {seen.setpoint_hz:.0f} Hz",
            _if(seen.heartbeat_age_s, OLD_HEARTBEAT_S),
        ),
        ("gps", _position_health(seen), _position_health_style(seen)),
        *([("cond", ", ".join(seen.conditions), look.WARN)] if seen.conditions else []),
    ]


def goals(scene: Scene) -> Text:
    """One line: what is pending, by which step, and what is flown."""
    pending, seen = scene.pending, scene.snapshot
    yaw = "" if pending.yaw_deg is None else f" {pending.yaw_deg:03.0f}°"
    line = Text(no_wrap=True, end="", overflow="ellipsis")
    if scene.velocity is not None:
        line.append(f"◇ velocity mode: keys fly {pending.step_m:g} m/s, y ends it", look.PENDING)
    else:
        line.append(f"◇ pending {signed_enu(pending.goal_enu)}{yaw}", look.PENDING)
        line.append(f" ±{pending.step_m:g} m", look.DIM)
    active = scene.active_enu
    line.append("  ◉ active ", look.ACTIVE)
    line.append(signed_enu(active) if active else "none", look.ACTIVE if active else look.DIM)
    if seen is not None and seen.mission_total:
        item = "-" if seen.mission_seq is None else str(seen.mission_seq)
        line.append(f"  mission {item}/{seen.mission_total}", look.DIM)
    return line


def answer(scene: Scene, columns: int) -> Text:
    """The gate's last word, or a transfer under way, on as many lines as `answer_rows` says."""
    if scene.progress is not None and scene.answer.kind != REFUSED:
        p = scene.progress
        return Text(f"… {p.what}: {p.done:g} of {p.total:g} {p.unit}", look.ACTIVE, end="")
    style = look.ANSWER.get(scene.answer.kind, look.DIM)
    return Text("\n".join(_answer_lines(scene, columns)), style, no_wrap=True, overflow="ellipsis")


def answer_rows(scene: Scene, columns: int) -> int:
    """1 or 2: a sentence with its numbers seldom fits one line of 80."""
    if scene.progress is not None and scene.answer.kind != REFUSED:
        return 1
    return len(_answer_lines(scene, columns))


def _answer_lines(scene: Scene, columns: int) -> list[str]:
    text = scene.answer.text or "nothing asked lately"
    if len(text) <= columns:
        return [text]
    return textwrap.wrap(text, max(columns, 20), max_lines=2, placeholder=" …") or [text]


def _age(age_s: float | None) -> str:
    return "-" if age_s is None else f"{age_s:.1f} s"


def _if(age_s: float | None, old_s: float) -> str:
    return look.PLAIN if age_s is not None and age_s <= old_s else look.BAD


def _position_health(seen: ipc.Snapshot) -> str:
    """The GPS and the estimator, in their words."""
    if seen.estimator in ("", "ok"):
        return f"{seen.gps or '-'}, EKF {seen.estimator or '-'}"
    return f"EKF: {seen.estimator}"


def _position_health_style(seen: ipc.Snapshot) -> str:
    bad = seen.estimator not in ("", "ok") or Condition.GPS_LOST in seen.conditions
    return look.BAD if bad else look.PLAIN


def _battery(seen: ipc.Snapshot) -> str:
    if seen.battery_pct is None:
        return "-"
    filled = round(min(max(seen.battery_pct, 0.0), 100.0) / 10)
    volts = "" if seen.battery_v is None else f" {seen.battery_v:.1f} V"
    return f"{'█' * filled}{'░' * (10 - filled)} {seen.battery_pct:.0f} %{volts}"


def _battery_style(pct: float | None) -> str:
    if pct is None:
        return look.DIM
    return look.BAD if pct < LOW_BATTERY_PCT else look.GOOD
