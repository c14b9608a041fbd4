"""Scripts that both personalities fly."""

from __future__ import annotations

from collections.abc import Callable
from copy import deepcopy
from math import acos, cos, degrees, hypot, inf, pi, radians, remainder, sin

from tests.unit.autopilot.flight import item
from tests.unit.autopilot.hand_flight import HandFlight
from tests.unit.parameters.probing import (
    UP_M,
    Act,
    Script,
    Setting,
    climb_m_s,
    flat_m_s,
    highest,
    sink_m_s,
    where,
)
from tests.unit.vehicle_logbook.flights import Flight as LoggedFlight
from tests.unit.vehicle_services.fake_vehicle import Bench, S, long
from vehicle_sim.autopilot.interface import AttitudeSetpoint, Landed, MissionReached, Setpoint
from vehicle_sim.autopilot.manual.stick_feel import Feel, feel_of, thrust_of
from vehicle_sim.autopilot.manual.sticks import Sticks
from vehicle_sim.numerics.gravity import GRAVITY_M_S2
from vehicle_sim.numerics.vectors import Quat
from vehicle_sim.plant.faults import Fault
from vehicle_sim.services.profile import profile_of
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.world import LinkSpec, Log, World
from vehicle_sim.wire import messages as m

GO, LAND, TAKEOFF, REBOOT, REQUEST_MESSAGE = 16, 21, 22, 246, 512


def mode_after(seconds: float, act: Act) -> Script:
    """The mode that is flown some time after something happened in hover."""

    def script(setting: Setting) -> object:
        flight = setting.aloft()
        act(flight)
        flight.fly(seconds)
        return flight.vehicle.mode_name if flight.vehicle.armed else "disarmed"

    return script


def seconds_until(act: Act, so: Callable[[HandFlight], bool], most_s: float = 60.0) -> Script:
    """How long it takes in hover from one thing to another; infinite = more than `most_s`."""

    def script(setting: Setting) -> object:
        return waits(setting.aloft(), act, so, most_s)

    return script


def waits(
    flight: HandFlight,
    act: Act,
    so: Callable[[HandFlight], bool],
    most_s: float = 60.0,
) -> float:
    act(flight)
    for tick in range(round(most_s * 50)):
        if so(flight):
            return tick * 0.02
        flight.fly(0.02)
    return inf


def leaves_mode(name: str) -> Callable[[HandFlight], bool]:
    return lambda flight: flight.vehicle.mode_name != name or not flight.vehicle.armed


def says(text: str) -> Callable[[HandFlight], bool]:
    return lambda flight: any(text in each for each in flight.texts())


def strike(*faults: Fault) -> Act:
    def act(flight: HandFlight) -> None:
        for fault in faults:
            flight.vehicle.inject(fault)

    return act


def station_silent(flight: HandFlight) -> None:
    flight.vehicle.gcs_heard(flight.vehicle.time_ns)


def goes_to(north_m: float, up_m: float = UP_M, east_m: float = 0.0) -> Act:
    return lambda flight: flight.vehicle.reposition((north_m, east_m, -up_m), None, None)


def cruise_m_s(setting: Setting) -> float:
    flight = setting.aloft()
    goes_to(120.0)(flight)
    return highest(flight, 12.0, flat_m_s)


def climb_m_s_to(up_m: float) -> Script:
    def script(setting: Setting) -> object:
        flight = setting.aloft()
        goes_to(0.0, up_m)(flight)
        return highest(flight, 8.0, climb_m_s)

    return script


def descent_m_s_to(up_m: float) -> Script:
    def script(setting: Setting) -> object:
        flight = setting.aloft()
        goes_to(0.0, up_m)(flight)
        return highest(flight, 6.0, sink_m_s)

    return script


def acceleration_m_s2(north_m: float, up_m: float) -> Script:
    """The largest that the reference takes on the way to a goal."""

    def script(setting: Setting) -> object:
        flight = setting.aloft()
        goes_to(north_m, up_m)(flight)
        return highest(flight, 2.0, _reference_m_s2)

    return script


def _reference_m_s2(flight: HandFlight) -> float:
    f = flight.vehicle.blocks.flight
    return hypot(f.ref_acc_n, f.ref_acc_e, f.ref_acc_d)


