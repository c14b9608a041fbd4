"""The command line itself: lazy, with exit codes, and without tracebacks."""

from __future__ import annotations

import errno
import os
import subprocess
import sys
from pathlib import Path

import click
import pytest

import gcs as gcs_library
from gcs import resources
from gcs.cli import main, oneshot, oneshot_session
from gcs.config import StationConfig
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError
from tests.unit.cli.command_line import gcs

HEAVY = (
    *("rich", "numpy", "msgspec", "pymavlink", "textual", "asyncio", "subprocess"),
    "gcs.cli.fly.fly",
)


def run_python(code: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)


@pytest.mark.slow
def test_help_imports_nothing_heavy() -> None:
    code = (
        "import sys\nfrom gcs.cli.main import run\nassert run(['--help']) == 0\n"
        f"heavy = [name for name in {HEAVY!r} if name in sys.modules]\n"
        "sys.exit(', '.join(heavy) or 0)"
    )
    result = run_python(code)
    assert result.returncode == 0, result.stderr
    for section in main.COMMANDS.values():
        for name in section:
            assert f"  {name} " in result.stdout


@pytest.mark.slow
def test_mavutil_is_never_loaded_by_a_command_line() -> None:
    code = (
        "import sys, gcs.cli.fly.fly, gcs.cli.demo.demo, gcs.cli.oneshot_session, gcs.tui.app\n"
        "sys.exit('pymavlink.mavutil' in sys.modules)"
    )
    assert run_python(code).returncode == 0


OURS = ("demo", "fly", *main.COMMANDS["One command, then leave"])


