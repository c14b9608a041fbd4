"""MAV_RESULT of refusals: whether the client may ask again."""

from __future__ import annotations

import pytest

from gcs.bridge.answers import result_of
from gcs.gate.refusal import Code
from gcs.wire.ids import Result


@pytest.mark.parametrize("code", [Code.IN_AIR, Code.NOT_ARMED, Code.NOT_FLYING, Code.BUSY])
def test_what_another_command_or_waiting_helps_is_rejected_for_now(code: Code) -> None:
    """PX4 1.14, recorded ("disarm in air", commands_px4.json): TEMPORARILY_REJECTED."""
    assert result_of(code) is Result.TEMPORARILY_REJECTED


@pytest.mark.parametrize("code", [Code.OUTSIDE_FENCE, Code.POLICY, Code.ALREADY_FLYING])
def test_what_is_refused_for_good_is_denied(code: Code) -> None:
    assert result_of(code) is Result.DENIED
