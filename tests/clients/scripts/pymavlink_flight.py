"""A flight with the helpers of pymavlink's mavutil and mavwp: what most scripts are made of.

    python pymavlink_flight.py ardupilot tcp:127.0.0.1:5760
    python pymavlink_flight.py px4 udpin:127.0.0.1:14540

One line for each thing shown; an AssertionError for what is not.
"""

import math
import os
import pathlib
import sys
import time

os.environ["MAVLINK20"] = "1"
from pymavlink import DFReader, mavextra, mavutil, mavwp

link = None
mavlink = mavutil.mavlink

FLOWN_MODES = {
    "ardupilot": (
        *("STABILIZE", "ACRO", "ALT_HOLD", "LOITER", "POSHOLD", "BRAKE"),
        *("CIRCLE", "FOLLOW", "GUIDED"),
    ),
    "px4": ("ALTCTL", "POSCTL", "STABILIZED", "MANUAL", "ACRO", "FOLLOWME", "LOITER"),
}


def main(personality, url):
    global link
    link = mavutil.mavlink_connection(url, source_system=255)
    link.wait_heartbeat(timeout=60)
    print(f"heartbeat of system {link.target_system}, mode {link.flightmode}")
    if personality == "ardupilot":
        link.mav.request_data_stream_send(1, 1, mavlink.MAV_DATA_STREAM_ALL, 10, 1)
    link.wait_gps_fix()
    home = link.location()
    print(f"at home {home.lat:.4f} {home.lng:.4f} {home.alt:.0f}")
    ready = mavlink.MAV_SYS_STATUS_PREARM_CHECK | mavlink.MAV_SYS_STATUS_SENSOR_GPS
    wait("SYS_STATUS", lambda m: m.onboard_control_sensors_health & ready == ready)
    upload_and_read_back(mission_round(home))
    arm_and_take_off(personality, home)
    fly_to_a_place(personality, home)
    fly_by_setpoints(personality)
    fly_the_mission(personality)
    fly_every_mode(personality)
    fly_by_sticks(personality)
    link.set_mode_rtl()
    link.motors_disarmed_wait()
    back = link.location(relative_alt=True)
    off_m = mavextra.distance_lat_lon(home.lat, home.lng, back.lat, back.lng)
    print(f"disarmed {off_m:.0f} m from home")
    read_the_newest_log(personality)
    link.close()


# ------------------------------------------------------------------------------- plumbing


