"""How a station's events are written."""

from __future__ import annotations

import pytest

from gcs import ipc
from gcs.operator.event_text import outcome_line


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
