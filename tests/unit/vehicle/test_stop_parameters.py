"""A parameter that the vehicle's stop depends on is set by another station: that is told."""

from __future__ import annotations

import pytest

from gcs.gate.effects import Level
from gcs.protocol.autopilot import ARDUPILOT, PX4, Autopilot
from gcs.vehicle.parameters.stop_parameters import StopParameters
from gcs.wire.ids import ParamType
from gcs.wire.messages import ParamValue


def told(autopilot: Autopilot, name: str, *values: float) -> list[list[tuple[Level, str]]]:
    """What each value leads to, one PARAM_VALUE after the other."""
    part = StopParameters()
    heard = [
        part.heard(ParamValue(value, 900, 0, name, ParamType.REAL32), autopilot) for value in values
    ]
    return [[(log.level, log.text) for log in logs] for logs in heard]


@pytest.mark.parametrize(
    ("autopilot", "name", "recorded", "other", "words"),
    [
        (PX4, "MPC_XY_VEL_MAX", 12.0, 20.0, "MPC_XY_VEL_MAX was 12 and is 20: "),
        (PX4, "MPC_TILTMAX_AIR", 45.0, 20.0, "MPC_TILTMAX_AIR was 45 and is 20: "),
        (ARDUPILOT, "WP_SPD", 10.0, 15.0, "WP_SPD was 10 and is 15: "),
        (ARDUPILOT, "WPNAV_SPEED", 1000.0, 1500.0, "WP_SPD was 10 and is 15: "),
    ],
)
def test_a_change_is_told_once_with_both_values(
    autopilot: Autopilot, name: str, recorded: float, other: float, words: str
) -> None:
    """The recorded ones are of PX4 1.14.3 and ArduCopter 4.7."""
    first, changed, again, back = told(autopilot, name, recorded, other, other, recorded)
    assert (first, again) == ([], [])
    ((level, text),) = changed
    assert level is Level.WARNING
    assert text.startswith(words)
    assert [level for level, _ in back] == [Level.INFO]


def test_one_that_was_never_told_is_compared_with_the_recorded() -> None:
    ((level, text),) = told(PX4, "MPC_ACC_HOR", 1.0)[0]
    assert (level, "MPC_ACC_HOR is 1" in text, "with 3" in text) == (Level.WARNING, True, True)


def test_a_stop_that_comes_sooner_is_no_news_and_a_later_one_is() -> None:
    sooner, later = told(ARDUPILOT, "GUID_TIMEOUT", 0.5, 5.0)
    assert sooner == []
    ((level, text),) = later
    assert (level, text.startswith("GUID_TIMEOUT was 0.5 and is 5: ")) == (Level.WARNING, True)


def test_of_other_parameters_nothing_is_told() -> None:
    assert told(PX4, "MPC_THR_HOVER", 0.5, 0.6) == [[], []]


@pytest.mark.parametrize(("value", "others"), [(3.0, 0), (0.5, 0), (9.0, 1)])
def test_a_vehicle_that_waits_less_for_setpoints_stops_no_later(value: float, others: int) -> None:
    part = StopParameters()
    part.heard(ParamValue(value, 900, 0, "GUID_TIMEOUT", ParamType.REAL32), ARDUPILOT)
    known = part.known("ardupilot")
    assert len(known.others) == len(known.mends) == others
    assert ("GUID_TIMEOUT",) not in known.unread
    assert ("WP_SPD", "WPNAV_SPEED") in known.unread


@pytest.mark.parametrize(
    ("speed", "lean"), [("WP_SPD", "ATC_ANGLE_MAX"), ("WPNAV_SPEED", "ANGLE_MAX")]
)
def test_what_was_not_read_is_named_as_the_vehicle_names_what_was(speed: str, lean: str) -> None:
    """4.5 does not know the names of 4.7: `gcs param get` of one ends with BAD_PARAMETER."""
    part = StopParameters()
    scale = 100.0 if speed == "WPNAV_SPEED" else 1.0
    part.heard(ParamValue(10.0 * scale, 900, 0, speed, ParamType.REAL32), ARDUPILOT)
    names = next(each for each in part.known("ardupilot").unread if "ANGLE_MAX" in each)
    assert (names[0], set(names)) == (lean, {"ANGLE_MAX", "ATC_ANGLE_MAX"})
