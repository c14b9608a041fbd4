"""The rally points, or the fence, that a vehicle has on board: read, and read again.

They are read when a vehicle appears, and again whenever they may have changed:

- they were sent or cleared by us, for a client or with a mission;
- the vehicle accepted such a change from anybody (MISSION_ACK of that kind);
- it gives them another number (MISSION_CURRENT.rally_points_id, fence_id);
- its parameter with their count has another value (ArduPilot's RALLY_TOTAL, FENCE_TOTAL).

From the moment when they may change until they are read again they are not known.  What a job reads
of them is overheard, and not read once more.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from gcs.gate.effects import Level
from gcs.plan.item_messages import item_of
from gcs.plan.wire import WireItem
from gcs.protocol.effects import (
    Address,
    Heard,
    Send,
    TransferDone,
    TransferEffect,
    TransferFailed,
    Wake,
)
from gcs.protocol.mission import MissionDownload
from gcs.session.speedup_waits import Times
from gcs.session.work import Log, Work
from gcs.vehicle.missions.missions import timing_of
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.ids import MissionResult, MissionType
from gcs.wire.messages import (
    Message,
    MissionAck,
    MissionClearAll,
    MissionCount,
    MissionCurrent,
    MissionRequestList,
    ParamValue,
)

NODE = "link"
NAMES: Final = {MissionType.FENCE: "fence", MissionType.RALLY: "rally points"}
TOTALS: Final = {MissionType.FENCE: "FENCE_TOTAL", MissionType.RALLY: "RALLY_TOTAL"}
"""ArduPilot's parameters; it tells a value that it has saved (from memory)."""
AGAIN_NS: Final = 1_000_000_000
"""Wait before they are read again, where they were not told whole."""
SILENT_AGAIN_NS: Final = 30_000_000_000
"""The same where nothing at all was answered."""
HEARD_NS: Final = 2_000_000_000
"""A vehicle that was heard in this time did not answer; of another one nothing follows."""