@pytest.mark.parametrize("name", OURS)
def test_every_command_has_help_with_an_example(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main.run([name, "--help"]) == ExitCode.DONE
    assert "Example" in capsys.readouterr().out


def test_a_command_without_arguments_shows_none(capsys: pytest.CaptureFixture[str]) -> None:
    main.run(["arm", "--help"])
    main.run(["goto", "--help"])
    arm, goto = capsys.readouterr().out.split("Usage: ")[1:]
    assert arm.startswith("gcs arm [OPTIONS]\n")
    assert "EAST NORTH UP [YAW_DEG]" in goto


def test_a_glance_at_the_vehicle_keeps_no_record(monkeypatch: pytest.MonkeyPatch) -> None:
    started: dict[str, StationConfig] = {}

    def run(
        setup: StationConfig, how: oneshot_session.OneShotConfig, _: oneshot_session.Task
    ) -> int:
        started[how.what] = setup
        return ExitCode.DONE

    monkeypatch.setattr(oneshot_session, "run", run)
    main.run(["status"])
    main.run(["land"])
    assert {what: setup.record for what, setup in started.items()} == {
        "status": False, "land": True,
    }  # fmt: skip


@pytest.mark.slow
def test_python_m_gcs_is_the_gcs_command() -> None:
    ended = [
        subprocess.run([sys.executable, *start, *args], capture_output=True, text=True, check=False)
        for args in (["--help"], ["got"])
        for start in (["-m", "gcs"], ["-c", "from gcs.cli.main import main; main()"])
    ]
    assert [each.returncode for each in ended] == [0, 0, ExitCode.USAGE, ExitCode.USAGE]
    assert ended[0].stdout == ended[1].stdout != ""
    assert ended[2].stderr == ended[3].stderr != ""
    assert "Usage: gcs" in ended[0].stdout


def test_version(capsys: pytest.CaptureFixture[str]) -> None:
    assert main.run(["--version"]) == ExitCode.DONE
    assert capsys.readouterr().out.startswith("gcs ")


@pytest.mark.parametrize(
    ("args", "told"),
    [
        (["got"], "no command 'got'; did you mean 'goto'?"),
        (["tune"], "no command 'tune'; `gcs --help` lists them"),
        (["stauts"], "no command 'stauts'; did you mean 'status'?"),
        (["aborrt"], "no command 'aborrt'; did you mean 'abort'?"),
        (["goto", "1", "2"], "goto: expected 3 numbers EAST NORTH UP [YAW_DEG], got 2"),
        (["goto", "-1", "x", "2"], "goto: NORTH: expected a number, got 'x'"),
        (["goto", "nan", "0", "2"], "goto: EAST: expected a number, got 'nan'"),
        (["takeoff", "inf"], "takeoff: UP: expected a number, got 'inf'"),
        (["goto", "1", "0", "2", "nan"], "goto: YAW_DEG: expected a number of degrees"),
        (["goto", "1", "0", "2", "400"], "goto: YAW_DEG: expected a number of degrees"),
        (["goto", "1_0", "0", "2"], "goto: EAST: expected a number, got '1_0'"),
        (["goto", "\uff13", "0", "2"], "goto: EAST: expected a number, got '\uff13'"),
        (["goto", "1", "0", "2", "--yaw", "3"], "goto: no option --yaw"),
        (["land", "--timeout", "nan"], "'nan' is not a number"),
        (["land", "--wait", "inf"], "'inf' is not a number"),
        (["land", "--wait", "1_0"], "'1_0' is not a number"),
        (["fly", "--sim", "--speedup", "nan"], "'nan' is not a number"),
        (["fly", "--sim", "--seed", "-1"], "-1 is negative"),
        (["fly", "--sim", "--seed", "1_0"], "'1_0' is not a whole number"),
        (["fly", "--sim", "--home", "4_7,8,488"], "'4_7,8,488' is not as in"),
        (["fly", "--name", "a/b"], "'a/b' is no part of a file name"),
        (["fly", "--name", "../../x"], "'../../x' is no part of a file name"),
        (["fly", "--name", ""], "'' is no part of a file name"),
        (["fly", "--name", 300 * "a"], "has 300 characters; at most 80"),
        (["fly", "--plain", "--speedup", "5"], "--speedup is for the vehicle of --sim"),
        (["fly", "--plain", "--home", "47,8,488"], "--home is for the vehicle of --sim"),
        (["fly", "--plain", "--seed", "1"], "--seed is for the vehicle of --sim"),
        (["fly", "--autopilot", "px4"], "--autopilot is for the vehicle of --sim"),
        (["land", "now"], "land: expected at most [all], got 1"),
        (["takeoff"], "takeoff: expected 1 number UP, got nothing"),
        (["fly", "--sim", "--link", "udpin://127.0.0.1:1"], "--sim starts a vehicle of its own"),
        (["fly", "--autopilot", "px5"], "px5"),
        (["fly", "--speedup", "0"], "--speedup"),
    ],
)
def test_usage_errors_are_two_and_say_why(
    args: list[str], told: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main.run(args) == ExitCode.USAGE
    assert told in capsys.readouterr().err


@pytest.mark.parametrize("args", [["help"], ["help", "fly"], ["help", "mission", "fly"]])
def test_help_is_a_command_too(args: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main.run(args) == ExitCode.DONE
    helped = capsys.readouterr().out
    assert main.run([*args[1:], "--help"]) == ExitCode.DONE
    assert helped == capsys.readouterr().out


def test_a_directory_is_no_policy(tmp_path: Path) -> None:
    ended = gcs("fly", "--plain", "--policy", tmp_path)
    assert ended == (
        ExitCode.BAD_FILE,
        f"gcs: {tmp_path}: is a directory\n  hint: a policy is a TOML file or default, lab, demo\n",
    )


NOT_UTF8 = os.fsdecode(b"not-\xff-utf8")


@pytest.mark.skipif(os.name != "posix", reason="a file's name is bytes on POSIX only")
@pytest.mark.parametrize(
    "args",
    [
        ["status", "--log-dir", NOT_UTF8],
        ["land", "--link", NOT_UTF8],
        ["land", "--policy", NOT_UTF8],
        ["mode", NOT_UTF8],
        ["fly", "--plain", "--name", NOT_UTF8],
        ["demo", "--log-dir", NOT_UTF8],
        ["mission", "upload", NOT_UTF8 + ".toml"],
        ["mission", "download", "-o", NOT_UTF8 + ".plan"],
    ],
    ids=lambda args: " ".join(args[:-1]),
)
def test_what_is_not_utf8_is_refused_before_any_station_is_started(
    args: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def start(*_: object) -> None:
        raise AssertionError("a station was started")

    monkeypatch.setattr("gcs.operator.client.StationClient.start", start)
    monkeypatch.chdir(tmp_path)
    try:
        Path(NOT_UTF8).write_text('name = "not UTF-8"\n')
        Path(NOT_UTF8 + ".toml").write_bytes(resources.find("demo").read_bytes())
    except OSError:
        pytest.skip("this file system has no such names")
    ended = gcs(*args)
    assert (ended.exit_code, ended.output.count("is not UTF-8")) == (ExitCode.USAGE, 1)


@pytest.mark.slow
def test_a_keyboard_station_needs_a_terminal(capsys: pytest.CaptureFixture[str]) -> None:
    result = subprocess.run(
        [sys.executable, "-c", "from gcs.cli.main import main; main()", "fly", "--sim"],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )
    assert result.returncode == ExitCode.USAGE
    assert "use --plain on a pipe" in result.stderr


@pytest.mark.slow
@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full here")
def test_output_that_cannot_be_written_is_told_and_is_no_bug() -> None:
    with open("/dev/full", "w", encoding="utf-8") as full:
        result = subprocess.run(
            [sys.executable, "-c", "from gcs.cli.main import main; main()", "fsa"],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert result.returncode == ExitCode.RECORDER
    assert result.stderr == "gcs: cannot write the output: No space left on device\n"


@pytest.mark.slow
def test_a_reader_that_has_gone_ends_it_quietly() -> None:
    reader, writer = os.pipe()
    os.close(reader)
    with os.fdopen(writer, "w") as pipe:
        result = subprocess.run(
            [sys.executable, "-c", "from gcs.cli.main import main; main()", "fsa"],
            stdout=pipe,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert result.returncode == ExitCode.READER_GONE
    assert result.stderr == ""


@pytest.mark.parametrize(
    ("error", "os_name", "gone"),
    [
        (OSError(errno.EINVAL, "Invalid argument"), "nt", True),
        (OSError(errno.EINVAL, "Invalid argument", "a:b"), "nt", False),
        (OSError(errno.EINVAL, "Invalid argument"), "posix", False),
        (OSError(errno.EACCES, "Permission denied"), "nt", False),
        (ValueError("Invalid argument"), "nt", False),
    ],
)
def test_a_broken_pipe_has_another_name_on_windows(
    error: Exception, os_name: str, gone: bool
) -> None:
    assert main._reader_has_gone(error, os_name) is gone


@pytest.mark.slow
def test_what_the_terminal_cannot_show_is_escaped(tmp_path: Path) -> None:
    mission = tmp_path / "go\u2192.toml"
    mission.write_bytes(resources.find("demo").read_bytes())
    result = subprocess.run(
        [sys.executable, "-m", "gcs", "mission", "check", str(mission)],
        env={**os.environ, "PYTHONIOENCODING": "latin-1:strict"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert (result.returncode, result.stderr) == (ExitCode.DONE, "")
    assert "go\\u2192.toml: demo: 7 items" in result.stdout


def _raising(error: BaseException) -> click.Command:
    def callback() -> None:
        raise error

    return click.Command("land", callback=callback)


@pytest.mark.parametrize(
    ("error", "code", "told"),
    [
        (
            ExitError(ExitCode.BAD_FILE, "a.plan: no", "try b"),
            ExitCode.BAD_FILE,
            "gcs: a.plan: no\n  hint: try",
        ),
        (KeyboardInterrupt(), ExitCode.INTERRUPTED, "interrupted"),
        (
            RuntimeError("boom"),
            ExitCode.BUG,
            "gcs: internal error: RuntimeError: boom\n  details: ",
        ),
    ],
    ids=["fail", "ctrl-c", "bug"],
)
def test_errors_become_sentences_and_exit_codes(
    error: BaseException,
    code: ExitCode,
    told: str,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.setattr(oneshot, "land", _raising(error))
    assert main.run(["land"]) == code
    shown = capsys.readouterr().err
    assert told in shown
    assert "Traceback" not in shown


def test_a_bug_leaves_its_details_in_a_file(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: object
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr(oneshot, "land", _raising(RuntimeError("boom")))
    main.run(["land"])
    path = capsys.readouterr().err.split("details: ")[1].strip()
    with open(path, encoding="utf-8") as file:
        assert "RuntimeError: boom" in file.read()


def test_the_details_of_a_bug_are_kept_whatever_was_typed(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr("sys.argv", ["gcs", "land", NOT_UTF8])
    monkeypatch.setattr(oneshot, "land", _raising(RuntimeError("boom")))
    assert gcs("land").exit_code == ExitCode.BUG
    (details,) = tmp_path.iterdir()
    assert "gcs land not-" in details.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("words", "code", "told"),
    [
        ("mission check missions", ExitCode.BAD_FILE, "missions: is a folder\n  hint: name a file"),
        ("topic info NOSUCHMSG", ExitCode.USAGE, "MAVLink has no message of that name"),
        ("topic echo ATTITUD.roll", ExitCode.USAGE, "did you mean 'ATTITUDE'?"),
        ("topic hz ATTITUD", ExitCode.USAGE, "MAVLink has no message of that name"),
        ("topic info ATITUDE", ExitCode.USAGE, "hint: did you mean 'ATTITUDE'?"),
        (
            "status --vehicle me",
            ExitCode.USAGE,
            "'me' is no MAVLink system id, a whole",
        ),
    ],
)
def test_what_is_typed_wrong_is_named(words: str, code: int, told: str) -> None:
    assert gcs(*words.split()).exit_code == code
    assert told in gcs(*words.split()).output


def test_the_common_options_are_told_once_and_named_by_each_command() -> None:
    page = gcs("help", "options").output
    for words in ("goto", "status", "mission upload"):
        told = gcs(*words.split(), "--help").output
        assert "(gcs help options):\n  --link --vehicle --policy" in told
        assert "Where the vehicle is" not in told
    assert {"--link", "--vehicle", "--policy", "--take", "--quiet"} <= set(told.split())
    assert "Where the vehicle is" in page
    assert "[default: udpin://127.0.0.1:14550]" in page
    assert "options" not in main.gcs.list_commands(click.Context(main.gcs))


def test_the_library_is_seen_by_whoever_asks_what_there_is() -> None:
    assert set(gcs_library.__all__) <= set(dir(gcs_library))


def test_a_package_that_is_not_installed_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "gcs.gate.machine", None)
    ended = gcs("fsa")
    assert ended.exit_code == ExitCode.USAGE
    assert "is not installed\n  hint: pip install mavgate" in ended.output