def turn_deg_s(setting: Setting) -> float:
    """Turning on the way to a heading behind it: not a setpoint's, which it takes at once."""
    flight = setting.aloft()
    if setting.personality == "ardupilot":
        flight.vehicle.condition_yaw(3.0, False, 0.0, 0)
    else:
        flight.vehicle.reposition(where(flight), 3.0, None)
    flight.fly(1.2)
    before = flight.vehicle.estimate.heading_rad
    flight.fly(0.5)
    return 2.0 * heading_off_deg(flight, before)


def sink_at(height_m: float) -> Script:
    """How fast a landing passes a height."""

    def script(setting: Setting) -> object:
        flight = setting.aloft()
        flight.vehicle.land()
        flight.fly(40.0, lambda: flight.up_m < height_m)
        return sink_m_s(flight)

    return script


def landing(setting: Setting) -> HandFlight:
    """Landed just now."""
    flight = setting.aloft()
    goes_to(0.0, 1.0)(flight)
    flight.fly(12.0)
    flight.vehicle.land()
    flight.fly(20.0, lambda: flight.landed() is Landed.ON_GROUND)
    return flight


def disarms_after_landing_s(setting: Setting) -> float:
    return waits(landing(setting), lambda _: None, lambda f: not f.vehicle.armed, 15.0)


def disarms_idle_s(setting: Setting) -> float:
    flight = setting.at_home()
    if setting.personality == "ardupilot":
        flight.vehicle.set_mode_kind("guided")
    return waits(flight, lambda f: f.vehicle.arm(False), lambda f: not f.vehicle.armed, 30.0)


def lifts_off_after_s(setting: Setting) -> float:
    flight = setting.at_home()
    if setting.personality == "ardupilot":
        flight.vehicle.set_mode_kind("guided")

    def leave(each: HandFlight) -> None:
        each.vehicle.arm(False)
        each.vehicle.take_off(5.0)

    return waits(flight, leave, lambda f: f.vehicle.blocks.flight.flying, 5.0)


def take_off_height_m(setting: Setting) -> float:
    flight = setting.at_home()
    if setting.personality == "ardupilot":
        flight.vehicle.set_mode_kind("guided")
    flight.vehicle.arm(False)
    flight.vehicle.take_off(None)
    flight.fly(12.0)
    return flight.up_m


def take_off_climb_m_s(setting: Setting) -> float:
    flight = setting.at_home()
    if setting.personality == "ardupilot":
        flight.vehicle.set_mode_kind("guided")
    flight.vehicle.arm(False)
    flight.vehicle.take_off(15.0)
    return highest(flight, 8.0, climb_m_s)


def exposure_s(setting: Setting) -> float:
    flight = setting.at_home()
    return waits(
        flight, lambda f: f.vehicle.capture_image(0.0, 1), lambda f: f.vehicle.images_captured > 0
    )


def returns(setting: Setting, away_m: float = 25.0) -> HandFlight:
    """On its way home from the north, just now."""
    flight = setting.aloft()
    goes_to(away_m)(flight)
    flight.fly(10.0)
    flight.vehicle.return_home()
    return flight


def return_top_m(away_m: float) -> Script:
    def script(setting: Setting) -> object:
        flight = returns(setting, away_m)
        return highest(flight, 12.0, lambda f: f.up_m)

    return script


def return_m_s(setting: Setting) -> float:
    return highest(returns(setting, 40.0), 12.0, flat_m_s)


def return_waits_s(setting: Setting) -> float:
    """Over home, before it lands."""
    flight = returns(setting)
    flight.fly(60.0, lambda: flight.up_m < 10.4)
    return waits(flight, lambda _: None, lambda f: f.landed() is Landed.LANDING)


def return_lands_from_m(setting: Setting) -> float:
    flight = returns(setting)
    flight.fly(60.0, lambda: flight.landed() is Landed.LANDING)
    return flight.up_m


def flies_plan(flight: HandFlight, *places: tuple[float, float]) -> None:
    first = [item(0, GO)] if flight.personality == "ardupilot" else []
    items = first + [
        item(len(first) + number, GO, north, east, UP_M)
        for number, (north, east) in enumerate(places)
    ]
    flight.vehicle.load_plan(tuple(items))
    flight.vehicle.set_mode_kind("mission")


