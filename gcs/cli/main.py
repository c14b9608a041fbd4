"""`gcs`: one table of commands, each imported only when it is called.

This module is what every start pays for, so it imports click and nothing else of weight.
"""

from __future__ import annotations

import errno
import importlib
import os
import sys
from collections.abc import Sequence
from io import TextIOWrapper
from typing import TYPE_CHECKING, NamedTuple, NoReturn, cast

import click

from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError, error_lines

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

_NO_ROOM = (errno.ENOSPC, errno.EDQUOT) if hasattr(errno, "EDQUOT") else (errno.ENOSPC,)


class Entry(NamedTuple):
    """One command: where it lives, its line in the help, and commands added to it if a group."""

    target: str  # "module:attribute"
    help: str
    more: str = ""  # "module:attribute" of them


COMMANDS: dict[str, dict[str, Entry]] = {
    "Fly": {
        "demo": Entry(
            "gcs.cli.demo.demo:demo", "A whole flight in a minute, on a simulated vehicle."
        ),
        "fly": Entry("gcs.cli.fly.fly:fly", "The keyboard ground station, or --plain lines."),
        "bridge": Entry("gcs.cli.bridge.bridge:bridge", "MAVLink clients fly it through the gate."),
        "mcp": Entry("gcs.cli.mcp.mcp:mcp", "An agent flies it through the gate (MCP)."),
        "live": Entry("gcs.cli.live:live", "The flight in a viewer such as Foxglove, as it flies."),
    },
    "One command, then leave": {
        "status": Entry("gcs.cli.oneshot:status", "What the vehicle reports."),
        "preflight": Entry(
            "gcs.cli.preflight:preflight", "What passes, and what fails, before a take-off."
        ),
        "control": Entry("gcs.cli.oneshot:control", "Take control of a flying vehicle."),
        "arm": Entry("gcs.cli.oneshot:arm", "Arm the motors."),
        "takeoff": Entry("gcs.cli.oneshot:takeoff", "Climb above the take-off point and hover."),
        "goto": Entry("gcs.cli.oneshot:goto", "Fly straight to a point, metres E N U."),
        "goto-global": Entry(
            "gcs.cli.oneshot:goto-global", "Fly straight to latitude, longitude, height."
        ),
        "move": Entry("gcs.cli.oneshot:move", "Fly so far east, north, up of where it is."),
        "forward": Entry("gcs.cli.oneshot:forward", "Fly so far where its nose points."),
        "heading": Entry("gcs.cli.oneshot:heading", "Turn the nose, and nothing else."),
        "speed": Entry("gcs.cli.oneshot:speed", "The most that the next legs are flown at."),
        "orbit": Entry("gcs.cli.oneshot:orbit", "Fly round a circle."),
        "land": Entry("gcs.cli.oneshot:land", "Land where it is."),
        "rtl": Entry("gcs.cli.oneshot:rtl", "Return to home and land."),
        "hold": Entry("gcs.cli.oneshot:hold", "Stop and hold, in the vehicle's own hold mode."),
        "abort": Entry("gcs.cli.oneshot:abort", "Stop now and forget the goal."),
        "resume": Entry("gcs.cli.oneshot:resume", "Hover under our control after a hold."),
        "disarm": Entry("gcs.cli.oneshot:disarm", "Stop the motors on the ground."),
        "mode": Entry("gcs.cli.oneshot:mode", "Ask for a flight mode by the autopilot's name."),
        "photo": Entry("gcs.cli.oneshot:photo", "Take a picture."),
    },
    "A station that runs": {
        "stations": Entry("gcs.cli.stations:stations", "The running stations of this user."),
        "attach": Entry("gcs.cli.fly.attach:attach", "A second screen, or --plain lines, on one."),
        "operations": Entry("gcs.cli.operations:operations", "What is under way; wait, stop."),
    },
    "Files": {
        "mission": Entry(
            "gcs.cli.mission.mission:mission",
            "Mission files: check, show, convert, new, upload, download, fly, set-current, clear.",
            more="gcs.cli.mission.live:COMMANDS",
        ),
        "param": Entry(
            "gcs.cli.param.param:param",
            "Parameters of the vehicle: list, get, set, show, save, load, diff.",
        ),
        "vehicle-log": Entry(
            "gcs.cli.vehicle_log:vehicle_log", "Flight logs that the vehicle keeps: list, get."
        ),
        "fence": Entry(
            "gcs.cli.mission.plan_parts:fence",
            "A vehicle's own fence: check, show, upload, download, clear, put.",
        ),
        "rally": Entry(
            "gcs.cli.mission.plan_parts:rally",
            "Rally points: check, show, upload, clear.",
        ),
        "key": Entry("gcs.cli.key:key", "Signing keys: new, show, install on a vehicle, remove."),
        "topic": Entry(
            "gcs.cli.topic.topic:topic", "Messages live or recorded: list, echo, hz, plot."
        ),
        "graph": Entry("gcs.cli.graph:graph", "Who sends what to whom, with rates; SVG, DOT."),
        "campaign": Entry(
            "gcs.cli.campaign.campaign:campaign", "Many flights on a virtual clock: run, show."
        ),
        "log": Entry("gcs.cli.log.log:log", "Recorded flights: info, layout, recover, replay."),
        "completion": Entry(
            "gcs.cli.completion:completion", "For bash, zsh and fish: words, files, vehicles."
        ),
        "config": Entry("gcs.cli.config:config", "The file mavgate.toml: show, check, init."),
        "fsa": Entry("gcs.cli.fsa:fsa", "The gate's state machine, printed from its table."),
    },
}


