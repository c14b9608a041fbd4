"""The command protocol, asking side, flown on a clock that the test advances."""

from __future__ import annotations

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from gcs.protocol.command import ACK_WAIT_NS, WORK_WAIT_NS, CommandClient
from gcs.protocol.effects import (
    Address,
    CommandEffect,
    Finished,
    Heard,
    InProgress,
    LateAck,
    Send,
    Submit,
    Wake,
)
from gcs.wire.ids import Cmd, Result
from gcs.wire.messages import CommandAck, CommandLong
from tests.shares import examples

OWN = Address(255, 190)
MS = 1_000_000
FOREVER = 10**18


def command(cmd: Cmd, sysid: int = 1, compid: int = 1) -> CommandLong:
    return CommandLong(
        param1=0.0,
        param2=0.0,
        param3=0.0,
        param4=0.0,
        param5=0.0,
        param6=0.0,
        param7=0.0,
        command=cmd,
        target_system=sysid,
        target_component=compid,
        confirmation=0,
    )


ARM = command(Cmd.COMPONENT_ARM_DISARM)
MODE = command(Cmd.DO_SET_MODE)


class Station:
    """A client, its clock, and what it put on the wire."""

    def __init__(self) -> None:
        self.client = CommandClient(OWN)
        self.now_ns = 0
        self.sent: list[CommandLong] = []
        self.sent_ns: list[int] = []

    def _keep(self, effects: list[CommandEffect]) -> list[CommandEffect]:
        for effect in effects:
            if isinstance(effect, Send):
                assert isinstance(effect.message, CommandLong)
                self.sent.append(effect.message)
                self.sent_ns.append(self.now_ns)
        return [effect for effect in effects if not isinstance(effect, Send)]

    def submit(
        self,
        token: int,
        what: CommandLong,
        deadline_ns: int = FOREVER,
        tries: int = 4,
        urgent: bool = False,
    ) -> list[CommandEffect]:
        submit = Submit(token, what, deadline_ns, tries, urgent)
        return self._keep(self.client.handle(submit, self.now_ns))

    def ack(
        self,
        cmd: Cmd,
        result: Result,
        source: tuple[int, int] = (1, 1),
        to: tuple[int, int] = (255, 190),
        percent: int = 255,
    ) -> list[CommandEffect]:
        ack = CommandAck(
            command=cmd,
            result=result,
            progress=percent,
            target_system=to[0],
            target_component=to[1],
        )
        return self._keep(self.client.handle(Heard(*source, ack), self.now_ns))

    def wait(self, ns: int) -> list[CommandEffect]:
        """Let time pass, waking the client whenever it asks."""
        end_ns = self.now_ns + ns
        effects: list[CommandEffect] = []
        while self.client.deadline_ns is not None and self.client.deadline_ns <= end_ns:
            self.now_ns = self.client.deadline_ns
            effects += self._keep(self.client.handle(Wake(), self.now_ns))
        self.now_ns = end_ns
        return effects


def test_an_answered_command_ends_with_its_result() -> None:
    station = Station()
    assert station.submit(7, ARM) == []
    assert station.sent == [ARM]
    station.wait(100 * MS)
    assert station.ack(Cmd.COMPONENT_ARM_DISARM, Result.DENIED) == [
        Finished(7, Cmd.COMPONENT_ARM_DISARM, Result.DENIED)
    ]
    assert station.client.deadline_ns is None


def test_a_lost_command_is_sent_again_and_says_so() -> None:
    station = Station()
    station.submit(1, ARM)
    station.wait(ACK_WAIT_NS)
    station.wait(ACK_WAIT_NS)
    assert [message.confirmation for message in station.sent] == [0, 1, 2]
    assert station.ack(Cmd.COMPONENT_ARM_DISARM, Result.ACCEPTED) == [
        Finished(1, Cmd.COMPONENT_ARM_DISARM, Result.ACCEPTED)
    ]


def test_silence_ends_a_command_without_a_result() -> None:
    station = Station()
    station.submit(1, ARM)
    ended = station.wait(10 * ACK_WAIT_NS)
    assert len(station.sent) == 4
    assert ended == [Finished(1, Cmd.COMPONENT_ARM_DISARM, None, "no answer to 4 tries")]


