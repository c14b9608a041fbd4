"""What operators are shown: each the vehicle of its choice, what was before, and the record."""

from __future__ import annotations

import msgspec

from gcs import ipc
from gcs.gate.condition import Condition, Severity
from gcs.gate.effects import Level
from gcs.gate.states import Control, State
from gcs.session.effects import Emit
from gcs.session.inputs import DiskLow, OperatorJoined, RecorderChanged, RecorderGrew
from gcs.session.setup import Setup
from gcs.session.work import Log, Work, condition
from gcs.station.fleet.neighbours import others_of
from gcs.station.history import History
from gcs.station.operators import Operators
from gcs.station.vehicles import FIRST as FIRST_SLOT
from gcs.station.vehicles import Vehicles
from gcs.vehicle.record_items import hello
from gcs.vehicle.snapshot import snapshot
from gcs.vehicle.vehicle import Vehicle

NODE = "recorder"


class RecordKept:
    """The record, as the shell tells of it; `path` empty and not `on` where none is kept."""

    def __init__(self, path: str) -> None:
        self.path = path
        self.on = bool(path)
        self.size_bytes = 0
        self.free_bytes: int | None = None
        """On its disk."""

    def changed(self, news: RecorderChanged) -> list[Work]:
        self.on, self.path = news.recording, news.path
        level = Level.INFO if news.recording else Level.ERROR
        failed = condition(Condition.RECORDER_FAILED, not news.recording, news.text)
        return [Log(level, NODE, news.text), failed]

    def grew(self, news: RecorderGrew) -> None:
        self.size_bytes = news.size_bytes
        if not isinstance(news.free_bytes, msgspec.UnsetType):
            self.free_bytes = news.free_bytes

    def disk_low(self, news: DiskLow) -> Log:
        """The warning, while there is still time to make room."""
        self.free_bytes = news.free_bytes
        left = "" if news.left_s is None else f", for {news.left_s / 60:.0f} min at this rate"
        text = f"the disk of the record has {news.free_bytes / 1e6:.0f} MB left{left}"
        return Log(Level.ERROR if news.critical else Level.WARNING, NODE, text)


class Shown:
    """Snapshots, trails and what is on board, to whom they are shown."""

    def __init__(
        self, setup: Setup, vehicles: Vehicles, operators: Operators, record: RecordKept
    ) -> None:
        self._setup = setup
        self._vehicles = vehicles
        self._operators = operators
        self._record = record
        self._histories = [History()]
        """Of each vehicle, by its slot; the first one's has the lines of the log."""

    def welcome(self, joined: OperatorJoined, now_ns: int) -> list[Work]:
        """What everybody else knows already, for one that has just joined."""
        operator, fence = joined.operator, self._vehicles.first.port.fence_shapes
        return [
            Emit(hello(self._setup, self._record.path, fence, operator), operator),
            Emit(self._snapshot(self._vehicles.first, now_ns), operator),
            *(Emit(event, operator) for event in self._histories[FIRST_SLOT].told()),
            *self._operators.join(operator, joined.name, joined.hold_on_leave),
        ]

    def show(self, operator: int, sysid: int, now_ns: int) -> list[Work]:
        """What was before of the vehicle that it is shown from now on; a trail without the log,
        which it has."""
        self._operators.screens.show(operator, sysid)
        slot = self._vehicles.slot_of(sysid) if sysid else FIRST_SLOT
        if slot is None:
            return [Emit(self._snapshot(None, now_ns), operator)]
        vehicle = self._vehicles.of_owner(slot)
        history = self._history(slot)
        told: list[ipc.Event] = [
            ipc.Fences(vehicle.port.fence_shapes),
            self._snapshot(vehicle, now_ns),
            history.way(),
            *history.on_board.all,
        ]
        return [Emit(event, operator) for event in told]

    def logged(self, line: Log, now_ns: int, prefix: str) -> None:
        """A line of the log, with what names its vehicle."""
        self._histories[FIRST_SLOT].logged(line, now_ns, prefix)

    def ten_times_a_second(self, now_ns: int) -> list[Work]:
        """What screens are told ten times a second."""
        work = self.to_each_screen(now_ns)
        for slot, vehicle in enumerate(self._vehicles):
            for event in self._history(slot).on_board.news(vehicle):
                work += self.to_screens(event, slot)
        return [*work]

    def to_each_screen(self, now_ns: int) -> list[Emit]:
        """To each operator that of the vehicle that it is shown."""
        told: list[Emit] = []
        for slot, vehicle in enumerate(self._vehicles):
            seen = self._snapshot(vehicle, now_ns)
            self._history(slot).seen(seen)
            told += self.to_screens(seen, slot)
        met = frozenset(vehicle.sysid for vehicle in self._vehicles)
        for operator in self._operators.screens.elsewhere(met):
            told.append(Emit(self._snapshot(None, now_ns), operator))
        return told

    def to_screens(self, event: ipc.Event, slot: int) -> list[Emit]:
        sysid = self._vehicles.of_owner(slot).sysid
        return self._operators.screens.tell(event, sysid, first=slot == FIRST_SLOT)

    def _history(self, slot: int) -> History:
        while len(self._histories) <= slot:
            self._histories.append(History())
        return self._histories[slot]

    def _snapshot(self, vehicle: Vehicle | None, now_ns: int) -> ipc.Snapshot:
        """None: of one that was not met."""
        first = self._vehicles.first
        of_station = ipc.Snapshot(
            time_ns=now_ns,
            state=State.NO_VEHICLE.name,
            control=Control.NONE.name,
            severity=Severity.NOMINAL.name,
            conditions=[],
            lost_pct=0.0,
            log_path=self._record.path,
            recording=self._record.on,
            recorded_mb=self._record.size_bytes / 1e6,
            vehicles=self._vehicles.heard_names(now_ns),
            listening=first.listening(now_ns),
            in_control=self._operators.in_control,
            others=others_of(self._vehicles, vehicle),
        )
        if vehicle is None:
            return of_station
        total, losses = vehicle.missions.total, vehicle.presence.losses
        return snapshot(of_station, vehicle.gate, vehicle.telemetry, total, losses)
