"""A client of its own making: pymavlink on one side, the whole vehicle's bytes on the other."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any, Final, TypeAlias

from pymavlink.dialects.v20 import all as mavlink

from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.boot import Boot
from vehicle_sim.autopilot.firmware import Firmware
from vehicle_sim.autopilot.interface import Geodetic, Truth
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.engine.choose_engine import engine_for
from vehicle_sim.engine.step import Seat, VehicleSpec
from vehicle_sim.plant.airframe import load
from vehicle_sim.plant.sensors import MEMS, SensorGrade
from vehicle_sim.services.profile import profile_of, without_camera
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.services.stream_sets import REAL
from vehicle_sim.simulation.world import Datagram, LinkSpec, Log, Transmit, Wake, World
from vehicle_sim.wire.signing import SigningKey

MS: Final = 1_000_000
S: Final = 1_000_000_000
NAN: Final = math.nan
UNIX_START_NS: Final = 1_800_000_000 * S
BOTH: tuple[Personality, ...] = ("px4", "ardupilot")
HOMES: dict[Personality, Geodetic] = {
    "px4": Geodetic(47.397742, 8.545594, 488.0),
    "ardupilot": Geodetic(-35.363262, 149.165237, 584.0),
}
ACCEPTED, TEMPORARILY_REJECTED, DENIED, UNSUPPORTED, FAILED, IN_PROGRESS = range(6)
UNSUPPORTED_MAV_FRAME = 9

Message: TypeAlias = Any
"""pymavlink's, which has no types."""


@dataclass(slots=True)
class Heard:
    """One message and the wall time at which it came [s]."""

    at_s: float
    message: Message


class Sky:
    """One or more vehicles in a world, and its clock."""

    def __init__(
        self,
        personality: Personality,
        count: int = 1,
        speedup: Fraction = Fraction(1),
        signing: SigningKey | None = None,
        parameters: dict[str, float] | None = None,
        home: Geodetic | None = None,
        firmware: Firmware | None = None,
        boot: Boot = "quick",
        camera: bool = True,
        real_streams: bool = False,
        grade: SensorGrade = MEMS,
        phase_ns: int = 0,
    ) -> None:
        self.personality: Personality = personality
        self.home = home or HOMES[personality]
        self.parameters: list[Parameters] = []
        servers = []
        for index in range(count):
            own = Parameters(personality, firmware)
            for name, value in (parameters or {}).items():
                own.set(name, value)
            self.parameters.append(own)
            spec = VehicleSpec(1, index, self.home.lat_deg)
            seat = Seat(engine_for([spec], load(), grade), 0)
            vehicle = Autopilot(personality, self.home, 1, index, own, seat, boot, camera)
            profile = profile_of(personality, own.firmware)
            if not camera:
                profile = without_camera(profile)
            servers.append(
                VehicleServer(
                    vehicle,
                    profile,
                    own,
                    index + 1,
                    speedup,
                    UNIX_START_NS,
                    phase_ns=phase_ns,
                    stream_sets=REAL[personality] if real_streams else None,
                )
            )
        self.vehicles = [server.vehicle for server in servers]
        self.world = World(
            servers, [LinkSpec()], speedup, signing=signing, unix_start_ns=UNIX_START_NS
        )
        self.now_ns = 0
        self.clients: dict[str, Client] = {}

    def client(self, name: str = "station", system: int = 255, component: int = 190) -> Client:
        self.clients[name] = Client(self, name, system, component)
        return self.clients[name]

    def truth(self, system: int = 1) -> Truth:
        truth = self.world.truth(system)
        assert truth is not None
        return truth

    def deliver(self, outputs: Iterable[Transmit | Log]) -> None:
        for output in outputs:
            if isinstance(output, Transmit) and str(output.peer) in self.clients:
                self.clients[str(output.peer)].take(output.data)

    def run(self, seconds: float, until: Callable[[], bool] | None = None) -> None:
        """Let time pass, with every client's heartbeat at 1 Hz."""
        end_ns = self.now_ns + round(seconds * S)
        while self.now_ns < end_ns:
            beats = [client.beat_ns for client in self.clients.values()]
            self.now_ns = min(end_ns, max(self.now_ns + 1, min(self.world.deadline_ns, *beats)))
            self.deliver(self.world.handle(Wake(), self.now_ns))
            for client in self.clients.values():
                client.beat_if_due()
            if until is not None and until():
                return
        assert until is None, f"did not happen within {seconds} s"


