"""A vehicle in a world with a schedule of faults, flown over MAVLink, seen by truth and telemetry.

A script says `aloft("px4", faults)`, lets time pass and looks: `truth` is what is, `last(kind)`
what is told.  Faults strike by their times, which count from the start; `STRIKES_S` is in a hover.
"""

from __future__ import annotations

import copyreg
import hashlib
from collections.abc import Callable, Mapping
from copy import deepcopy
from functools import cache
from math import cos, hypot, nan, radians

from tests.unit.vehicle_services.fake_vehicle import NUMBERS, Kind, long
from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.interface import Geodetic, Truth
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.engine.scalar_engine import ScalarEngine
from vehicle_sim.engine.step import Seat, VehicleSpec
from vehicle_sim.plant.airframe import load
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.simulation.fault_script import Schedule, parse
from vehicle_sim.simulation.impairment import NEVER_NS
from vehicle_sim.simulation.world import Datagram, LinkSpec, Log, Transmit, Wake, World
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.codec import MavlinkFrame, encode
from vehicle_sim.wire.split import Counters, split

S = 1_000_000_000
MS = 1_000_000
STRIKES_S = 20.0
HOMES: dict[Personality, Geodetic] = {
    "px4": Geodetic(47.397742, 8.545594, 488.0),
    "ardupilot": Geodetic(-35.363262, 149.165237, 584.0),
}
HOVERS: dict[Personality, str] = {"px4": "AUTO.LOITER", "ardupilot": "GUIDED"}
METRES_PER_DEGREE = 111_319.49
AS_DELIVERED: Mapping[str, float] = {}
PEER = "ground"
BEAT = m.Heartbeat(0, 6, 8, 0, 4, 3)
ARM, TAKE_OFF, SET_MODE, INJECT = 400, 22, 176, 420
GUIDED = 4

# A stage can be copied in flight; hashlib's objects are copied by a method of their own.
copyreg.pickle(type(hashlib.sha256()), lambda digest: (digest.copy, ()))


