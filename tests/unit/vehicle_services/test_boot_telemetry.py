"""`--boot real`: what a client is sent, and when, until the vehicle is ready.

Rows: `behaviour.json` "armable" and "SYS_STATUS bits"; `px4_1_14_flight.tlog` and
`arducopter_4_7_flight.tlog`, times in seconds since power-up.
"""

from __future__ import annotations

import pytest

from tests.unit.vehicle_services.fake_vehicle import MS, S, long, of
from tests.unit.vehicle_services.flown_vehicle import Flown
from vehicle_sim.autopilot.interface import Result
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Cmd, DataStream, Sensor

pytestmark = pytest.mark.slow  # a vehicle flies


def booting(personality: Personality) -> Flown:
    """A client that is there from power-up, and has asked for everything."""
    bench = Flown(personality, boot="real")
    bench.send(m.Heartbeat(0, 6, 8, 0, 4, 3))
    if personality == "ardupilot":
        bench.send(m.RequestDataStream(10, 1, 1, DataStream.ALL, 1))
    return bench


def first_s(bench: Flown, kind: type[m.Message], limit_s: int = 60) -> float:
    """When it comes for the first time; fails when it does not."""
    for _ in range(limit_s * 10):
        if any(isinstance(each, kind) for each in bench.advance(100 * MS)):
            return bench.now_ns / 1e9
    raise AssertionError(f"no {kind.__name__} within {limit_s} s")


@pytest.mark.parametrize(
    ("personality", "kind", "at_s", "within_s"),
    [
        ("px4", m.GpsGlobalOrigin, 1.1, 0.2),
        ("px4", m.LocalPositionNed, 1.1, 0.2),
        ("px4", m.HomePosition, 2.1, 0.2),
        ("px4", m.Attitude, 6.4, 0.2),
        ("px4", m.GlobalPositionInt, 6.5, 0.2),
        ("ardupilot", m.HomePosition, 20.0, 0.3),
        ("ardupilot", m.GpsGlobalOrigin, 20.0, 0.3),
        ("ardupilot", m.GlobalPositionInt, 20.0, 0.3),
        ("ardupilot", m.LocalPositionNed, 41.4, 0.3),
    ],
)
def test_a_message_comes_when_there_is_something_to_tell(
    personality: Personality, kind: type[m.Message], at_s: float, within_s: float
) -> None:
    assert first_s(booting(personality), kind) == pytest.approx(at_s, abs=within_s)


def test_px4s_utm_position_waits_for_the_attitude() -> None:
    """The flight: UTM_GLOBAL_POSITION at 6.53 s for the first time, with GLOBAL_POSITION_INT."""
    bench = booting("px4")
    bench.send(long(Cmd.SET_MESSAGE_INTERVAL, m.IDS[m.UtmGlobalPosition], 100_000))
    assert first_s(bench, m.UtmGlobalPosition) == pytest.approx(6.5, abs=0.2)


@pytest.mark.parametrize(
    ("at_s", "present", "enabled", "healthy"),
    [
        (1.5, 0x0, 0x0, 0x2221803F),
        (5.0, 0x0220000D, 0x0221000D, 0x2220803F),
        (10.0, 0x0220002D, 0x0221002D, 0x3220803F),
    ],
)
def test_px4s_sys_status(at_s: float, present: int, enabled: int, healthy: int) -> None:
    """The flight, at 1.1, 2.1 and 9.2 s.

    PREARM_CHECK is left out of the first two: it is told as present here, on purpose.
    """
    bench = booting("px4")
    told = of(bench.advance(int(at_s * S)), m.SysStatus)[-1]
    known = ~int(Sensor.PREARM_CHECK)
    assert told.onboard_control_sensors_present & known == present
    assert told.onboard_control_sensors_enabled & known == enabled
    assert told.onboard_control_sensors_health == healthy


def test_arducopters_sys_status_says_healthy_in_stabilize_and_not_in_guided() -> None:
    """vehicle.md, "Fidelity": a false "healthy" at 23 s; the flight, GUIDED, 37.55 s: health
    0x4771fc2f, without PREARM_CHECK."""
    bench = booting("ardupilot")

    def healthy(until_s: float) -> bool:
        heard = bench.advance(int(until_s * S) - bench.now_ns)
        told = of(heard, m.SysStatus)[-1]
        return bool(told.onboard_control_sensors_health & Sensor.PREARM_CHECK)

    assert not healthy(22.5)
    assert healthy(24.0)
    bench.mode("GUIDED")
    assert not healthy(37.5)
    assert healthy(42.5)


@pytest.mark.parametrize(
    ("personality", "at_s", "result"),
    [
        ("px4", 1.3, Result.TEMPORARILY_REJECTED),
        ("px4", 8.0, Result.TEMPORARILY_REJECTED),
        ("px4", 9.0, Result.ACCEPTED),
        ("ardupilot", 1.1, Result.FAILED),
        ("ardupilot", 14.0, Result.FAILED),
        ("ardupilot", 23.5, Result.ACCEPTED),
    ],
)
def test_the_ack_of_arm(personality: Personality, at_s: float, result: Result) -> None:
    """`H7_force_arm_not_ready` and the flight of ArduCopter, 12.02 s."""
    bench = booting(personality)
    bench.advance(int(at_s * S))
    assert bench.result(long(Cmd.COMPONENT_ARM_DISARM, 1), 100 * MS) == result


def test_estimator_status_of_px4() -> None:
    """The flight: flags 164 at 2.1 s; with a position all that it tells here."""
    bench = booting("px4")
    assert of(bench.advance(3 * S), m.EstimatorStatus)[-1].flags == 164
    assert of(bench.advance(7 * S), m.EstimatorStatus)[-1].flags & 0x1F == 0x1F


def test_gps_raw_int_of_arducopter() -> None:
    """`boot_to_ready`: no receiver before 9.8 s."""
    bench = booting("ardupilot")
    assert of(bench.advance(9 * S), m.GpsRawInt)[-1].fix_type == 0
    assert of(bench.advance(2 * S), m.GpsRawInt)[-1].fix_type == 3
