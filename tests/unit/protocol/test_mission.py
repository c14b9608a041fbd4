"""The mission protocol, ground station's side: a script, then a vehicle behind a bad link."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Protocol

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcs.protocol.effects import (
    Address,
    Cancel,
    Heard,
    Send,
    TransferDone,
    TransferEffect,
    TransferFailed,
    TransferProgress,
    Wake,
)
from gcs.protocol.mission import MissionClear, MissionDownload, MissionUpload
from gcs.protocol.transfers.transfer import Input
from gcs.wire.ids import Cmd, MavFrame, MissionResult, MissionType
from gcs.wire.messages import (
    Message,
    MissionAck,
    MissionClearAll,
    MissionCount,
    MissionItemInt,
    MissionRequest,
    MissionRequestInt,
    MissionRequestList,
)
from tests.shares import examples

OWN = Address(255, 190)
VEHICLE = Address(1, 1)
MS = 1_000_000
WAIT_NS = 1_500 * MS
SPEC_RETRIES = 5
ITEM_WAIT_NS = 250 * MS
PLAN = MissionType.MISSION


class Machine(Protocol):
    @property
    def deadline_ns(self) -> int | None: ...
    def start(self, now_ns: int) -> list[TransferEffect]: ...
    def handle(self, event: Input, now_ns: int) -> list[TransferEffect]: ...


def item(seq: int, target: Address = VEHICLE) -> MissionItemInt:
    return MissionItemInt(
        param1=float(seq),
        param2=0.0,
        param3=0.0,
        param4=0.0,
        x=473_977_420 + seq,
        y=85_455_940,
        z=10.0,
        seq=seq,
        command=Cmd.NAV_WAYPOINT,
        target_system=target.sysid,
        target_component=target.compid,
        frame=MavFrame.GLOBAL_RELATIVE_ALT_INT,
        current=0,
        autocontinue=1,
    )


THREE = tuple(item(seq) for seq in range(3))


def ack(result: MissionResult, kind: MissionType = PLAN, to: Address = OWN) -> MissionAck:
    return MissionAck(
        target_system=to.sysid, target_component=to.compid, type=result, mission_type=kind
    )


def request(seq: int, kind: MissionType = PLAN) -> MissionRequestInt:
    return MissionRequestInt(
        seq=seq, target_system=OWN.sysid, target_component=OWN.compid, mission_type=kind
    )


def old_request(seq: int) -> MissionRequest:
    return MissionRequest(seq=seq, target_system=OWN.sysid, target_component=OWN.compid)


def count(items: int, kind: MissionType = PLAN) -> MissionCount:
    return MissionCount(
        count=items, target_system=OWN.sysid, target_component=OWN.compid, mission_type=kind
    )


class Script:
    """A machine, its clock, and what it sent and said."""

    def __init__(self, machine: Machine) -> None:
        self.machine = machine
        self.now_ns = 0
        self.sent: list[Message] = []
        self.said: list[TransferEffect] = []
        self._keep(machine.start(0))

    def _keep(self, effects: list[TransferEffect]) -> None:
        for effect in effects:
            if isinstance(effect, Send):
                self.sent.append(effect.message)
            else:
                self.said.append(effect)

    def hear(self, message: Message, source: Address = VEHICLE) -> None:
        heard = Heard(source.sysid, source.compid, message)
        self._keep(self.machine.handle(heard, self.now_ns))

    def cancel(self) -> None:
        self._keep(self.machine.handle(Cancel(), self.now_ns))

    def wait(self, ns: int) -> None:
        end_ns = self.now_ns + ns
        while self.machine.deadline_ns is not None and self.machine.deadline_ns <= end_ns:
            self.now_ns = self.machine.deadline_ns
            self._keep(self.machine.handle(Wake(), self.now_ns))
        self.now_ns = end_ns

    @property
    def ending(self) -> TransferEffect:
        endings = [e for e in self.said if isinstance(e, TransferDone | TransferFailed)]
        assert len(endings) == 1
        assert endings[0] is self.said[-1]
        assert self.machine.deadline_ns is None
        return endings[0]


def upload(kind: MissionType = PLAN, items: tuple[MissionItemInt, ...] = THREE) -> Script:
    return Script(MissionUpload(OWN, VEHICLE, kind, items))


def download(kind: MissionType = PLAN) -> Script:
    return Script(MissionDownload(OWN, VEHICLE, kind))


# ------------------------------------------------------------------------------- upload


def test_an_upload_answers_what_it_is_asked_and_ends_with_the_ack() -> None:
    flight = upload()
    for seq in range(3):
        flight.hear(request(seq))
    flight.hear(ack(MissionResult.ACCEPTED))
    assert flight.sent == [
        MissionCount(count=3, target_system=1, target_component=1),
        *THREE,
    ]
    assert flight.said[:3] == [TransferProgress(n, 3) for n in (1, 2, 3)]
    assert flight.ending == TransferDone(PLAN, THREE)


def test_seq_target_and_type_are_set_whatever_the_items_said() -> None:
    strange = tuple(
        msgspec.structs.replace(one, seq=99, target_system=7, mission_type=0) for one in THREE
    )
    flight = upload(MissionType.FENCE, strange)
    flight.hear(request(1, MissionType.FENCE))
    sent = flight.sent[-1]
    assert isinstance(sent, MissionItemInt)
    assert (sent.seq, sent.target_system, sent.mission_type) == (1, 1, MissionType.FENCE)


def test_the_old_request_is_answered_with_an_int_item() -> None:
    flight = upload()
    flight.hear(old_request(0))
    assert flight.sent[-1] == THREE[0]


def test_an_item_is_sent_again_as_often_as_it_is_asked_for() -> None:
    flight = upload()
    for seq in (0, 1, 1, 0, 2, 1):
        flight.hear(request(seq))
    assert flight.sent[1:] == [THREE[seq] for seq in (0, 1, 1, 0, 2, 1)]
    assert flight.said[:3] == [TransferProgress(n, 3) for n in (1, 2, 3)]


def test_while_the_last_answer_is_missing_a_question_is_a_sign_of_life_for_five_minutes() -> None:
    """A bridge brings the plan on board meanwhile, and asks for the last items again."""
    flight = upload()
    flight.hear(request(0))
    flight.hear(request(0))
    assert flight.said == [TransferProgress(1, 3)], "not while items are missing"
    flight.hear(request(1))
    flight.hear(request(2))
    for _ in range(30):
        flight.wait(10_000 * MS)
        flight.hear(request(1))
    assert flight.said == [
        *(TransferProgress(n, 3) for n in (1, 2, 3)),
        *[TransferProgress(3, 3)] * 29,
    ]
    flight.wait(10_000 * MS)
    assert flight.sent[-1] == THREE[1], "and the last item is sent again by itself"
    flight.hear(ack(MissionResult.ACCEPTED))
    assert flight.ending == TransferDone(PLAN, THREE)


def test_an_item_beyond_the_plan_is_not_sent() -> None:
    flight = upload()
    flight.hear(request(3))
    assert len(flight.sent) == 1


def test_a_lost_count_is_sent_again() -> None:
    flight = upload()
    flight.wait(2 * WAIT_NS)
    assert [type(message) for message in flight.sent] == [MissionCount] * 3
    flight.hear(request(0))
    assert flight.sent[-1] == THREE[0]


def test_an_item_after_which_nothing_came_is_sent_again() -> None:
    flight = upload()
    flight.hear(request(0))
    flight.wait(WAIT_NS)
    assert flight.sent[-2:] == [THREE[0], THREE[0]]


@pytest.mark.parametrize(
    ("asked", "words"),
    [(0, "did not answer"), (1, "stopped asking after item 0"), (3, "may have the plan or not")],
)
def test_silence_ends_an_upload_and_says_where(asked: int, words: str) -> None:
    flight = upload()
    for seq in range(asked):
        flight.hear(request(seq))
    flight.wait(22 * WAIT_NS)
    ending = flight.ending
    assert isinstance(ending, TransferFailed)
    assert ending.result is None
    assert words in ending.text
    assert len(flight.sent) - 1 - asked >= SPEC_RETRIES


def test_a_message_is_repeated_for_thirty_seconds() -> None:
    flight = upload()
    flight.wait(20 * WAIT_NS - MS)
    assert [type(message) for message in flight.sent] == [MissionCount] * 20
    flight.wait(MS)
    assert isinstance(flight.ending, TransferFailed)


def test_on_a_quick_link_an_item_is_asked_for_again_sooner() -> None:
    """An answer took 4 ms: asked again after 50 ms, a fifth of the specification's."""
    flight = download()
    flight.wait(4 * MS)
    flight.hear(count(2))
    flight.wait(50 * MS - 1)
    assert len(flight.sent) == 2
    flight.wait(1)
    assert flight.sent[-2:] == [MissionRequestInt(seq=0, target_system=1, target_component=1)] * 2


