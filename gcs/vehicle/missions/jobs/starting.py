"""A job that ends with the start of a mission: verified, brought to the item where it is to begin,
then the gate decides.

The way to the first item was verified from where the vehicle was.  All this takes time, in which a
client may fly the vehicle to another place; then it is verified once more, from there.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from gcs.frames import Vec3
from gcs.gate.airspace.mission_box import box_round
from gcs.gate.airspace.projection import Origin
from gcs.gate.inputs import MissionPathVerified
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import StartMission
from gcs.gate.states import LandedState, State
from gcs.plan.item_messages import item_of
from gcs.plan.legs import FlightPath
from gcs.plan.model import Plan
from gcs.plan.wire import WireItem
from gcs.protocol.effects import Address
from gcs.protocol.mission_rewind import MissionRewind
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.work import AskGate, GateInput
from gcs.vehicle.missions.jobs.job import Asked, JobWork, PathVerified, VehicleView, code_of
from gcs.vehicle.missions.jobs.verified import VerifiedJob
from gcs.vehicle.missions.paths import first_item
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.ids import Cmd
from gcs.wire.messages import MissionItemInt

NAV_LAST: Final = 95
"""MAV_CMD_NAV_LAST: items up to it are flown, or waited for; those after it are done on the way."""
LEFT: Final = "its operator left before it began"
STOPPED: Final = "an operator stopped the vehicle before it began"
MOVED: Final = Refusal(
    Code.BUSY,
    "the vehicle, its home or its origin moves on while the way to the mission is verified: ask "
    "again when it stands still",
)
ROUNDS: Final = 5
"""So often the mission is verified once more because something has moved."""
STARTED_FROM: Final = frozenset({State.HOVERING, State.GROUNDED})
"""In any other state the gate refuses the start."""


@dataclass(frozen=True, slots=True)
class _Place:
    """What a mission is verified from, beside the plan."""

    pos_ned: Vec3 | None
    home_ned: Vec3 | None
    origin: Origin | None
    on_ground: bool

    def is_left(self, now: _Place, within_m: float) -> bool:
        """Whether the vehicle is not there any more."""
        if self.pos_ned is None or now.pos_ned is None:
            return True
        same = (self.home_ned, self.origin, self.on_ground)
        if same != (now.home_ned, now.origin, now.on_ground):
            return True
        return not math.dist(self.pos_ned, now.pos_ned) <= within_m


class StartingJob(VerifiedJob):
    """What is on board is read: `read_back`; once it is verified, `begin_at`."""

    def __init__(self, asked: Asked) -> None:
        super().__init__(asked)
        self.not_before_ns = 0
        """Until then a PX4 may not have checked the mission that it has taken."""
        self._waits = False
        """For that moment."""
        self._rewinding = False
        """The vehicle is to go to the item that it begins at."""
        self._begin_seq: int | None = None
        """That item; None: the first."""
        self._verified_from: _Place | None = None
        self._corners_ned: list[Vec3] = []
        """Of the path from there; of both, where it may begin at either of two items."""
        self._legs_ned: list[tuple[Vec3, Vec3]] = []
        """The same path, as it is flown."""
        self._rounds = 0

    @abstractmethod
    def verify_anew(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        """What is on board has cleared, and is to be verified from where the vehicle is now."""

    @abstractmethod
    def read_back(
        self, received: tuple[WireItem, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        """The items that are on board."""

    @property
    def deadline_ns(self) -> int | None:
        return self.not_before_ns if self._waits else super().deadline_ns

    def wake(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        return self._ask_from_here(view, now_ns) if self._waits else super().wake(view, now_ns)

    def file(self, news: FileRead | FileWritten, view: VehicleView, now_ns: int) -> list[JobWork]:
        return []

    def done(
        self, items: tuple[MissionItemInt, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        if self._rewinding:
            return self._ask_from_here(view, now_ns)
        return self.read_back(tuple(item_of(message) for message in items), view, now_ns)

    def begin_at(
        self, seq: int | None, items: Sequence[WireItem], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        """Ask the gate for the start, once the vehicle is at item `seq`; None: the first.

        From there the mission was verified; the vehicle itself would go on where it was left.
        """
        self._begin_seq = seq
        begin = first_item(view.telemetry) if seq is None else seq
        shown = shown_for(begin, items, view.telemetry)
        current = view.telemetry.mission_seq
        if current in shown or (current is None and seq is None):
            return self._ask_from_here(view, now_ns)
        self._rewinding = True
        target = Address(view.telemetry.sysid, view.telemetry.compid)
        rewind = MissionRewind(self.asked.own, target, begin, shown, self.asked.timing)
        return self.begin(rewind, view, now_ns)

    def verify(
        self, plan: Plan, view: VehicleView, now_ns: int, begin_item: int = 0
    ) -> list[JobWork]:
        """From where the vehicle is.  One that is verified twice, for two items that it may begin
        at, counts as verified from where the vehicle was at first."""
        if self._verified_from is None:
            self._verified_from = _place(view.telemetry)
            self._corners_ned, self._legs_ned = [], []
        return super().verify(plan, view, now_ns, begin_item)

    def _ask_from_here(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        """Ask the gate, if the vehicle still is where the mission was verified from."""
        self._waits = now_ns < self.not_before_ns
        if self._waits:
            self.stop_transfer()
            return []
        verified_from, within_m = self._verified_from, view.policy.arrival.max_radius_m
        moved = verified_from is not None and verified_from.is_left(
            _place(view.telemetry), within_m
        )
        if not moved or view.state not in STARTED_FROM:
            return self.ask_gate()
        self._rounds += 1
        if self._rounds > ROUNDS:
            return self.refuse(MOVED)
        self._verified_from = None
        return self.verify_anew(view, now_ns)

    def note_path(self, path: FlightPath) -> None:
        """It has cleared."""
        self._corners_ned += path.corners
        self._legs_ned += path.flown

    def ask_gate(self) -> list[JobWork]:
        """All that is known of the mission is: the start is the gate's to decide."""
        self.over = True
        work: list[JobWork] = [PathVerified(tuple(self._legs_ned))]
        if self._corners_ned:
            work.append(GateInput(MissionPathVerified(box_round(self._corners_ned))))
        return [*work, AskGate(self.asked.request_id, StartMission(self._begin_seq))]

    def failed(
        self, result: int | None, text: str, view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        sentence = text if self._rewinding else f"what is on board could not be read: {text}"
        return self.refuse(Refusal(code_of(result), sentence))

    def leave(self) -> list[JobWork]:
        """Its operator, or the station, goes before the verdict."""
        return self.refuse(Refusal(Code.OPERATOR_LOST, LEFT))

    def stop(self) -> list[JobWork]:
        """It has no verdict yet, so it is refused."""
        return self.refuse(Refusal(Code.OPERATOR, STOPPED))


def _place(telemetry: Telemetry) -> _Place:
    return _Place(
        telemetry.pos_ned,
        telemetry.home_ned,
        telemetry.origin,
        telemetry.landed is LandedState.ON_GROUND,
    )


def shown_for(begin: int, items: Sequence[WireItem], telemetry: Telemetry) -> range:
    """What MISSION_CURRENT may show of a vehicle that is to begin at item `begin`: that one, up to
    the next one that is flown to.  Before the first it is at the start as well, and an ArduCopter
    that is sent to home goes on to the first (from memory of AP_Mission::set_current_cmd)."""
    first = first_item(telemetry)
    begin = max(begin, first)
    flown = (
        seq
        for seq, item in enumerate(items)
        if seq >= begin and item.command <= NAV_LAST and item.command != Cmd.NAV_ROI
    )
    least = 0 if begin == first else begin
    return range(least, next(flown, begin) + 1)
