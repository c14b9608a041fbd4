"""Sticks, leaders, circles and regions of interest over the wire; what is told of them."""

from __future__ import annotations

import math

import pytest

from tests.unit.vehicle_services.fake_vehicle import HOME, NUMBERS, Bench, Kind, S, acks, long, of
from vehicle_sim.autopilot.interface import AttitudeGoal, Geodetic, Orbiting, OrbitRequest, Result
from vehicle_sim.autopilot.modes import MODES, Personality, Property
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Cmd, MavFrame

NAN = math.nan
either = pytest.mark.parametrize("personality", ["px4", "ardupilot"])


def override(*channels: int, target: int = 1) -> m.RcChannelsOverride:
    return m.RcChannelsOverride._make((*channels, target, 1, *[0] * 10))


@either
def test_manual_control_reaches_the_vehicle_as_it_came(personality: Personality) -> None:
    bench = Bench(personality)
    bench.send(m.ManualControl(x=100, y=-200, z=600, r=50, buttons=3, target=1))
    ((*axes, _),) = bench.vehicle.named("joystick")
    assert axes == [100, -200, 600, 50]


@either
def test_sticks_for_another_vehicle_are_not_ours(personality: Personality) -> None:
    bench = Bench(personality)
    bench.send(m.ManualControl(x=100, y=0, z=500, r=0, buttons=0, target=2))
    bench.send(override(*[1500] * 8, target=2))
    assert bench.vehicle.calls == []


def test_ardupilot_takes_sticks_only_from_its_station_and_px4_from_anyone() -> None:
    """SYSID_MYGCS is 255."""
    sticks = m.ManualControl(x=0, y=0, z=500, r=0, buttons=0, target=1)
    px4, ardupilot = Bench("px4"), Bench("ardupilot")
    for bench in (px4, ardupilot):
        bench.send(sticks, system=245)
        bench.send(sticks, system=255)
    assert len(px4.vehicle.named("joystick")) == 2
    assert len(ardupilot.vehicle.named("joystick")) == 1


def test_the_override_carries_eighteen_channels_in_order() -> None:
    bench = Bench("ardupilot")
    asked = override(1100, 1200, 1300, 1400, 1500, 1600, 1700, 0)._replace(chan9_raw=1900)
    bench.send(asked, system=255)
    ((channels_us, _),) = bench.vehicle.named("override_channels")
    assert channels_us == (1100, 1200, 1300, 1400, 1500, 1600, 1700, 0, 1900, *[0] * 9)


def follow_target(capabilities: int, lat: int = 473977420) -> m.FollowTarget:
    speed = (1.0, 2.0, NAN)
    still = (0.0, 0.0, 0.0)
    return m.FollowTarget(
        0, 0, lat, 85455940, 490.0, speed, still, (1.0, 0.0, 0.0, 0.0), still, still, capabilities
    )


def test_a_follow_target_is_a_leader_with_what_it_knows() -> None:
    bench = Bench()
    bench.send(follow_target(0b11))
    bench.send(follow_target(0b01))
    bench.send(follow_target(0b10))
    bench.send(follow_target(0b11, lat=1_000_000_000))
    first, second = bench.vehicle.named("hear_leader")
    assert first[2] == (1.0, 2.0, 0.0)
    assert second[2] == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(("alt_type", "alt_m"), [(0, 490.0), (1, HOME.alt_amsl_m + 2.0)])
def test_another_vehicles_position_is_a_leader_and_our_own_is_not(
    alt_type: int, alt_m: float
) -> None:
    """FOLL_ALT_TYPE: its height above sea, or above its home."""
    bench = Bench("ardupilot")
    bench.parameters.set("FOLL_ALT_TYPE", alt_type)
    where = m.GlobalPositionInt(0, 473977420, 85455940, 490_000, 2_000, 150, -50, 0, 9000)
    bench.send(where, system=42)
    bench.send(where, system=1)
    ((system, geodetic, v_ned, heading_rad, _),) = bench.vehicle.named("hear_leader")
    assert system == 42
    assert isinstance(geodetic, Geodetic)
    assert geodetic.alt_amsl_m == alt_m
    assert v_ned == (1.5, -0.5, 0.0)
    assert heading_rad == pytest.approx(0.5 * math.pi)


