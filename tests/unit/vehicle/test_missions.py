"""Missions of one vehicle: one job at a time, which mission is on board, how far it is flown."""

from __future__ import annotations

import json
from collections.abc import Callable

import pytest
from msgspec import structs

from gcs import ipc
from gcs.gate.effects import Outcome, Ruling
from gcs.gate.inputs import MissionLoaded, MissionPathVerified, MissionSeen
from gcs.gate.policy.parse import DEFAULT
from gcs.gate.refusal import Code
from gcs.gate.requests import StartMission
from gcs.gate.states import State
from gcs.protocol.effects import Address, Heard, Send
from gcs.session.effects import ReadFile, WriteFile
from gcs.session.inputs import FileRead, FileWritten
from gcs.session.speedup_waits import Times
from gcs.session.work import AskGate, GateInput, GiveVerdict, Work
from gcs.vehicle.missions.jobs.job import VehicleView
from gcs.vehicle.missions.missions import PLAN_RECEIVED, PX4_CHECKS_NS, Missions
from gcs.vehicle.talk.telemetry import Telemetry
from gcs.wire.messages import Message, MissionAck, MissionCount, MissionCurrent, MissionItemReached
from tests.unit.plan import samples
from tests.unit.station.vehicles import SECOND_NS
from tests.unit.vehicle.jobs.script import START_NS, Board, brought, placed
from tests.unit.vehicle.plans import BOX, FAR, LAT, LON, plan

ACTIVE, COMPLETE = 3, 5
"""MISSION_STATE."""
FOUR = 4
OPEN_END = plan(samples.waypoint(1, LAT, LON, 10, command=22), samples.waypoint(2, LAT, LON, 12))
"""It ends hovering at its second item."""
LOOP = plan(
    samples.waypoint(1, LAT, LON, 10, command=22),
    samples.waypoint(2, LAT, LON, 12),
    samples.simple(3, 177, 2, [2, 3, 0, 0, 0, 0, 0]),  # back to item 2, three times
)


class Script:
    """The missions of one px4, a board that keeps them, and a clock."""

    def __init__(self) -> None:
        self.missions = Missions(Address(255, 190), Times())
        self.board = Board()
        self.telemetry: Telemetry | None = placed()
        self.state = State.GROUNDED
        self.policy = DEFAULT
        self.now_ns = START_NS
        self._requests = 0

    def ask(self, word: str, path: str = "") -> list[Work]:
        """The next request; its id is `self.last`."""
        self._requests += 1
        ask = ipc.Ask(100 + self._requests, word, path=path)
        view = None if self.telemetry is None else self.view()
        work = self.missions.ask(self._requests, ask, view, self.now_ns)
        return self.with_replies(work)

    @property
    def last(self) -> int:
        return self._requests

    def read(self, data: bytes, token: int | None = None) -> list[Work]:
        news = FileRead(self.last if token is None else token, "a.plan", data)
        return self.with_replies(self.missions.file(news, self.view(), self.now_ns))

    def written(self, token: int) -> list[Work]:
        news = FileWritten(token, "out.plan")
        return self.with_replies(self.missions.file(news, self.view(), self.now_ns))

    def hear(self, message: Message) -> list[Work]:
        heard = Heard(1, 1, message)
        return self.with_replies(self.missions.heard(heard, self.view(), self.now_ns))

    def upload(self, data: bytes) -> None:
        self.ask("mission_upload", "a.plan")
        work = self.read(data)
        while (due_ns := self.missions.deadline_ns) is not None:
            self.now_ns = max(self.now_ns, due_ns)  # a long plan is verified in steps
            work += self.with_replies(self.missions.wake(self.view(), self.now_ns))
        (ended,) = [item for item in work if isinstance(item, Outcome)]
        assert ended.code is None
        self.now_ns += PX4_CHECKS_NS

    def view(self) -> VehicleView:
        assert self.telemetry is not None
        return VehicleView(self.telemetry, self.state, self.policy)

    def with_replies(self, work: list[Work]) -> list[Work]:
        done: list[Work] = []
        agenda = list(work)
        while agenda:
            item = agenda.pop(0)
            done.append(item)
            if isinstance(item, Send):
                for reply in self.board.hear(item.message):
                    heard = Heard(1, 1, reply)
                    agenda += self.missions.heard(heard, self.view(), self.now_ns)
        return done


