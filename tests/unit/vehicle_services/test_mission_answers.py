"""MISSION_ACK from the sender of an upload: MAVSDK refuses float requests so, and cancels so."""

from __future__ import annotations

import pytest

from tests.unit.vehicle_services.fake_vehicle import Bench, S
from tests.unit.vehicle_services.test_missions import asked_for, count, item, results
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import MissionResult, MissionType


def answer(result: int, kind: int = MissionType.MISSION) -> m.MissionAck:
    return m.MissionAck(1, 1, result, kind)


@pytest.mark.parametrize("kind", [MissionType.MISSION, MissionType.RALLY])
def test_a_refused_float_request_is_asked_again_as_int(kind: MissionType) -> None:
    """As PX4 does; MAVSDK never answers MISSION_REQUEST of a PX4."""
    bench = Bench("px4")
    assert asked_for(bench.send(count(2, kind))) == [("MissionRequest", 0)]
    heard = bench.send(answer(MissionResult.UNSUPPORTED, kind))
    assert asked_for(heard) == [("MissionRequestInt", 0)]
    command = 16 if kind is MissionType.MISSION else 5100
    assert asked_for(bench.send(item(0, command, kind))) == [("MissionRequestInt", 1)]
    assert results(bench.send(item(1, command, kind))) == [MissionResult.ACCEPTED]


def test_a_refused_int_request_is_asked_again_as_float() -> None:
    bench = Bench("px4")
    bench.send(count(2))
    assert asked_for(bench.send(item(0))) == [("MissionRequestInt", 1)]
    assert asked_for(bench.send(answer(MissionResult.UNSUPPORTED))) == [("MissionRequest", 1)]


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_a_cancelled_upload_ends_at_once_and_leaves_the_old_plan(personality: Personality) -> None:
    bench = Bench(personality)
    bench.send(count(1))
    assert results(bench.send(item(0))) == [MissionResult.ACCEPTED]
    before = bench.vehicle.plan
    bench.send(count(5))
    bench.send(item(0, z=9.0))
    assert bench.send(answer(MissionResult.OPERATION_CANCELLED)) == []
    assert asked_for(bench.advance(20 * S)) == []
    assert bench.vehicle.plan == before


def test_an_ack_for_another_kind_of_plan_or_without_an_upload_changes_nothing() -> None:
    bench = Bench("px4")
    assert asked_for(bench.send(answer(MissionResult.UNSUPPORTED))) == []
    bench.send(count(2))
    for result in (MissionResult.UNSUPPORTED, MissionResult.OPERATION_CANCELLED):
        assert bench.send(answer(result, MissionType.FENCE)) == []
    assert bench.send(answer(MissionResult.ACCEPTED)) == []
    assert asked_for(bench.send(item(0))) == [("MissionRequestInt", 1)]
