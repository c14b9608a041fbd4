"""What screens are told of the mission and the fence on board."""

from __future__ import annotations

import pytest

from gcs import ipc
from gcs.session.effects import Emit
from gcs.station.on_board import PATH_POINTS, fence_on_board, mission_on_board
from gcs.wire.messages import MissionCurrent
from tests.unit.station.test_session_missions import Mission
from tests.unit.vehicle.plans import BOX
from tests.unit.vehicle.test_missions import Script as OfMissions
from tests.unit.vehicle.test_uploaded_fence import INSIDE, OUTSIDE, SQUARE_60, polygon
from tests.unit.vehicle.test_uploaded_fence import Script as OfFence


def test_a_mission_is_told_once_when_it_is_on_board_and_to_whoever_joins() -> None:
    mission = Mission()
    mission.script.run(0.3)
    mission.script.forget()
    mission.upload()
    mission.script.run(1.0)
    (told,) = [
        each.event
        for each in mission.script.told
        if isinstance(each, Emit) and isinstance(each.event, ipc.MissionPath)
    ]
    commands = ["NAV_TAKEOFF", "NAV_WAYPOINT", "NAV_WAYPOINT", "NAV_LAND"]  # of BOX
    assert [each.command for each in told.items] == commands
    assert [(each.seq, each.datum) for each in told.items] == [(n, "home") for n in range(4)]
    assert told.points_enu
    assert told.unverified == ""


def test_what_is_wrong_with_a_mission_that_nobody_verified_is_told() -> None:
    script = OfMissions()
    assert mission_on_board(script.missions) == ipc.MissionPath([])
    script.hear(MissionCurrent(seq=0, total=9))
    told = mission_on_board(script.missions)
    assert told == ipc.MissionPath(
        [], [], "the mission on board (9 items) was not verified: upload or clear it"
    )


def test_a_long_path_is_thinned_and_keeps_its_end() -> None:
    missions = OfMissions()
    missions.upload(BOX)
    missions.missions._path_ned = tuple((float(n), 0.0, 0.0) for n in range(5 * PATH_POINTS + 1))
    told = mission_on_board(missions.missions).points_enu
    assert len(told) <= PATH_POINTS
    assert told[-1] == (0.0, 5.0 * PATH_POINTS, 0.0)


def test_the_fence_on_board_is_placed_about_the_vehicle_s_own_origin() -> None:
    vehicle = OfFence()
    small = [(30.0, 30.0), (30.0, 40.0), (40.0, 40.0)]
    vehicle.answer(*polygon(INSIDE, SQUARE_60), *polygon(OUTSIDE, small))
    stay_in, stay_out = fence_on_board(vehicle.fence, vehicle.telemetry).zones
    assert (stay_in.inclusion, stay_out.inclusion) == (True, False)
    for zone, corners in ((stay_in, SQUARE_60), (stay_out, small)):
        for corner_en, (north_m, east_m) in zip(zone.corners_en, corners, strict=True):
            assert corner_en == pytest.approx((east_m, north_m), abs=0.3)  # PX4's own map


def test_a_fence_that_cannot_be_placed_yet_is_not_drawn() -> None:
    vehicle = OfFence()
    vehicle.answer(*polygon(INSIDE, SQUARE_60))
    vehicle.telemetry.origin = None
    assert fence_on_board(vehicle.fence, vehicle.telemetry) == ipc.VehicleFence([])