class Stage:
    """One vehicle, one link, one ground station that says no more than it must."""

    def __init__(
        self,
        personality: Personality,
        faults: str = "",
        *,
        airframe: str = "s500",
        seed: int = 1,
        parameters: Mapping[str, float] = AS_DELIVERED,
    ) -> None:
        """`faults` is the text of a fault file; `parameters` are set before it boots."""
        given = Parameters(personality)
        for name, value in parameters.items():
            given.set(name, value)
        home = HOMES[personality]
        engine = ScalarEngine([VehicleSpec(seed, 0, home.lat_deg)], load(airframe))
        self.personality: Personality = personality
        self.vehicle = Autopilot(personality, home, seed, 0, given, Seat(engine, 0))
        server = VehicleServer(self.vehicle, PROFILES[personality], given, 1)
        self.world = World(
            [server], [LinkSpec((PEER,))], seed=seed, faults=parse(faults, "faults.toml")
        )
        self.now_ns = 0
        self.beats = True
        self.sticks: m.ManualControl | None = None  # repeated at 20 Hz, once set
        self.heard: list[tuple[int, MavlinkFrame]] = []
        self.logs: list[Log] = []
        self._beat_ns = 0
        self._stick_ns = 0
        self._sequence = 0

    # ------------------------------------------------------------------------------- time

    def run(self, seconds: float, look: Callable[[Truth], None] | None = None) -> None:
        """Let time pass; `look` at the truth every 20 ms."""
        end_ns = self.now_ns + round(seconds * S)
        while self.now_ns < end_ns:
            self.now_ns = min(end_ns, self.now_ns + 20 * MS)
            if self.beats and self.now_ns >= self._beat_ns:
                self._beat_ns = self.now_ns + S
                self.send(BEAT)
            if self.sticks is not None and self.now_ns >= self._stick_ns:
                self._stick_ns = self.now_ns + S // 20
                self.send(self.sticks)
            self._take(self.world.handle(Wake(), self.now_ns))
            if look is not None:
                look(self.truth)

    def until(self, holds: Callable[[], bool], timeout_s: float = 60.0) -> float:
        """Let time pass until it holds; the seconds that took.  Fails when it does not."""
        start_ns = self.now_ns
        while not holds():
            assert self.now_ns - start_ns < timeout_s * S, f"not within {timeout_s} s: {self}"
            self.run(0.02)
        return (self.now_ns - start_ns) / S

    def run_to(self, at_s: float) -> None:
        """Up to a time since the start."""
        assert self.now_ns <= at_s * S, "that time has passed"
        self.run((at_s * S - self.now_ns) / S)

    # ------------------------------------------------------------------------------ words

    def send(self, message: m.Message) -> None:
        self._sequence += 1
        data = encode(message, self._sequence & 0xFF, 255, 190)
        self._take(self.world.handle(Datagram(0, PEER, data), self.now_ns))

    def command(self, number: int, *params: float) -> int:
        """Its result."""
        answers = self.answers(number, *params)
        assert len(answers) == 1, f"{len(answers)} answers to {number}"
        return answers[0]

    def answers(self, number: int, *params: float) -> list[int]:
        """All results that come within 0.1 s."""
        before = len(self.heard)
        self.send(long(number, *params))
        self.run(0.1)
        return [
            message.result
            for _, frame in self.heard[before:]
            if isinstance(message := frame.message(), m.CommandAck) and message.command == number
        ]

    def ready(self) -> Stage:
        """Booted, with all its streams on, and in a mode in which it arms."""
        self.send(m.RequestDataStream(10, 1, 1, 0, 1))
        self.run(3.0)
        if self.personality == "ardupilot":
            assert self.command(SET_MODE, 1, GUIDED) == 0
        return self

    def take_off(self, up_m: float) -> Stage:
        """Ready, armed and up, in a hover just before the faults strike."""
        self.ready()
        home_m = HOMES[self.personality].alt_amsl_m if self.personality == "px4" else 0.0
        assert self.command(ARM, 1) == 0
        assert self.command(TAKE_OFF, 0, 0, 0, nan, nan, nan, home_m + up_m) == 0
        self.run_to(STRIKES_S - 0.1)
        assert self.mode == HOVERS[self.personality]
        assert abs(self.up_m - up_m) < 1.5
        assert self.speed_m_s < 0.4
        return self

    def copy(self, faults: str) -> Stage:
        """One that goes on from here by itself, with faults that have yet to strike."""
        timed = parse(faults, "faults.toml")
        assert all(each.at_ns > self.now_ns for each in timed), "that should have struck before"
        # What was heard so far changes no more: the copy has the same frames in a list of its own.
        copy = deepcopy(self, {id(self.heard): list(self.heard)})
        copy.world._schedule = Schedule(timed)
        copy.world._fault_ns = copy.world._schedule.due_ns(NEVER_NS)
        return copy

    # ------------------------------------------------------------------------------ sight

    @property
    def truth(self) -> Truth:
        truth = self.world.truth(1)
        assert truth is not None
        return truth

    @property
    def up_m(self) -> float:
        return -self.truth.pos_ned[2]

    @property
    def speed_m_s(self) -> float:
        return hypot(*self.truth.v_ned)

    @property
    def mode(self) -> str:
        return self.truth.mode

    @property
    def armed(self) -> bool:
        return self.truth.armed

    @property
    def texts(self) -> list[str]:
        """Every STATUSTEXT so far, its chunks put together."""
        texts: list[str] = []
        for each in self.all(m.Statustext):
            text = each.text.decode().rstrip("\0")
            if each.chunk_seq:
                texts[-1] += text
            else:
                texts.append(text)
        return texts

    def said(self, part: str) -> bool:
        return any(part in text for text in self.texts)

    def all(self, kind: type[Kind], since_ns: int = 0) -> list[Kind]:
        number = NUMBERS[kind]
        return [
            message
            for at_ns, frame in self.heard
            if at_ns >= since_ns
            and frame.number == number
            and isinstance(message := frame.message(), kind)
        ]

    def last(self, kind: type[Kind]) -> Kind:
        number = NUMBERS[kind]
        message = next(frame for _, frame in reversed(self.heard) if frame.number == number)
        found = message.message()
        assert isinstance(found, kind)
        return found

    @property
    def astray_m(self) -> float:
        """How far it is, horizontally, from where it says that it is."""
        told, truth = self.last(m.GlobalPositionInt), self.truth
        north_m = (told.lat * 1e-7 - truth.lat_deg) * METRES_PER_DEGREE
        east_m = (told.lon * 1e-7 - truth.lon_deg) * METRES_PER_DEGREE
        return hypot(north_m, east_m * cos(radians(truth.lat_deg)))

    def _take(self, outputs: list[Transmit | Log]) -> None:
        for output in outputs:
            if isinstance(output, Log):
                self.logs.append(output)
                continue
            self.heard += [(self.now_ns, frame) for frame in split(output.data, Counters())]

    def __str__(self) -> str:
        return f"{self.truth} {self.texts[-4:]}"


@cache
def _hovering(
    personality: Personality,
    up_m: float,
    airframe: str,
    seed: int,
    parameters: tuple[tuple[str, float], ...],
) -> Stage:
    stage = Stage(personality, airframe=airframe, seed=seed, parameters=dict(parameters))
    return stage.take_off(up_m)


def aloft(
    personality: Personality,
    faults: str = "",
    up_m: float = 10.0,
    *,
    airframe: str = "s500",
    seed: int = 1,
    parameters: Mapping[str, float] = AS_DELIVERED,
) -> Stage:
    """In a hover, just before the faults strike.

    The way there is the same for all faults: it is flown once, and each test goes on from a copy.
    `test_fault_determinism` compares such a copy with a stage that flew all the way.
    """
    given = tuple(sorted(parameters.items()))
    return _hovering(personality, up_m, airframe, seed, given).copy(faults)


def far(truth: Truth, from_ned: tuple[float, float, float]) -> float:
    """Horizontally, in metres."""
    return hypot(truth.pos_ned[0] - from_ned[0], truth.pos_ned[1] - from_ned[1])
