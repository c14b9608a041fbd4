"""A flight with MAVProxy, driven by its own commands as somebody at its prompt types them.

    python mavproxy_flight.py ardupilot tcp:127.0.0.1:5760
    python mavproxy_flight.py px4 udpin:127.0.0.1:14540

One line for each command that did what it should; the rest is in transcript.txt, in the working
directory, where MAVProxy's own files are too.
"""

import pathlib
import sys
import time

from mavproxy_prompt import Prompt
from pymavlink import DFReader, mavextra

HOMES = {"ardupilot": (-35.363262, 149.165237), "px4": (47.397742, 8.545594)}
SPEED = {"ardupilot": ("WPNAV_SPEED", 400), "px4": ("MPC_XY_CRUISE", 4)}


def main(personality, url):
    prompt = Prompt(url)
    try:
        prompt.wait("online system 1")
        prompt.wait(r"Received \d+ parameters")
        print("online")
        # PX4's EVENTs are not in MAVProxy's dialect: it counts each of them as lost.
        lost = {"ardupilot": "0", "px4": r"\d{1,2}"}[personality]
        prompt.do("link", rf"link 1 OK \(.* {lost} lost")
        prompt.do("version")
        prompt.do("status AUTOPILOT_VERSION", r"AUTOPILOT_VERSION \{capabilities : [1-9]\d+")
        parameters(prompt, personality)
        plans(prompt, personality)
        if personality == "ardupilot":
            fly_copter(prompt)
        else:
            fly_px4(prompt)
        prompt.do("link", rf"link 1 OK \(.* {lost} lost")
        files(prompt, personality)
        prompt.do("reboot", "PREFLIGHT_REBOOT_SHUTDOWN: ACCEPTED")
        time.sleep(1.5)
        prompt.do("link", "link 1 OK")
    finally:
        prompt.close()


def parameters(prompt, personality):
    name, slower = SPEED[personality]
    prompt.do("param fetch", r"Received \d+ parameters")
    prompt.do(f"param set {name} {slower}")
    prompt.do(f"param fetch {name}", rf"{name} = {slower}\.0+")
    prompt.do(f"param show {name}", rf"{name} +{slower}\.0")
    prompt.do("param save all.parm", r"Saved \d+ parameters to all.parm")
    if personality == "ardupilot":
        prompt.do("param diff", rf"{name} +{slower}\.0+ 1000\.0+")
        prompt.do(f"param revert {name}", "Reverted 1 parameters")
    else:
        prompt.do(f"param set {name} 5")


def plans(prompt, personality):
    lat, lon = HOMES[personality]

    def place(east_m, north_m):
        return mavextra.gps_offset(lat, lon, east_m, north_m)

    mission = [(0, 16, lat, lon, 584, 1), (3, 22, lat, lon, 10, 0)]
    mission += [(3, 16, *place(*to), 12, 0) for to in ((0, 20), (20, 20), (20, 0))]
    write_wpl("mission.txt", mission if personality == "ardupilot" else mission[1:])
    count = len(mission) - (personality == "px4")
    prompt.do(
        "wp load mission.txt", f"Loaded {count} waypoints from", f"Sent all {count} waypoints"
    )
    prompt.wait("Got MISSION_ACK: (TYPE_)?MISSION: ACCEPTED")
    prompt.do("wp list", f"Requesting {count} waypoints", f"Saved {count} waypoints to")
    corners = [place(*at) for at in ((-60, -60), (60, -60), (60, 60), (-60, 60))]
    write_wpl("fence.txt", [(3, 5001, *corner, 0, 0, 4) for corner in corners])
    prompt.do("fence load fence.txt", "Loaded 4 fence items", "Sent all 4 fence items")
    prompt.wait("Got MISSION_ACK: (TYPE_)?FENCE: ACCEPTED")
    prompt.do("fence list", "Requesting 4 fence items", "Saved 4 fence items to")
    write_wpl("rally.txt", [(3, 5100, *place(5, 5), 20, 0)])
    prompt.do("rally load rally.txt", "Loaded 1 rally items", "Sent all 1 rally items")
    prompt.wait("Got MISSION_ACK: (TYPE_)?RALLY: ACCEPTED")
    prompt.do("rally list", "Requesting 1 rally items", "Saved 1 rally items to")


