"""The leg that is flown, in 3D, coloured by speed: /vehicle/N/leg.

Ahead of the vehicle by the speed that the gate's law of pace allows at each place, with a label
where that falls; behind it, broader, by the speed at which it was flown.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import dist, hypot, isfinite
from typing import ClassVar

from foxglove.messages import Color, SceneUpdate

from gcs.frames import Vec3, enu_from_ned
from gcs.mcap_file.writer import Channel
from gcs.record.derived.body_frames import FrameNames
from gcs.record.derived.drawing import Rgb, channel, clear, color, entity, label, line, stamp
from gcs.record.topics import Deriver, Grid, Out
from gcs.report import LegItem, PoseItem, RecordItem

DRAWN_HZ = 1.0
MOST_FLOWN = 60
"""Places behind the vehicle; a detour has no more."""
LEAST_STEP_M = 0.2
FALLS = 0.97
"""The label stands at the last place at which so much of the highest speed is allowed."""
LABEL_ABOVE_M = 0.6

_FAST: Rgb = (0.2, 0.95, 0.9)
_SLOW: Rgb = (0.55, 0.15, 0.85)


@dataclass(slots=True)
class _Leg:
    frame_id: str
    topic: Channel
    places_enu: list[Vec3] = field(default_factory=list)
    speeds_m_s: tuple[float, ...] = ()
    step_m: float = LEAST_STEP_M
    flown: list[tuple[Vec3, float]] = field(default_factory=list)
    grid: Grid = field(default_factory=lambda: Grid(DRAWN_HZ))


class LegScene(Deriver):
    """Once a second while a leg is flown."""

    takes: ClassVar = frozenset({LegItem, PoseItem})

    def __init__(self, names: FrameNames) -> None:
        self._names = names
        self._legs: dict[int, _Leg] = {}

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        match item:
            case LegItem():
                return [self._begun(item, now_ns)]
            case PoseItem(sysid, pos_ned, v_ned):
                leg = self._legs.get(sysid)
                if leg is None or not leg.places_enu or not all(map(isfinite, (*pos_ned, *v_ned))):
                    return []
                at = enu_from_ned(pos_ned)
                if len(leg.flown) < MOST_FLOWN and (
                    not leg.flown or dist(at, leg.flown[-1][0]) >= leg.step_m
                ):
                    leg.flown.append((at, hypot(*v_ned)))
                return [_drawn(leg, now_ns)] if leg.grid.due(now_ns) else []
            case _:
                return []

    def _begun(self, item: LegItem, now_ns: int) -> Out:
        leg = self._legs.get(item.sysid)
        if leg is None:
            topic = channel(f"/vehicle/{item.sysid}/leg", SceneUpdate.get_schema())
            leg = self._legs[item.sysid] = _Leg(self._names.of(item.sysid).enu, topic)
        leg.places_enu = [enu_from_ned(place_ned) for place_ned in item.places_ned]
        leg.speeds_m_s, leg.flown = item.speeds_m_s, []
        if not leg.places_enu:
            gone = SceneUpdate(deletions=clear(stamp(now_ns)))
            return Out(leg.topic, gone.encode(), latch="leg")
        length_m = dist(leg.places_enu[0], leg.places_enu[-1])
        leg.step_m = max(LEAST_STEP_M, 1.25 * length_m / MOST_FLOWN)
        leg.grid.due(now_ns)
        return _drawn(leg, now_ns)


def _drawn(leg: _Leg, now_ns: int) -> Out:
    flown_m_s = [speed_m_s for _, speed_m_s in leg.flown]
    fastest_m_s = max([0.1, *leg.speeds_m_s, *flown_m_s])

    def by_speed(speeds_m_s: list[float]) -> list[Color]:
        return [_between(speed_m_s / fastest_m_s) for speed_m_s in speeds_m_s]

    lines = [line(leg.places_enu, by_speed([*leg.speeds_m_s]), pixels=3.0)]
    if len(leg.flown) > 1:
        way = [at for at, _ in leg.flown]
        lines.append(line(way, by_speed(flown_m_s), pixels=7.0))
    most_m_s = max(leg.speeds_m_s)
    east, north, up = next(
        at
        for at, speed_m_s in zip(reversed(leg.places_enu), reversed(leg.speeds_m_s), strict=True)
        if speed_m_s >= FALLS * most_m_s
    )
    words = f"slows from {most_m_s:.1f} m/s"
    drawn = entity(
        "leg",
        stamp(now_ns),
        frame_id=leg.frame_id,
        lines=lines,
        texts=[label((east, north, up + LABEL_ABOVE_M), words, _FAST)],
    )
    return Out(leg.topic, SceneUpdate(entities=[drawn]).encode(), latch="leg")


def _between(share: float) -> Color:
    """The colour of a share of the highest speed."""
    red, green, blue = (
        slow + share * (fast - slow) for slow, fast in zip(_SLOW, _FAST, strict=True)
    )
    return color((red, green, blue))
