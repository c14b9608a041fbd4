"""A command that hears no vehicle keeps no record."""

from __future__ import annotations

import subprocess
from pathlib import Path

from gcs.exit_codes import ExitCode
from tests.system.programs import GCS, LONGEST_S


def test_a_one_shot_without_a_vehicle_leaves_no_log(tmp_path: Path) -> None:
    link = ["--link", "udpin://127.0.0.1:0", "--log-dir", str(tmp_path), "--timeout", "0.5"]
    ended = subprocess.run([GCS, "arm", *link], capture_output=True, timeout=LONGEST_S, check=False)
    assert ended.returncode == ExitCode.NO_VEHICLE
    assert list(tmp_path.glob("*.mcap")) == []
