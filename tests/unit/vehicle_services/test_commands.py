"""Commands: one final ack each, retries without second effect, truthful results."""

from __future__ import annotations

import math

import pytest

from tests.unit.vehicle_services.fake_vehicle import HOME, MS, Bench, S, acks, long, of
from vehicle_sim.autopilot.interface import CommandDone, Result
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Cmd, MavFrame

NAN = math.nan


def command_int(command: int, frame: int, x: int = 0, y: int = 0, z: float = 0.0) -> m.CommandInt:
    return m.CommandInt(-1.0, 0.0, 0.0, NAN, x, y, z, command, 1, 1, frame, 0, 0)


def test_an_ack_goes_to_the_sender() -> None:
    bench = Bench()
    heard = bench.send(long(Cmd.COMPONENT_ARM_DISARM, 1), system=245, component=190)
    (ack,) = of(heard, m.CommandAck)
    assert (ack.result, ack.target_system, ack.target_component) == (0, 245, 190)
    assert bench.vehicle.named("arm") == [(False,)]


def test_two_clients_on_one_link_hear_each_only_their_own_acks() -> None:
    bench = Bench()
    bench.send(m.Heartbeat(0, 6, 8, 0, 4, 3), peer="other")
    heard = bench.send(long(Cmd.NAV_LAND), peer="ground")
    assert acks(heard) == [(Cmd.NAV_LAND, Result.ACCEPTED)]
    assert acks(bench.advance(100 * MS, peer="other")) == []


def test_the_ack_is_lost_and_the_retry_gets_it_again_without_a_second_effect() -> None:
    bench = Bench()
    bench.send(long(Cmd.IMAGE_START_CAPTURE, 0, 0, 1))
    bench.advance(500 * MS)
    again = bench.send(long(Cmd.IMAGE_START_CAPTURE, 0, 0, 1, confirmation=1))
    assert acks(again) == [(Cmd.IMAGE_START_CAPTURE, Result.ACCEPTED)]
    assert len(bench.vehicle.named("capture_image")) == 1


def test_a_datagram_that_the_network_doubled_has_one_effect_and_two_acks() -> None:
    bench = Bench()
    first = bench.send(long(Cmd.IMAGE_START_CAPTURE, 0, 0, 1), sequence=7)
    second = bench.send(long(Cmd.IMAGE_START_CAPTURE, 0, 0, 1), sequence=7)
    assert acks(first) == acks(second) == [(Cmd.IMAGE_START_CAPTURE, Result.ACCEPTED)]
    assert len(bench.vehicle.named("capture_image")) == 1


def test_the_first_frame_is_lost_and_the_retry_is_carried_out() -> None:
    bench = Bench()
    bench.send(long(Cmd.NAV_LAND, confirmation=2))
    assert bench.vehicle.named("land") == [()]


def test_the_same_command_asked_anew_is_carried_out_anew() -> None:
    bench = Bench()
    bench.send(long(Cmd.IMAGE_START_CAPTURE, 0, 0, 1))
    bench.send(long(Cmd.IMAGE_START_CAPTURE, 0, 0, 1))
    assert len(bench.vehicle.named("capture_image")) == 2


def test_a_refusal_is_remembered_like_any_other_result() -> None:
    bench = Bench()
    bench.vehicle.answers["arm"] = Result.DENIED
    assert acks(bench.send(long(Cmd.COMPONENT_ARM_DISARM, 1))) == [(400, Result.DENIED)]
    bench.vehicle.answers.clear()
    again = bench.send(long(Cmd.COMPONENT_ARM_DISARM, 1, confirmation=1))
    assert acks(again) == [(400, Result.DENIED)]
    assert not bench.vehicle.armed


def test_an_old_memory_does_not_answer_for_a_new_command() -> None:
    bench = Bench()
    bench.send(long(Cmd.NAV_LAND))
    bench.advance(4 * S)
    bench.send(long(Cmd.NAV_LAND, confirmation=1))
    assert len(bench.vehicle.named("land")) == 2


def test_a_long_command_is_in_progress_then_done_and_a_retry_does_not_start_it_twice() -> None:
    bench = Bench()
    bench.vehicle.answers["capture_image"] = Result.IN_PROGRESS
    started = bench.send(long(Cmd.IMAGE_START_CAPTURE, 0, 0, 1))
    retried = bench.send(long(Cmd.IMAGE_START_CAPTURE, 0, 0, 1, confirmation=1))
    assert acks(started) == acks(retried) == [(2000, Result.IN_PROGRESS)]
    bench.vehicle.pending.append(CommandDone(2000, Result.ACCEPTED))
    # Each of the two frames gets its final ack.
    assert acks(bench.advance(100 * MS)) == [(2000, Result.ACCEPTED)] * 2
    assert len(bench.vehicle.named("capture_image")) == 1
    late = bench.send(long(Cmd.IMAGE_START_CAPTURE, 0, 0, 1, confirmation=2))
    assert acks(late) == [(2000, Result.ACCEPTED)]


