"""What of the vehicle's speed its reports do not show yet: it flies to a goal and gains speed.

Looked at where something else is asked for than the leg that is flown; see
`airspace/gained_speed.py`.
"""

from __future__ import annotations

import math
from typing import Final

from gcs.frames import Vec3
from gcs.gate.airspace.gained_speed import gained_velocity
from gcs.gate.airspace.stopping import Leg, stops_of
from gcs.gate.machine.memory import SECOND_NS, Memory
from gcs.gate.machine.turn import Turn

RISES_M_S: Final = 0.2
"""A report that is faster by this than all before it on the leg shows that it gains speed."""


def leg_begins(turn: Turn) -> None:
    """The vehicle is sent to another place: its reports show later how fast it flies there."""
    memory = turn.memory
    memory.leg_fastest_m_s, memory.gains_ns = _speed_h_m_s(memory), turn.now_ns


def velocity_seen(turn: Turn) -> None:
    """With every position."""
    memory, speed_m_s = turn.memory, _speed_h_m_s(turn.memory)
    if speed_m_s >= memory.leg_fastest_m_s + RISES_M_S:
        memory.leg_fastest_m_s, memory.gains_ns = speed_m_s, turn.now_ns


def leg_left(turn: Turn) -> None:
    """Something else than the leg is flown from now on: what was gained on it acts for a while."""
    memory = turn.memory
    gained = _gained(turn)
    if gained is not None:
        memory.gained_ned, memory.gained_until_ns = gained, turn.after_ns(_react_s(turn))


def may_have_gained(turn: Turn, to_ned: Vec3 | None) -> tuple[Vec3, ...]:
    """Velocities that the vehicle may have beside the reported one, if it is to do something else
    than to fly to where it flies already; `to_ned` is where that leads, if to a place."""
    memory, found = turn.memory, []
    if memory.gained_ned is not None and turn.now_ns < memory.gained_until_ns:
        found.append(memory.gained_ned)
    path = memory.path
    if isinstance(path, Leg) and path.goal_ned != to_ned:
        gained = _gained(turn)
        found += [] if gained is None else [gained]
    return tuple(found)


def _gained(turn: Turn) -> Vec3 | None:
    """None, too, where no report has shown more speed for so long that it has no more by now."""
    memory, path = turn.memory, turn.memory.path
    if not isinstance(path, Leg) or memory.pos_ned is None or memory.v_ned is None:
        return None
    if turn.now_ns >= memory.gains_ns + round(_react_s(turn) * SECOND_NS):
        return None
    stops = stops_of(turn.policy, memory.autopilot)
    return gained_velocity(memory.pos_ned, memory.v_ned, path, stops)


def _react_s(turn: Turn) -> float:
    return turn.policy.braking_of(turn.memory.autopilot).react_s


def _speed_h_m_s(memory: Memory) -> float:
    return 0.0 if memory.v_ned is None else math.hypot(memory.v_ned[0], memory.v_ned[1])
