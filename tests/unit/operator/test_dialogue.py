"""A dialogue with a station: what becomes of a request, and what a program exits with."""

from __future__ import annotations

import pytest

from gcs import ipc
from gcs.exit_codes import ExitCode
from gcs.operator.dialogue import TrackedRequest


@pytest.mark.parametrize(
    ("ruling", "code", "ended", "outcome_code", "exit_code"),
    [
        ("accepted", "", "complete", "", ExitCode.DONE),
        ("accepted", "", "aborted", "VEHICLE_REFUSED", ExitCode.REFUSED_BY_VEHICLE),
        ("accepted", "", "timed out", "DEADLINE", ExitCode.NOT_COMPLETED),
        ("accepted", "", "taken over", "MODE_CHANGED", ExitCode.NOT_COMPLETED),
        ("refused", "BUSY", "", "", ExitCode.REFUSED_BY_GATE),
        ("refused", "NO_VEHICLE", "", "", ExitCode.NO_VEHICLE),
        ("refused", "BAD_MISSION", "", "", ExitCode.BAD_FILE),
        ("refused", "RECORDER_DOWN", "", "", ExitCode.RECORDER),
        ("superseded", "SUPERSEDED", "", "", ExitCode.REFUSED_BY_GATE),
        ("accepted", "", "", "", ExitCode.NOT_COMPLETED),
    ],
)
def test_exit_codes_mean_something(
    ruling: str, code: str, ended: str, outcome_code: str, exit_code: ExitCode
) -> None:
    verdict = ipc.VerdictEvent(1, "goto", ruling, code)
    tracked = TrackedRequest(ipc.Ask(1, "goto"), "goto", verdict)
    if ended:
        tracked.outcome = ipc.EndingEvent(1, "goto", ended, outcome_code)
    assert tracked.exit_code == exit_code
