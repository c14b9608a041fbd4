"""Somebody at MAVProxy's prompt flies through the bridge, and then tries to leave the fence.

    python bridge_mavproxy.py udpout:127.0.0.1:14551 px4 fly escape land

The words after the autopilot are what is done, in order; one line is printed for each thing done.
Nothing here knows that a bridge is between it and the vehicle.
"""

import pathlib
import re
import sys
import time

from mavproxy_prompt import Prompt
from pymavlink import mavextra

HOMES = {"ardupilot": (-35.363262, 149.165237), "px4": (47.397742, 8.545594)}
UP_M = 5
REFUSED = "(DENIED|TEMPORARILY_REJECTED|UNSUPPORTED|FAILED)"


class Peer:
    def __init__(self, url, autopilot):
        self.autopilot = autopilot
        self.prompt = Prompt(url)
        self.prompt.wait("online system 1", 40.0)
        self.prompt.wait(r"Received \d+ parameters", 60.0)
        print("online, all parameters", flush=True)

    def do(self, command, *patterns, seconds=30.0):
        self.prompt.do(command, *patterns, seconds=seconds)
        sys.stdout.flush()

    def long(self, words, answer):
        command = words.split()[0]
        self.do(f"long {words}", f"{command}: {answer}")

    def place(self, north_m, east_m):
        return mavextra.gps_offset(*HOMES[self.autopilot], east_m, north_m)

    def guided(self, north_m, east_m, up_m, answer):
        lat, lon = self.place(north_m, east_m)
        self.do(f"guided {lat} {lon} {up_m}", f"DO_REPOSITION: {answer}")

    def mission(self, *places, last=21):
        """A file of take-off, waypoints, and a last item; ArduPilot's item 0 is home."""
        home = HOMES[self.autopilot]
        rows = [(0, 16, *home, 0)] if self.autopilot == "ardupilot" else []
        rows.append((3, 22, *home, UP_M))
        rows += [(3, 16, *self.place(*at), UP_M) for at in places]
        rows.append((3, 21, *self.place(*places[-1]), 0) if last == 21 else (2, last, 0, 0, 0))
        lines = ["QGC WPL 110"]
        for seq, (frame, command, lat, lon, alt) in enumerate(rows):
            lines.append(
                f"{seq}\t{int(seq == 0)}\t{frame}\t{command}\t0\t0\t0\t0"
                f"\t{lat:.8f}\t{lon:.8f}\t{alt}\t1"
            )
        pathlib.Path("mission.txt").write_text("\n".join(lines) + "\n")
        return len(rows)

    def hold(self):
        mode = "29 4 3" if self.autopilot == "px4" else "1 5 0"
        self.long(f"DO_SET_MODE {mode}", "ACCEPTED")

    # --------------------------------------------------------------------------- flying

    def fly(self):
        count = self.mission((15, 0), (15, -15), (0, -15))
        self.do("wp load mission.txt", f"Loaded {count} waypoints from", f"Sent all {count}")
        self.prompt.wait("Got MISSION_ACK: (TYPE_)?MISSION: ACCEPTED")
        self.do("wp list", f"Requesting {count} waypoints", f"Saved {count} waypoints to")
        if self.autopilot == "ardupilot":
            self.do("mode guided", "Mode GUIDED")
            self.do("arm throttle", "COMPONENT_ARM_DISARM: ACCEPTED")
            self.do(f"takeoff {UP_M}", "NAV_TAKEOFF: ACCEPTED")
        else:
            self.do("arm throttle", "COMPONENT_ARM_DISARM: ACCEPTED")
            self.long("DO_SET_MODE 29 4 2", "ACCEPTED")
        time.sleep(15.0)
        self.guided(12, 0, UP_M, "ACCEPTED")
        time.sleep(12.0)
        self.hold()
        self.guided(0, 0, UP_M, "ACCEPTED")
        time.sleep(12.0)
        self.do("long MISSION_START 0", "MISSION_START: ACCEPTED", "waypoint 2", seconds=60.0)
        self.hold()
        self.long("NAV_RETURN_TO_LAUNCH", "ACCEPTED")
        self.do("status HEARTBEAT", "HEARTBEAT")
        time.sleep(2.0)
        self.hold()

    def land(self):
        self.do("long NAV_LAND", "NAV_LAND: ACCEPTED", "DISARMED", seconds=90.0)

    # ------------------------------------------------------------------------- escaping

    def escape(self):
        """One attempt of each kind; all others are flown in tests/loopback."""
        self.guided(200, 0, UP_M, REFUSED)
        self.upload_refused((30, 0), (30, 45), (0, 45), last=20)
        name = {"px4": "GF_ACTION", "ardupilot": "FENCE_ENABLE"}[self.autopilot]
        self.do(f"param show {name}", rf"{name} +[0-9.]+")
        before = re.findall(rf"{name} +([0-9.]+)", self.prompt.text)[-1]
        self.do(f"param set {name} {0 if float(before) else 1}")
        time.sleep(4.0)
        self.do(f"param fetch {name}", rf"{name} = {before}")

    def upload_refused(self, *places, last):
        self.mission(*places, last=last)
        self.do(
            "wp load mission.txt",
            "Loaded",
            "Got MISSION_ACK: (TYPE_)?MISSION: (?!ACCEPTED)[A-Z_]+",
            seconds=60.0,
        )


def main(url, autopilot, *words):
    peer = Peer(url, autopilot)
    try:
        for word in words:
            getattr(peer, word)()
    finally:
        peer.prompt.close()


main(*sys.argv[1:])
