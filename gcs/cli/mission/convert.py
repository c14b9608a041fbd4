"""`gcs mission convert`: a mission file as one of another format."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import click

from gcs.cli.mission.files import AUTOPILOT, FORCE, MISSION_FILE, parse_home, read_plan, write_file
from gcs.cli.options import AS_JSON, FiniteRange, with_options
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

if TYPE_CHECKING:
    from gcs.plan.formats.writer import Format
    from gcs.plan.model import AutopilotName, Geodetic

TO = click.Option(
    ["--to", "kind"],
    type=click.Choice(["plan", "wpl", "toml", "csv", "kml", "gpx"]),
    help="The format.  [default: by the suffix of OUT]",
)


@click.command(
    epilog="Example: gcs mission convert demo -o demo.plan --home 47.397742,8.545594,488\n\n"
    "Exit codes: 0 written, 1 something would be lost and --strict was given, 2 usage, 4 the file "
    "is wrong or cannot be written so."
)
@click.argument("file", type=MISSION_FILE)
@click.option(
    "-o",
    "--output",
    required=True,
    type=click.Path(dir_okay=False, allow_dash=True),
    metavar="OUT",
    help="What to write; - is standard output, with --to.",
)
@with_options(
    TO,
    AUTOPILOT,
    click.Option(
        ["--home"],
        callback=parse_home,
        metavar="LAT,LON,ALT",
        help="Where it takes off: metres count from there, and heights.  [default: the file's]",
    ),
    click.Option(
        ["--height", "height_m"],
        type=FiniteRange(-1e4, 1e4),
        metavar="M",
        help="Fly every place of the route at that height above home.",
    ),
    click.Option(["--strict"], is_flag=True, help="Write nothing if something would be lost."),
    FORCE,
    AS_JSON,
)
def convert(
    file: str,
    output: str,
    kind: Format | None,
    autopilot: AutopilotName | None,
    home: Geodetic | None,
    height_m: float | None,
    strict: bool,
    force: bool,
    as_json: bool,
) -> int:
    """Write a mission file in another format, and name what that one cannot keep.

    QGroundControl .plan, QGC WPL 110 (.waypoints, .txt), our TOML and CSV, KML, GPX.
    """
    from gcs.cli.mission.report import finding_json, finding_lines
    from gcs.plan.errors import PlanError
    from gcs.plan.formats import convert as conversion
    from gcs.plan.formats.reader import read
    from gcs.plan.formats.writer import format_of

    if output == "-" and (kind is None or as_json):
        problem = "--json says nothing of it there" if as_json else "--to names the format"
        raise ExitError(ExitCode.USAGE, f"-o - is standard output: {problem}")
    plan = read_plan(file, autopilot)
    if height_m is not None:
        plan = conversion.at_height(plan, height_m)
    try:
        kind = kind or format_of(output)
        written = conversion.convert(output, plan, kind, autopilot, home)
        there = read(f"{output}.{kind}", written.data, autopilot)
    except PlanError as error:
        raise ExitError(ExitCode.BAD_FILE, str(error), error.hint) from None
    kept = not (strict and written.lost)
    if kept:
        write_file(output, written.data, force)
    if as_json:
        document = {
            "file": plan.source,
            "written": output if kept else None,
            "format": kind,
            "items": len(there.items),
            "zones": len(there.fence.zones),
            "rally": len(there.rally),
            "notes": [finding_json(finding) for finding in plan.notes],
            "lost": [finding_json(finding) for finding in written.lost],
        }
        click.echo(json.dumps(document, indent=2))
        return ExitCode.DONE if kept else ExitCode.DIFFERENT
    for finding in plan.notes:
        click.echo("\n".join(finding_lines(plan, finding)), err=True)
    for loss in written.lost:
        place = f"{plan.source}:{loss.where}" if loss.where else plan.source
        click.echo(f"lost: {place}: {loss.item}: {loss.what}", err=True)
    if not kept:
        raise ExitError(ExitCode.DIFFERENT, f"{output}: not written, as it would lose the above")
    if output != "-":
        counts = f"{len(there.items)} items, {len(there.fence.zones)} zones"
        click.echo(f"{output}: written, {counts}, {len(there.rally)} rally points")
    return ExitCode.DONE
