"""A vehicle that obeys at once and remembers what it was asked, and a bench to drive it on."""

from __future__ import annotations

from fractions import Fraction
from inspect import isfunction, signature
from typing import Any, TypeVar

from vehicle_sim.autopilot.boot import READY
from vehicle_sim.autopilot.fence import rally
from vehicle_sim.autopilot.fence import zones as fence
from vehicle_sim.autopilot.firmware import Firmware
from vehicle_sim.autopilot.interface import (
    AttitudeGoal,
    Estimate,
    FenceState,
    Geodetic,
    GpsFix,
    Landed,
    Orbiting,
    PlanItem,
    Power,
    Readings,
    Refusal,
    Result,
    Target,
    Truth,
    Vehicle,
    VehicleEvent,
)
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.estimation.estimator import Health
from vehicle_sim.numerics.vectors import Vec3
from vehicle_sim.services.profile import profile_of
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.services.stream_sets import LinkMode, StreamSets
from vehicle_sim.simulation.world import Datagram, LinkSpec, Log, Transmit, Wake, World
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.codec import encode
from vehicle_sim.wire.split import Counters, split

HOME = Geodetic(47.397742, 8.545594, 488.0)
HEALTHY = Health(
    attitude_ok=True,
    velocity_ok=True,
    position_ok=True,
    height_ok=True,
    gps_ok=True,
    mag_ok=True,
    baro_ok=True,
    gps_fix=3,
    satellites=12,
    eph_m=0.6,
    epv_m=0.9,
    accuracy_m=0.4,
    dead_s=0.0,
    resets=0,
    vel_ratio=0.05,
    pos_ratio=0.1,
    height_ratio=0.03,
    mag_ratio=0.02,
)
MS = 1_000_000
S = 1000 * MS

Kind = TypeVar("Kind", bound=m.Message)
NUMBERS: dict[object, int] = {kind: number for kind, number in m.IDS.items()}  # noqa: C416
"""As `m.IDS`, for a kind that is given."""


class FakeVehicle:
    """Every request is noted in `calls` and answered with `answers.get(name, ACCEPTED)`.

    It is its own engine, and always has something to do.
    """

    dt_ns = 4 * MS

    def __init__(self) -> None:
        self.time_ns = 0
        self.calls: list[tuple[object, ...]] = []
        self.answers: dict[str, Result] = {}
        self.pending: list[VehicleEvent] = []
        self.armed = False
        self.landed = Landed.ON_GROUND
        self.custom_mode = 4 << 16 | 3 << 24
        self.base_mode = 1
        self.system_status = 3
        self.origin: Geodetic | None = HOME
        self.home: Geodetic | None = HOME
        self.home_pos_ned: Vec3 | None = (0.0, 0.0, 0.0)
        self.armable = True
        self.fence_state = FenceState(False, False, False, 0, 0, 0)
        self.motor_outputs = (0.0, 0.0, 0.0, 0.0)
        self.servos_us: tuple[int, ...] = (0,) * 16
        self.relays = (1, 0)
        self.downloads: list[bool] = []
        self.mission_current = 0
        self.mission_state = 1
        self.capturing = False
        self.images_captured = 0
        self.plan: tuple[PlanItem, ...] = ()
        self.power = Power(15.2, 4.0, 120.0, 96)
        self.mav_type = 2
        self.target = Target((0.0, 0.0, -2.0), None, 0.0)
        self.attitude_goal: AttitudeGoal | None = None
        self.orbiting: Orbiting | None = None
        self.channels_us: tuple[int, ...] = (0,) * 18
        self.sticks: tuple[float, float, float, float] | None = None
        self.wind_ned: Vec3 | None = (3.0, -4.0, 0.0)
        self.vibration_m_s2: Vec3 = (0.1, 0.2, 0.3)
        self.pos_ned: Vec3 = (10.0, 20.0, -5.0)
        self.q_ned_from_frd = (1.0, 0.0, 0.0, 0.0)
        self.health = HEALTHY
        self.boot_stage = READY
        self.gps = GpsFix(3, 12, 47.39785, 8.54595, 492.0, (3.0, 4.0, 0.0), 0.6, 0.9)

    @property
    def engine(self) -> FakeVehicle:
        return self

    @property
    def due_step(self) -> int:
        return self.time_ns // self.dt_ns + 1

    def step(self) -> None:
        self.time_ns += self.dt_ns

    def live(self) -> None:
        pass

    takes_failures = True

    @property
    def clock_ns(self) -> int:
        return self.time_ns

    @property
    def truth(self) -> Truth:
        return Truth(
            time_s=self.time_ns / 1e9,
            pos_ned=self.pos_ned,
            v_ned=(1.0, 0.0, 0.0),
            q_ned_from_frd=self.q_ned_from_frd,
            rates_frd=(0.0, 0.0, 0.0),
            lat_deg=47.3978,
            lon_deg=8.5459,
            alt_amsl_m=493.0,
            armed=self.armed,
            mode="AUTO.LOITER",
            landed=True,
            battery=0.96,
        )

    def events(self) -> list[VehicleEvent]:
        pending, self.pending = self.pending, []
        return pending

    @property
    def estimate(self) -> Estimate:
        return Estimate(
            time_ns=self.time_ns,
            pos_ned=self.pos_ned,
            v_ned=(1.0, 0.0, 0.0),
            q_ned_from_frd=self.q_ned_from_frd,
            rates_frd=(0.0, 0.0, 0.0),
            accel_frd=(0.0, 0.0, -9.8),
            lat_deg=47.3978,
            lon_deg=8.5459,
            alt_amsl_m=493.0,
            alt_rel_m=5.0,
            heading_rad=0.0,
            gps_ok=True,
        )

    @property
    def readings(self) -> Readings:
        return Readings(
            gyro_frd=(0.01, -0.02, 0.03),
            accel_frd=(0.1, 0.2, -9.8),
            mag_frd=(0.21, 0.01, 0.43),
            pressure_alt_amsl_m=493.5,
            gps=self.gps,
        )

    def _note(self, name: str, *given: object) -> Result:
        self.calls.append((name, *given))
        return self.answers.get(name, Result.ACCEPTED)

    def __getattr__(self, name: str) -> Any:
        """Every other method of a `Vehicle`: noted with what it was given, and answered."""
        asked = vars(Vehicle).get(name)
        if not isfunction(asked):
            raise AttributeError(name)

        def noted(*given: object, **by_name: object) -> Result:
            bound = signature(asked).bind(self, *given, **by_name)
            bound.apply_defaults()
            return self._note(name, *bound.args[1:])

        return noted

    def arm(self, force: bool) -> Result:
        result = self._note("arm", force)
        self.armed = self.armed or result is Result.ACCEPTED
        return result

    def disarm(self, force: bool) -> Result:
        self.armed = False
        return self._note("disarm", force)

    def set_mode(self, base_mode: int, custom_mode: int) -> Result:
        self.custom_mode = custom_mode
        return self._note("set_mode", base_mode, custom_mode)

    def mission_set_current(self, seq: int) -> Result:
        if seq >= len(self.plan):
            return Result.DENIED
        self.mission_current = seq
        return self._note("mission_set_current", seq)

    def check_plan(self, items: tuple[PlanItem, ...]) -> tuple[int, str] | None:
        bad = [item for item in items if item.command == 82]
        return (bad[0].seq, "splines are not flown") if bad else None

    def load_plan(self, items: tuple[PlanItem, ...]) -> None:
        self.plan = items

    def check_fence(self, items: tuple[PlanItem, ...]) -> Refusal | None:
        return fence.check(items, "px4")

    def check_rally(self, items: tuple[PlanItem, ...]) -> Refusal | None:
        return rally.check(items)

    def log_download(self, running: bool) -> None:
        self.downloads.append(running)

    def wall(self, wall_ns: int) -> None:
        pass

    def named(self, name: str) -> list[tuple[object, ...]]:
        """The calls of one name, without it."""
        return [call[1:] for call in self.calls if call[0] == name]


