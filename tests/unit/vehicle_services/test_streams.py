"""Rates: what is sent unasked, what is asked for, per channel and per wall second."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from fractions import Fraction

import pytest

from tests.unit.vehicle_services.fake_vehicle import HEALTHY, MS, Bench, S, acks, long, of
from vehicle_sim.autopilot.interface import Geodetic, ImageCaptured, StatusText
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Cmd, Sensor

GROUND = m.Heartbeat(0, 6, 8, 0, 4, 3)


def rates(bench: Bench, seconds: int = 2, peer: str = "ground") -> Counter[str]:
    heard = bench.advance(seconds * S, peer=peer)
    return Counter({name: n // seconds for name, n in Counter(map(kind, heard)).items()})


def kind(message: m.Message) -> str:
    return type(message).__name__


def test_px4_sends_unasked() -> None:
    bench = Bench("px4")
    bench.send(GROUND)
    heard = rates(bench)
    assert heard["Heartbeat"] == 1
    assert heard["LocalPositionNed"] == 50
    assert heard["ExtendedSysState"] == 5


def test_ardupilot_gives_data_streams_at_the_rate_asked_for_and_stops_them() -> None:
    bench = Bench("ardupilot")
    bench.send(m.RequestDataStream(4, 1, 1, 0, 1))
    heard = rates(bench)
    assert heard["GlobalPositionInt"] == heard["Attitude"] == heard["SysStatus"] == 4
    bench.send(m.RequestDataStream(0, 1, 1, 6, 0))
    heard = rates(bench)
    assert heard["GlobalPositionInt"] == 0
    assert heard["Attitude"] == 4


@pytest.mark.parametrize(("interval_us", "hertz"), [(100_000, 10), (20_000, 50), (-1, 0)])
def test_a_message_interval_is_honoured(interval_us: int, hertz: int) -> None:
    bench = Bench("ardupilot")
    heard = bench.send(long(Cmd.SET_MESSAGE_INTERVAL, 32, interval_us))
    assert acks(heard) == [(511, 0)]
    assert rates(bench)["LocalPositionNed"] == hertz
    told = bench.send(long(Cmd.GET_MESSAGE_INTERVAL, 32))
    assert [each.interval_us for each in of(told, m.MessageInterval)] == [interval_us]


def test_the_longest_interval_is_what_its_message_can_tell() -> None:
    bench = Bench("px4")
    bench.send(long(Cmd.SET_MESSAGE_INTERVAL, 30, 1e10))
    told = of(bench.send(long(Cmd.GET_MESSAGE_INTERVAL, 30)), m.MessageInterval)
    assert told == [m.MessageInterval(2**31 - 1, 30)]


def test_what_cannot_be_had_at_a_rate_fails() -> None:
    bench = Bench("px4")
    assert acks(bench.send(long(Cmd.SET_MESSAGE_INTERVAL, 42, 1e5))) == [(511, 4)]
    assert acks(bench.send(long(Cmd.SET_MESSAGE_INTERVAL, 12345, 1e5))) == [(511, 4)]
    told = bench.send(long(Cmd.GET_MESSAGE_INTERVAL, 12345))
    assert [each.interval_us for each in of(told, m.MessageInterval)] == [0]


@pytest.mark.parametrize("speedup", [4, 50])
def test_a_fast_vehicle_sends_no_more_per_second_of_wall_time(speedup: int) -> None:
    bench = Bench("px4", Fraction(speedup))
    bench.send(GROUND)
    heard = rates(bench)
    assert heard["Heartbeat"] == 1
    assert heard["LocalPositionNed"] == pytest.approx(50, abs=1)
    assert bench.world.time_ns == 2 * S * speedup


def test_the_position_lies_on_a_grid_of_its_own() -> None:
    bench = Bench("px4")
    bench.send(GROUND)
    bench.send(long(Cmd.SET_MESSAGE_INTERVAL, 30, 7000))
    heard = bench.advance(1 * S)
    at_ms = [each.time_boot_ms for each in of(heard, m.LocalPositionNed)]
    assert {time % 20 for time in at_ms} == {0}
    assert len(at_ms) == 50


def test_a_newcomer_is_told_at_once_who_where_and_home() -> None:
    heard = Bench("px4").send(GROUND)
    assert [kind(each) for each in heard] == ["Heartbeat", "GpsGlobalOrigin", "HomePosition"]


def test_the_origin_is_told_when_it_is_known_and_no_position_before() -> None:
    bench = Bench("px4")
    bench.vehicle.origin = None
    bench.send(GROUND)
    heard = rates(bench)
    assert heard["LocalPositionNed"] == heard["GlobalPositionInt"] == 0
    bench.vehicle.origin = Geodetic(47.0, 8.0, 400.0)
    told = of(bench.advance(20 * MS), m.GpsGlobalOrigin)
    assert [(each.latitude, each.altitude) for each in told] == [(470000000, 400000)]


def test_the_prearm_bit_says_whether_it_can_be_armed() -> None:
    bench = Bench("px4")
    bench.send(GROUND)
    bench.vehicle.armable = False
    (status,) = of(bench.advance(500 * MS), m.SysStatus)
    assert not status.onboard_control_sensors_health & Sensor.PREARM_CHECK
    assert status.onboard_control_sensors_health & Sensor.GYRO_3D


def test_position_sensors_are_not_healthy_before_the_estimator_is() -> None:
    """MAVSDK takes these bits for health, and arms as soon as all is well."""
    bench = Bench("px4")
    bench.send(GROUND)
    position = Sensor.GPS | Sensor.AHRS
    health = []
    starting = replace(HEALTHY, attitude_ok=False, position_ok=False, gps_ok=False)
    for bench.vehicle.health in (starting, HEALTHY):
        (status,) = of(bench.advance(500 * MS), m.SysStatus)
        health.append(status.onboard_control_sensors_health & position)
    assert health == [0, position]


@pytest.mark.parametrize(
    ("personality", "kinds"),
    [("px4", ["CameraImageCaptured"]), ("ardupilot", ["CameraImageCaptured", "CameraFeedback"])],
)
def test_an_image_is_told_and_can_be_asked_for_again(personality: str, kinds: list[str]) -> None:
    bench = Bench("px4" if personality == "px4" else "ardupilot")
    bench.send(GROUND)
    where = Geodetic(47.0, 8.0, 400.0)
    bench.vehicle.pending.append(ImageCaptured(5, 12 * S, where, 10.0, (1.0, 0.0, 0.0, 0.0)))
    heard = [kind(each) for each in bench.advance(20 * MS)]
    assert [each for each in heard if each.startswith("Camera")] == kinds
    again = bench.send(long(Cmd.REQUEST_MESSAGE, 263, 5))
    assert [each.image_index for each in of(again, m.CameraImageCaptured)] == [5]


def test_a_long_text_goes_out_in_chunks_that_belong_together() -> None:
    bench = Bench("px4")
    bench.send(GROUND)
    text = "Preflight Fail: " + "the quick brown fox jumps over the lazy dog " * 2
    bench.vehicle.pending.append(StatusText(3, text))
    chunks = of(bench.advance(20 * MS), m.Statustext)
    assert b"".join(each.text.rstrip(b"\0") for each in chunks).decode() == text
    assert [each.chunk_seq for each in chunks] == [0, 1, 2]
    assert len({each.id for each in chunks}) == 1
    assert chunks[0].id != 0
    assert [(line.level, line.text) for line in bench.logs][-1] == ("error", text)


def test_arming_and_modes_are_logged_by_name() -> None:
    bench = Bench("px4")
    bench.send(long(Cmd.COMPONENT_ARM_DISARM, 1))
    bench.send(long(Cmd.DO_SET_MODE, 1, 6))
    bench.advance(20 * MS)
    texts = [line.text for line in bench.logs]
    assert "armed" in texts
    assert "mode OFFBOARD" in texts
    assert "client 255/190 seen" in texts


def test_timesync_and_ping_are_echoed_to_the_asker_and_answers_are_not() -> None:
    bench = Bench("px4")
    bench.send(GROUND)
    bench.advance(1 * S)
    (echo,) = bench.send(m.Timesync(0, 12345))
    assert isinstance(echo, m.Timesync)
    assert (echo.tc1, echo.ts1) == (1 * S, 12345)
    assert bench.send(echo) == []
    (pong,) = bench.send(m.Ping(99, 4, 0, 0))
    assert isinstance(pong, m.Ping)
    assert (pong.seq, pong.target_system, pong.target_component) == (4, 255, 190)
    assert bench.send(m.Ping(99, 4, 1, 1)) == []


def test_ardupilot_4_7_refuses_a_rate_that_its_loop_cannot_keep() -> None:
    """K1_small_services: 5000 us ACCEPTED; 100 us DENIED, with a text in two chunks."""
    bench = Bench("ardupilot", firmware="4.7")
    assert acks(bench.send(long(Cmd.SET_MESSAGE_INTERVAL, 24, 5000))) == [(511, 0)]
    heard = bench.send(long(Cmd.SET_MESSAGE_INTERVAL, 24, 100))
    assert acks(heard) == [(511, 2)]
    assert [each.text.rstrip(b"\0") for each in of(heard, m.Statustext)] == [
        b"Requested rate for message ID 24 too fast. Increas",
        b"e SCHED_LOOP_RATE",
    ]
    told = bench.send(long(Cmd.GET_MESSAGE_INTERVAL, 24))
    assert [each.interval_us for each in of(told, m.MessageInterval)] == [5000]


@pytest.mark.parametrize("number", [4, 9999])
def test_ardupilot_names_a_message_that_it_cannot_stream(number: int) -> None:
    """K1_small_services: PING and 9999."""
    bench = Bench("ardupilot")
    heard = bench.send(long(Cmd.SET_MESSAGE_INTERVAL, number, 1e6))
    assert acks(heard) == [(511, 2)]
    (text,) = [each.text.rstrip(b"\0") for each in of(heard, m.Statustext)]
    assert text == b"No ap_message for mavlink id (%d)" % number
    assert acks(bench.send(long(Cmd.GET_MESSAGE_INTERVAL, number))) == [(510, 4)]