def test_an_answer_to_a_repeated_message_tells_nothing_of_the_link() -> None:
    flight = download()
    flight.wait(WAIT_NS + 4 * MS)
    flight.hear(count(2))
    flight.wait(ITEM_WAIT_NS - 1)
    asked = [type(message) for message in flight.sent]
    assert asked == [MissionRequestList] * 2 + [MissionRequestInt]
    flight.wait(1)
    assert len(flight.sent) == 4


def test_an_item_that_ardupilot_has_already_is_followed_by_the_next() -> None:
    """It answers a duplicate with INVALID_SEQUENCE; its question for the next was lost."""
    flight = upload()
    flight.hear(request(0))
    flight.hear(ack(MissionResult.INVALID_SEQUENCE))  # the network's duplicate: no news
    assert flight.sent[-1] == THREE[0]
    flight.wait(ITEM_WAIT_NS)
    flight.hear(ack(MissionResult.INVALID_SEQUENCE))
    assert flight.sent[-1] == THREE[1]
    flight.hear(ack(MissionResult.INVALID_SEQUENCE))
    assert flight.sent[-1] == THREE[1]
    flight.hear(request(2))
    flight.hear(ack(MissionResult.ACCEPTED))
    assert flight.ending == TransferDone(PLAN, THREE)


