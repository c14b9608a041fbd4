"""Scripts that only a vehicle of the ardupilot personality can fly."""

from __future__ import annotations

from math import cos, degrees, hypot, inf, radians, sin

from tests.unit.autopilot.flight import item
from tests.unit.autopilot.hand_flight import HandFlight
from tests.unit.failsafes.ground import point
from tests.unit.parameters import scripts as fly
from tests.unit.parameters.probing import (
    Act,
    Script,
    Setting,
    flat_m_s,
    highest,
    where,
)
from tests.unit.vehicle_services.fake_vehicle import acks, long
from vehicle_sim.autopilot.failsafes.failsafe import charge_of
from vehicle_sim.autopilot.fence.geofence import Geofence
from vehicle_sim.autopilot.fence.rally import Point, landing_site
from vehicle_sim.autopilot.interface import Power, Result, Setpoint
from vehicle_sim.autopilot.manual.sticks import Radio
from vehicle_sim.autopilot.tasks.return_height import return_up_m
from vehicle_sim.plant.faults import BaroFault, GpsGlitch, GpsLost
from vehicle_sim.wire import messages as m

S = 1_000_000_000
HOME = (0.0, 0.0, 0.0)


def charge(voltage_v: float, consumed_mah: float) -> Script:
    return lambda setting: (
        charge_of(setting.parameters(), Power(voltage_v, 5.0, consumed_mah, 50), 0.5).name
    )


def drained(consumed_mah: float) -> Act:
    def act(flight: HandFlight) -> None:
        flight.vehicle.blocks.body.consumed_mah = consumed_mah

    return act


def percent_left(setting: Setting) -> int:
    flight = setting.at_home()
    flight.vehicle.blocks.body.consumed_mah = 1000.0
    flight.fly(0.2)
    return flight.vehicle.power.remaining_pct


def volts_told(setting: Setting) -> bool:
    return setting.at_home().vehicle.power.voltage_v > 0.0


def volts(setting: Setting) -> float:
    flight = setting.at_home()
    flight.fly(0.5)
    return flight.vehicle.power.voltage_v


def low_voltage(flight: HandFlight) -> None:
    flight.vehicle.parameters.set("BATT_LOW_VOLT", 20.0)


def sticks_then_silent(mode: str) -> Act:
    def act(flight: HandFlight) -> None:
        flight.hold(0.3)
        flight.mode(mode)
        flight.hold(0.3)

    return act


def station_silent_in(mode: str) -> Act:
    def act(flight: HandFlight) -> None:
        flight.mode(mode)
        fly.station_silent(flight)

    return act


def velocity_then_silent(flight: HandFlight) -> None:
    flight.stream(Setpoint(v_ned=(3.0, 0.0, 0.0)), 3.0)


def brakes(flight: HandFlight) -> bool:
    return flat_m_s(flight) < 2.5


def position_lost(flight: HandFlight) -> None:
    flight.vehicle.inject(GpsLost())


def glitches(flight: HandFlight) -> None:
    flight.vehicle.inject(GpsGlitch((9.0, 0.0, 0.0)))


def crashed(setting: Setting) -> bool:
    """Whether a vehicle that lies on its side is disarmed."""
    flight = setting.aloft()
    body = flight.vehicle.blocks.body
    body.health_1 = body.health_3 = 0.0
    flight.fly(12.0)
    return flight.vehicle.armed


def arms(setting: Setting, mode: str) -> Result:
    flight = setting.at_home()
    flight.mode(mode)
    return flight.vehicle.arm(False)


def no_baro(flight: HandFlight) -> None:
    flight.vehicle.inject(BaroFault(lost=True))
    flight.fly(2.0)


def armed_by_gesture(setting: Setting) -> bool:
    flight = setting.at_home()
    flight.mode("STABILIZE")
    flight.hold(3.0, up=0, clockwise=1000)
    return flight.vehicle.armed


def takes_off_by_itself(setting: Setting) -> bool:
    flight = setting.at_home()
    flight.vehicle.load_plan((item(0, 16), item(1, 22, up_m=5.0)))
    flight.mode("AUTO")
    flight.vehicle.arm(True)
    flight.fly(7.0)
    return flight.up_m > 1.0


def fence_kinds(up_m: float, north_m: float) -> Script:
    def script(setting: Setting) -> object:
        fence = Geofence(setting.parameters())
        fence.check((0.0, 0.0, -45.0), (0.0, 0.0, -45.0), HOME, False, 0)
        at = (north_m, 0.0, -up_m)
        return fence.check(at, at, HOME, False, S).breached.value

    return script


