"""Hostile attitudes against the gate, flown by a point mass that does the worst that it may.

It is blown by the policy's whole `attitude_error_m_s2` one way, hovers at a thrust that is wrong by
the policy's whole `hover_thrust_error`, takes the policy's whole time to turn and to react to a
hold, hears what it is sent late, and brakes no harder than the policy has it.  It must stay inside.
"""

from __future__ import annotations

import math
from collections import deque
from functools import cache
from random import Random

import pytest

from gcs.frames import Vec3
from gcs.gate.attitude import Attitude, HoverThrust, attitude_of
from gcs.gate.effects import SendSetpoint, StreamVerdict
from gcs.gate.inputs import StreamSeen
from gcs.gate.permit import Permit
from gcs.gate.policy.parse import parse_policy
from gcs.gate.states import State
from tests.shares import one_in
from tests.unit.gate.script import Script

pytestmark = pytest.mark.slow

G = 9.80665
TICK_S, STEP_S = 0.05, 0.01
HALF_M, CEILING_M, UP_M = 40.0, 45.0, 22.0
TOLD = 0.5
SEEDS = range(12)
FIRST = range(4)
POLICY = parse_policy(
    f"""
[stream]
tilt_deg = 12.0
deadman_s = 0.3
hover_thrust_error = 0.08
attitude_error_m_s2 = 1.0
[[fence]]
name = "box"
kind = "box"
east_m = [-{HALF_M}, {HALF_M}]
north_m = [-{HALF_M}, {HALF_M}]
floor_up_m = 0.0
ceiling_up_m = {CEILING_M}
""",
    "attitudes.toml",
)
RULES, BRAKING = POLICY.stream, POLICY.braking_of("px4")


class PointMass:
    """Flies the last permit that it has heard."""

    def __init__(self, dice: Random, *, wind_m_s2: float, hover: float) -> None:
        way = dice.uniform(0.0, math.tau)
        self.wind = (wind_m_s2 * math.cos(way), wind_m_s2 * math.sin(way), 0.0)
        self.hover = hover
        self.brakes_m_s2 = (BRAKING.a_brake_h_m_s2, BRAKING.a_brake_v_m_s2)
        self.power = dice.choice((1.0, 1.5, 2.0))
        self.late_ticks = dice.choice((0, 1, 3))
        self.pos: list[float] = [0.0, 0.0, -UP_M]
        self.v: list[float] = [0.0, 0.0, 0.0]
        self._up: list[float] = [0.0, 0.0, -1.0]
        self._thrust = TOLD
        self._held_s: float | None = 10.0
        self._way: deque[Permit] = deque()

    def hears(self, permits: list[Permit]) -> None:
        self._way += permits
        while len(self._way) > self.late_ticks:
            permit = self._way.popleft()
            if permit.attitude is None:
                self.is_held()
            else:
                self._held_s, self._goal = None, permit.attitude

    def is_held(self) -> None:
        self._held_s = 0.0 if self._held_s is None else self._held_s

    def flies(self) -> None:
        for _ in range(round(TICK_S / STEP_S)):
            if self._held_s is None:
                self._turns()
            else:
                self._held_s += STEP_S
            if self._held_s is None or self._held_s < BRAKING.react_s:
                force = G * (self._thrust / self.hover) ** self.power
                a = [force * up + blown for up, blown in zip(self._up, self.wind, strict=True)]
                a[2] += G
            else:
                a = self._brakes()
                self._up, self._thrust = [0.0, 0.0, -1.0], self.hover
            for axis in range(3):
                self.pos[axis] += self.v[axis] * STEP_S
                self.v[axis] += a[axis] * STEP_S

    def _turns(self) -> None:
        """An equal part of what is left, so that a twentieth is left after the policy's time."""
        part = 3.0 * STEP_S / RULES.attitude_settle_s
        up = [a + (b - a) * part for a, b in zip(self._up, self._goal.up_ned, strict=True)]
        size = math.hypot(*up)
        self._up = [each / size for each in up]
        self._thrust = self._goal.thrust

    def _brakes(self) -> list[float]:
        speed = math.hypot(self.v[0], self.v[1])
        most = min(self.brakes_m_s2[0], speed / STEP_S)
        n, e = (-each / max(speed, 1e-9) * most for each in self.v[:2])
        down = math.copysign(min(self.brakes_m_s2[1], abs(self.v[2]) / STEP_S), -self.v[2])
        return [n, e, down]

    @property
    def pos_ned(self) -> Vec3:
        return (self.pos[0], self.pos[1], self.pos[2])

    @property
    def outside_m(self) -> float:
        north, east, down = self.pos
        return max(abs(north) - HALF_M, abs(east) - HALF_M, -down - CEILING_M, down)


@cache
def flown(seed: int, *, honest: bool = True) -> tuple[float, Script]:
    """Half a minute; how far outside it came (negative: inside), and the gate."""
    dice = Random(seed)
    error = RULES.hover_thrust_error
    hover = TOLD * (1.0 + dice.choice((-error, error)))
    vehicle = PointMass(dice, wind_m_s2=RULES.attitude_error_m_s2, hover=hover)
    if not honest:
        vehicle.brakes_m_s2 = (0.1 * BRAKING.a_brake_h_m_s2, 0.1 * BRAKING.a_brake_v_m_s2)
    script = Script(POLICY, "px4").take_control(UP_M)
    script.forget()
    outside_m, asked, way = -math.inf, Attitude((1.0, 0.0, 0.0, 0.0), TOLD), 0.0
    for tick in range(600):
        if tick % dice.choice((5, 20, 60)) == 0:
            tilt = math.radians(dice.choice((0.0, 6.0, 11.9, 11.9)))
            way = dice.choice((way, dice.uniform(0.0, math.tau)))
            thrust = TOLD * dice.choice((1.0, 1.0, 1.05, 0.95, 0.9))
            roll, pitch = tilt * math.sin(way), -tilt * math.cos(way)
            asked = Attitude(attitude_of(roll, pitch, 0.0), thrust, HoverThrust(TOLD))
        if dice.random() < 0.97:
            script.feed(StreamSeen("operator", None, None, None, None, None, asked))
        before = len(script.effects)
        script.pos_ned = vehicle.pos_ned
        script.v_ned = (vehicle.v[0], vehicle.v[1], vehicle.v[2])
        script.tick()
        sent = [effect for _, effect in script.effects[before:]]
        vehicle.hears([each.permit for each in sent if isinstance(each, SendSetpoint)])
        if script.gate.state is State.HOLDING:
            vehicle.is_held()  # a breach was predicted all the same: hold mode, as for every stream
        vehicle.flies()
        outside_m = max(outside_m, vehicle.outside_m)
    return outside_m, script


@pytest.mark.parametrize("seed", one_in(3, SEEDS))
def test_a_point_mass_at_its_worst_stays_inside(seed: int) -> None:
    outside_m, script = flown(seed)
    assert outside_m < 0.0
    assert any(told.refusal is None for told in script.all(StreamVerdict)), "nothing was flown"


def test_the_gate_is_met_at_the_fence_and_hands_back() -> None:
    refused = handed_back = 0
    for seed in FIRST:
        told = [each.refusal is None for each in flown(seed)[1].all(StreamVerdict)]
        refused += told.count(False)
        handed_back += told[1:].count(True)
    assert refused > 8
    assert handed_back > 8


def test_a_vehicle_that_breaks_its_promise_gets_out() -> None:
    """It brakes a tenth as hard: the flights here are such that it matters."""
    assert max(flown(seed, honest=False)[0] for seed in FIRST) > 0.0
