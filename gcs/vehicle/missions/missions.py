"""Missions of one vehicle: which one is on board, how far it is flown, and one job at a time.

What can be asked, step by step, is in `jobs/`.  A second request is refused BUSY.
Everything that moves still goes through the gate.
"""

from __future__ import annotations

from typing import Final

from gcs import ipc
from gcs.bridge.client_plan import ClientPlan
from gcs.frames import Vec3
from gcs.gate.effects import Level
from gcs.gate.inputs import Input, MissionLoaded, MissionSeen, OperatorLost, Requested
from gcs.gate.machine.events import Event, event_of
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code, Refusal
from gcs.gate.requests import StartMission
from gcs.gate.states import State
from gcs.protocol.effects import Address, Heard, Send
from gcs.protocol.transfers.transfer import SPEC_TIMING, Timing
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.speedup_waits import Times
from gcs.session.work import AskGate, GateInput, Log, Work
from gcs.vehicle.missions.jobs.check import NO_MISSION, Check, CheckUnknown
from gcs.vehicle.missions.jobs.clear import Clear
from gcs.vehicle.missions.jobs.download import Download
from gcs.vehicle.missions.jobs.forward_fence import RelayPlan
from gcs.vehicle.missions.jobs.job import (
    NODE,
    Asked,
    BeginsAt,
    Job,
    JobWork,
    OnBoardChanged,
    OnBoardRefused,
    PathVerified,
    VehicleView,
    refused,
)
from gcs.vehicle.missions.jobs.put_fence import PutFence
from gcs.vehicle.missions.jobs.set_current import SetCurrent, flown_by_mode
from gcs.vehicle.missions.jobs.start import Start
from gcs.vehicle.missions.jobs.starting import StartingJob
from gcs.vehicle.missions.jobs.transfers import BringingJob
from gcs.vehicle.missions.jobs.upload import ClientUpload, Upload
from gcs.vehicle.missions.jobs.verify_on_board import Adopt
from gcs.vehicle.missions.mission_current import MissionTold
from gcs.vehicle.missions.paths import autopilot_name, first_item, is_placed
from gcs.vehicle.missions.plans import OnBoard
from gcs.wire.ids import Cmd, MissionResult, MissionState, MissionType
from gcs.wire.messages import (
    MissionAck,
    MissionCount,
    MissionCurrent,
    MissionItemReached,
    MissionRequestList,
)

KINDS = (MissionType.MISSION, MissionType.FENCE, MissionType.RALLY)
OF_WORD = {"fence": MissionType.FENCE, "rally": MissionType.RALLY}
"""By how a word begins."""

PLAN_RECEIVED = "Flight plan received"
"""What ArduCopter tells all of a mission that was uploaded, some 0.1 s later (recorded, 4.7)."""
TEXT_WITHIN_NS: Final = 1_000_000_000
"""So long after an upload of our own that text is taken for the one of that upload."""

STOPS = frozenset(
    {Event.ABORT, Event.HOLD, Event.LAND, Event.RETURN, Event.DISARM, Event.FORCE_DISARM}
)
"""After these no mission begins that was asked for before them."""

PX4_CHECKS_NS: Final = 300_000_000
"""A PX4 checks a mission some time after it has taken it: of 15 starts within 0.05 s 11 were
DENIED ("No valid mission"), of 34 after 0.1 s none (recorded, 1.14.3)."""


def timing_of(times: Times) -> Timing:
    """The specification's waits, on the session's clock."""
    return Timing(
        times.real_ns(SPEC_TIMING.wait_ns),
        times.real_ns(SPEC_TIMING.item_wait_ns),
        silence_ns=times.real_ns(SPEC_TIMING.silence_ns),
        confirm_ns=times.real_ns(SPEC_TIMING.confirm_ns),
    )


def still_paused(paused: bool, before: State, after: State) -> bool:
    """Was a mission stopped by a hold, and has nothing else been flown since?

    `before` and `after` are the gate's states around one input.
    """
    if before is State.FLYING_MISSION and after is State.HOLDING:
        return True
    return paused and after in (State.HOLDING, State.HOVERING, State.STALE)


