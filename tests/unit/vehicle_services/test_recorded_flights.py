"""What the real autopilots were recorded to do with commands over time, as short flights.

Each test names the scenario (scenarios_px4.json, scenarios_arducopter.json) that it follows.
"""

from __future__ import annotations

from math import hypot, nan

import pytest

from tests.unit.vehicle_services.fake_vehicle import MS, S, acks, long, of
from tests.unit.vehicle_services.flown_vehicle import (
    HOME,
    Flown,
    in_the_air,
    on_the_ground,
    take_off,
)
from vehicle_sim.autopilot.interface import Landed, PlanItem, Result
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.services.stream_sets import POSITION_ONLY
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.ids import Cmd

pytestmark = pytest.mark.slow  # a vehicle flies

ARM, DISARM = long(Cmd.COMPONENT_ARM_DISARM, 1), long(Cmd.COMPONENT_ARM_DISARM, 0)
E7_PER_M = 90.0  # of latitude


def reposition(
    flag: int, north_m: float = 15.0, up_m: float = 8.0, speed: float = -1.0
) -> m.CommandInt:
    x, y = round(HOME.lat_deg * 1e7 + north_m * E7_PER_M), round(HOME.lon_deg * 1e7)
    return m.CommandInt(speed, flag, 0.0, nan, x, y, up_m, Cmd.DO_REPOSITION, 1, 1, 6, 0, 0)


def item(seq: int, command: int, *params: float, x: int = 0, y: int = 0, z: float = 0) -> PlanItem:
    p1, p2, p3, p4 = (*params, *(0.0,) * (4 - len(params)))
    return PlanItem(seq, 3, command, p1, p2, p3, p4, x, y, z, 1)


HOME_ITEM = item(0, 16)


def beat(bench: Flown, seconds: float, systems: tuple[int, ...] = (255,)) -> list[m.Message]:
    """Time passes with heartbeats of these stations."""
    heard: list[m.Message] = []
    for _ in range(round(seconds)):
        for system in systems:
            heard += bench.send(m.Heartbeat(0, 6, 8, 0, 4, 3), system=system)
        heard += bench.advance(S)
    return heard


