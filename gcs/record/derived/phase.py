"""/vehicle/N/phase: what a state bar shows.

Viewers hide labels that overlap, and the first one wins: a state of some milliseconds would name
the long one after it.  Here a value stands for `SHORTEST_NS` before it is told; what was shorter is
on /vehicle/N/fsa and in the log only.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import msgspec

from gcs.record.derived.json_topic import JsonTopic
from gcs.record.topics import Deriver, Out
from gcs.report import FsaItem, InputItem, PoseItem, RecordItem, StatusItem

SHORTEST_NS = 400_000_000
PERIOD_NS = 1_000_000_000
NEVER_NS = 1 << 62
_CLOCKS = frozenset({PoseItem, InputItem})
"""Items that only tell that time passes."""


class Phase(msgspec.Struct, frozen=True):
    """Each value as it stood for at least 0.4 s: the gate's state, who controls, what is wrong."""

    state: str = ""
    control: str = ""
    severity: str = ""
    mode: str = ""
    landed: str = ""


@dataclass(slots=True)
class Debounced:
    """A value that counts once it has stood for `SHORTEST_NS`; the first one counts at once."""

    value: str = ""
    newest: str = ""
    since_ns: int = 0

    def see(self, value: str, now_ns: int) -> bool:
        """Whether `value`, which holds now, changes what counts."""
        if value != self.newest:
            self.newest, self.since_ns = value, now_ns
        if self.newest == self.value or (self.value and now_ns - self.since_ns < SHORTEST_NS):
            return False
        self.value = self.newest
        return True

    @property
    def due_ns(self) -> int:
        """When the newest value counts, if it stays."""
        return NEVER_NS if self.newest == self.value else self.since_ns + SHORTEST_NS


@dataclass(slots=True)
class _Vehicle:
    topic: JsonTopic
    newest: dict[str, str] = field(default_factory=dict)
    shown: dict[str, Debounced] = field(default_factory=dict)
    sent_ns: int = 0

    @property
    def due_ns(self) -> int:
        """When the next value will have stood long enough, if it stays."""
        return min((each.due_ns for each in self.shown.values()), default=NEVER_NS)

    def settle(self, now_ns: int) -> bool:
        """Whether a value has stood long enough to be told."""
        changed = False
        for name, value in self.newest.items():
            shown = self.shown.get(name)
            if shown is None:
                shown = self.shown[name] = Debounced()
            changed |= shown.see(value, now_ns)
        return changed

    def out(self, now_ns: int) -> Out:
        self.sent_ns = now_ns
        return self.topic.out(Phase(**{name: one.value for name, one in self.shown.items()}))


class Phases(Deriver):
    """On change, every second and at the end.  Poses and inputs only tell that time passes."""

    takes: ClassVar = frozenset({FsaItem, StatusItem, PoseItem, InputItem})

    def __init__(self) -> None:
        self._vehicles: dict[int, _Vehicle] = {}
        self._due_ns = NEVER_NS
        """Before this nothing comes to count by time alone."""

    def handle(self, item: RecordItem, now_ns: int) -> list[Out]:
        if type(item) in _CLOCKS and now_ns < self._due_ns:
            return []
        match item:
            case FsaItem(sysid):
                seen = {"state": item.state, "control": item.control, "severity": item.severity}
                self._vehicle(sysid).newest.update(seen)
            case StatusItem(sysid):
                self._vehicle(sysid).newest.update(mode=item.mode, landed=item.landed)
            case _:
                pass
        return self._settled(now_ns)

    def _settled(self, now_ns: int) -> list[Out]:
        vehicles = self._vehicles.values()
        outs = [vehicle.out(now_ns) for vehicle in vehicles if vehicle.settle(now_ns)]
        self._due_ns = min((vehicle.due_ns for vehicle in vehicles), default=NEVER_NS)
        return outs

    def tick(self, now_ns: int) -> list[Out]:
        return [
            vehicle.out(now_ns)
            for vehicle in self._vehicles.values()
            if vehicle.settle(now_ns) or now_ns - vehicle.sent_ns >= PERIOD_NS
        ]

    def close(self, now_ns: int) -> list[Out]:
        """A state that the flight ended in before it stood long enough is shown all the same."""
        for vehicle in self._vehicles.values():
            vehicle.settle(now_ns + SHORTEST_NS)
        return [vehicle.out(now_ns) for vehicle in self._vehicles.values()]

    def _vehicle(self, sysid: int) -> _Vehicle:
        known = self._vehicles.get(sysid)
        if known is None:
            topic = JsonTopic(f"/vehicle/{sysid}/phase", "vehicle.Phase", Phase)
            known = self._vehicles[sysid] = _Vehicle(topic)
        return known