def climbs_out(flight: HandFlight) -> None:
    flight.vehicle.parameters.set("FENCE_ENABLE", 1)
    flight.mode("ALT_HOLD")
    for _ in range(80):
        flight.hold(0.1, up=1000)
        if flight.vehicle.mode_name != "ALT_HOLD":
            break


def leaves_recovery(setting: Setting) -> Result:
    flight = setting.aloft()
    climbs_out(flight)
    return flight.mode("LOITER")


def two_zones(setting: Setting) -> int:
    """In one of two inclusion zones."""
    flight = setting.aloft()
    corners = [(30.0, 30.0), (30.0, -30.0), (-30.0, -30.0), (-30.0, 30.0)]
    far = [(90.0, 30.0), (90.0, -30.0), (40.0, -30.0), (40.0, 30.0)]
    items = tuple(
        point("ardupilot", seq, 5001, corner, 4.0) for seq, corner in enumerate(corners + far)
    )
    flight.vehicle.load_fence(items)
    flight.fly(0.3)
    return int(flight.vehicle.fence_state.breached)


def returns_to(pos_n: float, point_n: float) -> Script:
    """How far north of home a return ends."""

    def script(setting: Setting) -> object:
        points = (Point(point_n, 0.0, 20.0, True),)
        found = landing_site(
            points, (pos_n, 0.0, -9.0), HOME, 584.0, setting.parameters(), lambda n, e: True
        )
        return found.ground_ned[0]

    return script


def return_from(away_m: float, up_m: float) -> Script:
    return lambda setting: return_up_m(setting.parameters(), HOME, (away_m, 0.0, -up_m))


def nose_home(setting: Setting) -> bool:
    """Whether it turns home on a return from the north."""
    flight = fly.returns(setting, 30.0)
    flight.fly(6.0)
    return fly.heading_off_deg(flight, radians(180.0)) < 30.0


def ends_return_m(setting: Setting) -> float:
    flight = fly.returns(setting)
    flight.fly(45.0)
    return flight.up_m


def radio(axis: str) -> Script:
    def script(setting: Setting) -> object:
        receiver = Radio(setting.parameters())
        receiver.override((1900, 1100, 1300, 1700, 1500, 1600, 1500, 1500, *(0,) * 10), 0)
        now = receiver.sticks(0)
        return None if now is None else round(100.0 * float(getattr(now, axis)))

    return script


def switched(pulse_us: int) -> Script:
    """The mode that the mode channel leads to."""

    def script(setting: Setting) -> object:
        flight = setting.aloft()
        channels = [1500] * 8
        channels[4] = pulse_us
        for _ in range(8):
            flight.vehicle.override_channels((*channels, *(0,) * 10), flight.vehicle.time_ns)
            flight.fly(0.1)
        return flight.vehicle.mode_name

    return script


def override_gone_s(setting: Setting) -> float:
    flight = setting.aloft()
    flight.hold(0.3)
    handed = flight.vehicle.sticks
    return fly.waits(flight, lambda _: None, lambda f: f.vehicle.sticks != handed, 8.0)


def circle(setting: Setting) -> HandFlight:
    flight = setting.aloft()
    flight.mode("CIRCLE")
    flight.fly(20.0)
    return flight


def circle_m(setting: Setting) -> float:
    """Its size, by how far it comes from north to south in a round."""
    flight = circle(setting)
    seen = []
    for _ in range(200):
        flight.fly(0.1)
        seen.append(where(flight)[0])
    return 0.5 * (max(seen) - min(seen))


def circle_deg_s(setting: Setting) -> float:
    flight = circle(setting)
    return degrees(hypot(*flight.vehicle.truth.v_ned[:2]) / 10.0)


def circle_nose(setting: Setting) -> tuple[bool, bool]:
    """Whether its nose is along the flight, and whether its centre is where it began."""
    flight = circle(setting)
    v_n, v_e, _ = flight.vehicle.truth.v_ned
    heading = flight.vehicle.estimate.heading_rad
    along = cos(heading) * v_n + sin(heading) * v_e > 0.7 * hypot(v_n, v_e)
    centre = flight.vehicle.target.pos_ned or HOME
    return (along, hypot(*centre[:2]) < 2.0)


def leader_walks(
    flight: HandFlight, seconds: float, start: tuple[float, float] = (20.0, 0.0), system: int = 3
) -> None:
    """North at 3 m/s, heading east, 10 m above home."""
    vehicle = flight.vehicle
    for tick in range(round(seconds * 10)):
        place = (start[0] + 0.3 * tick, start[1], -10.0)
        there = vehicle.state.datum().projection.to_geodetic(place)
        v_ned = (3.0, 0.0, 0.0)
        vehicle.hear_leader(system, there, v_ned, radians(90.0), vehicle.time_ns)
        flight.fly(0.1)


