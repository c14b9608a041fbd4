"""Download: what is on board, into a file where one is named: all of it, or one kind of plan."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.gate.effects import OutcomeKind
from gcs.gate.refusal import Code
from gcs.plan.errors import Finding, PlanError
from gcs.plan.formats.fence_items import split_fence
from gcs.plan.formats.writer import write
from gcs.plan.item_messages import item_of
from gcs.plan.model import Geodetic, Plan
from gcs.plan.parts import are, held
from gcs.plan.wire import WireItem, from_wire, items_from_wire
from gcs.plan.wire_fence import is_above_home
from gcs.protocol.mission import MissionDownload
from gcs.session.effects import WriteFile
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.work import TellOperator
from gcs.vehicle.missions.jobs.job import Asked, Job, JobWork, VehicleView
from gcs.vehicle.missions.jobs.transfers import NAMES
from gcs.vehicle.missions.paths import autopilot_name
from gcs.wire.ids import MissionResult, MissionType
from gcs.wire.messages import MissionItemInt

ON_BOARD = "on board"


class Download(Job):
    """What is on board, into a file where one is named.

    A vehicle that keeps no fence or no rally points (MAV_MISSION_UNSUPPORTED) has none.
    """

    def __init__(
        self, asked: Asked, path: str, kinds: tuple[MissionType, ...] = tuple(NAMES)
    ) -> None:
        super().__init__(asked)
        self._path = path
        self._kinds = kinds
        self._items: dict[MissionType, tuple[WireItem, ...]] = {}
        self._written = ""
        """What is in the file, and what is not."""

    def start(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        return [self.accept(), *self._next(view, now_ns)]

    def _next(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        """Ask for what was not read yet, or write all of it."""
        for kind in self._kinds:
            if kind not in self._items:
                download = MissionDownload(*self.parties(view, kind), self.asked.timing)
                return self.begin(download, view, now_ns)
        return self._write(view)

    def done(
        self, items: tuple[MissionItemInt, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        self._items[self._reading] = tuple(map(item_of, items))
        return self._next(view, now_ns)

    def failed(
        self, result: int | None, text: str, view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        kind = self._reading
        if kind is MissionType.MISSION:
            return super().failed(result, text, view, now_ns)
        if result == MissionResult.UNSUPPORTED:
            return self.done((), view, now_ns)
        text = f"its {NAMES[kind]} could not be read: {text}"
        return super().failed(result, text, view, now_ns)

    @property
    def _reading(self) -> MissionType:
        return next(kind for kind in self._kinds if kind not in self._items)

    def _write(self, view: VehicleView) -> list[JobWork]:
        self.stop_transfer()
        autopilot = autopilot_name(view.telemetry)
        try:
            plan = self._plan(view)
            found = held(plan)
            if not self._path:
                text = are(found) if found else f"{self._none} is"
                return self.end(OutcomeKind.COMPLETE, None, f"{text} on board")
            if not found:
                text = f"{self._none} is on board: {self._path} was not written"
                mission = MissionType.MISSION in self._kinds
                code = Code.NO_MISSION if mission else Code.NOT_ON_BOARD
                return self.end(OutcomeKind.ABORTED, code, text)
            written = write(self._path, plan, autopilot)
        except PlanError as error:
            return self.end(OutcomeKind.ABORTED, Code.BAD_MISSION, str(error))
        self._written = f"{', '.join(found)}{_lost(written.lost)}"
        return [WriteFile(self.asked.request_id, self._path, written.data)]

    @property
    def _none(self) -> str:
        """No mission, no fence, no rally."""
        names = [NAMES[kind] for kind in self._kinds]
        return f"no {', '.join(names[:-1])} or {names[-1]}" if names[1:] else f"no {names[0]}"

    def _plan(self, view: VehicleView) -> Plan:
        """What was read, and where home is.  Raises PlanError."""
        autopilot = autopilot_name(view.telemetry)
        plan = from_wire(self._items.get(MissionType.MISSION, ()), autopilot)
        if view.telemetry.home is not None:
            plan = replace(plan, home=Geodetic(*view.telemetry.home))
        fence = items_from_wire(self._items.get(MissionType.FENCE, ()), "fence on board")
        told = self._items.get(MissionType.RALLY, ())
        rally = items_from_wire(told, "rally points on board")
        home_alt_m = 0.0 if plan.home is None else plan.home.alt_amsl_m or 0.0
        points = (
            point
            if is_above_home(item, home_alt_m)
            else replace(point, alt_above_home_m=round(point.alt_above_home_m - home_alt_m, 3))
            for item, point in zip(told, split_fence(ON_BOARD, rally)[2], strict=True)
        )
        return replace(plan, fence=split_fence(ON_BOARD, fence)[1], rally=tuple(points))

    def file(self, news: FileRead | FileWritten, view: VehicleView, now_ns: int) -> list[JobWork]:
        if not isinstance(news, FileWritten):
            return []
        if not news.error:
            text = f"written to {news.path}: {self._written}"
            return self.end(OutcomeKind.COMPLETE, None, text)
        text = f"{news.path}: {news.error}"
        trouble = TellOperator(self.asked.request_id, ipc.Trouble(text, "", ExitCode.BAD_FILE))
        return [trouble, *self.end(OutcomeKind.ABORTED, Code.BAD_MISSION, text)]


def _lost(lost: Sequence[Finding]) -> str:
    """What the format cannot keep, each once."""
    told = dict.fromkeys(f"; {each.item} {each.what}" for each in lost)
    return "".join(told)
