"""Scripts that only a vehicle of the px4 personality can fly."""

from __future__ import annotations

from math import cos, hypot, inf, radians, sin

from tests.unit.autopilot.flight import item
from tests.unit.autopilot.hand_flight import HandFlight
from tests.unit.failsafes.ground import box
from tests.unit.parameters import scripts as fly
from tests.unit.parameters.probing import (
    UP_M,
    Act,
    Script,
    Setting,
    where,
)
from vehicle_sim.autopilot.failsafes.failsafe import RANK, charge_of
from vehicle_sim.autopilot.failsafes.failure_detector import Posture, Px4FailureDetector
from vehicle_sim.autopilot.fence.geofence import Geofence
from vehicle_sim.autopilot.fence.rally import Point, landing_site
from vehicle_sim.autopilot.interface import CommandSent, OrbitRequest, Power, Result, Setpoint
from vehicle_sim.autopilot.manual.sticks import Radio
from vehicle_sim.plant.faults import GpsLost
from vehicle_sim.wire import messages as m

S = 1_000_000_000


def charge(remaining: float) -> Script:
    return lambda setting: (
        charge_of(setting.parameters(), Power(14.0, 5.0, 0.0, 50), remaining).name
    )


def drained(left: float) -> Act:
    def act(flight: HandFlight) -> None:
        flight.vehicle.blocks.body.consumed_mah = (1.0 - left) * 5000.0

    return act


def percent_left(setting: Setting) -> int:
    flight = setting.at_home()
    flight.vehicle.blocks.body.consumed_mah = 1000.0
    flight.fly(0.2)
    return flight.vehicle.power.remaining_pct


def climbs_1_m_s_after_s(setting: Setting) -> float:
    """From leaving the ground."""
    flight = setting.at_home()
    flight.vehicle.arm(False)
    flight.vehicle.take_off(15.0)
    flight.fly(5.0, lambda: flight.vehicle.blocks.flight.flying)
    return flight.fly(10.0, lambda: flight.vehicle.truth.v_ned[2] < -1.0)


def percent_after_10_s(setting: Setting) -> int:
    """Armed on the ground, by the simulated battery where it is switched on."""
    flight = setting.at_home()
    flight.vehicle.arm(False)
    flight.fly(9.9)
    return flight.vehicle.power.remaining_pct


_LEVEL = Posture(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, (0.5,) * 4, (0.5,) * 4)


