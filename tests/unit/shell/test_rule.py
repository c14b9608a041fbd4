"""The operator's own rule in its own process: a sentence refuses, and whatever goes wrong, too."""

from __future__ import annotations

import select

import pytest

from gcs.gate.policy.parse import DEFAULT
from gcs.session.effects import AskRule
from gcs.session.inputs import RuleSaid
from gcs.shell.rule_child import Answer, BadRuleError, Place, judge, load
from gcs.shell.rule_process import RuleError, RuleProcess, rule_policy
from tests.each import each

START, GOAL = Place(0.0, 0.0, 1.0), Place(1.0, 2.0, 1.5)

ANSWERS = {
    "return None": Answer(None),
    "pass": Answer(None),
    "return 'too far'": Answer("too far"),
    "return f'{goal.up_m - start.up_m:.1f} m up'": Answer("0.5 m up"),
    "return policy['name'] + f\", {policy['margin_h_m']:g} m\"": Answer("default, 2 m"),
    "print('hm')": Answer(None, printed="hm\n"),
    "return True": Answer("r.py: verify returned True, neither None nor a sentence", failed=True),
    "return ''": Answer("r.py: verify returned '', neither None nor a sentence", failed=True),
    "return 1 / 0": Answer("r.py:2: ZeroDivisionError: division by zero", failed=True),
    "raise SystemExit(0)": Answer("r.py:2: SystemExit: 0", failed=True),
    "return 'two\\n lines'": Answer("two lines"),
    "while True: pass": Answer("r.py:2: took longer than 0.3 s", failed=True),
}


def source(body: str) -> str:
    return f"def verify(start, goal, policy):\n    {body}\n"


@each("body", ANSWERS)
def test_what_it_returns_or_raises(body: str) -> None:
    verify = load("a/r.py", source(body))
    assert judge(verify, "a/r.py", [(START, GOAL)], rule_policy(DEFAULT)) == ANSWERS[body]


def test_a_file_that_is_no_rule_says_where() -> None:
    for text, told in {
        "def verify(:\n": "r.py:1: ",
        "x = 1\n": "r.py: has no function verify(start, goal, policy)",
        "\nimport nonesuch_at_all\n": "r.py:2: ModuleNotFoundError: ",
    }.items():
        with pytest.raises(BadRuleError) as raised:
            load("r.py", text)
        assert str(raised.value).startswith(told)


SWALLOWS = """while True:
        try:
            __import__("time").sleep(9)
        except: pass"""


def answers(rule: RuleProcess) -> list[RuleSaid]:
    """The next that come, while the process lives."""
    assert select.select([rule.lines], [], [], 20.0)[0]
    return rule.answers()


@pytest.mark.slow
def test_its_process_answers_one_question_after_the_other() -> None:
    rule = RuleProcess("r.py", source("return None if goal.up_m > 1 else 'low'"), DEFAULT)
    try:
        rule.ask(AskRule(7, ((START, GOAL),)))
        assert answers(rule) == [RuleSaid(7, None)]
        rule.ask(AskRule(8, ((START, GOAL), (GOAL, (0.0, 0.0, 0.5)))))
        assert answers(rule) == [RuleSaid(8, "leg 2 of 2: low")]
    finally:
        rule.stop()


@pytest.mark.slow
@pytest.mark.parametrize("body", ["import os; os._exit(3)", SWALLOWS])
def test_a_process_that_ends_at_a_question_or_has_to_be_ended(body: str) -> None:
    rule = RuleProcess("r.py", source(body), DEFAULT)
    try:
        rule.ask(AskRule(1, ((START, GOAL),)))
        while not rule.lines.ended:
            assert answers(rule) == []
        rule.ask(AskRule(2, ((START, GOAL),)))  # says nothing, and raises nothing
    finally:
        rule.stop()


@pytest.mark.slow
def test_a_process_that_cannot_load_it_says_why() -> None:
    with pytest.raises(RuleError, match=r"^r\.py:1: ZeroDivisionError"):
        RuleProcess("r.py", "1 / 0\n", DEFAULT)
