"""MAVSDK's 3.x API (mavsdk-grpc) flies: coroutines, and a server of its own behind them.

Run: python mavsdk3_flight.py udpin://127.0.0.1:14540 px4 SCRATCH_FOLDER
"""

from __future__ import annotations

import asyncio
import logging
import math
import socket
import sys
import traceback
from collections.abc import AsyncIterator, Awaitable, Callable
from pathlib import Path
from typing import TypeVar

from mavsdk_grpc import System
from mavsdk_grpc.action import OrbitYawBehavior
from mavsdk_grpc.camera import Mode
from mavsdk_grpc.follow_me import Config, TargetLocation
from mavsdk_grpc.geofence import Circle, FenceType, GeofenceData, Point, Polygon
from mavsdk_grpc.mission import MissionItem, MissionPlan
from mavsdk_grpc.mission_raw import MissionItem as RawItem
from mavsdk_grpc.offboard import Attitude, PositionNedYaw, VelocityNedYaw
from mavsdk_grpc.telemetry import FlightMode
from mavsdk_grpc.tune import SongElement, TuneDescription

T = TypeVar("T")
EARTH_M_PER_DEG = 111_194.93
PATIENT_S = 60.0
ANSWER_S = 2.0
"""MAVSDK asks again after so long, instead of 0.5 s: on a slow machine the vehicle is late."""
NAN = float("nan")


async def until(
    stream: AsyncIterator[T], fits: Callable[[T], bool], what: str, timeout_s: float = PATIENT_S
) -> T:
    """The first value of the stream that fits."""

    async def wait() -> T:
        async for value in stream:
            if fits(value):
                return value
        raise AssertionError(f"the stream ended: {what}")

    try:
        return await asyncio.wait_for(wait(), timeout_s)
    except TimeoutError:
        raise AssertionError(f"not within {timeout_s:g} s: {what}") from None


async def first(stream: AsyncIterator[T]) -> T:
    return await until(stream, lambda _: True, "a first value")


async def refusal(call: Awaitable[object]) -> str:
    """The name of the result with which MAVSDK refuses a call."""
    try:
        await asyncio.wait_for(call, PATIENT_S)
    except Exception as error:  # noqa: BLE001  # every plugin has an error class of its own
        result = getattr(error, "_result", None)
        return str(result.result.name) if result is not None else repr(error)
    return "SUCCESS"


async def connected(url: str) -> System:
    """The server is a process of its own, on a port of its own."""
    logging.basicConfig(
        level=logging.WARNING, stream=sys.stdout, format="%(levelname)s: %(message)s"
    )
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    drone = System(port=port)
    await drone.connect(url)
    await drone.core.set_mavlink_timeout(ANSWER_S)
    await until(drone.core.connection_state(), lambda state: state.is_connected, "connected")
    return drone


async def told(drone: System, personality: str) -> None:
    if personality == "ardupilot":
        for set_rate in (
            drone.telemetry.set_rate_attitude_euler,
            drone.telemetry.set_rate_health,
            drone.telemetry.set_rate_landed_state,
            drone.telemetry.set_rate_position,
            drone.telemetry.set_rate_position_velocity_ned,
            drone.telemetry.set_rate_battery,
            drone.telemetry.set_rate_home,
        ):
            await set_rate(10.0)
    await until(drone.telemetry.health_all_ok(), bool, "health all ok")
    print("healthy")
    version = await drone.info.get_version()
    print("version", version.flight_sw_major, version.flight_sw_minor)
    battery = await first(drone.telemetry.battery())
    print("battery", battery.remaining_percent > 90.0)


