"""A joystick of a MAVLink client, as QGroundControl's: 25 MANUAL_CONTROL a second, all the time.

The vehicle never hears a stick; the gate flies a stream of velocities that it verifies.  What the
vehicle really did is its own truth.  The fence is a box about home, and the wind blows.
"""

from __future__ import annotations

import math

import pytest
from pymavlink.dialects.v20 import all as dialect

from gcs.gate.policy.parse import parse_policy
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code
from gcs.gate.states import State
from tests.loopback.boxed_stream import BoxedStream, box_fence, taken_off
from tests.loopback.bridged import VEHICLE, BridgedFlight, Client, joined
from tests.loopback.fleet import Fleet
from tests.loopback.flight import Personality
from vehicle_sim.simulation.fault_script import fault_of

ACCEPTED, DENIED = 0, 2
ARM, TAKE_OFF, SET_MODE, PAUSE = 400, 22, 176, 193
MIDDLE = 500
PERIOD_S = 0.04
HALF_M, CEILING_M = 30.0, 25.0
FENCE = box_fence(HALF_M, CEILING_M)
POLICY = parse_policy(FENCE, "box.toml")
REPLACE = parse_policy('retarget = "replace"\n' + FENCE, "replace.toml")
POSITION_ONLY, VELOCITY_AND_RATE = 3576, 1479
"""POSITION_TARGET_TYPEMASK: what is ignored."""
POSITION_MODE = {"px4": (1.0, 3.0), "ardupilot": (1.0, 5.0)}
"""POSCTL; LOITER."""


class Joystick(BoxedStream):
    """A client's, whose sticks are as they were moved last."""

    def __init__(self, flight: BridgedFlight, client: Client) -> None:
        super().__init__(flight, client, HALF_M, CEILING_M, PERIOD_S)

    def fly(
        self,
        seconds: float,
        x: int = 0,
        y: int = 0,
        z: int = MIDDLE,
        r: int = 0,
        buttons: int = 0,
    ) -> None:
        """Hold the sticks so for a while; heartbeats go on."""
        for _ in range(round(seconds / PERIOD_S)):
            sticks = dialect.MAVLink_manual_control_message(VEHICLE[0], x, y, z, r, buttons)
            self.client.send(sticks)
            self.passes(PERIOD_S)


def ready(personality: Personality, policy: Policy = POLICY) -> tuple[BridgedFlight, Client]:
    return joined(BridgedFlight(personality, policy=policy))


def flying(
    personality: Personality, policy: Policy = POLICY, up_m: float = 10.0
) -> tuple[BridgedFlight, Client, Joystick]:
    """Armed and taken off by the client, hovering above home."""
    flight, client = ready(personality, policy)
    taken_off(flight, client, up_m)
    return flight, client, Joystick(flight, client)


def masks(flight: BridgedFlight, since_ns: int) -> set[int]:
    return {setpoint.type_mask for setpoint in flight.setpoints(since_ns)}


def speed_m_s(flight: BridgedFlight) -> float:
    body = flight.vehicle.blocks.body
    return math.hypot(body.vel_e, body.vel_n, body.vel_d)


def yaw_of(flight: BridgedFlight) -> float:
    """Where the nose really points, clockwise from north."""
    w, x, y, z = flight.vehicle.truth.q_ned_from_frd
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def blow(flight: BridgedFlight, east_m_s: float, north_m_s: float) -> None:
    wind = {"wind_ned_m_s": [north_m_s, east_m_s, 0.0], "gust_m_s": 1.0}
    assert flight.world.inject(fault_of("wind", wind, "script"), 1)


def no_stick_was_forwarded(flight: BridgedFlight) -> bool:
    return not flight.to_vehicle("MANUAL_CONTROL") and not flight.to_vehicle("RC_CHANNELS_OVERRIDE")