class Bench:
    """One vehicle on one link, a clock, and clients that send messages and read the answers."""

    def __init__(
        self,
        personality: Personality = "px4",
        speedup: Fraction = Fraction(1),
        firmware: Firmware | None = None,
        stream_sets: StreamSets | None = None,
        mode: LinkMode = LinkMode.NORMAL,
        operator_control: bool = False,
    ) -> None:
        self.vehicle = FakeVehicle()
        self.parameters = Parameters(personality, firmware)
        profile = profile_of(personality, self.parameters.firmware)
        server = VehicleServer(
            self.vehicle,
            profile,
            self.parameters,
            system=1,
            speedup=speedup,
            stream_sets=stream_sets,
            operator_control=operator_control,
        )
        self.world = World([server], [LinkSpec(mode=mode)], speedup)
        self.now_ns = 0
        self.logs: list[Log] = []
        self.sequence = 0
        self.raw = b""

    def send(
        self,
        message: m.Message,
        system: int = 255,
        component: int = 190,
        peer: str = "ground",
        sequence: int | None = None,
    ) -> list[m.Message]:
        """What comes back to that peer at once."""
        self.sequence += 1
        used = self.sequence if sequence is None else sequence
        data = encode(message, used & 0xFF, system, component)
        return self._take(self.world.handle(Datagram(0, peer, data), self.now_ns), peer)

    def advance(self, ns: int, peer: str = "ground") -> list[m.Message]:
        """Let time pass; what that peer hears meanwhile."""
        heard: list[m.Message] = []
        end_ns = self.now_ns + ns
        while self.now_ns < end_ns:
            self.now_ns = min(end_ns, max(self.now_ns + 1, self.world.deadline_ns))
            heard += self._take(self.world.handle(Wake(), self.now_ns), peer)
        return heard

    def _take(self, outputs: list[Transmit | Log], peer: str) -> list[m.Message]:
        heard: list[m.Message] = []
        counters = Counters()
        for output in outputs:
            if isinstance(output, Log):
                self.logs.append(output)
                continue
            self.raw += output.data
            frames = split(output.data, counters)
            if output.peer == peer:
                heard += [known for frame in frames if (known := frame.message()) is not None]
        assert counters == Counters(frames=counters.frames)
        return heard


def of(heard: list[m.Message], kind: type[Kind]) -> list[Kind]:
    """The messages of one kind."""
    return [each for each in heard if isinstance(each, kind)]


def acks(heard: list[m.Message]) -> list[tuple[int, int]]:
    """Command and result of every COMMAND_ACK."""
    return [(ack.command, ack.result) for ack in heard if isinstance(ack, m.CommandAck)]


def long(command: int, *params: float, confirmation: int = 0, target: int = 1) -> m.CommandLong:
    p1, p2, p3, p4, p5, p6, p7 = (*params, *(0.0,) * (7 - len(params)))
    return m.CommandLong(p1, p2, p3, p4, p5, p6, p7, command, target, 1, confirmation)
