"""MAVSDK 4's missions: with progress, photos and a pause; raw plans of QGroundControl; fences.

Run: python mavsdk_mission.py udpin://127.0.0.1:14540 px4 survey.plan fence.plan
"""

from __future__ import annotations

import sys
from pathlib import Path
from threading import Event

from mavsdk.plugins import geofence as fences
from mavsdk.plugins import mission as missions
from mavsdk.plugins import mission_raw as raw
from mavsdk.plugins.action import Action
from mavsdk.plugins.camera import Camera
from mavsdk.plugins.telemetry import FlightMode, Telemetry
from mavsdk_station import EARTH_M_PER_DEG, PATIENT_S, Station, ask_for_streams, refusal, until

WAYPOINT = 16
RALLY_POINT = 5100
GLOBAL_RELATIVE_ALT_INT = 6


def item(telemetry: Telemetry, north_m: float, up_m: float, **more: object) -> missions.MissionItem:
    home = telemetry.home()
    return missions.MissionItem(
        latitude_deg=home.latitude_deg + north_m / EARTH_M_PER_DEG,
        longitude_deg=home.longitude_deg,
        relative_altitude_m=up_m,
        speed_m_s=5.0,
        acceptance_radius_m=1.0,
        **more,
    )


def uploaded(plugin: missions.Mission, plan: missions.MissionPlan) -> None:
    """With progress from nothing to everything."""
    seen: list[float] = []
    ended = Event()

    def heard(result: missions.MissionResult, data: missions.ProgressData, _: object) -> None:
        if result is missions.MissionResult.NEXT:
            seen.append(data.progress)
        else:
            seen.append(-1.0 if result is not missions.MissionResult.SUCCESS else 2.0)
            ended.set()

    plugin.upload_mission_with_progress_async(plan, heard)
    assert ended.wait(PATIENT_S), "upload goes on for ever"
    assert seen[-1] == 2.0, f"upload failed: {plugin}"
    print("uploaded with progress", seen[0] < 0.5, max(seen[:-1]) == 1.0, seen == sorted(seen))


def fly_mission(station: Station, telemetry: Telemetry, action: Action) -> None:
    plugin, camera = missions.Mission(station.system), Camera(station.system)
    until(lambda: camera.camera_list().cameras, "camera found")
    photos: list[int] = []
    camera.subscribe_capture_info(lambda info, _: photos.append(info.index))
    shoot = missions.MissionItem.CameraAction
    plan = missions.MissionPlan(
        [
            item(telemetry, 0.0, 5.0, vehicle_action=missions.MissionItem.VehicleAction.TAKEOFF),
            item(telemetry, 15.0, 5.0, is_fly_through=True, camera_action=shoot.TAKE_PHOTO),
            item(telemetry, 15.0, 8.0, yaw_deg=90.0, loiter_time_s=2.0),
            item(
                telemetry,
                0.0,
                8.0,
                camera_action=shoot.START_PHOTO_INTERVAL,
                camera_photo_interval_s=2.0,
            ),
            item(telemetry, -15.0, 8.0, camera_action=shoot.STOP_PHOTO_INTERVAL),
        ]
    )
    plugin.set_return_to_launch_after_mission(True)
    uploaded(plugin, plan)
    again = plugin.download_mission().mission_items
    print("downloaded", len(again), [round(each.relative_altitude_m) for each in again])

    progress: list[tuple[int, int]] = []
    plugin.subscribe_mission_progress(lambda now, _: progress.append((now.current, now.total)))
    action.arm()
    plugin.start_mission()
    until(lambda: telemetry.flight_mode() is FlightMode.MISSION, "flies the mission")
    until(lambda: plugin.mission_progress().current >= 2, "second item done")
    plugin.pause_mission()
    until(lambda: telemetry.flight_mode() is FlightMode.HOLD, "paused")
    print("paused")
    plugin.start_mission()
    until(plugin.is_mission_finished, "mission finished")
    until(lambda: telemetry.flight_mode() is FlightMode.RETURN_TO_LAUNCH, "returns after it")
    until(lambda: progress[-1] == (5, 5), f"progress told to its end, not {progress}")
    print("finished", "in order", progress == sorted(progress))
    until(lambda: not telemetry.armed(), "landed and disarmed")
    print("photos", len(photos) >= 2, photos == list(range(photos[0], photos[0] + len(photos))))
    plugin.clear_mission()
    print("cleared", len(plugin.download_mission().mission_items))


