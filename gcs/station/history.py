"""What has been told so far, for an operator who joins: the trail, the latest lines of the log, and
what is on board.  All of it bounded."""

from __future__ import annotations

import math
from collections import deque
from typing import Final

import msgspec

from gcs import ipc
from gcs.gate.effects import Level
from gcs.gate.states import LandedState
from gcs.report import LogEvent
from gcs.session.work import Log
from gcs.station.on_board import OnBoard

POINT_NS: Final = 1_000_000_000
POINTS: Final = 600
"""Ten minutes, one a second."""
LINES: Final = 200
_NOT_IN_AIR: Final = ("", LandedState.UNDEFINED.name, LandedState.ON_GROUND.name)


class History:
    """Of one vehicle; the lines of the log are told with that of the first."""

    def __init__(self) -> None:
        self._trail: deque[ipc.TrailPoint] = deque(maxlen=POINTS)
        self._lines: deque[LogEvent] = deque(maxlen=LINES)
        self.on_board = OnBoard()
        self._air_since_ns: int | None = None

    def logged(self, line: Log, now_ns: int, prefix: str) -> None:
        """`prefix` names the vehicle that it is of."""
        if line.level > Level.DEBUG:
            self._lines.append(LogEvent(now_ns, int(line.level), line.node, prefix + line.text))

    def seen(self, seen: ipc.Snapshot) -> None:
        """A snapshot that operators are told."""
        in_air = seen.armed is True and seen.landed not in _NOT_IN_AIR
        if not in_air:
            self._air_since_ns = None
        elif self._air_since_ns is None:
            self._air_since_ns = seen.time_ns
        if seen.pos_enu is None:
            return
        if self._trail and seen.time_ns - self._trail[-1].time_ns < POINT_NS:
            return
        east_m, north_m, up_m = (round(metres, 2) for metres in seen.pos_enu)
        speed_m_s = None if seen.v_enu is None else round(math.hypot(*seen.v_enu), 2)
        place = (east_m, north_m, up_m)
        point = ipc.TrailPoint(seen.time_ns, place, speed_m_s, seen.battery_pct, in_air)
        self._trail.append(point)

    def told(self) -> list[ipc.Event]:
        """For one that has just joined."""
        trail = msgspec.structs.replace(self.way(), log=[*self._lines])
        return [trail, *self.on_board.told()]

    def way(self) -> ipc.History:
        """The trail alone, for one that is shown this vehicle from now on."""
        return ipc.History([*self._trail], [], self._air_since_ns)
