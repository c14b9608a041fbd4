"""The pacer on a machine that is slower than the speed-up asked for."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from fractions import Fraction
from typing import Final

import pytest

from vehicle_sim.autopilot.autopilot import Autopilot
from vehicle_sim.autopilot.interface import Geodetic
from vehicle_sim.autopilot.parameters.parameters import Parameters
from vehicle_sim.services.profile import PROFILES
from vehicle_sim.services.server import VehicleServer
from vehicle_sim.shell import pacer
from vehicle_sim.shell.pacer import TURN_NS, Pacer, Stop
from vehicle_sim.shell.readable import Readable, ReadableSockets
from vehicle_sim.shell.urls import Url, UrlKind
from vehicle_sim.simulation.traffic import Datagram, Input, LinkSpec, Output, Peer
from vehicle_sim.simulation.world import World

SECOND_NS: Final = 1_000_000_000
SPEEDUP: Final = 50
REACHED: Final = 14
"""How many times real time the machine lives; 14 was seen with the station beside it."""
CALL_NS: Final = 10_000
SENT_NS: Final = SECOND_NS // 2
ENDS_NS: Final = SECOND_NS


class Machine(World):
    """A world whose steps cost real time, and that notes when its one datagram comes."""

    def __init__(self) -> None:
        parameters = Parameters("px4")
        vehicle = Autopilot("px4", Geodetic(47.397742, 8.545594, 488.0), 1, params=parameters)
        server = VehicleServer(vehicle, PROFILES["px4"], parameters, 1)
        super().__init__([server], [LinkSpec()], Fraction(SPEEDUP))
        self.real_ns = 0
        self.ours, self.theirs = socket.socketpair()
        self.stop = Stop()
        self.sent_ns: int | None = None
        self.came_ns: int | None = None

    def handle(self, given: Input, now_ns: int) -> list[Output]:
        before_ns = self.time_ns
        out = super().handle(given, now_ns)
        self.real_ns += CALL_NS + (self.time_ns - before_ns) // REACHED
        if isinstance(given, Datagram):
            self.came_ns = self.time_ns
        if self.real_ns >= SENT_NS and self.sent_ns is None:
            self.sent_ns = self.time_ns
            self.theirs.send(b"command")
        if self.real_ns >= ENDS_NS:
            self.stop.code = 0
        return out


class Socket:
    """One end of a socket pair, as the endpoint of link 0."""

    link: Final = 0
    peers: Final[tuple[Peer, ...]] = ()
    url: Final = Url(UrlKind.UDP_IN, "127.0.0.1", 14550)
    restless: Final = False

    def __init__(self, source: socket.socket) -> None:
        self._source = source

    def attach(self, watch: ReadableSockets) -> None:
        watch.add(self._source, 0)

    def read(self, ready: Readable) -> list[Input]:
        return [Datagram(0, ("127.0.0.1", 14550), self._source.recv(100))]

    def idle(self, now_ns: int) -> list[Input]:
        return []

    def send(self, peer: Peer, data: bytes) -> None:
        """Nobody is told anything."""

    def close(self) -> None:
        self._source.close()


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch) -> Iterator[Machine]:
    machine = Machine()
    monkeypatch.setattr(pacer, "monotonic_ns", lambda: machine.real_ns)
    yield machine
    for end in (machine.ours, machine.theirs):
        end.close()
    machine.stop.close()


def test_a_command_does_not_wait_for_seconds_of_the_vehicles_time(machine: Machine) -> None:
    """A take-off that waited for 10 s of it came to a PX4 that had disarmed (COM_DISARM_PRFLT)."""
    Pacer(machine, [Socket(machine.ours)], 0, lambda _: None, machine.stop).run()
    assert machine.sent_ns is not None
    assert machine.came_ns is not None
    assert machine.came_ns - machine.sent_ns <= 2 * TURN_NS
    assert machine.time_ns == pytest.approx(REACHED * ENDS_NS, rel=0.02)
