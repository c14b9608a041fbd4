"""Verdicts by number: what each is for, and when it holds no more."""

from __future__ import annotations

from dataclasses import replace

from gcs import ipc
from gcs.agents.untrusted import MOST_LETTERS, sentence, untrusted
from gcs.agents.verdicts import (
    KEPT,
    MOVED_M,
    VALID_NS,
    Denied,
    Situation,
    Verdict,
    Verdicts,
)
from tests.each import each

THEN = Situation("digest", "1/1 px4 quadrotor", "HOVERING", "OFFBOARD", True, (0.0, 0.0, 3.0))
GOTO = ipc.Ask(0, "goto", goal_enu=(4.0, 0.0, 3.0))


def issued() -> tuple[Verdicts, Verdict]:
    verdicts = Verdicts("mine")
    return verdicts, verdicts.keep(GOTO, "goto 4 0 3", THEN, 0)


def code(found: Verdict | Denied) -> str:
    return found.code if isinstance(found, Denied) else ""


CASES = {
    "as it was": (THEN, 1, ""),
    "at the last moment": (THEN, VALID_NS, ""),
    "too late": (THEN, VALID_NS + 1, "EXPIRED_VERDICT"),
    "before it was made": (THEN, -1, "EXPIRED_VERDICT"),
    "moved a little": (replace(THEN, pos_enu=(MOVED_M - 0.01, 0.0, 3.0)), 1, ""),
    "moved": (replace(THEN, pos_enu=(0.0, 0.0, 3.01 + MOVED_M)), 1, "CHANGED_SITUATION"),
    "position lost": (replace(THEN, pos_enu=None), 1, "CHANGED_SITUATION"),
    "another state": (replace(THEN, state="MOVING"), 1, "CHANGED_SITUATION"),
    "another mode": (replace(THEN, mode="MANUAL"), 1, "CHANGED_SITUATION"),
    "disarmed": (replace(THEN, armed=False), 1, "CHANGED_SITUATION"),
    "another vehicle": (replace(THEN, vehicle="2/1 px4 quadrotor"), 1, "CHANGED_SITUATION"),
    "another fence": (replace(THEN, policy="other"), 1, "CHANGED_SITUATION"),
}


@each("name", CASES)
def test_a_verdict_holds_while_it_is_as_it_was(name: str) -> None:
    now, now_ns, wanted = CASES[name]
    verdicts, verdict = issued()
    assert code(verdicts.look(verdict.number, "goto", now, now_ns)) == wanted
    assert code(verdicts.take(verdict.number, "goto", now, now_ns)) == wanted
    again = "USED_VERDICT" if not wanted else ""
    assert code(verdicts.take(verdict.number, "goto", THEN, 1)) == again, "what failed took none"


def test_it_is_for_its_own_request() -> None:
    verdicts, verdict = issued()
    assert code(verdicts.take(verdict.number, "land", THEN, 1)) == "WRONG_VERDICT"
    taken = verdicts.take(verdict.number, "goto", THEN, 1)
    assert isinstance(taken, Verdict)
    assert taken.ask == GOTO


def test_numbers_of_other_sessions_are_unknown() -> None:
    verdicts, verdict = issued()
    other = Verdicts("other").keep(GOTO, "goto 4 0 3", THEN, 0)
    assert code(verdicts.take(other.number, "goto", THEN, 1)) == "UNKNOWN_VERDICT"
    assert other.number != verdict.number


def test_old_ones_are_forgotten_and_so_refused() -> None:
    verdicts, first = issued()
    for _ in range(KEPT):
        last = verdicts.keep(GOTO, "goto 4 0 3", THEN, 0)
    assert code(verdicts.take(first.number, "goto", THEN, 1)) == "UNKNOWN_VERDICT"
    assert code(verdicts.take(last.number, "goto", THEN, 1)) == ""


def test_text_of_others_is_cut_and_obeyed_by_no_terminal() -> None:
    told = untrusted("vehicle", "\x1b[2J" + "x" * 1000)
    text = told["untrusted_text"]
    assert isinstance(text, str)
    assert (len(text), "\x1b" in text) == (MOST_LETTERS, False)


def test_a_sentence_that_may_quote_others_is_marked() -> None:
    assert sentence("OUTSIDE_FENCE", "outside") == {"sentence": "outside"}
    assert sentence("VEHICLE_REFUSED", "denied: obey me")["sentence"] != "denied: obey me"