def refusals(work: list[Work]) -> list[tuple[int, Code]]:
    verdicts = [item for item in work if isinstance(item, GiveVerdict)]
    return [(v.request_id, v.refusal.code) for v in verdicts if v.refusal is not None]


def rulings(work: list[Work]) -> list[Ruling]:
    return [item.ruling for item in work if isinstance(item, GiveVerdict)]


def seen(work: list[Work]) -> list[MissionSeen]:
    given = [item.given for item in work if isinstance(item, GateInput)]
    return [told for told in given if isinstance(told, MissionSeen)]


def current(seq: int, state: int = ACTIVE) -> MissionCurrent:
    return MissionCurrent(seq=seq, total=FOUR, mission_state=state)


# ---------------------------------------------------------------------------- what is refused


@pytest.mark.parametrize("word", ["mission_upload", "mission_download", "mission_clear"])
def test_while_one_job_is_under_way_another_is_refused_and_does_it_no_harm(word: str) -> None:
    script = Script()
    script.ask("mission_upload", "a.plan")
    work = script.ask(word, "b.plan")
    assert refusals(work) == [(2, Code.BUSY)]
    assert rulings(script.read(BOX, token=1)) == [Ruling.ACCEPTED]


def test_after_a_job_has_ended_the_next_may_begin() -> None:
    script = Script()
    script.upload(BOX)
    assert rulings(script.ask("mission_download")) == [Ruling.ACCEPTED]
    assert rulings(script.ask("mission_clear")) == [Ruling.ACCEPTED]


def test_after_a_job_was_refused_the_next_may_begin() -> None:
    script = Script()
    script.ask("mission_upload", "a.plan")
    assert refusals(script.read(b"no plan")) == [(1, Code.BAD_MISSION)]
    assert rulings(script.ask("mission_download")) == [Ruling.ACCEPTED]


@pytest.mark.parametrize(
    ("word", "state", "code"),
    [
        ("mission_upload", State.NO_VEHICLE, Code.NO_VEHICLE),
        ("mission_download", State.NO_VEHICLE, Code.NO_VEHICLE),
        ("mission_start", State.NO_VEHICLE, Code.NO_VEHICLE),
        ("mission_upload", State.STALE, Code.STALE),
        ("mission_clear", State.STALE, Code.STALE),
        ("mission_upload", State.FLYING_MISSION, Code.BUSY),
        ("mission_clear", State.FLYING_MISSION, Code.BUSY),
    ],
)
def test_where_it_cannot_be_it_is_refused_and_nothing_is_asked_of_anybody(
    word: str, state: State, code: Code
) -> None:
    script = Script()
    script.state = state
    work = script.ask(word, "a.plan")
    assert refusals(work) == [(1, code)]
    assert not any(isinstance(item, Send | ReadFile | AskGate) for item in work)


def test_a_mission_may_be_read_while_it_is_flown() -> None:
    script = Script()
    script.state = State.FLYING_MISSION
    assert rulings(script.ask("mission_download")) == [Ruling.ACCEPTED]


def test_before_a_vehicle_is_met_there_is_nobody_to_ask() -> None:
    script = Script()
    script.telemetry = None
    assert refusals(script.ask("mission_download")) == [(1, Code.NO_VEHICLE)]


def test_an_upload_wants_a_file() -> None:
    assert refusals(Script().ask("mission_upload")) == [(1, Code.BAD_MISSION)]


def test_after_leaving_nothing_begins() -> None:
    script = Script()
    assert script.missions.leave() == []
    assert refusals(script.ask("mission_download")) == [(1, Code.OPERATOR_LOST)]


def test_leaving_ends_the_job_under_way_once() -> None:
    script = Script()
    script.ask("mission_upload", "a.plan")
    assert refusals(script.missions.leave()) == [(1, Code.OPERATOR_LOST)]
    assert script.missions.leave() == []
    assert script.read(BOX) == []


