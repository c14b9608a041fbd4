"""Mission items that come back otherwise than they were sent.

Rows of `behaviour.json`: "MISSION_ITEM with yaw", "NAV_TAKEOFF param1 (pitch)" and "NAV_LOITER_TIME
param3"; autopilots.md, defect 4 of the station.
"""

from __future__ import annotations

import math

import pytest

from tests.unit.vehicle_services.fake_vehicle import Bench
from tests.unit.vehicle_services.flown_vehicle import on_the_ground
from tests.unit.vehicle_services.test_missions import item, results, upload
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import MissionResult

TAKEOFF, WAYPOINT, LOITER_TURNS, LOITER_TIME = 22, 16, 18, 19


def comes_back(personality: Personality, sent: m.MissionItemInt) -> m.MissionItemInt:
    """The item, uploaded as the second one and asked for."""
    bench = Bench(personality)
    told = upload(bench, [item(0), sent._replace(seq=1)])
    assert results(told) == [MissionResult.ACCEPTED]
    (back,) = bench.send(m.MissionRequestInt(1, 1, 1))
    assert isinstance(back, m.MissionItemInt)
    return back


@pytest.mark.parametrize(
    ("sent_deg", "back_deg"),
    [(225.0, 224.99998474121094), (90.0, 90.0), (0.0, 0.0), (-90.0, 270.0), (-1.0, 359.0)],
)
@pytest.mark.parametrize("command", [WAYPOINT, TAKEOFF])
def test_px4_keeps_a_heading_in_radians_of_0_to_2_pi(
    command: int, sent_deg: float, back_deg: float
) -> None:
    back = comes_back("px4", item(1, command)._replace(param4=sent_deg))
    assert back.param4 == back_deg


def test_px4_leaves_a_heading_that_is_not_given() -> None:
    assert math.isnan(comes_back("px4", item(1)).param4)


def test_px4_forgets_a_take_offs_pitch() -> None:
    assert comes_back("px4", item(1, TAKEOFF, p1=15.0)).param1 == 0.0


def test_px4_keeps_a_waypoints_time() -> None:
    assert comes_back("px4", item(1, p1=15.0)).param1 == 15.0


@pytest.mark.parametrize(("sent", "back"), [(12.0, 1.0), (0.0, 1.0), (-5.0, -1.0)])
def test_ardupilot_keeps_the_sign_of_a_timed_circles_radius(sent: float, back: float) -> None:
    given = item(1, LOITER_TIME, p1=10.0)._replace(param3=sent, param4=0.0)
    assert comes_back("ardupilot", given).param3 == back


def test_ardupilot_keeps_other_radii() -> None:
    given = item(1, LOITER_TURNS, p1=2.0)._replace(param3=12.0, param4=0.0)
    assert comes_back("ardupilot", given).param3 == 12.0


def test_ardupilot_keeps_a_heading_as_it_is() -> None:
    """Of what it stores at all: NAV_CONDITION_YAW's angle is its first parameter."""
    given = item(1, 115, p1=225.0)._replace(param4=0.0)
    assert comes_back("ardupilot", given).param1 == 225.0


@pytest.mark.parametrize(
    ("command", "given"),
    [
        (92, (1.0, 0.0, 0.0, 0.0)),
        (181, (0.0, 1.0, 0.0, 0.0)),
        (182, (0.0, 1.0, 1.0, 0.0)),
        (183, (9.0, 1500.0, 0.0, 0.0)),
        (184, (9.0, 1500.0, 2.0, 1.0)),
        (208, (1.0, 0.0, 0.0, 0.0)),
        (211, (1.0, 0.0, 0.0, 0.0)),
        (218, (41.0, 0.0, 0.0, 0.0)),
        (222, (3.0, 0.0, 0.0, 0.0)),
        (600, (1.0, 0.0, 0.0, 0.0)),
        (601, (1.0, 1.0, 0.0, 0.0)),
        (42600, (1.0, 0.0, 0.0, 0.0)),
    ],
)
def test_ardupilot_gives_back_payload_items_as_recorded(
    command: int, given: tuple[float, float, float, float]
) -> None:
    """C8_upload_item_kinds: what came back, in frame 0."""
    sent = item(1, command, frame=2)._replace(x=0, y=0, z=0.0)
    p1, p2, p3, p4 = given
    back = comes_back("ardupilot", sent._replace(param1=p1, param2=p2, param3=p3, param4=p4))
    assert (back.frame, back.command) == (0, command)
    assert (back.param1, back.param2, back.param3, back.param4) == given


def test_ardupilot_gives_back_a_payloads_place() -> None:
    sent = item(1, 94, z=10.0)._replace(param1=1.0, param4=0.0)
    back = comes_back("ardupilot", sent)
    assert (back.frame, back.param1, back.x, back.y, back.z) == (3, 1.0, sent.x, sent.y, 10.0)


@pytest.mark.parametrize("frame", [10, 11])
def test_ardupilot_gives_back_heights_above_terrain_in_frame_10(frame: int) -> None:
    """C8_upload_item_kinds: sent with 10 and 11, back with 10."""
    assert comes_back("ardupilot", item(1, frame=frame)).frame == 10


@pytest.mark.parametrize("command", [211, 42600])
def test_px4_gives_back_payload_items_in_frame_2(command: int) -> None:
    """C8_upload_item_kinds."""
    sent = item(1, command, frame=2)._replace(param1=1.0, param4=0.0, x=0, y=0, z=0.0)
    back = comes_back("px4", sent)
    assert (back.frame, back.param1, back.param2) == (2, 1.0, 0.0)


@pytest.mark.parametrize("command", [92, 94, 181, 182, 183, 184, 208, 218, 222, 600, 601])
def test_px4_refuses_other_payload_items(command: int) -> None:
    """C8_upload_item_kinds: MAV_MISSION_UNSUPPORTED."""
    heard = upload(on_the_ground("px4"), [item(0), item(1, command)])
    assert results(heard) == [MissionResult.UNSUPPORTED]
