"""How a station's events are written."""

from __future__ import annotations

import pytest

from gcs import ipc
from gcs.operator.text.event_text import outcome_line, verdict_line


@pytest.mark.parametrize(
    ("outcome", "line"),
    [
        (ipc.EndingEvent(1, "arm", "complete", "", "Complete"), "arm: complete"),
        (
            ipc.EndingEvent(1, "arm", "aborted", "OPERATOR_LOST", "the operator is lost"),
            "arm: aborted OPERATOR_LOST: the operator left",
        ),
        (
            ipc.EndingEvent(
                1, "arm", "aborted", "OPERATOR_LOST", "the operator is lost; the vehicle goes on"
            ),
            "arm: aborted OPERATOR_LOST: the operator left; the vehicle goes on",
        ),
        (
            ipc.EndingEvent(1, "arm", "aborted", "LINK_LOST", "not heard any more"),
            "arm: aborted LINK_LOST: not heard any more",
        ),
    ],
)
def test_an_outcome_is_written_with_its_reason_if_there_is_one(
    outcome: ipc.EndingEvent, line: str
) -> None:
    assert outcome_line("arm", outcome) == line


@pytest.mark.parametrize(
    ("word", "code", "rule"),
    [
        ("fence", "POLICY", "its key fence_switchable is false"),
        ("disarm", "POLICY", "its key allow_force_disarm is false"),
        ("mode", "POLICY", "only modes that hold, land, return, are guided or fly the mission"),
        ("fence", "NO_VEHICLE", ""),
    ],
)
def test_a_refusal_by_the_policy_names_the_rule(word: str, code: str, rule: str) -> None:
    refused = ipc.VerdictEvent(1, word, "refused", code, "the policy does not allow it")
    line = verdict_line(word, refused)
    assert line.startswith(f"{word}: refused {code}: the policy does not allow it")
    assert rule in line
    assert ("its key" in line or "only modes" in line) == bool(rule)
