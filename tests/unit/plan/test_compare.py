"""What a real PX4 1.14 and ArduCopter 4.7 gave back of items is the mission that was sent.

Figures: ../shared/data/autopilots, `behaviour.json` and scenario C8_upload_item_kinds.
"""

from __future__ import annotations

import math

import pytest

from gcs.plan.compare import same_meaning
from gcs.plan.model import AutopilotName
from gcs.plan.wire import WireItem
from gcs.wire.ids import Cmd

NAN = math.nan


def item(command: int, *params: float, frame: int = 6, z: float = 10.0, seq: int = 1) -> WireItem:
    p1, p2, p3, p4 = params
    return WireItem(seq, frame, command, 0, 1, p1, p2, p3, p4, 473978329, 85456608, z)


def differences(autopilot: AutopilotName, sent: WireItem, back: WireItem) -> list[str]:
    first = item(Cmd.NAV_WAYPOINT, 0.0, 0.0, 0.0, 0.0, seq=0)
    return [str(each) for each in same_meaning([first, sent], [first, back], autopilot)]


@pytest.mark.parametrize(
    ("autopilot", "sent", "back"),
    [
        ("px4", item(16, 0, 0, 0, 225.0), item(16, 0, 0, 0, 224.99998)),
        ("px4", item(16, 0, 0, 0, -90.0), item(16, 0, 0, 0, 270.0)),
        ("px4", item(16, 0, 0, 0, 360.0), item(16, 0, 0, 0, 0.0)),
        ("px4", item(22, 15.0, 0, 0, NAN), item(22, 0.0, 0, 0, NAN)),
        ("px4", item(17, 0, 0, 10.0, NAN), item(17, 0, 0, 10.0, NAN)),
        ("px4", item(19, 5.0, 0, 8.0, NAN), item(19, 5.0, 0, 8.0, 0.0)),
        ("px4", item(16, 0, 0, 0, NAN, frame=3), item(16, 0, 0, 0, NAN, frame=6)),
        ("ardupilot", item(19, 5.0, 0, 8.0, 0), item(19, 5.0, 0, 1.0, 0, frame=3)),
        ("ardupilot", item(19, 5.0, 0, 0.0, 0), item(19, 5.0, 0, 1.0, 0, frame=3)),
        ("ardupilot", item(19, 5.0, 0, -8.0, 0), item(19, 5.0, 0, -1.0, 0, frame=3)),
        ("ardupilot", item(21, 0, 0, 0, 0), item(21, 0, 0, 0, 1.0, frame=3)),
        ("ardupilot", item(31, 0, 10.0, 0, 1), item(31, 0, 10.0, 0, 1.0, frame=3)),
        ("ardupilot", item(16, 2.0, 5.0, 1.0, 90), item(16, 2.0, 0, 0, 0, frame=3)),
        ("ardupilot", item(181, 1, 1, 3, 4, frame=2), item(181, 1, 1, 0, 0, frame=0)),
        ("ardupilot", item(182, 1, 3, 1.5, 4, frame=2), item(182, 1, 3, 1.5, 0, frame=0)),
        ("ardupilot", item(183, 9, 1500, 3, 4, frame=2), item(183, 9, 1500, 0, 0, frame=0)),
        ("ardupilot", item(211, 1, 1, 3, 4, frame=2), item(211, 1, 1, 0, 0, frame=0)),
        ("ardupilot", item(600, 7, 2, 3, 4, frame=2), item(600, 7, 0, 0, 0, frame=0)),
        ("ardupilot", item(601, 7, -1, 3, 4, frame=2), item(601, 7, -1, 0, 0, frame=0)),
    ],
)
def test_what_was_given_back_means_what_was_sent(
    autopilot: AutopilotName, sent: WireItem, back: WireItem
) -> None:
    assert differences(autopilot, sent, back) == []


@pytest.mark.parametrize(
    ("autopilot", "sent", "back", "told"),
    [
        (
            "ardupilot",
            item(600, 1.6, 0, 0, 0, frame=2),
            item(600, 1.0, 0, 0, 0, frame=0),
            "item 1 (JUMP_TAG): param1: sent 1.6, stored 1",
        ),
        (
            "ardupilot",
            item(601, 9, 40000, 0, 0, frame=2),
            item(601, 9, -25536, 0, 0, frame=0),
            "item 1 (DO_JUMP_TAG): param2: sent 40000, stored -25536",
        ),
        (
            "px4",
            item(16, 0, 0, 0, 225.0),
            item(16, 0, 0, 0, 224.99),
            "item 1 (NAV_WAYPOINT): param4: sent 225, stored 224.99",
        ),
        (
            "px4",
            item(16, 0, 0, 0, NAN),
            item(16, 0, 0, 0, 0.0),
            "item 1 (NAV_WAYPOINT): param4: sent nan, stored 0",
        ),
        (
            "px4",
            item(16, 0, 30.0, 0, NAN),
            item(16, 0, 0.0, 0, NAN),
            "item 1 (NAV_WAYPOINT): param2: sent 30, stored 0",
        ),
        (
            "ardupilot",
            item(19, 5.0, 0, -8.0, 0),
            item(19, 5.0, 0, 1.0, 0, frame=3),
            "item 1 (NAV_LOITER_TIME): param3: sent -8, stored 1",
        ),
        (
            "ardupilot",
            item(18, 2.0, 0, 20.0, 0),
            item(18, 2.0, 0, 12.0, 0, frame=3),
            "item 1 (NAV_LOITER_TURNS): param3: sent 20, stored 12",
        ),
    ],
)
def test_what_is_flown_otherwise_is_told_with_item_field_sent_and_stored(
    autopilot: AutopilotName, sent: WireItem, back: WireItem, told: str
) -> None:
    assert differences(autopilot, sent, back) == [told]
