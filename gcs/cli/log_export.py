"""`gcs log export`: records into files for other programs."""

from __future__ import annotations

from pathlib import Path

import click

from gcs.cli.log_files import SOURCE, TARGET, new_file, progress, told


@click.command("export")
@click.argument("file", type=SOURCE)
@click.option(
    "-o", "--output", required=True, type=TARGET, help="The new file; its suffix is the format."
)
def export_log(file: Path, output: Path) -> None:
    """Write the frames of the record FILE as a .tlog.

    An imported .tlog comes out byte for byte as it was.

    Example: gcs log export flight.mcap -o flight.tlog
    """
    from gcs.logfile.exports.tlog import export_tlog

    if output.suffix.lower() != ".tlog":
        raise click.UsageError(f"{output}: the suffix is not .tlog")
    with told(file), new_file(output) as target, progress(file, "exporting") as bar:
        done = export_tlog(file, target, bar)
    click.echo(f"{output}: {done.frames} frames")
    if done.garbage_bytes:
        click.echo(f"with {done.garbage_bytes} damaged bytes of the file that it came from")
    if done.left_out:
        click.echo(f"left out: {done.left_out} refused frames and pieces of garbage")
    if done.damaged:
        click.echo(f"{done.damaged} damaged parts of {file} were skipped")
