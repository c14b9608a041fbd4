"""MAVSDK 4 beside the usual flight: sticks, following, fence, failures, reboot, end of a flight.

Run: python mavsdk_faults.py udpin://127.0.0.1:14540 px4
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Callable
from threading import Event, Thread

from mavsdk.plugins.action import Action
from mavsdk.plugins.failure import Failure, FailureType, FailureUnit
from mavsdk.plugins.follow_me import Config, FollowMe, TargetLocation
from mavsdk.plugins.geofence import Circle, FenceType, Geofence, GeofenceData, Point
from mavsdk.plugins.manual_control import ManualControl
from mavsdk.plugins.offboard import Offboard, PositionNedYaw, VelocityNedYaw
from mavsdk.plugins.param import Param
from mavsdk.plugins.telemetry import FixType, FlightMode, Telemetry
from mavsdk_station import EARTH_M_PER_DEG, Station, ned_m, refusal, told_twice, until

BOOTED_US = 3_000_000


def take_off(telemetry: Telemetry, action: Action, up_m: float) -> None:
    until(telemetry.health_all_ok, "health all ok")
    action.set_takeoff_altitude(up_m)
    action.arm()
    action.takeoff()
    until(lambda: telemetry.position().relative_altitude_m > up_m - 0.9, "up")
    until(lambda: telemetry.flight_mode() is FlightMode.HOLD, "taken off")


def fly_sticks(station: Station, telemetry: Telemetry, action: Action) -> None:
    """The caller repeats the sticks, down to the ground: PX4 takes silence for their loss."""
    manual = ManualControl(station.system)
    print("no sticks yet", refusal(manual.start_position_control))
    sticks = [0.0, 0.0, 0.5, 0.0]  # pitch, roll, throttle, yaw
    ended = Event()

    def push() -> None:
        while not ended.wait(0.02):
            manual.set_manual_control_input(*sticks)

    pusher = Thread(target=push)
    pusher.start()
    try:
        until(lambda: refusal(manual.start_position_control) == "SUCCESS", "sticks that it hears")
        until(lambda: telemetry.flight_mode() is FlightMode.POSCTL, "position mode")
        north_m = ned_m(telemetry)[0]
        sticks[0] = 0.5
        until(lambda: ned_m(telemetry)[0] > north_m + 5.0, "forward by stick")
        sticks[0] = 0.0
        until(lambda: abs(telemetry.velocity_ned().north_m_s) < 0.3, "stands again")
        print("position by stick")
        manual.start_altitude_control()
        until(lambda: telemetry.flight_mode() is FlightMode.ALTCTL, "altitude mode")
        up_m = telemetry.position().relative_altitude_m
        sticks[2] = 0.9
        until(lambda: telemetry.position().relative_altitude_m > up_m + 2.0, "up by stick")
        sticks[2] = 0.5
        print("altitude by stick")
        action.land()
        until(lambda: not telemetry.armed(), "landed and disarmed")
    finally:
        ended.set()
        pusher.join()


def follow(station: Station, telemetry: Telemetry) -> None:
    plugin = FollowMe(station.system)
    plugin.set_config(
        Config(
            follow_height_m=9.0,
            follow_distance_m=6.0,
            responsiveness=0.1,
            altitude_mode=Config.FollowAltitudeMode.CONSTANT,
            max_tangential_vel_m_s=8.0,
            follow_angle_deg=180.0,
        )
    )
    home = telemetry.home()

    def leader(north_m: float) -> None:
        plugin.set_target_location(
            TargetLocation(
                home.latitude_deg + north_m / EARTH_M_PER_DEG,
                home.longitude_deg,
                home.absolute_altitude_m,
                1.0,
                0.0,
                0.0,
            )
        )

    plugin.start()
    until(lambda: telemetry.flight_mode() is FlightMode.FOLLOW_ME, "follows")

    def near() -> bool:
        leader(20.0)
        time.sleep(0.05)
        north_m, east_m, down_m = ned_m(telemetry)
        return abs(math.hypot(north_m - 20.0, east_m) - 6.0) < 2.0 and abs(down_m + 9.0) < 1.0

    until(near, "at the leader's side")
    plugin.stop()
    until(lambda: telemetry.flight_mode() is FlightMode.HOLD, "follows no more")
    print("followed")


def breach(station: Station, telemetry: Telemetry) -> None:
    """GF_ACTION is 2 by default: it holds where it breached the fence."""
    plugin, control = Geofence(station.system), Offboard(station.system)
    control.set_position_ned(PositionNedYaw(0.0, 0.0, -10.0, 0.0))
    control.start()
    until(lambda: math.dist(ned_m(telemetry), (0.0, 0.0, -10.0)) < 1.0, "over home")
    home = telemetry.home()
    centre = Point(home.latitude_deg, home.longitude_deg)
    plugin.upload_geofence(GeofenceData(circles=[Circle(centre, 20.0, FenceType.INCLUSION)]))
    control.set_velocity_ned(VelocityNedYaw(5.0, 0.0, 0.0, 0.0))
    until(lambda: telemetry.flight_mode() is FlightMode.HOLD, "the fence holds it")
    until(lambda: abs(telemetry.velocity_ned().north_m_s) < 0.3, "stopped")
    print("breached the fence, and holds", 18.0 < ned_m(telemetry)[0] < 30.0)
    plugin.clear_geofence()


def fail(station: Station, telemetry: Telemetry) -> None:
    """The plugin reads once, when it is made, whether failures are enabled."""
    told_twice(Param(station.system).set_param_int, "SYS_FAILURE_EN", 1)
    plugin = Failure(station.system)
    plugin.inject(FailureUnit.SENSOR_GPS, FailureType.OFF, 0)
    until(lambda: telemetry.gps_info().fix_type in (FixType.NO_GPS, FixType.NO_FIX), "no GPS")
    plugin.inject(FailureUnit.SENSOR_GPS, FailureType.OK, 0)
    until(lambda: telemetry.gps_info().fix_type is FixType.FIX_3D, "GPS again")
    print("failed and mended")


def reboot(telemetry: Telemetry, action: Action) -> None:
    """Its time begins again, and goes on until what MAVSDK last heard of its health is new, too."""
    before_us = telemetry.attitude_euler().timestamp_us
    action.reboot()
    until(lambda: telemetry.attitude_euler().timestamp_us < before_us, "a new time")
    until(lambda: telemetry.attitude_euler().timestamp_us > BOOTED_US, "a vehicle that has booted")


def restart(station: Station, telemetry: Telemetry, action: Action) -> None:
    reboot(telemetry, action)
    until(station.system.is_connected, "back")
    until(telemetry.health_all_ok, "healthy after the reboot")
    print("rebooted")


def end(telemetry: Telemetry, action: Action, way: Callable[[], object]) -> None:
    """Motors off in the air: it falls."""
    take_off(telemetry, action, 6.0)
    way()
    until(lambda: telemetry.position().relative_altitude_m < 1.0, "fallen")
    print("fell after", way.__name__)


def main(url: str) -> None:
    with Station(url) as station:
        telemetry, action = Telemetry(station.system), Action(station.system)
        take_off(telemetry, action, 6.0)
        follow(station, telemetry)
        breach(station, telemetry)
        fail(station, telemetry)
        fly_sticks(station, telemetry, action)
        restart(station, telemetry, action)
        end(telemetry, action, action.kill)
        until(lambda: not telemetry.armed(), "disarmed by the kill")
        reboot(telemetry, action)
        end(telemetry, action, action.terminate)


if __name__ == "__main__":
    main(sys.argv[1])
