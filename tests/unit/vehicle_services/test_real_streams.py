"""`--streams real`: what the real autopilots send unasked, message by message."""

from __future__ import annotations

from collections import Counter
from typing import Final

import pytest

from tests.unit.vehicle_services.fake_vehicle import NUMBERS, Bench, Kind, S, long, of
from tests.unit.vehicle_services.flown_vehicle import Flown
from tests.unit.vehicle_services.test_missions import item, upload
from vehicle_sim.autopilot.interface import AttitudeGoal, Landed, Result
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.services.stream_sets import REAL, LinkMode, mode_of_port
from vehicle_sim.shell.urls import UrlError, parse
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Cmd

GROUND = m.Heartbeat(0, 6, 8, 0, 4, 3)
SECONDS: Final = 30

NORMAL_HZ: Final[dict[type[m.Message], float]] = {
    m.Altitude: 1,
    m.Attitude: 50,
    m.AttitudeQuaternion: 50,
    m.AttitudeTarget: 50,
    m.BatteryStatus: 0.5,
    m.CurrentEventSequence: 1 / 3,
    m.EstimatorStatus: 0.5,
    m.ExtendedSysState: 1,
    m.GlobalPositionInt: 50,
    m.GpsRawInt: 1,
    m.Heartbeat: 1,
    m.HomePosition: 0.5,
    m.LocalPositionNed: 50,
    m.OpenDroneIdLocation: 1,
    m.OpenDroneIdSystem: 1,
    m.Ping: 0.1,
    m.PositionTargetLocalNed: 50,
    m.ScaledPressure: 1,
    m.ServoOutputRaw: 50,
    m.SysStatus: 1,
    m.UtmGlobalPosition: 0.5,
    m.VfrHud: 4,
    m.Vibration: 0.1,
}
"""px4_1_14_flight.tlog, on 14550, 6 to 24 s after its beginning, when nothing had been asked for;
autopilots.md "PX4 on 14550, Hz, real / ours"; behaviour.json "streams on 14550 and 14540".
MISSION_CURRENT comes with a mission alone.  Not sent here: DISTANCE_SENSOR 0.5, LINK_NODE_STATUS 1,
TIME_ESTIMATE_TO_TARGET 1."""

ONBOARD_HZ: Final[dict[type[m.Message], float]] = {
    m.Altitude: 10,
    m.Attitude: 20,
    m.AttitudeQuaternion: 50,
    m.AttitudeTarget: 10,
    m.BatteryStatus: 1,
    m.CurrentEventSequence: 1 / 3,
    m.EstimatorStatus: 1,
    m.ExtendedSysState: 5,
    m.GlobalPositionInt: 5,
    m.GpsRawInt: 1,
    m.Heartbeat: 1,
    m.HighresImu: 50,
    m.HomePosition: 0.5,
    m.LocalPositionNed: 30,
    m.Odometry: 30,
    m.OpenDroneIdLocation: 1,
    m.OpenDroneIdSystem: 1,
    m.Ping: 1,
    m.PositionTargetLocalNed: 5,
    m.ScaledPressure: 1,
    m.ServoOutputRaw: 10,
    m.SystemTime: 1,
    m.SysStatus: 2,
    m.Timesync: 10,
    m.UtmGlobalPosition: 1,
    m.VfrHud: 10,
    m.Vibration: 0.5,
}
"""rates_px4_14540.json, "real_hz", each counted over 12 s there (9.92 is 10).  Not sent here:
DISTANCE_SENSOR 10, 8 LINK_NODE_STATUS 1, 380 TIME_ESTIMATE_TO_TARGET 1."""

ROWS: Final = [
    *(
        pytest.param(LinkMode.NORMAL, *row, id=f"14550 {row[0].__name__}")
        for row in NORMAL_HZ.items()
    ),
    *(
        pytest.param(LinkMode.ONBOARD, *row, id=f"14540 {row[0].__name__}")
        for row in ONBOARD_HZ.items()
    ),
]


@pytest.fixture(scope="module")
def heard() -> dict[LinkMode, list[m.Message]]:
    """What a PX4 that stands on the ground sends on either link in half a minute."""
    told: dict[LinkMode, list[m.Message]] = {}
    for mode in LinkMode:
        bench = Bench("px4", stream_sets=REAL["px4"], mode=mode)
        bench.send(GROUND)
        told[mode] = bench.advance(SECONDS * S)
    return told


@pytest.mark.parametrize(("mode", "kind", "rate_hz"), ROWS)
def test_px4_sends_at_the_recorded_rate(
    heard: dict[LinkMode, list[m.Message]],
    mode: LinkMode,
    kind: type[m.Message],
    rate_hz: float,
) -> None:
    count = sum(type(each) is kind for each in heard[mode])
    assert count == pytest.approx(rate_hz * SECONDS, abs=1)


