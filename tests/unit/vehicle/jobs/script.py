"""Scripts for mission jobs: a vehicle that keeps missions as the standard says, and a clock.

https://mavlink.io/en/services/mission.html, the vehicle's side.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable
from typing import TypeVar

import msgspec

from gcs.gate.effects import Outcome, OutcomeKind, Ruling
from gcs.gate.inputs import MissionLoaded
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.policy.policy import Policy
from gcs.gate.refusal import Code
from gcs.gate.states import State
from gcs.plan.item_messages import item_of, message_of
from gcs.plan.wire import WireItem
from gcs.protocol.autopilot import PX4, Autopilot
from gcs.protocol.effects import Address, Heard, Send
from gcs.protocol.transfers.transfer import SPEC_TIMING
from gcs.session.effects import ReadFile, WriteFile
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.speedup_waits import Times
from gcs.session.work import AskGate, GateInput, GiveVerdict
from gcs.steps import drained
from gcs.vehicle.missions.jobs.job import Asked, Job, JobWork, OnBoardChanged, VehicleView
from gcs.vehicle.missions.plans import OnBoard, Prepared, on_board, prepare
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.ids import MissionResult
from gcs.wire.messages import (
    Message,
    MissionAck,
    MissionClearAll,
    MissionCount,
    MissionCurrent,
    MissionItemInt,
    MissionRequestInt,
    MissionRequestList,
    MissionSetCurrent,
    ParamError,
    ParamRequestRead,
    ParamSet,
    ParamValue,
)
from tests.unit.station.vehicles import HOME, SECOND_NS, vehicle

W = TypeVar("W")
START_NS = 100 * SECOND_NS
OWN = Address(255, 190)
ANSWERABLE = (MissionCount, MissionItemInt, MissionRequestList, MissionRequestInt, MissionClearAll)


def asked(word: str) -> Asked:
    """Request 7 of the session, number 70 of its client."""
    return Asked(7, 70, word, OWN, SPEC_TIMING, Times())


def placed(autopilot: Autopilot = PX4) -> Telemetry:
    """On the ground at home, which is the origin; everything of its place is known."""
    telemetry = vehicle(autopilot)
    telemetry.origin = HOME
    telemetry.home = (HOME.lat_deg, HOME.lon_deg, HOME.alt_amsl_m)
    telemetry.home_ned = telemetry.pos_ned = (0.0, 0.0, 0.0)
    telemetry.position_ns = START_NS
    telemetry.return_up_m = 30.0
    return telemetry


def brought(data: bytes, telemetry: Telemetry) -> OnBoard:
    """The plan in `data` as it is once it was uploaded and read back."""
    prepared = drained(prepare("a.plan", data, telemetry))
    assert isinstance(prepared, Prepared)
    return on_board(prepared.plan, prepared.sent)


PARAMETERS = {
    "NAV_ACC_RAD": 2.0,
    "NAV_MC_ALT_RAD": 0.8,
    "MIS_TAKEOFF_ALT": 2.5,
    "RTL_RETURN_ALT": 30.0,
    "RTL_MIN_DIST": 10.0,
    "WPNAV_RADIUS": 200.0,
    "RTL_ALT": 1500.0,
    "RTL_CONE_SLOPE": 3.0,
}
"""As delivered; what is not here is answered with PARAM_ERROR, as by ArduPilot."""
REAL32 = 9


class Board:
    """The vehicle's store of missions, of rally points and of a fence, and its parameters."""

    def __init__(self, mission: OnBoard | None = None) -> None:
        sent = mission.sent if mission else ()
        self.items: list[MissionItemInt] = [message_of(item) for item in sent]
        self.heard: list[Message] = []
        self.deaf_to: list[type[Message]] = []
        """Kinds that never reach it, where they are about the mission or a parameter."""
        self.mute_ack = False
        """Its MISSION_ACKs never reach us."""
        self.deaf_from_seq = 1 << 16
        """Items from this one on never reach it."""
        self.refuses: MissionResult | None = None
        self.lists: dict[int, list[MissionItemInt]] = {1: [], 2: []}
        """Its fence and its rally points."""
        self.silent_lists: set[int] = set()
        """Of these kinds of plans it is asked in vain."""
        self.parameters = dict(PARAMETERS)
        self.stubborn: set[str] = set()
        """Parameters that stay as they are."""
        self._coming: list[MissionItemInt] = []
        self._count = 0

    def hear(self, message: Message) -> list[Message]:
        self.heard.append(message)
        about_mission = getattr(message, "mission_type", 0) == 0
        if type(message) in self.deaf_to and about_mission:
            return []
        if self.refuses is not None and isinstance(message, ANSWERABLE) and about_mission:
            return [self._ack(self.refuses)]
        match message:
            case ParamRequestRead(param_id=name):
                return [self._parameter(name)]
            case MissionCount(count=count, mission_type=kind):
                self._count, self._coming = count, []
                return [self._request(0, kind)]
            case MissionItemInt():
                return self._item(message)
            case MissionRequestList(mission_type=kind) if kind in self.silent_lists:
                return []
            case ParamSet(param_id=name, param_value=value) if name in self.parameters:
                if name not in self.stubborn:
                    self.parameters[name] = value
                return [self._parameter(name)]
            case MissionRequestList(mission_type=kind):
                return [MissionCount(count=len(self._list(kind)), mission_type=kind, **self._to())]
            case MissionRequestInt(seq=seq, mission_type=kind):
                item = self._list(kind)[seq]
                return [msgspec.structs.replace(item, seq=seq, mission_type=kind, **self._to())]
            case MissionSetCurrent(seq=seq):
                return [MissionCurrent(seq, 0, 0, 0, 0, 0, 0)]
            case MissionClearAll(mission_type=kind):
                self._list(kind).clear()
                return self._acked(kind)
            case _:
                return []

    def _list(self, kind: int) -> list[MissionItemInt]:
        return self.lists[kind] if kind else self.items

    def _parameter(self, name: str) -> Message:
        if name in self.parameters:
            value = self.parameters[name]
            return ParamValue(value, 1, 0, name, REAL32)
        return ParamError(param_index=-1, param_id=name, error=1, **self._to())

    def _item(self, item: MissionItemInt) -> list[Message]:
        if item.seq >= self.deaf_from_seq:
            return []
        if item.seq == len(self._coming):
            self._coming.append(item)
        if len(self._coming) < self._count:
            return [self._request(len(self._coming), item.mission_type)]
        if item.mission_type:
            self.lists[item.mission_type] = self._coming
        else:
            self.items = self._coming
        return self._acked(item.mission_type)

    def _acked(self, kind: int = 0) -> list[Message]:
        return [] if self.mute_ack else [self._ack(MissionResult.ACCEPTED, kind)]

    def _ack(self, result: MissionResult, kind: int = 0) -> MissionAck:
        return MissionAck(type=result, mission_type=kind, **self._to())

    def _request(self, seq: int, kind: int) -> MissionRequestInt:
        return MissionRequestInt(seq=seq, mission_type=kind, **self._to())

    def _to(self) -> dict[str, int]:
        return {"target_system": OWN.sysid, "target_component": OWN.compid}


