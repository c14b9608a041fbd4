"""`gcs status`: the rows of its table."""

from __future__ import annotations

import msgspec

from gcs.cli.status import rows
from tests.unit.operator.fake_station import FakeStation


def test_a_heading_goes_round_and_a_rate_not_measured_is_left_out() -> None:
    seen = msgspec.structs.replace(FakeStation().snapshot(), yaw_deg=359.7, rx_hz=0.0)
    shown = dict(rows(seen))
    assert shown["heading"] == "0 deg"
    assert shown["link"] == "0.0 % lost"


def test_unknown_values_are_dashes() -> None:
    shown = dict(rows(FakeStation("silent").snapshot()))
    assert shown["position"].startswith("E - N - U -")