def follows(setting: Setting) -> HandFlight:
    flight = setting.aloft()
    flight.vehicle.parameters.set("FOLL_ENABLE", 1)
    flight.mode("FOLLOW")
    leader_walks(flight, 20.0)
    return flight


def beside_leader(axis: int) -> Script:
    def script(setting: Setting) -> object:
        flight = follows(setting)
        here = where(flight)
        return (here[0] - 20.0 - 0.3 * 199, here[1], here[2] + 10.0)[axis]

    return script


def follow_heading(setting: Setting) -> str:
    flight = follows(setting)
    off = {
        way: fly.heading_off_deg(flight, rad)
        for way, rad in (("east", radians(90.0)), ("south", radians(180.0)), ("north", 0.0))
    }
    return min(off, key=lambda way: off[way])


def follows_at_all(setting: Setting) -> Result:
    return setting.aloft().mode("FOLLOW")


def leader_height_m(setting: Setting) -> float:
    """What GLOBAL_POSITION_INT of a leader whose home lies 50 m lower is taken for."""
    flight = setting.at_home()
    served = fly.Served(flight)
    told = m.GlobalPositionInt(
        0, round(-35.363262e7), round(149.165237e7), 600_000, 30_000, 0, 0, 0, 0
    )
    served.send(told, system=3, component=1)
    seen = flight.vehicle.parts.leader.seen(flight.vehicle.state.sense().wall_ns)
    return inf if seen is None else -seen.pos_ned[2]


def mission_goes_on_at(setting: Setting) -> int:
    """The item after a mission was left for a moment on its way to the second place."""
    flight = setting.aloft()
    fly.flies_plan(flight, (10.0, 0.0), (60.0, 0.0))
    flight.fly(30.0, lambda: flight.vehicle.mission_current == 2)
    flight.fly(4.0)
    flight.mode("LOITER")
    flight.fly(0.5)
    flight.mode("AUTO")
    flight.fly(0.5)
    return flight.vehicle.mission_current


def idle_speed(setting: Setting) -> float:
    flight = setting.at_home()
    flight.mode("STABILIZE")
    flight.vehicle.arm(False)
    flight.fly(1.0)
    return flight.vehicle.blocks.body.s1


def obeys(setting: Setting) -> bool:
    """Whether a command of station 250 is answered."""
    made = fly.bench(setting)
    return bool(acks(made.send(long(fly.REQUEST_MESSAGE, 0.0), system=250)))


def nose_on_leg(setting: Setting) -> bool:
    """Whether a mission turns to its next place."""
    flight = setting.aloft()
    fly.flies_plan(flight, (0.0, 40.0))
    flight.fly(6.0)
    return fly.heading_off_deg(flight, radians(90.0)) < 30.0


def hand_accel_m_s2(setting: Setting) -> float:
    flight = setting.aloft()
    flight.mode("ALT_HOLD")
    most = 0.0
    for _ in range(10):
        flight.hold(0.1, up=1000)
        most = max(most, -flight.vehicle.blocks.flight.ref_acc_d)
    return most


def sensed(field: str) -> Script:
    """What a sensor says on the ground."""

    def script(setting: Setting) -> object:
        flight = setting.at_home()
        flight.fly(0.5)
        return float(getattr(flight.vehicle.blocks.sensed, field))

    return script


def healths(setting: Setting) -> tuple[float, float, float, float]:
    flight = setting.at_home()
    flight.fly(0.2)
    body = flight.vehicle.blocks.body
    return (body.health_1, body.health_2, body.health_3, body.health_4)


def baro_heard(setting: Setting) -> bool:
    flight = setting.at_home()
    flight.fly(2.0)
    return flight.vehicle.health.baro_ok


def compass_heard(setting: Setting) -> bool:
    flight = setting.at_home()
    flight.fly(2.0)
    return flight.vehicle.health.mag_ok


def fix(setting: Setting) -> int:
    flight = setting.at_home()
    flight.fly(1.0)
    return flight.vehicle.readings.gps.fix_type


def air_m_s(axis: int) -> Script:
    def script(setting: Setting) -> object:
        flight = setting.at_home()
        flight.fly(6.0)
        body = flight.vehicle.blocks.body
        return (body.flow_n, body.flow_e)[axis]

    return script


def gusts(setting: Setting) -> float:
    flight = setting.at_home()
    return highest(flight, 20.0, lambda f: abs(f.vehicle.blocks.body.gust_n))