async def fly(drone: System, personality: str) -> None:
    telemetry, action = drone.telemetry, drone.action
    await action.set_takeoff_altitude(4.0)
    await action.arm()
    await action.takeoff()
    await until(telemetry.armed(), bool, "armed")
    await until(telemetry.position(), lambda p: p.relative_altitude_m > 3.1, "4 m up")
    print("taken off")
    home = await first(telemetry.home())
    await action.set_current_speed(4.0)
    await action.goto_location(
        home.latitude_deg + 10.0 / EARTH_M_PER_DEG,
        home.longitude_deg,
        home.absolute_altitude_m + 6.0,
        90.0,
    )
    await until(
        telemetry.position_velocity_ned(),
        lambda p: abs(p.position.north_m - 10.0) < 0.7 and abs(p.position.down_m + 6.0) < 0.5,
        "10 m north",
    )
    await action.hold()
    await until(telemetry.flight_mode(), lambda mode: mode == FlightMode.HOLD, "holding")
    print("went to a location")
    if personality == "px4":
        await action.do_orbit(
            5.0,
            2.0,
            OrbitYawBehavior.HOLD_FRONT_TO_CIRCLE_CENTER,
            home.latitude_deg,
            home.longitude_deg,
            home.absolute_altitude_m + 6.0,
        )
        await until(
            telemetry.position_velocity_ned(),
            lambda p: abs(math.hypot(p.position.north_m, p.position.east_m) - 5.0) < 0.7,
            "on the circle",
        )
        await action.hold()
        print("orbits")


async def offboard(drone: System) -> None:
    telemetry, control = drone.telemetry, drone.offboard
    await control.set_position_ned(PositionNedYaw(5.0, 5.0, -6.0, 0.0))
    await control.start()
    await until(
        telemetry.position_velocity_ned(),
        lambda p: math.hypot(p.position.north_m - 5.0, p.position.east_m - 5.0) < 0.6,
        "at the position",
    )
    await control.set_velocity_ned(VelocityNedYaw(0.0, -2.0, 0.0, 0.0))
    await until(
        telemetry.position_velocity_ned(),
        lambda p: abs(p.velocity.east_m_s + 2.0) < 0.3,
        "2 m/s westward",
    )
    await control.set_attitude(Attitude(0.0, -8.0, 0.0, 0.4))
    await until(telemetry.attitude_euler(), lambda a: abs(a.pitch_deg + 8.0) < 2.0, "leaning")
    await control.set_velocity_ned(VelocityNedYaw(0.0, 0.0, -1.0, 0.0))
    await until(telemetry.position(), lambda p: p.relative_altitude_m > 6.0, "6 m up")
    await control.stop()
    await until(telemetry.flight_mode(), lambda mode: mode == FlightMode.HOLD, "holding")
    print("offboard position, velocity, attitude")


async def follow(drone: System) -> None:
    home = await first(drone.telemetry.home())
    await drone.follow_me.set_config(
        Config(9.0, 6.0, 0.1, Config.FollowAltitudeMode.CONSTANT, 8.0, 180.0)
    )
    await drone.follow_me.start()
    await until(drone.telemetry.flight_mode(), lambda mode: mode == FlightMode.FOLLOW_ME, "follows")
    await drone.follow_me.set_target_location(
        TargetLocation(
            home.latitude_deg, home.longitude_deg, home.absolute_altitude_m, 0.0, 0.0, 0.0
        )
    )
    await until(drone.telemetry.position(), lambda p: p.relative_altitude_m > 8.0, "8 m up")
    await drone.follow_me.stop()
    print("followed")


async def mission(drone: System) -> None:
    home = await first(drone.telemetry.home())

    def item(north_m: float, up_m: float, photo: bool = False) -> MissionItem:
        shoot = MissionItem.CameraAction
        return MissionItem(
            home.latitude_deg + north_m / EARTH_M_PER_DEG,
            home.longitude_deg,
            up_m,
            5.0,
            True,
            NAN,
            NAN,
            shoot.TAKE_PHOTO if photo else shoot.NONE,
            NAN,
            1.0,
            1.0,
            NAN,
            NAN,
            MissionItem.VehicleAction.NONE,
        )

    await drone.mission.set_return_to_launch_after_mission(True)
    plan = MissionPlan([item(0.0, 6.0), item(15.0, 6.0, photo=True), item(0.0, 8.0)])
    updates = drone.mission.upload_mission_with_progress(plan)
    seen = [update.progress async for update in updates]
    print("mission uploaded", seen == sorted(seen) and seen[-1] == 1.0)
    back = await drone.mission.download_mission()
    print("mission downloaded", [round(each.relative_altitude_m) for each in back.mission_items])
    await drone.mission.start_mission()
    await until(
        drone.mission.mission_progress(), lambda now: now.current == now.total == 3, "finished"
    )
    print("mission finished", await drone.mission.is_mission_finished())
    await until(drone.telemetry.armed(), lambda armed: not armed, "landed and disarmed")


