"""`mavgate.toml`: project over user, options over both, strict; keys; and `gcs config`."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import click
import pytest

from gcs.cli import common_options, options, settings
from gcs.cli.settings_file import parse, template
from gcs.config import DEFAULT_LINK, StationConfig
from gcs.exit_codes import ExitCode
from gcs.toml import TomlError
from gcs.tui.keymap import ACTIONS, DEFAULT, KeymapError, keymap
from tests.each import each
from tests.unit.cli.command_line import gcs

Write = Callable[[str, str], Path]


@pytest.fixture
def write(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Write:
    """Writes the `user`'s file or the `project`'s; the working folder lies in the project."""
    work = tmp_path / "project" / "flights"
    work.mkdir(parents=True)
    monkeypatch.chdir(work)
    folders = {"user": tmp_path / "home", "project": tmp_path / "project"}
    monkeypatch.setattr(
        settings, "user_place", lambda: settings.Place("user", folders["user"] / settings.NAME)
    )

    def written(level: str, text: str) -> Path:
        folders[level].mkdir(exist_ok=True)
        path = folders[level] / settings.NAME
        path.write_text(text, encoding="utf-8")
        settings._loaded.cache_clear()
        return path

    return written


def shown() -> dict[str, tuple[Any, str, int]]:
    told = json.loads(gcs("config", "show", "--json").output)
    return {each["key"]: (each["value"], each["from"], each["line"]) for each in told["values"]}


def test_without_a_file_the_defaults_hold(write: Write) -> None:
    assert shown() == {
        "links": ([DEFAULT_LINK], "default", 0),
        "policy": ("default", "default", 0),
        "log_dir": ("logs", "default", 0),
        "timeout_s": (10.0, "default", 0),
    }


def test_the_project_goes_before_the_user_and_each_value_names_its_line(write: Write) -> None:
    write("user", 'policy = "lab"\ntimeout_s = 5\n[keys]\nhold = ["h"]\nland = ["L"]\n')
    project = write("project", '\npolicy = "demo"\nlog_dir = "records"\n[keys]\nhold = ["H"]\n')
    assert shown() == {
        "links": ([DEFAULT_LINK], "default", 0),
        "policy": ("demo", "project", 2),
        "log_dir": (str(project.parent / "records"), "project", 3),
        "timeout_s": (5.0, "user", 2),
        "keys.hold": (["H"], "project", 5),
        "keys.land": (["L"], "user", 5),
    }
    assert "policy     demo" in (table := gcs("config", "show").output)
    assert f"{project}:2" in table


def test_a_command_has_what_the_files_say_and_options_go_before_them(
    write: Write, monkeypatch: pytest.MonkeyPatch
) -> None:
    made: list[StationConfig] = []
    monkeypatch.setattr(
        common_options,
        "station_config",
        lambda *a, **k: made.append(options.station_config(*a, **k)),
    )
    monkeypatch.setattr("gcs.cli.oneshot_session.run", lambda *_: ExitCode.DONE)
    write("project", 'links = ["udpin://127.0.0.1:5"]\npolicy = "lab"\ntimeout_s = 3\n')
    gcs("arm")
    gcs("arm", "--link", "udpin://127.0.0.1:6", "--policy", "default", "--timeout", "4")
    assert [(each.endpoints, each.connect_timeout_s) for each in made] == [
        (["udpin://127.0.0.1:5"], 3.0),
        (["udpin://127.0.0.1:6"], 4.0),
    ]
    assert [Path(each.policy_path).name for each in made] == ["lab.toml", ""]


@each(
    "wrong",
    [
        ('polcy = "lab"', "1: polcy: unknown key", "did you mean policy?"),
        ("\npolicy = 3", "2: policy: 3 is not a text", "write it in quotes"),
        ("timeout_s = 0", "1: timeout_s: 0 is impossible", "between 0.1 and 86400"),
        ('links = "udpin://:1"', "1: links: ", "such as"),
        ('links = ["udpin:127.0.0.1"]', "1: links[1]: ", "such as udpin:127.0.0.1:14550"),
        ("links = []", "1: links: names no link", "leave the key out"),
        ('[keys]\nlnad = ["L"]', "2: keys.lnad: no such action", "did you mean land?"),
        ('[keys]\nland = ["spcae"]', '2: keys.land: "spcae" is no key', "did you mean space?"),
        ('[keys]\nland = ["h"]', "2: keys.land: the key h is that of hold", "give hold another"),
        ("[keys]\nabort = []", "2: keys.abort: has no key", "nobody can do without"),
    ],
)
def test_what_is_wrong_names_file_line_and_what_to_do(
    write: Write, wrong: tuple[str, str, str]
) -> None:
    text, told, hint = wrong
    path = write("project", text)
    ended = gcs("config", "check")
    assert ended.exit_code == ExitCode.BAD_FILE
    assert f"gcs: {path}:{told}" in ended.output
    assert hint in ended.output.split("hint: ")[1]


def test_all_that_is_wrong_is_told_at_once(write: Write) -> None:
    path = write(
        "project", 'links = 3\npolcy = 5\ntimeout_s = 0\n[keys]\nlnad = ["L"]\nhold = [" "]'
    )
    other = write("user", 'policy = "nosuch.toml"')
    ended = gcs("config", "check")
    assert ended.exit_code == ExitCode.BAD_FILE
    told = [line for line in ended.output.splitlines() if line.startswith("gcs: ")]
    places = [*(f"{path}:{line}:" for line in (1, 2, 3, 5, 6)), f"{other}:1:"]
    assert [each.split()[1] for each in told] == places


def test_a_wrong_file_keeps_a_flight_back_and_never_a_stop(
    write: Write, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("gcs.cli.oneshot_session.run", lambda *_: ExitCode.DONE)
    write("project", "polcy = 1")
    assert gcs("goto", "1", "0", "2").exit_code == ExitCode.BAD_FILE
    stopped = gcs("abort")
    assert stopped.exit_code == ExitCode.DONE
    assert "unknown key (left out, as this is a stop)" in stopped.output
    assert gcs("goto", "--help").exit_code == ExitCode.DONE


def test_a_policy_is_checked_with_the_file(write: Write) -> None:
    path = write("project", '\npolicy = "own.toml"\n')
    missing = gcs("config", "check")
    assert missing.exit_code == ExitCode.BAD_FILE
    assert f"{path}:2: policy: {path.parent / 'own.toml'}: No such file" in missing.output
    (path.parent / "own.toml").write_text("margin_h_m = 2.5\n")
    assert gcs("config", "check").output == f"{path}: in order\n"


def test_two_files_may_not_give_one_key_to_two_actions(write: Write) -> None:
    write("user", '[keys]\nland = ["L"]\n')
    path = write("project", '[keys]\nrtl = ["L"]\n')
    ended = gcs("config", "check")
    assert ended.exit_code == ExitCode.BAD_FILE
    assert f"{path}:2: keys.rtl: the key L is that of land" in ended.output


def test_init_writes_a_file_that_changes_nothing_once(write: Write) -> None:
    assert gcs("config", "init").exit_code == ExitCode.DONE
    assert gcs("config", "init").exit_code == ExitCode.USAGE
    assert gcs("config", "check").exit_code == ExitCode.DONE
    assert {origin for _, origin, _ in shown().values()} == {"default"}


def test_each_line_of_that_file_is_what_holds_without_it() -> None:
    text = template(DEFAULT_LINK)
    first = text.index("# links")
    read = parse(text[:first] + text[first:].replace("\n# ", "\n")[2:], Path("/x/mavgate.toml"))
    assert read.settings.links == (DEFAULT_LINK,)
    assert (read.settings.policy, read.settings.log_dir) == ("default", "/x/logs")
    assert read.settings.timeout_s == 10.0
    assert set(read.settings.keys or ()) == set(ACTIONS)
    assert read.keymap.actions == DEFAULT.actions


def test_no_file_no_work() -> None:
    context = click.Context(click.Command("goto"))
    assert options.POLICY.get_default(context) == "default"


def test_keys_are_written_as_signs_or_by_name() -> None:
    made = keymap({"abort": ["[", "ctrl+x"], "yaw_left": ["F5"], "fit": []})
    assert made.abort == "left_square_bracket"
    assert made.actions["ctrl+x"] == "request('abort')"
    assert made.actions["f5"] == "turn(-15)"
    assert "space" not in made.actions
    assert "z" not in made.actions
    assert {key.shown for key in made.keys} >= {"[ ctrl+x", "f5"}
    assert keymap({"north": ["i"], "fly_mission": ["w"]}).moves == "i↓←→ r f"
    with pytest.raises(KeymapError):
        keymap({"hold": ["x", "x"]})


def test_another_users_file_is_not_read(write: Write, monkeypatch: pytest.MonkeyPatch) -> None:
    write("project", 'policy = "demo"\n')
    monkeypatch.setattr("os.getuid", lambda: 4711)
    monkeypatch.setattr(settings, "ROOT", 4712)
    ended = gcs("config", "show")
    assert ended.exit_code == ExitCode.BAD_FILE
    assert "belongs to another user" in ended.output


def test_toml_that_is_none_is_told(write: Write) -> None:
    with pytest.raises(TomlError, match="not TOML"):
        parse("policy lab", Path("/x/mavgate.toml"))
