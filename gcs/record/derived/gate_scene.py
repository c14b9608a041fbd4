"""What the gate decides and commands, in 3D: /gate/goals, /vehicle/N/{setpoint,target,stop}.

A goal is a ball, green where it is accepted and red where it is refused, with a line from the
vehicle and the reason as text; each vanishes after `GOAL_NS`.  The setpoint is drawn as axes; the
predicted stopping point as a ring, with the speed that is flown, the one that the law of pace
allows there, and how far the stop is.  Both vanish when they are no longer renewed.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import cos, dist, hypot, isfinite, pi, sin
from textwrap import wrap
from typing import ClassVar

from foxglove.messages import Pose, PoseInFrame, Quaternion, SceneUpdate, Vector3

from gcs.frames import Vec3, enu_from_ned
from gcs.mcap_file.writer import Channel
from gcs.record.derived.body_frames import FrameNames
from gcs.record.derived.drawing import Rgb, ball, channel, color, entity, label, line, stamp
from gcs.record.derived.gate_json import request_text
from gcs.record.topics import Deriver, Grid, Out
from gcs.report import DecisionItem, PoseItem, RecordItem, SetpointItem, StopItem

GOAL_NS = 4_000_000_000
MARKER_NS = 500_000_000
MARKER_HZ = 5.0
SHORTEST_STOP_M = 0.3
"""A shorter way to stop is not drawn."""
RING_M = 0.6
LABEL_BELOW_M = 0.8
RING_CORNERS = 12
FARTHEST_LABEL_M = 30.0
"""The label of a goal that is farther away stands this far from the vehicle, to be in the view."""
LABEL_WIDTH = 40
LABEL_LINES = 3

_GREEN = (0.13, 0.85, 0.37)
_RED = (0.95, 0.2, 0.18)
_AMBER = (1.0, 0.7, 0.1)
_COLORS = {"accepted": _GREEN, "complete": _GREEN, "refused": _RED}
_AXES: tuple[tuple[Rgb, float], ...] = (((0.9, 0.2, 0.2), 0.0), ((0.3, 0.8, 0.3), pi / 2))
_UP = (0.3, 0.5, 1.0)


@dataclass(slots=True)
class _Vehicle:
    frame_id: str
    setpoint: Channel
    target: Channel
    stop: Channel
    pos_enu: Vec3 | None = None
    speed_m_s: float = 0.0
    target_grid: Grid = field(default_factory=lambda: Grid(MARKER_HZ))
    stop_grid: Grid = field(default_factory=lambda: Grid(MARKER_HZ))


class GateScene(Deriver):
    """Every decision and every setpoint; the two markers at 5 Hz."""

    takes: ClassVar = frozenset({DecisionItem, PoseItem, SetpointItem, StopItem})

    def __init__(self, names: FrameNames) -> None:
        self._names = names
        self._vehicles: dict[int, _Vehicle] = {}
        self._goals = channel("/gate/goals", SceneUpdate.get_schema())

    def start(self, now_ns: int) -> list[Out]:
        return [Out(self._goals, SceneUpdate().encode())]

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        match item:
            case PoseItem(sysid, pos_ned, v_ned):
                if all(map(isfinite, (*pos_ned, *v_ned))):
                    vehicle = self._vehicle(sysid)
                    vehicle.pos_enu, vehicle.speed_m_s = enu_from_ned(pos_ned), hypot(*v_ned)
                return []
            case DecisionItem():
                return self._decision(item, now_ns)
            case SetpointItem():
                return _setpoint(self._vehicle(item.sysid), item, now_ns)
            case StopItem():
                return _stop(self._vehicle(item.sysid), item, now_ns)
            case _:
                return []

    def _decision(self, item: DecisionItem, now_ns: int) -> list[Out]:
        """A goal, or what was refused or ended without one, at the vehicle."""
        vehicle = self._vehicles.get(item.vehicle)
        pos_enu = None if vehicle is None else vehicle.pos_enu
        goal = item.goal.enu if item.goal is not None else None
        if goal is not None and not all(map(isfinite, goal)):
            goal = None
        at = goal or pos_enu
        if at is None or (goal is None and item.outcome in ("accepted", "complete")):
            return []
        rgb = _COLORS.get(item.outcome, _AMBER)
        away_m = 0.0 if pos_enu is None else dist(pos_enu, at)
        size_m = min(2.0, max(0.3, 0.05 * away_m))
        drawn = entity(
            f"{item.phase} {item.request_id}",
            stamp(now_ns),
            GOAL_NS,
            frame_id="map" if vehicle is None else vehicle.frame_id,
            spheres=[ball(at, size_m, color(rgb, 0.9))] if goal is not None else [],
            lines=[line([pos_enu, at], color(rgb, 0.8))] if pos_enu and goal is not None else [],
            texts=[label(_label_place(pos_enu, at, away_m), _words(item), rgb)],
        )
        return [Out(self._goals, SceneUpdate(entities=[drawn]).encode())]

    def _vehicle(self, sysid: int) -> _Vehicle:
        known = self._vehicles.get(sysid)
        if known is None:
            base = f"/vehicle/{sysid}"
            known = self._vehicles[sysid] = _Vehicle(
                self._names.of(sysid).enu,
                setpoint=channel(f"{base}/setpoint", PoseInFrame.get_schema()),
                target=channel(f"{base}/target", SceneUpdate.get_schema()),
                stop=channel(f"{base}/stop", SceneUpdate.get_schema()),
            )
        return known


def _words(item: DecisionItem) -> str:
    """`goto 3 0 2`, or `REFUSED OUTSIDE_FENCE: 350.2 m outside home`."""
    if item.outcome == "accepted":
        return request_text(item)
    outcome = item.outcome.upper()
    text = outcome if item.code in ("", outcome) else f"{outcome} {item.code}"
    text = f"{text}: {item.sentence or request_text(item)}"
    return "\n".join(wrap(text, LABEL_WIDTH, max_lines=LABEL_LINES, placeholder=" …"))


def _label_place(pos_enu: Vec3 | None, at: Vec3, away_m: float) -> Vec3:
    if pos_enu is None or away_m <= FARTHEST_LABEL_M:
        return (at[0], at[1], at[2] + 0.6 + 0.03 * away_m)
    share = FARTHEST_LABEL_M / away_m
    east, north, up = (
        here + share * (there - here) for here, there in zip(pos_enu, at, strict=True)
    )
    return (east, north, up + 1.5)


def _setpoint(vehicle: _Vehicle, item: SetpointItem, now_ns: int) -> list[Out]:
    at = enu_from_ned(item.pos_ned)
    east, north, up = at
    # A heading, clockwise from north, turns anticlockwise from east in `map`; None faces east.
    known = item.yaw_rad is not None and isfinite(item.yaw_rad)
    turn = pi / 2 - item.yaw_rad if item.yaw_rad is not None and known else 0.0
    pose = Pose(
        position=Vector3(x=round(east, 3), y=round(north, 3), z=round(up, 3)),
        orientation=Quaternion(z=sin(turn / 2), w=cos(turn / 2)),
    )
    time = stamp(now_ns)
    frame_id = vehicle.frame_id
    message = PoseInFrame(timestamp=time, frame_id=frame_id, pose=pose)
    outs = [Out(vehicle.setpoint, message.encode())]
    if vehicle.target_grid.due(now_ns):
        axes = [
            line([at, (east + cos(turn + a), north + sin(turn + a), up)], color(rgb), pixels=3.0)
            for rgb, a in _AXES
        ]
        axes.append(line([at, (east, north, up + 1.0)], color(_UP), pixels=3.0))
        drawn = entity("setpoint", time, MARKER_NS, frame_id=frame_id, lines=axes)
        outs.append(Out(vehicle.target, SceneUpdate(entities=[drawn]).encode()))
    return outs


def _stop(vehicle: _Vehicle, item: StopItem, now_ns: int) -> list[Out]:
    """The way that the vehicle still needs to come to rest, and a ring where it would."""
    here, there = enu_from_ned(item.pos_ned), enu_from_ned(item.stop_ned)
    stop_m = dist(here, there)
    if stop_m < SHORTEST_STOP_M or not vehicle.stop_grid.due(now_ns):
        return []
    allowed = "" if item.allowed_m_s is None else f" of {item.allowed_m_s:.1f}"
    words = f"{vehicle.speed_m_s:.1f}{allowed} m/s, stop {stop_m:.1f} m"
    radius_m = RING_M
    turns = [2 * pi * i / RING_CORNERS for i in range(RING_CORNERS)]
    ring = [(there[0] + radius_m * cos(a), there[1] + radius_m * sin(a), there[2]) for a in turns]
    lines = [line([here, there], color(_AMBER)), line(ring, color(_AMBER), closed=True)]
    texts = [label((there[0], there[1], there[2] - LABEL_BELOW_M), words, _AMBER)]
    drawn = entity(
        *("stop", stamp(now_ns), MARKER_NS), frame_id=vehicle.frame_id, lines=lines, texts=texts
    )
    return [Out(vehicle.stop, SceneUpdate(entities=[drawn]).encode())]