def test_tries_beyond_what_confirmation_can_count_leave_all_the_same() -> None:
    client, now_ns = CommandClient(OWN), 0
    sent = client.handle(Submit(1, MODE, 300 * ACK_WAIT_NS, tries=None), now_ns)
    while client.deadline_ns is not None:
        now_ns = client.deadline_ns
        sent += client.handle(Wake(), now_ns)
    counted = [
        effect.message.confirmation
        for effect in sent
        if isinstance(effect, Send) and isinstance(effect.message, CommandLong)
    ]
    assert counted == [min(number, 255) for number in range(301)]


def test_what_must_not_be_done_twice_is_sent_once() -> None:
    station = Station()
    station.submit(1, ARM, deadline_ns=9 * ACK_WAIT_NS, tries=1)
    assert station.wait(8 * ACK_WAIT_NS) == [], "its one try is waited for until the deadline"
    ended = station.wait(2 * ACK_WAIT_NS)
    assert len(station.sent) == 1
    assert ended == [Finished(1, Cmd.COMPONENT_ARM_DISARM, None, "no answer to 1 try")]


def test_no_try_leaves_after_the_deadline() -> None:
    station = Station()
    station.submit(1, ARM, deadline_ns=700 * MS)
    ended = station.wait(5_000 * MS)
    assert len(station.sent) == 2
    assert ended == [Finished(1, Cmd.COMPONENT_ARM_DISARM, None, "no answer to 2 tries")]


def test_an_answer_after_the_end_is_news_and_nothing_more() -> None:
    station = Station()
    station.submit(1, ARM, deadline_ns=ACK_WAIT_NS, tries=1)
    station.wait(ACK_WAIT_NS)
    late = station.ack(Cmd.COMPONENT_ARM_DISARM, Result.ACCEPTED)
    assert late == [LateAck(1, Cmd.COMPONENT_ARM_DISARM, Result.ACCEPTED, None)]
    assert station.ack(Cmd.COMPONENT_ARM_DISARM, Result.ACCEPTED) == []


def test_a_duplicate_answer_is_no_news() -> None:
    station = Station()
    station.submit(1, ARM)
    station.ack(Cmd.COMPONENT_ARM_DISARM, Result.ACCEPTED)
    assert station.ack(Cmd.COMPONENT_ARM_DISARM, Result.ACCEPTED) == []
    assert station.ack(Cmd.COMPONENT_ARM_DISARM, Result.FAILED) == [
        LateAck(1, Cmd.COMPONENT_ARM_DISARM, Result.FAILED, Result.ACCEPTED)
    ]


def test_answers_to_others_and_from_others_are_not_ours() -> None:
    station = Station()
    station.submit(1, ARM)
    assert station.ack(Cmd.DO_SET_MODE, Result.ACCEPTED) == []
    assert station.ack(Cmd.COMPONENT_ARM_DISARM, Result.ACCEPTED, source=(2, 1)) == []
    assert station.ack(Cmd.COMPONENT_ARM_DISARM, Result.ACCEPTED, source=(1, 100)) == []
    assert station.ack(Cmd.COMPONENT_ARM_DISARM, Result.ACCEPTED, to=(254, 190)) == []
    assert station.ack(Cmd.COMPONENT_ARM_DISARM, Result.ACCEPTED, to=(0, 0)) == [
        Finished(1, Cmd.COMPONENT_ARM_DISARM, Result.ACCEPTED)
    ]


def test_a_command_in_progress_is_waited_for_and_not_repeated() -> None:
    station = Station()
    station.submit(1, ARM)
    assert station.ack(Cmd.COMPONENT_ARM_DISARM, Result.IN_PROGRESS, percent=40) == [
        InProgress(1, Cmd.COMPONENT_ARM_DISARM, 40)
    ]
    assert station.wait(WORK_WAIT_NS - 1) == []
    assert station.ack(Cmd.COMPONENT_ARM_DISARM, Result.IN_PROGRESS) == [
        InProgress(1, Cmd.COMPONENT_ARM_DISARM, None)
    ]
    assert station.wait(WORK_WAIT_NS - 1) == []
    assert len(station.sent) == 1
    assert station.ack(Cmd.COMPONENT_ARM_DISARM, Result.ACCEPTED) == [
        Finished(1, Cmd.COMPONENT_ARM_DISARM, Result.ACCEPTED)
    ]


def test_a_command_that_stops_making_progress_ends() -> None:
    station = Station()
    station.submit(1, ARM)
    station.ack(Cmd.COMPONENT_ARM_DISARM, Result.IN_PROGRESS)
    (ended,) = station.wait(WORK_WAIT_NS)
    assert isinstance(ended, Finished)
    assert (ended.result, len(station.sent)) == (None, 1)


