"""The pytest plugin: a simulated vehicle for a test, on a free port, with its own truth.

    def test_my_script(vehicle):
        my_script.fly(vehicle.url)
        assert vehicle.truth().landed

`@pytest.mark.vehicle(personality="ardupilot", speedup=10)` says what kind; `vehicles` is the
factory for more than one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack
from typing import TYPE_CHECKING, TypeAlias

import pytest

if TYPE_CHECKING:
    from vehicle_sim.testing.process import Simulator, SimVehicle

Factory: TypeAlias = "Callable[..., tuple[SimVehicle, ...]]"


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line(
        "markers",
        "vehicle(personality='px4', speedup=1, seed=1, params={}, options=()): what the `vehicle` "
        "fixture starts (mavgate)",
    )


@pytest.fixture
def vehicle(request: pytest.FixtureRequest, vehicles: Factory) -> SimVehicle:
    """One simulated vehicle, which ends with the test."""
    marker = request.node.get_closest_marker("vehicle")
    words = dict(marker.kwargs) if marker is not None else {}
    if marker is not None and marker.args:
        words["personality"] = marker.args[0]
    return vehicles(**words)[0]


@pytest.fixture
def vehicles(request: pytest.FixtureRequest) -> Iterator[Factory]:
    """A factory: `vehicles(count=3, personality="px4")` starts one simulator of three."""
    # Here: every test run loads this file, whether it has vehicles or not.
    from vehicle_sim.testing.process import LOG_LINES, Simulator, SimulatorError

    with ExitStack() as ends:

        def end(simulator: Simulator) -> None:
            simulator.stop()
            request.node.add_report_section(
                "teardown", "vehicle-sim", "\n".join(simulator.log[-LOG_LINES:])
            )

        def start(**words: object) -> tuple[SimVehicle, ...]:
            try:
                simulator = Simulator(**words)  # type: ignore[arg-type]  # the caller's own words
            except TypeError as wrong:
                raise SimulatorError(f"vehicle: {wrong}") from wrong
            ends.callback(end, simulator)
            return simulator.vehicles

        yield start
