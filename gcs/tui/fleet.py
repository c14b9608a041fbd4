"""Several vehicles on one screen, of which it shows one: what is told of all of them."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

from gcs import ipc
from gcs.gate.condition import Condition
from gcs.gate.states import LandedState, State
from gcs.tui.keyboard import PendingGoal


class Mind(NamedTuple):
    """What an operator has in mind for a vehicle, while another one is shown."""

    pending: PendingGoal = PendingGoal()
    pending_set: bool = False
    fence_on: bool = True
    climbs: bool = False


@dataclass(slots=True)
class Minds:
    """By the system ids of the vehicles."""

    _of: dict[int, Mind] = field(default_factory=dict)

    def swap(self, before: int, mind: Mind, now: int) -> Mind:
        """Keep the one of the vehicle that was shown; the one of the vehicle that is from now on,
        with the same step."""
        self._of[before] = mind
        return self._of.get(now, Mind(PendingGoal(step_m=mind.pending.step_m)))


class Mark(NamedTuple):
    """A vehicle in the header."""

    sysid: int
    severity: str
    shown: bool
    lost: bool


def marks(seen: ipc.Snapshot) -> list[Mark]:
    """Every vehicle by its number; none where there is one alone."""
    lost = seen.state == State.NO_VEHICLE.name
    shown = [Mark(seen.sysid, seen.severity, shown=True, lost=lost)] if seen.vehicle else []
    others = [
        Mark(each.vehicle, each.severity, shown=False, lost=each.state == State.NO_VEHICLE.name)
        for each in seen.others
    ]
    return sorted(shown + others) if seen.others else []


def next_of(seen: ipc.Snapshot) -> int:
    """The vehicle with the next number, after the last the first; 0: there is no other."""
    numbers = [each.vehicle for each in seen.others]
    return min((each for each in numbers if each > seen.sysid), default=min(numbers, default=0))


def flying(seen: ipc.Snapshot) -> int:
    """How many are in the air and heard."""
    on_ground = [seen.landed == LandedState.ON_GROUND.name, *(x.on_ground for x in seen.others)]
    return sum(up and not down for up, down in zip(_armed(seen), on_ground, strict=True))


def armed(seen: ipc.Snapshot) -> int:
    """How many are armed and heard, on the ground or in the air."""
    return sum(_armed(seen))


def _armed(seen: ipc.Snapshot) -> list[bool]:
    """Of each, the one that is shown first."""
    all_: list[ipc.Snapshot | ipc.OtherVehicle] = [seen, *seen.others]
    return [bool(each.armed) and each.state != State.NO_VEHICLE.name for each in all_]


def too_close(other: ipc.OtherVehicle) -> bool:
    return Condition.TOO_CLOSE in other.conditions
