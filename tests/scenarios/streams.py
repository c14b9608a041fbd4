"""What the recorder streamed at 20 Hz, which the steps of a recording tell in words.

Times are those of the steps, or of what followed from them; where the recording does not tell when
a stream began, it is the second before the mode that needs it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

from pymavlink.dialects.v20 import all as mavlink

from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.numerics.vectors import Vec3

PERIOD_S: Final = 0.05
_BY_VELOCITY: Final = 0x0DC7  # SET_POSITION_TARGET's mask: no more than the velocity counts
_BY_POSITION: Final = 0x09F8  # position and yaw
_LOCAL_NED: Final = 1
_END_S: Final = 1e9


@dataclass(frozen=True)
class Sticks:
    """MANUAL_CONTROL."""

    forward: int = 0
    up: int = 500


@dataclass(frozen=True)
class Override:
    """RC_CHANNELS_OVERRIDE of roll, pitch, throttle, yaw; all eight `other` where it is given."""

    pitch: int = 1500
    other: int | None = None


@dataclass(frozen=True)
class Velocity:
    """A velocity setpoint northwards [m/s]."""

    north_m_s: float


@dataclass(frozen=True)
class Place:
    """A position setpoint: so far from where the vehicle was when the first of them was sent."""

    from_first_ned: Vec3 = (0.0, 0.0, 0.0)
    yaw_rad: float = 0.0


Stream = Sticks | Override | Velocity | Place
_NORTH: Final = Velocity(3.0)
_CENTRED: Final = Sticks()


def _steps(velocity_s: float, *times: float) -> tuple[tuple[float, float, Stream], ...]:
    """Hover, 10 m north, 5 m up, down again, a quarter turn; 3 m/s north for five seconds."""
    goals = (
        Place(),
        Place((10.0, 0.0, 0.0)),
        Place((10.0, 0.0, -5.0)),
        Place((10.0, 0.0, 0.0)),
        Place((10.0, 0.0, 0.0), 1.5708),
    )
    ends = (*times[1:], velocity_s)
    placed = tuple((begin, end, goal) for begin, end, goal in zip(times, ends, goals, strict=True))
    return (*placed, (velocity_s, velocity_s + 5.0, _NORTH))


STREAMS: Final[dict[tuple[Personality, str], tuple[tuple[float, float, Stream], ...]]] = {
    ("px4", "B1_posctl_takeoff_stream_stops_0.6s"): (
        (0.6, 3.76, _CENTRED),
        (3.76, 5.11, Sticks(up=900)),
    ),
    ("px4", "B2_posctl_stream_stops_in_flight"): (
        (10.3, 14.4, _CENTRED),
        (14.4, 16.42, Sticks(forward=500)),
        (41.43, 46.45, _CENTRED),
        (46.45, _END_S, Sticks(forward=700)),
    ),
    ("px4", "B3_posctl_stream_returns_in_delay"): (
        (10.3, 13.6, _CENTRED),
        (16.11, 23.2, _CENTRED),
    ),
    ("px4", "F3_px4_circle_fresh"): ((11.2, 31.0, _NORTH),),
    ("px4", "F4_velocity_against_circle"): ((11.5, 26.6, _NORTH),),
    ("px4", "F5b_gf_action_return"): ((11.2, _END_S, _NORTH),),
    ("px4", "F5c_gf_action_land"): ((11.2, _END_S, _NORTH),),
    ("px4", "F5d_gf_action_none"): ((11.2, _END_S, _NORTH),),
    ("px4", "I1_step_response"): _steps(77.01, 16.0, 23.06, 41.58, 51.8, 68.0),
    ("px4", "I1_step_response (again)"): _steps(77.05, 16.0, 23.12, 32.02, 47.52, 68.05),
    ("ardupilot", "B5_rc_override_stops"): (
        (10.3, 15.6, Override()),
        (15.6, 18.61, Override(pitch=1400)),
    ),
    ("ardupilot", "B6_rc_override_released"): (
        (10.0, 13.21, Override()),
        (13.21, 13.5, Override(other=0)),
        (19.22, 19.5, Override(other=65535)),
    ),
    ("ardupilot", "B7_rc_override_stops_no_receiver"): (
        (10.0, 17.31, Override()),
        (29.34, _END_S, Override()),
    ),
    ("ardupilot", "B8_manual_control_ap"): (
        (10.0, 13.2, _CENTRED),
        (13.2, 17.24, Sticks(forward=500)),
    ),
    ("ardupilot", "I1_step_response"): _steps(56.5, 16.0, 18.25, 27.48, 36.28, 47.5),
    ("ardupilot", "I1_step_response (again)"): _steps(56.0, 16.0, 18.23, 26.97, 35.76, 47.0),
    ("ardupilot", "F2c_fly_out_of_polygon"): ((12.0, _END_S, _NORTH),),
    ("ardupilot", "F4_velocity_against_circle"): ((11.0, 25.0, _NORTH),),
    ("ardupilot", "F9_velocity_without_avoidance"): ((12.0, _END_S, _NORTH),),
    **{
        ("ardupilot", f"F9b_action_{action}"): ((12.0, _END_S, _NORTH),)
        for action in ("0_report", "2_land", "3_smartrtl", "4_brake", "5_smartrtl_or_land")
    },
}
"""By autopilot and scenario: from when, to when, and what."""


def message(stream: Stream, first_ned: Vec3) -> Any:
    """One message of it, to system 1; `first_ned`: where the vehicle was at the stream's start."""
    match stream:
        case Sticks(forward, up):
            return mavlink.MAVLink_manual_control_message(1, forward, 0, up, 0, 0)
        case Override(pitch, other):
            four = (1500, pitch, 1500, 1500)
            values = (other,) * 8 if other is not None else (*four, *(65535,) * 4)
            return mavlink.MAVLink_rc_channels_override_message(1, 1, *values)
        case Velocity(north_m_s):
            where, speed, mask, yaw_rad = (0.0, 0.0, 0.0), north_m_s, _BY_VELOCITY, 0.0
        case Place(offset, yaw_rad):
            n, e, d = (at + by for at, by in zip(first_ned, offset, strict=True))
            where, speed, mask = (n, e, d), 0.0, _BY_POSITION
    return mavlink.MAVLink_set_position_target_local_ned_message(
        0, 1, 1, _LOCAL_NED, mask, *where, speed, 0.0, 0.0, 0.0, 0.0, 0.0, yaw_rad, 0.0
    )
