"""`gcs mission`: what can be done with a mission file without a vehicle."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import TYPE_CHECKING

import click

from gcs.cli.mission.convert import convert
from gcs.cli.mission.files import AUTOPILOT, FORCE, HOME, MISSION_FILE, read_plan, write_file
from gcs.cli.mission.new import new
from gcs.cli.options import AS_JSON, POLICY, with_options
from gcs.exit_codes import ExitCode

if TYPE_CHECKING:
    from gcs.plan.items import Flown
    from gcs.plan.model import AutopilotName, Geodetic


@click.group()
def mission() -> None:
    """Mission files: check and show them, and fly them through the gate.

    FILE is a QGroundControl .plan, a QGC WPL 110 table, a mission in our TOML or CSV, KML or GPX; a
    shipped mission is found by its name (`gcs mission show demo`).
    """


@mission.command(
    epilog="Example: gcs mission check survey.plan --policy default\n\n"
    "Exit codes: 0 it may be flown, 4 the file is wrong, 6 the fence refuses it."
)
@click.argument("file", type=MISSION_FILE)
@with_options(AUTOPILOT, POLICY, HOME, AS_JSON)
def check(
    file: str,
    autopilot: AutopilotName | None,
    policy: str,
    home: Geodetic | None,
    as_json: bool,
) -> int:
    """Check a mission file, and every leg of it against the fence, without a vehicle."""
    from gcs.cli.mission.check import check_plan
    from gcs.cli.mission.report import check_json, check_lines

    result = check_plan(read_plan(file, autopilot), autopilot, policy, home)
    click.echo(check_json(result) if as_json else "\n".join(check_lines(result)))
    return result.exit_code


@mission.command(epilog="Example: gcs mission show demo --html demo.html")
@click.argument("file", type=MISSION_FILE)
@click.option("--ascii", "ascii_only", is_flag=True, help="Draw without braille dots.")
@click.option("--svg", metavar="FILE", help="Write the pictures as SVG; - is standard output.")
@click.option("--html", metavar="FILE", help="Write a page that needs no network.")
@with_options(AUTOPILOT, POLICY, HOME, FORCE, AS_JSON)
def show(
    file: str,
    ascii_only: bool,
    svg: str | None,
    html: str | None,
    autopilot: AutopilotName | None,
    policy: str,
    home: Geodetic | None,
    force: bool,
    as_json: bool,
) -> int:
    """Show a mission file: its items, its route with lengths, heights and times, its fence.

    Nothing is judged: `gcs mission check` does that. Of the policy only the battery counts here.
    """
    from gcs.cli.mission.report import plan_json, print_plan
    from gcs.cli.mission.route import route_of

    plan = read_plan(file, autopilot)
    route = route_of(plan, autopilot, policy, home)
    if svg is not None or html is not None:
        from gcs.cli.mission.route_page import page, picture_file

        if svg is not None:
            write_file(svg, picture_file(plan, route).encode(), force)
        if html is not None:
            write_file(html, page(plan, route).encode(), force)
    elif as_json:
        click.echo(plan_json(plan, route))
    else:
        encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
        print_plan(plan, route, ascii_only=ascii_only or not has_braille(encoding))
    return ExitCode.DONE


def has_braille(encoding: str) -> bool:
    """Whether text of that encoding can have the dots of the pictures."""
    try:
        "\u28ff".encode(encoding)
    except (UnicodeEncodeError, LookupError):
        return False
    return True


@mission.command(epilog="Example: gcs mission items")
def items() -> int:
    """Print how each mission item is flown, by autopilot and version."""
    click.echo("\n".join(_items_lines()))
    return ExitCode.DONE


def _items_lines() -> Iterator[str]:
    """A paragraph a command: its number and name, and what each firmware does with it."""
    from gcs.plan.items import ROWS

    yield "How each mission item is flown.  Recorded: PX4 1.14 and ArduCopter 4.7."
    for row in ROWS:
        yield f"{int(row.command):5d}  {row.command.name}"
        cells = (row.px4_1_14, row.px4_1_15, row.copter_4_5, row.copter_4_7)
        for names, flown in _grouped(cells):
            yield f"         {names}: {flown.value}"


def _grouped(cells: tuple[Flown, ...]) -> Iterator[tuple[str, Flown]]:
    """Firmwares that do the same stand in one line."""
    from gcs.plan.items import VERSIONS

    for flown in dict.fromkeys(cells):
        names = [name for name, cell in zip(VERSIONS, cells, strict=True) if cell is flown]
        yield ("all" if len(names) == len(cells) else ", ".join(names)), flown


mission.add_command(convert)
mission.add_command(new)