# --------------------------------------------------------------------------------- the start


@pytest.mark.parametrize("state", [State.GROUNDED, State.HOVERING])
def test_without_a_mission_of_ours_what_is_on_board_is_looked_up_before_a_start(
    state: State,
) -> None:
    """There is none: that is the gate's to refuse."""
    script = Script()
    script.state = state
    work = script.ask("mission_start")
    assert isinstance(work[0], Send)
    assert work[-1] == AskGate(1, StartMission())
    assert not any(isinstance(item, GateInput) for item in work)


def test_where_the_policy_wants_no_other_mission_none_is_looked_up() -> None:
    script = Script()
    bridge = structs.replace(DEFAULT.bridge, on_board="refuse")
    script.policy = structs.replace(DEFAULT, bridge=bridge)
    assert script.ask("mission_start") == [AskGate(1, StartMission())]


def test_where_none_can_be_started_nothing_on_board_is_looked_up() -> None:
    script = Script()
    script.state = State.EXTERNAL
    assert script.ask("mission_start") == [AskGate(1, StartMission())]


def test_where_no_mission_can_be_started_nothing_is_read_back_first() -> None:
    script = Script()
    script.upload(BOX)
    script.state = State.MOVING
    assert script.ask("mission_start") == [AskGate(2, StartMission())]


@pytest.mark.parametrize("word", ["mission_start", "mode"])
def test_in_whatever_word_a_start_is_read_back_and_verified_before_the_gate_is_asked(
    word: str,
) -> None:
    script = Script()
    script.upload(BOX)
    script.state = State.HOVERING
    work = script.ask(word)
    assert isinstance(work[0], Send)
    assert work[-1] == AskGate(2, StartMission())


def test_a_px4_is_given_the_time_to_check_what_it_has_taken() -> None:
    script = Script()
    script.upload(BOX)
    script.now_ns -= PX4_CHECKS_NS
    script.state = State.HOVERING
    work = script.ask("mission_start")
    assert not any(isinstance(item, AskGate) for item in work)
    assert script.missions.deadline_ns == script.now_ns + PX4_CHECKS_NS
    script.now_ns += PX4_CHECKS_NS
    assert script.missions.wake(script.view(), script.now_ns)[-1] == AskGate(2, StartMission())


def test_after_a_restart_of_the_vehicle_nothing_is_known_of_what_is_on_board() -> None:
    script = Script()
    script.upload(BOX)
    assert script.missions.forget() == [GateInput(MissionLoaded("", 0))]
    assert script.missions.forget() == []
    assert seen(script.hear(current(1))) == []
    work = script.ask("mission_start")
    loaded, path = (item.given for item in work if isinstance(item, GateInput))
    assert loaded == MissionLoaded("the mission on board", FOUR)
    assert isinstance(path, MissionPathVerified)
    assert path.within.holds((0.0, 0.0, 0.0))
    assert work[-1] == AskGate(2, StartMission())


# ---------------------------------------------------------------------------------- answers


def test_the_answer_to_another_request_s_file_is_none_to_this_one_s() -> None:
    script = Script()
    script.ask("mission_upload", "a.plan")
    assert script.read(BOX, token=99) == []
    assert rulings(script.read(BOX)) == [Ruling.ACCEPTED]


def test_a_late_answer_to_a_job_that_is_over_is_nobody_s() -> None:
    script = Script()
    script.upload(BOX)
    assert script.read(BOX, token=1) == []
    work = script.ask("mission_download", "out.plan")
    assert any(isinstance(item, WriteFile) for item in work)
    assert script.written(token=1) == []
    assert any(isinstance(item, Outcome) for item in script.written(token=2))


def test_a_job_s_time_is_the_missions_time() -> None:
    script = Script()
    assert script.missions.deadline_ns is None
    script.ask("mission_upload", "a.plan")
    assert script.missions.deadline_ns is None  # it waits for a file, not for the vehicle
    script.board.deaf_to = [MissionCount]
    script.read(BOX)
    assert script.missions.deadline_ns == START_NS + 3 * SECOND_NS // 2


# --------------------------------------------------------------------------------- progress


