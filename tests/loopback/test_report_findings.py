"""The report of whole flights: an injected fault is the headline, a good flight has no finding.

What is looked for is the name of the fault itself, not of what followed
from it.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import pytest

from gcs.flight_report.scan import scan
from gcs.flight_report.summary import main_trouble
from gcs.record.writer import Recorder
from tests.loopback.flight import PERSONALITIES, Flight, Personality
from tests.loopback.observed import START_NS
from tests.sample_files import elsewhere
from tests.shares import one_in
from vehicle_sim.simulation.fault_script import fault_of

STRUCK_S = (-1.0, 9.0)
"""A finding begins so long before or after the fault: a mean of some seconds, a slow estimator."""


class Fault(NamedTuple):
    kind: str
    keys: Mapping[str, object]
    title: str
    """A part of the headline that names it."""
    within_s: float = STRUCK_S[1]


FAULTS = (
    Fault("gps_lost", {}, "the GPS lost its fix"),
    Fault("gps_glitch", {"offset_ned_m": [60, 0, 0]}, "the estimator's position disagreed"),
    Fault("baro", {"offset_m": 15}, "the estimator's height disagreed"),
    Fault("motor", {"motor": 3, "health": 0.75}, "motor 3 had to give more than the rest"),
    Fault("centre_of_mass", {"forward_m": 0.05}, "motors 1 and 3 had to give more than the rest"),
    Fault("payload", {"mass_kg": 0.7}, "hovering took more thrust at once"),
    Fault("thrust", {"scale": 0.7}, "hovering took more thrust at once"),
    Fault("battery", {"cells": 1}, "the battery"),
    Fault("weak_battery", {"resistance_scale": 6.0, "capacity_scale": 0.3}, "the battery"),
    Fault("wind", {"wind_ned_m_s": [8, -6, 0], "gust_m_s": 0.5}, "the wind was stronger than"),
    Fault("link", {"out": True}, "nothing was heard of the vehicle for"),
    Fault("link", {"loss": 0.4}, "of the vehicle's messages were lost"),
    Fault("reboot", {}, "the autopilot restarted"),
    Fault("clock_jump", {"by_s": 100}, "the vehicle's clock jumped"),
    Fault("mag", {"lost": True}, "the autopilot said that its compass failed"),
)
IN_MEASUREMENTS = (
    Fault("mag", {"offset_gauss": [0.3, 0, 0]}, "the compass measured something else at once"),
    Fault("gyro_bias", {"offset_rad_s": [0.05, 0, 0]}, "the gyroscope measured something else"),
    # Two hovers are compared, and the height must be at rest again.
    Fault("accel_bias", {"offset_m_s2": [0, 0, 1.5]}, "the accelerometer measured", within_s=12.0),
)
"""What the sensors themselves show.  An ArduCopter does not send their measurements unasked."""
GOOD = (*((personality, wind) for personality in PERSONALITIES for wind in (0.0, 3.0, 5.0)),)


def flown(
    directory: Path, personality: Personality, fault: Fault | None, wind_m_s: float = 0.0
) -> tuple[Path, float]:
    """Two legs of 12 m at 6 m and a landing; the record, and when the fault struck."""
    flight = Flight(personality)
    recorder = Recorder.open(directory, personality, "20260101-000000", START_NS)
    flight.recorder = recorder
    if wind_m_s:
        keys = {"wind_ned_m_s": [wind_m_s, 0.5 * wind_m_s, 0.0], "gust_m_s": 0.5}
        assert flight.world.inject(fault_of("wind", keys, "script"), 1)
    flight.hovering(6.0)
    flight.run(4.0)
    flight.goto(12.0, 0.0, 6.0)
    flight.run(1.5)
    struck_ns = flight.now_ns
    injected = None
    if fault is not None:
        injected = fault_of(fault.kind, fault.keys, "script")
        assert flight.world.inject(injected, 1)
    flight.run(8.0)
    flight.goto(0.0, 0.0, 6.0)
    flight.run(10.0)
    if fault is not None and fault.kind == "link" and injected is not None:
        end = injected.ended()
        assert end is not None
        flight.world.inject(end, 1)
        flight.run(2.0)
    flight.say("land")
    flight.run(12.0)
    recorder.close(flight.now_ns)
    return recorder.path, (struck_ns - START_NS) / 1e9


@pytest.mark.parametrize("personality", PERSONALITIES)
@pytest.mark.parametrize("fault", one_in(4, [pytest.param(f, id=f.kind) for f in FAULTS]))
def test_an_injected_fault_is_the_headline(
    tmp_path: Path, personality: Personality, fault: Fault
) -> None:
    assert_it_is_the_headline(tmp_path, personality, fault)


@pytest.mark.parametrize("fault", [pytest.param(f, id=f.kind) for f in IN_MEASUREMENTS])
def test_a_sensor_that_is_wrong_is_the_headline(tmp_path: Path, fault: Fault) -> None:
    assert_it_is_the_headline(tmp_path, "px4", fault)


def assert_it_is_the_headline(tmp_path: Path, personality: Personality, fault: Fault) -> None:
    path, struck_s = flown(tmp_path, personality, fault)
    headline = main_trouble(scan(path).main_vehicle())
    assert headline is not None
    assert fault.title in headline.title
    assert STRUCK_S[0] <= headline.t_s - struck_s <= fault.within_s


@pytest.mark.parametrize(("personality", "wind_m_s"), GOOD)
def test_a_good_flight_has_no_finding(
    tmp_path: Path, personality: Personality, wind_m_s: float
) -> None:
    vehicle = scan(flown(tmp_path, personality, None, wind_m_s)[0]).main_vehicle()
    assert vehicle is not None
    assert [finding.title for finding in vehicle.went_wrong] == []


@pytest.mark.parametrize(
    "name",
    [
        "logs/arducopter_sitl.tlog",
        "autopilots/arducopter_4_7_flight.tlog",
        "autopilots/fence_approach/arducopter_yard_60m_a.tlog",
        "autopilots/fence_approach/arducopter_yard_60m_b.tlog",
        "autopilots/fence_approach/px4_default_150m.tlog",
        "autopilots/fence_approach/px4_yard_60m.tlog",
    ],
)
def test_a_good_flight_of_a_real_autopilot_has_no_finding(name: str) -> None:
    vehicle = scan(elsewhere(name)).main_vehicle()
    assert vehicle is not None
    assert vehicle.totals.take_offs
    assert [finding.title for finding in vehicle.went_wrong] == []
