"""A flight with DroneKit's own API, start to end as its examples do it.

    python dronekit_flight.py ardupilot tcp:127.0.0.1:5760
    python dronekit_flight.py px4 udpin:127.0.0.1:14540
    python dronekit_flight.py ardupilot udpout:127.0.0.1:14550

With the last it speaks first, in MAVLink 1, and is answered in it.
One line for each thing shown; an AssertionError for what is not.
"""

import collections
import collections.abc
import logging
import sys
import time

# DroneKit 2.9.2 is older than Python 3.10.
collections.MutableMapping = collections.abc.MutableMapping

from dronekit import Command, LocationGlobalRelative, VehicleMode, connect  # noqa: E402
from pymavlink import mavutil  # noqa: E402

SPEED = {"ardupilot": ("WPNAV_SPEED", 400.0), "px4": ("MPC_XY_CRUISE", 4.0)}


def main(personality, url):
    vehicle = connect(url, wait_ready=True, rate=10)
    print(f"connected: {len(vehicle.parameters)} parameters")
    version(vehicle)
    attributes(vehicle)
    parameters(vehicle, personality)
    heard = listen(vehicle)
    until(lambda: vehicle.ekf_ok or personality == "px4", "the EKF")
    if personality == "ardupilot":
        fly_copter(vehicle, mavlink1=url.startswith("udpout"))
    else:
        fly_px4(vehicle)
    until(lambda: not vehicle.armed, "disarmed", 60.0)
    height_m = vehicle.location.global_relative_frame.alt
    assert abs(height_m) < 0.5, height_m
    print(f"landed in {vehicle.mode.name}")
    assert all(heard.values()), heard
    print(f"listeners: {', '.join(heard)}")
    vehicle.close()


def until(holds, what, seconds=30.0):
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end, f"not within {seconds} s: {what}"
        time.sleep(0.05)


# ----------------------------------------------------------------------------- on the ground


def version(vehicle):
    assert vehicle.wait_ready("autopilot_version", timeout=10)
    told = vehicle.capabilities
    assert told.mission_int
    assert told.command_int
    assert told.ftp
    assert told.set_attitude_target
    print(f"version {vehicle.version}, stable {vehicle.version.is_stable()}")


def attributes(vehicle):
    until(lambda: vehicle.gps_0.fix_type >= 3, "a fix")
    assert vehicle.gps_0.satellites_visible >= 6
    assert not vehicle.armed
    assert vehicle.battery.voltage > 10.0
    assert vehicle.battery.level > 90
    assert vehicle.system_status.state == "STANDBY"
    assert 0 <= vehicle.heading < 360
    assert max(map(abs, vehicle.velocity)) < 0.5
    assert vehicle.groundspeed < 0.5
    assert abs(vehicle.attitude.roll) < 0.05
    assert abs(vehicle.location.global_relative_frame.alt) < 0.5
    until(lambda: vehicle.location.local_frame.north is not None, "a local position")
    assert vehicle.last_heartbeat < 2.0
    until(lambda: vehicle.home_location is not None, "home")
    vehicle.home_location = vehicle.home_location  # DO_SET_HOME
    print(f"attributes, home at {vehicle.home_location.alt:.0f} m")


def parameters(vehicle, personality):
    name, slower = SPEED[personality]
    changes = []
    vehicle.parameters.add_attribute_listener("*", lambda _, key, value: changes.append(key))
    before = vehicle.parameters[name]
    vehicle.parameters[name] = slower
    assert vehicle.parameters[name] == slower
    vehicle.parameters[name] = before
    until(lambda: name in changes, "the parameter listener")
    print(f"{name} set and heard")


def listen(vehicle):
    """Attribute and message listeners; the answer fills in as they are called."""
    heard = dict.fromkeys(("location", "attitude", "mode", "armed", "SYS_STATUS"), False)

    def note(_, name, value):
        heard[name] = True

    for name in ("location", "attitude", "mode", "armed"):
        vehicle.add_attribute_listener(
            {"location": "location.global_frame"}.get(name, name),
            lambda _, __, value, name=name: note(_, name, value),
        )
    vehicle.add_message_listener("SYS_STATUS", note)
    return heard


# -------------------------------------------------------------------------------- ArduPilot