@pytest.mark.parametrize(
    "sticks",
    [
        {"x": 1000},
        {"y": -1000},
        {"x": -1000, "y": 1000, "r": 300},
        {"z": 1000},
        {"z": 0, "x": 200},
    ],
    ids=["forward", "left", "back and turning", "up", "down"],
)
def test_full_stick_at_the_fence_is_held_inside_and_flown_back(
    personality: Personality, sticks: dict[str, int]
) -> None:
    flight, client, joystick = flying(personality)
    blow(flight, 6.0, 6.0)
    joystick.fly(0.2)
    start = flight.truth_enu()
    joystick.fly(14.0, **sticks)
    assert joystick.outside_m < 0.0
    assert math.dist(flight.truth_enu(), start) > 5.0
    assert "stream: refused CANNOT_STOP" in client.texts()
    assert flight.state in (State.STREAMING, State.HOLDING)
    assert no_stick_was_forwarded(flight)
    held = flight.truth_enu()
    joystick.fly(1.5)
    if flight.is_in(State.HOLDING):
        return
    back = {key: 1000 - value if key == "z" else -value for key, value in sticks.items()}
    joystick.fly(6.0, **back)
    assert joystick.outside_m < 0.0
    assert math.dist(flight.truth_enu(), held) > 1.5


def test_sticks_move_the_vehicle_as_in_its_position_mode(personality: Personality) -> None:
    """Half forward, then a quarter turn to the right: the nose comes round, clockwise."""
    flight, _, joystick = flying(personality)
    yaw_rad = yaw_of(flight)
    joystick.fly(0.2)
    joystick.fly(3.0, x=550)
    body = flight.vehicle.blocks.body
    assert math.hypot(body.vel_n, body.vel_e) == pytest.approx(2.5, abs=0.3)
    assert math.atan2(body.vel_e, body.vel_n) == pytest.approx(yaw_rad, abs=0.1)
    joystick.fly(1.0)
    joystick.fly(1.5, r=1000)
    turned_deg = math.degrees(math.remainder(yaw_of(flight) - yaw_rad, math.tau))
    assert 40.0 < turned_deg < 100.0


def test_released_sticks_hold_the_place_and_a_goto_flies_then(personality: Personality) -> None:
    flight, client, joystick = flying(personality)
    joystick.fly(0.2)
    since_ns = flight.now_ns
    joystick.fly(3.0, x=1000)
    assert flight.is_in(State.STREAMING)
    assert VELOCITY_AND_RATE in masks(flight, since_ns)
    joystick.fly(2.0)
    assert flight.is_in(State.HOVERING)
    joystick.fly(3.0)
    assert speed_m_s(flight) < 0.5
    assert masks(flight, flight.now_ns - 1_000_000_000) == {POSITION_ONLY}
    goes_to(flight, client, 5.0)
    joystick.fly(20.0)
    assert flight.truth_enu()[1] == pytest.approx(5.0, abs=1.0)
    assert flight.is_in(State.HOVERING)
    assert not flight.decisions("refused")


def goes_to(flight: BridgedFlight, client: Client, north_m: float) -> None:
    telemetry = flight.session.telemetry
    assert telemetry is not None
    assert telemetry.home is not None
    lat, lon, alt = telemetry.home
    client.fly_to(lat + north_m / 111_319.5, lon, alt + 10.0)


def test_a_goto_flies_beside_sticks_in_the_middle(personality: Personality) -> None:
    flight, client, joystick = flying(personality)
    since_ns = flight.now_ns
    joystick.fly(1.0)
    goes_to(flight, client, 15.0)
    joystick.fly(2.0, x=50, y=-40, z=520)  # a worn joystick's middle
    assert flight.is_in(State.MOVING)
    joystick.fly(20.0)
    assert flight.is_in(State.HOVERING)
    assert flight.truth_enu()[1] == pytest.approx(15.0, abs=1.0)
    joystick.fly(8.0, buttons=4)
    assert client.texts().count("buttons of a joystick are ignored") == 1
    assert flight.is_in(State.HOVERING)
    assert masks(flight, since_ns) == {POSITION_ONLY}
    assert not flight.decisions("refused")


@pytest.mark.parametrize("policy", [POLICY, REPLACE], ids=["refuse", "replace"])
def test_a_stick_during_a_goto_is_a_stream_by_the_policys_retarget(
    personality: Personality, policy: Policy
) -> None:
    flight, client, joystick = flying(personality, policy)
    joystick.fly(0.2)
    goes_to(flight, client, 12.0)
    joystick.fly(2.0)
    assert flight.is_in(State.MOVING)
    joystick.fly(2.0, x=-600)
    if policy is REPLACE:
        assert flight.is_in(State.STREAMING)
        return
    assert flight.is_in(State.MOVING)
    assert client.texts().count("stream: refused BUSY") == 1


