"""`gcs log merge`: several records in one."""

from __future__ import annotations

from pathlib import Path

import click

from gcs.cli.record_files import NEW_RECORD, RECORD, told, writing
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError


@click.command()
@click.argument("files", type=RECORD, nargs=-1, required=True, metavar="FILE...")
@NEW_RECORD
@click.option("--prefix", is_flag=True, help="Each session's topics begin with its name.")
def merge(files: tuple[Path, ...], output: Path, prefix: bool) -> None:
    """Write all messages of the FILEs into one, ordered by their time.

    The parts of one session become one record, which can be audited as such. Records of several
    vehicles become one picture; where two have the same number, take --prefix.

    Example: gcs log merge logs/20260101-120000_flight*.mcap -o flight.mcap
    """
    from gcs.record.merge import SameVehicleError
    from gcs.record.merge import merge as merge_files

    with told(files[0]), writing(files[0], output):
        try:
            made = merge_files(files, output, prefixed=prefix)
        except SameVehicleError as error:
            raise ExitError(
                ExitCode.USAGE, str(error), "--prefix keeps their topics apart"
            ) from error
    click.echo(f"{output}: {made.messages} messages of {len(files)} files, {made.seconds:.1f} s")
    for path in made.not_closed:
        click.echo(f"{path} was not closed: read as far as it goes")
    if made.damaged:
        click.echo(f"left out: {made.damaged} damaged records")
