"""Mode, position, battery and link, the two goals side by side, and the gate's last word."""

from __future__ import annotations

import math
import textwrap

import msgspec
from rich.text import Text

from gcs import ipc
from gcs.enu_text import signed_enu
from gcs.gate.condition import Condition
from gcs.operator.text.control_text import control_words
from gcs.operator.text.event_text import whole_degrees
from gcs.tui import flight_numbers, look
from gcs.tui.scene import REFUSED, Scene

OLD_POSITION_S = 0.5
OLD_HEARTBEAT_S = 2.5
LOW_BATTERY_PCT = 25.0
VALUE_COLUMNS = 27
FLIGHT_ROWS = -3
"""Before the battery and the link."""
SHOWN_OFF_M = 0.3
NEAR_FENCE_M = 5.0
SHORT_MIN = 3.0


def draw(scene: Scene) -> Text:
    """Rows of 32 cells, the most needed first: a small screen cuts the last ones."""
    seen = scene.snapshot
    panel = Text(no_wrap=True, end="", overflow="ellipsis")
    if seen is None or not seen.vehicle:
        panel.append("no vehicle heard yet\n", look.WARN)
        for endpoint in scene.talk.hello.endpoints if scene.talk.hello else ["starting the link …"]:
            panel.append(f"{endpoint}\n", look.DIM)
        panel.append("start one: vehicle-sim, gcs fly --sim\n", look.DIM)
        panel.append("or name its link: --link URL\n", look.DIM)
        return panel
    told = rows(seen, scene.talk.number, lost=scene.lost)
    told[FLIGHT_ROWS:FLIGHT_ROWS] = _flight(scene, seen)
    for name, value, style in told:
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
        *[("cond" if n == 0 else "", line, look.WARN) for n, line in enumerate(_conditions(seen))],
        ("pos", signed_enu(seen.pos_enu), look.VEHICLE),
        ("", f"{speed} {heading} age {position_age}", _if(seen.position_age_s, OLD_POSITION_S)),
        ("gps", seen.gps or "-", _gps_style(seen)),
        ("ekf", seen.estimator or "-", look.PLAIN if seen.estimator in ("", "ok") else look.BAD),
        ("batt", _battery(seen), _battery_style(seen.battery_pct)),
        ("link", f"{seen.rx_hz:.0f} Hz, {seen.lost_pct:.1f} % lost", look.PLAIN),
        (
            "",
            f"heard {_age(seen.heartbeat_age_s)}, sent {seen.setpoint_hz:.0f} Hz",
            _if(seen.heartbeat_age_s, OLD_HEARTBEAT_S),
        ),
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


def ahead(scene: Scene) -> Text:
    """One line: what the gate would say to Enter, or what a typed line still needs."""
    typed, asked = scene.typed, scene.ahead
    if not scene.heard_vehicle or scene.lost or (scene.velocity is not None and typed is None):
        return Text("")
    ask = scene.pending.ask
    if typed is not None:
        if typed.ask is None:
            return Text(typed.hint, look.DIM, no_wrap=True, overflow="ellipsis")
        ask, asked = typed.ask, scene.typed_ahead
    return Text(asked.words(ask), look.AHEAD[asked.of(ask)], no_wrap=True, overflow="ellipsis")


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


def _conditions(seen: ipc.Snapshot) -> list[str]:
    words = ", ".join(each.replace("_", " ") for each in seen.conditions)
    return textwrap.wrap(words, VALUE_COLUMNS, max_lines=2, placeholder=" …")


def _flight(scene: Scene, seen: ipc.Snapshot) -> list[tuple[str, str, str]]:
    """What is reckoned: how far it is, how long it has flown and will, what the wind does."""
    numbers, limit_pct = scene.numbers, scene.battery_low_pct
    home_m, fence_m = flight_numbers.home_m(seen), flight_numbers.fence_m(scene.zones, seen.pos_enu)
    left, off_m = numbers.minutes_left(limit_pct), flight_numbers.off_goal_m(seen)
    far = [f"home {_metres(home_m)}", f"fence {_metres(fence_m)}"]
    wind = "" if scene.wind is None else scene.wind.words(scene.now_ns)
    drift = "" if off_m is None or off_m < SHOWN_OFF_M else f"off by {off_m:.1f} m"
    time = f"flown {numbers.flown_ns // 60_000_000_000}:{numbers.flown_ns // 10**9 % 60:02d}"
    if left is not None:
        time += f", {left:.0f} min to {limit_pct:.0f} %"
    near = fence_m is not None and fence_m < NEAR_FENCE_M
    short = left is not None and left < SHORT_MIN
    told = [
        ("far", ", ".join(far), look.WARN if near else look.PLAIN),
        ("time", time, look.WARN if short else look.PLAIN),
    ]
    if wind or drift:
        told.append(("wind", " ".join(filter(None, (wind, drift))), _drift_style(off_m)))
    return told


def _metres(metres: float | None) -> str:
    return "-" if metres is None else f"{metres:.0f} m" if metres >= 10.0 else f"{metres:.1f} m"


def _drift_style(off_m: float | None) -> str:
    return look.WARN if off_m is not None and off_m >= 1.0 else look.PLAIN


def _gps_style(seen: ipc.Snapshot) -> str:
    if Condition.GPS_LOST in seen.conditions:
        return look.BAD
    return look.WARN if Condition.GPS_POOR in seen.conditions else look.PLAIN


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