def fly_raw(station: Station, telemetry: Telemetry, action: Action) -> None:
    """ArduPilot's way: item 0 is home, take-off is an item, AUTO begins when it is armed."""
    plugin = raw.MissionRaw(station.system)
    home = telemetry.home()

    def step(seq: int, command: int, north_m: float, up_m: float) -> raw.MissionItem:
        return raw.MissionItem(
            seq=seq,
            frame=GLOBAL_RELATIVE_ALT_INT,
            command=command,
            current=int(seq == 0),
            autocontinue=1,
            x=round((home.latitude_deg + north_m / EARTH_M_PER_DEG) * 1e7),
            y=round(home.longitude_deg * 1e7),
            z=up_m,
        )

    plan = [
        step(0, WAYPOINT, 0.0, 0.0),
        step(1, 22, 0.0, 5.0),
        step(2, WAYPOINT, 15.0, 5.0),
        step(3, WAYPOINT, 15.0, 8.0),
        step(4, 20, 0.0, 0.0),
    ]
    plugin.upload_mission(plan)
    back = plugin.download_mission()
    print("downloaded", [each.command for each in back], [round(each.z) for each in back[1:4]])
    progress: list[int] = []
    plugin.subscribe_mission_progress(lambda now, _: progress.append(now.current))
    action.set_takeoff_altitude(2.0)
    action.arm()
    action.takeoff()
    until(lambda: telemetry.position().relative_altitude_m > 1.0, "off the ground")
    plugin.start_mission()
    until(lambda: telemetry.flight_mode() is FlightMode.MISSION, "flies the mission")
    until(lambda: not telemetry.armed(), "landed and disarmed")
    print("flown in order", progress == sorted(progress), max(progress) >= 3)
    plugin.clear_mission()


def carry_plans(station: Station, plans: list[Path]) -> None:
    """QGroundControl's files, up and down again, item by item."""
    plugin = raw.MissionRaw(station.system)

    def commands(items: list[raw.MissionItem]) -> list[int]:
        return [each.command for each in items]

    for plan in plans:
        given = plugin.import_qgroundcontrol_mission(str(plan))
        plugin.upload_mission(given.mission_items)
        mission_same = commands(plugin.download_mission()) == commands(given.mission_items)
        fence_same = True
        if given.geofence_items:
            plugin.upload_geofence(given.geofence_items)
            fence_same = commands(plugin.download_geofence()) == commands(given.geofence_items)
        print(plan.name, "mission", mission_same, "fence", fence_same)
    rally = [
        raw.MissionItem(
            seq=seq,
            frame=3,
            command=RALLY_POINT,
            x=round(47.3977e7) + seq,
            y=round(8.5455e7),
            z=20.0,
            autocontinue=1,
            mission_type=2,
        )
        for seq in range(3)
    ]
    plugin.upload_rally_points(rally)
    print("rally", [each.x - rally[0].x for each in plugin.download_rallypoints()])
    plugin.clear_mission()
    unknown = [
        raw.MissionItem(seq=0, frame=6, command=WAYPOINT, current=1, autocontinue=1, x=1, y=1),
        raw.MissionItem(seq=1, frame=6, command=31_999, autocontinue=1),
    ]
    print("unknown item", refusal(plugin.upload_mission, unknown))
    plugin.clear_mission()


def fence(station: Station, telemetry: Telemetry) -> None:
    plugin = fences.Geofence(station.system)
    home = telemetry.home()

    def corner(north_m: float, east_m: float) -> fences.Point:
        return fences.Point(
            home.latitude_deg + north_m / EARTH_M_PER_DEG,
            home.longitude_deg + east_m / EARTH_M_PER_DEG,
        )

    square = [corner(-50, -50), corner(50, -50), corner(50, 50), corner(-50, 50)]
    data = fences.GeofenceData(
        polygons=[fences.Polygon(square, fences.FenceType.INCLUSION)],
        circles=[fences.Circle(corner(30.0, 0.0), 5.0, fences.FenceType.EXCLUSION)],
    )
    plugin.upload_geofence(data)
    back = plugin.download_geofence()
    print(
        "geofence",
        [len(polygon.points) for polygon in back.polygons],
        [(round(circle.radius), circle.fence_type.name) for circle in back.circles],
    )
    plugin.clear_geofence()
    print("geofence cleared", refusal(plugin.download_geofence))


def main(url: str, personality: str, plans: list[Path]) -> None:
    with Station(url) as station:
        telemetry, action = Telemetry(station.system), Action(station.system)
        if personality == "ardupilot":
            ask_for_streams(telemetry)
        until(telemetry.health_all_ok, "health all ok")
        carry_plans(station, plans)
        fence(station, telemetry)
        if personality == "px4":
            fly_mission(station, telemetry, action)
        else:
            fly_raw(station, telemetry, action)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2], [Path(name) for name in sys.argv[3:]])
