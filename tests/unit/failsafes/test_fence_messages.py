"""What a client hears and may ask about fence and arming checks."""

from __future__ import annotations

import pytest

from tests.unit.vehicle_services.fake_vehicle import Bench, S, acks, long
from vehicle_sim.autopilot.interface import FenceState, Result
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Sensor

FENCE_STATUS, SYS_STATUS = 162, 1


def ask(bench: Bench, number: int) -> list[m.Message]:
    return bench.send(long(512, number))


def test_fence_status_is_ardupilots_and_only_with_a_fence() -> None:
    bench = Bench("ardupilot")
    assert not [each for each in ask(bench, FENCE_STATUS) if isinstance(each, m.FenceStatus)]
    bench.vehicle.fence_state = FenceState(True, True, True, 3, 2, 61 * S)
    (told,) = [each for each in ask(bench, FENCE_STATUS) if isinstance(each, m.FenceStatus)]
    assert told == m.FenceStatus(61_000, 3, 1, 2, 1)
    other = Bench("px4")
    other.vehicle.fence_state = FenceState(True, True, True, 3, 2, 61 * S)
    assert not [each for each in ask(other, FENCE_STATUS) if isinstance(each, m.FenceStatus)]


@pytest.mark.parametrize(
    ("state", "bits"),
    [
        # As recorded; some clients take that for a breach.
        (FenceState(False, False, False, 0, 0, 0), (0, 0, 0)),
        (FenceState(True, False, False, 0, 0, 0), (1, 0, 1)),
        (FenceState(True, True, False, 0, 0, 0), (1, 1, 1)),
        (FenceState(True, True, True, 1, 3, 0), (1, 1, 0)),
    ],
)
def test_sys_status_tells_of_the_fence(state: FenceState, bits: tuple[int, int, int]) -> None:
    bench = Bench("px4")
    bench.vehicle.fence_state = state
    (told,) = [each for each in ask(bench, SYS_STATUS) if isinstance(each, m.SysStatus)]
    fields = (
        told.onboard_control_sensors_present,
        told.onboard_control_sensors_enabled,
        told.onboard_control_sensors_health,
    )
    assert tuple(int(bool(field & Sensor.GEOFENCE)) for field in fields) == bits


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_the_fence_is_turned_on_and_off_by_command(personality: Personality) -> None:
    bench = Bench(personality)
    assert acks(bench.send(long(207, 1.0))) == [(207, Result.ACCEPTED)]
    assert bench.vehicle.named("enable_fence") == [(1,)]
    bench.vehicle.answers["enable_fence"] = Result.UNSUPPORTED
    assert acks(bench.send(long(207, 0.0))) == [(207, Result.UNSUPPORTED)]
    assert acks(bench.send(long(207, float("nan")))) == [(207, Result.DENIED)]


def test_prearm_checks_are_run_on_demand() -> None:
    bench = Bench("ardupilot")
    assert acks(bench.send(long(401))) == [(401, Result.ACCEPTED)]
    assert bench.vehicle.named("check_arming") == [()]
