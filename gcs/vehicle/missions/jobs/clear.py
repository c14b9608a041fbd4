"""Clear: the mission, fence or rally points on board are taken off; a client may ask for all."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from gcs.gate.effects import OutcomeKind
from gcs.gate.inputs import MissionLoaded
from gcs.protocol.fence_parameters import TAKEN_OFF
from gcs.protocol.mission import MissionClear
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.work import GateInput
from gcs.vehicle.missions.jobs.job import (
    Asked,
    Job,
    JobWork,
    OnBoardChanged,
    VehicleView,
    may_not_fence,
)
from gcs.vehicle.missions.paths import autopilot_name
from gcs.wire.ids import MissionType
from gcs.wire.messages import MissionItemInt

GONE = {
    MissionType.MISSION: "no mission is on board",
    MissionType.FENCE: "no fence is on board",
    MissionType.RALLY: "no rally points are on board",
}


class Clear(Job):
    """The plans of these kinds are taken off, one after the other."""

    def __init__(self, asked: Asked, kinds: tuple[MissionType, ...]) -> None:
        super().__init__(asked)
        self._kinds = kinds
        self._left = list(kinds)

    def start(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        if self.asked.word == "fence_clear" and (kept := may_not_fence(view, ())):
            return self.refuse(kept)
        return [self.accept(), *self._clear(view, now_ns)]

    def _clear(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        clear = MissionClear(*self.parties(view, self._left[0]), self.asked.timing)
        return self.begin(clear, view, now_ns)

    def done(
        self, items: tuple[MissionItemInt, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        work: list[JobWork] = []
        if self._left.pop(0) is MissionType.MISSION:
            work += [OnBoardChanged(None), GateInput(MissionLoaded("", 0))]
        if self._left:
            return work + self._clear(view, now_ns)
        told = ", ".join(GONE[kind] for kind in self._kinds)
        stays: Iterable[str] = ()
        if self._kinds == (MissionType.MISSION,):
            stays = self._stays(view)
        elif self.asked.word == "fence_clear":
            stays = self._limits(view)
        return work + self.end(OutcomeKind.COMPLETE, None, "; ".join((told, *stays)))

    def _stays(self, view: VehicleView) -> Iterator[str]:
        """What else is on board, and what clears it."""
        for name, items in (("fence stays", view.fence), ("rally points stay", view.rally)):
            if items != ():
                doubt = "" if items else ", if there is any"
                yield f"its {name}{doubt} (`gcs {name.split()[0]} clear`)"

    def _limits(self, view: VehicleView) -> Iterator[str]:
        """What else keeps it in, once `fence put` has set it, and what takes that off."""
        sets = TAKEN_OFF.get(autopilot_name(view.telemetry), ())
        if sets:
            how = ", ".join(f"`gcs param set {each}`" for each in sets)
            yield f"limits of radius and height, if they are set, stay ({how})"

    def file(self, news: FileRead | FileWritten, view: VehicleView, now_ns: int) -> list[JobWork]:
        return []
