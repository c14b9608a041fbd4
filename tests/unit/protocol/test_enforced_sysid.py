"""Which system ids an ArduPilot hears alone, by what it has told of its parameters."""

from __future__ import annotations

import math

import pytest

from gcs.protocol.enforced_sysid import Hears, hears_alone


@pytest.mark.parametrize(
    ("parameters", "hears"),
    [
        ({"SYSID_ENFORCE": 1.0, "SYSID_MYGCS": 255.0}, Hears(255, 255, "SYSID_ENFORCE")),
        ({"SYSID_ENFORCE": 0.0, "SYSID_MYGCS": 255.0}, None),
        ({"MAV_OPTIONS": 3.0, "MAV_GCS_SYSID": 7.0}, Hears(7, 7, "MAV_OPTIONS")),
        ({"MAV_OPTIONS": 2.0, "MAV_GCS_SYSID": 7.0}, None),
        (
            {"MAV_OPTIONS": 1.0, "MAV_GCS_SYSID": 7.0, "MAV_GCS_SYSID_HI": 9.0},
            Hears(7, 9, "MAV_OPTIONS"),
        ),
        (
            {"MAV_OPTIONS": 1.0, "MAV_GCS_SYSID": 7.0, "MAV_GCS_SYSID_HI": 0.0},
            Hears(7, 7, "MAV_OPTIONS"),
        ),
        ({"SYSID_ENFORCE": 1.0}, None),
        ({"SYSID_MYGCS": 255.0}, None),
        ({"SYSID_ENFORCE": math.nan, "SYSID_MYGCS": 255.0}, None),
        ({}, None),
    ],
)
def test_an_ardupilot(parameters: dict[str, float], hears: Hears | None) -> None:
    assert hears_alone("ardupilot", parameters) == hears
    assert hears_alone("px4", parameters) is None


def test_who_is_heard() -> None:
    hears = Hears(7, 9, "MAV_OPTIONS")
    assert [sysid in hears for sysid in (6, 7, 9, 10)] == [False, True, True, False]
    assert hears.words == "7 to 9"
