"""What must not be overlooked: alarms that stay on the screen until a key acknowledges them.

An alarm rings when it is raised, and again while it stands and nobody has acknowledged it.  One
that is over stays too, marked so: what has happened is to be known.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Final

from gcs import ipc
from gcs.gate.condition import Condition
from gcs.gate.states import State

NAMES: Final[dict[str, str]] = {
    Condition.GPS_LOST: "GPS LOST",
    Condition.ESTIMATOR_UNRELIABLE: "ESTIMATOR",
    Condition.BATTERY_CRITICAL: "BATTERY CRITICAL",
    Condition.BATTERY_LOW: "BATTERY LOW",
    Condition.FENCE_BREACHED: "FENCE BREACHED",
    Condition.VEHICLE_FENCE_BREACHED: "VEHICLE'S FENCE BREACHED",
    Condition.VEHICLE_FAILSAFE_ACTIVE: "FAILSAFE",
    Condition.TOO_CLOSE: "TOO CLOSE",
    Condition.LINK_POOR: "LINK POOR",
    Condition.OTHER_STATION: "OTHER STATION",
    Condition.RECORDER_FAILED: "NOT RECORDED",
}
"""Conditions that are alarms.  The others are shown, and ring nothing."""
LINK_LOST: Final = "LINK LOST"
POSITION_OLD: Final = "POSITION OLD"
CONTROL_LOST: Final = "CONTROL LOST"
STATION_LOST: Final = "STATION LOST"
OF_ALL: Final = frozenset({NAMES[Condition.RECORDER_FAILED], NAMES[Condition.OTHER_STATION]})
"""No vehicle's own."""
AT_ONCE: Final = frozenset({CONTROL_LOST})
"""Events, not states: over as soon as they are raised, and still to be acknowledged."""

OURS: Final = frozenset(
    state.name
    for state in (
        State.TAKING_OFF, State.HOVERING, State.VERIFYING, State.MOVING, State.STREAMING,
        State.TAKING_PICTURE, State.FLYING_MISSION,
    )
)  # fmt: skip
"""The vehicle flies what the station asked for; from there only somebody else makes it EXTERNAL."""
BELL_AGAIN_S: Final = 5.0


@dataclass(slots=True)
class Alarm:
    name: str
    since_ns: int
    standing: bool = True
    seen: bool = False
    """Acknowledged."""


@dataclass(slots=True)
class Alarms:
    """By name, the oldest first."""

    _all: dict[str, Alarm] = field(default_factory=dict)
    _now_ns: int = 0
    _new: bool = False
    _rung_s: float = -math.inf
    _states: dict[int, str] = field(default_factory=dict)
    """Of the other vehicles, as they were told last."""
    _sysid: int = 0
    """Of the vehicle that is shown, where there are others."""

    def told(self, event: ipc.Event, *, lost: bool) -> None:
        """`lost`: a vehicle was heard and is not heard any more."""
        match event:
            case ipc.Snapshot():
                self._now_ns = event.time_ns
                self._stand(_standing(event, lost=lost))
                self._sysid = event.sysid if event.others else 0
                self._look_at_others(event.others)
            case ipc.StateEvent(before=before, after=State.EXTERNAL.name) if before in OURS:
                self._raise(_numbered(self._sysid, CONTROL_LOST) if self._sysid else CONTROL_LOST)
            case _:
                pass

    def _look_at_others(self, others: list[ipc.OtherVehicle]) -> None:
        """Of a vehicle that is not shown no change of state is told, but its state is."""
        for each in others:
            before = self._states.get(each.vehicle)
            if each.state == State.EXTERNAL.name and before in OURS:
                self._raise(f"{each.vehicle}: {CONTROL_LOST}")
        self._states = {each.vehicle: each.state for each in others}

    def station_lost(self) -> None:
        self._raise(STATION_LOST)

    def acknowledge(self) -> bool:
        """Whether there was anything to acknowledge."""
        open_ = self.open
        self._all = {name: each for name, each in self._all.items() if each.standing}
        for each in self._all.values():
            each.seen = True
        return bool(open_)

    @property
    def open(self) -> list[Alarm]:
        """Those that nobody has acknowledged."""
        return [each for each in self._all.values() if not each.seen]

    def rings(self, now_s: float) -> bool:
        """Whether the bell is to ring now."""
        waits = any(each.standing or _at_once(each.name) for each in self.open)
        due = self._new or (waits and now_s - self._rung_s >= BELL_AGAIN_S)
        self._new = False
        if due:
            self._rung_s = now_s
        return due

    def words(self) -> str:
        """`GPS LOST 12 s · BATTERY LOW (over)`; empty where there is none."""
        return " · ".join(self._words_of(each) for each in self.open)

    def _words_of(self, alarm: Alarm) -> str:
        if _at_once(alarm.name) or alarm.name == STATION_LOST:
            return alarm.name
        if not alarm.standing:
            return f"{alarm.name} (over)"
        return f"{alarm.name} {max(0, self._now_ns - alarm.since_ns) / 1e9:.0f} s"

    def _stand(self, names: list[str]) -> None:
        for name in names:
            self._raise(name)
        for name, each in list(self._all.items()):
            if name not in names and name != STATION_LOST:
                each.standing = False
                if each.seen:
                    del self._all[name]

    def _raise(self, name: str) -> None:
        known = self._all.get(name)
        if known is not None and known.standing:
            return
        self._all[name] = Alarm(name, self._now_ns)
        self._new = True


def _standing(seen: ipc.Snapshot, *, lost: bool) -> list[str]:
    """Of several vehicles each with its number; the record is that of all."""
    if not seen.others:
        return _of_shown(seen, lost=lost)
    names = [_numbered(seen.sysid, name) for name in _of_shown(seen, lost=lost)]
    for each in seen.others:
        gone = each.state == State.NO_VEHICLE.name
        old = [POSITION_OLD] if each.state == State.STALE.name and each.armed else []
        told = [*([LINK_LOST] if gone else old), *(NAMES[c] for c in NAMES if c in each.conditions)]
        names += [_numbered(each.vehicle, name) for name in told]
    return list(dict.fromkeys(names))


def _at_once(name: str) -> bool:
    return name.partition(": ")[2] in AT_ONCE or name in AT_ONCE


def _numbered(sysid: int, name: str) -> str:
    return name if name in OF_ALL else f"{sysid}: {name}"


def _of_shown(seen: ipc.Snapshot, *, lost: bool) -> list[str]:
    """Nothing is known of a vehicle that was never heard; of one that is lost only that."""
    names = [NAMES[each] for each in NAMES if each in seen.conditions]
    if not seen.vehicle:
        return [each for each in names if each == NAMES[Condition.RECORDER_FAILED]]
    if lost:
        return [LINK_LOST, *names]
    old = seen.state == State.STALE.name and seen.armed  # before it is armed it may yet come
    return [POSITION_OLD, *names] if old else names
