"""`gcs log import`: logs of other programs into records."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from gcs.cli.log.files import SOURCE, TARGET, new_file, told
from gcs.cli.record_files import reading_progress

if TYPE_CHECKING:
    from gcs.logfile.imports.result import Imported


@click.command("import")
@click.argument("file", type=SOURCE)
@click.option("-o", "--output", required=True, type=TARGET, help="The new record (.mcap).")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def import_log(file: Path, output: Path, as_json: bool) -> None:
    """Make a record of FILE, a .tlog, an ArduPilot .BIN or a PX4 .ulg.

    All of it is kept, each kind of message on a topic of its own, damaged stretches too. Position,
    attitude, status, parameters and texts are on the topics of our own flights as well, so that the
    same layouts show it.

    Example: gcs log import flight.tlog -o flight.mcap
    """
    import json

    from gcs.logfile.imports.formats import importer_of
    from gcs.mcap_file.batch_writer import BatchWriter

    with told(file):
        run = importer_of(file)
        with new_file(output) as target, reading_progress(file, "importing") as bar:
            writer = BatchWriter(target)
            found = run(file, writer, bar)
            writer.finish()
    if as_json:
        values = {
            "path": str(output),
            "format": found.format,
            "read": found.read,
            "kinds": found.kinds,
            "garbage_bytes": found.garbage_bytes,
            "garbage_stretches": found.garbage_stretches,
            "messages": found.messages,
            "seconds": found.seconds,
        }
        click.echo(json.dumps(values))
        return
    _print(found, output)


def _print(found: Imported, output: Path) -> None:
    click.echo(
        f"{output}: {found.read} messages of {len(found.kinds)} kinds in {found.seconds:.1f} s, "
        f"from a {found.format}"
    )
    if found.garbage_stretches:
        click.echo(
            f"kept too: {found.garbage_bytes} damaged bytes in {found.garbage_stretches} stretches"
        )
