"""The shipped missions: found from anywhere, clean, and inside the default fence."""

from __future__ import annotations

from pathlib import Path

import pytest

from gcs import resources
from gcs.cli.mission.check import check_plan
from gcs.cli.mission.files import read_plan
from gcs.exit_codes import ExitCode
from gcs.plan.errors import Level
from gcs.plan.model import AutopilotName

EVERY = resources.shipped()


def test_what_is_promised_is_shipped() -> None:
    assert EVERY == [
        "demo.toml",
        "fence.plan",
        "lab3/first_step.toml",
        "lab3/pictures.toml",
        "lab3/square.toml",
        "rally.plan",
        "square.toml",
        "survey.plan",
        "triangle.waypoints",
        "yard.toml",
    ]


@pytest.mark.parametrize("name", EVERY)
def test_each_is_named_in_the_readme_of_its_folder(name: str) -> None:
    path = resources.find(name)

    assert path.name in (path.parent / "README.md").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("name", "policy"),
    [(name, "default") for name in EVERY]
    + [(name, "lab") for name in EVERY if name.startswith("lab3/")],
)
def test_each_is_clean_and_cleared_by_the_fence(name: str, policy: str) -> None:
    plan = read_plan(name, None)

    checked = check_plan(plan, None, policy, None)

    assert [f for f in checked.findings if f.level is not Level.NOTE] == []
    assert plan.items or plan.rally
    assert (checked.verification is None) is not bool(plan.items)
    assert checked.verification is None or checked.verification.refusal is None
    assert checked.exit_code is ExitCode.DONE


@pytest.mark.parametrize("who", ["px4", "ardupilot"])
@pytest.mark.parametrize("name", [name for name in EVERY if name.endswith(".toml")])
def test_missions_in_metres_are_for_either_autopilot(name: str, who: AutopilotName) -> None:
    assert check_plan(read_plan(name, None), who, "default", None).exit_code is ExitCode.DONE


def test_a_mission_is_found_by_its_short_name_from_any_folder(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    demo = resources.missions_dir() / "demo.toml"

    for name in ("demo", "demo.toml", "missions/demo.toml", "./missions/demo.toml", str(demo)):
        assert resources.find(name) == demo


def test_a_file_of_the_users_own_comes_first(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "demo.toml").write_text("")

    assert resources.find("demo.toml") == Path("demo.toml")


def test_a_mission_that_is_nowhere_is_told_with_those_that_are() -> None:
    with pytest.raises(resources.MissionNotFoundError, match="nope") as caught:
        resources.find("nope")

    assert "lab3/square.toml" in caught.value.hint


def test_policies_are_found_by_name() -> None:
    assert resources.policy_path("lab").is_file()
    assert resources.policy_path("default").is_file()
    assert resources.policy_path("my.toml") == Path("my.toml")
