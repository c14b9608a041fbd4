"""`gcs campaign`: what is wrong is told before anything is flown."""

from __future__ import annotations

from pathlib import Path

import msgspec

from gcs.campaign.store import Store
from gcs.exit_codes import ExitCode
from tests.unit.campaign.campaigns import TEXT, planned, written
from tests.unit.cli.command_line import gcs


def test_errors_have_their_exit_codes(tmp_path: Path) -> None:
    file = str(written(tmp_path))
    told = gcs("campaign", "run", file, "--require", "breeches == 0")
    assert (told.exit_code, "did you mean breaches?" in told.output) == (ExitCode.USAGE, True)
    written(tmp_path, TEXT.replace("wind_m_s", "wind"))
    told = gcs("campaign", "run", file)
    assert (told.exit_code, f"{file}:16: vary.wind" in told.output) == (ExitCode.BAD_FILE, True)
    told = gcs("campaign", "run", str(tmp_path / "no.toml"))
    assert told.exit_code == ExitCode.BAD_FILE
    told = gcs("campaign", "show", str(tmp_path), "3")
    assert told.exit_code == ExitCode.BAD_FILE


def test_the_folder_of_another_campaign_is_left_alone(tmp_path: Path) -> None:
    plan = planned(tmp_path)
    Store(tmp_path / "campaign").begin(msgspec.structs.replace(plan, seed=99))
    told = gcs("campaign", "run", str(tmp_path / "campaign.toml"))
    assert told.exit_code == ExitCode.USAGE
    assert "another campaign" in told.output
    told = gcs("campaign", "show", str(tmp_path / "campaign"), "3")
    assert (told.exit_code, "no flight 3" in told.output) == (ExitCode.USAGE, True)