class JobScript:
    """One job, from its start to its end."""

    def __init__(
        self,
        job: Job,
        board: Board,
        telemetry: Telemetry | None = None,
        state: State = State.GROUNDED,
        policy: Policy = DEFAULT,
    ) -> None:
        self.job, self.board = job, board
        self.now_ns = START_NS
        self.telemetry = telemetry or placed()
        self.state, self.policy = state, policy
        self.work: list[JobWork] = []
        self._on_air: deque[Message] = deque()
        self.on_board: tuple[tuple[WireItem, ...] | None, tuple[WireItem, ...] | None]
        lists = (tuple(map(item_of, board.lists[kind])) for kind in (1, 2))
        self.on_board = (next(lists), next(lists))
        self._take(job.start(self.view, self.now_ns))

    @property
    def view(self) -> VehicleView:
        """The fence and the rally points on board are known as they were before the job."""
        return VehicleView(self.telemetry, self.state, self.policy, *self.on_board)

    # ------------------------------------------------------------------------------ inputs

    def read(self, data: bytes | None, error: str = "") -> JobScript:
        """The answer to the ReadFile that it asked for."""
        (ask,) = self.of(ReadFile)
        self._take(
            self.job.file(FileRead(ask.token, ask.path, data, error), self.view, self.now_ns)
        )
        return self

    def written(self, error: str = "") -> JobScript:
        (ask,) = self.of(WriteFile)
        news = FileWritten(ask.token, ask.path, error)
        self._take(self.job.file(news, self.view, self.now_ns))
        return self

    def stop(self) -> JobScript:
        self._take(self.job.stop())
        return self

    def leave(self) -> JobScript:
        self._take(self.job.leave())
        return self

    def run(self, seconds: float) -> JobScript:
        """Let time pass, as the session does: it wakes a job at every tick."""
        for _ in range(round(seconds * 20)):
            if self.job.over:
                break
            self.now_ns += SECOND_NS // 20
            self.telemetry.position_ns = self.now_ns
            self._take(self.job.wake(self.view, self.now_ns))
        return self

    def wake(self) -> JobScript:
        """Let time pass to its deadline."""
        self.now_ns = max(self.now_ns, self.job.deadline_ns or 0)
        self._take(self.job.wake(self.view, self.now_ns))
        return self

    def hear(self, *messages: Message, sysid: int = 1) -> JobScript:
        """Messages that the vehicle sends though nothing was asked, or another one in its place."""
        for message in messages:
            self._take(self.job.heard(Heard(sysid, 1, message), self.view, self.now_ns))
        return self

    def _take(self, work: Iterable[JobWork]) -> None:
        """Keep what it returned; then the vehicle's answers, in order."""
        for item in work:
            self.work.append(item)
            if isinstance(item, Send):
                self._on_air += self.board.hear(item.message)
        while self._on_air:
            self.hear(self._on_air.popleft())

    # -------------------------------------------------------------------------------- looks

    def of(self, kind: type[W]) -> list[W]:
        return [item for item in self.work if isinstance(item, kind)]

    @property
    def refused(self) -> Code:
        """It is over with one verdict, a refusal, and no outcome."""
        (verdict,) = self.of(GiveVerdict)
        assert self.job.over
        assert self.of(Outcome) == []
        assert self.of(AskGate) == []
        assert (verdict.request_id, verdict.ruling) == (7, Ruling.REFUSED)
        assert verdict.refusal is not None
        return verdict.refusal.code

    @property
    def accepted(self) -> bool:
        """It has its one verdict, and is under way."""
        return [verdict.ruling for verdict in self.of(GiveVerdict)] == [Ruling.ACCEPTED]

    @property
    def outcome(self) -> tuple[OutcomeKind, Code | None]:
        """It is over with one verdict, accepted, and then one outcome."""
        (outcome,) = self.of(Outcome)
        assert self.job.over
        assert self.accepted
        assert self.work.index(self.of(GiveVerdict)[0]) < self.work.index(outcome)
        assert outcome.request_id == 7
        return outcome.kind, outcome.code

    @property
    def sentence(self) -> str:
        """Why, in words."""
        refusals = [decide.refusal.sentence for decide in self.of(GiveVerdict) if decide.refusal]
        return " ".join([*refusals, *(outcome.sentence for outcome in self.of(Outcome))])

    @property
    def loaded(self) -> list[tuple[str, int]]:
        """What the gate was told to be on board, in order."""
        given = [item.given for item in self.of(GateInput)]
        return [(told.name, told.items) for told in given if isinstance(told, MissionLoaded)]

    @property
    def kept(self) -> list[OnBoard | None]:
        """What the session was told to be on board, in order."""
        return [item.on_board for item in self.of(OnBoardChanged)]

    def sent(self, kind: type[W]) -> list[W]:
        return [item.message for item in self.of(Send) if isinstance(item.message, kind)]
