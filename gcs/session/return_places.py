"""Where the vehicle's own return may end: at home, or at one of the rally points on board.

The gate clears a return by the ways to all of these places (`ReturnPlacesSeen`), so they are read
when a vehicle appears, and again whenever they may have changed:

- rally points were sent or cleared by us, for a client or with a mission;
- the vehicle accepted such a change from anybody (MISSION_ACK of that kind);
- it gives its rally points another number (MISSION_CURRENT.rally_points_id);
- its parameter RALLY_TOTAL has another value (ArduPilot), or a client sends RALLY_POINT;
- its parameter RTL_TYPE has another value (PX4).

From the moment when they may change until they are read again they are not known, and a return is
refused.  What a job reads of them is overheard, and not read once more.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from gcs.gate.airspace.return_place import ReturnPlace
from gcs.gate.effects import Level
from gcs.gate.inputs import ReturnPlacesSeen
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
from gcs.session.jobs.facts import landings_on_board
from gcs.session.missions import timing_of
from gcs.session.telemetry import Telemetry
from gcs.session.times import Times
from gcs.session.work import Log, ToGate, Work
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
READING: Final = "its rally points are still being read (ask again in a second)"
NO_ORIGIN: Final = "its origin is not known, so its rally points cannot be placed"

JUDGED_TYPES: Final = frozenset({0, 5})
"""PX4's RTL_TYPE: straight to home or a rally point, or to a rally point only.  1 and 3 may lead to
the landing of the mission on board, 2 and 4 along that mission."""
RALLY_TOTAL: Final = "RALLY_TOTAL"
"""ArduPilot's number of rally points; it tells a value that it has saved (from memory)."""
AGAIN_NS: Final = 1_000_000_000
"""Wait before they are read again, where they were not told whole."""
SILENT_AGAIN_NS: Final = 30_000_000_000
"""The same where nothing at all was answered."""
HEARD_NS: Final = 2_000_000_000
"""A vehicle that was heard in this time did not answer; of another one nothing follows."""


