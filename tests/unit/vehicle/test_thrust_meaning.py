"""What a thrust means to a vehicle, by the parameters that it told."""

from __future__ import annotations

import pytest

from gcs.gate.attitude import Attitude, ClimbRate, HoverThrust, UnknownThrust
from gcs.gate.inputs import StreamSeen
from gcs.protocol.autopilot import ARDUPILOT, GENERIC, PX4, Autopilot
from gcs.vehicle.parameters.thrust_meaning import thrust_meaning, with_thrust_meaning

COPTER = {"GUID_OPTIONS": 0.0, "WP_SPD_UP": 2.5, "WP_SPD_DN": 1.5}
"""arducopter_4_7_params.json."""
OLDER = {"GUID_OPTIONS": 0.0, "WPNAV_SPEED_UP": 250.0, "WPNAV_SPEED_DN": 150.0}
"""The same by the names of 4.5, centimetres per second."""


def test_to_px4_it_is_a_share_of_full_thrust() -> None:
    """MPC_THR_HOVER of px4_1_14_params.json."""
    assert thrust_meaning(PX4, {"MPC_THR_HOVER": 0.5}) == HoverThrust(0.5)


@pytest.mark.parametrize("told", [COPTER, OLDER], ids=["4.7", "4.5"])
def test_to_arducopter_it_is_a_climb_rate(told: dict[str, float]) -> None:
    assert thrust_meaning(ARDUPILOT, told) == ClimbRate(2.5, 1.5)


def test_a_speed_down_that_is_told_negative_is_a_speed_down() -> None:
    assert thrust_meaning(ARDUPILOT, {**COPTER, "WP_SPD_DN": -1.5}) == ClimbRate(2.5, 1.5)


@pytest.mark.parametrize("options", [8.0, 9.0, 255.0])
def test_arducopters_thrust_as_thrust_is_not_known(options: float) -> None:
    """GUID_OPTIONS bit 3 (SetAttitudeTarget_ThrustAsThrust; from memory)."""
    means = thrust_meaning(ARDUPILOT, {**COPTER, "GUID_OPTIONS": options})
    assert isinstance(means, UnknownThrust)
    assert "GUID_OPTIONS has bit 3" in means.why


@pytest.mark.parametrize(
    ("autopilot", "told", "missing"),
    [
        (PX4, {}, "MPC_THR_HOVER"),
        (PX4, COPTER, "MPC_THR_HOVER"),
        *((ARDUPILOT, {k: v for k, v in COPTER.items() if k != name}, name) for name in COPTER),
    ],
)
def test_what_was_not_told_is_not_known(
    autopilot: Autopilot, told: dict[str, float], missing: str
) -> None:
    means = thrust_meaning(autopilot, told)
    assert isinstance(means, UnknownThrust)
    assert missing in means.why


def test_of_other_autopilots_nothing_is_known() -> None:
    assert isinstance(thrust_meaning(GENERIC, {"MPC_THR_HOVER": 0.5}), UnknownThrust)


def test_a_sample_without_an_attitude_stays_as_it_is() -> None:
    velocity = StreamSeen("operator", None, (1.0, 0.0, 0.0), None, None, None)
    assert with_thrust_meaning(velocity, PX4, {}) is velocity
    attitude = StreamSeen(
        "operator", None, None, None, None, None, Attitude((1.0, 0.0, 0.0, 0.0), 0.5)
    )
    meant = with_thrust_meaning(attitude, PX4, {"MPC_THR_HOVER": 0.5}).attitude
    assert meant == Attitude((1.0, 0.0, 0.0, 0.0), 0.5, HoverThrust(0.5))
