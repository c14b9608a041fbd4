"""The queue: in order, in place, each with its owner, and one gate input at a time."""

from __future__ import annotations

import pytest

from gcs.gate.effects import Level
from gcs.gate.inputs import MissionSeen
from gcs.session.effects import Finish
from gcs.session.work import STATION, ForOwner, GateAnswered, GateInput, Log, Work
from gcs.station.queue import WorkQueue


def effect(name: str) -> Finish:
    """Any effect: the queue does not look into them."""
    return Finish(0, name)


def line(name: str) -> Log:
    return Log(Level.INFO, "a test", name)


def gate(seq: int) -> GateInput:
    """Any input for the gate, told apart by a number."""
    return GateInput(MissionSeen(seq, 9, False))


class Script:
    """Answers each item of work as the test says, and keeps the order of what it was asked."""

    def __init__(self, answers: dict[Work, list[Work]]) -> None:
        self._answers = answers
        self.asked: list[Work] = []
        self.queue = WorkQueue(self.step)

    def step(self, item: Work, owner: int, now_ns: int) -> list[Work]:
        self.asked.append(item)
        if item == line("fails"):
            raise ZeroDivisionError
        return self._answers.get(item, [])

    def run(self, *work: Work) -> list[str]:
        self.queue.run(work, 0, 0)
        return [e.sentence for e in self.queue.take() if isinstance(e, Finish)]


def test_effects_leave_in_the_order_in_which_they_were_returned() -> None:
    assert Script({}).run(effect("a"), effect("b")) == ["a", "b"]


def test_what_an_item_leads_to_is_done_in_its_place() -> None:
    script = Script({line("a"): [effect("a1"), line("a2")], line("a2"): [effect("a2")]})
    assert script.run(effect("first"), line("a"), effect("last")) == ["first", "a1", "a2", "last"]


def test_a_gate_input_waits_until_the_effects_of_the_one_before_are_carried_out() -> None:
    script = Script(
        {
            gate(1): [line("refused at once"), effect("first transition"), GateAnswered()],
            line("refused at once"): [gate(2)],
            gate(2): [effect("second transition"), GateAnswered()],
        }
    )
    assert script.run(gate(1), effect("after")) == [
        "first transition",
        "second transition",
        "after",
    ]
    assert script.asked == [gate(1), line("refused at once"), gate(2)]


def test_two_gate_inputs_that_wait_are_taken_in_turn() -> None:
    script = Script(
        {
            gate(1): [line("x"), line("y"), GateAnswered()],
            line("x"): [gate(2)],
            line("y"): [gate(3)],
            gate(2): [effect("2"), GateAnswered()],
            gate(3): [effect("3"), GateAnswered()],
        }
    )
    assert script.run(gate(1)) == ["2", "3"]


def test_what_follows_the_answer_comes_after_the_inputs_that_waited() -> None:
    script = Script(
        {
            gate(1): [line("x"), GateAnswered(), effect("afterwards")],
            line("x"): [gate(2)],
            gate(2): [effect("2"), GateAnswered()],
        }
    )
    assert script.run(gate(1)) == ["2", "afterwards"]


def test_after_a_failure_nothing_of_it_is_left() -> None:
    """A part raises while a gate input waits for the end of another one's answer."""
    script = Script(
        {
            gate(1): [effect("half done"), line("x"), line("fails"), GateAnswered()],
            line("x"): [gate(2)],
            gate(3): [effect("3"), GateAnswered()],
        }
    )
    with pytest.raises(ZeroDivisionError):
        script.run(gate(1))
    script.queue.drop()
    assert script.run(gate(3), effect("next")) == ["3", "next"]
    assert gate(2) not in script.asked


class Owned:
    """Keeps whose each item of work was."""

    def __init__(self, answers: dict[Work, list[Work]]) -> None:
        self._answers = answers
        self.asked: list[tuple[Work, int]] = []
        self.queue = WorkQueue(self.step)

    def step(self, item: Work, owner: int, now_ns: int) -> list[Work]:
        self.asked.append((item, owner))
        return self._answers.get(item, [])


def test_what_an_item_leads_to_has_its_owner() -> None:
    script = Owned({line("a"): [line("a1"), line("a2")]})
    script.queue.run([ForOwner(3, (line("a"),)), line("b")], 0)
    assert script.asked == [
        (line("a"), 3),
        (line("a1"), 3),
        (line("a2"), 3),
        (line("b"), STATION),
    ]


def test_another_owners_work_in_between_gives_the_owner_back() -> None:
    script = Owned({line("a"): [ForOwner(1, (line("of 1"),)), line("a2")]})
    script.queue.run([line("a"), line("b")], 0, 2)
    assert script.asked == [(line("a"), 2), (line("of 1"), 1), (line("a2"), 2), (line("b"), 2)]


def test_a_gate_input_that_waited_still_has_its_own_owner() -> None:
    """One gate's answer leads to an input for another one: its gate, and no other, gets it."""
    script = Owned(
        {
            gate(1): [ForOwner(1, (gate(2),)), line("still 0"), GateAnswered()],
            gate(2): [line("of 1"), GateAnswered()],
        }
    )
    script.queue.run([gate(1), line("after")], 0, 0)
    assert script.asked == [
        (gate(1), 0),
        (line("still 0"), 0),
        (gate(2), 1),
        (line("of 1"), 1),
        (line("after"), 0),
    ]


def test_a_gate_input_of_the_station_is_no_gates_answer() -> None:
    """It goes to every gate, one after the other: each is done with it before the next has it."""
    script = Owned(
        {
            gate(1): [ForOwner(0, (gate(2),)), ForOwner(1, (gate(3),))],
            gate(2): [line("x"), GateAnswered()],
            line("x"): [gate(4)],
            gate(4): [GateAnswered()],
            gate(3): [GateAnswered()],
        }
    )
    script.queue.run([gate(1)], 0)
    assert script.asked == [
        (gate(1), STATION),
        (gate(2), 0),
        (line("x"), 0),
        (gate(4), 0),
        (gate(3), 1),
    ]