def fly_copter(vehicle, mavlink1):
    upload_mission(vehicle)
    until(lambda: vehicle.is_armable, "armable")
    vehicle.mode = VehicleMode("GUIDED")
    vehicle.wait_for_mode("GUIDED", timeout=10)
    vehicle.arm(timeout=10)
    print("armed in GUIDED")
    vehicle.wait_simple_takeoff(10, epsilon=0.5, timeout=30)
    print("took off to 10 m")
    here = vehicle.location.global_relative_frame
    there = LocationGlobalRelative(here.lat + 0.0002, here.lon, 12)
    vehicle.simple_goto(there, groundspeed=4)
    fastest = 0.0
    end = time.monotonic() + 30
    while abs(vehicle.location.global_relative_frame.lat - there.lat) > 5e-6:
        fastest = max(fastest, vehicle.groundspeed)
        assert time.monotonic() < end
        time.sleep(0.05)
    assert 3.0 < fastest < 4.6, fastest
    print(f"went there at {fastest:.0f} m/s")
    vehicle.groundspeed = 3
    vehicle.airspeed = 3
    vehicle.mode = VehicleMode("LOITER")
    vehicle.wait_for_mode("LOITER", timeout=10)
    low_m = vehicle.location.global_relative_frame.alt
    vehicle.channels.overrides = {"3": 1800}
    until(lambda: vehicle.location.global_relative_frame.alt > low_m + 3, "up by the override")
    if mavlink1:  # RC_CHANNELS_RAW, all that DroneKit hears of channels, is ArduPilot's for it
        until(lambda: vehicle.channels["3"] == 1800, "the channel")
        print("channels are told")
    vehicle.channels.overrides = {"3": 1500}
    vehicle.channels.overrides = {}
    print("climbed by a channel override")
    vehicle.gimbal.release()
    vehicle.mode = VehicleMode("AUTO")
    vehicle.wait_for_mode("AUTO", timeout=10)
    watch_mission(vehicle, last=4)
    vehicle.mode = VehicleMode("RTL")
    vehicle.wait_for_mode("RTL", timeout=10)


def upload_mission(vehicle):
    commands = vehicle.commands
    commands.download()
    commands.wait_ready(timeout=10)
    assert commands.count == 0
    commands.clear()
    for item in mission(vehicle):
        commands.add(item)
    commands.upload(timeout=10)
    commands.download()
    commands.wait_ready(timeout=10)
    told = [item.command for item in commands]
    assert told == [item.command for item in mission(vehicle)], told
    print(f"mission of {commands.count} commands up and down")


def mission(vehicle):
    home = vehicle.home_location

    def item(command, north, east):
        frame = mavutil.mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT
        place = (home.lat + north * 1e-4, home.lon + east * 1e-4)
        return Command(0, 0, 0, frame, command, 0, 1, 0, 0, 0, 0, *place, 12)

    waypoint = mavutil.mavlink.MAV_CMD_NAV_WAYPOINT
    return [
        item(mavutil.mavlink.MAV_CMD_NAV_TAKEOFF, 0, 0),
        item(waypoint, 2, 0),
        item(waypoint, 2, 2),
        item(waypoint, 0, 2),
    ]


def watch_mission(vehicle, last):
    seen = [vehicle.commands.next]
    end = time.monotonic() + 60
    while seen[-1] < last:
        if vehicle.commands.next != seen[-1]:
            seen.append(vehicle.commands.next)
        assert time.monotonic() < end, seen
        time.sleep(0.02)
    print(f"mission to item {seen[-1]}")


# ------------------------------------------------------------------------------------- PX4


def fly_px4(vehicle):
    """As DroneKit's px4 example: a mission, by hand as far as DroneKit knows PX4.

    It cannot upload to PX4, whose MISSION_REQUEST_INT it does not answer.
    """
    vehicle.arm(timeout=10)
    print("armed")
    vehicle.mode = VehicleMode("TAKEOFF")
    vehicle.wait_for_mode("TAKEOFF", timeout=10)
    until(lambda: vehicle.mode.name == "LOITER", "taken off")
    height_m = vehicle.location.global_relative_frame.alt
    assert 1.5 < height_m < 3.0, height_m  # of 2.5 m: its climb ends up to 0.8 m lower
    print(f"took off to {height_m:.1f} m")

    def with_sticks(condition):
        """PX4 enters POSCTL only while there are sticks, and tells when they are lost."""
        vehicle.send_mavlink(vehicle.message_factory.manual_control_encode(1, 0, 0, 500, 0, 0))
        return condition()

    with_sticks(lambda: True)
    vehicle.mode = VehicleMode("POSCTL")
    until(lambda: with_sticks(lambda: vehicle.mode.name == "POSCTL"), "POSCTL")
    vehicle.mode = VehicleMode("LAND")
    until(lambda: with_sticks(lambda: vehicle.mode.name == "LAND"), "LAND")
    until(lambda: with_sticks(lambda: not vehicle.armed), "landed")


logging.basicConfig(level=logging.WARNING, stream=sys.stderr)
logging.getLogger("autopilot").propagate = False  # what the vehicle says is not a complaint
main(*sys.argv[1:])