def test_a_refusal_ends_an_upload_with_its_result() -> None:
    flight = upload()
    flight.hear(request(0))
    flight.hear(ack(MissionResult.UNSUPPORTED))
    failed = TransferFailed(PLAN, MissionResult.UNSUPPORTED, "the vehicle answered UNSUPPORTED")
    assert flight.ending == failed


def test_an_acceptance_that_comes_too_early_is_an_old_one() -> None:
    flight = upload()
    flight.hear(ack(MissionResult.ACCEPTED))
    flight.hear(request(0))
    flight.hear(ack(MissionResult.ACCEPTED))
    assert flight.said == [TransferProgress(1, 3)]


def test_what_is_of_another_type_of_others_or_for_others_is_not_heard() -> None:
    flight = upload()
    for seq in range(3):
        flight.hear(request(seq))
    sent = len(flight.sent)
    flight.hear(ack(MissionResult.DENIED, MissionType.FENCE))
    flight.hear(ack(MissionResult.DENIED, to=Address(254, 190)))
    flight.hear(ack(MissionResult.DENIED), source=Address(2, 1))
    flight.hear(request(0, MissionType.RALLY))
    assert len(flight.said) == 3
    assert len(flight.sent) == sent
    flight.hear(ack(MissionResult.ACCEPTED))
    assert flight.ending == TransferDone(PLAN, THREE)


def test_an_empty_plan_is_accepted_at_once() -> None:
    flight = upload(items=())
    flight.hear(ack(MissionResult.ACCEPTED))
    assert flight.ending == TransferDone(PLAN, ())


@pytest.mark.parametrize("start", [upload, download])
def test_a_cancelled_transfer_tells_the_vehicle(start: Callable[[], Script]) -> None:
    flight = start()
    flight.cancel()
    told = flight.sent[-1]
    assert isinstance(told, MissionAck)
    assert told.type == MissionResult.OPERATION_CANCELLED
    assert flight.ending == TransferFailed(PLAN, None, "cancelled")


