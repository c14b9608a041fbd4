"""Set current: the item at which the mission on board is to begin, before it is started in the air.

It moves nothing: while a mission is flown it is refused.  The start verifies the way from where the
vehicle is to that item, and all that may follow from there.
"""

from __future__ import annotations

from gcs.gate.effects import OutcomeKind
from gcs.gate.refusal import Code, Refusal
from gcs.gate.states import FlightMode, State
from gcs.protocol.autopilot import mode_named
from gcs.protocol.effects import Address
from gcs.protocol.mission_rewind import MissionRewind
from gcs.session.inputs import FileRead, FileWritten
from gcs.vehicle.missions.jobs.job import Asked, BeginsAt, Job, JobWork, VehicleView
from gcs.vehicle.missions.jobs.starting import shown_for
from gcs.vehicle.missions.paths import first_item
from gcs.vehicle.missions.plans import OnBoard
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.messages import MissionItemInt

UNKNOWN = "no mission is on board that this station has verified: upload it, or start it once"
FLOWN = "the mission is being flown: stop it first (hold, resume)"
ON_GROUND = "on the ground a mission begins with its first item"


class SetCurrent(Job):
    """The vehicle is told (MISSION_SET_CURRENT), and shows it."""

    def __init__(self, asked: Asked, seq: int, on_board: OnBoard | None) -> None:
        super().__init__(asked)
        self._seq = seq
        self._on_board = on_board

    def start(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        refusal = self._refusal(view)
        if refusal is not None:
            return self.refuse(refusal)
        telemetry = view.telemetry
        items = self._on_board.sent if self._on_board is not None else ()
        shown = shown_for(self._seq, items, telemetry)
        target = Address(telemetry.sysid, telemetry.compid)
        transfer = MissionRewind(self.asked.own, target, self._seq, shown, self.asked.timing)
        return [self.accept(), *self.begin(transfer, view, now_ns)]

    def _refusal(self, view: VehicleView) -> Refusal | None:
        if flies_mission(view):
            return Refusal(Code.BUSY, FLOWN)
        first = first_item(view.telemetry)
        if self._on_board is None:
            return None if self._seq in (0, first) else Refusal(Code.NO_MISSION, UNKNOWN)
        count = len(self._on_board.sent)
        if not 0 <= self._seq < count:
            which = f"items {first} to {count - 1}"
            return Refusal(
                Code.BAD_MISSION, f"there is no item {self._seq}: the mission has {which}"
            )
        if view.state is State.GROUNDED and self._seq > first:
            return Refusal(Code.NOT_FLYING, ON_GROUND)
        return None

    def wake(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        """It is sent again while no answer comes, but not to a vehicle that flies its mission."""
        if flies_mission(view):
            return self.end(OutcomeKind.ABORTED, Code.MODE_CHANGED, FLOWN)
        return super().wake(view, now_ns)

    def done(
        self, items: tuple[MissionItemInt, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        begins = BeginsAt(None if self._seq <= first_item(view.telemetry) else self._seq)
        text = f"the mission begins at item {self._seq}"
        return [begins, *self.end(OutcomeKind.COMPLETE, None, text)]

    def file(self, news: FileRead | FileWritten, view: VehicleView, now_ns: int) -> list[JobWork]:
        return []


def flies_mission(view: VehicleView) -> bool:
    """By the gate's state, or by the vehicle's mode while it is armed."""
    return view.state is State.FLYING_MISSION or flown_by_mode(view.telemetry)


def flown_by_mode(telemetry: Telemetry | None) -> bool:
    """Whether the vehicle is armed in the mode of a mission, whoever has set that, a pilot as well:
    it flies what is on board."""
    if telemetry is None or not telemetry.armed:
        return False
    mode = mode_named(telemetry.autopilot, telemetry.mode_name)
    return mode is not None and mode.meaning is FlightMode.MISSION
