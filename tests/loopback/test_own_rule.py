"""The operator's own rule: it refuses more, and it never permits more."""

from __future__ import annotations

import msgspec
import pytest

from gcs import ipc
from gcs.audit.audit import audit
from gcs.frames import Vec3
from gcs.gate.policy.policy import Policy
from gcs.gate.states import State
from gcs.session import inputs
from gcs.session.effects import AskRule
from tests.loopback.flight import CONFIG, POLICIES, Flight
from tests.loopback.recorded_flights import flights_recorded

RULED = msgspec.structs.replace(CONFIG, rule_path="somewhere/my_rule.py")
TOO_LOW = "lower than 0.9 m"


def verify(goal_enu: Vec3) -> str | None:
    """The rule of these flights."""
    return TOO_LOW if goal_enu[2] < 0.9 else None


def ruled() -> tuple[Flight, list[AskRule]]:
    """Hovering in the lab's cage; and the questions that its rule is asked and answers."""
    flight, asked = Flight(policy=POLICIES["lab"], config=RULED), list[AskRule]()

    def rule(question: AskRule) -> list[inputs.Input]:
        asked.append(question)
        return [inputs.RuleSaid(question.request_id, verify(question.goal_enu))]

    flight.rule = rule
    return flight.hovering(1.0), asked


def test_what_it_permits_is_judged_by_the_gate_and_flown() -> None:
    flight, asked = ruled()
    began_ns = flight.now_ns
    assert flight.done(flight.goto(2.0, 0.0, 1.0)) == "complete"
    assert [each.goal_enu for each in asked] == [(2.0, 0.0, 1.0)]
    assert asked[0].start_enu == pytest.approx((0.0, 0.0, 1.0), abs=0.5)
    assert flight.states(began_ns) == ["VERIFYING", "MOVING", "HOVERING"]


def test_what_it_refuses_never_reaches_the_wire() -> None:
    flight, _ = ruled()
    began_ns = flight.now_ns
    low = flight.goto(1.0, 0.0, 0.5)
    assert flight.done(low) == "refused OWN_RULE"
    assert flight.verdicts(low)[0].sentence == TOO_LOW
    flight.run(1.0)
    assert all(each.pos_ned[2] < -0.9 for each in flight.setpoints(began_ns))
    assert flight.state is State.HOVERING


def test_it_is_not_asked_for_what_the_gate_refuses() -> None:
    flight, asked = ruled()
    began_ns = flight.now_ns
    assert flight.done(flight.goto(6.0, 0.0, 1.0)) == "refused OUTSIDE_FENCE"
    assert flight.states(began_ns) == ["VERIFYING", "HOVERING"]
    flight.goto(2.0, 0.0, 1.0)
    flight.until(lambda: flight.is_in(State.MOVING))
    assert flight.done(flight.goto(1.0, 0.0, 1.0)) == "refused BUSY"
    assert len(asked) == 1


def test_a_rule_that_permits_everything_changes_no_verdict() -> None:
    free, (under, _) = Flight(policy=POLICIES["lab"]).hovering(1.0), ruled()
    under.rule = lambda asked: [inputs.RuleSaid(asked.request_id, None)]
    for goal_enu in ((2.0, 0.0, 1.0), (5.01, 0.0, 1.0), (0.0, 0.0, 2.5), (-1.0, 4.9, 0.5)):
        without, within = free.goto(*goal_enu), under.goto(*goal_enu)
        assert free.done(without) == under.done(within)


def test_no_answer_refuses_and_a_late_one_is_for_nobody() -> None:
    flight, _ = ruled()
    flight.rule = lambda _: []
    silent, began_ns = flight.goto(1.0, 0.0, 1.0), flight.now_ns
    assert flight.done(silent) == "refused OWN_RULE_FAILED"
    assert 0.5 <= (flight.now_ns - began_ns) / 1e9 <= 0.6
    flight.feed(inputs.RuleSaid(silent, None))
    flight.run(0.5)
    assert flight.state is State.HOVERING


def test_a_rule_that_fails_refuses() -> None:
    flight, _ = ruled()
    told = "my_rule.py:7: ZeroDivisionError: division by zero"
    flight.rule = lambda asked: [inputs.RuleSaid(asked.request_id, told, failed=True)]
    wrong = flight.goto(1.0, 0.0, 1.0)
    assert flight.done(wrong) == "refused OWN_RULE_FAILED"
    assert flight.verdicts(wrong)[0].sentence == told


def test_an_abort_meanwhile_counts_and_nothing_revives_the_goal() -> None:
    flight, _ = ruled()
    flight.rule = lambda _: []
    waits = flight.goto(2.0, 0.0, 1.0)
    flight.run(0.1)
    flight.do("abort")
    assert flight.outcome(waits) == "refused NOT_FLYING"
    flight.do("resume")
    flight.feed(inputs.RuleSaid(waits, None))
    flight.run(0.5)
    assert flight.state is State.HOVERING


def test_a_newer_goal_supersedes_the_one_that_waits() -> None:
    flight, asked = ruled()
    first, second = flight.goto(1.0, 0.0, 1.0), flight.goto(2.0, 0.0, 1.0)
    assert flight.done(second) == "complete"
    assert flight.outcome(first) == "superseded SUPERSEDED"
    assert [each.goal_enu[0] for each in asked] == [2.0]


def test_a_check_tells_that_the_rule_is_still_to_be_asked() -> None:
    flight, asked = ruled()
    for goal_enu in ((1.0, 0.0, 1.0), (6.0, 0.0, 1.0)):
        flight.feed(inputs.OperatorLine(1, ipc.Check(ipc.Ask(0, "goto", goal_enu=goal_enu))))
    assert [each.outcome for each in flight.of(ipc.Checked)] == ["waits", "refused"]
    assert asked == []


def test_an_audit_takes_its_answers_from_the_record_and_asks_it_again_if_told_to() -> None:
    with flights_recorded() as recorded:
        flight, _ = ruled()
        assert flight.done(flight.goto(1.0, 0.0, 1.0)) == "complete"
        flight.done(flight.goto(1.0, 0.0, 0.5))
        (own,) = recorded
    messages, attached = own.tape.take(), own.tape.attachments

    alone = audit(messages, attached, "test", "")
    assert alone.good
    assert any("on requests 3, 4 were taken from the record" in note for note in alone.notes)

    def same(_start: Vec3, goal_enu: Vec3, _policy: Policy) -> tuple[str | None, bool]:
        return verify(goal_enu), False

    again = audit(messages, attached, "test", "", same)
    assert again.good
    assert any("asked again on requests 3, 4" in note for note in again.notes)

    laxer = audit(messages, attached, "test", "", lambda *_: (None, False))
    assert [(each.recorded, each.reproduced) for each in laxer.first] == [(TOO_LOW, "permits")]
