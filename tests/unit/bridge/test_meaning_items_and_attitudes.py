"""Single mission items of clients."""

from __future__ import annotations

import pytest
from pymavlink.dialects.v20 import all as mavlink

from gcs.bridge.translate.translate import meaning_of
from gcs.gate.states import State
from gcs.protocol.autopilot import ARDUPILOT, PX4
from gcs.wire.messages import Message
from tests.unit.bridge.vehicles import NAN, flying, goal, refusal, sent, words

BOTH = pytest.mark.parametrize("autopilot", [PX4, ARDUPILOT], ids=lambda a: a.name)


def item(current: int, frame: int = 3, lat: float = 47.398742, alt: float = 5.0) -> Message:
    """DroneKit's `simple_goto` and MAVProxy's `guided`: NAV_WAYPOINT, `current` 2."""
    return sent(
        mavlink.MAVLink_mission_item_message(
            1, 1, 0, frame, 16, current, 0, 0, 0, 0, 0, lat, 8.545594, alt
        )
    )


def test_ardupilots_guided_item_is_a_go_to() -> None:
    """0.001 degrees north, 5 m above home, which is 12 m above the origin.  A float32 latitude is
    good to 0.4 m."""
    assert goal(meaning_of(item(2), flying(ARDUPILOT))) == pytest.approx((0, 111.3, 17.0), abs=0.5)
    exact = mavlink.MAVLink_mission_item_int_message(
        1, 1, 0, 6, 16, 2, 0, 0, 0, 0, 0, 473987420, 85455940, 5.0
    )
    there = goal(meaning_of(sent(exact), flying(ARDUPILOT)))
    assert there == pytest.approx((0.0, 111.3188, 17.0), abs=0.01)


def test_a_guided_item_does_not_leave_a_hold() -> None:
    """mode_auto.cpp: "only process guided waypoint if we are in guided mode"."""
    held = flying(ARDUPILOT, state=State.HOLDING)
    assert words(meaning_of(item(2), held)) == ["goto"]


def test_ardupilots_item_for_another_height() -> None:
    assert goal(meaning_of(item(3, alt=8.0), flying(ARDUPILOT))) == (2.0, 1.0, 20.0)
    on_its_way = flying(ARDUPILOT, state=State.MOVING, goal_ned=(30.0, 40.0, -22.0))
    assert goal(meaning_of(item(3, alt=8.0), on_its_way)) == (40.0, 30.0, 20.0)


def test_items_that_are_no_go_to() -> None:
    assert refusal(meaning_of(item(2), flying(PX4))).startswith("UNSUPPORTED")
    assert refusal(meaning_of(item(2, frame=10), flying(ARDUPILOT))).startswith("UNSUPPORTED")
    assert refusal(meaning_of(item(0), flying(ARDUPILOT))).startswith("BAD_MISSION")
    assert refusal(meaning_of(item(2, lat=NAN), flying(ARDUPILOT))).startswith("NON_FINITE")
    assert refusal(meaning_of(item(2, alt=NAN), flying(ARDUPILOT))).startswith("NON_FINITE")
    land = mavlink.MAVLink_mission_item_message(1, 1, 0, 3, 21, 2, 0, 0, 0, 0, 0, 47.3, 8.5, 5.0)
    assert refusal(meaning_of(sent(land), flying(ARDUPILOT))).startswith("UNSUPPORTED")


def test_what_moves_nothing_has_no_meaning() -> None:
    heartbeat = mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3)
    assert refusal(meaning_of(sent(heartbeat), flying(PX4))).startswith("UNSUPPORTED")