@pytest.mark.parametrize("frame", [MavFrame.GLOBAL, MavFrame.GLOBAL_RELATIVE_ALT])
def test_an_orbit_by_command_int_has_its_height_above_sea_whatever_the_frame(frame: int) -> None:
    """Clients leave the frame at its default, relative, and send AMSL: PX4 takes it so."""
    bench = Bench()
    alt_m = HOME.alt_amsl_m + 12.0
    asked = m.CommandInt(
        -15.0, 4.0, 2.0, NAN, 473977420, 85455940, alt_m, Cmd.DO_ORBIT, 1, 1, frame, 0, 0
    )
    assert acks(bench.send(asked)) == [(Cmd.DO_ORBIT, Result.ACCEPTED)]
    ((request,),) = bench.vehicle.named("orbit")
    assert isinstance(request, OrbitRequest)
    assert (request.radius_m, request.speed_m_s, request.nose) == (-15.0, 4.0, 2)
    assert request.centre_ne == pytest.approx((0.0, 0.0), abs=0.01)
    assert request.down_m == pytest.approx(-12.0, abs=0.01)


def test_an_orbit_by_command_long_keeps_what_is_nan() -> None:
    bench = Bench()
    bench.send(long(Cmd.DO_ORBIT, NAN, NAN, NAN, NAN, NAN, NAN, NAN))
    assert bench.vehicle.named("orbit") == [(OrbitRequest(None, None, None, None, None),)]


@pytest.mark.parametrize(
    ("personality", "command"),
    [
        ("ardupilot", Cmd.DO_ORBIT),
        ("px4", Cmd.NAV_LOITER_UNLIM),
        *(("px4", c) for c in (209, 183, 1001, 500, 42424, 115, 193, 224)),
        *(("ardupilot", c) for c in (187, 310, 1001, 2510, 500, 186, 242, 243)),
        *((p, c) for p in ("px4", "ardupilot") for c in (43000, 43001, 43002)),
    ],
)
def test_what_it_cannot_do_is_unsupported(personality: Personality, command: int) -> None:
    """As recorded (D3, commands_*.json); slewed guided commands are a plane's."""
    bench = Bench(personality)
    assert acks(bench.send(long(command, 0, 0, 0, 0, 0, 0, 0))) == [(command, Result.UNSUPPORTED)]
    assert bench.vehicle.calls == []


@either
def test_regions_of_interest(personality: Personality) -> None:
    bench = Bench(personality)
    place = (47.3977420, 8.5455940, 488.0)
    for asked in (
        long(Cmd.DO_SET_ROI_LOCATION, 0, 0, 0, 0, *place),
        long(Cmd.DO_SET_ROI, 3, 0, 0, 0, *place),
        long(Cmd.DO_SET_ROI_NONE),
    ):
        assert acks(bench.send(asked)) == [(asked.command, Result.ACCEPTED)]
    first, second, last = bench.vehicle.named("look_at")
    # Degrees as float32 are metres apart.
    assert first[0] == second[0] == pytest.approx((0.0, 0.0, 0.0), abs=1.0)
    assert last == (None,)


def test_ardupilot_loiters_where_it_is_told_to() -> None:
    bench = Bench("ardupilot")
    assert acks(bench.send(long(Cmd.NAV_LOITER_UNLIM))) == [(17, Result.ACCEPTED)]
    assert bench.vehicle.named("set_mode_kind") == [("hold",)]


def test_parameters_are_stored_and_reset_when_asked() -> None:
    bench = Bench()
    assert acks(bench.send(long(Cmd.PREFLIGHT_STORAGE, 1))) == [(245, Result.ACCEPTED)]
    assert acks(bench.send(long(Cmd.PREFLIGHT_STORAGE, 2))) == [(245, Result.ACCEPTED)]
    assert bench.vehicle.named("reset_parameters") == [()]
    assert acks(bench.send(long(Cmd.PREFLIGHT_STORAGE, 5))) == [(245, Result.DENIED)]
    bench.vehicle.armed = True
    refused = bench.send(long(Cmd.PREFLIGHT_STORAGE, 0))
    assert acks(refused) == [(245, Result.TEMPORARILY_REJECTED)]


