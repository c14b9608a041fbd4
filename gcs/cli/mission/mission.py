"""`gcs mission`: what can be done with a mission file without a vehicle."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import click

from gcs.cli.mission.convert import convert
from gcs.cli.mission.files import AUTOPILOT, HOME, MISSION_FILE, read_plan
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


@mission.command(epilog="Example: gcs mission show demo")
@click.argument("file", type=MISSION_FILE)
@with_options(AUTOPILOT, AS_JSON)
def show(file: str, autopilot: AutopilotName | None, as_json: bool) -> int:
    """Print what a mission file holds, item by item."""
    from gcs.cli.mission.report import plan_json, print_plan

    plan = read_plan(file, autopilot)
    if as_json:
        click.echo(plan_json(plan))
    else:
        print_plan(plan)
    return ExitCode.DONE


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
