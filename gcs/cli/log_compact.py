"""`gcs log compact`: what a station does with its record when it ends, by hand."""

from __future__ import annotations

from pathlib import Path

import click

from gcs.cli.record_files import RECORD, reading_progress, told
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError


@click.command()
@click.argument("files", type=RECORD, nargs=-1, required=True, metavar="FILE...")
def compact(files: tuple[Path, ...]) -> None:
    """Rewrite each FILE in larger chunks: smaller, and opened faster by viewers.

    A station does it with its own record when it ends. The new file takes the old one's place
    when it is complete; after a Ctrl-C or an error FILE is as it was.

    Example: gcs log compact logs/20260101-120000_flight.mcap
    """
    from gcs.record.compact import NotCompactedError
    from gcs.record.compact import compact as compact_file

    for file in files:
        with told(file), reading_progress(file, "compacting") as progress:
            try:
                done = compact_file(file, progress)
            except NotCompactedError as error:
                raise ExitError(
                    ExitCode.BAD_FILE, f"{file}: not compacted: {error}", "it is as it was"
                ) from error
        click.echo(
            f"{file}: {done.messages} messages, "
            f"{done.bytes_before / 1e6:.2f} MB before, {done.bytes_after / 1e6:.2f} MB now"
        )