def test_on_the_ground_no_stick_arms_or_takes_off(personality: Personality) -> None:
    """Neither as PX4's stick gesture, nor as ArduPilot's: the throttle down and the yaw right."""
    flight, client = ready(personality)
    joystick = Joystick(flight, client)
    joystick.fly(5.0)
    joystick.fly(5.0, z=0)
    assert "stream" not in client.texts(), "sticks at rest are no news"
    assert not flight.decisions()
    joystick.fly(5.0, z=0, r=1000)
    assert not flight.vehicle.armed
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    joystick.fly(4.0, z=1000)
    assert flight.truth_enu()[2] < 0.1
    assert client.texts().count("stream: refused NOT_FLYING") == 1
    assert no_stick_was_forwarded(flight)


def test_a_throttle_left_at_its_bottom_does_not_bring_it_down(personality: Personality) -> None:
    """A transmitter's throttle has no spring: after a take-off it must be brought to its middle."""
    flight, client, joystick = flying(personality)
    up_m = flight.truth_enu()[2]
    joystick.fly(3.0, z=0)
    assert flight.is_in(State.HOVERING)
    assert flight.truth_enu()[2] == pytest.approx(up_m, abs=0.5)
    assert "let go of them once" in client.texts()
    joystick.fly(0.2)
    joystick.fly(2.0, z=200)
    assert flight.truth_enu()[2] < up_m - 0.5


def test_a_joystick_that_is_lost_is_held_within_the_deadmans_time(
    personality: Personality,
) -> None:
    flight, client, joystick = flying(personality)
    joystick.fly(0.2)
    joystick.fly(3.0, y=600)
    silent_ns = flight.now_ns
    flight.run(POLICY.stream.deadman_s - 0.1)
    assert flight.setpoints(silent_ns)[-1].type_mask == VELOCITY_AND_RATE
    flight.run(0.2)
    assert flight.setpoints(silent_ns)[-1].type_mask == POSITION_ONLY
    assert "stream: refused DEADLINE" in client.texts()
    flight.beating(POLICY.stream.ends_after_s)
    assert flight.is_in(State.HOVERING)
    assert speed_m_s(flight) < 0.5


def test_a_joystick_of_who_is_not_in_control_is_refused_once(personality: Personality) -> None:
    flight, client, _ = flying(personality)
    other = flight.join(255, 190)
    sticks = Joystick(flight, other)
    client.beat()
    sticks.fly(3.0)
    assert "OTHER_OPERATOR" not in other.texts(), "in the middle they ask for nothing"
    since_ns = flight.now_ns
    for _ in range(8):
        client.beat()
        sticks.fly(1.0, x=1000, y=1000)
    assert other.texts().count("OTHER_OPERATOR") == 1
    assert "stream: refused" not in client.texts()
    assert flight.is_in(State.HOVERING)
    assert masks(flight, since_ns) == {POSITION_ONLY}


def test_sticks_in_the_middle_take_control_from_nobody(personality: Personality) -> None:
    flight, client = ready(personality)
    Joystick(flight, client).fly(3.0)
    assert "in control" not in client.texts()
    other = flight.join(255, 190)
    assert other.ask(ARM, 1, within_s=10) == ACCEPTED


def test_the_position_mode_is_flown_by_the_gate(personality: Personality) -> None:
    """QGroundControl's Position, or Loiter, out of a goto; and after a hold."""
    flight, client, joystick = flying(personality)
    main = POSITION_MODE[personality]
    joystick.fly(0.2)
    goes_to(flight, client, 15.0)
    joystick.fly(1.5)
    assert flight.is_in(State.MOVING)
    client.command(SET_MODE, *main)
    joystick.fly(4.0)
    assert client.acks(SET_MODE)[-1].result == ACCEPTED
    assert flight.is_in(State.HOVERING)
    joystick.fly(2.0, x=-1000)
    assert flight.is_in(State.STREAMING)
    client.command(PAUSE, 0)
    joystick.fly(1.0)
    assert flight.is_in(State.HOLDING)
    client.command(SET_MODE, *main)
    joystick.fly(4.0)
    assert flight.is_in(State.HOVERING)
    joystick.fly(2.0, x=1000)
    assert flight.is_in(State.STREAMING)
    assert "verifies what the sticks ask for" in client.texts()
    assert not flight.decisions("refused")


