"""Another station puts a mission on board past the bridge, while the one before is flown.

The vehicle flies it at once.  Outside the box round what was verified nothing says that it slows
down for a waypoint of its own, so the gate brakes by what a hold takes.  By its approach, an
ArduCopter at 10 m/s came to rest 22 m outside.
"""

from __future__ import annotations

import math

import pytest
from msgspec import structs

from gcs.gate.policy.parse import DEFAULT
from gcs.gate.states import State
from tests.loopback.flight import PERSONALITIES, Personality
from tests.loopback.plan_clients import mission
from tests.loopback.random_missions import on_board
from tests.loopback.test_set_current import FIELD, flown, with_square

FAR_M = 400.0
MARGIN_M = 2.0


@pytest.mark.parametrize("personality", PERSONALITIES)
def test_the_vehicle_is_stopped_inside_the_fence(personality: Personality) -> None:
    flight = flown(with_square(personality, structs.replace(DEFAULT, fence=(FIELD,))))
    away = mission(personality, (FAR_M, 0.0, 10.0), (FAR_M, 0.0, 10.0), (FAR_M, 0.0, 10.0))
    flight.vehicle.load_plan(on_board(away))
    farthest_m = 0.0
    for _ in range(300):
        flight.clients[1].beat()
        flight.run(0.2)
        farthest_m = max(farthest_m, math.hypot(*flight.truth_enu()[:2]))
    assert flight.is_in(State.HOLDING)
    assert 60.0 < farthest_m < FIELD.radius_m + MARGIN_M
    assert [each.code for each in flight.decisions("aborted")] == ["FENCE_BREACH"]
