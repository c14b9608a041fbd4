"""Manual input (MANUAL_CONTROL, RC_CHANNELS_OVERRIDE) and the leader of FOLLOW_TARGET.

None of these has an ack; RC_CHANNELS, MANUAL_CONTROL and the flight tell what was heard.
"""

from __future__ import annotations

import math
from typing import Final, TypeAlias

from vehicle_sim.autopilot.interface import Geodetic, Vehicle
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.effects import Client
from vehicle_sim.numerics.vectors import Vec3
from vehicle_sim.wire import messages as m

ManualInput: TypeAlias = (
    m.ManualControl | m.RcChannelsOverride | m.FollowTarget | m.GlobalPositionInt
)

_POSITION_KNOWN: Final = 0x1  # FOLLOW_TARGET.est_capabilities
_VELOCITY_KNOWN: Final = 0x2
_NO_HEADING: Final = 65535
_FASTEST_M_S: Final = 1e3


def manual_input(
    vehicle: Vehicle,
    parameters: Parameters,
    system: int,
    client: Client,
    heard: ManualInput,
    wall_ns: int,
) -> None:
    """One such message.  ArduCopter lets only the station SYSID_MYGCS touch the sticks."""
    match heard:
        case m.ManualControl():
            if heard.target in (0, system) and _is_pilot(parameters, client):
                vehicle.joystick(heard.x, heard.y, heard.z, heard.r, wall_ns)
        case m.RcChannelsOverride():
            if _is_pilot(parameters, client):
                vehicle.override_channels((*heard[:8], *heard[10:20]), wall_ns)
        case m.FollowTarget():
            _follow_target(vehicle, client, heard, wall_ns)
        case m.GlobalPositionInt():
            if client.system != system:
                _other_vehicle(vehicle, parameters, client, heard, wall_ns)


def _other_vehicle(
    vehicle: Vehicle,
    parameters: Parameters,
    client: Client,
    heard: m.GlobalPositionInt,
    wall_ns: int,
) -> None:
    """ArduCopter's FOLL_ALT_TYPE 1 takes the height above the leader's home for one above ours."""
    alt_m = heard.alt * 1e-3
    home = vehicle.home
    by_home = parameters.rules.leader_height_by_home
    if by_home is not None and parameters.get(by_home) == 1 and home is not None:
        alt_m = home.alt_amsl_m + heard.relative_alt * 1e-3
    heading = None if heard.hdg == _NO_HEADING else math.radians(heard.hdg * 0.01)
    where = Geodetic(heard.lat * 1e-7, heard.lon * 1e-7, alt_m)
    v_ned = (heard.vx * 0.01, heard.vy * 0.01, heard.vz * 0.01)
    vehicle.hear_leader(client.system, where, v_ned, heading, wall_ns)


def _is_pilot(parameters: Parameters, client: Client) -> bool:
    own = parameters.rules.own_station
    return own is None or client.system == int(parameters.get(own))


def _follow_target(vehicle: Vehicle, client: Client, heard: m.FollowTarget, wall_ns: int) -> None:
    """Without a position it says nothing; without a velocity the leader stands."""
    v_ned: Vec3 = (0.0, 0.0, 0.0)
    if heard.est_capabilities & _VELOCITY_KNOWN:
        v_ned = (_speed(heard.vel[0]), _speed(heard.vel[1]), _speed(heard.vel[2]))
    where = Geodetic(heard.lat * 1e-7, heard.lon * 1e-7, heard.alt)
    on_earth = abs(where.lat_deg) <= 90.0 and abs(where.lon_deg) <= 180.0
    if heard.est_capabilities & _POSITION_KNOWN and on_earth and math.isfinite(heard.alt):
        vehicle.hear_leader(client.system, where, v_ned, None, wall_ns)


def _speed(given_m_s: float) -> float:
    """Clients leave NaN where they know nothing."""
    return given_m_s if abs(given_m_s) <= _FASTEST_M_S else 0.0