# ------------------------------------------------------------------------------- being told


def asked_for(bench: Bench, kind: type[Kind]) -> list[Kind]:
    return of(bench.send(long(Cmd.REQUEST_MESSAGE, NUMBERS[kind])), kind)


def test_an_orbit_is_told_while_it_is_flown() -> None:
    bench = Bench()
    assert asked_for(bench, m.OrbitExecutionStatus) == []
    bench.vehicle.orbiting = Orbiting((0.0, 0.0, -10.0), -7.5)
    heard = bench.advance(S)
    told = of(heard, m.OrbitExecutionStatus)
    assert len(told) >= 4
    assert told[-1].radius == -7.5
    assert (told[-1].x, told[-1].y) == pytest.approx((473977420, 85455940), abs=2)
    assert told[-1].z == pytest.approx(HOME.alt_amsl_m + 10.0)


@either
def test_radio_channels_are_told(personality: Personality) -> None:
    bench = Bench(personality)
    silent = asked_for(bench, m.RcChannels)
    bench.vehicle.channels_us = (1500, 0, 1700, *[0] * 15)
    (told,) = asked_for(bench, m.RcChannels)
    assert (told.chan1_raw, told.chan3_raw, told.chancount) == (1500, 1700, 3)
    # PX4 is silent without a radio and marks an unused channel; ArduPilot tells of nothing.
    if personality == "px4":
        assert silent == []
        assert told.chan2_raw == 65535
    else:
        (nothing,) = silent
        assert nothing.chancount == told.chan2_raw == 0


def test_px4_tells_the_sticks_that_it_flies_by() -> None:
    bench = Bench()
    assert asked_for(bench, m.ManualControl) == []
    bench.vehicle.sticks = (0.1, -0.2, 0.3, 0.5)
    (told,) = asked_for(bench, m.ManualControl)
    assert (told.x, told.y, told.z, told.r) == (-200, 100, 500, 300)


def test_the_target_is_told_as_a_place_on_earth() -> None:
    bench = Bench()
    assert asked_for(bench, m.PositionTargetGlobalInt) == []
    bench.vehicle.armed = True
    (told,) = asked_for(bench, m.PositionTargetGlobalInt)
    assert (told.lat_int, told.lon_int) == pytest.approx((473977420, 85455940), abs=2)
    assert told.alt == pytest.approx(HOME.alt_amsl_m + 2.0)


def test_the_attitude_target_is_told_in_flight() -> None:
    bench = Bench("ardupilot")
    assert asked_for(bench, m.AttitudeTarget) == []
    bench.vehicle.attitude_goal = AttitudeGoal((1.0, 0.0, 0.0, 0.0), (0.1, 0.2, 0.3), 0.45)
    (told,) = asked_for(bench, m.AttitudeTarget)
    assert told.q == (1.0, 0.0, 0.0, 0.0)
    assert told.thrust == pytest.approx(0.45)


def test_modes_are_told_with_their_properties() -> None:
    """PX4 1.14 does not have the message (commands_px4.json: 435 DENIED)."""
    personality: Personality = "ardupilot"
    heard = Bench(personality).send(long(Cmd.REQUEST_MESSAGE, 435, 0))
    told = {each.custom_mode: each for each in heard if isinstance(each, m.AvailableModes)}
    for mode in MODES[personality].values():
        assert told[mode.custom_mode].properties == mode.properties
        assert told[mode.custom_mode].mode_name.rstrip(b"\0").decode() == mode.name
    advanced = [mode.name for mode in MODES[personality].values() if mode.properties]
    assert "ACRO" in advanced
    hidden = MODES["px4"]["POSCTL.ORBIT"].properties
    assert hidden is Property.NOT_USER_SELECTABLE
