"""MAVSDK 4 flies: health, take-off, go-to, hold, orbit, every kind of offboard setpoint, landing.

Run: python mavsdk_flight.py udpin://127.0.0.1:14540 px4
"""

from __future__ import annotations

import math
import sys

from mavsdk.plugins.action import Action, OrbitYawBehavior
from mavsdk.plugins.info import Info
from mavsdk.plugins.offboard import (
    AccelerationNed,
    Attitude,
    AttitudeRate,
    Offboard,
    PositionGlobalYaw,
    PositionNedYaw,
    VelocityBodyYawspeed,
    VelocityNedYaw,
)
from mavsdk.plugins.telemetry import FlightMode, LandedState, Telemetry
from mavsdk_station import EARTH_M_PER_DEG, Station, ask_for_streams, ned_m, refusal, until


def told(station: Station, telemetry: Telemetry) -> None:
    """What a ground station wants to know before it flies."""
    until(telemetry.health_all_ok, "health all ok")
    print("healthy", telemetry.health().is_armable)
    info = Info(station.system)
    until(lambda: refusal(info.get_version) == "SUCCESS", "version known")
    version = info.get_version()
    print("version", version.flight_sw_major, version.flight_sw_minor, version.flight_sw_patch)
    print("legacy uid", info.get_identification().legacy_uid != 0)
    until(lambda: refusal(info.get_speed_factor) == "SUCCESS", "speed factor known")
    # How near to ten times real time the vehicle comes, a loaded machine decides.
    until(lambda: 2.0 < info.get_speed_factor() < 15.0, "speed factor measured")
    print("faster than real time")
    until(lambda: telemetry.unix_epoch_time() > 1_600_000_000_000_000, "time of day")
    origin = telemetry.get_gps_global_origin()
    home = telemetry.home()
    print("origin", round(origin.latitude_deg, 4), round(origin.longitude_deg, 4))
    print("home", round(home.latitude_deg, 4), round(home.longitude_deg, 4))


def streamed(telemetry: Telemetry, personality: str) -> None:
    """Every stream that MAVSDK shows, with something true in it."""
    until(lambda: telemetry.gps_info().num_satellites >= 10, "satellites")
    until(lambda: telemetry.battery().remaining_percent > 90.0, "battery")
    until(lambda: telemetry.attitude_euler().timestamp_us > 0, "attitude")
    until(lambda: abs(telemetry.raw_gps().absolute_altitude_m) > 100.0, "raw GPS")
    until(lambda: telemetry.heading().heading_deg >= 0.0, "heading")
    if personality == "px4":  # ArduPilot has no such message
        until(lambda: abs(telemetry.altitude().altitude_amsl_m) > 100.0, "altitude")
    print("streams")


def fly(telemetry: Telemetry, action: Action, personality: str) -> None:
    action.set_takeoff_altitude(4.0)
    print("take-off altitude", action.get_takeoff_altitude())
    action.arm()
    until(telemetry.armed, "armed")
    action.takeoff()
    until(telemetry.in_air, "in the air")
    low_m = 0.8 if personality == "px4" else 0.0  # PX4 ends its climb within NAV_MC_ALT_RAD
    until(lambda: -low_m - 0.3 < telemetry.position().relative_altitude_m - 4.0 < 0.3, "4 m up")
    if personality == "px4":
        until(lambda: telemetry.flight_mode() is FlightMode.HOLD, "taken off")
    print("taken off", telemetry.landed_state() is not LandedState.ON_GROUND)

    home = telemetry.home()
    north_deg = home.latitude_deg + 10.0 / EARTH_M_PER_DEG
    action.goto_location(north_deg, home.longitude_deg, home.absolute_altitude_m + 6.0, 90.0)
    until(lambda: abs(ned_m(telemetry)[0] - 10.0) < 0.7, "10 m north")
    until(lambda: abs(telemetry.position().relative_altitude_m - 6.0) < 0.5, "6 m up")
    until(lambda: abs(telemetry.heading().heading_deg - 90.0) < 5.0, "looking east")
    print("went to a location")

    action.set_current_speed(2.0)
    action.goto_location(
        home.latitude_deg, home.longitude_deg, home.absolute_altitude_m + 6.0, math.nan
    )
    fastest_m_s = 0.0
    while ned_m(telemetry)[0] > 1.0:
        velocity = telemetry.velocity_ned()
        fastest_m_s = max(fastest_m_s, math.hypot(velocity.north_m_s, velocity.east_m_s))
    print("at the speed that was set", 1.5 < fastest_m_s < 2.5)
    action.hold()
    until(lambda: telemetry.flight_mode() is FlightMode.HOLD, "holding")
    print("holds")
    if personality == "px4":  # which tells the wind in the air
        until(lambda: math.isfinite(telemetry.wind().wind_x_ned_m_s), "wind")


