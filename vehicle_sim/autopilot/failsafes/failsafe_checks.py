"""What triggers a failsafe, in either autopilot: the common part.

Each is reported once, when it begins; `failsafe_actions.py` decides which of several wins.
Silence of the other side is measured in wall time, everything else in simulated time.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

from vehicle_sim.autopilot.failsafes.failsafe import Cause, Charge, Failsafe
from vehicle_sim.autopilot.fence.geofence import Crossing
from vehicle_sim.autopilot.interface import Power
from vehicle_sim.autopilot.modes import Mode
from vehicle_sim.autopilot.parameters.parameters import Parameters, Quantity
from vehicle_sim.control_loops.believed import Believed
from vehicle_sim.estimation.estimated import Estimated
from vehicle_sim.estimation.estimator import Health
from vehicle_sim.plant.sensed import Sensed


@dataclass(slots=True)
class Seen:
    """All that the failsafes look at, at 10 Hz while armed.

    `needs_position`: what the mode flies now cannot be flown without one.  `sticks`: there are
    some now; `sticks_lost`: there were some, and are none now.
    """

    time_ns: int
    wall_ns: int
    mode: Mode
    flying: bool
    needs_position: bool
    power: Power
    remaining: float
    health: Health
    sticks: bool
    sticks_lost: bool
    crossing: Crossing


@dataclass(frozen=True, slots=True)
class Cleared:
    """What triggered a failsafe has gone; what the autopilot says about it, if anything."""

    cause: Cause
    text: str = ""
    severity: int = 6


FailsafeEvent: TypeAlias = Failsafe | Cleared


class FailsafeChecks(ABC):
    """Remembers what was triggered, so that each is told and acted on once.

    There are two looks at the same thresholds, which `_learn` takes from the parameters: `nominal`,
    quick, at what is measured, and `check`, thorough, at what is made of it.
    """

    __slots__ = (
        "_believed",
        "_charge",
        "_first",
        "_parameters",
        "_station_limit_ns",
        "_station_ns",
        "_version",
        "battery_failed",
        "position_lost",
        "station_lost",
        "sticks_lost",
    )

    back_again: Cleared
    """What is said when the ground station is heard again."""

    def __init__(self, parameters: Parameters, believed: Believed) -> None:
        self._parameters = parameters
        self._believed = believed
        self._version = -1
        self._station_ns: int | None = None
        self.station_lost = False
        self.restart()

    def restart(self) -> None:
        """As after power-up."""
        self.battery_failed = False
        self.reset()

    def reset(self) -> None:
        """Disarmed: what is triggered from the next arming on is new."""
        self._charge = Charge.FINE
        self._first = True
        self.position_lost = False
        self.sticks_lost = False

    def station_heard(self, wall_ns: int) -> Cleared | None:
        """A heartbeat came."""
        back = self.station_lost
        self._station_ns = wall_ns
        self.station_lost = False
        return self.back_again if back else None

    def nominal(self, wall_ns: int, sensed: Sensed, est: Estimated, sticks_lost: bool) -> bool:
        """Whether `check` would find nothing, the fence aside, and change nothing.

        Nearly always so, and much cheaper than to check.
        """
        if self._first or sticks_lost or self.sticks_lost or self.position_lost:
            return False
        self._look_up()
        return not self._silent(wall_ns) and self._within_limits(sensed, est)

    def _look_up(self) -> None:
        """The thresholds, if a parameter has changed."""
        if self._version != self._parameters.version:
            self._version = self._parameters.version
            self._station_limit_ns = int(self._parameters.si(Quantity.STATION_LOSS_S) * 1e9)
            self._learn()

    def _silent(self, wall_ns: int) -> bool:
        """Whether a station that was there has been silent for too long, and nobody was told."""
        if self._station_ns is None or self.station_lost:
            return False
        return wall_ns - self._station_ns >= self._station_limit_ns

    @abstractmethod
    def _learn(self) -> None:
        """Parameters have changed."""

    @abstractmethod
    def _within_limits(self, sensed: Sensed, est: Estimated) -> bool:
        """Battery and position are far from any failsafe."""

    def check(self, seen: Seen) -> list[FailsafeEvent]:
        """What is triggered and what is cleared now, in no order of weight."""
        self._look_up()
        begun: list[FailsafeEvent] = []
        if self._first:
            self._first = False
            begun = list(self._begin(seen))
        return [
            *begun,
            *self._battery(seen),
            *self._station(seen),
            *self._sticks(seen),
            *self._fence(seen),
            *self._position(seen),
        ]

    @abstractmethod
    def _begin(self, seen: Seen) -> Iterator[FailsafeEvent]:
        """Just armed: what is wrong already was accepted with it, and may be told."""

    @abstractmethod
    def _battery(self, seen: Seen) -> Iterator[FailsafeEvent]: ...

    @abstractmethod
    def _station(self, seen: Seen) -> Iterator[FailsafeEvent]: ...

    @abstractmethod
    def _sticks(self, seen: Seen) -> Iterator[FailsafeEvent]: ...

    @abstractmethod
    def _fence(self, seen: Seen) -> Iterator[FailsafeEvent]: ...

    @abstractmethod
    def _position(self, seen: Seen) -> Iterator[FailsafeEvent]: ...

    def check_disarmed(self, wall_ns: int, power: Power, remaining: float) -> Iterator[Failsafe]:
        """What is only told, once each, while nothing can be done about it."""
        self._look_up()
        if self._station_gone(wall_ns):
            yield from self._station_words()
        yield from self._battery_words(power, remaining)

    @abstractmethod
    def _station_words(self) -> Iterator[Failsafe]:
        """What is said of a lost station before anything is done about it."""

    @abstractmethod
    def _battery_words(self, power: Power, remaining: float) -> Iterator[Failsafe]:
        """What is said of a low battery while disarmed."""

    def _station_gone(self, wall_ns: int) -> bool:
        """Whether the silence has just become too long; from now on the station is lost."""
        gone = self._silent(wall_ns)
        self.station_lost = self.station_lost or gone
        return gone