class ReturnPlaces:
    """Reads the rally points of one vehicle, and tells its gate where a return may end."""

    def __init__(self, own: Address, times: Times) -> None:
        self._own = own
        self._times = times
        self._download: MissionDownload | None = None
        self._overheard = False
        """The download under way is a job's: nothing is sent for it here."""
        self._again_ns: int | None = None
        """When they are to be read; None: they need not be."""
        self._waits = False
        """A job transfers a plan first."""
        self._items: tuple[WireItem, ...] | None = None
        self._why = READING
        self._return_type: int | None = None
        self._number: int | None = None
        """What the vehicle calls its rally points."""
        self._total: float | None = None
        """How many ArduPilot's parameter says that it has."""
        self._told: ReturnPlacesSeen | None = None
        self._answered = False

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
    def first_time(self) -> bool:
        """They were not told yet, since the vehicle appeared."""
        return not self._answered

    # ---------------------------------------------------------------------------- reading

    def start(self, telemetry: Telemetry, *, busy: bool, now_ns: int) -> list[Work]:
        """The vehicle appeared: nothing is known of it.  `busy`: a job transfers a plan."""
        self._return_type = self._number = self._total = None
        self._answered = not telemetry.autopilot.commanded
        if self._answered:
            return []
        return [*self.changed(telemetry, now_ns), *self._go_on(telemetry, busy, now_ns)]

    def follow(
        self, work: Iterable[Work], telemetry: Telemetry, *, busy: bool, now_ns: int
    ) -> list[Work]:
        """What the jobs send may change the rally points, or ask for them."""
        out: list[Work] = []
        for item in work:
            if not isinstance(item, Send):
                continue
            if _changes(item.message):
                out += self.changed(telemetry, now_ns)
            elif _asks(item.message):
                self._begin(telemetry, overheard=True, now_ns=now_ns)
        return out + self._go_on(telemetry, busy, now_ns)

    def heard(self, heard: Heard, telemetry: Telemetry, now_ns: int) -> list[Work]:
        """A mission message or parameter of the vehicle; before the jobs hear it."""
        if heard.compid != telemetry.compid:
            return []
        match heard.message:
            case MissionAck(type=MissionResult.ACCEPTED, mission_type=kind) if _of_rally(kind):
                return self.changed(telemetry, now_ns)
            case MissionCurrent(rally_points_id=number):
                was, self._number = self._number, number
                return [] if was in (None, number) else self.changed(telemetry, now_ns)
            case ParamValue(param_id=name, param_value=total) if name == RALLY_TOTAL:
                before, self._total = self._total, total
                if before is None and self._items is not None:
                    before = float(len(self._items))
                return [] if before in (None, total) else self.changed(telemetry, now_ns)
        if self._download is None:
            return []
        return self._answers(self._download.handle(heard, now_ns), telemetry, now_ns)

    def wake(self, telemetry: Telemetry, *, busy: bool, now_ns: int) -> list[Work]:
        if self._download is not None and self.reading:
            return self._answers(self._download.handle(Wake(), now_ns), telemetry, now_ns)
        return self._go_on(telemetry, busy, now_ns)

    def returns_by(self, return_type: int | None, telemetry: Telemetry) -> list[Work]:
        """PX4's RTL_TYPE; None: the vehicle says that it has none."""
        self._return_type = return_type or 0
        return self._tell(telemetry)

    def placed(self, telemetry: Telemetry) -> list[Work]:
        """Home or the origin has changed."""
        return self._tell(telemetry) if self._items else []

    def changed(self, telemetry: Telemetry, now_ns: int) -> list[Work]:
        """They may be others from now on."""
        self._items, self._why = None, READING
        self._download, self._again_ns = None, now_ns
        return self._tell(telemetry)

    def _go_on(self, telemetry: Telemetry, busy: bool, now_ns: int) -> list[Work]:
        """Read them when that is due, and no job transfers a plan: one at a time."""
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
        timing = timing_of(self._times)
        self._overheard = overheard
        self._download = MissionDownload(self._own, target, MissionType.RALLY, timing)
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
                    work += self._learnt(tuple(map(item_of, items)), telemetry)
                case TransferFailed(_, result, text):
                    work += self._failed(result, text, telemetry, now_ns)
        return work

    def _learnt(self, items: tuple[WireItem, ...], telemetry: Telemetry) -> list[Work]:
        self._download, self._again_ns = None, None
        self._items, self._answered = items, True
        return self._tell(telemetry)

    def _failed(
        self, result: int | None, text: str, telemetry: Telemetry, now_ns: int
    ) -> list[Work]:
        """A vehicle that is heard and answers nothing at all is taken to have no rally points."""
        download, overheard = self._download, self._overheard
        listed = download is not None and download.listed
        if result == MissionResult.UNSUPPORTED:
            return self._learnt((), telemetry)
        self._download = None
        real_ns = self._times.real_ns
        alive = now_ns - telemetry.heard_ns <= real_ns(HEARD_NS)
        if result is None and not listed and not overheard and alive:
            work = self._learnt((), telemetry)
            self._again_ns = now_ns + real_ns(SILENT_AGAIN_NS)
            said = "the vehicle was asked for its rally points and did not answer"
            return [*work, Log(Level.WARNING, NODE, f"{said}: it is taken to have none")]
        self._again_ns = now_ns + real_ns(AGAIN_NS)
        self._why, self._answered = f"its rally points could not be read: {text}", True
        return self._tell(telemetry)

    # ---------------------------------------------------------------------------- telling

    def _tell(self, telemetry: Telemetry) -> list[Work]:
        """The gate, where it is news."""
        seen = self._seen(telemetry)
        if seen == self._told:
            return []
        self._told = seen
        return [ToGate(seen), *_logged(seen)]

    def _seen(self, telemetry: Telemetry) -> ReturnPlacesSeen:
        if self._items is None:
            return ReturnPlacesSeen(None, self._why)
        if telemetry.autopilot.name == "px4":
            kind = self._return_type
            if kind is None:
                return ReturnPlacesSeen(None, "its RTL_TYPE is still being read")
            if kind not in JUDGED_TYPES:
                said = f"it returns as its RTL_TYPE {kind} says, by its mission or to its landing"
                return ReturnPlacesSeen(None, f"{said}, which is not judged")
        if self._items and (telemetry.origin is None or telemetry.home_ned is None):
            return ReturnPlacesSeen(None, NO_ORIGIN)
        landings = landings_on_board(self._items, telemetry)
        places = (ReturnPlace(each.name, each.ground_ned, each.over_up_m) for each in landings)
        return ReturnPlacesSeen(tuple(places))


def _logged(seen: ReturnPlacesSeen) -> list[Work]:
    """Said where it is not the usual."""
    if seen.places:
        names = ", ".join(each.name for each in seen.places)
        return [Log(Level.INFO, NODE, f"a return may end at home, {names}")]
    if seen.places is None and seen.unknown != READING:
        return [Log(Level.WARNING, NODE, f"no return can be cleared: {seen.unknown}")]
    return []


def _of_rally(kind: int) -> bool:
    return kind in (MissionType.RALLY, MissionType.ALL)


def _changes(message: Message) -> bool:
    return isinstance(message, MissionCount | MissionClearAll) and _of_rally(message.mission_type)


def _asks(message: Message) -> bool:
    return isinstance(message, MissionRequestList) and message.mission_type == MissionType.RALLY