def orbit(telemetry: Telemetry, action: Action) -> None:
    home = telemetry.home()
    action.do_orbit(
        5.0,
        2.0,
        OrbitYawBehavior.HOLD_FRONT_TO_CIRCLE_CENTER,
        home.latitude_deg,
        home.longitude_deg,
        home.absolute_altitude_m + 6.0,
    )

    def radius_m() -> float:
        north_m, east_m, _ = ned_m(telemetry)
        return math.hypot(north_m, east_m)

    sides = set[tuple[bool, bool]]()

    def round_once() -> bool:
        north_m, east_m, _ = ned_m(telemetry)
        if abs(radius_m() - 5.0) < 1.0:
            sides.add((north_m > 0.0, east_m > 0.0))
        return len(sides) == 4

    until(round_once, "once around")
    print("orbits")
    action.hold()


def offboard(station: Station, telemetry: Telemetry) -> None:
    """The setpoint is set before the start, as PX4 wants it; MAVSDK repeats it at 20 Hz."""
    home = telemetry.home()
    control = Offboard(station.system)
    print("offboard without a setpoint", refusal(control.start))

    def near(north_m: float, east_m: float, down_m: float) -> bool:
        return math.dist(ned_m(telemetry), (north_m, east_m, down_m)) < 0.6

    control.set_position_ned(PositionNedYaw(5.0, 5.0, -6.0, 0.0))
    control.start()
    until(lambda: telemetry.flight_mode() is FlightMode.OFFBOARD, "offboard")
    until(lambda: near(5.0, 5.0, -6.0), "at the position")
    print("offboard position")

    control.set_position_global(
        PositionGlobalYaw(
            home.latitude_deg,
            home.longitude_deg,
            8.0,
            0.0,
            PositionGlobalYaw.AltitudeType.REL_HOME,
        )
    )
    until(lambda: near(0.0, 0.0, -8.0), "above home")
    print("offboard global position")

    control.set_velocity_ned(VelocityNedYaw(0.0, 2.0, 0.0, 90.0))
    until(lambda: abs(telemetry.velocity_ned().east_m_s - 2.0) < 0.3, "2 m/s eastward")
    print("offboard velocity")

    control.set_velocity_body(VelocityBodyYawspeed(0.0, 0.0, -0.5, 30.0))
    until(lambda: abs(turning_deg_s(telemetry) - 30.0) < 5.0, "turning")
    until(lambda: abs(telemetry.velocity_ned().down_m_s + 0.5) < 0.2, "climbing")
    print("offboard body velocity")

    control.set_position_velocity_ned(
        PositionNedYaw(0.0, 0.0, -8.0, 0.0), VelocityNedYaw(0.0, 0.0, 0.0, 0.0)
    )
    until(lambda: near(0.0, 0.0, -8.0), "back")
    print("offboard position and velocity")

    control.set_acceleration_ned(AccelerationNed(1.0, 0.0, 0.0))
    until(lambda: telemetry.velocity_ned().north_m_s > 1.5, "faster and faster northward")
    print("offboard acceleration")

    control.set_velocity_ned(VelocityNedYaw(0.0, 0.0, 0.0, 0.0))
    until(lambda: abs(telemetry.velocity_ned().north_m_s) < 0.3, "stopped")
    control.set_attitude(Attitude(0.0, -8.0, 0.0, 0.4))
    until(lambda: abs(telemetry.attitude_euler().pitch_deg + 8.0) < 2.0, "leaning")
    print("offboard attitude")

    control.set_position_ned(PositionNedYaw(0.0, 0.0, -15.0, 0.0))
    until(lambda: near(0.0, 0.0, -15.0), "high enough")
    control.set_attitude_rate(AttitudeRate(0.0, 0.0, 40.0, 0.4))
    until(lambda: abs(turning_deg_s(telemetry) - 40.0) < 6.0, "turning at the rate")
    print("offboard rates")

    control.set_position_ned(PositionNedYaw(0.0, 0.0, -4.0, 0.0))
    until(lambda: near(0.0, 0.0, -4.0), "down again")
    control.stop()
    until(lambda: telemetry.flight_mode() is FlightMode.HOLD, "offboard left")
    print("offboard stopped")


def turning_deg_s(telemetry: Telemetry) -> float:
    return math.degrees(telemetry.attitude_angular_velocity_body().yaw_rad_s)


def main(url: str, personality: str) -> None:
    with Station(url) as station:
        telemetry, action = Telemetry(station.system), Action(station.system)
        if personality == "ardupilot":
            ask_for_streams(telemetry)
        told(station, telemetry)
        streamed(telemetry, personality)
        fly(telemetry, action, personality)
        if personality == "px4":
            orbit(telemetry, action)
        else:
            print("orbit", refusal(action.do_orbit, 5.0, 2.0, 0, math.nan, math.nan, math.nan))
        offboard(station, telemetry)
        action.return_to_launch()
        until(lambda: telemetry.flight_mode() is FlightMode.RETURN_TO_LAUNCH, "returning")
        action.land()
        until(lambda: telemetry.flight_mode() is FlightMode.LAND, "landing")
        until(lambda: not telemetry.in_air(), "landed")
        until(lambda: not telemetry.armed(), "disarmed")
        print("landed and disarmed")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