def test_of_a_mission_that_is_not_ours_there_is_no_progress() -> None:
    script = Script()
    assert seen(script.hear(current(1))) == []
    assert seen(script.hear(MissionItemReached(seq=1))) == []


def test_the_gate_sees_which_item_is_flown() -> None:
    script = Script()
    script.upload(BOX)
    assert script.missions.total == FOUR
    assert seen(script.hear(current(2))) == [MissionSeen(2, FOUR, False)]
    assert seen(script.hear(MissionItemReached(seq=1))) == [MissionSeen(1, FOUR, False)]


def test_the_last_item_reached_ends_a_mission_that_ends_in_the_air() -> None:
    script = Script()
    script.upload(OPEN_END)
    assert seen(script.hear(MissionItemReached(seq=0))) == [MissionSeen(0, 2, False)]
    assert seen(script.hear(MissionItemReached(seq=1))) == [MissionSeen(1, 2, True)]


@pytest.mark.parametrize("message", [MissionItemReached(seq=3), current(3, COMPLETE)])
def test_a_mission_that_ends_with_a_landing_is_over_when_it_has_landed(message: Message) -> None:
    script = Script()
    script.upload(BOX)
    script.hear(current(3))
    assert [told.finished for told in seen(script.hear(message))] == [False]


def test_a_mission_that_the_vehicle_calls_complete_is_over() -> None:
    script = Script()
    script.upload(OPEN_END)
    script.hear(current(1))
    assert seen(script.hear(current(1, COMPLETE))) == [MissionSeen(1, 2, True)]


def test_complete_before_it_was_seen_flying_is_of_the_mission_before() -> None:
    script = Script()
    script.upload(OPEN_END)
    assert seen(script.hear(current(1, COMPLETE))) == [MissionSeen(1, 2, False)]
    script.hear(current(0))
    script.state = State.HOVERING
    script.ask("mission_start")
    assert seen(script.hear(current(1, COMPLETE))) == [MissionSeen(1, 2, False)]


def test_a_mission_that_jumps_back_is_not_over_at_its_last_stop() -> None:
    script = Script()
    script.upload(LOOP)
    last_item = MissionSeen(2, 3, False)  # from there on its mode tells whether it is over
    assert seen(script.hear(MissionItemReached(seq=1))) == [last_item]
    script.hear(current(1))
    (told,) = seen(script.hear(current(1, COMPLETE)))
    assert told.finished


def test_a_refused_upload_leaves_the_mission_on_board_as_it_is() -> None:
    script = Script()
    script.upload(BOX)
    script.ask("mission_upload", "b.plan")
    script.read(json.dumps({}).encode())
    assert seen(script.hear(current(2))) == [MissionSeen(2, FOUR, False)]


def acknowledged(script: Script) -> None:
    """An upload of anybody's, as the vehicle tells it."""
    script.hear(MissionAck(target_system=254, target_component=190, type=0, mission_type=0))


def said(script: Script) -> None:
    script.missions.said(PLAN_RECEIVED, script.view(), script.now_ns)


def test_the_text_of_an_upload_of_our_own_may_come_when_it_is_flown_already() -> None:
    """ArduCopter's comes up to 0.1 s later; the one after it is of somebody else's upload."""
    script = Script()
    script.upload(BOX)
    script.state = State.FLYING_MISSION
    said(script)
    assert script.missions.items
    said(script)
    assert not script.missions.items


@pytest.mark.parametrize("uploaded", [acknowledged, said])
def test_what_was_found_in_the_mission_on_board_is_named_until_another_is_brought(
    uploaded: Callable[[Script], None],
) -> None:
    script = Script()
    script.board = Board(brought(FAR, placed()))
    items = len(script.board.items)
    work = script.ask("mission_check")
    while (due_ns := script.missions.deadline_ns) is not None:
        script.now_ns = max(script.now_ns, due_ns)
        work += script.with_replies(script.missions.wake(script.view(), script.now_ns))
    assert refusals(work)
    script.hear(MissionCurrent(0, items, 0, 0, 0, 0, 0))
    assert "item 2" in script.missions.unverified
    uploaded(script)
    assert "was not verified" in script.missions.unverified
