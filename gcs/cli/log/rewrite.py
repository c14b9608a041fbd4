"""`gcs log compact`, `cut`, `merge` and `recover`: records written anew, whole or in part.

`compact` is what a station does with its record when it ends, by hand.
"""

from __future__ import annotations

import math
from pathlib import Path

import click

from gcs.cli.options import FiniteRange
from gcs.cli.records.files import (
    LAST,
    NEW_RECORD,
    RECORD,
    one_record,
    reading_progress,
    told,
    writing,
)
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

_SECONDS = FiniteRange(min=0)


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


@click.command()
@click.argument("file", type=RECORD, required=False)
@NEW_RECORD
@LAST
@click.option("--from", "from_s", type=_SECONDS, metavar="S", help="Seconds after its beginning.")
@click.option("--to", "to_s", type=_SECONDS, metavar="S", help="Seconds after its beginning.")
@click.option("--around", type=int, metavar="REQUEST", help="Around this request's decisions.")
@click.option(
    "--margin",
    type=_SECONDS,
    default=5.0,
    show_default=True,
    metavar="S",
    help="With --around: so much before the first and after the last of them.",
)
def cut(
    file: Path | None,
    output: Path,
    last: bool,
    from_s: float | None,
    to_s: float | None,
    around: int | None,
    margin: float,
) -> None:
    """Write the messages of a stretch of FILE into a new one.

    At its beginning stands the latest message of each topic that tells a state: frames, model,
    fence, mission, parameters. Attachments and metadata are all kept.

    \b
    Examples: gcs log cut flight.mcap --from 60 --to 90 -o turn.mcap
              gcs log cut flight.mcap --around 7 -o refused.mcap
    """
    from gcs.record.cut import NotInRecordError
    from gcs.record.cut import around as stretch_around
    from gcs.record.cut import cut as cut_file

    file = one_record(file, last=last)

    if (around is None) == (from_s is None and to_s is None):
        raise click.UsageError("say which stretch: --from and --to, or --around REQUEST")
    begin_s, end_s = from_s or 0.0, math.inf if to_s is None else to_s
    if begin_s > end_s:
        raise click.UsageError(f"--from {begin_s:g} is after --to {end_s:g}")
    with told(file), reading_progress(file, "cutting") as progress, writing(file, output):
        try:
            if around is not None:
                begin_s, end_s = stretch_around(file, around, margin)
            made = cut_file(file, output, begin_s, end_s, progress)
        except NotInRecordError as error:
            raise ExitError(ExitCode.USAGE, f"{file}: {error}", error.hint) from error
    click.echo(
        f"{output}: {made.messages} messages, {made.seconds:.1f} s, "
        f"{made.repeated} of them states from before the cut"
    )


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


@click.command()
@click.argument("file", type=RECORD)
@NEW_RECORD
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object.")
def recover(file: Path, output: Path, as_json: bool) -> None:
    """Make a whole file of one whose writer was killed.

    Everything that is complete in FILE goes to the new file, up to the last message that can
    still be read.  FILE stays as it is.

    Example: gcs log recover broken.mcap -o whole.mcap
    """
    import json

    from gcs.record.recover import recover

    with (
        told(file),
        reading_progress(file, "recovering") as progress,
        writing(file, output),
    ):
        saved = recover(file, output, progress)
    condition = saved.condition
    if as_json:
        values = {
            "path": str(output),
            "messages": saved.messages,
            "seconds": saved.seconds,
            "attachments": saved.attachments,
            "source_closed": condition.closed,
            "broken_chunk": condition.broken_chunk,
            "damaged": condition.damaged,
            "unread_bytes": condition.unread_bytes,
            "orphans": saved.orphans,
        }
        click.echo(json.dumps(values))
        return
    click.echo(f"{output}: {saved.messages} messages, {saved.seconds:.1f} s recovered")
    if condition.closed and not condition.damaged:
        click.echo("the file was complete already; this is a copy")
    if condition.broken_chunk:
        click.echo("the last chunk breaks off: what could be decompressed of it is included")
    if condition.damaged or saved.orphans:
        click.echo(f"left out: {condition.damaged} damaged records, {saved.orphans} messages")
    if condition.unread_bytes:
        last = f"its last {condition.unread_bytes} bytes of {condition.size}"
        click.echo(f"the rest of the file could not be read: {last}")