OPTIONS = "options"
"""Of `gcs help options`: no command, but a page."""


def _load(target: str) -> object:
    module, attribute = target.split(":")
    return getattr(importlib.import_module(module), attribute)


class LazyGroup(click.Group):
    """A group that knows its commands' names and one-line helps without importing them."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """`gcs help fly` is `gcs fly --help`."""
        if args[:1] == ["help"]:
            args = [OPTIONS] if args[1:] == [OPTIONS] else [*args[1:], "--help"]
        return super().parse_args(ctx, args)

    def list_commands(self, ctx: click.Context) -> list[str]:
        return [name for section in COMMANDS.values() for name in section]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        if cmd_name == OPTIONS:
            return cast("click.Command", _load("gcs.cli.common_options:options"))
        for section in COMMANDS.values():
            if cmd_name in section:
                return _with_additions(section[cmd_name])
        return None

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """Without a look into the commands, which would import them all."""
        from click.shell_completion import CompletionItem

        entries = {name: entry for section in COMMANDS.values() for name, entry in section.items()}
        commands = [
            CompletionItem(name, help=entry.help)
            for name, entry in entries.items()
            if name.startswith(incomplete)
        ]
        return [*commands, *click.Command.shell_complete(self, ctx, incomplete)]

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        for title, section in COMMANDS.items():
            with formatter.section(title):
                formatter.write_dl([(name, entry.help) for name, entry in section.items()])

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        name = args[0]
        if name not in [*self.list_commands(ctx), OPTIONS] and not name.startswith("-"):
            ctx.fail(_unknown(name, self.list_commands(ctx)))
        return super().resolve_command(ctx, args)


def _with_additions(entry: Entry) -> click.Command:
    command = _load(entry.target)
    assert isinstance(command, click.Command)
    if entry.more:
        assert isinstance(command, click.Group)
        for added in cast("tuple[click.Command, ...]", _load(entry.more)):
            command.add_command(added)
    return command


def _unknown(name: str, known: Sequence[str]) -> str:
    import difflib

    near = difflib.get_close_matches(name, known, n=1)
    hint = f"did you mean {near[0]!r}?" if near else "`gcs --help` lists them"
    return f"no command {name!r}; {hint}"


def _print_version(ctx: click.Context, _param: click.Parameter, asked: bool) -> None:
    if not asked:
        return
    from importlib.metadata import version

    click.echo(f"gcs {version('mavgate')}")
    ctx.exit()


@click.group(
    cls=LazyGroup,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
    epilog="Example: gcs demo\n\ngcs help options: the options of every command that meets a "
    "vehicle.\n\nExit codes: 0 done, 1 a check found something, 2 usage, 3 no "
    "link, 4 bad file, 5 refused by the vehicle, 6 refused by the gate, 7 recorder, 8 accepted but "
    "not completed, 9 address in use, 70 bug, 130 interrupted, 141 the reader of a pipe has gone.",
)
@click.option(
    "--version",
    is_flag=True,
    is_eager=True,
    expose_value=False,
    callback=_print_version,
    help="Show the version and exit.",
)
def gcs() -> None:
    """A MAVLink ground station that sends no command it cannot justify.

    Positions are metres east, north and up of the vehicle's local origin (E N U).
    """


def run(args: Sequence[str] | None = None) -> int:
    """Run one command line and return its exit code; users never see a traceback."""
    try:
        result = gcs.main(args=args, prog_name="gcs", standalone_mode=False)
    except click.ClickException as error:
        error.show()
        return error.exit_code
    except ExitError as error:
        click.echo("\n".join(error_lines(str(error), error.hint)), err=True)
        return error.exit_code
    except (click.Abort, KeyboardInterrupt):
        click.echo("gcs: interrupted", err=True)
        return ExitCode.INTERRUPTED
    except (BrokenPipeError, SystemExit) as ended:
        if isinstance(ended, SystemExit) and not ended.code:
            return ExitCode.DONE  # click has told a shell how a word may go on
        # Whoever read our output has gone; click and rich make a SystemExit of it.
        _drop_output()
        return ExitCode.READER_GONE
    except ModuleNotFoundError as missing:
        hint = "pip install mavgate brings all that gcs needs; vehicle-sim alone needs less"
        click.echo("\n".join(error_lines(f"{missing.name} is not installed", hint)), err=True)
        return ExitCode.USAGE
    except Exception as bug:  # noqa: BLE001  the one place: a bug is told, not spilled
        if _reader_has_gone(bug):
            _drop_output()
            return ExitCode.READER_GONE
        if isinstance(bug, OSError) and bug.errno in _NO_ROOM:
            _drop_output()
            click.echo(f"gcs: cannot write the output: {bug.strerror}", err=True)
            return ExitCode.RECORDER
        click.echo(f"gcs: internal error: {type(bug).__name__}: {bug}", err=True)
        click.echo(f"  details: {_keep_details(bug)}", err=True)
        return ExitCode.BUG
    return result if isinstance(result, int) else ExitCode.DONE


def _reader_has_gone(error: Exception, os_name: str = os.name) -> bool:
    """Windows says EINVAL where others say that a pipe is broken; a file's error has its name."""
    if os_name != "nt" or not isinstance(error, OSError):
        return False
    return error.errno == errno.EINVAL and error.filename is None


def _drop_output() -> None:
    """What is still unwritten goes nowhere: the interpreter must not trip over it at exit."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _keep_details(bug: Exception) -> str:
    """Write the traceback where it does not disturb, and say where."""
    import tempfile
    import traceback

    with tempfile.NamedTemporaryFile(
        "w",
        prefix="gcs-bug-",
        suffix=".txt",
        delete=False,
        encoding="utf-8",
        errors="backslashreplace",
    ) as file:
        file.write(f"gcs {' '.join(sys.argv[1:])}\n\n")
        traceback.print_exception(bug, file=file)
    return file.name


def main() -> NoReturn:
    """The console script."""
    if isinstance(sys.stdout, TextIOWrapper) and sys.stdout.errors == "strict":
        # Not every terminal, and no pipe on Windows, has every character that we print, and a
        # file's name may be no text at all: what cannot be written is escaped, as on stderr.
        sys.stdout.reconfigure(errors="backslashreplace")
    sys.exit(run())
