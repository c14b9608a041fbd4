"""Parameters, fences, rally points, files, time and signing with pymavlink's own helpers.

    python pymavlink_services.py ardupilot tcp:127.0.0.1:5760
    python pymavlink_services.py px4 udpin:127.0.0.1:14540

Files are written to the working directory.  One line for each thing shown; an AssertionError for
what is not.
"""

import logging
import os
import pathlib
import struct
import sys
import time

os.environ["MAVLINK20"] = "1"
from pymavlink import mavextra, mavftp, mavparm, mavutil, mavwp

link = None
mavlink = mavutil.mavlink

SPEED = {"ardupilot": "WPNAV_SPEED", "px4": "MPC_XY_CRUISE"}
ROOT = {"ardupilot": "/", "px4": "/fs/microsd"}
KEY = bytes(range(32))


def main(personality, url):
    global link
    link = mavutil.mavlink_connection(url, source_system=255)
    link.wait_heartbeat(timeout=60)
    home_position()
    parameters(personality)
    fence_and_rally()
    files(ROOT[personality].rstrip("/"))
    if personality == "ardupilot":
        packed_parameters()
    time_and_ping()
    refusals()
    signing()
    link.close()


def wait(kind, condition=lambda message: True, seconds=60.0):
    """The first message of that kind for which the condition holds."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        message = link.recv_match(type=kind, blocking=True, timeout=0.1)
        if message is not None and condition(message):
            return message
    raise AssertionError(f"no such {kind} within {seconds} s")


def home_position():
    """ArduPilot sends it when it is asked, and when home changes."""
    while True:
        link.mav.command_long_send(1, 1, mavlink.MAV_CMD_REQUEST_MESSAGE, 0, 242, 0, 0, 0, 0, 0, 0)
        message = link.recv_match(type="HOME_POSITION", blocking=True, timeout=1.0)
        if message is not None:
            return message


# ------------------------------------------------------------------------------ parameters


def parameters(personality):
    link.param_fetch_all()
    names, count = set(), 1
    while len(names) < count:
        told = wait("PARAM_VALUE")
        count = told.param_count
        if told.param_id != "_HASH_CHECK":
            names.add(told.param_id)
    print(f"{count} parameters, {SPEED[personality]} = {link.param(SPEED[personality]):g}")
    name = SPEED[personality]
    faster = link.param(name) * 1.5
    known = mavparm.MAVParmDict()
    assert known.mavset(link, name, faster)
    link.param_fetch_one(name)
    assert wait("PARAM_VALUE", lambda m: m.param_id == name).param_value == faster
    if personality == "px4":
        # PX4 carries integers as their bytes; mavset packs them so when it is given the type.
        assert known.mavset(link, "COM_OBL_RC_ACT", 1, parm_type=mavlink.MAV_PARAM_TYPE_INT32)
        link.param_fetch_one("COM_OBL_RC_ACT")
        told = wait("PARAM_VALUE", lambda m: m.param_id == "COM_OBL_RC_ACT")
        assert struct.pack("<f", told.param_value) == struct.pack("<i", 1)
    known = mavparm.MAVParmDict()
    known.update({name: faster})
    known.save("saved.parm")
    loaded = mavparm.MAVParmDict()
    loaded.load("saved.parm")
    loaded[name] = faster / 3.0
    known[name] = 0.0
    loaded.save("other.parm")
    assert known.load("other.parm", mav=link)
    link.param_fetch_one(name)
    told = wait("PARAM_VALUE", lambda m: m.param_id == name)
    print(f"set, saved, loaded: {name} = {told.param_value:g}")


def packed_parameters():
    done(ftp.cmd_getparams(["all.parm", "defaults.parm"]))
    done(ftp.process_ftp_reply("getparams"))
    values = pathlib.Path("all.parm").read_text().splitlines()
    defaults = pathlib.Path("defaults.parm").read_text().splitlines()
    assert len(values) == len(defaults) > 50
    differing = set(values) - set(defaults)
    print(f"param.pck: {len(values)} parameters, changed: {sorted(differing)}")


# ---------------------------------------------------------------------------- fence, rally


def fence_and_rally():
    home = home_position()
    lat, lon = home.latitude * 1e-7, home.longitude * 1e-7
    corners = [
        mavextra.gps_offset(lat, lon, e, n) for e, n in ((-80, -80), (80, -80), (80, 80), (-80, 80))
    ]
    fence = mavwp.MissionItemProtocol_Fence(1, 1)
    fence.add([vertex(fence, *corner, count=len(corners)) for corner in corners])
    transfer(fence)
    print(f"fence of {fence.count()} vertices up and down")
    rally = mavwp.MissionItemProtocol_Rally(1, 1)
    point = mavextra.gps_offset(lat, lon, 20, 20)
    rally.add(item(rally, mavlink.MAV_CMD_NAV_RALLY_POINT, *point, 15.0))
    transfer(rally)
    print(f"{rally.count()} rally point up and down")
    for loader in (fence, rally):
        link.mav.mission_clear_all_send(1, 1, loader.mav_mission_type())
        assert wait("MISSION_ACK").mission_type == loader.mav_mission_type()
        link.mav.mission_request_list_send(1, 1, loader.mav_mission_type())
        assert wait("MISSION_COUNT").count == 0
    print("fence and rally points cleared")


def vertex(loader, lat, lon, count):
    command = mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION
    return item(loader, command, lat, lon, 0.0, param1=count)


def item(loader, command, lat, lon, alt, param1=0):
    return mavlink.MAVLink_mission_item_int_message(
        *(1, 1, 0, mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT, command, 0, 0, param1, 0, 0, 0),
        *(round(lat * 1e7), round(lon * 1e7), alt, loader.mav_mission_type()),
    )


def transfer(loader):
    """Up, and down again."""
    kind = loader.mav_mission_type()
    link.mav.mission_count_send(1, 1, loader.count(), kind)
    for _ in range(loader.count()):
        asked = wait(["MISSION_REQUEST", "MISSION_REQUEST_INT"])
        assert asked.mission_type == kind
        link.mav.send(loader.wp(asked.seq))
    ack = wait("MISSION_ACK")
    assert (ack.type, ack.mission_type) == (mavlink.MAV_MISSION_ACCEPTED, kind), ack
    link.mav.mission_request_list_send(1, 1, kind)
    assert wait("MISSION_COUNT").count == loader.count()
    for seq in range(loader.count()):
        link.mav.mission_request_int_send(1, 1, seq, kind)
        back = wait("MISSION_ITEM_INT", lambda m, seq=seq: m.seq == seq)
        sent = loader.wp(seq)
        assert (back.x, back.y, back.command, back.param1) == (
            sent.x,
            sent.y,
            sent.command,
            sent.param1,
        )
    link.mav.mission_ack_send(1, 1, mavlink.MAV_MISSION_ACCEPTED, kind)


# ----------------------------------------------------------------------------------- files

ftp = None


def files(root):
    global ftp
    ftp = mavftp.MAVFTP(link, 1, 1)
    ftp.ftp_settings.idle_detection_time = 1.2  # it waits that long after most operations
    mine = pathlib.Path("mine.bin")
    mine.write_bytes(bytes(range(256)) * 40)
    done(ftp.cmd_list([root or "/"]))
    done(ftp.cmd_mkdir([f"{root}/trial"]))
    done(ftp.cmd_put([str(mine), f"{root}/trial/mine.bin"]))
    done(ftp.process_ftp_reply("put"))
    done(ftp.cmd_list([f"{root}/trial"]))
    listed = {entry.name: entry.size_b for entry in ftp.list_result}
    assert listed["mine.bin"] == mine.stat().st_size, listed
    done(ftp.cmd_crc([f"{root}/trial/mine.bin"]))
    done(ftp.cmd_rename([f"{root}/trial/mine.bin", f"{root}/trial/yours.bin"]))
    done(ftp.cmd_get([f"{root}/trial/yours.bin", "back.bin"]))
    done(ftp.process_ftp_reply("get"))
    assert pathlib.Path("back.bin").read_bytes() == mine.read_bytes()
    done(ftp.cmd_rm([f"{root}/trial/yours.bin"]))
    done(ftp.cmd_rmdir([f"{root}/trial"]))
    print(f"{mine.stat().st_size} bytes up, listed, checked, renamed, down, removed")


def done(returned):
    assert returned.error_code == mavftp.FtpError.Success, (
        returned.operation_name,
        returned.error_code,
    )


# ------------------------------------------------------------------------------------ time


def time_and_ping():
    link.mav.timesync_send(0, 1234567890)
    told = wait("TIMESYNC", lambda m: m.ts1 == 1234567890)
    assert told.tc1 > 0
    link.mav.ping_send(0, 77, 0, 0)
    told = wait("PING", lambda m: m.seq == 77)
    assert (told.target_system, told.target_component) == (255, 0)
    print("TIMESYNC and PING answered")


def refusals():
    """Commands for what there is not are answered."""
    link.mav.command_long_send(1, 1, mavlink.MAV_CMD_DO_PARACHUTE, 0, 0, 0, 0, 0, 0, 0, 0)
    ack = wait("COMMAND_ACK", lambda m: m.command == mavlink.MAV_CMD_DO_PARACHUTE)
    assert ack.result == mavlink.MAV_RESULT_UNSUPPORTED
    link.calibrate_level()
    ack = wait("COMMAND_ACK", lambda m: m.command == mavlink.MAV_CMD_PREFLIGHT_CALIBRATION)
    print(f"no parachute; calibration answered with result {ack.result}")


# --------------------------------------------------------------------------------- signing


def signing():
    """From SETUP_SIGNING on, only who has the key is heard."""
    ask_version()
    link.mav.setup_signing_send(1, 1, KEY, 1)
    link.setup_signing(KEY, sign_outgoing=True)
    wait("HEARTBEAT", lambda m: m.get_signed())
    assert ask_version().get_signed()
    print("signed both ways")
    link.mav.signing.sign_outgoing = False
    link.mav.command_long_send(1, 1, mavlink.MAV_CMD_REQUEST_MESSAGE, 0, 148, 0, 0, 0, 0, 0, 0)
    assert link.recv_match(type="COMMAND_ACK", blocking=True, timeout=1.0) is None
    link.mav.signing.sign_outgoing = True
    ask_version()
    print("an unsigned command is not heard")


def ask_version():
    link.mav.command_long_send(1, 1, mavlink.MAV_CMD_REQUEST_MESSAGE, 0, 148, 0, 0, 0, 0, 0, 0)
    return wait("AUTOPILOT_VERSION")


logging.basicConfig(level=logging.WARNING)
main(*sys.argv[1:])
