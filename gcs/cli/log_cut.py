"""`gcs log cut`: a stretch of a record as a record of its own."""

from __future__ import annotations

import math
from pathlib import Path

import click

from gcs.cli.options import FiniteRange
from gcs.cli.record_files import NEW_RECORD, RECORD, reading_progress, told, writing
from gcs.exit_codes import ExitCode
from gcs.operator.errors import ExitError

_SECONDS = FiniteRange(min=0)


@click.command()
@click.argument("file", type=RECORD)
@NEW_RECORD
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
    file: Path,
    output: Path,
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
