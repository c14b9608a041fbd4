"""A MAVLink client streams attitudes with a thrust, and the gate verifies them sample by sample.

What the vehicle really did is its own truth.  The fence is a box about home, and the wind blows.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from random import Random

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.attitude import attitude_of
from gcs.gate.policy.parse import parse_policy
from gcs.gate.policy.policy import Policy
from gcs.gate.states import State
from gcs.wire.codec import decode
from gcs.wire.messages import SetAttitudeTarget
from tests.loopback.boxed_stream import BoxedStream, box_fence, taken_off
from tests.loopback.bridged import VEHICLE, BridgedFlight, Client, joined
from tests.loopback.flight import Personality
from vehicle_sim.simulation.fault_script import fault_of

ACCEPTED = 0
ARM, TAKE_OFF = 400, 22
PERIOD_S = 0.05
HALF_M, CEILING_M = 60.0, 50.0
TILT_DEG = 10.0
ATTITUDES = f"""
[stream]
tilt_deg = {TILT_DEG}
"""
FENCE = box_fence(HALF_M, CEILING_M)
POLICY = parse_policy(ATTITUDES + FENCE, "attitudes.toml")
SHORT = parse_policy(f"{ATTITUDES}deadman_s = 0.2\n{FENCE}", "short.toml")
"""A sample counts for less time, so that it needs less room above and below."""
HOVER = {"px4": 0.43, "ardupilot": 0.5}
"""The thrust that keeps the height: vehicle-sim's MPC_THR_HOVER; the middle of a climb rate."""
POSITION_ONLY = 3576
"""POSITION_TARGET_TYPEMASK of a hold."""
ATTITUDE_ONLY = 7
"""ATTITUDE_TARGET_TYPEMASK: body rates are ignored, as MAVSDK and MAVROS send it."""


class Attitudes(BoxedStream):
    """A client's, sent at 20 Hz."""

    def __init__(self, flight: BridgedFlight, client: Client) -> None:
        super().__init__(flight, client, HALF_M, CEILING_M, PERIOD_S)

    def send(
        self,
        roll_deg: float,
        pitch_deg: float,
        thrust: float,
        *,
        mask: int = ATTITUDE_ONLY,
        rates: Sequence[float] = (0.0, 0.0, 0.0),
    ) -> None:
        q = attitude_of(math.radians(roll_deg), math.radians(pitch_deg), 0.0)
        self.client.send(
            dialect.MAVLink_set_attitude_target_message(0, *VEHICLE, mask, q, *rates, thrust)
        )

    def fly(self, seconds: float, roll_deg: float, pitch_deg: float, thrust: float) -> None:
        for _ in range(round(seconds / PERIOD_S)):
            self.send(roll_deg, pitch_deg, thrust)
            self.passes(PERIOD_S)

    def fly_until_refused(self, roll_deg: float, pitch_deg: float, thrust: float) -> None:
        """Within 60 s."""
        for _ in range(60):
            if "stream: refused CANNOT_STOP" in self.client.texts():
                return
            self.fly(1.0, roll_deg, pitch_deg, thrust)
        raise AssertionError(self.client.texts())


def flying(
    personality: Personality,
    policy: Policy = POLICY,
    up_m: float = 20.0,
    params: dict[str, float] | None = None,
) -> tuple[BridgedFlight, Client, Attitudes]:
    """Armed and taken off by the client, hovering above home."""
    flight, client = joined(BridgedFlight(personality, policy=policy, params=params))
    taken_off(flight, client, up_m)
    return flight, client, Attitudes(flight, client)


def blow(flight: BridgedFlight, east_m_s: float, north_m_s: float) -> None:
    """Up to 5 m/s, as the default policy's `attitude_error_m_s2` has it."""
    wind = {"wind_ned_m_s": [north_m_s, east_m_s, 0.0], "gust_m_s": 1.0}
    assert flight.world.inject(fault_of("wind", wind, "script"), 1)


def forwarded(flight: BridgedFlight) -> int:
    """How many SET_ATTITUDE_TARGET the vehicle was sent."""
    return len(flight.to_vehicle("SET_ATTITUDE_TARGET"))


def speed_m_s(flight: BridgedFlight) -> float:
    body = flight.vehicle.blocks.body
    return math.hypot(body.vel_e, body.vel_n, body.vel_d)


# --------------------------------------------------------------------------------- it is flown


def test_tilting_flies_where_it_leans_and_silence_holds(personality: Personality) -> None:
    """5 degrees of nose down for 3 s from rest: g sin(5) t^2 / 2 is 3.8 m, drag takes some."""
    flight, client, stream = flying(personality)
    since_ns = flight.now_ns
    stream.fly(3.0, 0.0, -5.0, HOVER[personality])
    assert flight.is_in(State.STREAMING)
    assert "stream: flown" in client.texts()
    east_m, north_m, up_m = flight.truth_enu()
    assert 2.0 < north_m < 4.0
    assert abs(east_m) < 0.5
    assert up_m == pytest.approx(20.0, abs=1.0)
    assert forwarded(flight) >= 55
    stream.passes(10.0)
    assert speed_m_s(flight) < 0.2  # its estimate wanders, and it follows
    assert "no sample of the stream came for 0.5 s" in client.texts()
    assert {setpoint.type_mask for setpoint in flight.setpoints(since_ns)} == {POSITION_ONLY}