def wait(kind, condition=lambda message: True, seconds=60.0):
    """The first message of that kind for which the condition holds."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        beat()
        message = link.recv_match(type=kind, blocking=True, timeout=0.1)
        if message is not None and condition(message):
            return message
    raise AssertionError(f"no such {kind} within {seconds} s")


def latest(kind):
    """Of all that has come."""
    while link.recv_match() is not None:
        pass
    return link.messages[kind]


def beat(last=[0.0]):  # noqa: B006
    """A ground station's heartbeat, once a second; without it the vehicle's failsafe acts."""
    if time.monotonic() - last[0] > 1.0:
        last[0] = time.monotonic()
        link.mav.heartbeat_send(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 0)


def acked(command, send):
    """Sends the command, again every two seconds, until its final result comes."""
    end = time.monotonic() + 60.0
    while time.monotonic() < end:
        send()
        asked = time.monotonic()
        while time.monotonic() < asked + 2.0:
            beat()
            ack = link.recv_match(type="COMMAND_ACK", blocking=True, timeout=0.1)
            if ack is not None and (ack.command, ack.result) == (command, 0):
                return
            final = ack is not None and ack.result != mavlink.MAV_RESULT_IN_PROGRESS
            assert not (final and ack.command == command), ack
    raise AssertionError(f"no result of {command}")


def set_mode(name):
    assert name in link.mode_mapping(), name
    acked(mavlink.MAV_CMD_DO_SET_MODE, lambda: link.set_mode(name))
    wait("HEARTBEAT", lambda m: link.flightmode == name)


def centre_sticks(personality):
    """PX4 enters a mode that is flown by hand only while there are sticks."""
    if personality == "px4":
        link.mav.manual_control_send(1, 0, 0, 500, 0, 0)
        link.mav.manual_control_send(1, 0, 0, 500, 0, 0)


def height_reached(up_m, within_m=0.5):
    wait("GLOBAL_POSITION_INT", lambda m: abs(m.relative_alt * 1e-3 - up_m) < within_m)


# -------------------------------------------------------------------------------- mission


def mission_round(home):
    """Home (item 0 of ArduPilot; a waypoint to PX4), three waypoints, and no end."""
    loader = mavwp.MAVWPLoader(1, 1)
    loader.add_latlonalt(home.lat, home.lng, 12)
    for north_m, east_m in ((15, 0), (15, 15), (0, 15)):
        lat, lon = mavextra.gps_offset(home.lat, home.lng, east_m, north_m)
        loader.add_latlonalt(lat, lon, 12)
    return loader


def upload_and_read_back(loader):
    link.waypoint_clear_all_send()
    assert wait("MISSION_ACK").type == mavlink.MAV_MISSION_ACCEPTED
    link.waypoint_count_send(loader.count())
    for _ in range(loader.count()):
        asked = wait(["MISSION_REQUEST", "MISSION_REQUEST_INT"])
        item = loader.wp(asked.seq)
        if asked.get_type() == "MISSION_REQUEST_INT":
            link.mav.mission_item_int_send(
                *(1, 1, item.seq, item.frame, item.command, 0, item.autocontinue),
                *(item.param1, item.param2, item.param3, item.param4),
                *(round(item.x * 1e7), round(item.y * 1e7), item.z),
            )
        else:
            link.mav.send(item)
    assert wait("MISSION_ACK").type == mavlink.MAV_MISSION_ACCEPTED
    link.waypoint_request_list_send()
    count = wait("MISSION_COUNT").count
    assert count == loader.count()
    for seq in range(count):
        link.mav.mission_request_int_send(1, 1, seq)
        back = wait("MISSION_ITEM_INT", lambda m, seq=seq: m.seq == seq)
        there = loader.wp(seq)
        place = (back.x * 1e-7, back.y * 1e-7)
        assert math.dist(place, (there.x, there.y)) < 2e-5, (back, there)
    print(f"mission of {count} items up and down")


def fly_the_mission(personality):
    link.waypoint_set_current_send(1)
    wait("MISSION_CURRENT", lambda m: m.seq == 1)
    set_mode({"ardupilot": "AUTO", "px4": "MISSION"}[personality])
    for seq in (1, 2, 3):
        wait("MISSION_ITEM_REACHED", lambda m, seq=seq: m.seq == seq)
        print(f"mission item {seq} reached")


# --------------------------------------------------------------------------------- flying


def arm_and_take_off(personality, home):
    if personality == "ardupilot":
        set_mode("GUIDED")
    acked(mavlink.MAV_CMD_COMPONENT_ARM_DISARM, link.arducopter_arm)
    link.motors_armed_wait()
    print("armed")
    # PX4 takes the height above the sea, ArduPilot above home.
    up = home.alt + 10 if personality == "px4" else 10
    take_off = (0, 0, 0, 0, math.nan, math.nan, math.nan, up)
    acked(
        mavlink.MAV_CMD_NAV_TAKEOFF,
        lambda: link.mav.command_long_send(1, 1, mavlink.MAV_CMD_NAV_TAKEOFF, *take_off),
    )
    # PX4 ends its climb up to NAV_MC_ALT_RAD = 0.8 m lower.
    height_reached(10, within_m=0.9 if personality == "px4" else 0.5)
    print("10 m up")


def fly_to_a_place(personality, home):
    """COMMAND_INT, as ground stations send it."""
    if personality == "px4":
        wait("HEARTBEAT", lambda m: link.flightmode == "LOITER")
    lat, lon = mavextra.gps_offset(home.lat, home.lng, -10, 0)
    there = (
        *(1, 1, mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT, mavlink.MAV_CMD_DO_REPOSITION, 0, 0),
        *(-1, mavlink.MAV_DO_REPOSITION_FLAGS_CHANGE_MODE, 0, math.nan),
        *(round(lat * 1e7), round(lon * 1e7), 12),
    )
    acked(mavlink.MAV_CMD_DO_REPOSITION, lambda: link.mav.command_int_send(*there))
    wait(
        "GLOBAL_POSITION_INT",
        lambda m: abs(m.lon - lon * 1e7) < 80 and abs(m.relative_alt - 12000) < 500,
    )
    print("10 m west by COMMAND_INT")


def fly_by_setpoints(personality):
    """SET_POSITION_TARGET_LOCAL_NED at 10 Hz; PX4 wants the stream before it enters OFFBOARD."""
    mode = {"ardupilot": "GUIDED", "px4": "OFFBOARD"}[personality]
    for turn in range(600):
        beat()
        link.mav.set_position_target_local_ned_send(
            *(0, 1, 1, mavlink.MAV_FRAME_LOCAL_NED, 0b110111111000),
            *(5, -5, -8, 0, 0, 0, 0, 0, 0, 0, 0),
        )
        if turn % 50 == 10:
            link.set_mode(mode)
        here = latest("LOCAL_POSITION_NED")
        if turn > 10 and math.dist((here.x, here.y, here.z), (5, -5, -8)) < 0.5:
            break
        time.sleep(0.1)
    else:
        raise AssertionError("not at the setpoint")
    wait("HEARTBEAT", lambda m: link.flightmode == mode)
    print(f"at the setpoint in {mode}")


def fly_every_mode(personality):
    if personality == "ardupilot":
        link.param_set_send("FOLL_ENABLE", 1)
        wait("PARAM_VALUE", lambda m: m.param_id == "FOLL_ENABLE" and m.param_value == 1)
    for mode in FLOWN_MODES[personality]:
        centre_sticks(personality)
        set_mode(mode)
    print(f"flew in {', '.join(FLOWN_MODES[personality])}")


def fly_by_sticks(personality):
    """RC_CHANNELS_OVERRIDE (ArduPilot) and MANUAL_CONTROL (PX4): up, and stay."""
    centre_sticks(personality)
    set_mode({"ardupilot": "LOITER", "px4": "POSCTL"}[personality])
    start = wait("GLOBAL_POSITION_INT").relative_alt

    def sticks(throttle):
        if personality == "ardupilot":
            link.mav.rc_channels_override_send(
                1, 1, 0, 0, 1500 + round(500 * throttle), 0, 0, 0, 0, 0
            )
        else:
            link.mav.manual_control_send(1, 0, 0, 500 + round(500 * throttle), 0, 0)

    for _ in range(1200):
        sticks(0.6)
        if latest("GLOBAL_POSITION_INT").relative_alt > start + 5000:
            break
        time.sleep(0.05)
    for _ in range(1200):
        sticks(0.0)
        if abs(latest("GLOBAL_POSITION_INT").vz) < 10:
            break
        time.sleep(0.05)
    else:
        raise AssertionError("it does not stop where the stick is centred")
    print("5 m up by the sticks, and stays")


# ------------------------------------------------------------------------------------ logs


def read_the_newest_log(personality):
    """LOG_REQUEST_LIST and LOG_REQUEST_DATA by hand."""
    link.mav.log_request_list_send(1, 1, 0, 0xFFFF)
    entry = wait("LOG_ENTRY", lambda m: m.id == m.last_log_num)
    size = min(entry.size, 90_000) if personality == "px4" else entry.size
    data = bytearray(size)
    link.mav.log_request_data_send(1, 1, entry.id, 0, size)
    got = 0
    while got < size:
        part = wait("LOG_DATA")
        assert part.count > 0
        data[part.ofs : part.ofs + part.count] = bytes(part.data[: part.count])
        got += part.count
    link.mav.log_request_end_send(1, 1)
    if personality == "px4":
        assert data[:7] == b"ULog\x01\x12\x35"
        print(f"log {entry.id}: a ULog")
        return
    name = "newest.bin"
    pathlib.Path(name).write_bytes(data)
    log = DFReader.DFReader_binary(name)
    highest = 0.0
    while (position := log.recv_match(type="POS")) is not None:
        highest = max(highest, position.RelHomeAlt)
    log.close()
    print(f"log {entry.id}: {highest:.0f} m was the highest")


main(*sys.argv[1:])
