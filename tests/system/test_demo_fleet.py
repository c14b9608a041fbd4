"""`gcs demo --fleet`: three vehicles, and of two goals that cross one is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.system.programs import gcs

pytestmark = [pytest.mark.system, pytest.mark.thorough]


def test_it_comes_to_what_it_says_and_its_record_is_whole(tmp_path: Path) -> None:
    ended = gcs("demo", "--fleet", "--log-dir", str(tmp_path))
    assert ended.returncode == 0, ended.stdout + ended.stderr
    assert "vehicle 2: goto -5 15 5: refused OTHER_VEHICLE" in ended.stdout
    assert "too_close" not in ended.stdout + ended.stderr
    (record,) = tmp_path.glob("*_fleet.mcap")
    audited = gcs("log", "audit", str(record))
    assert audited.returncode == 0, audited.stdout
