"""MAVLink 1, as old scripts speak it: who has heard no MAVLink 2 is answered in MAVLink 1.

    python pymavlink_mavlink1.py ardupilot udpout:127.0.0.1:14550

The script has to speak first, so the vehicle waits on a port (`--port`).
"""

import os
import sys
import time

os.environ.pop("MAVLINK20", None)
from pymavlink import mavutil

MAVLINK1 = 254  # the first byte of a frame


def main(personality, url):
    link = mavutil.mavlink_connection(url, source_system=255)
    mavlink = mavutil.mavlink
    assert not mavutil.mavlink20()
    seen = {}

    def wait(kind, condition=lambda message: True):
        end = time.monotonic() + 60.0
        while time.monotonic() < end:
            message = link.recv_match(blocking=True, timeout=0.1)
            if message is None or message.get_type() == "BAD_DATA":
                continue
            assert message.get_msgbuf()[0] == MAVLINK1, message
            seen[message.get_type()] = message
            if message.get_type() == kind and condition(message):
                return message
        raise AssertionError(f"no such {kind}")

    link.mav.heartbeat_send(mavlink.MAV_TYPE_GCS, mavlink.MAV_AUTOPILOT_INVALID, 0, 0, 0)
    wait("HEARTBEAT")
    print(f"MAVLink 1 with system {link.target_system}, mode {link.flightmode}")
    link.mav.request_data_stream_send(1, 1, mavlink.MAV_DATA_STREAM_ALL, 10, 1)
    wait("GLOBAL_POSITION_INT")
    link.param_fetch_all()
    count = wait("PARAM_VALUE").param_count
    wait("PARAM_VALUE", lambda m: m.param_index == count - 1)
    print(f"{count} parameters")
    link.mav.mission_count_send(1, 1, 2)
    for seq in (0, 1):
        wait("MISSION_REQUEST" if personality == "ardupilot" or seq == 0 else "MISSION_REQUEST_INT")
        link.mav.mission_item_send(
            1, 1, seq, mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT, mavlink.MAV_CMD_NAV_WAYPOINT,
            0, 1, 0, 0, 0, 0, *HOMES[personality], 10,
        )  # fmt: skip
    assert wait("MISSION_ACK").type == mavlink.MAV_MISSION_ACCEPTED
    print("a mission of float items")
    ready = mavlink.MAV_SYS_STATUS_PREARM_CHECK | mavlink.MAV_SYS_STATUS_SENSOR_GPS
    wait("SYS_STATUS", lambda m: m.onboard_control_sensors_health & ready == ready)
    if personality == "ardupilot":
        link.set_mode("GUIDED")
        wait("COMMAND_ACK", lambda m: m.result == mavlink.MAV_RESULT_ACCEPTED)
        link.mav.rc_channels_override_send(1, 1, 1500, 1500, 1000, 1500, 0, 0, 0, 0)
        channels = wait("RC_CHANNELS_RAW", lambda m: m.chan3_raw == 1000)
        print(f"channels {channels.chan1_raw} {channels.chan2_raw} {channels.chan3_raw}")
    link.arducopter_arm()
    wait("COMMAND_ACK", lambda m: m.result == mavlink.MAV_RESULT_ACCEPTED)
    wait("HEARTBEAT", lambda m: link.motors_armed())
    print("armed")
    link.close()


HOMES = {"ardupilot": (-35.363262, 149.165237), "px4": (47.397742, 8.545594)}
main(*sys.argv[1:])
