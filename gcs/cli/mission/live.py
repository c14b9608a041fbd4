"""The `gcs mission` commands that need a vehicle: upload, download, fly, set-current, clear."""

from __future__ import annotations

from typing import Unpack

import click

from gcs.cli import completers
from gcs.cli.common_options import COMMON, MeetsVehicle, ToVehicle, set_up
from gcs.cli.mission.files import MISSION_FILE
from gcs.cli.options import UTF8, Seconds, with_options
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

EXITS = (
    "Exit codes: 0 done, 3 no vehicle, 4 bad file, 5 refused by the vehicle, 6 refused by the "
    "gate, 8 accepted but not completed, 130 interrupted."
)
WAIT = click.Option(
    ["--wait"],
    type=Seconds(),
    default=1800.0,
    show_default=True,
    metavar="S",
    help="Seconds to wait for the effect.",
)
LINK_OPTIONS = (WAIT, *COMMON)


@click.command(
    cls=MeetsVehicle, epilog=f"Example: gcs mission upload missions/demo.toml\n\n{EXITS}"
)
@click.argument("file", type=MISSION_FILE)
@with_options(*LINK_OPTIONS)
def upload(
    file: str,
    **to: Unpack[ToVehicle],
) -> None:
    """Verify a mission file, send it to the vehicle, read it back and compare.

    Its fence and rally points are sent too; a file that has none leaves those on board as they are.
    """
    run_word("mission upload", readable(file), **to)


@click.command(cls=MeetsVehicle, epilog=f"Example: gcs mission download on_board.plan\n\n{EXITS}")
@click.argument("file", required=False, shell_complete=completers.missions)
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, writable=True),
    help="The same as FILE.",
)
@click.option("--force", is_flag=True, help="Write over a file that exists.")
@with_options(*LINK_OPTIONS)
def download(
    file: str | None,
    output: str | None,
    force: bool,
    **to: Unpack[ToVehicle],
) -> None:
    """Read the mission on board into FILE, mission.plan if none is named, with the fence and the
    rally points on board, and where home is. What the format cannot keep is said.

    The suffix chooses the format: .plan, .waypoints, .txt or .csv.
    """
    if file is not None and output is not None:
        raise ExitError(ExitCode.USAGE, f"one file, not two: {file} and {output}")
    path = file or output or "mission.plan"
    check_output(path, force)
    run_word("mission download", path, **to)


@click.command(cls=MeetsVehicle, epilog=f"Example: gcs mission fly missions/demo.toml\n\n{EXITS}")
@click.argument("file", type=MISSION_FILE)
@with_options(*LINK_OPTIONS)
def fly(
    file: str,
    **to: Unpack[ToVehicle],
) -> None:
    """Upload a mission file, then start it and wait for its end."""
    run_word("mission fly", readable(file), **to)


@click.command(
    "set-current", cls=MeetsVehicle, epilog=f"Example: gcs mission set-current 3\n\n{EXITS}"
)
@click.argument("item", type=click.IntRange(min=0))
@with_options(*LINK_OPTIONS)
def set_current(
    item: int,
    **to: Unpack[ToVehicle],
) -> None:
    """Let the next start of the mission begin at ITEM, as MAVLink counts: 0 is the first item of a
    PX4, 1 that of an ArduPilot.

    In the air only, and while no mission is flown; the start itself verifies the way there.
    """
    run_word("mission set-current", item, **to)


@click.command(cls=MeetsVehicle, epilog=f"Example: gcs mission clear\n\n{EXITS}")
@with_options(*LINK_OPTIONS)
def clear(
    **to: Unpack[ToVehicle],
) -> None:
    """Remove the mission on board. Its fence and rally points stay, which is said: see gcs fence
    clear, gcs rally clear."""
    run_word("mission clear", **to)


COMMANDS = (upload, download, fly, set_current, clear)


def check_output(output: str, force: bool) -> None:
    """Whether a mission may be written there, checked before any station is started."""
    from pathlib import Path

    from gcs.plan.formats.writer import SUFFIXES

    path = Path(output)
    if path.suffix.lower() not in SUFFIXES:
        raise ExitError(
            ExitCode.USAGE,
            f"{output}: the suffix names no format that can be written",
            f"one of: {', '.join(SUFFIXES)}",
        )
    if path.exists() and not force:
        raise ExitError(ExitCode.USAGE, f"{output}: exists already", "--force writes over it")


def readable(file: str) -> str:
    """Path of the file as typed, or of the shipped mission of that name.

    It is read here first, so that a file that is no plan is refused before any station is
    started.  Raises ExitError with BAD_FILE.
    """
    from gcs import resources
    from gcs.cli.mission.files import read_plan

    read_plan(file, None)
    return str(resources.find(file))


def run_word(word: str, *arguments: str | int, **to: Unpack[ToVehicle]) -> None:
    from gcs.cli import oneshot_session
    from gcs.request_words import WORD_BY_NAME, SendRequests, label

    action = WORD_BY_NAME[word].action(*arguments)
    assert isinstance(action, SendRequests)
    for request in action.requests:
        UTF8.convert(request.path, None, None)
    setup, how = set_up(word.partition(" ")[0], label(action.requests[0]), to)
    task = oneshot_session.sending(action, to["wait"])
    code = oneshot_session.run(setup, how, task)
    click.get_current_context().exit(code)
