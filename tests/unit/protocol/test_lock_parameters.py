"""What `--lock` makes of what a vehicle's parameters are."""

from __future__ import annotations

import math

import pytest

from gcs.protocol.lock_parameters import FenceSize, Locking, open_ports, wanted_of

LOCK = Locking(255, FenceSize(150.0, 50.0), enforce_sysid=True)


def becomes(autopilot: str, name: str, value: float) -> float:
    """What that parameter is set to where it is `value`."""
    (wanted,) = (each for each in wanted_of(autopilot, LOCK) if each.name == name)
    return wanted.becomes(value)


@pytest.mark.parametrize("value", [77.0, 6.0, 2.5, -1.0, 1e20, math.inf, math.nan])
@pytest.mark.parametrize(
    ("autopilot", "name", "right"),
    [
        ("px4", "GF_ACTION", 2.0),
        ("ardupilot", "FENCE_ACTION", 1.0),
        ("ardupilot", "FENCE_ENABLE", 1.0),
    ],
)
def test_a_number_that_the_autopilot_does_not_know_is_set_right(
    autopilot: str, name: str, right: float, value: float
) -> None:
    assert becomes(autopilot, name, value) == right


@pytest.mark.parametrize(
    ("autopilot", "name", "known"),
    [("px4", "GF_ACTION", (2, 3, 4, 5)), ("ardupilot", "FENCE_ACTION", (1, 2, 3, 4, 5))],
)
def test_a_breach_action_that_is_known_stays(
    autopilot: str, name: str, known: tuple[int, ...]
) -> None:
    for value in known:
        assert becomes(autopilot, name, float(value)) == value


@pytest.mark.parametrize("value", [math.nan, math.inf, -5.0, 1e20])
def test_what_is_no_set_of_bits_has_none_that_stays(value: float) -> None:
    assert becomes("ardupilot", "FENCE_TYPE", value) == 3.0
    assert becomes("ardupilot", "MAV_OPTIONS", value) == 1.0
    assert becomes("ardupilot", "FENCE_TYPE", 4.0) == 7.0


# ArduPilot: MAVLINK_COMM_0 takes unsigned frames, seen on an ArduCopter 4.7; bit 0 of MAVn_OPTIONS
# is its MAVLINK2_SIGNING_DISABLED.  PX4: MAV_SIGN_CFG is 0 off, 1 not on USB, 2 everywhere.
@pytest.mark.parametrize(
    ("autopilot", "values", "ports"),
    [
        ("ardupilot", {"SERIAL0_PROTOCOL": 2, "SERIAL1_PROTOCOL": 2}, ["SERIAL0"]),
        (
            "ardupilot",
            {"SERIAL0_PROTOCOL": -1, "SERIAL1_PROTOCOL": 5, "SERIAL2_PROTOCOL": 1},
            ["SERIAL2"],
        ),
        (
            "ardupilot",
            {
                "SERIAL0_PROTOCOL": 2,
                "SERIAL1_PROTOCOL": 2,
                "SERIAL3_PROTOCOL": 43,
                "MAV1_OPTIONS": 1,
                "MAV2_OPTIONS": 2,
                "MAV3_OPTIONS": 3,
            },
            ["SERIAL0", "SERIAL3"],
        ),
        ("ardupilot", {}, ["its first MAVLink port"]),
        ("px4", {"MAV_SIGN_CFG": 0}, ["it takes unsigned frames on every port"]),
        ("px4", {"MAV_SIGN_CFG": 1}, ["it takes unsigned frames on USB"]),
        ("px4", {"MAV_SIGN_CFG": 2}, []),
        ("px4", {}, []),
    ],
)
def test_ports_that_take_unsigned_frames_although_there_is_a_key_are_told(
    autopilot: str, values: dict[str, float], ports: list[str]
) -> None:
    told = open_ports(autopilot, values)
    assert [line.startswith(port) for line, port in zip(told, ports, strict=True)] == [True] * len(
        ports
    )
    assert all("unsigned frames" in line for line in told)