@pytest.mark.parametrize(
    ("mode", "rates"), [(LinkMode.NORMAL, NORMAL_HZ), (LinkMode.ONBOARD, ONBOARD_HZ)]
)
def test_px4_sends_nothing_else(
    heard: dict[LinkMode, list[m.Message]], mode: LinkMode, rates: dict[type[m.Message], float]
) -> None:
    assert {type(each) for each in heard[mode]} - set(rates) == {m.Event}


@pytest.mark.parametrize("mode", LinkMode)
def test_px4_tells_the_item_of_a_mission_and_nothing_without_one(mode: LinkMode) -> None:
    """Seen of PX4 1.14.3 in 10 s: none without a mission, 98 with one on 14550 and on 14540, all
    fields but seq 0; REQUEST_MESSAGE without one is DENIED."""
    bench = Bench("px4", stream_sets=REAL["px4"], mode=mode)
    bench.send(GROUND)
    assert of(bench.advance(10 * S), m.MissionCurrent) == []
    asked = bench.send(long(Cmd.REQUEST_MESSAGE, NUMBERS[m.MissionCurrent]))
    assert [each.result for each in of(asked, m.CommandAck)] == [Result.DENIED]
    upload(bench, [item(0), item(1)])
    told = of(bench.advance(10 * S), m.MissionCurrent)
    assert len(told) == pytest.approx(98, abs=3)
    assert set(told) == {m.MissionCurrent(0)}