def test_after_its_end_a_transfer_hears_nothing() -> None:
    flight = upload(items=())
    flight.hear(ack(MissionResult.ACCEPTED))
    sent = len(flight.sent)
    flight.hear(ack(MissionResult.DENIED))
    flight.hear(request(0))
    flight.cancel()
    flight.wait(100 * WAIT_NS)
    assert len(flight.sent) == sent
    assert flight.ending == TransferDone(PLAN, ())


# ----------------------------------------------------------------------------- download


def test_a_download_asks_item_by_item_and_thanks() -> None:
    flight = download()
    flight.hear(count(3))
    for seq in range(3):
        asked = flight.sent[-1]
        assert asked == MissionRequestInt(seq=seq, target_system=1, target_component=1)
        flight.hear(item(seq, OWN))
    thanks = flight.sent[-1]
    assert isinstance(thanks, MissionAck)
    assert thanks.type == MissionResult.ACCEPTED
    assert flight.ending == TransferDone(PLAN, tuple(item(seq, OWN) for seq in range(3)))


def test_a_lost_item_is_asked_for_again_soon() -> None:
    flight = download()
    flight.hear(count(2))
    flight.wait(ITEM_WAIT_NS)
    assert flight.sent[-2:] == [MissionRequestInt(seq=0, target_system=1, target_component=1)] * 2


def test_duplicates_and_wrong_items_do_no_harm() -> None:
    flight = download()
    flight.hear(count(2))
    flight.hear(count(2))
    flight.hear(item(1, OWN))
    flight.hear(item(0, OWN))
    flight.hear(item(0, OWN))
    flight.hear(item(1, OWN))
    assert flight.ending == TransferDone(PLAN, (item(0, OWN), item(1, OWN)))


def test_no_plan_on_board_is_an_empty_one() -> None:
    flight = download()
    flight.hear(count(0))
    assert flight.ending == TransferDone(PLAN, ())


@pytest.mark.parametrize("items", [None, 2])
def test_silence_ends_a_download_and_says_where(items: int | None) -> None:
    flight = download()
    words = "the vehicle did not answer"
    if items is not None:
        flight.hear(count(items))
        flight.hear(item(0, OWN))
        words = "the vehicle did not send item 1 of 2"
    flight.wait(22 * WAIT_NS)
    assert flight.ending == TransferFailed(PLAN, None, words)


def test_a_plan_of_another_type_is_not_taken_for_ours() -> None:
    flight = download(MissionType.FENCE)
    flight.hear(count(5))
    flight.hear(count(0, MissionType.FENCE))
    assert flight.ending == TransferDone(MissionType.FENCE, ())


# -------------------------------------------------------------------------------- clear


def test_clearing_ends_with_the_ack_of_its_type() -> None:
    flight = Script(MissionClear(OWN, VEHICLE, MissionType.RALLY))
    flight.wait(WAIT_NS)
    flight.hear(ack(MissionResult.ACCEPTED))
    flight.hear(ack(MissionResult.ACCEPTED, MissionType.RALLY))
    clear = MissionClearAll(target_system=1, target_component=1, mission_type=2)
    assert flight.sent == [clear, clear]
    assert flight.ending == TransferDone(MissionType.RALLY, ())


def test_clearing_may_be_refused_and_may_get_no_answer() -> None:
    refused = Script(MissionClear(OWN, VEHICLE, PLAN))
    refused.hear(ack(MissionResult.DENIED))
    assert refused.ending == TransferFailed(PLAN, 14, "the vehicle answered DENIED")
    silent = Script(MissionClear(OWN, VEHICLE, PLAN))
    silent.wait(20 * WAIT_NS)
    assert silent.ending == TransferFailed(PLAN, None, "the vehicle did not answer")


def test_an_answer_without_a_name_keeps_its_number() -> None:
    flight = Script(MissionClear(OWN, VEHICLE, PLAN))
    odd = msgspec.structs.replace(ack(MissionResult.DENIED), type=77)
    flight.hear(odd)
    assert flight.ending == TransferFailed(PLAN, 77, "the vehicle answered result 77")


# ------------------------------------------------------- a vehicle behind a lossy link