def test_a_yaw_rate_beside_it_turns_the_nose(personality: Personality) -> None:
    flight, _, stream = flying(personality)
    mask = 3 if personality == "px4" else 0
    for _ in range(20):
        stream.send(0.0, 0.0, HOVER[personality], mask=mask, rates=(0.0, 0.0, 0.3))
        stream.passes(PERIOD_S)
    assert flight.is_in(State.STREAMING)
    sent = [decode(frame) for frame in flight.to_vehicle("SET_ATTITUDE_TARGET")]
    assert sent
    for message in sent:
        assert isinstance(message, SetAttitudeTarget)
        assert message.type_mask == mask
        assert message.body_yaw_rate == pytest.approx(0.3)
        assert (message.body_roll_rate, message.body_pitch_rate) == (0.0, 0.0)


# ------------------------------------------------------------------------- it cannot leave


@pytest.mark.parametrize(
    ("roll_deg", "pitch_deg", "more_thrust"),
    [(0.0, -10.0, 0.0), (-7.0, 7.0, 0.0), (10.0, 0.0, 0.01), (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)],
    ids=["forward", "left and back", "right and up", "up", "down"],
)
def test_at_the_fence_it_is_held_inside_and_flown_back(
    personality: Personality, roll_deg: float, pitch_deg: float, more_thrust: float
) -> None:
    flight, _, stream = flying(personality, SHORT, up_m=20.0 if more_thrust > 0.5 else 27.0)
    blow(flight, 3.0, 2.0)
    full = 0.03 if personality == "px4" else 0.5
    """As a share of full thrust; as a climb rate."""
    start = flight.truth_enu()
    asked = (roll_deg, pitch_deg, HOVER[personality] + more_thrust * full)
    stream.fly_until_refused(*asked)
    stream.fly(2.0, *asked)
    assert stream.outside_m < 0.0
    assert math.dist(flight.truth_enu(), start) > 4.0
    assert flight.state in (State.STREAMING, State.HOLDING)
    stream.passes(4.0)
    if flight.is_in(State.HOLDING):
        return
    held, before = flight.truth_enu(), forwarded(flight)
    stream.fly(3.0, -roll_deg, -pitch_deg, HOVER[personality] - more_thrust * full)
    assert forwarded(flight) > before + 20
    assert math.dist(flight.truth_enu(), held) > 1.0
    assert stream.outside_m < 0.0


@pytest.mark.thorough
@pytest.mark.parametrize("seed", range(3))
def test_hostile_attitudes_never_take_it_out(personality: Personality, seed: int) -> None:
    """Anything for 25 s, in wind: for a while each, at any rate, with and without pauses."""
    dice = Random(seed)
    flight, _, stream = flying(personality)
    blow(flight, dice.uniform(-3.3, 3.3), dice.uniform(-3.3, 3.3))
    hover, flown = HOVER[personality], 0
    end_ns = flight.now_ns + 25_000_000_000
    while flight.now_ns < end_ns and flight.state in (State.STREAMING, State.HOVERING):
        tilt, way = dice.choice((0.0, 5.0, 10.0, 10.0, 30.0)), dice.uniform(0.0, math.tau)
        thrust = dice.choice((hover, hover, hover * 1.05, hover * 0.95, 1.0, 0.0))
        period_s, before = dice.choice((0.02, 0.05, 0.1, 0.3)), forwarded(flight)
        for _ in range(dice.choice((1, 10, 40))):
            stream.send(tilt * math.sin(way), -tilt * math.cos(way), thrust)
            stream.passes(period_s)
        flown += forwarded(flight) - before
        if dice.random() < 0.2:
            stream.passes(dice.choice((0.3, 1.0, 3.0)))
    assert flown > 40
    assert stream.outside_m < 0.0


# ------------------------------------------------------------------------- it is not flown


def test_body_rates_alone_are_refused_with_the_reason(personality: Personality) -> None:
    flight, client, stream = flying(personality)
    for _ in range(20):
        stream.send(0.0, 0.0, HOVER[personality], mask=0x80, rates=(0.5, 0.0, 0.0))
        stream.passes(PERIOD_S)
    assert forwarded(flight) == 0
    assert flight.is_in(State.HOVERING)
    assert "where body rates alone turn" in client.texts()


def test_none_is_flown_unless_the_policy_says_so(personality: Personality) -> None:
    flight, client, stream = flying(personality, policy=parse_policy(FENCE, "default.toml"))
    stream.fly(1.0, 0.0, -5.0, HOVER[personality])
    assert forwarded(flight) == 0
    assert flight.is_in(State.HOVERING)
    assert "stream.tilt_deg is 0" in client.texts()


def test_a_thrust_that_the_vehicle_may_mean_otherwise_is_refused() -> None:
    """ArduCopter with GUID_OPTIONS bit 3: thrust as thrust."""
    flight, client, stream = flying("ardupilot", params={"GUID_OPTIONS": 8})
    stream.fly(1.0, 0.0, -5.0, 0.43)
    assert forwarded(flight) == 0
    assert "GUID_OPTIONS has bit 3" in client.texts()


@pytest.mark.parametrize("share", [0.92, 1.08])
def test_a_hover_thrust_that_is_told_a_little_wrong(share: float) -> None:
    """It rises or sinks by what the parameter is wrong, within what the policy has it, and the gate
    holds it inside."""
    told = 0.43 * share
    flight, _, stream = flying("px4", SHORT, up_m=27.0, params={"MPC_THR_HOVER": told})
    stream.fly_until_refused(0.0, 0.0, told)
    stream.fly(2.0, 0.0, 0.0, told)
    assert forwarded(flight) > 20
    assert abs(flight.truth_enu()[2] - 27.0) > 2.0
    assert stream.outside_m < 0.0
