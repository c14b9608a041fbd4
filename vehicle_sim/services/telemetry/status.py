"""Builders of what says how well it flies, and on what: navigation, heights, air, board."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final, TypeAlias

from vehicle_sim.autopilot.interface import Vehicle
from vehicle_sim.numerics.vectors import euler_rad
from vehicle_sim.services.profile import Profile
from vehicle_sim.services.units import UINT16_MAX, clip_uint16, usec
from vehicle_sim.wire import messages as m

Builder: TypeAlias = Callable[[Vehicle, Profile], m.Message | None]

BOARD_MV: Final = 5000
BRICK_VALID: Final = 0x1  # MAV_POWER_STATUS_BRICK_VALID
FREE_BYTES: Final = 131_072
WIND_STD_M_S: Final = 0.5
"""Of the horizontal wind: what the bias of the accelerometer makes of it."""


def nav_controller_output(vehicle: Vehicle, profile: Profile) -> m.NavControllerOutput:
    """ArduPilot's; attitude and bearings in degrees, the distance is horizontal."""
    estimate, goal = vehicle.estimate, vehicle.attitude_goal
    roll, pitch = (0.0, 0.0) if goal is None else euler_rad(goal.q_ned_from_frd)[:2]
    bearing_deg, away_m, above_m = 0, 0.0, 0.0
    target_ned = vehicle.target.pos_ned
    if target_ned is not None:
        north, east, down = (
            there - here for there, here in zip(target_ned, estimate.pos_ned, strict=True)
        )
        away_m, above_m = math.hypot(north, east), -down
        bearing_deg = round(math.degrees(math.atan2(east, north)))
    return m.NavControllerOutput(
        nav_roll=math.degrees(roll),
        nav_pitch=math.degrees(pitch),
        alt_error=above_m,
        aspd_error=0.0,
        xtrack_error=0.0,
        nav_bearing=bearing_deg,
        target_bearing=bearing_deg,
        wp_dist=clip_uint16(away_m),
    )


def altitude(vehicle: Vehicle, profile: Profile) -> m.Altitude | None:
    """PX4's; NaN for what it has no sensor for."""
    if vehicle.origin is None:
        return None
    estimate = vehicle.estimate
    return m.Altitude(
        time_usec=usec(vehicle),
        altitude_monotonic=vehicle.readings.pressure_alt_amsl_m,
        altitude_amsl=estimate.alt_amsl_m,
        altitude_local=-estimate.pos_ned[2],
        altitude_relative=estimate.alt_rel_m,
        altitude_terrain=math.nan,
        bottom_clearance=math.nan,
    )


def wind(vehicle: Vehicle, profile: Profile) -> m.Wind | None:
    """ArduPilot's; `direction` is where the wind comes from.  None is known yet: none is told."""
    if m.Wind in profile.unsent_messages:
        return None
    north, east, down = vehicle.wind_ned or (0.0, 0.0, 0.0)
    return m.Wind(math.degrees(math.atan2(-east, -north)), math.hypot(north, east), down)


def wind_cov(vehicle: Vehicle, profile: Profile) -> m.WindCov | None:
    """PX4's; NaN = the vertical wind is not estimated."""
    if vehicle.wind_ned is None:
        return None
    north, east, _ = vehicle.wind_ned
    return m.WindCov(
        time_usec=usec(vehicle),
        wind_x=north,
        wind_y=east,
        wind_z=math.nan,
        var_horiz=WIND_STD_M_S * WIND_STD_M_S,
        var_vert=math.nan,
        wind_alt=vehicle.estimate.alt_amsl_m,
        horiz_accuracy=WIND_STD_M_S,
        vert_accuracy=math.nan,
    )


def vibration(vehicle: Vehicle, profile: Profile) -> m.Vibration:
    """The sensors of the model do not clip."""
    return m.Vibration(usec(vehicle), *vehicle.vibration_m_s2, 0, 0, 0)


def power_status(vehicle: Vehicle, profile: Profile) -> m.PowerStatus:
    return m.PowerStatus(Vcc=BOARD_MV, Vservo=BOARD_MV, flags=BRICK_VALID)


def hwstatus(vehicle: Vehicle, profile: Profile) -> m.Hwstatus:
    return m.Hwstatus(Vcc=BOARD_MV, I2Cerr=0)


def meminfo(vehicle: Vehicle, profile: Profile) -> m.Meminfo:
    return m.Meminfo(brkval=0, freemem=min(FREE_BYTES, UINT16_MAX), freemem32=FREE_BYTES)


def relay_status(vehicle: Vehicle, profile: Profile) -> m.RelayStatus | None:
    """ArduPilot's."""
    if m.RelayStatus in profile.unsent_messages:
        return None
    present, on = vehicle.relays
    return m.RelayStatus(vehicle.clock_ns // 1_000_000 & 0xFFFFFFFF, on, present)


STATUS: Final[dict[int, Builder]] = {
    m.IDS[kind]: builder
    for kind, builder in (
        (m.NavControllerOutput, nav_controller_output),
        (m.Altitude, altitude),
        (m.Wind, wind),
        (m.WindCov, wind_cov),
        (m.Vibration, vibration),
        (m.PowerStatus, power_status),
        (m.Hwstatus, hwstatus),
        (m.Meminfo, meminfo),
        (m.RelayStatus, relay_status),
    )
}
