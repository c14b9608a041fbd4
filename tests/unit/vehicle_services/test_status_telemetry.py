"""Navigation, heights, air and board: the numbers in their messages."""

from __future__ import annotations

import math

import pytest

from tests.unit.vehicle_services.fake_vehicle import NUMBERS, Bench, Kind, acks, long, of
from vehicle_sim.autopilot.interface import AttitudeGoal, Target
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Cmd


def asked(bench: Bench, kind: type[Kind]) -> Kind:
    return of(bench.send(long(512, NUMBERS[kind])), kind)[0]


def test_navigation_is_told_in_degrees_and_metres_from_here() -> None:
    bench = Bench("ardupilot")
    half = math.radians(10.0) / 2.0
    roll = (math.cos(half), math.sin(half), 0.0, 0.0)
    bench.vehicle.attitude_goal = AttitudeGoal(roll, (0.0, 0.0, 0.0), 0.5)
    bench.vehicle.target = Target((10.0, 50.0, -12.0), None, None)
    told = asked(bench, m.NavControllerOutput)
    assert told.nav_roll == pytest.approx(10.0)
    assert (told.target_bearing, told.wp_dist) == (90, 30)
    assert told.alt_error == pytest.approx(7.0), "it is to climb"


def test_navigation_without_a_goal_is_all_zero() -> None:
    bench = Bench("ardupilot")
    bench.vehicle.target = Target(None, None, None)
    told = asked(bench, m.NavControllerOutput)
    assert told == m.NavControllerOutput(0.0, 0.0, 0.0, 0.0, 0.0, 0, 0, 0)


def at_a_rate(bench: Bench, kind: type[Kind]) -> Kind:
    """The last of those that come; not all of them can be requested."""
    bench.send(m.Heartbeat(0, 6, 8, 0, 4, 3))
    bench.send(long(511, NUMBERS[kind], 200_000))
    return of(bench.advance(1_200_000_000), kind)[-1]


def test_wind_comes_from_where_it_does_not_go() -> None:
    bench = Bench("ardupilot")
    told = asked(bench, m.Wind)
    assert told.speed == pytest.approx(5.0)
    assert told.direction == pytest.approx(126.87, abs=0.01), "it blows to the north-west"
    other = Bench("px4")
    cov = asked(other, m.WindCov)
    assert (cov.wind_x, cov.wind_y, math.isnan(cov.wind_z)) == (3.0, -4.0, True)
    bench.vehicle.wind_ned = None
    other.vehicle.wind_ned = None
    calm = asked(bench, m.Wind)
    assert (abs(calm.direction), calm.speed, calm.speed_z) == (180.0, 0.0, 0.0), (
        "arducopter_4_7_flight.tlog, before the take-off"
    )
    assert not of(other.send(long(512, m.IDS[m.WindCov])), m.WindCov)


def test_heights_each_have_their_own_zero() -> None:
    told = asked(Bench("px4"), m.Altitude)
    heights = (told.altitude_monotonic, told.altitude_amsl, told.altitude_local)
    assert heights == (493.5, 493.0, 5.0)
    assert told.altitude_relative == 5.0
    assert math.isnan(told.altitude_terrain)
    assert math.isnan(told.bottom_clearance)


@pytest.mark.parametrize("personality", ["px4", "ardupilot"])
def test_board_and_vibration(personality: Personality) -> None:
    bench = Bench(personality)
    shaking = asked(bench, m.Vibration)
    assert shaking[1:4] == pytest.approx((0.1, 0.2, 0.3))
    power = at_a_rate(bench, m.PowerStatus)
    assert power.Vcc == 5000
    assert at_a_rate(bench, m.Hwstatus)
    memory = at_a_rate(bench, m.Meminfo)
    assert memory.freemem32 > 0


def test_the_mission_mode_is_told_beside_the_item() -> None:
    for personality, mission, other in (("px4", 4 << 16 | 4 << 24, 4 << 16), ("ardupilot", 3, 4)):
        bench = Bench("px4", firmware="1.15") if personality == "px4" else Bench("ardupilot")
        for number, expected in ((mission, 1), (other, 2)):
            bench.vehicle.custom_mode = number
            told = at_a_rate(bench, m.MissionCurrent)
            assert told.mission_mode == expected


def test_who_asks_for_the_modes_hears_from_then_on_whether_they_changed() -> None:
    """arducopter_4_7_flight.tlog: AVAILABLE_MODES was asked for at 47.3 s; the monitor came at
    52.3, 57.3, 62.3 s, CURRENT_MODE never."""
    bench = Bench("ardupilot")
    bench.send(m.Heartbeat(0, 6, 8, 0, 4, 3))
    listed = bench.send(long(512, m.IDS[m.AvailableModes]))
    assert of(listed, m.AvailableModes)
    after = bench.advance(15_000_000_000)
    assert len(of(after, m.AvailableModesMonitor)) == 3
    assert not of(after, m.CurrentMode)


def test_servo_outputs_and_relays_are_told() -> None:
    """DO_SET_SERVO's output in SERVO_OUTPUT_RAW beside the motors; RELAY_STATUS's masks."""
    bench = Bench("ardupilot")
    bench.vehicle.servos_us = (0,) * 8 + (1900,) + (0,) * 7
    bench.vehicle.relays = (1, 1)
    told = bench.send(long(Cmd.REQUEST_MESSAGE, m.IDS[m.ServoOutputRaw]))
    (servos,) = of(told, m.ServoOutputRaw)
    assert (servos.servo1_raw, servos.servo9_raw, servos.servo10_raw) == (1000, 1900, 0)
    told = bench.send(long(Cmd.REQUEST_MESSAGE, m.IDS[m.RelayStatus]))
    (relays,) = of(told, m.RelayStatus)
    assert (relays.present, relays.on) == (1, 1)


@pytest.mark.parametrize(
    ("command", "given", "call"),
    [
        (Cmd.DO_SET_SERVO, (9, 1500), ("set_servo", 9.0, 1500.0)),
        (Cmd.DO_REPEAT_SERVO, (9, 1500, 2, 1), ("repeat_servo", 9.0, 1500.0, 2.0, 1.0)),
        (Cmd.DO_SET_RELAY, (0, 1), ("set_relay", 0.0, 1.0)),
        (Cmd.DO_REPEAT_RELAY, (0, 3, 1), ("repeat_relay", 0.0, 3.0, 1.0)),
    ],
)
def test_commands_for_servos_and_relays_reach_them(
    command: Cmd, given: tuple[float, ...], call: tuple[object, ...]
) -> None:
    bench = Bench("ardupilot")
    assert acks(bench.send(long(command, *given))) == [(command, 0)]
    assert bench.vehicle.calls[-1] == call


def test_a_winch_that_there_is_not() -> None:
    """From memory: FAILED by ArduCopter (WINCH_TYPE 0), no answer by PX4, as of its gripper."""
    assert acks(Bench("ardupilot").send(long(Cmd.DO_WINCH, 1))) == [(42600, 4)]
    assert acks(Bench("px4").send(long(Cmd.DO_WINCH, 1))) == []
