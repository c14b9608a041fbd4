"""The simulators that campaigns can fly: whoever is registered in `mavgate.simulators`.

An entry point of that group is a factory: a table of plain values -> a `Simulator`.  What a station
and a simulator say to each other is bytes, whole numbers of nanoseconds and tables of plain values,
so that neither knows the other's code.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from importlib.metadata import entry_points
from typing import Any, Protocol, TypeAlias

import msgspec

from gcs.frames import Vec3

GROUP = "mavgate.simulators"
REAL_TIME = "mavgate.real_time_simulators"
"""Those that a clock of their own drives, and whose flights do not repeat."""


class Simulator(Protocol):
    """One vehicle on the caller's clock.  Equal calls at equal times give equal answers."""

    @property
    def deadline_ns(self) -> int:
        """When `handle` wants to be called again at the latest."""
        ...

    def handle(self, now_ns: int, datagrams: Sequence[bytes]) -> list[bytes]:
        """Live up to `now_ns`, then take these datagrams; the datagrams that it sends."""
        ...

    def truth(self) -> Mapping[str, object]:
        """What really is, as a `Truth` can be read from."""
        ...


Factory: TypeAlias = Callable[[Mapping[str, object]], Simulator]
"""Raises ValueError for a key or a value that it cannot use: `KEY: what is wrong with it`.
`start_ns` and `seed` are in every table; the rest is what the campaign's file says."""


class RealTime(Simulator, Protocol):
    """One that begins when it is first asked for something, and ends with `close`."""

    @property
    def starved(self) -> str:
        """In which way the machine was too slow for what was flown to count; or nothing."""
        ...

    def close(self) -> None: ...


RealTimeFactory: TypeAlias = Callable[[Mapping[str, object]], RealTime]
"""As `Factory`; `instance` in its table is the number of a simulator among those that run."""


class Truth(msgspec.Struct, frozen=True, gc=False):
    """`pos_ned` [m] counts from where the vehicle stood at its start, which is `home` (degrees,
    degrees, metres above sea level); `energy_j` is what its battery has given so far, where that
    is measured at all."""

    pos_ned: Vec3
    v_ned: Vec3
    home: Vec3
    armed: bool
    landed: bool
    energy_j: float | None = None


def truth_of(simulator: Simulator) -> Truth:
    """Raises msgspec.ValidationError where it says something else."""
    return msgspec.convert(simulator.truth(), Truth)


class UnknownSimulatorError(Exception):
    """None of that name is installed; `hint` names those that are."""

    def __init__(self, name: str, known: Sequence[str]) -> None:
        super().__init__(f"simulator {name}: none of that name is installed")
        self.hint = f"installed: {', '.join(known) or 'none'}"


def factory(name: str) -> Factory:
    """Raises UnknownSimulatorError."""
    made: Factory = _loaded(GROUP, name)
    return made


def real_time_factory(name: str) -> RealTimeFactory:
    """Raises UnknownSimulatorError."""
    made: RealTimeFactory = _loaded(REAL_TIME, name)
    return made


def _loaded(group: str, name: str) -> Any:
    found = {each.name: each for each in entry_points(group=group)}
    if name not in found:
        raise UnknownSimulatorError(name, sorted(found))
    return found[name].load()
