"""Sensors that measure something else at once, or that the autopilot says have failed."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import radians, sin

import pytest

from gcs.flight_report.facts import Acceleration, Fact, Failed, Field, Pose, Rotation, Sample
from gcs.flight_report.findings.finding import Situation
from gcs.flight_report.findings.sensors import SensorsDetector
from gcs.frames import Vec3
from tests.unit.flight_report.facts_in_time import check, found

END_S, STRUCK_S = 24.0, 12.0
Measured = Callable[[float], tuple[Vec3, Vec3, float]]
"""Time -> acceleration, rates and field."""


def hover(measured: Measured, roll_deg: float = 0.0) -> Iterator[tuple[float, Fact]]:
    """Messages as a PX4 sends them, 10 times a second."""
    for step in range(int(10 * END_S)):
        t_s = step / 10
        yield t_s, Pose((0.0, 0.0, 5.0), 0.1, 0.0, roll_deg, 0.0, 350.0)
        yield t_s, Sample("attitude", (roll_deg, 0.0, 350.0))
        acceleration, rates, gauss = measured(t_s)
        yield t_s, Acceleration(acceleration)
        yield t_s, Rotation(rates)
        yield t_s, Field(gauss)


def good(t_s: float) -> tuple[Vec3, Vec3, float]:
    return (0.0, 0.0, -9.80665), (0.0, 0.0, 0.0), 0.5


@pytest.mark.parametrize(
    ("name", "after"),
    [
        ("accelerometer", ((0.0, 0.0, -8.0), (0.0, 0.0, 0.0), 0.5)),
        ("gyroscope", ((0.0, 0.0, -9.80665), (0.05, 0.0, 0.0), 0.5)),
        ("compass", ((0.0, 0.0, -9.80665), (0.0, 0.0, 0.0), 0.7)),
    ],
)
def test_a_shift_is_found_when_it_begins_and_only_as_what_it_is(
    name: str, after: tuple[Vec3, Vec3, float]
) -> None:
    result = found(SensorsDetector(), hover(lambda t_s: good(t_s) if t_s < STRUCK_S else after))
    (finding,) = result.findings
    assert finding.title == f"the {name} measured something else at once"
    assert STRUCK_S - 1.5 <= finding.t_s <= STRUCK_S + 2.0
    # From the beginning it is what the autopilot was calibrated with.
    always = found(SensorsDetector(), hover(lambda _: after))
    assert always.findings == []
    assert check(always, name.capitalize()).level is not None


def test_a_vehicle_that_leans_into_the_wind_measures_that() -> None:
    def leaning(t_s: float) -> tuple[Vec3, Vec3, float]:
        return (0.0, -9.80665 * sin(radians(6.0)), -9.7528), (0.0, 0.0, 0.0), 0.5

    result = found(SensorsDetector(), hover(leaning, 6.0))
    assert result.findings == []
    assert "shifted by at most 0" in check(result, "Accelerometer").measured


def test_a_turn_is_no_shift_of_the_gyroscope() -> None:
    """The attitude comes later than the rates that lead to it."""

    def turning() -> Iterator[tuple[float, Fact]]:
        for t_s, fact in hover(good):
            if isinstance(fact, Rotation) and STRUCK_S <= t_s < STRUCK_S + 1.5:
                yield t_s, Rotation((0.0, 0.0, 0.3))
            elif isinstance(fact, Sample):
                turned_s = min(max(t_s - 0.4 - STRUCK_S, 0.0), 1.5)
                yield t_s, Sample("attitude", (0.0, 0.0, 0.3 * 57.29578 * turned_s))
            else:
                yield t_s, fact

    assert found(SensorsDetector(), turning()).findings == []


def test_one_gust_is_no_shift() -> None:
    """It is in the mean of one window."""
    gust = (0.0, 4.0, -9.80665), (0.0, 0.0, 0.0), 0.5
    result = found(SensorsDetector(), hover(lambda t_s: gust if 12.0 < t_s < 12.6 else good(t_s)))
    assert result.findings == []


def test_a_sensor_that_fails_in_flight_is_told_once_and_one_that_never_worked_is_not() -> None:
    all_three = frozenset({"compass", "barometer", "radio receiver"})
    off = frozenset({"radio receiver"})
    failed = frozenset({"radio receiver", "compass"})
    told = [(1.0, off), (2.0, failed), (3.0, off), (4.0, failed), (5.0, failed)]
    facts = [(t_s, Failed(sensors, all_three)) for t_s, sensors in told]
    result = found(SensorsDetector(), facts)
    assert [(each.t_s, each.title) for each in result.findings] == [
        (2.0, "the autopilot said that its compass failed")
    ]
    assert found(SensorsDetector(), facts, Situation(autopilot="px4")).findings == []
