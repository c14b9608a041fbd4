"""Which warnings a console leaves out."""

from __future__ import annotations

import pytest

from gcs import ipc
from gcs.operator.conversation import TrackedRequest
from gcs.operator.text.event_text import WarningFilter

CAUTION = "CAUTION: vehicle_failsafe_weak: the vehicle's own failsafes: none"


@pytest.mark.parametrize(("cautions", "shown"), [(True, True), (False, False)])
def test_a_standing_caution_is_shown_if_it_is_wanted(cautions: bool, shown: bool) -> None:
    hidden = WarningFilter(cautions=cautions).hides(ipc.LogEvent(0, 3, "gate", CAUTION), None)
    assert hidden is not shown


def test_only_the_copy_of_an_own_refusal_is_hidden() -> None:
    warnings = WarningFilter(cautions=True)
    copy = ipc.LogEvent(0, 3, "gate", "Refused (BUSY): the vehicle is MOVING")
    assert not warnings.hides(copy, None)
    verdict = ipc.VerdictEvent(1, "goto", "refused", "BUSY", "the vehicle is MOVING")
    warnings.hides(verdict, TrackedRequest(ipc.Ask(1, "goto"), "goto"))
    assert warnings.hides(copy, None)
    assert not warnings.hides(ipc.LogEvent(0, 3, "gate", "Refused (STALE): too old"), None)
    assert not warnings.hides(ipc.LogEvent(0, 4, "gate", copy.text), None)
    lost = ipc.EndingEvent(1, "goto", "aborted", "OPERATOR_LOST", "the operator is lost")
    warnings.hides(lost, TrackedRequest(ipc.Ask(1, "goto"), "goto"))
    assert warnings.hides(ipc.LogEvent(0, 3, "gate", "goto: aborted: the operator is lost"), None)