def reached_at_m(setting: Setting) -> float:
    """How far from its waypoint a mission calls it reached."""
    flight = setting.aloft()
    flies_plan(flight, (30.0, 0.0), (30.0, 30.0))
    flight.fly(30.0, lambda: any(isinstance(e, MissionReached) for e in flight.vehicle.events()))
    return flight.off((30.0, 0.0, -UP_M))


def answer(field: str, ask: Act, after_s: float, hover_s: float = 0.0) -> Script:
    """How much of a step a field of the truth has taken up some time after it was asked for.

    What the hover's own drift does meanwhile is that of a copy that was not asked.
    """

    def script(setting: Setting) -> object:
        flight = setting.aloft(hover_s)
        unasked = deepcopy(flight)
        ask(flight)
        flight.fly(after_s)
        unasked.fly(after_s)
        return _truth(flight, field) - _truth(unasked, field)

    return script


def _truth(flight: HandFlight, field: str) -> float:
    body = flight.vehicle.blocks.body
    return float(getattr(body, field))


def reference(**fields: float) -> Act:
    """Set the reference (and the goal) beside the vehicle: the loops see a step."""

    def ask(flight: HandFlight) -> None:
        f = flight.vehicle.blocks.flight
        for name, value in fields.items():
            setattr(f, name, getattr(f, name) + value)

    return ask


def turned(roll: float = 0.0, pitch: float = 0.0, yaw: float = 0.0) -> Quat:
    """The attitude after a turn [deg] about one axis."""
    half = radians(0.5 * (roll + pitch + yaw))
    x, y, z = (sin(half) if angle else 0.0 for angle in (roll, pitch, yaw))
    return (cos(half), x, y, z)


def tips(q_ned_from_frd: Quat) -> Act:
    """An attitude from outside."""

    def ask(flight: HandFlight) -> None:
        f = flight.vehicle.blocks.flight
        f.attitude = 1.0
        f.sp_w, f.sp_x, f.sp_y, f.sp_z = q_ned_from_frd
        f.horizontal = 2.0

    return ask


def spins(rates_frd: tuple[float, float, float]) -> Act:
    """Body rates from outside."""

    def ask(flight: HandFlight) -> None:
        f = flight.vehicle.blocks.flight
        f.attitude = 2.0
        f.rate_sp_x, f.rate_sp_y, f.rate_sp_z = rates_frd
        f.horizontal = 2.0

    return ask


def fastest(field: str, ask: Act, seconds: float) -> Script:
    """The largest that a field of the truth comes to."""

    def script(setting: Setting) -> object:
        flight = setting.aloft()
        ask(flight)
        return highest(flight, seconds, lambda f: _truth(f, field))

    return script


def learns(field: str, seconds: float, **wind: float) -> Script:
    """What an integrator has taken up of a new load."""

    def script(setting: Setting) -> object:
        flight = setting.aloft()
        before = float(getattr(flight.vehicle.blocks.flight, field))
        for name, value in wind.items():
            setattr(flight.vehicle.blocks.body, name, value)
        flight.fly(seconds)
        return float(getattr(flight.vehicle.blocks.flight, field)) - before

    return script


def lifts(seconds: float, health: float) -> Script:
    """What the vertical integrator has taken up [m/s^2, down] of weaker motors.

    The hover thrust that is learnt from it meanwhile counts as its work: it is handed over.
    """

    def taken(flight: HandFlight) -> float:
        f = flight.vehicle.blocks.flight
        return GRAVITY_M_S2 - f.load * (GRAVITY_M_S2 - f.int_d)

    def script(setting: Setting) -> object:
        flight = setting.aloft()
        before, body = taken(flight), flight.vehicle.blocks.body
        body.health_1 = body.health_2 = body.health_3 = body.health_4 = health
        flight.fly(seconds)
        return taken(flight) - before

    return script


def lean_deg(setting: Setting) -> float:
    """The steepest lean in a storm that would take more."""
    flight = setting.aloft()
    body = flight.vehicle.blocks.body
    body.wind_n = 30.0
    return degrees(highest(flight, 4.0, _lean_rad))


def _lean_rad(flight: HandFlight) -> float:
    f = flight.vehicle.blocks.flight
    return acos(min(1.0, 1.0 - 2.0 * (f.sp_x * f.sp_x + f.sp_y * f.sp_y)))