def write_wpl(name, items):
    """QGC WPL 110: frame, command, place, height, current, first parameter."""
    lines = ["QGC WPL 110"]
    for seq, (frame, command, lat, lon, alt, current, *p1) in enumerate(items):
        first = p1[0] if p1 else 0
        lines.append(
            f"{seq}\t{current}\t{frame}\t{command}\t{first}\t0\t0\t0\t{lat:.8f}\t{lon:.8f}\t{alt}\t1"
        )
    pathlib.Path(name).write_text("\n".join(lines) + "\n")


def fly_copter(prompt):
    lat, lon = mavextra.gps_offset(*HOMES["ardupilot"], 0, -15)
    prompt.do("fence enable", "DO_FENCE_ENABLE: ACCEPTED", "fence (present|enabled)")
    prompt.do("mode guided", "Mode GUIDED")
    prompt.do("arm throttle", "COMPONENT_ARM_DISARM: ACCEPTED", "ARMED")
    prompt.do("takeoff 15", "NAV_TAKEOFF: ACCEPTED", r"height \d+")
    prompt.do(f"guided {lat} {lon} 30", "DO_REPOSITION: ACCEPTED", r"height [23]\d")
    prompt.do("wp set 2")
    prompt.do("mode auto", "Mode AUTO", "waypoint 3", "waypoint 4", seconds=60)
    prompt.do("mode loiter", "Mode LOITER")
    prompt.do("rc 3 1800", r"height [23]\d")
    prompt.do("rc 3 1500")
    prompt.do("mode alt_hold", "Mode ALT_HOLD")
    prompt.do("rc 3 1700", r"height [345]\d")
    prompt.do("rc all 0")
    prompt.do("fence disable", "DO_FENCE_ENABLE: ACCEPTED", "fence (disabled|removed)")
    prompt.do("mode rtl", "Mode RTL", "DISARMED", seconds=90)


def fly_px4(prompt):
    """MAVProxy's `mode` and `takeoff` do not speak PX4's language; its `long` says anything."""
    lat, lon = mavextra.gps_offset(*HOMES["px4"], 0, -15)
    prompt.do("arm throttle", "COMPONENT_ARM_DISARM: ACCEPTED", "ARMED")
    prompt.do("long DO_SET_MODE 29 4 2", "DO_SET_MODE: ACCEPTED", "Mode TAKEOFF")
    prompt.wait("LOITER>")
    prompt.do(f"guided {lat} {lon} 30", "DO_REPOSITION: ACCEPTED", r"height [23]\d", seconds=60)
    prompt.do("long DO_SET_MODE 29 4 4", "Mode MISSION", "waypoint 2", "waypoint 3", seconds=60)
    prompt.do("long DO_SET_MODE 81 3", "DO_SET_MODE: TEMPORARILY_REJECTED")  # without sticks
    prompt.do("long NAV_LAND", "NAV_LAND: ACCEPTED", "Mode LAND", "DISARMED", seconds=90)


def files(prompt, personality):
    root = "" if personality == "ardupilot" else "/fs/microsd"
    mine = pathlib.Path("mine.txt")
    mine.write_text("a line of mine\n" * 400)
    prompt.do("log list", r"Log \d+  numLogs 1 .*size [1-9]\d+")
    number = 1 if personality == "ardupilot" else 0
    prompt.do(f"log download {number} log.bin", "Finished downloading log.bin", seconds=60)
    if personality == "ardupilot":
        log = DFReader.DFReader_binary("log.bin")
        assert log.recv_match(type="POS") is not None
        log.close()
    else:
        assert pathlib.Path("log.bin").read_bytes().startswith(b"ULog")
    prompt.do(f"ftp put mine.txt {root}/mine.txt", "Sent file of length 6000")
    prompt.do(f"ftp list {root or '/'}", r"mine.txt\s+6000")
    prompt.do(f"ftp crc {root}/mine.txt", r"crc: .*mine.txt 0x[0-9a-f]{8}")
    prompt.do(f"ftp get {root}/mine.txt back.txt", "Wrote 6000 bytes to back.txt")
    prompt.do(f"ftp rm {root}/mine.txt", "Removing")
    prompt.do(f"ftp list {root or '/'}", "Total size")
    assert pathlib.Path("back.txt").read_bytes() == mine.read_bytes()
    prompt.do("status", r"SYS_STATUS \{")


main(*sys.argv[1:])
