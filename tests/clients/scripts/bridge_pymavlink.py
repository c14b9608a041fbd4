"""A script on pymavlink flies through the bridge, and then tries to leave the fence.

    python bridge_pymavlink.py udpout:127.0.0.1:14551 px4 fly escape land

The words after the autopilot are what it does, in order; one line is printed for each thing done.
Nothing here knows that a bridge is between it and the vehicle.  It runs on pymavlink alone.
"""

import math
import os
import sys
import time

os.environ["MAVLINK20"] = "1"
from pymavlink import mavextra, mavutil

M = mavutil.mavlink
REL = M.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT
UP_M = 5.0
POSITION, VELOCITY = 0b110111111000, 0b110111000111
"""SET_POSITION_TARGET type masks."""


class Peer:
    def __init__(self, url, autopilot, source_system=250):
        self.autopilot = autopilot
        self.sysid = source_system
        self.link = mavutil.mavlink_connection(url, source_system=source_system)
        self.beaten_s = 0.0
        self.texts = []
        self.home = None

    # ------------------------------------------------------------------------- talking

    def beat(self):
        if time.monotonic() - self.beaten_s > 0.9:
            self.beaten_s = time.monotonic()
            self.link.mav.heartbeat_send(M.MAV_TYPE_GCS, M.MAV_AUTOPILOT_INVALID, 0, 0, 0)

    def receive(self, seconds):
        self.beat()
        message = self.link.recv_match(blocking=True, timeout=seconds)
        if message is not None and message.get_type() == "STATUSTEXT":
            self.read(message)
        return message

    def read(self, message):
        """A text, or the next piece of one that is too long for a message."""
        if message.id and message.chunk_seq and self.texts:
            self.texts[-1] += message.text
        else:
            self.texts.append(message.text)

    def wait(self, kinds, holds=lambda message: True, seconds=60.0, needed=True):
        """The first message of these kinds for which it holds; None if not `needed`."""
        kinds = [kinds] if isinstance(kinds, str) else kinds
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            message = self.receive(0.1)
            if message is not None and message.get_type() in kinds and holds(message):
                return message
        assert not needed, f"no such {kinds} within {seconds} s; texts {self.texts[-6:]}"
        return None

    def latest(self, kind):
        while (message := self.link.recv_match()) is not None:
            if message.get_type() == "STATUSTEXT":
                self.read(message)
        return self.link.messages[kind]

    def rest(self, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.receive(0.05)

    def _final(self, command, send):
        """The final acknowledgement; sent again each second, as MAVSDK and QGroundControl do."""
        for turn in range(40):
            send(turn)
            end = time.monotonic() + 1.5
            while time.monotonic() < end:
                ack = self.wait(
                    "COMMAND_ACK", lambda m: m.command == command, end - time.monotonic(), False
                )
                if ack is None:
                    break
                if ack.result != M.MAV_RESULT_IN_PROGRESS:
                    return ack
                end = time.monotonic() + 60.0
        raise AssertionError(f"no acknowledgement of {command}; texts {self.texts[-6:]}")

    def long(self, command, *params):
        words = [*params, *[0.0] * (7 - len(params))]
        return self._final(
            command, lambda turn: self.link.mav.command_long_send(1, 1, command, turn, *words)
        )

    def at(self, command, north_m, east_m, up_m, params=(0.0, 0.0, 0.0, 0.0), frame=REL):
        lat, lon = self.place(north_m, east_m)
        return self._final(
            command,
            lambda _: self.link.mav.command_int_send(
                *(1, 1, frame, command, 0, 0, *params, round(lat * 1e7), round(lon * 1e7), up_m)
            ),
        )

    def done(self, what, ack):
        assert ack.result == M.MAV_RESULT_ACCEPTED, (what, ack.to_dict(), self.texts[-6:])
        print(f"{what}: accepted", flush=True)

    def refused(self, what, ack):
        assert ack.result != M.MAV_RESULT_ACCEPTED, (what, ack.to_dict())
        result = M.enums["MAV_RESULT"][ack.result].name.removeprefix("MAV_RESULT_")
        print(f"{what}: refused {result} {ack.result_param2} {self.last_text()}", flush=True)

    def last_text(self):
        self.rest(0.3)
        return self.texts[-1] if self.texts else ""

    def refusal_since(self, count):
        """The last text of a refusal, beside others that come, after so many texts."""
        self.rest(0.3)
        return next((text for text in reversed(self.texts[count:]) if "refused" in text), "")

    # --------------------------------------------------------------------------- places

    def place(self, north_m, east_m):
        lat, lon = self.home
        return mavextra.gps_offset(lat, lon, east_m, north_m)

    def here(self):
        """North, east, up of home."""
        fix = self.latest("GLOBAL_POSITION_INT")
        lat, lon = self.home
        east_m = (fix.lon * 1e-7 - lon) * 111_319.49 * math.cos(math.radians(lat))
        return (fix.lat * 1e-7 - lat) * 111_319.49, east_m, fix.relative_alt * 1e-3

    def come_to(self, north_m, east_m, up_m, seconds=60.0, within_m=1.2):
        end = time.monotonic() + seconds
        while math.dist(self.here(), (north_m, east_m, up_m)) > within_m:
            assert time.monotonic() < end, (self.here(), self.texts[-6:])
            self.rest(0.1)

    # --------------------------------------------------------------------------- flying

    def connect(self):
        end = time.monotonic() + 60.0
        while self.link.target_system != 1:
            assert time.monotonic() < end, "no vehicle"
            self.receive(0.05)  # texts that come meanwhile are read, too
        if self.autopilot == "ardupilot":
            self.link.mav.request_data_stream_send(1, 1, M.MAV_DATA_STREAM_ALL, 10, 1)
        fix = self.wait("GLOBAL_POSITION_INT", lambda m: m.lat != 0)
        self.long(M.MAV_CMD_REQUEST_MESSAGE, M.MAVLINK_MSG_ID_HOME_POSITION)
        home = self.wait("HOME_POSITION")
        self.home = home.latitude * 1e-7, home.longitude * 1e-7
        self.sea_m = home.altitude * 1e-3
        assert abs(fix.lat - home.latitude) < 1000
        print("connected", flush=True)

    def parameters(self):
        self.link.mav.param_request_list_send(1, 1)
        names = set()
        first = self.wait("PARAM_VALUE", lambda m: m.param_index != 65535)
        names.add(first.param_id)
        while len(names) < first.param_count:
            names.add(self.wait("PARAM_VALUE").param_id)
        print(f"all parameters: {len(names) == first.param_count}", flush=True)

    def upload(self, items, mission_type=0):
        """Items as (command, frame, params, north_m, east_m, up_m); the type of MISSION_ACK."""
        self.link.mav.mission_count_send(1, 1, len(items), mission_type)
        end = time.monotonic() + 60.0
        while time.monotonic() < end:
            message = self.wait(
                ["MISSION_REQUEST", "MISSION_REQUEST_INT", "MISSION_ACK"],
                lambda m: m.mission_type == mission_type and m.target_system == self.sysid,
            )
            if message.get_type() == "MISSION_ACK":
                return message.type
            command, frame, params, north_m, east_m, up_m = items[message.seq]
            lat, lon = self.place(north_m, east_m) if north_m is not None else (0.0, 0.0)
            self.link.mav.mission_item_int_send(
                *(1, 1, message.seq, frame, command, int(message.seq == 0), 1, *params),
                *(round(lat * 1e7), round(lon * 1e7), up_m, mission_type),
            )
        raise AssertionError("the upload does not end")

    def download(self):
        self.link.mav.mission_request_list_send(1, 1)
        count = self.wait("MISSION_COUNT", lambda m: m.mission_type == 0).count
        commands = []
        for seq in range(count):
            self.link.mav.mission_request_int_send(1, 1, seq)
            item = self.wait("MISSION_ITEM_INT", lambda m, seq=seq: m.seq == seq)
            commands.append(item.command)
        self.link.mav.mission_ack_send(1, 1, 0)
        return commands

    def mission(self, *places, last=None):
        """Take-off, these waypoints (north, east, up, acceptance radius), and `last`."""
        nav = [(16, 3, (0, radius, 0, math.nan), *at) for *at, radius in places]
        items = [(22, 3, (0, 0, 0, math.nan), 0, 0, UP_M), *nav]
        if last is not None:
            items.append((last, 3 if last == 21 else 2, (0, 0, 0, 0), None, None, 0))
        if self.autopilot == "ardupilot":  # item 0 is home
            items.insert(0, (16, 0, (0, 0, 0, 0), 0, 0, self.sea_m))
        return items

    def mode(self, name):
        base, main, sub = (
            self.link.mode_mapping()[name]
            if self.autopilot == "px4"
            else (
                M.MAV_MODE_FLAG_CUSTOM_MODE_ENABLED,
                self.link.mode_mapping()[name],
                0,
            )
        )
        return self.long(M.MAV_CMD_DO_SET_MODE, base | 1, main, sub)

    def in_mode(self, *names, seconds=60.0):
        self.wait("HEARTBEAT", lambda m: self.link.flightmode in names, seconds)

    def arm(self):
        if self.autopilot == "ardupilot":
            self.done("mode GUIDED", self.mode("GUIDED"))
        self.done("arm", self.long(M.MAV_CMD_COMPONENT_ARM_DISARM, 1.0))

    def take_off(self):
        up_m = self.sea_m + UP_M if self.autopilot == "px4" else UP_M
        nan = math.nan
        self.done("take-off", self.long(M.MAV_CMD_NAV_TAKEOFF, 0, 0, 0, nan, nan, nan, up_m))
        low_m = 1.0 if self.autopilot == "px4" else 0.4
        self.wait("GLOBAL_POSITION_INT", lambda m: m.relative_alt * 1e-3 > UP_M - low_m)
        self.rest(3.0)
        print("took off", flush=True)

    def goto(self, north_m, east_m, up_m):
        flags = M.MAV_DO_REPOSITION_FLAGS_CHANGE_MODE
        params = (-1.0, float(flags), 0.0, math.nan)
        return self.at(M.MAV_CMD_DO_REPOSITION, north_m, east_m, up_m, params)

    def go(self, north_m, east_m, up_m):
        self.done(f"goto {north_m} {east_m} {up_m}", self.goto(north_m, east_m, up_m))
        self.come_to(north_m, east_m, up_m)
        self.rest(1.5)

    def fly(self):
        self.connect()
        self.parameters()
        items = self.mission((15, 0, UP_M, 1), (15, -15, UP_M, 1), (0, -15, UP_M, 1), last=21)
        assert self.upload(items) == 0, self.texts[-6:]
        commands = self.download()
        assert commands == [item[0] for item in items], commands
        print(f"mission of {len(items)} items up and down", flush=True)
        self.arm()
        self.take_off()
        self.go(12, 0, UP_M)
        self.done("hold", self.long(M.MAV_CMD_DO_SET_MODE, *self.hold_mode()))
        self.go(0, 0, UP_M)
        self.done("start of the mission", self.long(M.MAV_CMD_MISSION_START))
        self.wait("MISSION_ITEM_REACHED", lambda m: m.seq >= 2, seconds=60.0)
        print("mission item 2 reached", flush=True)
        self.done("return", self.long(M.MAV_CMD_NAV_RETURN_TO_LAUNCH))
        self.in_mode("RTL")
        print("returns", flush=True)
        self.done("hold", self.long(M.MAV_CMD_DO_SET_MODE, *self.hold_mode()))

    def look_on(self):
        """While another one flies: it reads all, and moves nothing."""
        self.connect()
        self.parameters()
        self.wait("HEARTBEAT", lambda m: m.get_srcComponent() == 1 and m.system_status == 4, 240.0)
        self.wait("GLOBAL_POSITION_INT", lambda m: m.relative_alt > 3000, 240.0)
        self.refused("goto of another", self.goto(5, 5, UP_M))
        self.refused("take-off of another", self.long(M.MAV_CMD_NAV_TAKEOFF, *[math.nan] * 7))
        result = self.upload(self.mission((5, 5, UP_M, 1), last=21))
        self.denied("mission of another", result)
        end = time.monotonic() + 60.0
        while not any("in control" in text for text in self.texts):
            assert time.monotonic() < end, self.texts
            self.rest(0.1)
        print(f"told: {next(text for text in self.texts if 'in control' in text)}", flush=True)

    def hold_mode(self):
        return (1 | 128, 4, 3) if self.autopilot == "px4" else (1 | 128, 5, 0)  # LOITER

    def land(self):
        self.done("land", self.long(M.MAV_CMD_NAV_LAND, 0, 0, 0, math.nan, 0, 0, 0))
        self.wait(
            "HEARTBEAT",
            lambda m: m.get_srcComponent() == 1 and not m.base_mode & M.MAV_MODE_FLAG_SAFETY_ARMED,
            seconds=60.0,
        )
        print("landed and disarmed", flush=True)

    def stream(self, seconds, mask, position=(0, 0, 0), velocity=(0, 0, 0), until=lambda: False):
        """A setpoint at 20 Hz, as an offboard program sends it; no longer than `until` it is so."""
        end, turn = time.monotonic() + seconds, 0
        farthest_m = 0.0
        while time.monotonic() < end:
            self.link.mav.set_position_target_local_ned_send(
                *(0, 1, 1, M.MAV_FRAME_LOCAL_NED, mask, *position, *velocity, 0, 0, 0, 0, 0)
            )
            if turn == 30:
                self.link.set_mode("OFFBOARD" if self.autopilot == "px4" else "GUIDED")
            turn += 1
            self.rest(0.05)
            farthest_m = max(farthest_m, *(abs(x) for x in self.here()[:2]))
            if until():
                break
        return farthest_m

    def offboard(self):
        """A stream of positions, then one of velocities, both where they may be flown."""
        start_m = self.here()[0]
        here = self.latest("LOCAL_POSITION_NED")

        def north_m():
            return self.here()[0] - start_m

        goal = (here.x + 6.0, here.y, here.z)
        self.stream(60.0, POSITION, position=goal, until=lambda: abs(north_m() - 6.0) < 1.0)
        self.stream(4.0, POSITION, position=goal)
        assert abs(north_m() - 6.0) < 1.5, (north_m(), self.texts[-6:])
        print("offboard position", flush=True)
        there_m = north_m()
        self.stream(60.0, VELOCITY, velocity=(-1.5, 0, 0), until=lambda: there_m - north_m() > 2.5)
        assert there_m - north_m() > 2.5, (north_m(), self.texts[-6:])
        self.stream(1.5, VELOCITY)
        print("offboard velocity", flush=True)
        self.done("hold", self.long(M.MAV_CMD_DO_SET_MODE, *self.hold_mode()))
        self.rest(2.0)

    # ------------------------------------------------------------------------- escaping

    def escape(self):
        """One attempt of each kind; all others are flown in tests/loopback."""
        self.refused("goto outside the yard", self.goto(200, 0, UP_M))
        around = ((30, 0, UP_M, 1), (30, 45, UP_M, 1), (0, 45, UP_M, 1))
        returns = self.upload(self.mission(*around, last=20))
        self.denied("mission that returns through the mast", returns)
        name = {"px4": "GF_ACTION", "ardupilot": "FENCE_ENABLE"}[self.autopilot]
        self.link.mav.param_request_read_send(1, 1, name.encode(), -1)
        before = self.wait("PARAM_VALUE", lambda m: m.param_id == name)
        told = len(self.texts)
        self.link.mav.param_set_send(1, 1, name.encode(), 0.0, before.param_type)
        after = self.wait("PARAM_VALUE", lambda m: m.param_id == name)
        assert after.param_value == before.param_value or math.isnan(before.param_value), after
        print(f"parameter {name}: kept {self.refusal_since(told)}", flush=True)
        told = len(self.texts)
        far_m = self.stream(25.0, VELOCITY, velocity=(-10, 0, 0))
        refusal = self.refusal_since(told)
        print(f"velocity at the fence: came {far_m:.0f} m {refusal}", flush=True)
        self.done("hold", self.long(M.MAV_CMD_DO_SET_MODE, *self.hold_mode()))
        self.rest(4.0)

    def denied(self, what, result):
        assert result != M.MAV_MISSION_ACCEPTED, what
        name = M.enums["MAV_MISSION_RESULT"][result].name.removeprefix("MAV_MISSION_")
        print(f"{what}: refused {name} {self.last_text()}", flush=True)


def main(url, autopilot, *words):
    peer = Peer(url, autopilot, source_system=251 if "look_on" in words else 250)
    for word in words:
        getattr(peer, word)()


if __name__ == "__main__":
    main(*sys.argv[1:])
