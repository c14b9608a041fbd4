"""A program on MAVSDK's 3.x API (mavsdk-grpc) flies through the bridge, then tries to leave.

    python bridge_mavsdk3.py udpout://127.0.0.1:14551 px4 fly offboard escape land

The words after the autopilot are what it does, in order; one line is printed for each thing done.
Nothing here knows that a bridge is between it and the vehicle.
"""

from __future__ import annotations

import asyncio
import math
import os
import sys
import traceback
from collections.abc import Awaitable

from mavsdk3_flight import EARTH_M_PER_DEG, System, connected, first, refusal, told, until
from mavsdk_grpc.mission_raw import MissionItem
from mavsdk_grpc.offboard import PositionNedYaw, VelocityNedYaw
from mavsdk_grpc.telemetry import FlightMode

UP_M = 5.0
NAN = float("nan")


class Peer:
    def __init__(self, drone: System, autopilot: str) -> None:
        self.drone = drone
        self.autopilot = autopilot

    async def done(self, what: str, call: Awaitable[object]) -> None:
        result = await refusal(call)
        assert result == "SUCCESS", f"{what}: {result}"
        print(f"{what}: accepted", flush=True)

    async def refused(self, what: str, call: Awaitable[object]) -> None:
        result = await refusal(call)
        assert result != "SUCCESS", what
        print(f"{what}: refused {result}", flush=True)

    async def goto(self, north_m: float, east_m: float, up_m: float) -> None:
        home = await first(self.drone.telemetry.home())
        lat, lon = await self.place(north_m, east_m)
        await self.drone.action.goto_location(lat, lon, home.absolute_altitude_m + up_m, NAN)

    async def place(self, north_m: float, east_m: float) -> tuple[float, float]:
        home = await first(self.drone.telemetry.home())
        east_m_per_deg = EARTH_M_PER_DEG * math.cos(math.radians(home.latitude_deg))
        return (
            home.latitude_deg + north_m / EARTH_M_PER_DEG,
            home.longitude_deg + east_m / east_m_per_deg,
        )

    async def come_to(self, north_m: float, east_m: float, up_m: float) -> None:
        home = await first(self.drone.telemetry.home())
        lat, lon = await self.place(north_m, east_m)
        east_m_per_deg = EARTH_M_PER_DEG * math.cos(math.radians(home.latitude_deg))
        await until(
            self.drone.telemetry.position(),
            lambda now: (
                math.dist(
                    (
                        (now.latitude_deg - lat) * EARTH_M_PER_DEG,
                        (now.longitude_deg - lon) * east_m_per_deg,
                        now.relative_altitude_m,
                    ),
                    (0.0, 0.0, up_m),
                )
                < 1.2
            ),
            f"at {north_m} {east_m} {up_m}",
        )
        await asyncio.sleep(1.5)

    # --------------------------------------------------------------------------- flying

    async def fly(self) -> None:
        drone = self.drone
        await told(drone, self.autopilot)
        print("all parameters", len((await drone.param.get_all_params()).float_params) >= 30)
        plan = await self.mission((15, 0), (15, -15), (0, -15), last=21)
        await self.done("upload", drone.mission_raw.upload_mission(plan))
        back = await drone.mission_raw.download_mission()
        print("mission", [each.command for each in back] == [each.command for each in plan])
        await self.done("take-off height", drone.action.set_takeoff_altitude(UP_M))
        await self.done("arm", drone.action.arm())
        await self.done("take-off", drone.action.takeoff())
        await until(drone.telemetry.position(), lambda p: p.relative_altitude_m > UP_M - 1.0, "up")
        await asyncio.sleep(6.0)
        await self.done("goto", self.goto(12.0, 0.0, UP_M))
        await self.come_to(12.0, 0.0, UP_M)
        await self.done("hold", drone.action.hold())
        await self.done("goto", self.goto(0.0, 0.0, UP_M))
        await self.come_to(0.0, 0.0, UP_M)
        await self.done("start of the mission", drone.mission_raw.start_mission())
        await until(drone.mission_raw.mission_progress(), lambda now: now.current >= 2, "item 2")
        print("flies the mission", flush=True)
        await self.done("hold", drone.action.hold())
        await self.done("return", drone.action.return_to_launch())
        await until(
            drone.telemetry.flight_mode(),
            lambda mode: mode == FlightMode.RETURN_TO_LAUNCH,
            "returns",
        )
        await self.done("hold", drone.action.hold())

    async def mission(self, *places: tuple[float, float], last: int) -> list[MissionItem]:
        """Take-off, waypoints north and east of home, and a last item: 20 return, 21 land."""
        rows = [(22, 0.0, 0.0, UP_M), *((16, *at, UP_M) for at in places)]
        rows.append((last, *(places[-1] if last == 21 else (0.0, 0.0)), 0.0))
        if self.autopilot == "ardupilot":  # item 0 is home
            rows.insert(0, (16, 0.0, 0.0, 0.0))
        items = []
        for seq, (command, north_m, east_m, up_m) in enumerate(rows):
            lat, lon = await self.place(north_m, east_m) if command != 20 else (0.0, 0.0)
            p2, p4 = (1.0 if command == 16 else 0.0), (NAN if command != 20 else 0.0)
            frame = 6 if command != 20 else 2
            at = (round(lat * 1e7), round(lon * 1e7), up_m)
            items.append(
                MissionItem(seq, frame, command, int(seq == 0), 1, 0.0, p2, 0.0, p4, *at, 0)
            )
        return items

    async def offboard(self) -> None:
        control = self.drone.offboard
        now = (await first(self.drone.telemetry.position_velocity_ned())).position
        goal_m = now.north_m + 6.0
        await control.set_position_ned(PositionNedYaw(goal_m, now.east_m, now.down_m, 0.0))
        await self.done("offboard", control.start())
        await until(
            self.drone.telemetry.position_velocity_ned(),
            lambda p: abs(p.position.north_m - goal_m) < 1.2,
            "6 m north",
        )
        print("offboard position", flush=True)
        await control.set_velocity_ned(VelocityNedYaw(-2.0, 0.0, 0.0, 0.0))
        await until(
            self.drone.telemetry.position_velocity_ned(),
            lambda p: p.velocity.north_m_s < -1.5,
            "2 m/s southward",
        )
        print("offboard velocity", flush=True)
        await control.set_velocity_ned(VelocityNedYaw(0.0, 0.0, 0.0, 0.0))
        await asyncio.sleep(2.0)
        await self.done("offboard ended", control.stop())
        await asyncio.sleep(2.0)

    async def land(self) -> None:
        await self.done("land", self.drone.action.land())
        await until(self.drone.telemetry.armed(), lambda armed: not armed, "disarmed")
        print("landed and disarmed", flush=True)

    # ------------------------------------------------------------------------- escaping

    async def escape(self) -> None:
        """One attempt of each kind; all others are flown in tests/loopback."""
        drone = self.drone
        await self.refused("goto outside the yard", self.goto(200.0, 0.0, UP_M))
        home = await self.mission((30, 0), (30, 45), (0, 45), last=20)
        await self.refused(
            "mission that returns through the mast", drone.mission_raw.upload_mission(home)
        )
        name = {"px4": "GF_ACTION", "ardupilot": "FENCE_ENABLE"}[self.autopilot]
        before = await drone.param.get_param_int(name)
        said = await refusal(drone.param.set_param_int(name, 0))
        assert await drone.param.get_param_int(name) == before
        print(f"parameter {name}: kept {said}", flush=True)
        await self.streams()

    async def streams(self) -> None:
        control = self.drone.offboard
        now = (await first(self.drone.telemetry.position_velocity_ned())).position
        await control.set_position_ned(PositionNedYaw(200.0, 0.0, now.down_m, 0.0))
        print("offboard outside:", await refusal(control.start()), flush=True)
        await asyncio.sleep(6.0)
        await control.set_velocity_ned(VelocityNedYaw(-10.0, 0.0, 0.0, 0.0))
        print("offboard again:", await refusal(control.start()), flush=True)
        await asyncio.sleep(20.0)
        await refusal(control.stop())
        await self.done("hold", self.drone.action.hold())
        await asyncio.sleep(4.0)


async def main(url: str, autopilot: str, *words: str) -> None:
    """Ends the process itself: after streams that were cut off, asyncio waits for ever."""
    drone = await connected(url)
    code = 0
    try:
        peer = Peer(drone, autopilot)
        for word in words:
            await getattr(peer, word)()
    except Exception:  # noqa: BLE001  # said in full
        traceback.print_exc()
        code = 1
    drone._stop_mavsdk_server()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


if __name__ == "__main__":
    asyncio.run(main(*sys.argv[1:]))
