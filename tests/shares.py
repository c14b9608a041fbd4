"""Which share of the longer tests `make test` has; the others are marked `thorough`.

A test that flies is flown in one of five of its cases, one if it has fewer: px4 or ardupilot, or
one of three winds.  Which of them comes first is told by the place of the test in its file, so that
each autopilot flies half of each file.  Of `tests/loopback` every second test is flown.
What is long in other ways is marked where it stands:
`one_in` so many of a list of cases, `seeds`, or `pytest.mark.thorough`.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from typing import cast

import pytest
from _pytest.mark import ParameterSet
from hypothesis import settings

FLIGHTS = (
    "tests/clients/",
    "tests/contract/",
    "tests/loopback/",
    "tests/scenarios/flights/test_flights.py::test_no_new",
    "tests/system/",
    *(
        f"tests/unit/{file}"
        for file in (
            "autopilot/test_airflow.py",
            "autopilot/test_any_orders.py",
            "autopilot/test_flight_quality.py",
            "autopilot/test_guided.py",
            "autopilot/test_mismatch.py",
            "autopilot/test_mission",
            "autopilot/test_modes_and_failsafes.py",
            "autopilot/test_payload_items.py",
            "autopilot/test_real_boot.py",
            "autopilot/test_stale_orders.py",
            "autopilot/test_step_responses.py",
            "autopilot/test_stick_flights.py",
            "autopilot/test_take_off_and_land.py",
            "estimator/test_estimator.py",
            "failsafes/test_failsafe_flights.py",
            "failsafes/test_fence_flights.py",
            "failsafes/test_quiet.py",
            "faults/test_gps_flights.py",
            "faults/test_inject_failure.py::test_it_flies",
            "faults/test_link_faults.py",
            "faults/test_motor_flights.py",
            "faults/test_power_and_wind_flights.py",
            "faults/test_sensor_flights.py",
            "faults/test_sticks_clock_and_reboot.py",
            "model/test_batches.py",
            "model/test_quad.py",
            "model/test_real_sensors.py",
            "model/test_wind.py",
            "parameters/test_every_parameter.py::test_what",
            "vehicle_services/test_calibration.py",
            "vehicle_services/test_fleet_links.py",
            "vehicle_services/test_fuzz.py",
            "vehicle_services/test_real_acks.py::test_messages",
            "vehicle_services/test_recorded_flights.py",
        )
    ),
)
"""Tests that fly a vehicle or start programs in each of their cases."""
HALVED = "tests/loopback/"
"""Whole flights of station and vehicle, over half of what `make test` computes: `make test` flies
every second test of each file there."""
ONE_OF = 5
EXAMPLES = 100
"""Of a property that does not say how many, in `make thorough`; `make test` has a quarter."""


def one_in(count: int, cases: Iterable[object]) -> list[ParameterSet]:
    """Cases of `parametrize`, of which `make test` has one in so many; the first is one."""
    return [_case(case, left=number % count > 0) for number, case in enumerate(cases)]


def examples(count: int) -> int:
    """`max_examples` of a property: so many, and a quarter of them in `make test`."""
    return max(1, count * min(settings().max_examples, EXAMPLES) // EXAMPLES)


def seeds(count: int, in_each_run: int, most: int) -> list[ParameterSet]:
    """Of the seeds from 0 on: one in `count` for `make test`, the others below `in_each_run` for
    `make thorough`, and those from there to `most` for `make soak`."""
    rare = [pytest.param(seed, marks=pytest.mark.soak) for seed in range(in_each_run, most)]
    return one_in(count, range(in_each_run)) + rare


def _case(case: object, *, left: bool) -> ParameterSet:
    if not isinstance(case, ParameterSet):
        case = pytest.param(*case) if isinstance(case, tuple) else pytest.param(case)
    return case._replace(marks=[*case.marks, pytest.mark.thorough]) if left else case


def other_flights(items: Sequence[pytest.Item]) -> Iterator[pytest.Item]:
    """Of the tests that fly: their other cases, and every second test of `tests/loopback`, but for
    what is marked already."""
    cases: dict[tuple[str, int], list[pytest.Item]] = defaultdict(list)
    for item in items:
        if item.nodeid.startswith(FLIGHTS) and not item.get_closest_marker("thorough"):
            cases[item.nodeid.partition("[")[0], place_in_file(item)].append(item)
    for (name, place), flights in cases.items():
        turn, left = divmod(place, 2 if name.startswith(HALVED) else 1)
        flown = [] if left else flights[turn % min(ONE_OF, len(flights)) :: ONE_OF]
        yield from (flight for flight in flights if flight not in flown)


def place_in_file(item: pytest.Item) -> int:
    """Which test of its file this is, whichever of them are asked for; the first one is 0."""
    test = cast("pytest.Function", item)
    return [name for name in vars(test.module) if name.startswith("test_")].index(test.originalname)
