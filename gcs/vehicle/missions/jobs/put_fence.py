"""PutFence: the policy's own fence, and what a breach of it leads to, brought on board.

The vehicle then keeps it when the link is down.  Zones are uploaded and read back first, in place
of the fence that was on board; then each parameter is read, set where it differs, and read back;
what switches the fence on comes last.  Only on the ground and disarmed: meanwhile there is less of
a fence.  What was on board before is named as gone, as a fence of a plan may be.
"""

from __future__ import annotations

from gcs.gate.effects import Level, OutcomeKind
from gcs.gate.refusal import Code, Refusal
from gcs.plan.errors import PlanError
from gcs.plan.model import Plan
from gcs.plan.parts import held
from gcs.plan.wire_fence import fence_to_wire
from gcs.protocol.effects import Address, Heard, Wake
from gcs.protocol.fence_parameters import kept_by
from gcs.protocol.mission import MissionClear
from gcs.protocol.parameter_setup import EVERY_NS, Change, ParameterSetup
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.work import Log
from gcs.steps import Steps
from gcs.vehicle.missions.jobs.bring_on_board import BringMission
from gcs.vehicle.missions.jobs.job import NODE, Asked, JobWork, VehicleView, code_of
from gcs.vehicle.missions.paths import autopilot_name
from gcs.vehicle.missions.plans import Prepared
from gcs.vehicle.missions.policy_fence import VehicleFence, vehicle_fence
from gcs.wire.ids import MissionType
from gcs.wire.messages import MissionItemInt

SOURCE = "the policy's fence"


class PutFence(BringMission):
    """The policy's zones are brought on board, then its parameters are set."""

    def __init__(self, asked: Asked) -> None:
        super().__init__(asked, SOURCE)
        self._fence: VehicleFence | None = None
        self._setup: ParameterSetup | None = None
        self._before = 0
        """Items of the fence that was on board."""

    def start(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        if view.in_air or view.telemetry.armed:
            text = "the vehicle's own fence is not changed in the air, or while it is armed"
            return self.refuse(Refusal(Code.IN_AIR, f"{text}: land and disarm first"))
        self._before = len(view.fence or ())
        return self.prepare_with(self._prepare(view), True, view, now_ns)

    def _prepare(self, view: VehicleView) -> Steps[Prepared | Refusal]:
        yield
        fence = vehicle_fence(view.policy, view.telemetry)
        if isinstance(fence, Refusal):
            return fence
        self._fence = fence
        plan = Plan(SOURCE, None, None, fence=fence.zones, source=SOURCE)
        return Prepared(plan, (), (), fence_to_wire(SOURCE, fence.zones))

    def placed(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        """The zones; where the policy has none, those that are on board are taken off."""
        if self.prepared.fence or view.fence == ():
            return super().placed(view, now_ns)
        self._accepted = True
        clear = MissionClear(*self.parties(view, MissionType.FENCE), self.asked.timing)
        return [self.accept(), *self.begin(clear, view, now_ns)]

    def done(
        self, items: tuple[MissionItemInt, ...], view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        if isinstance(self._transfer, MissionClear):
            return self.on_board(view, now_ns)
        return super().done(items, view, now_ns)

    def failed(
        self, result: int | None, text: str, view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        """Only an upload can be settled by what is on board then."""
        if isinstance(self._transfer, MissionClear):
            text = f"the fence on board was not taken off: {text}"
            return self.end(OutcomeKind.ABORTED, code_of(result), text)
        return super().failed(result, text, view, now_ns)

    # ------------------------------------------------------------------------- parameters

    def on_board(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        """The zones are: the parameters are next."""
        assert self._fence is not None
        self.stop_transfer()
        telemetry = view.telemetry
        self._setup = ParameterSetup(
            self.asked.own,
            Address(telemetry.sysid, telemetry.compid),
            telemetry.autopilot.param_encoding,
            kept_by(autopilot_name(telemetry), self._fence.kept),
            self.asked.times.real_ns(EVERY_NS),
        )
        return [*self._setup.start(now_ns)]

    @property
    def deadline_ns(self) -> int | None:
        return super().deadline_ns if self._setup is None else self._setup.deadline_ns

    def heard(self, heard: Heard, view: VehicleView, now_ns: int) -> list[JobWork]:
        if self._setup is None:
            return super().heard(heard, view, now_ns)
        return self._set_on(self._setup, heard, view, now_ns)

    def wake(self, view: VehicleView, now_ns: int) -> list[JobWork]:
        if self._setup is None:
            return super().wake(view, now_ns)
        return self._set_on(self._setup, Wake(), view, now_ns)

    def _set_on(
        self, setup: ParameterSetup, event: Heard | Wake, view: VehicleView, now_ns: int
    ) -> list[JobWork]:
        told = len(setup.changes)
        work: list[JobWork] = [*setup.handle(event, now_ns)]
        work += [Log(Level.INFO, NODE, _words(change)) for change in setup.changes[told:]]
        if setup.failure:
            code = Code.VEHICLE_REFUSED
            return [*work, *self.end(OutcomeKind.ABORTED, code, f"not all is set: {setup.failure}")]
        return (
            [*work, *self.end(OutcomeKind.COMPLETE, None, self._said(setup))]
            if setup.over
            else work
        )

    def _said(self, setup: ParameterSetup) -> str:
        assert self._fence is not None
        kept, zones = self._fence.kept, held(self.prepared.plan)
        size = f"{kept.reach_m:g} m from home, {kept.ceiling_up_m:g} m above it"
        values = ", ".join(f"{each.name} = {each.after:g}" for each in setup.changes)
        text = f"on board, read back: {', '.join((size, *zones))}; a breach leads to {kept.breach}"
        lost = "".join(f"; not kept: {each}" for each in self._fence.not_kept)
        gone = (
            f"; the fence that was on board, {self._before} items, is gone" if self._before else ""
        )
        return f"{text} ({values}){gone}{lost}"

    # ------------------------------------------------------------------------- of no file

    def kept(self) -> list[JobWork]:
        return []

    def bad_plan(self, error: PlanError) -> list[JobWork]:
        return self.refuse(Refusal(Code.POLICY, str(error)))

    def file(self, news: FileRead | FileWritten, view: VehicleView, now_ns: int) -> list[JobWork]:
        return []


def _words(change: Change) -> str:
    was = "" if change.before == change.after else f", was {change.before:g}"
    return f"{change.name} = {change.after:g}{was}"
