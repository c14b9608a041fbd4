"""One vehicle, its link under test, its observer, and the pilot of the moment."""

import subprocess
import time
from pathlib import Path

from tests.real import autopilots
from tests.real.autopilots import GROUND_PORT, ONBOARD_PORT, PX4, Kind
from tests.real.observer import Observer
from tests.real.pilots import STATION_PORT, Bridge, Library, OneShot, outcome_of
from tests.real.relay import Relay
from tests.real.rows import HEIGHT_M, Row
from tests.real.truth import Vector

POLICY = """name = "real"
retarget = "{retarget}"
[[fence]]
name = "yard"
kind = "circle"
inclusion = true
frame = "home"
centre = [0.0, 0.0]
radius_m = {radius}
floor_up_m = 0.0
ceiling_up_m = {ceiling}
"""
START_S = 90.0


class NotReadyError(Exception):
    """The vehicle cannot be brought to where a row begins."""


class Flight:
    def __init__(self, kind: Kind, folder: Path, seed: int) -> None:
        self.kind, self.folder = kind, folder
        folder.mkdir(parents=True)
        self.vehicle: subprocess.Popen[bytes] = autopilots.start(kind, folder / "vehicle")
        # PX4 has a set of streams for either link, so the station gets the one that is its own.
        under_test, beside = (
            (ONBOARD_PORT, GROUND_PORT) if kind is PX4 else (GROUND_PORT, ONBOARD_PORT)
        )
        self.relay = Relay(under_test, STATION_PORT, seed)
        self.observer = Observer(kind, beside)
        self._library: tuple[Path, Library] | None = None
        # Where the row that is judged begins: samples of truth, of the estimate's error, seconds.
        self.marks: tuple[int, int, float] | None = None
        try:
            if not self.observer.start(START_S):
                told = folder / "vehicle" / "output.txt"
                raise NotReadyError(f"{kind.name} tells no truth: see {told}")
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        self.relay.trouble()
        self.leave()
        self.observer.close()
        self.relay.close()
        autopilots.end(self.vehicle)

    # -- who flies ----------------------------------------------------------------------------

    def policy(self, row: Row) -> Path:
        retarget = row.trouble if row.trouble == "replace" else "clients"
        path = self.folder / f"{row.radius_m:g}_{row.ceiling_m:g}_{retarget}.toml"
        path.write_text(
            POLICY.format(radius=row.radius_m, ceiling=row.ceiling_m, retarget=retarget)
        )
        return path

    def library(self, row: Row) -> Library:
        """The same one for rows with the same fence, while it lives."""
        policy = self.policy(row)
        if self._library is not None and self._library[0] != policy:
            self.leave()
        if self._library is None:
            self._library = (policy, Library(policy, self.folder))
        return self._library[1]

    @property
    def current(self) -> Library | None:
        return None if self._library is None else self._library[1]

    def mark(self) -> None:
        """From here on the row is judged."""
        if self.marks is None:
            seen = self.observer
            self.marks = (len(seen.truth.samples), len(seen.off_m), time.monotonic())

    def leave(self) -> None:
        if self._library is not None:
            self._library[1].close()
            self._library = None

    def one_shot(self, row: Row) -> OneShot:
        self.leave()
        return OneShot(self.policy(row), self.folder)

    def joined(self, row: Row) -> OneShot:
        """Through the library's own station, of which it takes control."""
        return OneShot(self.policy(row), self.folder, "--take")

    def bridge(self, row: Row) -> Bridge:
        self.leave()
        return Bridge(self.policy(row), self.folder, self.kind)

    # -- where it is --------------------------------------------------------------------------

    @property
    def from_home(self) -> Vector:
        """The truth."""
        return self.observer.from_home(self.observer.position)

    @property
    def flying(self) -> bool:
        return self.observer.armed and self.from_home[2] > 1.0

    def local(self, from_home: Vector) -> Vector:
        """A place for a goal: the station's goals are from the local origin."""
        assert self.observer.home_local is not None
        home = self.observer.home_local
        return (from_home[0] + home[0], from_home[1] + home[1], from_home[2] + home[2])

    def land_past_the_gate(self) -> bool:
        """As another station would; again, as a station that holds may have come between."""
        observer = self.observer
        for _ in range(6):
            observer.command(21)
            if observer.wait(lambda: not observer.armed, 20.0):
                return True
        return False

    def on_ground(self, row: Row) -> None:
        """Landed and disarmed, by whatever way."""
        if self.flying or self.observer.armed:
            self.leave()
            if not self.land_past_the_gate():
                raise NotReadyError(f"does not land: {self.observer.texts[-3:]}")
        time.sleep(2.0)

    def take_off(self, row: Row, up_m: float = HEIGHT_M) -> str:
        station = self.library(row).station
        for _ in range(3):  # as an operator would; what was refused at first is told if it goes on
            done = outcome_of(lambda: station.arm(timeout_s=90.0))
            if done == "complete":
                break
            time.sleep(5.0)
        if done != "complete":
            return f"arm: {done}"
        return outcome_of(lambda: station.takeoff(up_m, timeout_s=90.0))

    def in_air_at(self, row: Row, place: Vector) -> None:
        """Brings it there past the gate, whatever the row before has left."""
        if not self.flying:
            self.on_ground(row)
            done = self.take_off(row)
            if done != "complete":
                raise NotReadyError(f"take-off: {done}; {self.observer.texts[-3:]}")
        for _ in range(3):
            if self.observer.fly_to(place, 90.0):
                self.mark()
                return
        raise NotReadyError(f"is at {self.from_home}, not at {place}: {self.observer.texts[-3:]}")