class PlanOnBoard:
    """What one vehicle has on board of one kind, fence or rally points."""

    def __init__(self, own: Address, times: Times, kind: MissionType) -> None:
        self._own = own
        self._times = times
        self._kind = kind
        self._name = NAMES[kind]
        self._download: MissionDownload | None = None
        self._overheard = False
        """The download under way is a job's: nothing is sent for it here."""
        self._again_ns: int | None = None
        """When they are to be read; None: they need not be."""
        self._waits = False
        """Another transfer with the vehicle comes first."""
        self._number: int | None = None
        """What the vehicle calls them."""
        self._total: float | None = None
        """How many ArduPilot's parameter says that it has."""
        self._silence_told = False
        self.items: tuple[WireItem, ...] | None = None
        """None: they are not known."""
        self.failure = ""
        """Why they could not be read; empty where they were not read yet."""
        self.answered = False
        """They were known once, or could not be read, since the vehicle appeared."""

    @property
    def deadline_ns(self) -> int | None:
        """When an answer is overdue, or they are to be read again."""
        if self._download is not None and self.reading:
            return self._download.deadline_ns
        return None if self._waits else self._again_ns

    @property
    def reading(self) -> bool:
        """A transfer for this is under way."""
        return self._download is not None and not self._overheard

    @property
    def none_on_board(self) -> bool:
        """They were read, and there is none."""
        return self.items == ()

    def start(self, telemetry: Telemetry, now_ns: int) -> None:
        """The vehicle appeared: nothing is known of it.  `follow` begins to read."""
        self._number = self._total = None
        self._silence_told = False
        self.answered = not telemetry.autopilot.commanded
        if not self.answered:
            self.changed(now_ns)

    def follow(
        self, work: Iterable[Work], telemetry: Telemetry, *, busy: bool, now_ns: int
    ) -> list[Work]:
        """What the jobs send may change them, or ask for them.

        `busy`: a job, or another of these, transfers a plan: one at a time.
        """
        for item in work:
            if not isinstance(item, Send):
                continue
            if self._changes(item.message):
                self.changed(now_ns)
            elif self._asks(item.message):
                self._begin(telemetry, overheard=True, now_ns=now_ns)
        return self._go_on(telemetry, busy, now_ns)

    def heard(self, heard: Heard, telemetry: Telemetry, now_ns: int) -> list[Work]:
        """A mission message or parameter of the vehicle; before the jobs hear it."""
        if heard.compid != telemetry.compid:
            return []
        match heard.message:
            case MissionAck(type=MissionResult.ACCEPTED, mission_type=kind) if self._is_of(kind):
                self.changed(now_ns)
                return []
            case MissionCurrent() as current:
                was, self._number = self._number, self._number_in(current)
                if was not in (None, self._number):
                    self.changed(now_ns)
                return []
            case ParamValue(param_id=name, param_value=total) if name == TOTALS[self._kind]:
                before, self._total = self._total, total
                if before is None and self.items is not None:
                    before = float(len(self.items))
                if before not in (None, total):
                    self.changed(now_ns)
                return []
        if self._download is None:
            return []
        return self._answers(self._download.handle(heard, now_ns), telemetry, now_ns)

    def wake(self, telemetry: Telemetry, *, busy: bool, now_ns: int) -> list[Work]:
        """`deadline_ns` has passed."""
        if self._download is not None and self.reading:
            return self._answers(self._download.handle(Wake(), now_ns), telemetry, now_ns)
        return self._go_on(telemetry, busy, now_ns)

    def changed(self, now_ns: int) -> None:
        """They may be others from now on."""
        self.items, self.failure = None, ""
        self._download, self._again_ns = None, now_ns

    def _go_on(self, telemetry: Telemetry, busy: bool, now_ns: int) -> list[Work]:
        """Read them when that is due, and nothing else transfers a plan."""
        self._waits = busy
        if busy:
            if self.reading:
                self._download = None
                self._again_ns = now_ns
            return []
        if self._overheard:
            self._download, self._overheard = None, False  # the job is over
        if self._again_ns is None or self.reading or now_ns < self._again_ns:
            return []
        return self._begin(telemetry, overheard=False, now_ns=now_ns)

    def _begin(self, telemetry: Telemetry, *, overheard: bool, now_ns: int) -> list[Work]:
        target = Address(telemetry.sysid, telemetry.compid)
        self._overheard = overheard
        self._download = MissionDownload(self._own, target, self._kind, timing_of(self._times))
        asked = self._download.start(now_ns)
        return [] if overheard else [each for each in asked if isinstance(each, Send)]

    def _answers(
        self, effects: list[TransferEffect], telemetry: Telemetry, now_ns: int
    ) -> list[Work]:
        work: list[Work] = []
        for effect in effects:
            match effect:
                case Send() if not self._overheard:
                    work.append(effect)
                case TransferDone(_, items):
                    self._learn(tuple(map(item_of, items)))
                case TransferFailed(_, result, text):
                    work += self._fail(result, text, telemetry, now_ns)
        return work

    def _learn(self, items: tuple[WireItem, ...]) -> None:
        self._download, self._again_ns = None, None
        self.items, self.failure, self.answered = items, "", True

    def _fail(self, result: int | None, text: str, telemetry: Telemetry, now_ns: int) -> list[Work]:
        """A vehicle that is heard and answers nothing at all is taken to have none."""
        download, overheard = self._download, self._overheard
        listed = download is not None and download.listed
        if result == MissionResult.UNSUPPORTED:
            self._learn(())
            return []
        self._download = None
        real_ns = self._times.real_ns
        alive = now_ns - telemetry.heard_ns <= real_ns(HEARD_NS)
        if result is None and not listed and not overheard and alive:
            self._learn(())
            self._again_ns = now_ns + real_ns(SILENT_AGAIN_NS)
            told, self._silence_told = self._silence_told, True
            said = f"the vehicle was asked for its {self._name} and did not answer"
            log = Log(Level.WARNING, NODE, f"{said}: it is taken to have none")
            return [] if told else [log]
        self._again_ns = now_ns + real_ns(AGAIN_NS)
        self.failure, self.answered = f"its {self._name} could not be read: {text}", True
        return []

    # ---------------------------------------------------------------------- of which kind

    def _number_in(self, current: MissionCurrent) -> int:
        return current.fence_id if self._kind is MissionType.FENCE else current.rally_points_id

    def _is_of(self, kind: int) -> bool:
        return kind in (self._kind, MissionType.ALL)

    def _changes(self, message: Message) -> bool:
        return isinstance(message, MissionCount | MissionClearAll) and self._is_of(
            message.mission_type
        )

    def _asks(self, message: Message) -> bool:
        return isinstance(message, MissionRequestList) and message.mission_type == self._kind
