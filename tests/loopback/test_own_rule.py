"""The operator's own rule: it refuses more, and it never permits more."""

from __future__ import annotations

import math
from collections.abc import Callable

import msgspec
import pytest

from gcs import ipc
from gcs.audit.audit import audit
from gcs.frames import Vec3
from gcs.gate.policy.policy import Policy
from gcs.gate.states import State
from gcs.report import MissionItem
from gcs.session import inputs
from gcs.session.effects import AskRule
from tests.loopback.flight import CONFIG, MISSIONS, POLICIES, Flight
from tests.loopback.recorded_flights import flights_recorded

RULED = msgspec.structs.replace(CONFIG, rule_path="somewhere/my_rule.py")
TOO_LOW = "lower than 0.9 m"


Legs = tuple[tuple[Vec3, Vec3], ...]


def verify(legs_enu: Legs) -> str | None:
    """The rule of these flights."""
    return TOO_LOW if any(end[2] < 0.9 for _, end in legs_enu) else None


def asked_of(flight: Flight, verify: Callable[[Legs], str | None] = verify) -> list[AskRule]:
    """The questions that the rule of a flight is asked and answers from now on."""
    asked = list[AskRule]()

    def rule(question: AskRule) -> list[inputs.Input]:
        asked.append(question)
        return [inputs.RuleSaid(question.request_id, verify(question.legs_enu))]

    flight.rule = rule
    return asked


def ruled() -> tuple[Flight, list[AskRule]]:
    """Hovering in the lab's cage; and the questions from then on."""
    flight = Flight(policy=POLICIES["lab"], config=RULED)
    asked_of(flight)
    flight.hovering(1.0)
    return flight, asked_of(flight)


def test_what_it_permits_is_judged_by_the_gate_and_flown() -> None:
    flight, asked = ruled()
    began_ns = flight.now_ns
    assert flight.done(flight.goto(2.0, 0.0, 1.0)) == "complete"
    (((start_enu, goal_enu),),) = [each.legs_enu for each in asked]
    assert goal_enu == (2.0, 0.0, 1.0)
    assert start_enu == pytest.approx((0.0, 0.0, 1.0), abs=0.5)
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


def test_a_take_off_is_one_leg_up() -> None:
    flight = Flight(policy=POLICIES["lab"], config=RULED).connected()
    asked = asked_of(flight)
    flight.do("arm")
    assert flight.done(flight.say("takeoff", up_m=0.6)) == "refused OWN_RULE"
    assert flight.state is State.GROUNDED
    flight.do("takeoff", up_m=1.2)
    assert [each.legs_enu[0][1][2] for each in asked] == pytest.approx([0.6, 1.2], abs=0.1)


def test_of_a_mission_an_orbit_and_a_return_it_is_asked_every_leg() -> None:
    """In the lab's cage the gate refuses a return, so these are in the open."""
    flight = Flight(config=RULED)
    asked_of(flight, lambda _: None)
    flight.hovering(5.0)
    flight.do("mission_upload", path=str(MISSIONS / "square.toml"))
    asked, began_ns = asked_of(flight, lambda _: "no"), flight.now_ns
    for word, mode in (("mission_start", ""), ("rtl", ""), ("mode", "AUTO.RTL")):
        assert flight.done(flight.say(word, mode=mode)) == "refused OWN_RULE"
    orbit_ask = flight.last_id = flight.last_id + 1
    circle = ipc.Circle(None, 8.0, 2.0, 1.0)
    flight.feed(inputs.OperatorLine(1, ipc.Ask(orbit_ask, "orbit", orbit=circle)))
    assert flight.done(orbit_ask) == "refused OWN_RULE"
    mission, home, by_mode, orbit = (each.legs_enu for each in asked)
    flown = next(i for _, i in flight.records if isinstance(i, MissionItem))
    assert len(mission) >= len(flown.path_ned) - 1
    assert home[-1][1][:2] == pytest.approx((0.0, 0.0), abs=0.5)
    assert home[-1][1][2] > 4.0, "the descent is a landing, which it is not asked for"
    assert [len(home), len(by_mode)] == [2, 2]
    assert len(orbit) > 12
    assert all(math.dist(start, end) < 3.0 for start, end in orbit[1:])
    assert flight.states(began_ns) == []
    flight.rule = lambda _: []
    stopped = flight.say("rtl")
    flight.run(0.1)
    flight.do("abort")
    assert flight.outcome(stopped) == "superseded SUPERSEDED"
    asked_of(flight, lambda _: None)
    flight.do("resume")
    flight.feed(inputs.OperatorLine(1, ipc.Ask(orbit_ask + 9, "orbit", orbit=circle)))
    flight.until(lambda: flight.is_in(State.STREAMING))
    flight.run(2.0)
    assert flight.is_in(State.STREAMING), "the orbit's own samples are no stream of an operator"
    assert flight.done(flight.say("rtl")) == "complete"


def test_a_stream_has_no_legs_and_is_refused_and_stops_are_never_asked_for() -> None:
    flight, asked = ruled()
    assert flight.done(flight.say("stream_begin")) == "refused OWN_RULE"
    for _ in range(20):
        flight.feed(inputs.OperatorLine(1, ipc.Stream(v_enu=(1.0, 0.0, 0.0))))
        flight.run(0.05)
    assert [each.code for each in flight.of(ipc.StreamVerdictEvent)] == ["OWN_RULE"]
    assert flight.state is State.HOVERING
    for word in ("hold", "resume", "abort", "land"):
        flight.do(word)
    assert asked == []


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
    assert [each.legs_enu[0][1][0] for each in asked] == [2.0]


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
    assert any("on requests 2, 3, 4 were taken from the record" in note for note in alone.notes)

    def same(legs_enu: Legs, _policy: Policy) -> tuple[str | None, bool]:
        return verify(legs_enu), False

    again = audit(messages, attached, "test", "", same)
    assert again.good
    assert any("asked again on requests 2, 3, 4" in note for note in again.notes)

    laxer = audit(messages, attached, "test", "", lambda *_: (None, False))
    assert [(each.recorded, each.reproduced) for each in laxer.first] == [(TOO_LOW, "permits")]
