"""Ctrl-C while `gcs` starts: a share of the moments of `tests.system.measure_ctrl_c`."""

from __future__ import annotations

import pytest

from tests.shares import one_in
from tests.system.measure_ctrl_c import interrupt

pytestmark = pytest.mark.system


@pytest.mark.parametrize("at_s", one_in(3, [0.2, 0.4, 0.6, 0.9, 1.3, 2.0]))
def test_a_ctrl_c_at_the_start_ends_it_without_a_traceback_or_a_process_left(at_s: float) -> None:
    ended = interrupt(at_s, "--plain")
    assert ended.good or ended.before_us, ended
