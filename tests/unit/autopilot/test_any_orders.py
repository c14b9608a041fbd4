"""Whatever is asked, in whatever order: the vehicle answers, and its numbers stay numbers."""

from __future__ import annotations

from collections.abc import Callable
from math import inf, isfinite, nan

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.shares import examples
from tests.unit.autopilot.flight import Flight, item
from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.interface import Result, Setpoint, SpeedType
from vehicle_sim.autopilot.modes import KINDS, Personality

PLAN = (item(0, 22, up_m=3.0), item(1, 22, up_m=3.0), item(2, 16, 5.0, 5.0, 4.0), item(3, 21))

Order = Callable[[Autopilot], Result | None]


def load(vehicle: Autopilot) -> None:
    if vehicle.check_plan(PLAN) is None:
        vehicle.load_plan(PLAN)


ORDERS: tuple[Order, ...] = (
    *((lambda v, kind=kind: v.set_mode_kind(kind)) for kind in KINDS["px4"]),
    lambda v: v.arm(False),
    lambda v: v.arm(True),
    lambda v: v.disarm(False),
    lambda v: v.take_off(4.0),
    lambda v: v.take_off(None),
    lambda v: v.take_off(nan),
    lambda v: v.reposition((3.0, 1.0, -4.0), 1.0, 2.0),
    lambda v: v.reposition((inf, 1.0, -4.0), None, None),
    lambda v: v.pause(),
    lambda v: v.resume(),
    lambda v: v.change_altitude(6.0),
    lambda v: v.change_altitude(nan),
    lambda v: v.change_speed(SpeedType.GROUND, inf),
    lambda v: v.change_speed(SpeedType.CLIMB, 0.5),
    lambda v: v.change_speed(SpeedType.DESCENT, None),
    lambda v: v.condition_yaw(2.0, True, 1.0, -1),
    lambda v: v.capture_image(0.5, 3),
    load,
    lambda v: v.load_plan(()),
    lambda v: v.mission_start(0, 0),
    lambda v: v.mission_set_current(2),
    lambda v: v.set_home(None),
    lambda v: v.set_setpoint(Setpoint(pos_ned=(1.0, 2.0, -3.0))),
    lambda v: v.set_setpoint(Setpoint(v_ned=(1.0, 0.0, -1.0), yaw_rate_rad_s=0.3)),
    lambda v: v.set_setpoint(Setpoint(a_ned=(0.5, 0.0, 0.0))),
    lambda v: v.reboot(),
)


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
@settings(max_examples=examples(40), deadline=None)
@given(st.lists(st.tuples(st.sampled_from(ORDERS), st.floats(0.0, 3.0)), max_size=25))
def test_any_orders_leave_a_vehicle_that_can_be_landed(
    personality: Personality, script: list[tuple[Order, float]]
) -> None:
    flight = Flight(personality).boot()
    for order, seconds in script:
        order(flight.vehicle)
        flight.fly(seconds)
        estimate = flight.vehicle.estimate
        assert all(map(isfinite, (*estimate.pos_ned, *estimate.v_ned, *estimate.q_ned_from_frd)))
        assert -60.0 < flight.pos[2] < 0.2
    assert flight.vehicle.land() is Result.ACCEPTED
    flight.fly(120.0, lambda: not flight.vehicle.armed)
    assert flight.up_m < 0.1