def test_a_px4_set_to_posctl_on_the_ground_arms_and_takes_off() -> None:
    """QGroundControl's joystick: Position first, then arm.  A PX4 that hears no sticks does not
    arm in POSCTL (B4_posctl_mode_without_stream of scenarios_px4.json)."""
    flight, client = ready("px4")
    joystick = Joystick(flight, client)
    joystick.fly(1.0)
    assert client.ask(SET_MODE, *POSITION_MODE["px4"]) == ACCEPTED
    joystick.fly(1.0)
    assert client.ask(ARM, 1, within_s=10) == ACCEPTED
    assert client.ask(TAKE_OFF, 0, 0, 0, *[math.nan] * 4) == ACCEPTED
    joystick.fly(12.0)
    assert flight.is_in(State.HOVERING)
    joystick.fly(2.0, z=1000)
    assert flight.is_in(State.STREAMING)


def test_a_stick_leaves_no_hold(personality: Personality) -> None:
    """Somebody has stopped the vehicle: a stick that is pushed on does not fly it again."""
    flight, client, joystick = flying(personality)
    joystick.fly(0.2)
    joystick.fly(2.0, x=1000)
    other = flight.join(255, 190)
    other.command(PAUSE, 0)
    joystick.fly(6.0, x=1000)
    assert flight.is_in(State.HOLDING)
    assert speed_m_s(flight) < 0.5
    assert client.texts().count("stream: refused HOLDING") == 1


def test_overridden_channels_fly_an_ardupilot() -> None:
    """1000, 1500, 2000 us; low pitch is forward (arducopter_4_7_params.json)."""
    flight, client, _ = flying("ardupilot")
    yaw_rad = yaw_of(flight)

    def send(seconds: float, *channels: int) -> None:
        raw = (*channels, *(65535,) * (8 - len(channels)))
        for _ in range(round(seconds / PERIOD_S)):
            client.send(dialect.MAVLink_rc_channels_override_message(*VEHICLE, *raw))
            flight.run(PERIOD_S)

    send(0.2, 1500, 1500, 1500, 1500)
    send(3.0, 1500, 1000)
    body = flight.vehicle.blocks.body
    assert math.hypot(body.vel_n, body.vel_e) > 3.0
    assert math.atan2(body.vel_e, body.vel_n) == pytest.approx(yaw_rad, abs=0.1)
    send(2.0, 0, 0, 0, 0)
    assert flight.is_in(State.HOVERING)
    send(0.2, 1500, 1500, 1500, 1500, 1900)
    assert Code.UNSUPPORTED.value in client.texts()
    assert no_stick_was_forwarded(flight)


def test_no_stick_and_no_channel_of_a_client_reaches_the_vehicle(personality: Personality) -> None:
    flight, client, _ = flying(personality)
    for z in (500, 0):  # the middle, and the throttle closed
        client.send(dialect.MAVLink_manual_control_message(VEHICLE[0], 0, 0, z, 0, 0))
    for raw in (0, 1100, 65535):
        client.send(dialect.MAVLink_rc_channels_override_message(*VEHICLE, *[raw] * 8))
    flight.run(1)
    assert no_stick_was_forwarded(flight)
    refused = [item.code for item in flight.decisions("refused")]
    assert refused == ["UNSUPPORTED", "DEADLINE"], "the channels; the stick, silent since"


def test_a_joystick_flies_the_vehicle_that_it_is_for() -> None:
    flight = Fleet()
    client = flight.all_flying()
    before = {sysid: flight.place_enu(sysid) for sysid in (1, 2)}
    for count in range(75):
        x = 800 if count > 4 else 0
        client.send(dialect.MAVLink_manual_control_message(2, x, 0, MIDDLE, 0, 0))
        flight.run(PERIOD_S)
    assert [flight.state_of(sysid) for sysid in (1, 2)] == [State.HOVERING, State.STREAMING]
    assert math.dist(flight.place_enu(1), before[1]) < 0.5
    assert math.dist(flight.place_enu(2), before[2]) > 3.0
    client.send(dialect.MAVLink_manual_control_message(1, 800, 0, MIDDLE, 0, 0))
    flight.run(0.2)
    assert flight.state_of(1) is State.HOVERING, "its sticks were not in the middle yet"
