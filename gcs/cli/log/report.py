"""`gcs log report`: a recorded flight as one page, and what was found as JSON."""

from __future__ import annotations

import os
from pathlib import Path

import click

from gcs.cli.options import SYSID
from gcs.cli.records.files import LAST, RECORD, one_record, reading_progress, still_written, told
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError


@click.command()
@click.argument("file", type=RECORD, required=False)
@LAST
@click.option(
    "-o",
    "--output",
    type=click.Path(dir_okay=False, path_type=Path),
    help="The page; without it, FILE with the suffix .html.",
)
@click.option(
    "--vehicle",
    type=SYSID,
    metavar="SYSID",
    help="Whose flight the page is about; without it, that of the one that flew longest.",
)
@click.option(
    "--json",
    "as_json",
    is_flag=True,
    help="Print what was found as one JSON object; the page is written only with -o.",
)
def report(
    file: Path | None, last: bool, output: Path | None, vehicle: int | None, as_json: bool
) -> None:
    """One page about the flight in FILE: what happened, and what went wrong first.

    The page is one HTML file that needs no network: the path inside its fence, plots, states,
    requests with their reasons, and findings with the limits they were judged by.

    Examples: gcs log report --last  |  gcs log report logs/SOME.mcap --json
    """
    from gcs.flight_report.findings_json import report_json
    from gcs.flight_report.render import page
    from gcs.flight_report.scan import scan
    from gcs.flight_report.summary import lines_of

    file = one_record(file, last=last)
    if output is None and not as_json:
        output = file.with_suffix(".html")
    if output is not None and same_file(file, output):
        raise click.UsageError(f"{output}: the page would overwrite the record")
    with told(file), reading_progress(file, "reading") as progress:
        flight = scan(file, progress)
    if vehicle is not None and vehicle not in flight.vehicles:
        heard = ", ".join(map(str, sorted(flight.vehicles))) or "none"
        raise ExitError(
            ExitCode.USAGE, f"{file}: no vehicle {vehicle} in it", f"vehicles in it: {heard}"
        )
    flight.chosen = vehicle
    if output is not None:
        write_page(output, page(flight))
    if as_json:
        click.echo(report_json(flight).decode())
        return
    if writing := still_written(file):
        click.echo(f"{file}: {writing}: the flight so far")
    for line in lines_of(flight):
        click.echo(line)
    click.echo(f"{output}: open it in a browser")


def same_file(file: Path, output: Path) -> bool:
    return output.exists() and os.path.samefile(file, output)


def write_page(output: Path, html: str) -> None:
    """Whole or not at all: a reader never finds half a page."""
    beside = output.with_name(f".{output.name}.{os.getpid()}")
    try:
        beside.write_text(html, encoding="utf-8", errors="replace")
        beside.replace(output)
    except OSError as error:
        beside.unlink(missing_ok=True)
        raise ExitError(
            ExitCode.RECORDER, f"{output}: cannot write: {error.strerror or error}"
        ) from error
