"""The quick look at trouble and the thorough one: what a vehicle does is the same by both."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.unit.autopilot.flight import Flight
from tests.unit.failsafes.ground import box, fenced
from vehicle_sim.autopilot.fence.geofence import Crossing
from vehicle_sim.autopilot.health.health_checks import HealthChecks
from vehicle_sim.autopilot.modes import Personality

S = 1_000_000_000

Trouble = Callable[[Flight], object]


def drain(flight: Flight) -> None:
    """To the last threshold, the first one counting in the middle of the flight."""
    for left in (0.5, 0.14, 0.09, 0.06, 0.04):
        flight.vehicle.blocks.body.consumed_mah = (1.0 - left) * 5000.0
        flight.fly(1.0)


def lose_satellites(flight: Flight) -> None:
    flight.vehicle.blocks.sensed.gps_lost = True
    flight.fly(12.0)
    flight.vehicle.blocks.sensed.gps_lost = False
    flight.fly(4.0)


def lose_station(flight: Flight) -> None:
    flight.vehicle.parameters.set(
        "NAV_DLL_ACT" if flight.personality == "px4" else "FS_GCS_ENABLE", 2
    )
    flight.vehicle.gcs_heard(flight.vehicle.time_ns)
    flight.fly(14.0)
    flight.vehicle.gcs_heard(flight.vehicle.time_ns)
    flight.fly(2.0)


def lose_sticks(flight: Flight) -> None:
    channels = (1500, 1500, 1500, 1500, *(0,) * 14)
    for _ in range(20):
        flight.vehicle.override_channels(channels, flight.vehicle.time_ns)
        flight.fly(0.1)
    flight.fly(6.0)
    for _ in range(20):
        flight.vehicle.override_channels(channels, flight.vehicle.time_ns)
        flight.fly(0.1)


def leave_fence(flight: Flight) -> None:
    flight.vehicle.blocks.body.vel_n = 6.0
    flight.fly(6.0)


def change_thresholds(flight: Flight) -> None:
    """A battery that was good enough is no more, without having changed."""
    px4 = flight.personality == "px4"
    flight.fly(1.0)
    flight.vehicle.parameters.set("BAT_LOW_THR" if px4 else "BATT_LOW_MAH", 0.5 if px4 else 4900)
    flight.vehicle.blocks.body.consumed_mah = 3000.0
    flight.fly(3.0)


TROUBLES: tuple[Trouble, ...] = (
    drain,
    lose_satellites,
    lose_station,
    lose_sticks,
    leave_fence,
    change_thresholds,
)


def flown(personality: Personality, trouble: Trouble) -> tuple[list[object], bytes]:
    """All that was said and done, and the state at the end."""
    flight = Flight(personality)
    if trouble is leave_fence:
        fenced(flight, box(personality, 6.0))
    flight.airborne(8.0)
    trouble(flight)
    flight.fly(3.0)
    return [*flight.seen], flight.vehicle.state_bytes()


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
@pytest.mark.parametrize("trouble", TROUBLES, ids=lambda each: each.__name__)
def test_the_quick_look_misses_no_trouble(
    personality: Personality, trouble: Trouble, monkeypatch: pytest.MonkeyPatch
) -> None:
    quiet: list[bool] = []
    look = HealthChecks.failsafes_nominal

    def noted(self: HealthChecks, s: object, crossing: Crossing) -> bool:
        quiet.append(look(self, s, crossing))  # type: ignore[arg-type]  # as it was given
        return quiet[-1]

    monkeypatch.setattr(HealthChecks, "failsafes_nominal", noted)
    quick = flown(personality, trouble)
    assert any(quiet)
    assert not all(quiet)
    monkeypatch.setattr(HealthChecks, "failsafes_nominal", lambda self, s, crossing: False)
    assert flown(personality, trouble) == quick