@pytest.mark.parametrize("command", [0, 1, 35, 500, 31000, 65535])
def test_an_unknown_command_is_unsupported(command: int) -> None:
    assert acks(Bench().send(long(command))) == [(command, Result.UNSUPPORTED)]


def test_a_command_for_another_system_is_ignored() -> None:
    bench = Bench()
    assert acks(bench.send(long(Cmd.NAV_LAND, target=2))) == []
    assert bench.vehicle.named("land") == []


@pytest.mark.parametrize(
    ("personality", "result", "times"),
    [("px4", Result.FAILED, 0), ("ardupilot", Result.ACCEPTED, 1)],
)
def test_a_command_for_a_component_that_there_is_not(
    personality: Personality, result: Result, times: int
) -> None:
    """behaviour.json: PX4 fails it, ArduPilot carries it out."""
    bench = Bench(personality)
    heard = bench.send(long(Cmd.COMPONENT_ARM_DISARM, 1)._replace(target_component=25))
    assert acks(heard) == [(400, result)]
    assert len(bench.vehicle.named("arm")) == times


def test_a_broadcast_command_is_for_us_too() -> None:
    bench = Bench()
    asked = long(Cmd.NAV_LAND, target=0)._replace(target_component=0)
    assert acks(bench.send(asked)) == [(Cmd.NAV_LAND, Result.ACCEPTED)]


@pytest.mark.parametrize("frame", [MavFrame.LOCAL_NED, MavFrame.GLOBAL_TERRAIN_ALT_INT, 200])
def test_a_place_in_a_frame_that_is_not_global_is_an_unsupported_frame(frame: int) -> None:
    heard = Bench().send(command_int(Cmd.DO_SET_ROI_LOCATION, frame))
    assert acks(heard) == [(Cmd.DO_SET_ROI_LOCATION, Result.UNSUPPORTED_MAV_FRAME)]


@pytest.mark.parametrize(
    ("personality", "p7", "up"),
    [
        ("px4", NAN, None),
        ("px4", HOME.alt_amsl_m + 4.0, 4.0),
        ("px4", 0.0, None),
        ("ardupilot", 4.0, 4.0),
    ],
)
def test_the_height_of_a_take_off(personality: Personality, p7: float, up: float | None) -> None:
    """px4: above mean sea level, ardupilot: above home."""
    bench = Bench(personality)
    bench.send(long(Cmd.NAV_TAKEOFF, 0, 0, 0, NAN, NAN, NAN, p7))
    assert bench.vehicle.named("take_off") == [(up,)]


def test_ardupilot_is_not_told_how_high_to_take_off() -> None:
    bench = Bench("ardupilot")
    assert acks(bench.send(long(Cmd.NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, NAN))) == [(22, Result.DENIED)]
    assert bench.vehicle.calls == []


def test_reposition_by_command_int_is_exact_and_by_home() -> None:
    bench = Bench()
    asked = command_int(
        Cmd.DO_REPOSITION, MavFrame.GLOBAL_RELATIVE_ALT_INT, 473977420, 85455940, 12.5
    )._replace(param2=1.0)
    assert acks(bench.send(asked)) == [(Cmd.DO_REPOSITION, Result.ACCEPTED)]
    ((pos_ned, yaw, speed, changes_mode),) = bench.vehicle.named("reposition")
    assert pos_ned == pytest.approx((0.0, 0.0, -12.5), abs=1e-3)
    assert (yaw, speed, changes_mode) == (None, None, True)


def test_reposition_keeps_what_it_is_not_given() -> None:
    bench = Bench()
    bench.send(long(Cmd.DO_REPOSITION, 3.0, 1, 0, 0.5, NAN, NAN, NAN))
    ((pos_ned, yaw, speed, _),) = bench.vehicle.named("reposition")
    assert (pos_ned, yaw, speed) == ((10.0, 20.0, -5.0), 0.5, 3.0)


@pytest.mark.parametrize(
    "asked",
    [
        long(Cmd.DO_REPOSITION, -1, 1, 0, NAN, 91.0, 8.5, 500.0),
        long(Cmd.DO_REPOSITION, -1, 1, 0, NAN, 47.4, 8.5, math.inf),
        long(Cmd.NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, math.inf),
        long(Cmd.COMPONENT_ARM_DISARM, NAN),
        long(Cmd.COMPONENT_ARM_DISARM, 0.5),
        long(Cmd.DO_SET_HOME, 0, 0, 0, 0, 47.0, 200.0, 10.0),
        long(Cmd.DO_SET_MODE, NAN),
        long(Cmd.SET_MESSAGE_INTERVAL, 30, math.inf),
        long(Cmd.IMAGE_START_CAPTURE, 0, NAN, 1),
        long(Cmd.IMAGE_START_CAPTURE, 0, 0, NAN),
    ],
    ids=lambda asked: f"{asked.command}-{asked[:7]}",
)
def test_numbers_that_make_no_sense_are_denied_before_the_vehicle_sees_them(
    asked: m.CommandLong,
) -> None:
    bench = Bench()
    assert acks(bench.send(asked)) == [(asked.command, Result.DENIED)]
    assert bench.vehicle.calls == []