class Missions:
    """Takes the mission requests of one vehicle, and tells the gate how its mission goes."""

    def __init__(self, own: Address, times: Times) -> None:
        self._own = own
        self._times = times
        self._timing = timing_of(times)
        self.job: Job | None = None
        """The one that is under way."""
        self._on_board: OnBoard | None = None
        self._path_ned: tuple[Vec3, ...] = ()
        self.legs_ned: tuple[tuple[Vec3, Vec3], ...] = ()
        """What the mission flies that is started, or was asked for last, from where it began."""
        self._begin_seq: int | None = None
        """The item at which the next start in the air begins, where one was asked for."""
        self._left = False
        self._taken_ns = -PX4_CHECKS_NS
        """When the vehicle told last that it has taken a mission, of whomever."""
        self._own_text_until_ns = 0
        """Until then the text of our own upload may still come."""
        self._was_active = False
        """Whether the vehicle was seen flying the mission that was started last."""
        self.total: int | None = None
        """Items that the vehicle holds, as they were read back last."""
        self._told = MissionTold(times)

    @property
    def deadline_ns(self) -> int | None:
        """When a transfer's wait is over."""
        return self.job.deadline_ns if self.job else None

    @property
    def items(self) -> int:
        """Of the verified mission on board; 0 where there is none."""
        return 0 if self._on_board is None else len(self._on_board.sent)

    @property
    def plan(self) -> OnBoard | None:
        """The verified mission on board."""
        return self._on_board

    @property
    def path_ned(self) -> tuple[Vec3, ...]:
        """Of the verified mission on board, as it is flown."""
        return () if self._on_board is None else self._path_ned

    @property
    def land_starts(self) -> tuple[int, ...]:
        """Where the landing of the verified mission on board begins, as MAVLink counts (seq)."""
        items = () if self._on_board is None else self._on_board.sent
        return tuple(seq for seq, item in enumerate(items) if item.command == Cmd.DO_LAND_START)

    # ----------------------------------------------------------------------------- requests

    def ask(
        self,
        request_id: int,
        ask: ipc.Ask,
        view: VehicleView | None,
        now_ns: int,
        plan: ClientPlan | None = None,
        kind: MissionType = MissionType.MISSION,
    ) -> list[Work]:
        """A transfer, or the start of the mission in whatever word.

        `plan` is what a MAVLink client sent, in place of a file; `kind` is which plan it is about,
        where the word does not say it.
        """
        kind = OF_WORD.get(ask.word.partition("_")[0], kind)
        refusal = self._cannot_begin(ask, view, plan, kind)
        if refusal is not None:
            return [*refused(request_id, ask.word, refusal)]
        assert view is not None
        asked = Asked(request_id, ask.id, ask.word, self._own, self._timing, self._times)
        job = self._job_for(ask, asked, plan, kind, view.state, view.policy)
        if job is None:
            self.legs_ned = ()
            return [AskGate(request_id, StartMission())]
        if isinstance(job, StartingJob) and autopilot_name(view.telemetry) == "px4":
            job.not_before_ns = self._taken_ns + self._times.real_ns(PX4_CHECKS_NS)
        self.job = job
        return self._follow(job.start(view, now_ns))

    def _job_for(
        self,
        ask: ipc.Ask,
        asked: Asked,
        plan: ClientPlan | None,
        kind: MissionType,
        state: State,
        policy: Policy,
    ) -> Job | None:
        """None: what cannot be flown at all the gate refuses at once."""
        match ask.word:
            case "mission_upload" if plan is not None:
                mission = kind is MissionType.MISSION
                return ClientUpload(asked, plan) if mission else RelayPlan(asked, plan)
            case "mission_upload" | "fence_upload" | "rally_upload":
                return Upload(asked, ask.path, kind)
            case "mission_download":
                return Download(asked, ask.path)
            case "fence_download" | "rally_download":
                return Download(asked, ask.path, (kind,))
            case "mission_clear" | "fence_clear" | "rally_clear":
                return Clear(asked, KINDS if kind is MissionType.ALL else (kind,))
            case "fence_put":
                return PutFence(asked)
            case "mission_set_current":
                return SetCurrent(asked, ask.item, self._on_board)
            case "mission_check" if self._on_board is not None:
                return Check(asked, self._on_board, ask.mode)
            case "mission_check":
                return CheckUnknown(asked, ask.mode)
        if state not in (State.HOVERING, State.GROUNDED):
            return None
        begin_seq, self._begin_seq = self._begin_seq, None
        if state is State.GROUNDED:
            begin_seq = None
        if self._on_board is not None:
            return Start(asked, self._on_board, begin_seq)
        return Adopt(asked) if policy.bridge.on_board == "verify" else None

    def _cannot_begin(
        self,
        ask: ipc.Ask,
        view: VehicleView | None,
        plan: ClientPlan | None,
        kind: MissionType,
    ) -> Refusal | None:
        """What refuses any job before it begins."""
        if self._left:
            return Refusal(Code.OPERATOR_LOST, "the station is leaving")
        if view is None or view.state is State.NO_VEHICLE:
            return Refusal(Code.NO_VEHICLE, "no vehicle is heard")
        telemetry, state, policy = view.telemetry, view.state, view.policy
        if self.job is not None:
            return Refusal(Code.BUSY, f"{self.job.asked.word} is still under way")
        if ask.word == "mission_check":
            return self._cannot_check(state, policy)
        if ask.word.endswith("_upload") and plan is None and not ask.path:
            return Refusal(Code.BAD_MISSION, "which file?")
        of_mission = kind in (MissionType.MISSION, MissionType.ALL)
        if ask.word in ("mission_upload", "mission_clear") and of_mission:
            starting = ask.word == "mission_upload" and not is_placed(telemetry)
            if state is State.STALE and not starting:  # else the job waits for it
                return Refusal(Code.STALE, "the vehicle's position is too old")
            if state is State.FLYING_MISSION or flown_by_mode(telemetry):
                return Refusal(Code.BUSY, "the mission on board is being flown")
        return None

    def _cannot_check(self, state: State, policy: Policy) -> Refusal | None:
        """A mission is checked on the ground; in the air its start does that."""
        if state is State.STALE:
            return Refusal(Code.STALE, "the vehicle's position is too old")
        if state is not State.GROUNDED:
            return Refusal(Code.ALREADY_FLYING, "in the air the start of a mission verifies it")
        if self._on_board is None and policy.bridge.on_board != "verify":
            return NO_MISSION
        return None

    # -------------------------------------------------------------------------------- input

    def file(self, news: FileRead | FileWritten, view: VehicleView, now_ns: int) -> list[Work]:
        """The answer to a ReadFile or WriteFile of the job under way."""
        if self.job is None or news.token != self.job.asked.request_id:
            return []
        return self._follow(self.job.file(news, view, now_ns))

    def heard(self, heard: Heard, view: VehicleView, now_ns: int) -> list[Work]:
        """A message of the vehicle: about progress in flight, or for the transfer under way."""
        work: list[Work] = []
        match heard.message:
            case MissionCurrent(seq=seq, mission_state=state) as told:
                self._told.heard(told, self._on_board, first_item(view.telemetry), now_ns)
                if why := self._told.replaced(self._on_board):
                    work += self._forget_flown(why, view)
                self._was_active |= state == MissionState.ACTIVE
                over = state == MissionState.COMPLETE and self._was_active
                work += self._progress(seq, over)
            case MissionCount(count=count, mission_type=MissionType.MISSION):
                self._told.counted(count, first_item(view.telemetry))
            case MissionAck(type=MissionResult.ACCEPTED, mission_type=MissionType.MISSION):
                self._taken_ns = now_ns
                self._told.changed()  # by whomever
                if isinstance(self.job, BringingJob):
                    self._own_text_until_ns = now_ns + self._times.real_ns(TEXT_WITHIN_NS)
            case MissionItemReached(seq=seq):
                work += self._reached(seq)
        if self.job is not None:
            work += self._follow(self.job.heard(heard, view, now_ns))
        return work

    @property
    def unverified(self) -> str:
        """What is wrong with the mission on board, as the vehicle tells of it.  Empty where it was
        verified, or where there is none."""
        return self._told.unverified(self._on_board)

    @property
    def told(self) -> bool:
        """Whether the vehicle has told what is on board."""
        return self._told.known

    @property
    def does_not_clear(self) -> bool:
        """The mission on board was read, and is none that may be flown."""
        return self._told.does_not_clear(self._on_board)

    def ask_how_many(self, view: VehicleView) -> list[Work]:
        """Ask for the number of items of a vehicle that has not told it: a PX4 1.14."""
        if self._told.known or self.job is not None:
            return []
        telemetry = view.telemetry
        return [Send(MissionRequestList(telemetry.sysid, telemetry.compid, MissionType.MISSION))]

    def said(self, text: str, view: VehicleView, now_ns: int) -> list[Work]:
        """A text of the vehicle: ArduPilot's of a mission that it was sent, by whomever.

        That of our own upload may come when the mission is flown already.
        """
        if text != PLAN_RECEIVED:
            return []
        if now_ns < self._own_text_until_ns:
            self._own_text_until_ns = 0
            return []
        self._told.forget_refused()
        if self._on_board is None:
            return []
        return self._forget_flown(f'another mission was put on board ("{text}")', view)

    def _forget_flown(self, why: str, view: VehicleView) -> list[Work]:
        """The station itself uploads and clears no mission that is flown."""
        if view.state is not State.FLYING_MISSION:
            return []
        self._on_board, self._begin_seq = None, None
        self._told.learn_anew()
        log = Log(Level.ERROR, NODE, f"While its mission is flown: {why}")
        return [log, GateInput(MissionLoaded("", 0))]

    def wake(self, view: VehicleView, now_ns: int) -> list[Work]:
        if self.job is None:
            return []
        return self._follow(self.job.wake(view, now_ns))

    def forget(self) -> list[Work]:
        """The vehicle restarted or was away: nothing is known of what it has on board, and no start
        goes on that stands on what it was asked before."""
        work = self._follow(self.job.stop()) if isinstance(self.job, StartingJob) else []
        self._told.forget()
        self._begin_seq = None
        if self._on_board is None:
            return work
        self._on_board = None
        return [*work, GateInput(MissionLoaded("", 0))]

    def stop(self, request_id: int) -> list[Work]:
        """Whoever asked for the transfer `request_id`, somebody stops it, if it is under way."""
        if self.job is None or self.job.asked.request_id != request_id:
            return []
        return self._follow(self.job.stop())

    def overruled(self, given: Input) -> list[Work]:
        """Whatever stops the vehicle stops a mission start, too, that is still being prepared."""
        if self.job is None or not isinstance(self.job, StartingJob):
            return []
        match given:
            case Requested(request=request) if event_of(request) in STOPS:
                return self._follow(self.job.stop())
            case OperatorLost():
                return self._follow(self.job.leave())
            case _:
                return []

    def leave(self) -> list[Work]:
        """The session ends: the job under way ends with it."""
        self._left = True
        return [] if self.job is None else self._follow(self.job.leave())

    def _follow(self, job_work: list[JobWork]) -> list[Work]:
        """Keep what a job says about the mission on board; pass on the rest."""
        work: list[Work] = []
        for item in job_work:
            if isinstance(item, OnBoardChanged):
                self._on_board, self._begin_seq = item.on_board, None
                self._path_ned = item.path_ned
                self._told.learn_anew()
                self._told.forget_refused()
                if item.on_board is not None:
                    self.total = len(item.on_board.sent)
            elif isinstance(item, OnBoardRefused):
                self._told.refused(item.items, item.why)
            elif isinstance(item, PathVerified):
                self.legs_ned = item.legs_ned
            elif isinstance(item, BeginsAt):
                self._begin_seq = item.seq
            else:
                if isinstance(item, AskGate):
                    self._was_active = False
                work.append(item)
        if self.job is not None and self.job.over:
            self.job = None
        return work

    # ----------------------------------------------------------------------------- progress

    def _reached(self, seq: int) -> list[Work]:
        if self._on_board is None:
            return []
        last = self._on_board.last_seq is not None and seq >= self._on_board.last_seq
        if last and self._on_board.loops:
            # It may be over now; whether it is, the vehicle's mode tells.
            seq = (self.total or 1) - 1
        return self._progress(seq, last and not self._on_board.loops)

    def _progress(self, seq: int, finished: bool) -> list[Work]:
        if self._on_board is None:
            return []
        over = finished and self._on_board.last_seq is not None
        return [GateInput(MissionSeen(seq, self.total or 0, over))]
