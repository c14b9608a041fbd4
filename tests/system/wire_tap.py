"""A UDP proxy between a vehicle and a station: an ear on the wire that neither of them knows."""

from __future__ import annotations

import contextlib
import select
import socket
import struct
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass

READ_BYTES = 65_536
RECEIVE_BUFFER_BYTES = 4 << 20
SO_TIMESTAMPNS = 35
"""Linux tells when a datagram came, however late it is read; Python has no name for it."""
_TIMESPEC = struct.Struct("@ll")


@dataclass(frozen=True, slots=True)
class Crossing:
    """One datagram and when it came, ns of the monotonic clock."""

    at_ns: int
    data: bytes


class WireTap:
    """Passes datagrams on at once and keeps each, in order.

    The vehicle sends to `vehicle_port`; what it says before `connect` names the station's port is
    dropped, and not kept.  `hear` is told of every datagram towards the vehicle as it passes.
    """

    def __init__(self, hear: Callable[[Crossing], None] | None = None) -> None:
        self.to_station: list[Crossing] = []
        self.to_vehicle: list[Crossing] = []
        self._hear = hear
        self._wall_minus_monotonic_ns = time.time_ns() - time.monotonic_ns()
        self._vehicle_side = _socket()
        self._station_side = _socket()
        self._vehicle: tuple[str, int] | None = None
        self._station: tuple[str, int] | None = None
        self._passing = threading.Lock()
        self._silent = False
        self._wake, self._woken = socket.socketpair()
        self._thread = threading.Thread(target=self._run, name="wire-tap")

    def __enter__(self) -> WireTap:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._wake.send(b".")
        self._thread.join()
        for each in (self._vehicle_side, self._station_side, self._wake, self._woken):
            each.close()

    @property
    def vehicle_port(self) -> int:
        return int(self._vehicle_side.getsockname()[1])

    def connect(self, station_port: int) -> None:
        self._station = ("127.0.0.1", station_port)

    def silence_vehicle(self) -> None:
        """From the return of this call on nothing of the vehicle's reaches the station."""
        with self._passing:
            self._silent = True

    def say_to_station(self, data: bytes) -> None:
        """A datagram in the vehicle's name."""
        with self._passing:
            assert self._station is not None
            made_up = Crossing(time.monotonic_ns(), data)
            self._pass(self._station_side, self._station, made_up, self.to_station)

    def say_to_vehicle(self, data: bytes) -> None:
        """A datagram in the station's name."""
        with self._passing:
            assert self._vehicle is not None
            made_up = Crossing(time.monotonic_ns(), data)
            self._pass(self._vehicle_side, self._vehicle, made_up, self.to_vehicle)

    def drained(self) -> None:
        """Returns once everything that was sent before the call has passed."""
        while select.select([self._vehicle_side, self._station_side], [], [], 0)[0]:
            time.sleep(0.001)
        with self._passing:
            return

    def _run(self) -> None:
        while True:
            sides = [self._woken, self._vehicle_side, self._station_side]
            readable, _, _ = select.select(sides, [], [])
            if self._woken in readable:
                return
            with self._passing:
                if self._station_side in readable:
                    self._from_station()
                if self._vehicle_side in readable:
                    self._from_vehicle()

    def _from_station(self) -> None:
        with contextlib.suppress(OSError):  # what was sent before had nobody to go to
            crossing, _ = self._read(self._station_side)
            if self._vehicle is not None:
                self._pass(self._vehicle_side, self._vehicle, crossing, self.to_vehicle)
                if self._hear is not None:
                    self._hear(self.to_vehicle[-1])

    def _from_vehicle(self) -> None:
        with contextlib.suppress(OSError):
            crossing, self._vehicle = self._read(self._vehicle_side)
            if self._station is not None and not self._silent:
                self._pass(self._station_side, self._station, crossing, self.to_station)

    def _read(self, side: socket.socket) -> tuple[Crossing, tuple[str, int]]:
        data, told, _, sender = side.recvmsg(READ_BYTES, socket.CMSG_SPACE(_TIMESPEC.size))
        at_ns = time.monotonic_ns()
        for level, kind, value in told:
            if (level, kind) == (socket.SOL_SOCKET, SO_TIMESTAMPNS):
                seconds, rest_ns = _TIMESPEC.unpack(value)
                at_ns = seconds * 1_000_000_000 + rest_ns - self._wall_minus_monotonic_ns
        return Crossing(at_ns, data), sender

    @staticmethod
    def _pass(
        side: socket.socket, to: tuple[str, int], crossing: Crossing, kept: list[Crossing]
    ) -> None:
        kept.append(crossing)
        with contextlib.suppress(ConnectionRefusedError):
            side.sendto(crossing.data, to)


def _socket() -> socket.socket:
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, RECEIVE_BUFFER_BYTES)
    if sys.platform == "linux":
        made.setsockopt(socket.SOL_SOCKET, SO_TIMESTAMPNS, 1)
    made.bind(("127.0.0.1", 0))
    made.setblocking(False)
    return made