@pytest.mark.parametrize(
    "asked",
    [
        long(Cmd.DO_CHANGE_SPEED, 1, NAN),
        long(Cmd.DO_CHANGE_SPEED, 1, -1),
        long(Cmd.CONDITION_YAW, NAN),
        long(Cmd.CONDITION_YAW, 1, 1, 1e38),
    ],
    ids=lambda asked: f"{asked.command}-{asked[:7]}",
)
def test_numbers_that_make_no_sense_are_denied_by_an_ardupilot_in_flight(
    asked: m.CommandLong,
) -> None:
    """On a NaN speed the recorded one crashed (H8)."""
    bench = Bench("ardupilot")
    bench.vehicle.armed = True
    assert acks(bench.send(asked)) == [(asked.command, Result.DENIED)]
    assert bench.vehicle.calls == []


def test_px4_modes_travel_as_main_and_sub_mode() -> None:
    bench = Bench()
    bench.send(long(Cmd.DO_SET_MODE, 1, 4, 4))
    assert bench.vehicle.named("set_mode") == [(1, 4 << 16 | 4 << 24)]


def test_ardupilot_acks_set_mode_under_the_number_of_the_message() -> None:
    bench = Bench("ardupilot")
    assert acks(bench.send(m.SetMode(4, 1, 1))) == [(11, Result.ACCEPTED)]
    assert bench.vehicle.named("set_mode") == [(1, 4)]
    assert acks(Bench("px4").send(m.SetMode(6 << 16, 1, 1))) == []


def test_the_version_comes_after_its_ack_with_true_capabilities() -> None:
    for asked in (
        long(Cmd.REQUEST_MESSAGE, 148),
        long(Cmd.REQUEST_AUTOPILOT_CAPABILITIES, 1),
    ):
        heard = [each for each in Bench().send(asked) if not isinstance(each, m.Heartbeat)]
        ack, version = heard[-2:]
        assert isinstance(ack, m.CommandAck)
        assert isinstance(version, m.AutopilotVersion)
        assert version.capabilities & 0x2000, "MAVLink 2"
        assert version.capabilities & 0x10, "bytewise parameters"
        assert version.capabilities & 0x20, "file transfer"


@pytest.mark.parametrize(
    ("personality", "unknown", "too_early"),
    [("px4", Result.DENIED, Result.DENIED), ("ardupilot", Result.FAILED, Result.ACCEPTED)],
)
def test_a_message_that_there_is_not_and_one_too_early(
    personality: Personality, unknown: Result, too_early: Result
) -> None:
    """behaviour.json; ArduPilot accepted LOCAL_POSITION_NED, and sent none."""
    bench = Bench(personality)
    bench.vehicle.origin = None
    assert acks(bench.send(long(Cmd.REQUEST_MESSAGE, 9999))) == [(512, unknown)]
    assert acks(bench.send(long(Cmd.REQUEST_MESSAGE, 49))) == [(512, too_early)]


@pytest.mark.parametrize(("personality", "told"), [("px4", 0xECFF), ("ardupilot", 0xFBEF)])
def test_capabilities(personality: Personality, told: int) -> None:
    """autopilots.md, "Real beside ours" 3."""
    heard = Bench(personality).send(long(Cmd.REQUEST_MESSAGE, 148))
    (version,) = of(heard, m.AutopilotVersion)
    assert version.capabilities == told


def test_home_is_told_when_asked() -> None:
    heard = Bench().send(long(Cmd.GET_HOME_POSITION))
    home = of(heard, m.HomePosition)[-1]
    assert (home.latitude, home.longitude, home.altitude) == (473977420, 85455940, 488000)


@pytest.mark.parametrize("system", [1, 255, 250])
def test_with_sysid_enforce_ardupilot_hears_its_own_station_and_its_own_system(system: int) -> None:
    """SYSID_MYGCS is 255, the vehicle's system 1: a companion computer has that one."""
    bench = Bench("ardupilot")
    bench.parameters.set("SYSID_ENFORCE", 1)
    answers = acks(bench.send(long(Cmd.REQUEST_MESSAGE, 0.0), system=system))
    assert bool(answers) is (system != 250)