async def raw(drone: System) -> None:
    items = [
        RawItem(seq, 6, 16, int(seq == 0), 1, 0.0, 0.0, 0.0, NAN, 473977000 + seq, 85456000, 9.0, 0)
        for seq in range(40)
    ]
    await drone.mission_raw.upload_mission(items)
    back = await drone.mission_raw.download_mission()
    print("raw mission", len(back), [each.x for each in back][1:] == [each.x for each in items][1:])
    await drone.mission_raw.clear_mission()


async def fence(drone: System) -> None:
    home = await first(drone.telemetry.home())
    north_deg = home.latitude_deg + 50.0 / EARTH_M_PER_DEG
    here = Point(home.latitude_deg, home.longitude_deg)
    there = Point(north_deg, home.longitude_deg)
    beside = Point(north_deg, home.longitude_deg + 0.001)
    await drone.geofence.upload_geofence(
        GeofenceData(
            [Polygon([here, there, beside], FenceType.EXCLUSION)],
            [Circle(here, 80.0, FenceType.INCLUSION)],
        )
    )
    back = await drone.geofence.download_geofence()
    print("geofence", len(back.polygons[0].points), round(back.circles[0].radius))
    await drone.geofence.clear_geofence()


async def services(drone: System, scratch: Path, personality: str) -> None:
    param = drone.param
    name = {"px4": "MPC_XY_CRUISE", "ardupilot": "LOIT_SPEED"}[personality]
    before = await param.get_param_float(name)
    await param.set_param_float(name, before / 2.0)
    print("parameter", await param.get_param_float(name) == before / 2.0)
    await asyncio.sleep(1.0)  # PX4 tells a change twice: the first one's must not meet the next
    await param.set_param_float(name, before)
    print("all parameters", len((await param.get_all_params()).float_params) >= 30)

    here = scratch / "notes.txt"
    here.write_bytes(bytes(range(256)) * 20)
    async for _ in drone.ftp.upload(str(here), "/"):
        pass
    print("identical", await drone.ftp.are_files_identical(str(here), "/notes.txt"))
    (scratch / "back").mkdir()
    async for _ in drone.ftp.download("/notes.txt", str(scratch / "back"), True):
        pass
    print("downloaded", (scratch / "back" / "notes.txt").read_bytes() == here.read_bytes())
    await drone.ftp.remove_file("/notes.txt")

    entries = await drone.log_files.get_entries()
    log = scratch / "flight.log"
    async for _ in drone.log_files.download_log_file(entries[-1], str(log)):
        pass
    print("log", log.stat().st_size == entries[-1].size_bytes > 1000)

    cameras = await until(drone.camera.camera_list(), lambda c: bool(c.cameras), "camera found")
    number = cameras.cameras[0].component_id
    await drone.camera.set_mode(number, Mode.PHOTO)
    photo = asyncio.ensure_future(first(drone.camera.capture_info()))
    await drone.camera.take_photo(number)
    print("photo", (await photo).is_success)

    print("tune", await refusal(drone.tune.play_tune(TuneDescription([SongElement.NOTE_A], 120))))
    if personality == "px4":  # of an ArduPilot's texts it understands none
        progress = [step async for step in drone.calibration.calibrate_gyro()]
        print("calibration", progress[-1].progress == 1.0)
    print("actuator", await refusal(drone.action.set_actuator(9, 0.5)))


async def flight(drone: System, personality: str, scratch: Path) -> None:
    await told(drone, personality)
    await fly(drone, personality)
    await offboard(drone)
    if personality == "px4":
        await follow(drone)
        await mission(drone)
    else:
        await drone.action.land()
        await until(drone.telemetry.armed(), lambda armed: not armed, "landed and disarmed")
    await raw(drone)
    await fence(drone)
    await services(drone, scratch, personality)


async def main(url: str, personality: str, scratch: Path) -> int:
    """The server ends with the last reference to `drone`: an exception would keep one."""
    drone = await connected(url)
    try:
        await flight(drone, personality, scratch)
    except Exception:  # noqa: BLE001  # said in full
        traceback.print_exc()
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(asyncio.run(main(sys.argv[1], sys.argv[2], Path(sys.argv[3]))))
