"""The link under test: UDP datagrams between vehicle and station, delayed, lost or stopped."""

import contextlib
import heapq
import itertools
import random
import select
import socket
import threading
import time

Address = tuple[str, int]


class Relay:
    """Between the port that the vehicle sends to and the port that the station listens on."""

    def __init__(self, vehicle_port: int, station_port: int, seed: int) -> None:
        self.delay_s = 0.0  # each way
        self.loss = 0.0  # share of the datagrams, each way
        self.silent_until_s = 0.0
        self._random = random.Random(seed)
        self._station: Address = ("127.0.0.1", station_port)
        self._vehicle: Address | None = None
        self._to_vehicle = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._to_vehicle.bind(("127.0.0.1", vehicle_port))
        self._to_station = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._to_station.bind(("127.0.0.1", 0))
        self._waiting: list[tuple[float, int, bool, bytes]] = []
        self._numbers = itertools.count()
        self._ended = False
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def trouble(self, *, delay_s: float = 0.0, loss: float = 0.0, silent_s: float = 0.0) -> None:
        self.delay_s, self.loss = delay_s, loss
        self.silent_until_s = time.monotonic() + silent_s

    def close(self) -> None:
        self._ended = True
        self._thread.join()
        self._to_vehicle.close()
        self._to_station.close()

    def _run(self) -> None:
        while not self._ended:
            now = time.monotonic()
            wait = min(0.1, max(0.0, self._waiting[0][0] - now)) if self._waiting else 0.1
            readable, _, _ = select.select([self._to_vehicle, self._to_station], [], [], wait)
            for one in readable:
                # Nobody listens there yet, or no more: ICMP says so at the next call.
                with contextlib.suppress(ConnectionError):
                    data, sender = one.recvfrom(65_536)
                    self._take(data, sender, from_vehicle=one is self._to_vehicle)
            now = time.monotonic()
            while self._waiting and self._waiting[0][0] <= now:
                _, _, to_station, data = heapq.heappop(self._waiting)
                with contextlib.suppress(ConnectionError):
                    if to_station:
                        self._to_station.sendto(data, self._station)
                    elif self._vehicle is not None:
                        self._to_vehicle.sendto(data, self._vehicle)

    def _take(self, data: bytes, sender: Address, *, from_vehicle: bool) -> None:
        if from_vehicle:
            self._vehicle = sender
        now = time.monotonic()
        if now < self.silent_until_s or self._random.random() < self.loss:
            return
        entry = (now + self.delay_s, next(self._numbers), from_vehicle, data)
        heapq.heappush(self._waiting, entry)
