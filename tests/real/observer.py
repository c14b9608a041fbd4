"""Sees the truth on a link of its own, and acts there as whatever the gate does not know of:
another ground station, the wind, a GPS receiver that fails."""

import math
import struct
import threading
import time
from collections.abc import Callable
from typing import Any

from tests.real.autopilots import PX4, Kind
from tests.real.link import Link
from tests.real.truth import MESSAGES, RADIUS_M, Vector

OTHER_STATION = 250  # its system id
GLOBAL_RELATIVE = 6  # MAV_FRAME_GLOBAL_RELATIVE_ALT_INT


class Observer(Link):
    def __init__(self, kind: Kind, port: int) -> None:
        super().__init__(kind, port, OTHER_STATION)
        self.off_m: list[float] = []  # of the vehicle's own position, beside each of the truth's
        self.home_local: Vector | None = None  # in the frame of the goals: east, north, up
        # The truth, each sample from the home of its moment: a PX4 that has landed has another.
        self.flown_from_home: list[Vector] = []
        self.home_truth: Vector | None = None  # the same place in the truth's; up: as it stood
        self.estimate: Vector | None = None  # in the truth's frame; up is above home
        self._ended = False
        self._thread = threading.Thread(target=self._run, daemon=True)

    def start(self, seconds: float) -> bool:
        """Whether the truth came in time."""
        if self.mavlink.wait_heartbeat(timeout=seconds) is None:
            return False
        self._thread.start()
        end = time.monotonic() + seconds
        while not (self.truth.samples and self.home_local) and time.monotonic() < end:
            hertz = {30: 10.0, 33: 10.0, 242: 1.0, **dict.fromkeys(MESSAGES.values(), 50.0)}
            for number, rate in hertz.items():
                self.command(511, number, 1e6 / rate)
            self.wait(lambda: bool(self.truth.samples and self.home_local), 2.0)
        return bool(self.truth.samples and self.home_local)

    def close(self) -> None:
        self._ended = True
        if self._thread.is_alive():
            self._thread.join()
        self.mavlink.close()

    def _run(self) -> None:
        while not self._ended:
            message = self.mavlink.recv_match(blocking=True, timeout=0.2)
            if message is not None:
                self.take(message)

    def take(self, message: Any) -> None:
        super().take(message)
        if self.home_truth is not None:
            new = self.truth.samples[len(self.flown_from_home) :]
            self.flown_from_home += [self.from_home(sample.position_enu) for sample in new]
        match message.get_type():
            case "HOME_POSITION" if self.truth.samples:
                east, north, _ = self.truth.enu(message.latitude / 1e7, message.longitude / 1e7, 0)
                self.home_truth = (east, north, 0.0)
                self.home_local = (message.y, message.x, -message.z)
            case "GLOBAL_POSITION_INT" if self.truth.samples and self.home_truth and message.lat:
                east, north, _ = self.truth.enu(message.lat / 1e7, message.lon / 1e7, 0)
                self.estimate = (east, north, message.relative_alt / 1e3)
                here = self.position
                self.off_m.append(
                    math.hypot(*(a - b for a, b in zip(self.estimate[:2], here[:2], strict=True)))
                )

    # -- what is seen -------------------------------------------------------------------------

    @property
    def position(self) -> Vector:
        """The truth."""
        return self.truth.now.position_enu

    def from_home(self, position: Vector) -> Vector:
        assert self.home_truth is not None
        home = self.home_truth
        return (position[0] - home[0], position[1] - home[1], position[2] - home[2])

    def get(self, name: str) -> float | None:
        """A parameter of the vehicle, as it tells it now."""
        self.mavlink.messages.pop("PARAM_VALUE", None)
        for _ in range(5):
            self.mavlink.mav.param_request_read_send(1, 1, name.encode(), -1)
            self.wait(lambda: self._told(name) is not None, 1.0)
            if (told := self._told(name)) is not None:
                return told
        return None

    def _told(self, name: str) -> float | None:
        told = self.mavlink.messages.get("PARAM_VALUE")
        if told is None or told.param_id != name:
            return None
        if self.kind is PX4 and told.param_type == 6:  # the bytes of an integer
            return float(struct.unpack("<i", struct.pack("<f", told.param_value))[0])
        return float(told.param_value)

    def on_map(self, from_home: Vector) -> tuple[float, float]:
        """Latitude and longitude of a place."""
        assert self.truth.origin is not None
        assert self.home_truth is not None
        lat0, lon0, _ = self.truth.origin
        metres = math.radians(1.0) * RADIUS_M
        lat = lat0 + (from_home[1] + self.home_truth[1]) / metres
        lon = lon0 + (from_home[0] + self.home_truth[0]) / metres / math.cos(math.radians(lat0))
        return lat, lon

    def wait(self, condition: Callable[[], bool], seconds: float) -> bool:
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                return False
            time.sleep(0.02)
        return True

    def at_rest(self, seconds: float = 60.0) -> bool:
        """Waits until it has been slow for two seconds; a hovering PX4 SIH wanders by 0.5 m/s."""
        since = time.monotonic()

        def slow() -> bool:
            nonlocal since
            if self.now.speed_m_s > 0.6:
                since = time.monotonic()
            return time.monotonic() - since > 2.0

        return self.wait(slow, seconds)

    # -- what it does -------------------------------------------------------------------------

    def set(self, name: str, value: float, *, integer: bool = False) -> None:
        """A parameter of the simulation."""
        if integer and self.kind is PX4:
            # PX4 takes the bytes of an integer for the float.
            value = struct.unpack("<f", struct.pack("<i", int(value)))[0]
        kind = 6 if integer else 9
        for _ in range(3):
            self.mavlink.mav.param_set_send(1, 1, name.encode(), value, kind)
            time.sleep(0.1)

    def fly_to(self, from_home: Vector, seconds: float = 60.0) -> bool:
        """Brings it there past the gate, as another station would, and lets it hold."""
        lat, lon = self.on_map(from_home)
        if self.kind is not PX4:
            # A station that streams in GUIDED gives up control when it sees another mode, and
            # sees to it for a second or two that it is a hold.
            self.mode(self.kind.hold_custom_mode)
            self.wait(lambda: self.custom_mode == self.kind.hold_custom_mode, 3.0)
            time.sleep(2.0)
            self.mode(self.kind.guided_custom_mode)
            time.sleep(0.5)
        frame, up = GLOBAL_RELATIVE, from_home[2]
        if self.kind is PX4:  # which takes the height above the sea
            fix = self.mavlink.messages["HOME_POSITION"]
            frame, up = 5, up + fix.altitude / 1e3
        self.mavlink.mav.command_int_send(
            1, 1, frame, 192, 0, 0, -1.0, 1.0, 0.0, math.nan, round(lat * 1e7), round(lon * 1e7), up
        )
        there = self.wait(
            lambda: math.dist(self.from_home(self.position), from_home) < 2.5, seconds
        )
        self.mode(self.kind.hold_custom_mode)
        self.at_rest(20.0)
        return there