def acceleration_after(seconds: float) -> Script:
    """What the reference has come to so soon after a far goal was set."""

    def script(setting: Setting) -> object:
        flight = setting.aloft()
        goes_to(60.0)(flight)
        flight.fly(seconds)
        return _reference_m_s2(flight)

    return script


def feels(look: Callable[[Feel], object]) -> Script:
    return lambda setting: look(feel_of(setting.parameters()))


def thrust(sticks: Sticks) -> Script:
    return lambda setting: thrust_of(setting.parameters(), sticks)


def by_hand(mode: str, seconds: float, look: Callable[[HandFlight], float], **axes: int) -> Script:
    """The largest that is seen while sticks are held."""

    def script(setting: Setting) -> object:
        flight = setting.aloft()
        flight.mode(mode)
        most = look(flight)
        for _ in range(round(seconds * 10)):
            flight.hold(0.1, **axes)
            most = max(most, look(flight))
        return most

    return script


class Served(Bench):
    """A whole vehicle on one link."""

    def __init__(self, flight: HandFlight, system: int = 1) -> None:
        parameters = flight.vehicle.parameters
        profile = profile_of(flight.personality, parameters.firmware)
        self.server = VehicleServer(flight.vehicle, profile, parameters, system)
        self.world = World([self.server], [LinkSpec()])
        self.now_ns = 0
        self.logs: list[Log] = []
        self.sequence = 0
        self.raw = b""
        self.stored = parameters.value


def system_id(setting: Setting) -> int:
    """After a reboot."""
    served = Served(setting.fresh())
    served.advance(S)
    served.send(long(REBOOT, 1.0))
    served.advance(S)
    return served.server.system


def message(kind: type[m.Message], field: str) -> Script:
    """What a message says, half a second after the start."""

    def script(setting: Setting) -> object:
        served = Served(setting.fresh())
        served.send(m.Heartbeat(0, 6, 8, 0, 4, 3))
        served.advance(S // 2)
        built = served.server._info.build(m.IDS[kind])
        return None if built is None else getattr(built, field)

    return script


def logs_written(setting: Setting) -> tuple[bool, bool, bool]:
    """Whether something is logged before arming, while armed, and after disarming."""
    flight = LoggedFlight(setting.personality)
    for name, value in setting.values.items():
        flight.parameters.set(name, value)

    def grows() -> bool:
        before = sum(map(len, flight.logs))
        flight.advance(S)
        return sum(map(len, flight.logs)) > before

    before = grows()
    flight.vehicle.armed = True
    armed = grows()
    flight.vehicle.armed = False
    grows()
    return (before, armed, grows())


def bench(setting: Setting) -> Bench:
    made = Bench(setting.personality)
    for name, value in setting.values.items():
        made.parameters.set(name, value)
    return made


def rate_hz(kind: type[m.Message]) -> Script:
    """How often a message comes unasked."""

    def script(setting: Setting) -> object:
        made = bench(setting)
        made.send(m.Heartbeat(0, 6, 8, 0, 4, 3))
        heard = made.advance(2_000_000_000)
        return sum(isinstance(each, kind) for each in heard) / 2.0

    return script


def against_arming(text: str, act: Act = lambda _: None) -> Script:
    """Whether something is said against arming."""

    def script(setting: Setting) -> object:
        flight = setting.at_home()
        act(flight)
        flight.fly(0.1)
        flight.vehicle.check_arming()
        flight.fly(0.1)
        return any(text in each for each in flight.texts())

    return script


def heading_off_deg(flight: HandFlight, wanted_rad: float) -> float:
    return abs(degrees(remainder(flight.vehicle.estimate.heading_rad - wanted_rad, 2.0 * pi)))


def attitude_climb(setting: Setting) -> float:
    """What full thrust in an attitude setpoint does in half a second [m/s]."""
    flight = setting.aloft()
    flight.vehicle.set_attitude(AttitudeSetpoint((1.0, 0.0, 0.0, 0.0), None, 0.9))
    flight.fly(0.6)
    return climb_m_s(flight)


def velocity(setpoint: Setpoint, seconds: float) -> Script:
    """The fastest flight by a stream of setpoints."""

    def script(setting: Setting) -> object:
        flight = setting.aloft()
        flight.stream(setpoint, 1.2)
        flight.vehicle.set_mode_kind("guided")
        flight.stream(setpoint, seconds)
        return flat_m_s(flight)

    return script
