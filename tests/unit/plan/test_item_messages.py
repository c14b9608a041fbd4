"""An item of a plan as either message carries it, packed by pymavlink."""

from __future__ import annotations

import math
from typing import Any

import pytest
from pymavlink.dialects.v20 import all as mavlink

from gcs.plan.item_messages import item_of, item_of_degrees
from gcs.wire.codec import decode
from gcs.wire.frame import Frame, split
from gcs.wire.messages import Message, MissionItem, MissionItemInt

WAYPOINT, JUMP = 16, 177
RELATIVE, NO_PLACE = 3, 2


def received(message: Any) -> Message:
    (frame,) = split(message.pack(mavlink.MAVLink(None, srcSystem=255, srcComponent=190)))
    assert isinstance(frame, Frame)
    decoded = decode(frame)
    assert decoded is not None
    return decoded


def old(command: int, frame: int, x: float, y: float) -> MissionItem:
    head = (1, 1, 4, frame, command, 0, 1)
    message = received(mavlink.MAVLink_mission_item_message(*head, 1, 2, 3, 4, x, y, 12.5, 0))
    assert isinstance(message, MissionItem)
    return message


def new(command: int, frame: int, x: int, y: int) -> MissionItemInt:
    head = (1, 1, 4, frame, command, 0, 1)
    message = received(mavlink.MAVLink_mission_item_int_message(*head, 1, 2, 3, 4, x, y, 12.5, 0))
    assert isinstance(message, MissionItemInt)
    return message


def test_a_place_is_the_same_by_either_message() -> None:
    """47.5 and 8.25 degrees are exact in float32."""
    by_degrees = item_of_degrees(old(WAYPOINT, RELATIVE, 47.5, 8.25))
    assert by_degrees == item_of(new(WAYPOINT, RELATIVE, 475_000_000, 82_500_000))


def test_what_is_no_place_stays_the_number_that_it_is() -> None:
    assert item_of_degrees(old(JUMP, NO_PLACE, 2.0, 3.0)) == item_of(new(JUMP, NO_PLACE, 2, 3))


@pytest.mark.parametrize("latitude_deg", [math.nan, math.inf, 1e9])
def test_what_no_item_can_hold_is_none(latitude_deg: float) -> None:
    assert item_of_degrees(old(WAYPOINT, RELATIVE, latitude_deg, 8.25)) is None