class Board:
    """The vehicle's side as the specification has it: it asks, and asks again every 250 ms."""

    def __init__(self, old: bool) -> None:
        self.plan: tuple[MissionItemInt, ...] = ()
        self._coming: list[MissionItemInt] = []
        self._total = 0
        self._receiving = False
        self._old = old

    def hear(self, message: Message) -> list[Message]:
        match message:
            case MissionCount(count=total):
                self._coming, self._total, self._receiving = [], total, True
                return self.ask()
            case MissionItemInt(seq=seq) if self._receiving:
                if seq == len(self._coming):
                    self._coming.append(message)
                return self.ask()
            case MissionItemInt():
                return [ack(MissionResult.ACCEPTED)] if self.plan else []
            case MissionRequestList():
                return [count(len(self.plan))]
            case MissionRequestInt(seq=seq) if seq < len(self.plan):
                return [self.plan[seq]]
            case _:
                return []

    def ask(self) -> list[Message]:
        if not self._receiving:
            return []
        if len(self._coming) < self._total:
            seq = len(self._coming)
            return [old_request(seq) if self._old else request(seq)]
        self.plan = tuple(self._coming)
        self._receiving = False
        return [ack(MissionResult.ACCEPTED)]


class ArduPilotBoard(Board):
    """As seen of ArduCopter 4.7: a duplicate is an INVALID_SEQUENCE, one after the end an ERROR."""

    def __init__(self) -> None:
        super().__init__(old=False)
        self.duplicates = 0

    def hear(self, message: Message) -> list[Message]:
        match message:
            case MissionItemInt() if not self._receiving:
                self.duplicates += 1
                return [ack(MissionResult.ERROR)]
            case MissionItemInt(seq=seq) if seq != len(self._coming):
                self.duplicates += 1
                return [ack(MissionResult.INVALID_SEQUENCE)]
            case _:
                return super().hear(message)


def cross(
    machine: Machine,
    board: Board,
    dice: random.Random,
    loss: float,
    delays_ms: range = range(1, 60),
    ask_again_after_ns: int = ITEM_WAIT_NS,
) -> TransferEffect:
    """Run both over a link that loses, duplicates and delays, until the machine ends."""
    now_ns = 0
    to_board: list[tuple[int, Message]] = []
    to_machine: list[tuple[int, Message]] = []
    ask_again_ns = ask_again_after_ns

    def put(wire: list[tuple[int, Message]], message: Message) -> None:
        copies = 2 if loss and dice.random() < 0.1 else 1
        arrived = [message for _ in range(copies) if dice.random() >= loss]
        wire.extend((now_ns + dice.choice(delays_ms) * MS, copy) for copy in arrived)

    def send(effects: list[TransferEffect]) -> TransferEffect | None:
        for effect in effects:
            if isinstance(effect, Send):
                put(to_board, effect.message)
            elif not isinstance(effect, TransferProgress):
                return effect
        return None

    ended = send(machine.start(now_ns))
    while ended is None:
        assert now_ns < 10**12, "neither done nor failed"
        times = [time_ns for time_ns, _ in to_board + to_machine] + [ask_again_ns]
        if machine.deadline_ns is not None:
            times.append(machine.deadline_ns)
        now_ns = max(now_ns, min(times))
        for wire in (to_board, to_machine):
            for arrival in sorted((a for a in wire if a[0] <= now_ns), key=lambda a: a[0]):
                wire.remove(arrival)
                if wire is to_board:
                    for answer in board.hear(arrival[1]):
                        put(to_machine, answer)
                elif ended is None:
                    ended = send(machine.handle(Heard(1, 1, arrival[1]), now_ns))
        if now_ns >= ask_again_ns:
            ask_again_ns = now_ns + ask_again_after_ns
            for question in board.ask():
                put(to_machine, question)
        if ended is None:
            ended = send(machine.handle(Wake(), now_ns))
    return ended


@pytest.mark.parametrize("old", [False, True])
@pytest.mark.parametrize("seed", range(10))
def test_a_plan_survives_a_bad_link_both_ways(seed: int, old: bool) -> None:
    dice = random.Random(seed)
    board = Board(old)
    plan = tuple(item(seq) for seq in range(20))
    up = cross(MissionUpload(OWN, VEHICLE, PLAN, plan), board, dice, loss=0.1)
    assert up == TransferDone(PLAN, plan)
    assert board.plan == plan
    board.plan = tuple(item(seq, OWN) for seq in range(20))
    down = cross(MissionDownload(OWN, VEHICLE, PLAN), board, dice, loss=0.1)
    assert down == TransferDone(PLAN, board.plan)


