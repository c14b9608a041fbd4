"""RelayPlan: a client's fence or rally points, brought on board whole and read back.

They are settings of the vehicle, no path: the policy says whether a client may change them
(`[bridge] fence`, `rally`).  What cannot be a fence or a list of rally points is refused first.  So
are rally points of which one lies where the policy lets nobody land: the vehicle's own failsafe may
return there, which no ground station can stop.
"""

from __future__ import annotations

from gcs import ipc
from gcs.bridge.client_plan import ClientPlan
from gcs.gate.effects import Level as LogLevel
from gcs.gate.effects import OutcomeKind
from gcs.gate.refusal import Code, Refusal
from gcs.plan.errors import Level, PlanError
from gcs.plan.formats.fence_items import split_fence
from gcs.plan.lint_fence import lint_fence
from gcs.plan.model import Plan
from gcs.plan.wire import WireItem, items_from_wire
from gcs.plan.wire_fence import fence_to_wire
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.work import Log, TellOperator
from gcs.vehicle.missions.jobs.facts import landings_on_board
from gcs.vehicle.missions.jobs.job import NODE, Asked, JobWork, VehicleView
from gcs.vehicle.missions.jobs.prepared import MOST_FINDINGS
from gcs.vehicle.missions.jobs.transfers import NAMES, BringingJob
from gcs.vehicle.missions.paths import bad_rally_points
from gcs.wire.ids import MissionType


class RelayPlan(BringingJob):
    """A client's fence or rally points, brought on board whole and read back."""

    def __init__(self, asked: Asked, plan: ClientPlan) -> None:
        super().__init__(asked)
        self._plan = plan

    def start(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        try:
            items = checked(self._plan)
        except PlanError as error:
            return self.refuse(Refusal(Code.BAD_MISSION, str(error)))
        if self._plan.kind is MissionType.RALLY:
            landings = landings_on_board(items, view.telemetry)
            bad = bad_rally_points(landings, view.policy, view.telemetry)
            if bad:
                told = [each for refusal in bad[1:MOST_FINDINGS] for each in self._found(refusal)]
                return [*told, *self.refuse(bad[0])]
        return [self.accept(), *self.bring([(self._plan.kind, items)], view, now_ns)]

    def _found(self, refusal: Refusal) -> list[JobWork]:
        """One more rally point that is refused: the log has it, and the client reads it."""
        text = f"{refusal.code.value}: {refusal.sentence}"
        log = Log(LogLevel.WARNING, NODE, f"{self._plan.source}: {text}")
        return [log, TellOperator(self.asked.request_id, ipc.Trouble(text))]

    def on_board(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        name, many = NAMES[self._plan.kind], len(self._plan.items)
        text = f"the {name} of {many} items is on board, read back equal"
        return self.end(OutcomeKind.COMPLETE, None, text)

    def file(self, news: FileRead | FileWritten, view: VehicleView, now_ns: int) -> list[JobWork]:
        return []


def checked(plan: ClientPlan) -> tuple[WireItem, ...]:
    """The items to be sent.  Raises PlanError where they are no fence, or no rally points.

    A fence's are written anew, as clients differ in the frames that they give its corners.
    """
    items = items_from_wire(plan.items, plan.source)
    mission, fence, rally = split_fence(plan.source, items)
    fenced = bool(fence.zones or fence.breach_return)
    is_rally = plan.kind is MissionType.RALLY
    if mission or fenced is is_rally or bool(rally) is not is_rally:
        what = f"holds items that are no {'rally point' if is_rally else 'part of a fence'}"
        raise PlanError(plan.source, "", "", what)
    for finding in lint_fence(Plan(plan.source, None, None, fence=fence), None):
        if finding.level is Level.ERROR:
            raise PlanError(plan.source, finding.where, finding.item, finding.what)
    return plan.items if is_rally else fence_to_wire(plan.source, fence)
