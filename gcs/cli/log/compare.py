"""`gcs log compare`: two flights over each other."""

from __future__ import annotations

from pathlib import Path

import click

from gcs.cli.log.report import same_file, write_page
from gcs.cli.options import SYSID
from gcs.cli.records.files import RECORD, reading_progress, told
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError


@click.command()
@click.argument("a", type=RECORD)
@click.argument("b", type=RECORD)
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, path_type=Path),
    help="The page; without it, A-B.html beside B.",
)
@click.option(
    "--vehicle",
    type=SYSID,
    metavar="SYSID",
    help="Whose flights; without it, those of the one that flew longest in each.",
)
@click.option(
    "--json",
    "as_json",
    is_flag=True,
    help="Print the comparison as one JSON object; the page is written only with -o.",
)
def compare(a: Path, b: Path, output: Path | None, vehicle: int | None, as_json: bool) -> None:
    """Two flights beside each other: of one mission, or before and after a change.

    One HTML file that needs no network: the same plots over each other from the take-off on, a
    table of figures and their differences, both paths, what went wrong in one alone, parameters
    that differ. Also of .tlog, .BIN, .log and .ulg.

    Examples: gcs log compare before.mcap after.mcap  |  gcs log compare a.tlog b.ulg --json
    """
    import msgspec

    from gcs.flight_report.compare import compare as compared
    from gcs.flight_report.compare_html import apart, compare_page, known, number
    from gcs.flight_report.scan import scan
    from gcs.flight_report.summary import what_went_wrong

    if output is None and not as_json:
        output = b.with_name(f"{a.stem}-{b.stem}.html")
    for file in (a, b):
        if output is not None and same_file(file, output):
            raise click.UsageError(f"{output}: the page would overwrite the record")
    flights, vehicles = [], []
    for file in (a, b):
        with told(file), reading_progress(file, "reading") as progress:
            flight = scan(file, progress)
        flight.chosen = vehicle
        shown = flight.main_vehicle()
        if shown is None or (vehicle is not None and shown.sysid != vehicle):
            heard = ", ".join(map(str, sorted(flight.vehicles))) or "none"
            raise ExitError(
                ExitCode.USAGE, f"{file}: no such vehicle in it", f"vehicles in it: {heard}"
            )
        flights.append(flight)
        vehicles.append(shown)
    comparison = compared((flights[0].name, flights[1].name), *vehicles)
    if output is not None:
        write_page(output, compare_page((flights[0], flights[1]), tuple(vehicles)))
    if as_json:
        click.echo(msgspec.json.encode(comparison).decode())
        return
    for letter, flight, shown in zip("AB", flights, vehicles, strict=True):
        click.echo(f"{letter} {flight.name}: {what_went_wrong(flight, shown)}")
    for each in known(comparison):
        click.echo(
            f"  {each.name:24}{number(each.a, each.unit):>12}{number(each.b, each.unit):>12}"
            f"{number(each.difference, each.unit, signed=True):>12}"
        )
    click.echo(apart(comparison))
    click.echo(f"{output}: open it in a browser")
