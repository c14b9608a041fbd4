"""MAVSDK 4 flies a mission on a vehicle whose time runs faster, and measures how much faster.

Run: python mavsdk_speedup.py udpin://127.0.0.1:14540 px4 10 [SECONDS]
SECONDS of wall time is about how long the mission lasts.
"""

from __future__ import annotations

import math
import sys
import time

from mavsdk.plugins.action import Action
from mavsdk.plugins.mission_raw import MissionItem, MissionRaw
from mavsdk.plugins.param import Param
from mavsdk.plugins.telemetry import FlightMode, Telemetry
from mavsdk_station import EARTH_M_PER_DEG, PATIENT_S, Station, ask_for_streams, until

SPEED_M_S = 5.0
LEG_M = 80.0
TAKEOFF, WAYPOINT, RETURN, CHANGE_SPEED = 22, 16, 20, 178


def there_and_back(telemetry: Telemetry, legs: int) -> list[MissionItem]:
    home = telemetry.home()

    def item(
        seq: int, command: int, north_m: float, p1: float = 0.0, p2: float = 0.0
    ) -> MissionItem:
        return MissionItem(
            seq=seq,
            frame=6,
            command=command,
            current=int(seq == 0),
            autocontinue=1,
            param1=p1,
            param2=p2,
            param4=math.nan,
            x=round((home.latitude_deg + north_m / EARTH_M_PER_DEG) * 1e7),
            y=round(home.longitude_deg * 1e7),
            z=10.0,
        )

    flown = [item(3 + leg, WAYPOINT, LEG_M * (leg % 2)) for leg in range(1, legs + 1)]
    return [
        item(0, WAYPOINT, 0.0),
        item(1, TAKEOFF, 0.0),
        item(2, CHANGE_SPEED, 0.0, 1.0, SPEED_M_S),
        item(3, WAYPOINT, 0.0),
        *flown,
        item(4 + legs, RETURN, 0.0),
    ]


def main(url: str, personality: str, factor: float, wall_s: float) -> None:
    with Station(url) as station:
        telemetry, action = Telemetry(station.system), Action(station.system)
        plugin = MissionRaw(station.system)
        lost: list[bool] = []
        station.system.subscribe_is_connected(lambda connected, _: lost.append(not connected))
        if personality == "ardupilot":
            ask_for_streams(telemetry)
        until(telemetry.health_all_ok, "health all ok")
        items = there_and_back(telemetry, math.ceil(wall_s * factor * SPEED_M_S / LEG_M))
        # PX4 has no home among its items.
        if personality == "px4":
            items = items[1:]
            for each in items:
                if each.command in (CHANGE_SPEED, RETURN):
                    each.frame = 2  # it refuses items without a place in a frame of places
            for seq, each in enumerate(items):
                each.seq, each.current = seq, int(seq == 0)
        plugin.upload_mission(items)
        # An armed vehicle that does not take off disarms after 10 s of its own time: 0.2 s at 50.
        # MAVSDK holds a PX4 that it has seen in mission mode before it arms it: armed first.
        if personality == "px4":
            Param(station.system).set_param_float("COM_DISARM_PRFLT", -1.0)
            action.arm()
            plugin.start_mission()
        else:
            Param(station.system).set_param_int("DISARM_DELAY", 0)
            action.arm()
            action.takeoff()
            plugin.start_mission()
        until(telemetry.in_air, "in the air")
        seen: list[tuple[int, int]] = []  # (wall time, the vehicle's time), in ns
        telemetry.subscribe_attitude_euler(
            lambda angle, _: seen.append((time.monotonic_ns(), angle.timestamp_us * 1000))
        )
        patient_s = wall_s * 4.0 + PATIENT_S
        ended = {"px4": FlightMode.RETURN_TO_LAUNCH, "ardupilot": FlightMode.MISSION}[personality]
        if personality == "px4":
            until(lambda: telemetry.flight_mode() is ended, "mission over", patient_s)
        until(lambda: not telemetry.armed(), "landed and disarmed", patient_s)
        (began_ns, first_ns), (ended_ns, last_ns) = seen[0], seen[-1]
        print(f"wall {(ended_ns - began_ns) * 1e-9:.3f} s")
        print(f"factor {(last_ns - first_ns) / (ended_ns - began_ns):.4f}")
        print("link lost", sum(lost))


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], float(sys.argv[3]), float([*sys.argv, "5"][4]))