def fastest(bench: Flown, seconds: float, climb: bool = False) -> float:
    """Highest speed over ground, or of climb, within that time [m/s]."""
    most = 0.0
    for _ in range(round(seconds * 5)):
        bench.advance(S // 5)
        n, e, d = bench.autopilot.truth.v_ned
        most = max(most, -d if climb else hypot(n, e))
    return most


# ---------------------------------------------------- A take-off and reposition (clients.md 5)


def test_px4_flies_to_a_place_given_before_it_has_left_the_ground() -> None:
    """A1: take-off, 1 s, HOLD, DO_REPOSITION: ACCEPTED, and it flies there."""
    bench = on_the_ground("px4")
    take_off(bench)
    bench.advance(S)
    assert bench.result(long(176, 1, 4, 3), 0) == Result.ACCEPTED
    assert bench.result(reposition(1), 0) == Result.ACCEPTED
    bench.advance(15 * S)
    north, _, down = bench.autopilot.truth.pos_ned
    assert north == pytest.approx(15.0, abs=1.5)
    assert -down == pytest.approx(8.0, abs=1.0)
    assert bench.mode_name == "AUTO.LOITER"


def test_px4_still_takes_off_when_hold_comes_while_it_stands() -> None:
    """A5: HOLD 1 s after NAV_TAKEOFF: up to the take-off height, in AUTO.LOITER."""
    bench = on_the_ground("px4")
    take_off(bench)
    bench.advance(S)
    bench.mode("AUTO.LOITER")
    bench.advance(12 * S)
    assert -bench.autopilot.truth.pos_ned[2] == pytest.approx(5.0, abs=0.8)
    assert bench.mode_name == "AUTO.LOITER"


def test_px4_stands_after_arming_in_hold_alone_and_disarms() -> None:
    """A6: "Disarmed by auto preflight disarming" 10 s after arming; nothing is left of a place
    of an earlier flight."""
    bench = on_the_ground("px4")
    assert bench.result(reposition(1), 0) == Result.ACCEPTED
    assert bench.result(ARM, 0) == Result.ACCEPTED
    assert bench.result(DISARM, 0) == Result.ACCEPTED
    bench.advance(5 * S)
    assert bench.result(ARM, 0) == Result.ACCEPTED
    heard = bench.advance(9_500 * MS)
    assert bench.autopilot.armed
    heard += bench.advance(1_000 * MS)
    assert "Disarmed by auto preflight disarming\t" in bench.texts(heard)
    assert bench.autopilot.landed is Landed.ON_GROUND


# ------------------------------------------------------------ B sticks lost (clients.md 6)


def test_px4_goes_on_taking_off_when_the_sticks_are_lost_just_then() -> None:
    """B1: hold, for COM_FAIL_ACT_T; then it returns.  Never disarmed in between."""
    bench = on_the_ground("px4")
    stick = m.ManualControl(0, 0, 500, 0, 0, 1)
    for _ in range(20):
        bench.send(stick)
        bench.advance(50 * MS)
    take_off(bench)
    for _ in range(12):
        bench.send(stick)
        bench.advance(50 * MS)
    heard = bench.advance(1_500 * MS)
    assert bench.autopilot.armed
    assert bench.mode_name == "AUTO.LOITER"
    heard += bench.advance(3 * S)
    assert bench.autopilot.armed
    assert bench.autopilot.landed is Landed.IN_AIR
    bench.advance(3 * S)
    assert bench.mode_name == "AUTO.RTL"


# ------------------------------------------- C missions (clients.md 7, 8, 9)


@pytest.mark.parametrize("command", [16, 18, 82])
def test_ardupilot_takes_an_item_at_zero_for_here(command: int) -> None:
    """C1: WAYPOINT, LOITER_TURNS, SPLINE at 0/0; PX4 has refused them before."""
    plan = (HOME_ITEM, item(1, 22, z=5), item(2, command, 1.0, z=0))
    assert on_the_ground("ardupilot").autopilot.check_plan(plan) is None


def test_ardupilot_flies_a_waypoint_at_zero_where_it_is() -> None:
    """C1: 0/0 with altitude 0 is the present place and height."""
    bench = in_the_air("ardupilot")
    bench.autopilot.load_plan((HOME_ITEM, item(1, 22, z=5), item(2, 16, 2.0), item(3, 16, 2.0)))
    bench.autopilot.mission_set_current(2)
    bench.mode("AUTO")
    bench.advance(8 * S)
    north, east, down = bench.autopilot.truth.pos_ned
    assert hypot(north, east) < 1.0
    assert -down == pytest.approx(5.0, abs=0.7)


def test_ardupilot_waits_and_sets_its_speed_before_the_take_off() -> None:
    """C2: DO_CHANGE_SPEED 3, NAV_DELAY 5 s, TAKEOFF: 5 s armed on the ground, then up."""
    bench = on_the_ground("ardupilot")
    speed, delay = item(1, 178, 1, 3, -1), item(2, 93, 5, -1, -1, -1)
    far = item(4, 16, x=round(HOME.lat_deg * 1e7 + 60 * E7_PER_M), y=round(HOME.lon_deg * 1e7), z=8)
    bench.autopilot.load_plan((HOME_ITEM, speed, delay, item(3, 22, z=8), far))
    bench.mode("GUIDED")
    assert bench.result(ARM, 0) == Result.ACCEPTED
    assert bench.result(long(300), 0) == Result.ACCEPTED
    heard = bench.advance(4_900 * MS)
    assert bench.autopilot.landed is Landed.ON_GROUND
    heard += bench.advance(15 * S)
    reached = [each.seq for each in of(heard, m.MissionItemReached)]
    assert reached == [2, 3]
    assert fastest(bench, 6) == pytest.approx(3.0, abs=0.3)


def test_ardupilot_without_a_mission_starts_none_when_armed() -> None:
    """C4: disarmed ACCEPTED without a word; armed FAILED.

    Its finding: in AUTO without a mission "PreArm: Mode requires mission", with the other checks.
    """
    bench = on_the_ground("ardupilot")
    bench.parameters.set("AUTO_OPTIONS", 3)
    heard = bench.send(long(300)) + bench.advance(S)
    assert acks(heard) == [(300, Result.ACCEPTED)]
    assert bench.texts(heard) == []
    assert "PreArm: Mode requires mission" in bench.texts(bench.advance(35 * S))
    heard = bench.send(ARM) + bench.advance(S // 10)
    assert acks(heard) == [(400, Result.FAILED)]
    assert bench.texts(heard) == ["Arm: Mode requires mission"]


# ------------------------------------------------ what ArduCopter tells, D3, J2, K1, C1


def test_a_compass_calibrated_by_its_yaw_needs_a_reboot_to_arm() -> None:
    """D3: after FIXED_MAG_CAL_YAW "PreArm: Compass calibrated requires reboot"."""
    bench = on_the_ground("ardupilot")
    assert bench.result(long(Cmd.FIXED_MAG_CAL_YAW, 84), 0) == Result.ACCEPTED
    heard = bench.send(long(Cmd.RUN_PREARM_CHECKS)) + bench.advance(MS * 100)
    assert bench.texts(heard) == ["PreArm: Compass calibrated requires reboot"]
    bench.mode("GUIDED")
    assert bench.result(ARM) == Result.FAILED
    bench.autopilot.reboot()
    bench.advance(2 * S)
    bench.mode("GUIDED")
    assert bench.result(ARM) == Result.ACCEPTED


def test_px4_arms_after_a_quick_calibration_of_the_compass() -> None:
    bench = on_the_ground("px4")
    assert bench.result(long(Cmd.FIXED_MAG_CAL_YAW, 84)) == Result.ACCEPTED
    assert bench.result(ARM) == Result.ACCEPTED


def test_ardupilot_does_not_arm_while_a_log_is_downloaded() -> None:
    """J2: "PreArm: Downloading logs" while LOG_DATA comes."""
    bench = on_the_ground("ardupilot")
    bench.mode("GUIDED")
    bench.autopilot.log_download(True)
    heard = bench.send(ARM) + bench.advance(S // 10)
    assert acks(heard) == [(400, Result.FAILED)]
    assert bench.texts(heard) == ["Arm: Downloading logs"]
    bench.autopilot.log_download(False)
    assert bench.result(ARM) == Result.ACCEPTED


def test_each_circle_of_a_mission_is_told_and_one_more() -> None:
    """C1: LOITER_TURNS of 1: "starting circle 1/1" on it, "2/1" when it is flown."""
    bench = in_the_air("ardupilot")
    circle = PlanItem(1, 3, 18, 1.0, 0.0, 4.0, 0.0, 0, 0, 5.0, 1)
    bench.autopilot.load_plan((HOME_ITEM, circle, item(2, 20)))
    assert bench.result(long(300), 0) == Result.ACCEPTED
    told = [text for text in bench.texts(bench.advance(60 * S)) if "circle" in text]
    assert told == ["Mission: starting circle 1/1", "Mission: starting circle 2/1"]


def test_px4_checks_before_arming_without_a_word_about_its_mode() -> None:
    """px4_1_14_flight.tlog, 64.75 s: RUN_PREARM_CHECKS in POSCTL.ORBIT on the ground, ACCEPTED, no
    STATUSTEXT follows."""
    bench = on_the_ground("px4")
    bench.result(long(Cmd.DO_ORBIT, 5, 1, 0, nan, nan, nan, nan))
    assert bench.mode_name == "POSCTL.ORBIT"
    heard = bench.send(long(Cmd.RUN_PREARM_CHECKS)) + bench.advance(2 * S)
    assert acks(heard) == [(Cmd.RUN_PREARM_CHECKS, Result.ACCEPTED)]
    assert bench.texts(heard) == []


# ------------------------------------------- H speed and termination (vehicle.md 2, 3, 5, 8)


def test_px4_takes_a_speed_of_any_type_for_the_horizontal_one() -> None:
    """H1b: type 2 (climb), 1 m/s: the horizontal cruise is 1.05 m/s."""
    bench = in_the_air("px4")
    assert bench.result(long(178, 2, 1, -1), 0) == Result.ACCEPTED
    bench.send(reposition(1, up_m=5.0))
    assert fastest(bench, 8) == pytest.approx(1.05, abs=0.25)


@pytest.mark.parametrize("value", [-1.0, -2.0, 0.0, nan])
def test_px4_restores_its_default_speed_for_what_is_no_speed(value: float) -> None:
    """H1b: -1, -2, 0 and NaN; on the ground they are ACCEPTED, too (H1)."""
    bench = in_the_air("px4")
    bench.autopilot.load_plan((item(0, 16, x=round(HOME.lat_deg * 1e7 + 8000),
                                    y=round(HOME.lon_deg * 1e7), z=5),))  # fmt: skip
    for kind in range(5):
        assert bench.result(long(178, kind, 1.0, -1), 0) == Result.ACCEPTED
    bench.mode("AUTO.MISSION")
    assert fastest(bench, 6) < 1.5
    assert bench.result(long(178, 1, value, -1), 0) == Result.ACCEPTED
    assert fastest(bench, 8) > 4.0
    assert on_the_ground("px4").result(long(178, 1, value, -1)) == Result.ACCEPTED


def test_px4s_reposition_without_a_speed_restores_the_default() -> None:
    """H1b: param1 2 gives 2.0 m/s, -1 the default again."""
    bench = in_the_air("px4")
    bench.send(reposition(1, north_m=30.0, up_m=5.0, speed=2.0))
    assert fastest(bench, 6) == pytest.approx(2.0, abs=0.3)
    bench.send(reposition(1, north_m=80.0, up_m=5.0))
    assert fastest(bench, 8) > 4.0


@pytest.mark.parametrize("value", [-1.0, -2.0, 0.0, -5.0])
def test_ardupilot_denies_a_speed_that_is_none_and_fails_any_on_the_ground(value: float) -> None:
    """H1."""
    assert in_the_air("ardupilot").result(long(178, 1, value)) == Result.DENIED
    assert in_the_air("ardupilot").result(long(178, 4, 3.0)) == Result.DENIED
    ground = on_the_ground("ardupilot")
    assert ground.result(long(178, 1, 3.0)) == Result.FAILED
    assert ground.result(ARM) == Result.ACCEPTED
    assert ground.result(long(178, 1, 3.0)) == Result.FAILED


def test_ardupilot_sets_the_climb_rate_by_type() -> None:
    """H1: climb 0.76 m/s after type 2 with 0.7; the horizontal speed is another."""
    bench = in_the_air("ardupilot")
    assert bench.result(long(178, 2, 0.7), 0) == Result.ACCEPTED
    bench.send(reposition(1, north_m=0.0, up_m=12.0))
    assert fastest(bench, 6, climb=True) == pytest.approx(0.7, abs=0.15)
    bench.send(reposition(1, north_m=40.0, up_m=12.0))
    assert fastest(bench, 8) > 3.0


def test_px4_ends_its_termination() -> None:
    """H3: disarmed, param1 1: TERMINATION, arming and forced arming TEMPORARILY_REJECTED; 0 ends
    it, and it arms."""
    bench = on_the_ground("px4")
    assert bench.result(long(185, 0), 0) == Result.ACCEPTED
    assert bench.result(long(185, 1), 0) == Result.ACCEPTED
    assert bench.autopilot.system_status == 8
    for force in (0, 21196):
        heard = bench.send(long(400, 1, force)) + bench.advance(S)
        assert acks(heard) == [(400, Result.TEMPORARILY_REJECTED)]
        assert "Preflight Fail: Flight termination active" in bench.texts(heard)
    assert bench.result(long(185, 0), 0) == Result.ACCEPTED
    assert bench.autopilot.system_status == 3
    assert bench.result(ARM) == Result.ACCEPTED


# ------------------------------------------------------------------------- F fence


@pytest.mark.parametrize("radius_m", [0.0, -5.0, nan])
def test_px4_takes_a_fence_circle_of_any_radius(radius_m: float) -> None:
    """F1 (clients.md 16): inside of one that is an inclusion there is nothing: not armable.
    ArduPilot refuses it ("Non-positive circle radius")."""
    circle = item(0, 5003, radius_m, x=473977420, y=85455940)
    bench = on_the_ground("px4")
    assert bench.autopilot.check_fence((circle,)) is None
    bench.autopilot.load_fence((circle,))
    bench.advance(S)
    assert bench.result(ARM) == Result.TEMPORARILY_REJECTED
    assert on_the_ground("ardupilot").autopilot.check_fence((circle,)) is not None


# ------------------------------------------------------------ heartbeats, texts, banner


@pytest.mark.parametrize(
    ("personality", "mode", "base_mode"),
    [("px4", "OFFBOARD", 17), ("px4", "POSCTL", 81), ("px4", "AUTO.LOITER", 29),
     ("ardupilot", "GUIDED", 89), ("ardupilot", "STABILIZE", 81), ("ardupilot", "LAND", 89),
     ("ardupilot", "RTL", 89), ("ardupilot", "LOITER", 89), ("ardupilot", "AUTO", 89)],
)  # fmt: skip
def test_base_mode_disarmed(personality: Personality, mode: str, base_mode: int) -> None:
    """behaviour.json and the HEARTBEATs of the scenarios; 128 more while armed."""
    bench = on_the_ground(personality)
    bench.mode(mode)
    assert bench.autopilot.base_mode == base_mode


def test_px4_says_what_it_does_with_a_tab() -> None:
    """behaviour.json rank 4; the standard flight L1."""
    bench = on_the_ground("px4")
    heard = bench.send(ARM)
    heard += bench.send(long(22, 0, 0, 0, nan, nan, nan, HOME.alt_amsl_m + 3)) + beat(bench, 9)
    heard += bench.send(long(21, 0, 0, 0, nan, nan, nan, nan)) + beat(bench, 20)
    assert bench.texts(heard) == [
        "Armed by external command\t",
        "Takeoff detected\t",
        "Landing at current position\t",
        "Landing detected\t",
        "Disarmed by landing\t",
    ]


def test_ardupilot_sends_its_banner_and_px4_does_not_know_the_command() -> None:
    """D3 (clients.md 21)."""
    heard = on_the_ground("ardupilot").send(long(Cmd.DO_SEND_BANNER))
    assert acks(heard) == [(Cmd.DO_SEND_BANNER, Result.ACCEPTED)]
    assert len(of(heard, m.Statustext)) == 3
    px4 = on_the_ground("px4").result(long(Cmd.DO_SEND_BANNER))
    assert px4 == Result.UNSUPPORTED


def test_ardupilot_sends_its_home_when_it_changes_or_is_asked_for() -> None:
    """clients.md 21: never unasked at a rate."""
    bench = on_the_ground("ardupilot")
    assert not of(bench.advance(5 * S), m.HomePosition)
    (home,) = of(bench.send(long(410)), m.HomePosition)
    assert all(part != part for part in home.q), "NaN, as the real one sends"


def test_px4_takes_what_has_no_place_in_no_frame_with_one() -> None:
    """behaviour.json rank 2, and seen of a PX4 1.14.3 with all commands below: frames 0, 3 and 6
    are refused with type 3; frame 2 is stored.  Of 201, DO_SET_ROI, it is the reverse."""
    placeless = (20, 93, 112, 114, 177, 178, 179, 189, 197, 203, 206, 211, 530, 1000, 2000, 2001)
    for command in (*placeless, 201):
        parameters = (1.0, 1.0, 0.0, 0.0) if command != 201 else (3.0, 0.0, 0.0, 0.0)
        for frame in (0, 3, 6, *((2,) if command != 201 else ())):
            item = PlanItem(0, frame, command, *parameters, 0, 0, 0, 1)
            stored = on_the_ground("px4").autopilot.check_plan((item,)) is None
            assert stored is ((frame == 2) is (command != 201)), (command, frame)
    for frame in (2, 3, 6):
        home = PlanItem(0, frame, 20, 0, 0, 0, 0, 0, 0, 0, 1)
        assert on_the_ground("ardupilot").autopilot.check_plan((HOME_ITEM, home)) is None


def test_ardupilots_vtol_state_is_a_multicopters() -> None:
    """behaviour.json rank 3: EXTENDED_SYS_STATE.vtol_state 3 (MC); PX4's is 0."""
    for personality, state in (("px4", 0), ("ardupilot", 3)):
        bench = on_the_ground(personality)  # type: ignore[arg-type]
        bench.send(long(511, 245, 200_000))
        told = of(bench.advance(S), m.ExtendedSysState)
        assert {each.vtol_state for each in told} == {state}


def test_a_fleets_sparse_streams_have_the_global_position() -> None:
    """clients.md 21: `--streams position`."""
    assert m.IDS[m.GlobalPositionInt] in POSITION_ONLY