def test_ardupilot_sends_heartbeat_and_timesync() -> None:
    """autopilots.md 2; arducopter_4_7_flight.tlog: TIMESYNC every 10 s."""
    bench = Bench("ardupilot", stream_sets=REAL["ardupilot"])
    assert {type(each) for each in bench.send(GROUND)} == {m.Heartbeat}
    told = Counter(type(each) for each in bench.advance(SECONDS * S))
    assert told == {m.Heartbeat: SECONDS, m.Timesync: SECONDS // 10}


def test_ardupilot_sends_more_when_asked_and_by_its_parameters() -> None:
    bench = Bench("ardupilot", stream_sets=REAL["ardupilot"])
    bench.send(m.RequestDataStream(4, 1, 1, 6, 1))
    bench.send(long(Cmd.SET_MESSAGE_INTERVAL, 30, 100_000))
    told = Counter(type(each) for each in bench.advance(10 * S))
    assert (told[m.GlobalPositionInt], told[m.Attitude]) == (40, 100)
    bench = Bench("ardupilot", stream_sets=REAL["ardupilot"])
    bench.parameters.start_with("SR0_EXTRA1", 5)
    bench.send(GROUND)
    assert Counter(type(each) for each in bench.advance(10 * S))[m.Attitude] == 50


def test_ardupilot_tells_no_position_before_it_knows_where_it_is() -> None:
    """behaviour.json "armable": LOCAL_POSITION_NED is not sent at all before about 40 s."""
    bench = Bench("ardupilot", stream_sets=REAL["ardupilot"])
    bench.vehicle.origin = None
    bench.send(m.RequestDataStream(4, 1, 1, 0, 1))
    told = Counter(type(each) for each in bench.advance(10 * S))
    assert (told[m.Attitude], told[m.LocalPositionNed]) == (40, 0)
    bench.vehicle.origin = Bench().vehicle.origin
    assert Counter(map(type, bench.advance(10 * S)))[m.LocalPositionNed] == 40


def test_ardupilot_tells_its_landed_state_as_soon_as_it_is_initialised() -> None:
    """Scenarios `boot_to_ready` and `H7_force_arm_not_ready`: ON_GROUND 2.7 s after power-up.

    In arducopter_4_7_flight.tlog it was not asked for before 42.4 s, and then told at once: what
    behaviour.json "armable" says of it, not sent before about 40 s, is that nobody had asked.
    """
    bench = Flown("ardupilot", boot="real")
    bench.send(long(Cmd.SET_MESSAGE_INTERVAL, m.IDS[m.ExtendedSysState], 200_000))
    assert Counter(map(type, bench.advance(12 * S // 5)))[m.ExtendedSysState] == 0
    told = of(bench.advance(S), m.ExtendedSysState)
    assert len(told) == 5
    assert {each.landed_state for each in told} == {Landed.ON_GROUND}


def test_ardupilots_groups_hold_what_the_recorded_one_sent() -> None:
    """arducopter_4_7_flight.tlog, 53 to 61 s: all groups at 4 Hz, EXTENDED_SYS_STATE stays at 5."""
    bench = Bench("ardupilot", stream_sets=REAL["ardupilot"])
    bench.send(long(Cmd.SET_MESSAGE_INTERVAL, m.IDS[m.ExtendedSysState], 200_000))
    bench.send(m.RequestDataStream(4, 1, 1, 0, 1))
    told = Counter(type(each) for each in bench.advance(10 * S))
    assert (told[m.ExtendedSysState], told[m.Attitude], told[m.Wind]) == (50, 40, 40)
    silent = (m.AttitudeQuaternion, m.PositionTargetLocalNed, m.Hwstatus)
    assert [told[kind] for kind in silent] == [0, 0, 0]


def test_a_heartbeat_comes_out_of_turn_when_ardupilots_mode_changes_alone() -> None:
    """Both flights' HEARTBEATs: PX4's come on their second whatever happens, ArduCopter's tells a
    new mode at once and arming not."""
    expected: dict[Personality, tuple[int, int]] = {"px4": (0, 0), "ardupilot": (1, 0)}
    for personality, beats in expected.items():
        bench = Bench(personality, stream_sets=REAL[personality])
        bench.send(GROUND)
        bench.advance(S // 10)
        bench.vehicle.custom_mode = 9
        mode = Counter(map(type, bench.advance(S // 10)))
        bench.vehicle.armed = not bench.vehicle.armed
        arming = Counter(map(type, bench.advance(S // 10)))
        assert (mode[m.Heartbeat], arming[m.Heartbeat]) == beats


def test_an_interval_of_0_is_the_default_of_that_link() -> None:
    bench = Bench("px4", stream_sets=REAL["px4"], mode=LinkMode.ONBOARD)
    bench.send(long(Cmd.SET_MESSAGE_INTERVAL, m.IDS[m.LocalPositionNed], 1_000_000))
    assert Counter(map(type, bench.advance(10 * S)))[m.LocalPositionNed] == 10
    bench.send(long(Cmd.SET_MESSAGE_INTERVAL, m.IDS[m.LocalPositionNed], 0))
    assert Counter(map(type, bench.advance(10 * S)))[m.LocalPositionNed] == 300


@pytest.mark.parametrize("port", [14540, 14549])
def test_the_ports_of_programs_on_board(port: int) -> None:
    assert mode_of_port(port) is LinkMode.ONBOARD


@pytest.mark.parametrize("port", [14539, 14550, 5760, 0])
def test_all_other_ports_are_for_ground_stations(port: int) -> None:
    assert mode_of_port(port) is LinkMode.NORMAL


def test_a_link_may_say_what_it_is() -> None:
    assert parse("udpin://127.0.0.1:14540").mode is None
    assert parse("udpin://127.0.0.1:14540,normal").mode is LinkMode.NORMAL
    named = parse("tcpin://127.0.0.1:5760,onboard")
    assert named.mode is LinkMode.ONBOARD
    assert str(named) == "tcpin://127.0.0.1:5760"
    with pytest.raises(UrlError, match="normal or onboard"):
        parse("udpin://127.0.0.1:14540,on board")


# ---------------------------------------------------------------- what is told in these sets


def test_on_the_ground_px4_holds_no_place_and_pushes_into_the_ground(
    heard: dict[LinkMode, list[m.Message]],
) -> None:
    """px4_1_14_flight.tlog, 0 to 66 s: NaN, acceleration 0, 0, 100, type_mask 63."""
    target = of(heard[LinkMode.NORMAL], m.PositionTargetLocalNed)[-1]
    assert all(each != each for each in target[1:7])
    assert (target.afx, target.afy, target.afz) == (0.0, 0.0, 100.0)
    assert (target.type_mask, target.coordinate_frame) == (63, 1)
    attitude = of(heard[LinkMode.NORMAL], m.AttitudeTarget)[-1]
    assert attitude.q == pytest.approx((1.0, 0.0, 0.0, 0.0))
    assert attitude.thrust == pytest.approx(0.001)


def test_in_flight_the_targets_are_those_of_the_controllers() -> None:
    bench = Bench("px4", stream_sets=REAL["px4"])
    bench.vehicle.armed = True
    bench.vehicle.attitude_goal = AttitudeGoal((0.8, 0.0, 0.0, 0.6), (0.1, 0.2, 0.3), 0.45)
    told = bench.send(GROUND) + bench.advance(S)
    target = of(told, m.PositionTargetLocalNed)[-1]
    assert (target.x, target.y, target.z) == (0.0, 0.0, -2.0)
    attitude = of(told, m.AttitudeTarget)[-1]
    assert (*attitude.q, attitude.thrust) == pytest.approx((0.8, 0.0, 0.0, 0.6, 0.45))


def test_odometry_is_in_ned_and_along_the_bodys_axes() -> None:
    """common.xml: x, y, z in frame_id, vx, vy, vz in child_frame_id.  Heading west: north is to the
    right."""
    bench = Bench("px4", stream_sets=REAL["px4"], mode=LinkMode.ONBOARD)
    half = 0.5**0.5
    bench.vehicle.q_ned_from_frd = (half, 0.0, 0.0, -half)
    told = of(bench.send(GROUND) + bench.advance(S), m.Odometry)[-1]
    assert (told.x, told.y, told.z) == (10.0, 20.0, -5.0)
    assert (told.vx, told.vy, told.vz) == pytest.approx((0.0, 1.0, 0.0), abs=1e-6)
    assert (told.frame_id, told.child_frame_id, told.estimator_type) == (1, 12, 8)
    assert told.q == pytest.approx((half, 0.0, 0.0, -half))
    assert told.pose_covariance[0] == pytest.approx(0.16)
    assert told.pose_covariance[1] != told.pose_covariance[1]
    assert [index for index, each in enumerate(told.velocity_covariance) if each == each] == [
        *(0, 6, 11, 15, 18, 20)
    ]


def asked_at_1_hz(bench: Bench, kind: type[Kind]) -> Kind:
    bench.send(long(Cmd.SET_MESSAGE_INTERVAL, NUMBERS[kind], 1_000_000))
    return of(bench.advance(2 * S), kind)[-1]


def test_outputs_are_900_while_disarmed_and_pulses_in_flight() -> None:
    """px4_1_14_flight.tlog: ACTUATOR_OUTPUT_STATUS active 16, sixteen times 900, then 0."""
    bench = Bench("px4")
    told = asked_at_1_hz(bench, m.ActuatorOutputStatus)
    assert (told.active, told.actuator) == (16, (900.0,) * 16 + (0.0,) * 16)
    bench.vehicle.armed, bench.vehicle.motor_outputs = True, (0.5, 0.25, 0.75, 1.0)
    told = asked_at_1_hz(bench, m.ActuatorOutputStatus)
    assert told.actuator[:5] == (1500.0, 1250.0, 1750.0, 2000.0, 900.0)


def test_the_motor_controllers_share_the_batterys_current() -> None:
    bench = Bench("px4")
    bench.vehicle.motor_outputs = (0.5, 0.25, 0.75, 0.5)
    told = asked_at_1_hz(bench, m.EscStatus)
    assert told.rpm == (4750, 2375, 7125, 4750)
    assert told.voltage == pytest.approx((15.2,) * 4)
    assert told.current == pytest.approx((1.0, 0.5, 1.5, 1.0))
    info = asked_at_1_hz(bench, m.EscInfo)
    assert (info.count_, info.info, info.failure_flags) == (4, 0b1111, (0,) * 4)


def test_utm_position_is_told_as_px4_fills_it() -> None:
    """px4_1_14_flight.tlog: state 1, flags 109, height 0 on the ground; then 3, 125."""
    bench = Bench("px4")
    told = asked_at_1_hz(bench, m.UtmGlobalPosition)
    assert (told.flight_state, told.flags, told.relative_alt) == (1, 109, 0)
    bench.vehicle.landed = Landed.IN_AIR
    told = asked_at_1_hz(bench, m.UtmGlobalPosition)
    assert (told.flight_state, told.flags, told.relative_alt) == (3, 125, 5000)


def test_remote_identification_is_told_as_px4_fills_it() -> None:
    """px4_1_14_flight.tlog: timestamp 65535, status 1 and 2, accuracies 12, 5, 1, 3; area -1000."""
    bench = Bench("px4")
    told = asked_at_1_hz(bench, m.OpenDroneIdLocation)
    assert (told.latitude, told.longitude) == (473978000, 85459000)
    assert (told.altitude_geodetic, told.height, told.timestamp) == (493.0, 5.0, 65535.0)
    assert (told.direction, told.speed_horizontal, told.speed_vertical) == (0, 100, 0)
    assert (told.status, told.height_reference, told.timestamp_accuracy) == (1, 0, 0)
    accuracies = (told.horizontal_accuracy, told.vertical_accuracy, told.barometer_accuracy)
    assert (*accuracies, told.speed_accuracy) == (12, 5, 1, 3)
    bench.vehicle.landed = Landed.IN_AIR
    told = asked_at_1_hz(bench, m.OpenDroneIdLocation)
    assert told.status == 2
    operator = asked_at_1_hz(bench, m.OpenDroneIdSystem)
    assert (operator.operator_latitude, operator.operator_longitude) == (473977420, 85455940)
    assert (operator.area_ceiling, operator.area_floor, operator.area_count) == (
        -1000.0,
        -1000.0,
        1,
    )
    assert operator.operator_altitude_geo == 488.0
