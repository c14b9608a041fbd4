"""A fleet over real sockets, and who listens at the other end: for the measurements of fleets.

The vehicles are a program of their own, whose CPU time is the system's own account of it.
Ports are the listener's choice, so nothing else on the machine hears or disturbs the fleet.
"""

from __future__ import annotations

import argparse
import os
import selectors
import socket
import struct
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from fractions import Fraction
from math import nan
from typing import Final

from vehicle_sim.autopilot.firmware import FIRMWARES
from vehicle_sim.autopilot.interface import Geodetic
from vehicle_sim.autopilot.modes import Personality
from vehicle_sim.cli import HOMES, place
from vehicle_sim.plant.faults import WindChange
from vehicle_sim.shell.runtime import Opened, Plan, VehicleSetup, launch, run
from vehicle_sim.shell.urls import parse
from vehicle_sim.wire import messages as m
from vehicle_sim.wire.codec import encode

ARM, FORCE, TAKE_OFF, SET_MODE = 400, 21196, 22, 176
UP_M: Final = 20.0
COPTER_GUIDED: Final = 4
SYSTEMS: Final = 250
BUFFER_BYTES: Final = 1 << 23


def _udp() -> socket.socket:
    listener = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_BYTES)
    listener.bind(("127.0.0.1", 0))
    listener.setblocking(False)
    return listener


@dataclass
class Listener:
    """Counts what comes in; `own` has an entry a vehicle, or none."""

    own: list[socket.socket]
    shared: socket.socket | None
    datagrams: int = 0
    data_bytes: int = 0
    positions: dict[int, int] = field(default_factory=dict)  # LOCAL_POSITION_NED by socket
    boot_ms: int = 0  # of the newest position
    height_m: float = 0.0
    talkers: dict[int, tuple[str, int]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.watch = selectors.DefaultSelector()
        for listener in (*self.own, *([self.shared] if self.shared is not None else [])):
            self.watch.register(listener, selectors.EVENT_READ)

    def listen(self, seconds: float) -> None:
        end = time.monotonic() + seconds
        while (left := end - time.monotonic()) > 0.0:
            for key, _ in self.watch.select(left):
                self._drain(key.fd, key.fileobj)

    def _drain(self, number: int, listener: object) -> None:
        assert isinstance(listener, socket.socket)
        for _ in range(200):
            try:
                data, source = listener.recvfrom(65536)
            except BlockingIOError:
                return
            self.talkers[number] = source
            self.datagrams += 1
            self.data_bytes += len(data)
            at = 0
            while at + 10 <= len(data) and data[at] == 0xFD:
                length = data[at + 1]
                if data[at + 7 : at + 10] == b"\x20\0\0" and length == 28:
                    self.positions[number] = self.positions.get(number, 0) + 1
                    self.boot_ms, *_, down = struct.unpack_from("<Ifff", data, at + 10)
                    self.height_m = -down
                at += length + 12

    def forget(self) -> None:
        self.datagrams = self.data_bytes = 0
        self.positions.clear()

    def close(self) -> None:
        self.watch.close()
        for listener in (*self.own, *([self.shared] if self.shared is not None else [])):
            listener.close()


@dataclass(frozen=True)
class Fleet:
    """What was started, and how to talk to it."""

    process: subprocess.Popen[str]
    listener: Listener
    count: int
    personality: Personality

    def take_off(self) -> None:
        """All of them, one after the other, and up."""
        for index in range(self.count):
            system = index % SYSTEMS + 1
            copter = self.personality == "ardupilot"
            orders: list[m.Message] = []
            if copter:
                orders.append(m.SetMode(COPTER_GUIDED, system, 1))
            up_m = UP_M if copter else HOMES["px4"][2] + UP_M
            orders.append(_long(system, ARM, 1.0, FORCE))
            orders.append(_long(system, TAKE_OFF, 0.0, 0.0, 0.0, nan, nan, nan, up_m))
            listener = self.listener.own[index] if self.listener.own else self.listener.shared
            assert listener is not None
            talker = self.listener.talkers[listener.fileno()]
            for number, order in enumerate(orders):
                listener.sendto(encode(order, number, 255, 190), talker)

    @property
    def cpu_s(self) -> float:
        """User and system time of the program since its start (Linux)."""
        with open(f"/proc/{self.process.pid}/stat", encoding="ascii") as file:
            words = file.read().rpartition(")")[2].split()
        return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")

    @property
    def resident_mib(self) -> float:
        with open(f"/proc/{self.process.pid}/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20


def _long(system: int, command: int, *params: float) -> m.CommandLong:
    p1, p2, p3, p4, p5, p6, p7 = (*params, *(0.0,) * (7 - len(params)))
    return m.CommandLong(p1, p2, p3, p4, p5, p6, p7, command, system, 1, 0)


@contextmanager
def fleet(
    count: int, *, own: bool, shared: bool, sparse: bool, personality: Personality = "px4"
) -> Iterator[Fleet]:
    """Started, heard and on the ground."""
    listener = Listener([_udp() for _ in range(count)] if own else [], _udp() if shared else None)
    ports = [each.getsockname()[1] for each in listener.own]
    common = [] if listener.shared is None else [listener.shared.getsockname()[1]]
    words = [sys.executable, "-m", "tools.fleet_listener", personality, str(count)]
    words += ["--own", ",".join(map(str, ports)), "--shared", ",".join(map(str, common))]
    words += ["--sparse"] if sparse else []
    process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdin is not None
    assert process.stdout is not None
    try:
        process.stdout.readline()
        yield Fleet(process, listener, count, personality)
    finally:
        process.stdin.close()
        process.stdout.close()
        process.wait(20.0)
        listener.close()


def plan(personality: Personality, count: int, own: Sequence[int], shared: Sequence[int],
         sparse: bool) -> Plan:  # fmt: skip
    home = HOMES[personality]
    return Plan(
        personality=personality,
        firmware=FIRMWARES[personality][0],
        airframe="s500",
        vehicles=tuple(
            VehicleSetup(
                index % SYSTEMS + 1,
                Geodetic(*place(home, index, count)),
                tuple(parse(f"udpout://127.0.0.1:{port}") for port in own[index : index + 1]),
            )
            for index in range(count)
        ),
        shared=tuple(parse(f"udpout://127.0.0.1:{port}") for port in shared),
        seed=1,
        speedup=Fraction(1),
        params=(),
        wind=WindChange((0.0, 0.0, 0.0), 0.0),
        faults=(),
        signing=None,
        files=None,
        streams="position" if sparse else "full",
    )


def main() -> int:
    """The fleet itself, until its standard input ends."""
    parser = argparse.ArgumentParser()
    parser.add_argument("personality", choices=["px4", "ardupilot"])
    parser.add_argument("count", type=int)
    parser.add_argument("--own", default="")
    parser.add_argument("--shared", default="")
    parser.add_argument("--sparse", action="store_true")
    asked = parser.parse_args()
    own, shared = (
        [int(port) for port in ports.split(",") if port] for ports in (asked.own, asked.shared)
    )
    opened: Opened = launch(plan(asked.personality, asked.count, own, shared, asked.sparse))
    return run(opened, lambda: print("ready", flush=True), lambda line: None, lifeline=True)


if __name__ == "__main__":
    sys.exit(main())