@pytest.mark.parametrize("delay_ms", [100, 200, 500])
def test_a_slow_link_is_not_taken_for_one_that_loses(delay_ms: int) -> None:
    """The vehicle is asked again, and asks again, after the round trip: no item goes twice."""
    board = ArduPilotBoard()
    plan = tuple(item(seq) for seq in range(50))
    upload, slow = MissionUpload(OWN, VEHICLE, PLAN, plan), range(delay_ms, delay_ms + 1)
    up = cross(upload, board, random.Random(1), 0.0, slow, 1_000_000 * MS)
    assert (up, board.plan, board.duplicates) == (TransferDone(PLAN, plan), plan, 0)


def test_a_round_trip_that_was_never_measured_is_found() -> None:
    """The count had to be repeated, and 1 s is longer than the first wait: a few go twice."""
    flight = upload(PLAN, tuple(item(seq) for seq in range(20)))
    flight.wait(WAIT_NS)
    for seq in range(20):
        flight.hear(request(seq))
        flight.wait(1_000 * MS)
    sent = [one.seq for one in flight.sent if isinstance(one, MissionItemInt)]
    assert sent[-15:] == list(range(5, 20))


def test_when_an_upload_is_read_back_late_answers_to_its_duplicates_end_nothing() -> None:
    flight = Script(MissionDownload(OWN, VEHICLE, PLAN, after_upload=True))
    late = [MissionResult.INVALID_SEQUENCE, MissionResult.ERROR]
    for message in (ack(late[0]), count(1), ack(late[1]), item(0, OWN)):
        flight.hear(message)
    assert flight.ending == TransferDone(PLAN, (item(0, OWN),))
    silent = Script(MissionDownload(OWN, VEHICLE, PLAN, after_upload=True))
    silent.hear(ack(MissionResult.DENIED))
    silent.wait(20 * WAIT_NS)
    assert silent.ending == TransferFailed(
        PLAN, MissionResult.DENIED, "the vehicle answered DENIED"
    )


def test_an_answer_of_an_upload_before_sends_no_item() -> None:
    flight = upload()
    flight.wait(WAIT_NS)
    flight.hear(ack(MissionResult.INVALID_SEQUENCE))
    assert [type(message) for message in flight.sent] == [MissionCount] * 2


@settings(max_examples=examples(60), deadline=None)
@given(st.integers(0, 2**32), st.integers(1, 30), st.booleans())
def test_on_any_bad_link_a_transfer_is_whole_or_was_given_up(
    seed: int, items: int, old: bool
) -> None:
    dice = random.Random(seed)
    board = Board(old)
    plan = tuple(item(seq) for seq in range(items))
    up = cross(MissionUpload(OWN, VEHICLE, PLAN, plan), board, dice, loss=0.15)
    if up == TransferDone(PLAN, plan):
        assert board.plan == plan
    else:
        assert isinstance(up, TransferFailed)
        assert up.result is None
    board.plan = tuple(item(seq, OWN) for seq in range(items))
    down = cross(MissionDownload(OWN, VEHICLE, PLAN), board, dice, loss=0.15)
    if down != TransferDone(PLAN, board.plan):
        assert isinstance(down, TransferFailed)
        assert down.result is None


@settings(max_examples=examples(30), deadline=None)
@given(st.integers(0, 2**32), st.integers(1, 10))
def test_on_a_hopeless_link_every_transfer_still_ends(seed: int, items: int) -> None:
    dice = random.Random(seed)
    board = Board(old=False)
    plan = tuple(item(seq) for seq in range(items))
    up = cross(MissionUpload(OWN, VEHICLE, PLAN, plan), board, dice, loss=0.8)
    if isinstance(up, TransferDone):
        assert board.plan == plan
    else:
        assert isinstance(up, TransferFailed)