def upset_after_s(posture: Posture) -> Script:
    """How long after the start of an upset something is said; infinite = nothing."""

    def script(setting: Setting) -> object:
        upsets = Px4FailureDetector(setting.parameters())
        upsets.check(_LEVEL, True, False, 0)
        start = 10 * S
        for tick in range(150):
            if upsets.check(posture, True, False, start + tick * S // 50):
                return tick / 50
        return inf

    return script


def upset_action(posture: Posture) -> Script:
    def script(setting: Setting) -> object:
        upsets = Px4FailureDetector(setting.parameters())
        upsets.check(_LEVEL, True, False, 0)
        struck = [*upsets.check(posture, True, False, 10 * S)]
        struck += upsets.check(posture, True, False, 12 * S)
        return max(struck, key=lambda each: RANK[each.action]).action.value

    return script


def tilted(roll_deg: float = 0.0, pitch_deg: float = 0.0) -> Posture:
    return Posture(
        radians(roll_deg), radians(pitch_deg), 1.0, 0.0, 0.0, 0.0, (0.5,) * 4, (0.5,) * 4
    )


DEAD_MOTOR = Posture(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, (0.4,) * 4, (0.4, 0.4, 0.0, 0.4))


def offboard_then_silent(flight: HandFlight) -> None:
    setpoint = Setpoint(pos_ned=(0.0, 0.0, -UP_M))
    flight.stream(setpoint, 1.2)
    flight.vehicle.set_mode_kind("guided")
    flight.stream(setpoint, 0.5)
    assert flight.vehicle.mode_name == "OFFBOARD"


def sticks_then_silent(mode: str) -> Act:
    def act(flight: HandFlight) -> None:
        flight.hold(0.3)
        flight.mode(mode)
        flight.hold(0.3)

    return act


def position_lost_by_hand(flight: HandFlight) -> None:
    flight.hold(0.3)
    flight.mode("POSCTL")
    flight.vehicle.inject(GpsLost())
    for _ in range(70):
        flight.hold(0.1)
        if flight.vehicle.mode_name != "POSCTL":
            return


def stick_moved(flight: HandFlight) -> None:
    flight.hold(0.3, right=400)


def corner(flight: HandFlight) -> None:
    flight.mode("POSCTL")
    flight.hold(1.5, up=0, clockwise=1000)


def armed_by_gesture(setting: Setting) -> bool:
    flight = setting.at_home()
    corner(flight)
    return flight.vehicle.armed


def radio(**channels: int) -> Script:
    """The sticks that overridden channels are, in percent."""

    def script(setting: Setting) -> object:
        receiver = Radio(setting.parameters())
        receiver.override((1900, 1100, 1300, 1700, 1500, 1500, 1500, 1500, *(0,) * 10), 0)
        now = receiver.sticks(0)
        return None if now is None else round(100.0 * float(getattr(now, next(iter(channels)))))

    return script


def joystick_counts(setting: Setting) -> bool:
    receiver = Radio(setting.parameters())
    receiver.joystick(0, 0, 500, 0, 0)
    return receiver.sticks(0) is not None


def fence_kinds(up_m: float, north_m: float, stop_m: float | None = None) -> Script:
    def script(setting: Setting) -> object:
        fence = Geofence(setting.parameters())
        stop = (stop_m if stop_m is not None else north_m, 0.0, -up_m)
        crossing = fence.check((north_m, 0.0, -up_m), stop, (0.0, 0.0, 0.0), False, S)
        return crossing.breached.value

    return script


def leaves_fence(flight: HandFlight) -> None:
    items = box("px4", 20.0)
    assert flight.vehicle.check_fence(items) is None
    flight.vehicle.load_fence(items)
    flight.stream(Setpoint(v_ned=(4.0, 0.0, 0.0)), 1.2)
    flight.vehicle.set_mode_kind("guided")
    flight.stream(Setpoint(v_ned=(4.0, 0.0, 0.0)), 7.0)


def returns_to(setting: Setting) -> float:
    """How far north of home a return from between home and a rally point ends."""
    points = (Point(30.0, 0.0, 0.0, True),)
    found = landing_site(
        points, (5.0, 0.0, -9.0), (0.0, 0.0, 0.0), 488.0, setting.parameters(), lambda n, e: True
    )
    return found.ground_ned[0]


def leader_walks(flight: HandFlight, seconds: float, speed_m_s: float = 3.0) -> None:
    """North from 20 m north of home, at 2 m above it."""
    vehicle = flight.vehicle
    for tick in range(round(seconds * 10)):
        place = (20.0 + speed_m_s * 0.1 * tick, 0.0, -2.0)
        there = vehicle.state.datum().projection.to_geodetic(place)
        vehicle.hear_leader(0, there, (speed_m_s, 0.0, 0.0), None, vehicle.time_ns)
        flight.fly(0.1)


def beside_leader(axis: int, seconds: float = 25.0) -> Script:
    """Where the follower is from its leader at the end, by axis north, east, up of home."""

    def script(setting: Setting) -> object:
        flight = setting.aloft()
        flight.vehicle.set_mode_kind("follow")
        leader_walks(flight, seconds)
        here = where(flight)
        lead_n = 20.0 + 3.0 * 0.1 * (round(seconds * 10) - 1)
        return (here[0] - lead_n, here[1], -here[2])[axis]

    return script


def feeds_forward_m_s(setting: Setting) -> float:
    """How much of its leader's 3 m/s it has taken up after half a second."""
    flight = setting.aloft()
    flight.vehicle.set_mode_kind("follow")
    leader_walks(flight, 0.5)
    return flight.vehicle.blocks.flight.goal_vel_n


def goes_round_m(setting: Setting) -> float:
    """How far it has come to the side in 3 s, on its way round a leader that stands."""
    flight = setting.aloft()
    flight.vehicle.set_mode_kind("follow")
    leader_walks(flight, 12.0)
    flight.vehicle.parameters.set("FLW_TGT_FA", 0.0)
    most = 0.0
    for _ in range(30):
        leader_walks(flight, 0.1, 0.0)
        most = max(most, abs(where(flight)[1]))
    return most


def home_hash(setting: Setting) -> bool:
    made = fly.bench(setting)
    heard = made.send(m.ParamRequestList(1, 1))
    return any(
        isinstance(each, m.ParamValue) and each.param_id.startswith(b"_HASH") for each in heard
    )


def orbit_result(setting: Setting) -> Result:
    flight = setting.aloft()
    return flight.vehicle.orbit(OrbitRequest(50.0, 3.0, 0, (0.0, 0.0), -UP_M))


def orbit_shrinks_m(setting: Setting) -> float:
    flight = setting.aloft()
    flight.vehicle.orbit(OrbitRequest(30.0, 3.0, 0, (0.0, 0.0), -UP_M))
    flight.fly(1.0)
    flight.hold(2.0, forward=1000)
    told = flight.vehicle.orbiting
    return 0.0 if told is None else abs(told.radius_m)


def mission_result(setting: Setting) -> Result:
    flight = setting.aloft()
    flight.vehicle.load_plan((item(0, 16, 200.0, 0.0, UP_M),))
    return flight.vehicle.set_mode_kind("mission")


def payload_s(setting: Setting) -> float:
    """How long a mission waits at DO_GRIPPER."""
    flight = setting.aloft()
    vehicle = flight.vehicle
    vehicle.load_plan((item(0, 211, frame=2, p1=1), item(1, 17, 5.0, 0.0, UP_M)))
    vehicle.set_mode_kind("mission")
    return fly.waits(flight, lambda _: None, lambda f: f.vehicle.mission_current == 1, 8.0)


def nose_homewards(setting: Setting) -> float:
    """How much the nose points home on the way north-east: 1 = there, -1 = away from it."""
    flight = setting.aloft()
    fly.goes_to(30.0)(flight)
    flight.fly(12.0)
    fly.flies_plan(flight, (30.0, 60.0))
    flight.fly(11.0)
    north, east, _ = where(flight)
    heading = flight.vehicle.estimate.heading_rad
    return (cos(heading) * -north + sin(heading) * -east) / hypot(north, east)


def after_take_off(setting: Setting) -> str:
    flight = setting.at_home()
    flight.vehicle.load_plan((item(0, 16, 50.0, 0.0, 5.0),))
    flight.vehicle.arm(False)
    flight.vehicle.take_off(3.0)
    flight.fly(8.0)
    return flight.vehicle.mode_name


def lost_position_s(setting: Setting) -> float:
    return fly.waits(
        setting.aloft(), fly.strike(GpsLost()), lambda f: not f.vehicle.health.position_ok
    )


def injects(setting: Setting) -> int:
    """INJECT_FAILURE's result for a lost GPS."""
    flight = setting.at_home()
    return int(flight.vehicle.takes_failures)


def gyro_off(flight: HandFlight) -> None:
    flight.vehicle.blocks.est.gyro_bias_x = 0.2


def no_fix(flight: HandFlight) -> None:
    flight.mode("STABILIZED")
    flight.vehicle.inject(GpsLost())
    flight.fly(0.5)


def lags_m(setting: Setting) -> float:
    """How far ahead the reference comes of a vehicle that a storm holds back."""
    flight = setting.aloft()
    flight.vehicle.blocks.body.wind_n = -9.0
    fly.goes_to(100.0)(flight)
    flight.fly(10.0)
    return flight.vehicle.blocks.flight.ref_n - where(flight)[0]


def satellites(setting: Setting) -> tuple[int, int]:
    flight = setting.at_home()
    flight.fly(1.0)
    gps = flight.vehicle.readings.gps
    return (gps.fix_type, gps.satellites)


def field_gauss(axis: int) -> Script:
    def script(setting: Setting) -> object:
        flight = setting.at_home()
        flight.fly(0.5)
        return flight.vehicle.readings.mag_frd[axis]

    return script


def baro_off_m(setting: Setting) -> float:
    flight = setting.at_home()
    flight.fly(0.5)
    return flight.vehicle.readings.pressure_alt_amsl_m - 488.0


def arms(setting: Setting) -> object:
    """What an `arm` is answered at once."""
    return setting.at_home().vehicle.arm(False)


def authorizer(setting: Setting) -> object:
    """Which system is asked whether the vehicle may arm."""
    flight = setting.at_home()
    flight.vehicle.arm(False)
    return next(e.system for e in flight.vehicle.events() if isinstance(e, CommandSent))


def waits_for_authorizer_s(setting: Setting) -> object:
    flight = setting.at_home()
    return fly.waits(flight, lambda f: f.vehicle.arm(False), fly.says("Arm auth: No response"))