def test_commands_of_different_kinds_fly_together() -> None:
    station = Station()
    station.submit(1, ARM)
    station.submit(2, MODE)
    assert station.sent == [ARM, MODE]
    assert station.ack(Cmd.DO_SET_MODE, Result.ACCEPTED) == [
        Finished(2, Cmd.DO_SET_MODE, Result.ACCEPTED)
    ]
    assert station.client.busy


def test_commands_of_one_kind_wait_for_each_other() -> None:
    station = Station()
    station.submit(1, MODE)
    station.submit(2, MODE)
    station.submit(3, MODE, deadline_ns=50 * MS)
    assert len(station.sent) == 1
    station.wait(100 * MS)
    assert station.ack(Cmd.DO_SET_MODE, Result.DENIED) == [
        Finished(1, Cmd.DO_SET_MODE, Result.DENIED)
    ]
    assert len(station.sent) == 2
    assert station.ack(Cmd.DO_SET_MODE, Result.ACCEPTED) == [
        Finished(2, Cmd.DO_SET_MODE, Result.ACCEPTED),
        Finished(3, Cmd.DO_SET_MODE, None, "its time was over before it could be sent"),
    ]
    assert len(station.sent) == 2
    assert not station.client.busy


def test_the_same_command_to_two_vehicles_does_not_wait() -> None:
    station = Station()
    station.submit(1, MODE)
    station.submit(2, command(Cmd.DO_SET_MODE, sysid=2))
    assert len(station.sent) == 2
    assert station.ack(Cmd.DO_SET_MODE, Result.ACCEPTED, source=(2, 1)) == [
        Finished(2, Cmd.DO_SET_MODE, Result.ACCEPTED)
    ]


def test_a_hold_does_not_wait_behind_a_mode_change() -> None:
    station = Station()
    station.submit(1, MODE)
    station.submit(2, MODE)
    station.wait(100 * MS)
    assert station.submit(3, MODE, urgent=True) == [
        Finished(1, Cmd.DO_SET_MODE, None, "gave way to an urgent one"),
        Finished(2, Cmd.DO_SET_MODE, None, "gave way to an urgent one"),
    ]
    assert len(station.sent) == 2
    assert station.ack(Cmd.DO_SET_MODE, Result.ACCEPTED) == [
        Finished(3, Cmd.DO_SET_MODE, Result.ACCEPTED)
    ]


def test_a_wake_that_comes_early_does_nothing() -> None:
    station = Station()
    station.submit(1, ARM)
    assert station.client.handle(Wake(), ACK_WAIT_NS - 1) == []


STEPS = st.lists(
    st.one_of(
        st.tuples(st.just("submit"), st.sampled_from([Cmd.DO_SET_MODE, Cmd.NAV_LAND])),
        st.tuples(st.just("urgent"), st.sampled_from([Cmd.DO_SET_MODE, Cmd.NAV_LAND])),
        st.tuples(st.sampled_from([Result.ACCEPTED, Result.IN_PROGRESS]), st.just(Cmd.NAV_LAND)),
        st.tuples(st.just(Result.DENIED), st.just(Cmd.DO_SET_MODE)),
        st.tuples(st.just("wait"), st.integers(0, 2_000)),
    ),
    max_size=30,
)


@pytest.mark.slow
@settings(max_examples=examples(200))
@given(STEPS)
def test_every_command_ends_exactly_once_and_none_leaves_late(
    steps: list[tuple[str | Result, Cmd | int]],
) -> None:
    station = Station()
    endings: list[int] = []
    deadline_ns: dict[int, int] = {}

    def watch(effects: list[CommandEffect]) -> None:
        endings.extend(effect.token for effect in effects if isinstance(effect, Finished))

    for token, (what, detail) in enumerate(steps):
        if what == "wait":
            watch(station.wait(detail * MS))
        elif isinstance(what, Result):
            watch(station.ack(Cmd(detail), what))
        else:
            deadline_ns[token] = station.now_ns + 1_200 * MS
            marked = msgspec.structs.replace(command(Cmd(detail)), param1=float(token))
            watch(station.submit(token, marked, deadline_ns[token], urgent=what == "urgent"))
    watch(station.wait(100 * WORK_WAIT_NS))
    for message, sent_ns in zip(station.sent, station.sent_ns, strict=True):
        assert sent_ns <= deadline_ns[int(message.param1)]
    assert sorted(endings) == sorted(deadline_ns)
    assert not station.client.busy
