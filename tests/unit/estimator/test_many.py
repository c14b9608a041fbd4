"""Sensors and estimator over many vehicles, and over motions that no vehicle makes."""

from __future__ import annotations

import struct
from dataclasses import fields
from math import cos, isfinite, pi, sin, sqrt
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vehicle_sim.estimation.estimated import Estimated
from vehicle_sim.estimation.estimator import align, estimate, health
from vehicle_sim.numerics.lanes import Lanes, batched
from vehicle_sim.plant.body import Body
from vehicle_sim.plant.sensed import Sensed
from vehicle_sim.plant.sensors import MEMS, sense, switch_on

_LETTERS = {"float": "d", "int": "Q", "bool": "?"}


def to_bytes(kind: type[Any], block: object) -> bytes:
    return b"".join(
        struct.pack("<" + _LETTERS[str(each.type)], getattr(block, each.name))
        for each in fields(kind)
    )


def swing(body: Body, vehicle: int, k: int) -> None:
    """A motion of this vehicle's own: it stands, then climbs, turns, leans and jolts."""
    if k < 125:
        return
    t = (k - 125) * 0.004
    lean, yaw = 0.4 * sin(0.7 * t + vehicle), 0.3 * t * (vehicle % 5 - 2)
    body.qw, body.qx = cos(0.5 * lean) * cos(0.5 * yaw), sin(0.5 * lean) * cos(0.5 * yaw)
    body.qy, body.qz = sin(0.5 * lean) * sin(0.5 * yaw), cos(0.5 * lean) * sin(0.5 * yaw)
    body.rate_x, body.rate_z = 0.28 * cos(0.7 * t + vehicle), 0.3 * (vehicle % 5 - 2)
    body.vel_n, body.vel_d = 3.0 * sin(0.2 * t), -0.5 * vehicle * 0.1
    body.pos_n, body.pos_d = 15.0 * (1.0 - cos(0.2 * t)), body.vel_d * t
    body.sf_n = 0.6 * cos(0.2 * t) + (200.0 if vehicle == 3 and k % 400 == 0 else 0.0)


def inject(sensed: Sensed, est: Estimated, vehicle: int, k: int) -> None:
    """Trouble, other for every vehicle, so that all branches are gone through."""
    if k == 400:
        sensed.gps_lost = vehicle % 4 == 0
        sensed.mag_lost = vehicle % 4 == 1
        sensed.baro_lost = vehicle % 4 == 2
        sensed.gps_off_n = 40.0 if vehicle % 4 == 3 else 0.0
        sensed.baro_off_m = 30.0 if vehicle % 3 == 0 else 0.0
        sensed.gyro_off_y = 0.01 * vehicle
    if k == 1500:
        sensed.gps_lost = sensed.baro_lost = False
    if k == 900 and vehicle % 5 == 0:
        align(est)


@pytest.mark.parametrize("count", [1, 5, 60])
def test_a_batch_senses_and_estimates_the_same_bytes_as_each_vehicle_by_itself(count: int) -> None:
    steps = 2400 if count <= 5 else 600
    alone = [(Body(), Sensed(), Estimated()) for _ in range(count)]
    bodies, sensors, estimates = (
        Lanes(Body, count),
        Lanes(Sensed, count),
        Lanes(Estimated, count),
    )
    for vehicle, (_, sensed, _) in enumerate(alone):
        switch_on(sensed, 5, vehicle, 47.4, MEMS)
        switch_on(sensors.lane(vehicle), 5, vehicle, 47.4, MEMS)
    sense_all, estimate_all = batched(sense), batched(estimate)
    for k in range(1, steps + 1):
        for vehicle, (body, sensed, est) in enumerate(alone):
            swing(body, vehicle, k)
            inject(sensed, est, vehicle, k)
            sense(sensed, body, MEMS, k)
            estimate(est, sensed, k)
            lane = bodies.lane(vehicle)
            swing(lane, vehicle, k)
            inject(sensors.lane(vehicle), estimates.lane(vehicle), vehicle, k)
        sense_all(sensors.all, bodies.all, MEMS, k)
        estimate_all(estimates.all, sensors.all, k)
    for vehicle, (_, sensed, est) in enumerate(alone):
        assert to_bytes(Sensed, sensors.lane(vehicle)) == to_bytes(Sensed, sensed)
        assert to_bytes(Estimated, estimates.lane(vehicle)) == to_bytes(Estimated, est)
    if count == 5:
        assert {est.resets for _, _, est in alone} > {0}
    assert len({to_bytes(Estimated, est) for _, _, est in alone}) == count


wild = st.one_of(
    st.floats(allow_nan=True, allow_infinity=True),
    st.floats(-1e3, 1e3),
)


@given(
    st.lists(
        st.tuples(*[wild] * 9, st.floats(-pi, pi), st.floats(-pi, pi)), min_size=1, max_size=8
    ),
    st.integers(0, 2**64 - 1),
)
def test_no_motion_makes_an_estimate_that_is_no_number(
    motions: list[tuple[float, ...]], seed: int
) -> None:
    body, sensed, est = Body(), Sensed(), Estimated()
    switch_on(sensed, seed, 0, -35.0, MEMS)
    k = 0
    for motion in motions:
        body.pos_n, body.pos_e, body.pos_d = motion[:3]
        body.vel_n, body.vel_d = motion[3:5]
        body.rate_x, body.rate_z = motion[5:7]
        body.sf_e, body.sf_d = motion[7:9]
        body.qw, body.qy = cos(motion[9]), sin(motion[9])
        for _ in range(130):
            k += 1
            sense(sensed, body, MEMS, k)
            estimate(est, sensed, k)
    values = [getattr(est, each.name) for each in fields(Estimated)]
    assert all(map(isfinite, values))
    size = sqrt(est.qw**2 + est.qx**2 + est.qy**2 + est.qz**2)
    assert size == pytest.approx(1.0, abs=1e-9)
    assert health(est, sensed).gps_fix == 3