@dataclass(slots=True)
class Client:
    """`heard` is everything since the last `forget`."""

    sky: Sky
    name: str
    system: int
    component: int
    heard: list[Heard] = field(default_factory=list)
    beats: bool = True
    beat_ns: int = 0
    raw: bytearray = field(default_factory=bytearray)
    mav: mavlink.MAVLink = field(init=False)

    def __post_init__(self) -> None:
        self.mav = mavlink.MAVLink(None, self.system, self.component)
        self.mav.robust_parsing = True

    def take(self, data: bytes) -> None:
        self.raw += data
        for message in self.mav.parse_buffer(data) or []:
            assert message.get_type() != "BAD_DATA"
            self.heard.append(Heard(self.sky.now_ns / 1e9, message))

    def forget(self) -> Client:
        self.heard.clear()
        self.raw.clear()
        return self

    def beat_if_due(self) -> None:
        if self.sky.now_ns >= self.beat_ns:
            self.beat_ns = (self.sky.now_ns // S + 1) * S
            if self.beats:
                self.send(mavlink.MAVLink_heartbeat_message(6, 8, 0, 0, 4, 3))

    def send(self, message: Message, sequence: int | None = None) -> list[Message]:
        """What comes back at once; `sequence` repeats a frame."""
        if sequence is not None:
            self.mav.seq = sequence
        data = bytes(message.pack(self.mav))
        self.mav.seq = (self.mav.seq + 1) & 0xFF
        return self.send_raw(data)

    def send_raw(self, data: bytes) -> list[Message]:
        before = len(self.heard)
        self.sky.deliver(self.sky.world.handle(Datagram(0, self.name, data), self.sky.now_ns))
        return [each.message for each in self.heard[before:]]

    # ------------------------------------------------------------------------ looking back

    def all(self, kind: str) -> list[Message]:
        return [each.message for each in self.heard if each.message.get_type() == kind]

    def last(self, kind: str) -> Message:
        found = self.all(kind)
        assert found, f"no {kind} in {sorted({h.message.get_type() for h in self.heard})}"
        return found[-1]

    def rate_hz(self, kind: str, seconds: float) -> float:
        return len(self.all(kind)) / seconds

    def texts(self) -> list[str]:
        return [message.text for message in self.all("STATUSTEXT")]

    # --------------------------------------------------------------------------- commands

    def long(
        self,
        command: int,
        *params: float,
        confirmation: int = 0,
        target: int = 1,
        sequence: int | None = None,
    ) -> list[int]:
        """COMMAND_LONG; the results that are acked at once."""
        p = (*params, *(0.0,) * (7 - len(params)))
        asked = mavlink.MAVLink_command_long_message(target, 1, command, confirmation, *p)
        return self._results(command, self.send(asked, sequence))

    def int_(
        self,
        command: int,
        *params: float,
        x: int = 0,
        y: int = 0,
        z: float = 0.0,
        frame: int = 6,
    ) -> list[int]:
        """COMMAND_INT."""
        p = (*params, *(0.0,) * (4 - len(params)))
        asked = mavlink.MAVLink_command_int_message(1, 1, frame, command, 0, 0, *p, x, y, z)
        return self._results(command, self.send(asked))

    def _results(self, command: int, heard: list[Message]) -> list[int]:
        acks = [each for each in heard if each.get_type() == "COMMAND_ACK"]
        assert all(ack.command == command for ack in acks)
        for ack in acks:
            assert (ack.target_system, ack.target_component) == (self.system, self.component)
        return [ack.result for ack in acks]

    def request_message(self, number: int, p2: float = 0.0) -> tuple[int, list[Message]]:
        """The ack's result, and what came beside it."""
        p = (float(number), p2, 0.0, 0.0, 0.0, 0.0, 0.0)
        heard = self.send(mavlink.MAVLink_command_long_message(1, 1, 512, 0, *p))
        (result,) = self._results(512, heard)
        return result, [each for each in heard if each.get_type() != "COMMAND_ACK"]

    # ------------------------------------------------------------------------------ flying

    def take_off(self, up_m: float = 10.0) -> None:
        """Arm and hover, the personality's own way."""
        sky = self.sky
        sky.run(5.0, lambda: sky.vehicles[0].armable)
        if sky.personality == "ardupilot":
            assert self.long(176, 1, 4) == [ACCEPTED]
        assert self.long(400, 1) == [ACCEPTED]
        height = up_m if sky.personality == "ardupilot" else sky.home.alt_amsl_m + up_m
        assert self.long(22, 0, 0, 0, NAN, NAN, NAN, height) == [ACCEPTED]
        sky.run(30.0, lambda: -sky.truth().pos_ned[2] > up_m - 1.0)
        sky.run(3.0)


def connected(
    personality: Personality,
    speedup: Fraction = Fraction(1),
    parameters: dict[str, float] | None = None,
) -> Client:
    """A vehicle that is ready, and a station that has heard of it."""
    sky = Sky(personality, speedup=speedup, parameters=parameters)
    client = sky.client()
    client.beat_if_due()
    sky.run(2.0)
    return client
